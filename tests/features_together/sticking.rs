//! The row with adhesion: a path of another type, so that it has checks of its own.

use std::path::PathBuf;

use asperity::adhesion::{Adhesion, AdhesiveBranch, AdhesivePath, AdhesiveState, NodeState};
use asperity::kernel::{Layered, LayeredBody};
use asperity::record::{AdhesiveRecord, LoadingRecord};
use asperity::surface::Axis;
use asperity::{
    Boussinesq, ContactTarget, Error, Grid, InfluenceKernel, PeriodicBoussinesq,
    SemiPeriodicBoussinesq,
};
use asperity_testing::dense::{influence_matrix, initial_gap};
use asperity_testing::surfaces::self_affine;
use nalgebra::DVector;

use super::rows::E_STAR;

/// Its name on the page.
pub(super) const NAME: &str = "adhesion";

/// Work of adhesion \[J/m²\]: so much that its range is as long as the surface is rough.
const WORK: f64 = 1000.0;
const END: f64 = 0.5;

fn grid() -> Grid {
    Grid::square(16, 3.2e-4).unwrap()
}

fn path() -> AdhesivePath {
    path_of(&Boussinesq::new(grid(), E_STAR).unwrap(), Adhesion::work(WORK))
}

fn path_of(kernel: &dyn InfluenceKernel, law: Adhesion) -> AdhesivePath {
    let surface = self_affine(&grid(), 0.8, 1.5e-6, 3);
    let builder = AdhesivePath::builder(&surface, kernel, law);
    builder.until(ContactTarget::AreaFraction(END)).build().unwrap()
}

/// Every kind of body on which contact grows.
fn bodies() -> Vec<Box<dyn InfluenceKernel>> {
    let [sheet, soft, _] = super::rows::bodies();
    let along = |axis| Box::new(SemiPeriodicBoussinesq::new(grid(), E_STAR, axis).unwrap());
    let layered = |made: fn(Grid, LayeredBody) -> Result<Layered, Error>, body: &LayeredBody| {
        Box::new(made(grid(), body.clone()).unwrap())
    };
    vec![
        Box::new(Boussinesq::new(grid(), E_STAR).unwrap()),
        Box::new(PeriodicBoussinesq::new(grid(), E_STAR).unwrap()),
        along(Axis::X),
        along(Axis::Y),
        layered(Layered::free, &sheet),
        layered(Layered::periodic, &sheet),
        layered(Layered::free, &soft),
        layered(Layered::periodic, &soft),
    ]
}

/// States of both branches.
fn pulled_off(mut path: AdhesivePath) -> (AdhesivePath, AdhesiveBranch) {
    let mut states = path.run().unwrap();
    path.unload().unwrap();
    states.extend(path.run().unwrap().states().iter().copied());
    (path, states)
}

/// What the page says of a column.
pub(super) fn column(name: &str) -> Result<(), Error> {
    match name {
        "fields" | "unload" => fields(),
        "record" => record(),
        "resume" => resume(),
        // Single loads and sweeps have no way to be given a law, and all others take states or a record of contact that
        // only grows: an `AdhesiveBranch` is no `History`, which the compiler refuses. What is left is the file, and it
        // is the record in it that is refused, whatever it was to be read for.
        _ => refused(),
    }
}

/// Pressures and gaps are those of the influence matrix and of the law, and scalars follow from them.
fn fields() -> Result<(), Error> {
    let (path, states) = pulled_off(path());
    let law = path.law();
    let grid = path.grid();
    let half_space = Boussinesq::new(grid, E_STAR)?;
    let matrix = influence_matrix(&half_space);
    let surface = self_affine(&grid, 0.8, 1.5e-6, 3);
    let initial = initial_gap(surface.matrix());
    let (mut soft, mut pressed) = (0, 0);
    for state in states.states().iter().step_by(states.states().len() / 12) {
        let fields = path.fields_at(state)?;
        let pressure = DVector::from_column_slice(fields.pressure.as_slice());
        let displacement = &matrix * &pressure;
        for (node, kind) in fields.nodes.iter().enumerate() {
            let gap = initial[node] + displacement[node] - state.contact.approach;
            // Two solutions whose condition is some 10³, of displacements about as long as the range.
            let rounding = 1e-10 * (law.range() + state.contact.approach.abs());
            assert!((gap - fields.gap[node]).abs() < rounding, "{gap} {}", fields.gap[node]);
            if *kind == NodeState::Contact {
                assert!(pressure[node] > -law.stress() * (1.0 + 1e-9));
                pressed += 1;
            } else {
                let pull = law.pull(gap);
                assert!((pressure[node] + pull).abs() < 1e-8 * law.stress(), "{kind:?}");
                soft += usize::from(*kind == NodeState::Soft);
            }
        }
        let unit = grid.cell_area() * pressure.iter().map(|p| p.abs()).sum::<f64>();
        let load = grid.cell_area() * pressure.sum();
        assert!((load - state.contact.load).abs() <= 1e-10 * unit, "{load} {state:?}");
    }
    assert!(soft > 20 && pressed > 100, "{soft} {pressed}");
    // All the way back.
    let last = states.states().last().unwrap();
    assert_eq!((last.contact.contact_nodes, last.soft_nodes), (0, 0));
    assert!(states.dissipated() >= 0.0 && states.pull_off() > 0.0);
    Ok(())
}

