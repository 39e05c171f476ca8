//! Records of paths in whatever state they are, and what a branch may be asked for from there.

use asperity::adhesion::{
    Adhesion, AdhesiveBranch, AdhesiveEnd, AdhesiveEvent, AdhesivePath, Direction,
};
use asperity::record::AdhesiveRecord;
use asperity::surface::{Amplitude, SelfAffine};
use asperity::{
    AdhesionError, ContactTarget, Error, Grid, InfluenceKernel, PeriodicBoussinesq, Spectral,
};

const N: usize = 16;

fn surface() -> SelfAffine {
    SelfAffine::new(0.8, 0.5, 0.25, Amplitude::RmsHeight(0.02), 5).unwrap()
}

fn grid() -> Grid {
    Grid::square(N, 1.0).unwrap()
}

/// A path on which nodes jump.
fn path_on(kernel: &dyn InfluenceKernel) -> AdhesivePath {
    AdhesivePath::builder(&surface(), kernel, Adhesion::work(1e-3)).build().unwrap()
}

fn periodic() -> PeriodicBoussinesq {
    PeriodicBoussinesq::new(grid(), 1.0).unwrap()
}

/// Pressed on up to a mean pressure, and pulled off.
fn both(path: &mut AdhesivePath) -> AdhesiveBranch {
    path.load_to(ContactTarget::AreaFraction(0.4)).unwrap();
    let mut states = path.run().unwrap();
    path.unload().unwrap();
    states.extend(path.run().unwrap().states().iter().copied());
    states
}

/// Loads differ by solutions whose condition is some 10³ at most.
fn assert_same(found: &AdhesiveBranch, expected: &AdhesiveBranch) {
    let most = expected.states().iter().map(|state| state.contact.load.abs()).fold(0.0, f64::max);
    assert_eq!(found.states().len(), expected.states().len());
    for (a, b) in found.states().iter().zip(expected.states()) {
        assert_eq!((a.step, a.event, a.node), (b.step, b.event, b.node));
        assert!((a.contact.load - b.contact.load).abs() < 1e-10 * most, "{a:?} {b:?}");
    }
}

/// A path that was interrupted where a jump begins goes on to its end: the beginning is no event once more.
#[test]
fn jumps_begin_once() {
    let whole = both(&mut path_on(&periodic()));
    let starts: Vec<usize> = (0..whole.states().len())
        .filter(|&k| whole.states()[k].event == AdhesiveEvent::JumpStart)
        .collect();
    assert!(starts.len() > 3, "{}", starts.len());
    for start in starts {
        let mut path = path_on(&periodic());
        path.load_to(ContactTarget::AreaFraction(0.4)).unwrap();
        let mut states = AdhesiveBranch::default();
        let turn =
            whole.states().iter().filter(|state| state.direction == Direction::Loading).count();
        if start >= turn {
            states = path.run().unwrap();
            path.unload().unwrap();
        }
        states.extend(path.by_ref().take(start + 1 - states.states().len()).map(Result::unwrap));
        assert_eq!(states.states().last().unwrap().event, AdhesiveEvent::JumpStart);
        let record = AdhesiveRecord::new(&path, states.clone()).unwrap();
        for mut path in [path, record.path().unwrap()] {
            let mut all = states.clone();
            all.extend(path.run().unwrap().states().iter().copied());
            if start < turn {
                path.unload().unwrap();
                all.extend(path.run().unwrap().states().iter().copied());
            }
            assert_same(&all, &whole);
        }
    }
}

/// A record knows the gauge of its kernel, in which the approach is held during jumps.
#[test]
fn records_know_the_gauge() {
    let spectral = Spectral::new(grid(), 1.0).unwrap();
    let kernels: [Box<dyn InfluenceKernel>; 2] = [
        Box::new(periodic().with_gauge(2.0 * periodic().gauge()).unwrap()),
        Box::new(spectral.clone().with_gauge(3.0 * spectral.gauge()).unwrap()),
    ];
    for kernel in kernels {
        let whole = both(&mut path_on(&*kernel));
        for part in [3, 2] {
            let mut path = path_on(&*kernel);
            path.load_to(ContactTarget::AreaFraction(0.4)).unwrap();
            let count = whole.states().len() / (2 * part);
            let mut states: AdhesiveBranch =
                path.by_ref().take(count).map(Result::unwrap).collect();
            let mut again = AdhesiveRecord::new(&path, states.clone()).unwrap().path().unwrap();
            states.extend(again.run().unwrap().states().iter().copied());
            again.unload().unwrap();
            states.extend(again.run().unwrap().states().iter().copied());
            assert_same(&states, &whole);
        }
    }
}

/// Where unloading is to end need not be ahead of where the surfaces are apart.
#[test]
fn records_of_unloading_open() {
    let mut path = path_on(&periodic());
    path.load_to(ContactTarget::AreaFraction(0.4)).unwrap();
    let mut states = path.run().unwrap();
    let apart = states.states()[0].contact.mean_gap;
    for target in
        [ContactTarget::MeanGap(2.0 * apart), ContactTarget::Approach(-20.0 * path.law().range())]
    {
        path.unload_to(target).unwrap();
        states.extend(path.by_ref().take(2).map(Result::unwrap));
        let mut again = AdhesiveRecord::new(&path, states.clone()).unwrap().path().unwrap();
        let (rest, expected) = (again.run().unwrap(), path.run().unwrap());
        assert_same(&rest, &expected);
        assert_eq!(again.end(), path.end());
        assert_eq!(again.state().unwrap().contact.contact_nodes, 0);
        states.extend(expected.states().iter().copied());
    }
}

