//! Paths that stop, are read, cut and put together, where there is more than one way to take it.

use asperity::bed::Bed;
use asperity::kernel::KernelTable;
use asperity::loading::{ContactEvent, History, LoadingEnd};
use asperity::record::LoadingRecord;
use asperity::surface::{HeightMap, Paraboloid};
use asperity::updater::ConjugateGradient;
use asperity::{
    Boundary, Boussinesq, ContactGrowth, ContactTarget, Error, Grid, InfluenceKernel,
    LoadingSolver, LoadingState, PeriodicBoussinesq, Spectral,
};
use asperity_testing::surfaces::{scattered, self_affine};
use nalgebra::DMatrix;

fn grid() -> Grid {
    Grid::square(16, 1e-3).unwrap()
}

fn half_space() -> Boussinesq {
    Boussinesq::new(grid(), 1e9).unwrap()
}

fn rough() -> HeightMap {
    self_affine(&grid(), 0.8, 1e-6, 3)
}

/// A path with limits on its way is put together from its parts: the states at the limits are left out where others
/// follow, and the whole is a record.
#[test]
fn histories_leave_limits_out() {
    let (surface, kernel) = (rough(), half_space());
    let whole = LoadingSolver::new(&surface, &kernel).unwrap().run().unwrap();
    let mut path = LoadingSolver::new(&surface, &kernel).unwrap();
    let mut all = History::default();
    for load in [0.1, 0.5, 0.7] {
        let load = load * whole.states()[200].contact.load;
        path.continue_to(ContactTarget::Load(load)).unwrap();
        all.extend(path.run().unwrap().states().iter().copied());
        assert_eq!(all.states().last().unwrap().event, ContactEvent::Limit);
        let record = LoadingRecord::new(&path, all.clone()).unwrap();
        assert_eq!(record.end(), Some(LoadingEnd::Load));
    }
    let limits = all.states().iter().filter(|state| state.event == ContactEvent::Limit);
    assert_eq!(limits.count(), 1);
    assert_eq!(all.events(), &whole.states()[..all.events().len()]);
    all.extend([]);
    assert_eq!(all.states().last().unwrap().event, ContactEvent::Limit);
}

/// A record of some states of a path that has ended goes on.
#[test]
fn a_part_of_a_path_has_not_ended() {
    let (surface, kernel) = (rough(), half_space());
    let mut path = LoadingSolver::new(&surface, &kernel).unwrap();
    let whole = path.run().unwrap();
    let of = |count: usize| {
        let part: History = whole.states()[..count].iter().copied().collect();
        LoadingRecord::new(&path, part).unwrap()
    };
    assert_eq!(of(256).end(), Some(LoadingEnd::FullContact));
    assert_eq!(of(100).end(), None);
    assert_eq!(of(100).resume().unwrap().run().unwrap().states().len(), 156);
}

/// No gap is left at the beginning of full contact, and not only once all nodes have yielded.
#[test]
fn no_mean_gap_is_full_contact() {
    let (surface, kernel) = (rough(), half_space());
    let elastic = LoadingSolver::new(&surface, &kernel).unwrap().run().unwrap();
    let full = elastic.states().last().unwrap().contact;
    let hardness = 1.5 * full.load / full.nominal_area;
    let builder = || LoadingSolver::builder(&surface, &kernel).hardness(hardness);
    let whole = builder().build().unwrap().run().unwrap();
    let is_full = |state: &&LoadingState| state.contact.contact_area_fraction == 1.0;
    let first = *whole.states().iter().find(is_full).unwrap();
    assert!(whole.states().last().unwrap().step > first.step + 10);
    assert_eq!(whole.at_mean_gap(0.0), Some(first));
    let mut path = builder().min_mean_gap(0.0).build().unwrap();
    let states = path.run().unwrap();
    assert_eq!((path.end(), states.states().last()), (Some(LoadingEnd::MeanGap), Some(&first)));
}

/// An elastic path that presses more than a hardness is none of that hardness.
#[test]
fn elastic_states_above_a_hardness_are_refused() {
    let (surface, kernel) = (rough(), half_space());
    let mut path = LoadingSolver::builder(&surface, &kernel).max_nodes(120).build().unwrap();
    let history = path.run().unwrap();
    let greatest = path.fields().unwrap().max_pressure();
    let states: History = history.states().iter().copied().collect();
    for history in [&history, &states] {
        let resumed = |hardness: f64| {
            LoadingSolver::builder(&surface, &kernel).hardness(hardness).resume(history)
        };
        let refused = resumed(0.5 * greatest).map(|_| ());
        let quantity = "greatest pressure above the hardness";
        let is_so = matches!(&refused, Err(Error::NotOnPath { quantity: q, .. }) if *q == quantity);
        assert!(is_so, "{refused:?}");
        assert!(resumed(2.0 * greatest).is_ok());
    }
}

