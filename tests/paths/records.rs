//! Records of paths: read, replayed, and gone on from.

use crate::problems::{grid, kernels, rough};
use asperity::loading::{ContactEvent, History};
use asperity::record::{KernelRecord, LoadingRecord};
use asperity::surface::{HeightMap, Topography};
use asperity::updater::{ConjugateGradient, Handover, LinearUpdater, RecursiveCholesky};
use asperity::{
    Boundary, Boussinesq, ContactRule, ContactTarget, Error, FixedLoadSolver, Grid,
    InfluenceKernel, LoadingSolver, LoadingState, PeriodicBoussinesq, Spectral,
};
use asperity_testing::assert_relative;
use asperity_testing::close::assert_close;
use nalgebra::DMatrix;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Records of a path cut at a state.
fn cut(path: &LoadingSolver<RecursiveCholesky>, all: &[LoadingState], at: usize) -> LoadingRecord {
    let history: History = all[..at].iter().copied().collect();
    LoadingRecord::new(path, history).unwrap()
}

fn whole<U: LinearUpdater>(
    kernel: &dyn InfluenceKernel,
    updater: U,
) -> (LoadingSolver<U>, Vec<LoadingState>) {
    let surface = rough(&kernel.grid(), 5);
    let mut path = LoadingSolver::builder(&surface, kernel).updater(updater).build().unwrap();
    let all = path.by_ref().map(Result::unwrap).collect();
    (path, all)
}

/// Resumed anywhere, with any updater, a path has the events of one that was never interrupted. States of a
/// factor agree to rounding; 1e-10 is what the whole crate promises of columns.
#[test]
fn resumed_paths_are_uninterrupted_ones() {
    for (name, kernel) in kernels(grid()) {
        let (path, all) = whole(&*kernel, RecursiveCholesky::new());
        for at in [1, 2, 60, 200, all.len() - 1] {
            let record = cut(&path, &all, at);
            let surface = record.heights().clone();
            let resumed = LoadingSolver::builder(&surface, &*kernel)
                .updater(RecursiveCholesky::new())
                .resume(record.history())
                .unwrap();
            assert_eq!(resumed.state(), Some(all[at - 1]));
            let rest: Vec<LoadingState> = resumed.map(Result::unwrap).collect();
            assert_eq!(rest.len(), all.len() - at, "{name} {at}");
            for (found, expected) in rest.iter().zip(&all[at..]) {
                assert_eq!(found.node, expected.node, "{name} {at}");
                assert_close(found, expected, 1e-10, all[0].contact.mean_gap);
            }
        }
    }
}

/// The fields of a state are the same bits whatever was asked before.
#[test]
fn answers_do_not_depend_on_earlier_questions() {
    let kernel = PeriodicBoussinesq::new(Grid::square(48, 1e-3).unwrap(), 1e9).unwrap();
    let (path, all) = whole(&kernel, RecursiveCholesky::new());
    let record = cut(&path, &all, all.len() / 2);
    let mut asked = record.replay().unwrap();
    for at in [300, 310, 700, 720, 750, 1000, 1040] {
        let found = asked.fields_at(&all[at]).unwrap();
        let alone = record.replay().unwrap().fields_at(&all[at]).unwrap();
        assert_eq!((found.pressure, found.gap), (alone.pressure, alone.gap), "{at}");
    }
}

/// A path that was made again from states alone has begun no window. Its record goes on from the states too.
#[test]
fn paths_made_again_are_recorded_before_they_go_on() {
    for (name, kernel) in kernels(grid()) {
        let (path, all) = whole(&*kernel, RecursiveCholesky::new());
        let record = cut(&path, &all, 60);
        let surface = record.heights().clone();
        let builder =
            || LoadingSolver::builder(&surface, &*kernel).updater(RecursiveCholesky::new());
        let again = builder().resume(record.history()).unwrap();
        let again = LoadingRecord::new(&again, record.history().clone()).unwrap();
        let rest = builder().resume(again.history()).unwrap();
        let rest: Vec<LoadingState> = rest.map(Result::unwrap).collect();
        assert_eq!(rest.len(), all.len() - 60, "{name}");
        for (found, expected) in rest.iter().zip(&all[60..]) {
            assert_close(found, expected, 1e-10, all[0].contact.mean_gap);
        }
    }
}

