//! A node alone by hand, flat and repeated surfaces, whose nodes have their events together, and other units.

use asperity::adhesion::{Adhesion, AdhesiveBranch, AdhesiveEvent, AdhesivePath};
use asperity::surface::{Amplitude, HeightMap, SelfAffine};
use asperity::{
    Boussinesq, ContactTarget, Error, Grid, InfluenceKernel, PeriodicBoussinesq, Surface,
};
use nalgebra::DMatrix;

fn flat(nodes: usize) -> HeightMap {
    HeightMap::new(DMatrix::zeros(nodes, nodes)).unwrap()
}

/// A flat cylinder of radius 0.4 on a square of side 1.
fn punch(nodes: usize) -> HeightMap {
    let place = |i: usize| (i as f64 + 0.5) / nodes as f64 - 0.5;
    let height = |i, j| if place(i).hypot(place(j)) < 0.4 { 0.0 } else { -1.0 };
    HeightMap::new(DMatrix::from_fn(nodes, nodes, height)).unwrap()
}

fn both(
    surface: &dyn Surface,
    kernel: &dyn InfluenceKernel,
    law: Adhesion,
    end: ContactTarget,
) -> [AdhesiveBranch; 2] {
    let mut path = AdhesivePath::builder(surface, kernel, law).until(end).build().unwrap();
    let loading = path.run().unwrap();
    path.unload().unwrap();
    [loading, path.run().unwrap()]
}

/// One node of compliance c: it comes near at −h₂ and touches at −σ₀ c; both branches are one, and closing is 1/(1 − k
/// c) times as fast.
#[test]
fn one_node() {
    let kernel = Boussinesq::new(Grid::square(1, 0.5).unwrap(), 2.0).unwrap();
    let compliance = kernel.coefficient(0, 0);
    let law = Adhesion::work(0.01).range(0.1);
    let stress = 2.0 * 0.01 / 0.1;
    assert!(law.on(&kernel).unwrap().resolution() < 1.0);
    let [loading, unloading] = both(&flat(1), &kernel, law, ContactTarget::Approach(0.03));
    let events = |branch: &AdhesiveBranch| -> Vec<_> {
        let states = branch.states().iter();
        states.map(|s| (s.event, s.contact.approach, s.contact.load, s.dissipated)).collect()
    };
    let touch = -stress * compliance;
    let area = 0.25;
    let expected = [
        (AdhesiveEvent::Near, -0.1, 0.0),
        (AdhesiveEvent::Touch, touch, -stress * area),
        (AdhesiveEvent::Limit, 0.03, 0.03 / compliance * area),
        (AdhesiveEvent::Part, touch, -stress * area),
        (AdhesiveEvent::Far, -0.1, 0.0),
    ];
    let found = events(&loading).into_iter().chain(events(&unloading));
    let mut count = 0;
    for ((event, approach, load, dissipated), expected) in found.zip(expected) {
        assert_eq!((event, dissipated), (expected.0, 0.0));
        assert!(
            (approach - expected.1).abs() < 1e-15 && (load - expected.2).abs() < 1e-15,
            "{expected:?} {approach} {load}"
        );
        count += 1;
    }
    assert_eq!(count, 5);
    assert!((unloading.pull_off() - stress * area).abs() < 1e-15);
    // Half way up the slope the load is too.
    let middle = 0.5 * (-0.1 + touch);
    assert!((loading.load_at(middle).unwrap() + 0.5 * stress * area).abs() < 1e-15);
}

/// All nodes of a flat periodic surface let go at once, under σ₀ everywhere.
#[test]
fn flat_surface() {
    let grid = Grid::square(12, 1.0).unwrap();
    let periodic = PeriodicBoussinesq::new(grid, 1.0).unwrap();
    let law = Adhesion::work(1e-3);
    let [_, unloading] = both(&flat(12), &periodic, law, ContactTarget::AreaFraction(1.0));
    let stress = law.on(&periodic).unwrap().stress();
    assert!((unloading.pull_off() / stress - 1.0).abs() < 1e-9, "{}", unloading.pull_off());
}