/// Where no event is left and not all nodes touch, everything is linear: the path ends at the load that was asked for.
#[test]
fn limits_behind_the_last_event_are_reached() {
    // Between two nodes that carry a third one, a gap does not close.
    let grid = Grid::new(5, 1, 1.0, 1.0).unwrap();
    let coefficient = |di: isize, _| [1.0, 0.5, 0.0, 0.0, 0.0][di.unsigned_abs()];
    let kernel =
        KernelTable::from_fn(grid, Boundary::Free, ContactGrowth::Unknown, coefficient).unwrap();
    let gaps = [0.1, 0.0, 0.2, 50.0, 5.0];
    let heights = HeightMap::new(DMatrix::from_fn(5, 1, |ix, _| -gaps[ix])).unwrap();
    let builder = || LoadingSolver::builder(&heights, &kernel);
    let mut path = builder().build().unwrap();
    let last = *path.run().unwrap().states().last().unwrap();
    assert_eq!(path.end(), Some(LoadingEnd::NoMoreEvents));
    let rate = last.contact.contact_stiffness.unwrap();
    let (load, approach) = (3.0 * last.contact.load, 2.0 * last.contact.approach);
    let at_load = last.contact.approach + 2.0 * last.contact.load / rate;
    let at_approach = last.contact.load + rate * last.contact.approach;
    for (builder, end, expected) in [
        (builder().max_load(load), LoadingEnd::Load, [load, at_load]),
        (builder().max_approach(approach), LoadingEnd::Approach, [at_approach, approach]),
    ] {
        let mut path = builder.build().unwrap();
        let found = *path.run().unwrap().states().last().unwrap();
        assert_eq!((path.end(), found.event), (Some(end), ContactEvent::Limit));
        for (found, expected) in [found.contact.load, found.contact.approach].iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < 1e-14, "{found} {expected}");
        }
        assert!(path.certificate().unwrap().greatest_contact_gap < 1e-12);
        path.verify().unwrap();
    }
}

/// Behind the last event gaps may open: a mean gap that the path has not come to is not reached, and hides no load.
#[test]
fn mean_gaps_behind_the_last_event_are_not_reached() {
    let grid = Grid::new(3, 1, 1.0, 1.0).unwrap();
    let coefficient = |di: isize, _| [1.0, 0.6, 0.1][di.unsigned_abs()];
    let kernel =
        KernelTable::from_fn(grid, Boundary::Free, ContactGrowth::Unknown, coefficient).unwrap();
    let gaps = [0.0, 5.0, 0.1];
    let heights = HeightMap::new(DMatrix::from_fn(3, 1, |ix, _| -gaps[ix])).unwrap();
    let builder = || LoadingSolver::builder(&heights, &kernel).min_mean_gap(1.0);
    let mut path = builder().build().unwrap();
    let last = *path.run().unwrap().states().last().unwrap();
    assert_eq!((path.end(), last.step), (Some(LoadingEnd::NoMoreEvents), 2));
    assert!(last.contact.interfacial_stiffness.unwrap() < 0.0 && last.contact.mean_gap > 1.0);
    let mut path = builder().max_load(1.0).build().unwrap();
    let loaded = *path.run().unwrap().states().last().unwrap();
    assert_eq!((path.end(), loaded.contact.load), (Some(LoadingEnd::Load), 1.0));
    assert!(loaded.contact.mean_gap > last.contact.mean_gap);
}

/// Nodes that tie are solved for one by one where a kernel promises nothing: what rounds there is no path that falls.
#[test]
fn ties_of_unknown_growth_are_a_bed() {
    let grid = Grid::square(12, 1.0).unwrap();
    let love = Boussinesq::new(grid, 1.0).unwrap();
    let coefficient = |di, dj| love.coefficient(di, dj);
    let kernel =
        KernelTable::from_fn(grid, Boundary::Free, ContactGrowth::Unknown, coefficient).unwrap();
    let sphere = Paraboloid::new(10.0).unwrap();
    let mut path = LoadingSolver::builder(&sphere, &kernel)
        .updater(ConjugateGradient::default())
        .build()
        .unwrap();
    let history = path.run().unwrap();
    assert_eq!(history.states().len(), 144);
    let bed = Bed::new(&history).unwrap();
    let knots = bed.loads().windows(2).zip(bed.approaches().windows(2));
    assert!(
        knots
            .zip(bed.mean_gaps().windows(2))
            .all(|((w, d), gap)| { w[0] <= w[1] && d[0] <= d[1] && gap[0] >= gap[1] })
    );
    // A load that truly falls is refused.
    let mut states = history.states().to_vec();
    states[80].contact.load *= 1.0 - 1e-6;
    states[80].contact.load = states[80].contact.load.min((1.0 - 1e-6) * states[79].contact.load);
    assert!(Bed::new(&states.into_iter().collect()).is_err());
}