/// Without a factor the nodes are the same.
#[test]
fn paths_without_a_factor_go_on_at_the_same_nodes() {
    let kernel = Boussinesq::new(grid(), 1e9).unwrap();
    let (path, all) = whole(&kernel, RecursiveCholesky::new());
    for at in [3, 100, 250] {
        let record = cut(&path, &all, at);
        let resumed = LoadingSolver::builder(record.heights(), &kernel)
            .updater(ConjugateGradient::new())
            .resume(record.history())
            .unwrap();
        let nodes: Vec<_> = resumed.map(|state| state.unwrap().node).collect();
        let expected: Vec<_> = all[at..].iter().map(|state| state.node).collect();
        assert_eq!(nodes, expected);
    }
}

/// Tops that are equal but for rounding: any of them may touch first, and the record knows which.
#[test]
fn paths_from_one_of_equal_tops_are_recorded() {
    fn check<U: LinearUpdater>(updater: impl Fn() -> U) {
        let grid = Grid::square(48, 1e-3).unwrap();
        let wave = |place: usize, nodes: usize| {
            libm::cos(std::f64::consts::TAU * (place % nodes) as f64 / nodes as f64)
        };
        let mut heights = DMatrix::from_fn(48, 48, |ix, iy| 1e-6 * (wave(ix, 12) + wave(iy, 8)));
        heights[(0, 0)] = heights[(0, 0)].next_down();
        let surface = Topography::new(grid, heights).unwrap();
        let kernels: [Box<dyn InfluenceKernel>; 2] = [
            Box::new(Boussinesq::new(grid, 115e9).unwrap()),
            Box::new(PeriodicBoussinesq::new(grid, 115e9).unwrap()),
        ];
        for kernel in kernels {
            for hardness in [f64::INFINITY, 2e9] {
                let builder = || {
                    LoadingSolver::builder(&surface, &*kernel).updater(updater()).hardness(hardness)
                };
                let mut path = builder().max_area_fraction(0.1).build().unwrap();
                let history = path.run().unwrap();
                let record = LoadingRecord::new(&path, history).unwrap();
                let mut resumed = builder().resume(record.history()).unwrap();
                let next = resumed.next().unwrap().unwrap();
                assert_eq!(next.step, path.state().unwrap().step + 1);
            }
        }
    }
    check(RecursiveCholesky::new);
    check(ConjugateGradient::new);
    check(Handover::new);
}

#[test]
fn records_make_their_kernel_again() {
    let grid = grid();
    let kernels: [Box<dyn InfluenceKernel>; 3] = [
        Box::new(Boussinesq::new(grid, 1e9).unwrap()),
        Box::new(PeriodicBoussinesq::new(grid, 1e9).unwrap()),
        Box::new(Spectral::new(grid, 1e9).unwrap()),
    ];
    for kernel in kernels {
        let (path, all) = whole(&*kernel, Handover::new());
        let history: History = all[..150].iter().copied().collect();
        let record = LoadingRecord::new(&path, history).unwrap();
        // At 0, 1, half a side and the greatest offset of 18 × 15 nodes.
        let offsets = [0, 1, 9, 17].into_iter();
        let offsets = offsets.flat_map(|di| [0, 1, 7, 14].map(|dj| (di, dj)));
        let expected: Vec<f64> = offsets.map(|(di, dj)| kernel.coefficient(di, dj)).collect();
        assert_eq!(record.kernel().coefficients, expected);
        let mut resumed = record.resume().unwrap();
        resumed
            .continue_to(ContactTarget::Load(0.5 * (all[170].contact.load + all[171].contact.load)))
            .unwrap();
        let last = resumed.by_ref().last().unwrap().unwrap();
        assert_eq!(last.step, 171);
        assert_eq!(record.resume().unwrap().count(), all.len() - 150);
    }
}