/// The same with long cells, whose nodes turn unstable one behind the other at one instant, so that what rounding makes
/// of the first could grow up to the last, whatever the windows are.
#[test]
fn flat_surfaces_of_long_cells() {
    let sizes = [1, 2, 9, 40].map(Some);
    let shapes = [(8, 1), (32, 1), (64, 1), (9, 7)].map(|shape| (shape, &sizes[..]));
    for ((nodes, rows), sizes) in shapes.into_iter().chain([
        ((16, 16), &[Some(1), Some(5), None][..]),
        ((24, 24), &[None]),
        ((40, 10), &[None]),
    ]) {
        let grid = Grid::new(nodes, rows, 7.0, 1.0).unwrap();
        let kernel = PeriodicBoussinesq::new(grid, 1.0).unwrap();
        let surface = HeightMap::new(DMatrix::zeros(nodes, rows)).unwrap();
        for &size in sizes {
            let law = Adhesion::work(1e-3);
            let builder = AdhesivePath::builder(&surface, &kernel, law);
            let builder = size.into_iter().fold(builder, |builder, size| builder.window_size(size));
            let mut path = builder.until(ContactTarget::AreaFraction(1.0)).build().unwrap();
            path.run().unwrap();
            path.unload().unwrap();
            let unloading = path.run().unwrap();
            let force = path.law().stress() * grid.nominal_area();
            let part = unloading.pull_off() / force;
            assert!((part - 1.0).abs() < 1e-9, "{nodes} {size:?}: {part}");
            let state = unloading.states().last().unwrap();
            let apart = (state.contact.contact_nodes, state.soft_nodes, state.contact.load);
            assert_eq!(apart, (0, 0, 0.0), "{nodes} {size:?}: {state:?}");
            // As the driver asks of energies: rounding, with three digits to spare.
            let work = path.law().work() * grid.nominal_area();
            let left = state.work - state.contact.energy - state.dissipated;
            assert!(left.abs() < 1e-9 * work, "{nodes} {size:?}: {left:e} of {work:e}");
        }
    }
}

/// A flat cylinder comes to Kendall's force, √(8π E* w a³), from below as the cells, and with them the range, become
/// shorter.
#[test]
fn flat_cylinder() {
    let parts = [(12, 0.8), (24, 0.85), (36, 0.91)].map(|(nodes, least)| {
        let kernel = Boussinesq::new(Grid::square(nodes, 1.0).unwrap(), 1.0).unwrap();
        let (law, end) = (Adhesion::work(1e-3), ContactTarget::Approach(0.02));
        let [_, unloading] = both(&punch(nodes), &kernel, law, end);
        let part = unloading.pull_off() / (8.0 * std::f64::consts::PI * 0.064 * 1e-3_f64).sqrt();
        assert!(part > least && part < 1.0, "{nodes}: {part}");
        part
    });
    assert!(parts.is_sorted(), "{parts:?}");
}

/// Four equal tiles on a periodic half-space, without jumps, which depend on the gauge: every event comes four times,
/// and carries as much as one.
#[test]
fn equal_tiles() {
    let tile = SelfAffine::new(0.8, 0.5, 0.25, Amplitude::RmsHeight(0.02), 3).unwrap();
    let one = HeightMap::sample(&tile, &Grid::square(12, 1.0).unwrap()).unwrap();
    let four = HeightMap::new(DMatrix::from_fn(24, 24, |i, j| one.matrix()[(i % 12, j % 12)]));
    let law = Adhesion::work(3e-5).range(4.5e-3);
    let [small, large] =
        [(1.0, 12, one), (2.0, 24, four.unwrap())].map(|(side, nodes, surface)| {
            let kernel = PeriodicBoussinesq::new(Grid::square(nodes, side).unwrap(), 1.0).unwrap();
            both(&surface, &kernel, law, ContactTarget::MeanPressure(5e-3))
        });
    for (small, large) in small.iter().zip(&large) {
        assert!(small.states().iter().all(|state| state.event != AdhesiveEvent::JumpStart));
        assert!((large.pull_off() / small.pull_off() - 4.0).abs() < 1e-9);
        let events = |branch: &AdhesiveBranch| {
            branch.states().iter().filter(|state| state.event != AdhesiveEvent::Limit).count()
        };
        assert_eq!(events(large), 4 * events(small));
    }
}