/// Fields of earlier states, where nodes have left since, are those of a factor on a path without one, too.
#[test]
fn fields_before_a_release_are_those_of_a_factor() {
    use asperity::kernel::{Base, Layer, Layered, LayeredBody};
    let grid = Grid::square(48, 48e-6).unwrap();
    let coat = Layer { youngs_modulus: 500e9, poissons_ratio: 0.2, thickness: 4e-6 };
    let base = Base::HalfSpace { youngs_modulus: 5e9, poissons_ratio: 0.35 };
    let body = LayeredBody::new(&[coat], base).unwrap();
    let kernel = Layered::free(grid, body).unwrap();
    assert_eq!(kernel.contact_growth(), ContactGrowth::Unknown);
    let surface = self_affine(&grid, 0.8, 1e-7, 5);
    let builder = || LoadingSolver::builder(&surface, &kernel).max_area_fraction(0.4);
    let mut direct = builder().build().unwrap();
    let mut iterated = builder().updater(ConjugateGradient::default()).build().unwrap();
    let states = iterated.run().unwrap();
    let exact = direct.run().unwrap();
    let releases: Vec<usize> = (0..states.states().len())
        .filter(|&k| states.states()[k].event == ContactEvent::Release)
        .collect();
    assert!(releases.len() > 3, "{}", releases.len());
    let last = *releases.last().unwrap();
    for k in [last / 3, last / 2, last - 1] {
        let state = states.states()[k];
        let found = iterated.fields_at(&state).unwrap();
        let expected = direct.fields_at(&exact.states()[k]).unwrap();
        let most = expected.pressure.max();
        let error = (found.pressure - expected.pressure).abs().max() / most;
        // The tolerance of iterations, 10⁻¹⁰ of the approach, times a condition of some hundred.
        assert!(error < 1e-7, "{k}: {error:e}");
    }
}

/// A record knows the gauge of its kernel.
#[test]
fn records_know_the_gauge() {
    let surface = rough();
    let love = PeriodicBoussinesq::new(grid(), 1e9).unwrap();
    let waves = Spectral::new(grid(), 1e9).unwrap();
    let kernels: [Box<dyn InfluenceKernel>; 3] = [
        Box::new(love.clone().with_gauge(5.0 * love.gauge()).unwrap()),
        Box::new(waves.clone().with_gauge(20.0 * waves.gauge()).unwrap()),
        Box::new(love.clone().with_gauge(0.0).unwrap()),
    ];
    for kernel in kernels {
        let whole = LoadingSolver::new(&surface, &kernel).unwrap().run().unwrap();
        let mut path = LoadingSolver::new(&surface, &kernel).unwrap();
        let history: History = path.by_ref().take(130).map(Result::unwrap).collect();
        let record = LoadingRecord::new(&path, history).unwrap();
        let rest = record.resume().unwrap().run().unwrap();
        assert_eq!(rest.states().len(), 126);
        for (found, expected) in rest.states().iter().zip(&whole.states()[130..]) {
            assert_eq!(found.node, expected.node);
            let error = found.contact.load / expected.contact.load - 1.0;
            // Rounding times the gauge over a cell's own displacement and the condition.
            assert!(error.abs() < 1e-10, "{error:e}");
        }
    }
}

/// Where nodes that tie close the contact, rounding leaves no mean gap below 0, before which a path would end, and the
/// path is a bed.
#[test]
fn ties_close_the_contact() {
    use asperity::kernel::{Base, Layer, Layered, LayeredBody};
    let (mut full, mut grown) = (0, 0);
    for seed in 0..40 {
        let grid = Grid::new(6, 7, 1.0, 1.0).unwrap();
        // In steps, and the same from either side.
        let steps = scattered(grid.shape(), 23, seed) / 300.0;
        let mirrored = DMatrix::from_fn(6, 7, |ix, iy| steps[(ix, iy)] + steps[(5 - ix, iy)]);
        let surface = HeightMap::new(mirrored).unwrap();
        let youngs_modulus = [10.0, 100.0, 1000.0][seed % 3];
        let coat = Layer { youngs_modulus, poissons_ratio: 0.3, thickness: 0.2 };
        let base = Base::HalfSpace { youngs_modulus: 1.0, poissons_ratio: 0.3 };
        let kernel = Layered::periodic(grid, LayeredBody::new(&[coat], base).unwrap()).unwrap();
        let builder =
            || LoadingSolver::builder(&surface, &kernel).updater(ConjugateGradient::default());
        let history = builder().build().unwrap().run().unwrap();
        assert!(history.states().iter().all(|state| state.contact.mean_gap >= 0.0), "{seed}");
        let mut path = builder().min_mean_gap(0.0).build().unwrap();
        let closed = path.run().unwrap();
        let nodes = |history: &History| history.states().last().unwrap().contact.contact_nodes;
        assert_eq!(nodes(&closed), nodes(&history), "{seed}");
        full += usize::from(nodes(&history) == 42);
        if history.states().iter().all(|state| state.event == ContactEvent::Touch) {
            grown += 1;
            Bed::new(&history).unwrap();
        }
    }
    assert!(full >= 20 && grown >= 10, "{full} {grown}");
}