/// Fields of any state, from the record alone, are those that the path itself gives.
#[test]
fn records_know_the_fields_of_their_states() {
    let kernel = PeriodicBoussinesq::new(grid(), 1e9).unwrap();
    let (mut path, all) = whole(&kernel, RecursiveCholesky::new());
    let record = cut(&path, &all, 180);
    let mut replay = record.replay().unwrap();
    let history = record.history();
    let between = history.at_load(0.4 * (all[90].contact.load + all[91].contact.load)).unwrap();
    for state in [all[0], all[40], between, all[179]] {
        let expected = path.fields_at(&state).unwrap().pressure;
        let found = replay.fields_at(&state).unwrap().pressure;
        let greatest = expected.max();
        // Iterations end at a residual of 1e-10 of the approach.
        assert!((&found - &expected).amax() <= 1e-7 * greatest);
        let gap = (replay.fields_at(&state).unwrap().gap, path.fields_at(&state).unwrap().gap);
        assert!((gap.0 - gap.1).amax() <= 1e-9 * state.contact.approach.max(1e-9));
        let contact = replay.contact_map_at(&state).unwrap();
        assert_eq!(contact, path.contact_map_at(&state).unwrap());
        assert_eq!(contact.iter().filter(|is_in| **is_in).count(), state.contact.contact_nodes);
    }
    let beyond = replay.fields_at(&all[180]).map(|fields| fields.pressure);
    assert!(matches!(beyond, Err(Error::StateNotReached { .. })));
}

#[test]
fn records_of_other_surfaces_and_kernels_are_refused() {
    let kernel = Boussinesq::new(grid(), 1e9).unwrap();
    let (path, all) = whole(&kernel, RecursiveCholesky::new());
    let record = cut(&path, &all, 120);
    let other = rough(&grid(), 6);
    let resumed = LoadingSolver::builder(&other, &kernel).resume(record.history());
    assert!(matches!(resumed, Err(Error::NotOnPath { .. })));
    let stiffer = Boussinesq::new(grid(), 2e9).unwrap();
    let resumed = LoadingSolver::builder(record.heights(), &stiffer).resume(record.history());
    assert!(matches!(resumed, Err(Error::NotOnPath { .. })));
    let replayed = record.replay_on(&stiffer);
    assert!(matches!(replayed, Err(Error::WrongKernel { .. })));
}

/// A record ends where its path is, or before.
#[test]
fn states_that_are_not_reached_are_not_recorded() {
    let kernel = Boussinesq::new(grid(), 1e9).unwrap();
    let (_, all) = whole(&kernel, RecursiveCholesky::new());
    let mut early = LoadingSolver::new(&rough(&grid(), 5), &kernel).unwrap();
    early.by_ref().take(10).for_each(drop);
    let record = |count: usize| LoadingRecord::new(&early, all[..count].iter().copied().collect());
    assert_eq!(record(10).unwrap().states(), &all[..10]);
    let beyond = record(11);
    assert!(matches!(beyond, Err(Error::StateNotReached { step: 11, present: 10 })), "{beyond:?}");
}

/// Targets that a path has passed are refused behind it. Its record knows the states up to there: those of a path that
/// was to end there.
#[test]
fn targets_that_have_been_passed_are_read_and_not_resumed_to() {
    for (name, kernel) in kernels(grid()) {
        let (path, all) = whole(&*kernel, RecursiveCholesky::new());
        let record = cut(&path, &all, 240);
        let (from, to) = (all[99], all[100]);
        let between =
            |quantity: fn(&LoadingState) -> f64| 0.3 * quantity(&from) + 0.7 * quantity(&to);
        let surface = rough(&grid(), 5);
        for target in [
            ContactTarget::Load(between(|s| s.contact.load)),
            ContactTarget::Approach(between(|s| s.contact.approach)),
            ContactTarget::MeanGap(between(|s| s.contact.mean_gap)),
            ContactTarget::AreaFraction(from.contact.contact_area_fraction),
        ] {
            let builder = || {
                LoadingSolver::builder(&surface, &kernel)
                    .updater(RecursiveCholesky::new())
                    .until(target)
            };
            let refused = builder().resume(record.history());
            assert!(
                matches!(
                    refused,
                    Err(Error::OutOfRange { expected: "beyond the present state", .. })
                ),
                "{name} {target:?}: {refused:?}"
            );
            let mut stopped = builder().build().unwrap();
            let expected: Vec<LoadingState> = stopped.by_ref().map(Result::unwrap).collect();
            let (read, end) = record.history().ending_at(&grid(), &[target]).unwrap();
            assert_eq!(end, stopped.end(), "{name} {target:?}");
            assert_eq!(read.states().len(), expected.len(), "{name} {target:?}");
            for (found, expected) in read.states().iter().zip(&expected) {
                assert_close(found, expected, 1e-10, all[0].contact.mean_gap);
            }
            // To where it has got, a path is resumed, and ends there again.
            let resumed = builder().resume(&read).unwrap();
            assert_eq!(resumed.count(), read.states().len() - read.events().len());
            let (same, end) = read.ending_at(&grid(), &[target]).unwrap();
            assert_eq!((same.states(), end), (read.states(), None));
        }
        // What it has not passed leaves all as it is; what makes no sense is refused.
        let far = [ContactTarget::Load(2.0 * all[240].contact.load)];
        let (same, end) = record.history().ending_at(&grid(), &far).unwrap();
        assert_eq!((same.states().len(), end), (240, None));
        assert!(record.history().ending_at(&grid(), &[ContactTarget::Load(-1.0)]).is_err());
    }
}