/// The same path in metres and newtons, and in others.
#[test]
fn units_do_not_matter() {
    let law = |length: f64, pressure: f64| Adhesion::work(3e-4 * length * pressure);
    let branches = [(1.0, 1.0), (1e-6, 1e11), (1e3, 1e-4)].map(|(length, pressure)| {
        let kernel = Boussinesq::new(Grid::square(20, length).unwrap(), pressure).unwrap();
        let rms = Amplitude::RmsHeight(0.015 * length);
        let surface = SelfAffine::new(0.8, 0.5 * length, 0.2 * length, rms, 8).unwrap();
        let load = ContactTarget::Load(4e-3 * length * length * pressure);
        (both(&surface, &kernel, law(length, pressure), load), length * length * pressure)
    });
    let (expected, _) = &branches[0];
    for (found, force) in &branches[1..] {
        for (found, expected) in found.iter().zip(expected) {
            assert_eq!(found.states().len(), expected.states().len());
            for (found, expected) in found.states().iter().zip(expected.states()) {
                assert_eq!((found.event, found.node), (expected.event, expected.node));
                let load = found.contact.load / force;
                assert!((load - expected.contact.load).abs() < 1e-12, "{load} {expected:?}");
            }
        }
    }
}

/// A row of nodes, and cells that are long.
#[test]
fn strips_and_long_cells() {
    for (nx, ny, dx, dy) in [(40, 1, 1.0, 1.0), (24, 3, 1.0, 8.0), (2, 30, 5.0, 1.0)] {
        let grid = Grid::new(nx, ny, dx, dy).unwrap();
        let heights =
            DMatrix::from_fn(nx, ny, |i, j| (1.7 * i as f64 + 0.9 * j as f64).sin() * 0.3);
        let surface = HeightMap::new(heights).unwrap();
        for kernel in [
            &Boussinesq::new(grid, 1.0).unwrap() as &dyn InfluenceKernel,
            &PeriodicBoussinesq::new(grid, 1.0).unwrap(),
        ] {
            let [loading, unloading] =
                both(&surface, kernel, Adhesion::work(5e-3), ContactTarget::AreaFraction(1.0));
            assert_eq!(loading.states().last().unwrap().contact.contact_area_fraction, 1.0);
            let last = unloading.states().last().unwrap();
            assert_eq!((last.contact.load, last.soft_nodes), (0.0, 0));
            assert!((last.work - last.dissipated).abs() < 1e-12 * 5e-3 * grid.nominal_area());
        }
    }
}

/// Beside a range of 10¹³ heights no digit of these is left, and the square of the greatest ranges is no number: both are
/// refused. A long range alone changes nothing but the pull.
#[test]
fn ranges_beside_which_heights_are_rounding() {
    let kernel = Boussinesq::new(Grid::square(8, 8e-3).unwrap(), 1e9).unwrap();
    let heights = DMatrix::from_fn(8, 8, |ix, iy| 1e-6 * ((5 * ix + 3 * iy) % 7) as f64);
    let surface = HeightMap::new(heights).unwrap();
    let last = |range: f64| {
        let law = Adhesion::work(0.05).range(range);
        let mut path = AdhesivePath::builder(&surface, &kernel, law).build()?;
        Ok::<f64, Error>(path.run()?.states().last().unwrap().contact.load)
    };
    // The pull is 0.1 Pa and less; lengths of 10⁻⁶ m are known to 10⁻¹⁰ of 1 m, and to 10⁻⁷ of 100 m.
    let [near, far] = [1.0, 100.0].map(|range| last(range).unwrap());
    assert!((far / near - 1.0).abs() < 1e-6, "{near} {far}");
    for range in [1e7, 1e20, 1e150, 1e160, 1e300] {
        let refused = last(range);
        assert!(matches!(refused, Err(Error::OutOfRange { .. })), "{range:e}: {refused:?}");
    }
}