/// Surfaces that are drawn together bear no load again once they are in contact, and this is the contact without load.
#[test]
fn no_load_is_that_of_contact() {
    let kernel = asperity::Boussinesq::new(grid(), 1.0).unwrap();
    let mut path = AdhesivePath::builder(&surface(), &kernel, Adhesion::work(1e-3))
        .until(ContactTarget::Load(0.0))
        .build()
        .unwrap();
    let states = path.run().unwrap();
    let last = states.states().last().unwrap();
    assert_eq!((path.end(), last.event), (Some(AdhesiveEnd::Target), AdhesiveEvent::Limit));
    assert_eq!(last.contact.load, 0.0);
    assert!(last.contact.contact_nodes > 0 && states.pull_off() > 0.0, "{last:?}");
}

/// A branch may come back to the area at which it turned around, also where that is no whole number of nodes.
#[test]
fn areas_are_numbers_of_nodes() {
    let mut path = path_on(&periodic());
    // 76.8 nodes.
    path.load_to(ContactTarget::AreaFraction(0.3)).unwrap();
    let reached = path.run().unwrap().states().last().unwrap().contact.contact_nodes;
    assert_eq!(reached, 76);
    for target in [0.3, 76.0 / 256.0] {
        path.unload_to(ContactTarget::AreaFraction(target)).unwrap();
        path.load_to(ContactTarget::AreaFraction(target)).unwrap();
    }
    let ahead = path.unload_to(ContactTarget::AreaFraction(0.31));
    let refused = matches!(ahead, Err(Error::Adhesion(AdhesionError::Behind { .. })));
    assert!(refused, "{ahead:?}");
}

/// A path that has failed has not come to its target, nor has its record.
#[test]
fn a_path_that_failed_goes_on_from_its_record() {
    let (surface, kernel) = (surface(), periodic());
    let target = ContactTarget::AreaFraction(0.9);
    let builder = || AdhesivePath::builder(&surface, &kernel, Adhesion::work(1e-3)).until(target);
    let whole = builder().build().unwrap().run().unwrap();
    // In windows that do not fit some time.
    let mut paths = (10..).map(|k| builder().memory_budget(k << 12).build());
    let (path, states) = paths
        .find_map(|path| {
            let mut path = path.ok()?;
            let states: AdhesiveBranch = path.by_ref().map_while(Result::ok).collect();
            (states.states().len() > 20).then_some((path, states))
        })
        .unwrap();
    assert_eq!(path.end(), Some(AdhesiveEnd::Failed));
    assert!(states.states().len() < whole.states().len());
    let mut path = AdhesiveRecord::new(&path, states.clone()).unwrap().path().unwrap();
    assert_eq!(path.end(), None);
    let mut all = states;
    all.extend(path.run().unwrap().states().iter().copied());
    assert_same(&all, &whole);
    assert_eq!(path.end(), Some(AdhesiveEnd::Target));
}

/// A record of a path that has turned around, and has no state there yet, goes on the way it has turned to.
#[cfg(feature = "io")]
#[test]
fn records_know_which_way_a_path_goes() {
    for work in [1e-3, 0.0] {
        let (surface, kernel) = (surface(), periodic());
        let builder = AdhesivePath::builder(&surface, &kernel, Adhesion::work(work));
        let mut path = builder.until(ContactTarget::AreaFraction(0.4)).build().unwrap();
        let states = path.run().unwrap();
        let least = 0.2 * states.states().last().unwrap().contact.contact_area_fraction;
        for target in [Some(ContactTarget::AreaFraction(least)), None] {
            match target {
                Some(target) => path.unload_to(target).unwrap(),
                None => path.unload().unwrap(),
            }
            let record = AdhesiveRecord::new(&path, states.clone()).unwrap();
            let file = std::env::temp_dir().join(format!("turned-{}.npz", std::process::id()));
            record.write_npz(&file, &[]).unwrap();
            let read = AdhesiveRecord::read_npz(&file).unwrap();
            std::fs::remove_file(file).unwrap();
            let mut expected = record.path().unwrap();
            let mut again = read.path().unwrap();
            assert_eq!(again.run().unwrap(), expected.run().unwrap());
            let last = again.state().unwrap();
            assert_eq!(last.direction, Direction::Unloading);
            assert!(last.contact.contact_area_fraction <= least, "{last:?}");
        }
    }
}

/// The energies of a stiff body that is flat but for its roughness are small beside those in the gauge.
#[test]
fn great_pressures_on_mean_planes_are_a_record() {
    let kernel = PeriodicBoussinesq::new(Grid::square(N, 1e-2).unwrap(), 1e11).unwrap();
    let height = Amplitude::RmsHeight(1e-9);
    let surface = SelfAffine::new(0.8, 0.5e-2, 0.25e-2, height, 5).unwrap();
    for (work, pressure) in [(1e-3, 1e9), (1e-2, 3e9)] {
        let mut path = AdhesivePath::builder(&surface, &kernel, Adhesion::work(work))
            .until(ContactTarget::MeanPressure(pressure))
            .build()
            .unwrap();
        let states = path.run().unwrap();
        let record = AdhesiveRecord::new(&path, states).unwrap();
        assert_eq!(record.path().unwrap().state(), path.state());
    }
}