/// The fraction that was asked for is on record, and not that of the nodes which fit into it.
#[test]
fn records_remember_what_was_asked() {
    let kernel = Boussinesq::new(grid(), 1e9).unwrap();
    let surface = rough(&grid(), 5);
    let target = ContactTarget::AreaFraction(0.1234);
    let builder = LoadingSolver::builder(&surface, &kernel).until(target);
    let mut path = builder.build().unwrap();
    let history = path.run().unwrap();
    let record = LoadingRecord::new(&path, history).unwrap();
    assert_eq!(record.settings().targets, [target]);
}

/// A path that has not begun is resumed at its beginning.
#[test]
fn no_states_are_no_path_yet() {
    let kernel = Boussinesq::new(grid(), 1e9).unwrap();
    let (_, all) = whole(&kernel, RecursiveCholesky::new());
    let nothing: History = [].into_iter().collect();
    let surface = rough(&grid(), 5);
    let resumed = LoadingSolver::builder(&surface, &kernel)
        .updater(RecursiveCholesky::new())
        .resume(&nothing)
        .unwrap();
    assert_eq!(resumed.state(), None);
    let states: Vec<LoadingState> = resumed.map(Result::unwrap).collect();
    assert_eq!(states, all);
}

/// The factor of the nodes in contact is made only if it fits, to the byte.
#[test]
fn a_contact_that_does_not_fit_is_not_resumed() {
    let kernel = Boussinesq::new(grid(), 1e9).unwrap();
    let (path, all) = whole(&kernel, RecursiveCholesky::new());
    let record = cut(&path, &all, 240);
    let room = LoadingSolver::check_room(&grid(), kernel.boundary(), Some(0));
    let Err(Error::MemoryBudget { needed: fixed, .. }) = room else {
        panic!("{room:?}");
    };
    let resume = |bytes: usize| {
        LoadingSolver::builder(record.heights(), &kernel)
            .updater(RecursiveCholesky::new())
            .memory_budget(fixed + bytes)
            .resume(record.history())
    };
    let needed = match resume(1000) {
        Err(Error::MemoryBudget { needed, budget, nodes_that_fit: 0 })
            if budget == fixed + 1000 =>
        {
            needed - fixed
        }
        other => panic!("{other:?}"),
    };
    // A triangle of 240 numbers a side at least.
    assert!(needed > 240 * 240 / 2 * size_of::<f64>(), "{needed}");
    assert!(matches!(
        resume(needed - 1),
        Err(Error::MemoryBudget { needed: again, budget, .. })
            if again == fixed + needed && budget == fixed + needed - 1
    ));
    assert_eq!(resume(needed).unwrap().state(), Some(all[239]));
}

/// A kernel of which another number of coefficients is remembered is another one.
#[test]
fn a_kernel_with_too_few_coefficients_is_refused() {
    let kernel = Boussinesq::new(grid(), 1e9).unwrap();
    let (path, all) = whole(&kernel, RecursiveCholesky::new());
    let record = cut(&path, &all, 30);
    let mut remembered = record.kernel().clone();
    remembered.coefficients.pop();
    let history: History = record.states().iter().copied().collect();
    let (heights, settings) = (record.heights().clone(), record.settings().clone());
    let record =
        LoadingRecord::from_parts(grid(), heights, remembered, settings, history, None).unwrap();
    let made = record.make_kernel();
    assert!(matches!(made, Err(Error::LengthMismatch { expected: 16, found: 15 })), "{made:?}");
}