/// A file of its own for each test.
fn file(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("asperity-sticking-{name}-{}.npz", std::process::id()))
}

fn through_a_file(record: &AdhesiveRecord, name: &str) -> AdhesiveRecord {
    let file = file(name);
    record.write_npz(&file, &[]).unwrap();
    let read = AdhesiveRecord::read_npz(&file);
    std::fs::remove_file(&file).unwrap();
    read.unwrap()
}

/// Both branches come back bit for bit, and so do the fields of their states.
fn record() -> Result<(), Error> {
    for kernel in bodies() {
        record_on(&*kernel)?;
    }
    Ok(())
}

fn record_on(kernel: &dyn InfluenceKernel) -> Result<(), Error> {
    // Half the stress of the triangle, over a longer range: nodes are pulled with all of it before they touch.
    let triangle = Adhesion::work(WORK);
    let maugis = Adhesion::maugis(WORK, 0.5 * triangle.on(kernel)?.stress());
    for law in [triangle, maugis] {
        let (path, states) = pulled_off(path_of(kernel, law));
        let last = states.states().last().unwrap();
        assert_eq!((last.contact.contact_nodes, last.soft_nodes), (0, 0));
        assert!(states.dissipated() >= 0.0 && states.pull_off() > 0.0);
        let is_cohesive = states.states().iter().any(|state| state.cohesive_nodes > 0);
        assert!(is_cohesive || law != maugis);
        let record = through_a_file(&AdhesiveRecord::new(&path, states.clone())?, "record");
        assert_eq!(record.states(), &states);
        assert_eq!((record.adhesion(), path.adhesion()), (law, law));
        let again = record.path()?;
        assert_eq!(again.problem().table().origin(), kernel.origin());
        assert_eq!((again.law(), again.state()), (path.law(), path.state()));
        for state in states.states().iter().step_by(states.states().len() / 5) {
            assert_eq!(again.fields_at(state)?, path.fields_at(state)?);
        }
        // On a kernel that is given, if it is that one, and within a budget.
        let on = |kernel: &dyn InfluenceKernel, budget| record.path_on(kernel, budget);
        let given = on(kernel, Some(1 << 30))?;
        assert_eq!(given.state(), path.state());
        let other = Boussinesq::new(record.grid(), 2.0 * E_STAR)?;
        assert!(matches!(on(&other, None), Err(Error::WrongKernel { .. })));
        assert!(matches!(on(kernel, Some(1000)), Err(Error::MemoryBudget { budget: 1000, .. })));
    }
    Ok(())
}

/// Interrupted on either branch, within a jump or not, a path goes on to the same events: where its branch was to end,
/// and where it is told to.
fn resume() -> Result<(), Error> {
    let (_, states) = pulled_off(path());
    let all = states.states();
    let stops = [0, 1, all.len() / 5, all.len() / 2, 4 * all.len() / 5];
    for (stop, is_told) in stops.into_iter().flat_map(|stop| [(stop, false), (stop, true)]) {
        let mut path = path();
        let is_unloading = stop > 0 && all[stop - 1].direction != all[0].direction;
        let mut so_far: Vec<AdhesiveState> = Vec::new();
        if is_unloading {
            so_far.extend(path.run()?.states());
            path.unload()?;
        }
        while so_far.len() < stop {
            so_far.extend(path.next().transpose()?);
        }
        let record = AdhesiveRecord::new(&path, so_far.into_iter().collect())?;
        let mut path = through_a_file(&record, &format!("resume-{stop}-{is_told}")).path()?;
        assert_eq!(path.end(), None);
        match (is_told, is_unloading) {
            (false, _) => {}
            (true, true) => path.unload()?,
            (true, false) => path.load_to(ContactTarget::AreaFraction(END))?,
        }
        let mut rest: Vec<AdhesiveState> = path.run()?.states().to_vec();
        if !is_unloading {
            path.unload()?;
            rest.extend(path.run()?.states());
        }
        assert_eq!(stop + rest.len(), all.len());
        // Windows begin elsewhere: rounding, of the greatest load.
        let unit = states.pull_off() + all.iter().map(|s| s.contact.load).fold(0.0, f64::max);
        for (found, expected) in rest.iter().zip(&all[stop..]) {
            assert_eq!((found.step, found.event), (expected.step, expected.event));
            assert!((found.contact.load - expected.contact.load).abs() < 1e-9 * unit);
        }
    }
    Ok(())
}

/// What takes a record of contact that only grows refuses this one.
fn refused() -> Result<(), Error> {
    let mut path = path();
    let states = path.run()?;
    use std::sync::atomic::{AtomicUsize, Ordering};
    static NEXT: AtomicUsize = AtomicUsize::new(0);
    let file = file(&format!("refused-{}", NEXT.fetch_add(1, Ordering::Relaxed)));
    AdhesiveRecord::new(&path, states)?.write_npz(&file, &[])?;
    let read = LoadingRecord::read_npz(&file);
    std::fs::remove_file(&file).unwrap();
    read.map(drop)
}