#[test]
fn states_in_no_order_of_a_path_are_refused() {
    let kernel = Boussinesq::new(grid(), 1e9).unwrap();
    let (path, all) = whole(&kernel, RecursiveCholesky::new());
    let record =
        |states: Vec<LoadingState>| LoadingRecord::new(&path, states.into_iter().collect());
    assert!(record(all[..50].to_vec()).is_ok());
    // Without its beginning, with a node twice, with one outside the grid, and with a number that is none.
    assert!(matches!(record(all[1..50].to_vec()), Err(Error::NotOnPath { .. })));
    let changed = |change: &dyn Fn(&mut LoadingState)| {
        let mut states = all[..50].to_vec();
        change(&mut states[20]);
        record(states)
    };
    let twice = changed(&|state| state.node = all[3].node);
    assert!(matches!(twice, Err(Error::AlreadyInContact { .. })));
    let outside = changed(&|state| state.node = (usize::MAX, 3));
    assert!(matches!(outside, Err(Error::NodeOutOfGrid { .. })));
    // Numbers that do not go with the events, and a limit that is not the end.
    let not_on_path = |found: Result<LoadingRecord, Error>, numbers: (&str, f64, &str)| match found
    {
        Err(Error::NotOnPath { step, quantity, value, expected, load, approach }) => {
            assert_eq!((quantity, value, expected), numbers);
            assert_eq!((load, approach), (all[20].contact.load, all[20].contact.approach));
            step
        }
        other => panic!("{other:?}"),
    };
    let limit = changed(&|state| state.event = ContactEvent::Limit);
    let only_last = ("number of the event", 21.0, "no limit but the last state");
    assert_eq!(not_on_path(limit, only_last), 21);
    let step = changed(&|state| state.step = 30);
    let in_turn = ("number of the event", 30.0, "one more than before");
    assert_eq!(not_on_path(step, in_turn), 30);
    let count = changed(&|state| state.contact.contact_nodes = 7);
    let counted = ("number of nodes in contact", 7.0, "that of the events");
    assert_eq!(not_on_path(count, counted), 21);
    let nan = changed(&|state| state.contact.load = f64::NAN);
    assert!(matches!(nan, Err(Error::RecordNotFinite { step: 21, quantity: "load", .. })));
    // A kernel of this crate always has a stiffness, without which loads and gaps could be any.
    let soft = changed(&|state| state.contact.interfacial_stiffness = None);
    let quantity = "interfacial stiffness";
    assert!(
        matches!(soft, Err(Error::RecordNotFinite { step: 21, quantity: q, .. }) if q == quantity)
    );
}

/// Stress and patches go by the boundary on record, without the kernel.
#[test]
fn a_boundary_that_is_not_that_of_the_kernel_is_refused() {
    let kernel = Boussinesq::new(grid(), 1e9).unwrap();
    let path = LoadingSolver::new(&rough(&grid(), 5), &kernel).unwrap();
    let record = LoadingRecord::new(&path, History::default()).unwrap();
    for boundary in [Boundary::Periodic, Boundary::PeriodicX, Boundary::PeriodicY] {
        let other = KernelRecord { boundary, ..record.kernel().clone() };
        let (heights, settings) = (record.heights().clone(), record.settings().clone());
        let history = History::default();
        let refused = LoadingRecord::from_parts(grid(), heights, other, settings, history, None);
        assert!(matches!(refused, Err(Error::WrongBoundary { .. })), "{refused:?}");
    }
}

/// All lengths of a flat periodic surface are rounding: a path on it goes on from wherever it was stopped.
#[test]
fn flat_periodic_surfaces_with_a_hardness_go_on_from_any_event() {
    let grid = Grid::square(6, 8e-4).unwrap();
    let flat = HeightMap::new(DMatrix::zeros(6, 6)).unwrap();
    let kernels: [Box<dyn InfluenceKernel>; 2] = [
        Box::new(PeriodicBoussinesq::new(grid, 1e9).unwrap()),
        Box::new(Spectral::new(grid, 1e9).unwrap()),
    ];
    for kernel in kernels {
        let path = || LoadingSolver::builder(&flat, &*kernel).hardness(6e8).build().unwrap();
        let whole = path().run().unwrap();
        let events = whole.states().len();
        for stopped in 1..events {
            let mut path = path();
            let history = path.by_ref().take(stopped).collect::<Result<_, _>>().unwrap();
            let record = LoadingRecord::new(&path, history).unwrap();
            let mut resumed = record.resume().unwrap();
            let rest = resumed.run().unwrap();
            assert_eq!(stopped + rest.states().len(), events, "{stopped}");
            let [found, last] =
                [&rest, &whole].map(|path| path.states().last().unwrap().contact.load);
            assert_relative!(found, last, 1e-10);
        }
    }
}

/// A record that ends at a limit goes on from there.
#[test]
fn a_limit_is_no_event() {
    let kernel = Boussinesq::new(grid(), 1e9).unwrap();
    let (_, all) = whole(&kernel, RecursiveCholesky::new());
    let load = 0.3 * all[99].contact.load + 0.7 * all[100].contact.load;
    let surface = rough(&grid(), 5);
    let mut path = LoadingSolver::builder(&surface, &kernel).max_load(load).build().unwrap();
    let history = path.run().unwrap();
    let record = LoadingRecord::new(&path, history).unwrap();
    assert_eq!(record.states().len(), 101);
    assert_eq!(record.contact().unwrap().len(), 100);
    assert_eq!(record.history().at_load(load).unwrap().contact.load, load);
    assert_eq!(record.settings().rule, ContactRule::FirstContact);
    let mut resumed = record.resume().unwrap();
    // It is to end where it ended, and then goes on.
    let last = resumed.by_ref().last().unwrap().unwrap();
    assert_eq!((last.step, last.contact.load), (100, load));
    resumed.continue_to(ContactTarget::AreaFraction(1.0)).unwrap();
    let next = resumed.next().unwrap().unwrap();
    assert_close(&next, &all[100], 1e-10, all[0].contact.mean_gap);
}

/// Read anywhere, a record gives the state of a path that was stopped there, and of a solver that knows one load
/// only. Stopped paths round alike but for windows that end elsewhere; the solver stops at 1e-10 of the approach.
#[test]
fn a_record_reads_as_a_path_that_stops_there() {
    let mut random = ChaCha8Rng::seed_from_u64(4);
    for (name, kernel) in kernels(grid()) {
        let (path, all) = whole(&*kernel, RecursiveCholesky::new());
        let record = cut(&path, &all, all.len());
        let history = record.history();
        let unloaded = all[0].contact.mean_gap;
        for _ in 0..12 {
            // Between two events, from the sixth on to the last but one.
            let k = random.random_range(5..all.len() - 1);
            let share: f64 = random.random_range(0.05..0.95);
            let between = |a: f64, b: f64| a + share * (b - a);
            let (a, b) = (&all[k], &all[k + 1]);
            let load = between(a.contact.load, b.contact.load);
            let approach = between(a.contact.approach, b.contact.approach);
            let mean_gap = between(a.contact.mean_gap, b.contact.mean_gap);
            let fraction = a.contact.contact_area_fraction;
            let read = [
                (ContactTarget::Load(load), history.at_load(load)),
                (ContactTarget::Approach(approach), history.at_approach(approach)),
                (ContactTarget::MeanGap(mean_gap), history.at_mean_gap(mean_gap)),
                (ContactTarget::AreaFraction(fraction), history.at_area_fraction(fraction)),
            ];
            for (target, read) in read {
                let stopped = LoadingSolver::builder(record.heights(), &kernel)
                    .updater(RecursiveCholesky::new())
                    .until(target)
                    .build()
                    .unwrap();
                let stopped = stopped.last().unwrap().unwrap();
                let read = read.unwrap_or_else(|| panic!("{name} {target:?}"));
                assert_close(&read, &stopped, 1e-10, unloaded);
            }
            let mut solver = FixedLoadSolver::builder(record.heights(), &kernel)
                .tolerance(1e-10)
                .build()
                .unwrap();
            let found = solver.solve(load).unwrap().contact;
            let read = history.at_load(load).unwrap();
            assert_eq!(found.contact_nodes, read.contact.contact_nodes, "{name}");
            let error = (found.approach - read.contact.approach).abs();
            assert!(error <= 1e-7 * read.contact.approach, "{name} {error}");
            let error = (found.mean_gap - read.contact.mean_gap).abs();
            assert!(error <= 1e-7 * unloaded, "{name} {error}");
        }
    }
}
