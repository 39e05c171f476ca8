//! Ends of branches, reversals, and what is refused.

use asperity::adhesion::{
    Adhesion, AdhesiveEnd, AdhesiveEvent, AdhesivePath, AdhesiveState, Direction,
};
use asperity::loading::History;
use asperity::record::AdhesiveRecord;
use asperity::surface::{Amplitude, HeightMap, SelfAffine};
use asperity::{
    AdhesionError, Boundary, Boussinesq, ContactGrowth, ContactState, ContactTarget, Error, Grid,
    InfluenceKernel, KernelTable, LoadingSolver, LoadingState, PeriodicBoussinesq, Spectral,
};
use nalgebra::DMatrix;

fn kernel() -> Boussinesq {
    Boussinesq::new(Grid::square(20, 1.0).unwrap(), 1.0).unwrap()
}

fn surface() -> SelfAffine {
    SelfAffine::new(0.8, 0.5, 0.25, Amplitude::RmsHeight(0.02), 5).unwrap()
}

fn path(target: Option<ContactTarget>) -> AdhesivePath {
    let (surface, kernel) = (surface(), kernel());
    let builder = AdhesivePath::builder(&surface, &kernel, Adhesion::work(1e-3));
    let builder = target.into_iter().fold(builder, |builder, target| builder.until(target));
    builder.build().unwrap()
}

fn run(path: &mut AdhesivePath) -> Vec<AdhesiveState> {
    path.by_ref().map(|state| state.unwrap()).collect()
}

/// A branch ends at exactly what was asked for, negative loads and approaches too, and goes on from there as if nothing
/// had been.
#[test]
fn branches_end_at_their_targets() {
    let whole = run(&mut path(None));
    assert_eq!(whole.last().unwrap().contact.contact_area_fraction, 1.0);
    let most = whole.last().unwrap().contact.load;
    let gap = 0.5 * whole[0].contact.mean_gap;
    let targets = [
        ContactTarget::Load(-2e-4),
        ContactTarget::Load(0.25 * most),
        ContactTarget::Approach(-0.012),
        ContactTarget::Approach(0.01),
        ContactTarget::MeanGap(gap),
    ];
    for target in targets {
        let mut path = path(Some(target));
        let states = run(&mut path);
        let last = states.last().unwrap();
        assert_eq!(
            (path.end(), last.event),
            (Some(AdhesiveEnd::Target), AdhesiveEvent::Limit),
            "{target:?}"
        );
        let (found, asked) = match target {
            ContactTarget::Load(load) => (last.contact.load, load),
            ContactTarget::Approach(approach) => (last.contact.approach, approach),
            ContactTarget::MeanGap(gap) => (last.contact.mean_gap, gap),
            _ => unreachable!(),
        };
        assert_eq!(found, asked);
        // Then the same events as without a stop.
        path.load_to(ContactTarget::AreaFraction(1.0)).unwrap();
        let later = run(&mut path);
        assert_eq!(states.len() - 1 + later.len(), whole.len(), "{target:?}");
        for (state, expected) in
            states.iter().filter(|s| s.event != AdhesiveEvent::Limit).chain(&later).zip(&whole)
        {
            assert_eq!((state.event, state.node), (expected.event, expected.node));
            assert!((state.contact.load - expected.contact.load).abs() < 1e-10 * most);
        }
    }
}

/// Between two events all is linear, so that stiffnesses are those of secants, on both branches; across a jump there
/// is none.
#[test]
fn stiffnesses_are_those_of_secants() {
    let square = Grid::square(20, 1.0).unwrap();
    let oblong = Grid::new(24, 16, 0.04, 0.06).unwrap();
    let free = Boussinesq::new(oblong, 1.0).unwrap();
    let periodic = [square, oblong].map(|grid| PeriodicBoussinesq::new(grid, 1.0).unwrap());
    let spectral = Spectral::new(oblong, 1.0).unwrap();
    // Of a periodic half-space no distant point has a stiffness.
    let kernels: [(&dyn InfluenceKernel, usize); 5] =
        [(&kernel(), 50), (&free, 50), (&periodic[0], 0), (&periodic[1], 0), (&spectral, 0)];
    let laws = [Adhesion::work(1e-3), Adhesion::maugis(1e-3, 0.02).range(0.08)];
    for ((kernel, least), law) in
        kernels.into_iter().flat_map(|kernel| laws.map(|law| (kernel, law)))
    {
        let end = ContactTarget::AreaFraction(0.5);
        let mut path = AdhesivePath::builder(&surface(), kernel, law).until(end).build().unwrap();
        let mut branches = vec![run(&mut path)];
        path.unload().unwrap();
        branches.push(run(&mut path));
        let length = path.problem().greatest_gap() + path.law().range();
        let pull = path.law().stress() * path.grid().nominal_area();
        for states in branches {
            let mut counts = [0; 2];
            for pair in states.windows(2) {
                let (event, [from, to]) = (pair[1].event, [0, 1].map(|k| pair[k].contact));
                if event == AdhesiveEvent::JumpEnd {
                    continue;
                }
                let steps = [to.approach - from.approach, from.mean_gap - to.mean_gap];
                let stiffnesses = [from.contact_stiffness, from.interfacial_stiffness];
                for (k, (step, stiffness)) in steps.into_iter().zip(stiffnesses).enumerate() {
                    let Some(stiffness) = stiffness else { continue };
                    // Loads and lengths are exact to 1e-12 of the greatest, as the elastic parts of one are.
                    let change = to.load - from.load;
                    let rounding = 1e-12 * (pull + from.load.abs() + stiffness.abs() * length);
                    assert!(
                        (change - stiffness * step).abs() < 1e-9 * change.abs() + rounding,
                        "{k} {pair:?}"
                    );
                    counts[k] += usize::from(change.abs() > 1e3 * rounding);
                }
            }
            assert!(counts[0] >= least && counts[1] >= 50, "{counts:?}");
        }
    }
}

/// In full contact the mean planes of a periodic half-space do not approach any more: a target beyond that is none, and
/// the load stays what it was.
#[test]
fn no_approach_is_beyond_full_contact() {
    let grid = Grid::new(4, 2, 0.07984, 0.09574).unwrap();
    let kernels: [&dyn InfluenceKernel; 2] =
        [&PeriodicBoussinesq::new(grid, 1.0).unwrap(), &Spectral::new(grid, 1.0).unwrap()];
    // In pairs that are nearly of one height.
    let heights = [2.5755e-10, 2.3408e-10, 1.9532e-10, 1.7231e-10];
    let heights = DMatrix::from_fn(4, 2, |ix, iy| heights[ix] - 1e-13 * iy as f64);
    let deepest = heights.max() - heights.min();
    let surface = HeightMap::new(heights).unwrap();
    for kernel in kernels {
        let law = Adhesion::work(1e-10);
        let mut path = AdhesivePath::builder(&surface, kernel, law).build().unwrap();
        path.load_to(ContactTarget::AreaFraction(1.0)).unwrap();
        let full = *run(&mut path).last().unwrap();
        assert_eq!(full.contact.contact_area_fraction, 1.0);
        path.load_to(ContactTarget::Approach(2.0 * deepest)).unwrap();
        assert_eq!(run(&mut path), []);
        assert_eq!((path.end(), path.state()), (Some(AdhesiveEnd::NoMoreEvents), Some(full)));
    }
}

/// As many nodes as fit, or those behind the jump that goes past; on unloading the first state with no more.
#[test]
fn areas_of_both_branches() {
    let mut path = path(Some(ContactTarget::AreaFraction(0.3)));
    let states = run(&mut path);
    assert_eq!(path.end(), Some(AdhesiveEnd::Target));
    let last = states.last().unwrap();
    assert!(last.contact.contact_nodes >= 120, "{last:?}");
    assert!(last.contact.contact_nodes == 120 || last.event == AdhesiveEvent::JumpEnd);
    path.unload_to(ContactTarget::AreaFraction(0.1)).unwrap();
    let states = run(&mut path);
    let [.., before, last] = &states[..] else { panic!() };
    assert!(
        last.contact.contact_nodes <= 40 && before.contact.contact_nodes > 40,
        "{before:?} {last:?}"
    );
    assert_eq!(last.direction, Direction::Unloading);
}

/// A path that is turned around in the midst of a window goes back to the state that was yielded last.
#[test]
fn a_path_turns_where_it_is() {
    for steps in [3, 57, 150] {
        let mut early = path(None);
        let states: Vec<_> = early.by_ref().take(steps).map(|state| state.unwrap()).collect();
        let here = states.last().unwrap();
        early.unload().unwrap();
        let back = run(&mut early);
        let mut stopped = path(Some(ContactTarget::Approach(here.contact.approach)));
        run(&mut stopped);
        stopped.unload().unwrap();
        let expected = run(&mut stopped);
        let [back, expected] = [&back, &expected].map(|states| *states.last().unwrap());
        assert_eq!((back.contact.load, expected.contact.load), (0.0, 0.0));
        let unit = 1e-3;
        assert!((back.dissipated - expected.dissipated).abs() < 1e-12 * unit, "{steps}");
        assert!((back.work - expected.work).abs() < 1e-12 * unit, "{steps}");
        assert!((back.contact.approach - expected.contact.approach).abs() < 1e-15);
    }
}

/// A path that is asked step by step has the same states, and no end before the last of them; one that is left within
/// a jump turns around at the state before it.
#[test]
fn jumps_can_be_left() {
    let (surface, kernel) = (surface(), kernel());
    // With one event to a window a jump takes several.
    let build = |window: usize| {
        let builder = AdhesivePath::builder(&surface, &kernel, Adhesion::work(1e-3));
        builder.until(ContactTarget::Load(1e-3)).window_size(window).build().unwrap()
    };
    for window in [1, 64] {
        let expected = run(&mut build(window));
        let (mut path, mut states, mut within) = (build(window), Vec::new(), 0);
        loop {
            while !path.prepare().unwrap() {
                within += 1;
                assert_eq!((path.state(), path.end()), (states.last().copied(), None));
                if within % 20 == 1 && path.state().is_some() {
                    let mut left = build(window);
                    assert_eq!(left.by_ref().take(states.len()).count(), states.len());
                    assert!(!left.prepare().unwrap());
                    let mut stopped = build(window);
                    stopped.nth(states.len() - 1);
                    let [left, stopped] = [left, stopped].map(|mut path| {
                        path.unload().unwrap();
                        *run(&mut path).last().unwrap()
                    });
                    assert_eq!((left.contact.load, left.direction), (0.0, Direction::Unloading));
                    assert!((left.dissipated - stopped.dissipated).abs() < 1e-15);
                }
            }
            let Some(state) = path.next() else { break };
            states.push(state.unwrap());
            let is_last = states.len() == expected.len();
            assert_eq!(path.end(), is_last.then_some(AdhesiveEnd::Target));
        }
        assert_eq!(states, expected);
        assert!(window > 1 || within > 20, "{within}");
    }
}

/// Little adhesion changes little: load and area at an approach are those of the elastic path, to what so small a
/// stress can carry.
#[test]
fn little_adhesion_is_none() {
    let (surface, kernel) = (surface(), kernel());
    let elastic = LoadingSolver::builder(&surface, &kernel).max_approach(0.02).build().unwrap();
    let elastic = elastic.map(|state| state.unwrap()).last().unwrap();
    let law = Adhesion::work(1e-18);
    let builder = AdhesivePath::builder(&surface, &kernel, law);
    let mut path = builder.until(ContactTarget::Approach(0.02)).build().unwrap();
    let last = *run(&mut path).last().unwrap();
    let stress = path.law().stress();
    assert!(stress < 1e-4 * elastic.contact.load);
    assert!((last.contact.load - elastic.contact.load).abs() < 10.0 * stress);
    assert_eq!(last.contact.contact_nodes, elastic.contact.contact_nodes);
}

/// The same of stiff bodies that stick a little over a long range: pressures are up to 10¹¹ times what adhesion pulls
/// with, and known to no more than rounding. The branches come to their ends, and energies balance.
#[test]
fn little_adhesion_over_a_long_range_is_none() {
    let (surface, kernel) = (surface(), kernel());
    let elastic = LoadingSolver::builder(&surface, &kernel).max_approach(0.04).build().unwrap();
    let elastic = elastic.map(|state| state.unwrap()).last().unwrap().contact;
    for work in [1e-6, 1e-8, 1e-10, 1e-12, 1e-14] {
        for law in [Adhesion::work(work).range(0.05), Adhesion::maugis(work, 0.6 * work / 0.02)] {
            let builder = AdhesivePath::builder(&surface, &kernel, law);
            let mut path = builder.until(ContactTarget::Approach(0.04)).build().unwrap();
            let last = run(&mut path).last().unwrap().contact;
            let stress = path.law().stress();
            // What pulls adds as much contact, and its pull, as a load of that size.
            assert!((last.load - elastic.load).abs() < 10.0 * stress + 1e-12 * elastic.load);
            let nodes = elastic.contact_nodes.abs_diff(last.contact_nodes);
            assert!(nodes <= if work > 1e-7 { 2 } else { 0 }, "{work}: {nodes}");
            path.unload().unwrap();
            let off = *run(&mut path).last().unwrap();
            assert_eq!(path.end(), Some(AdhesiveEnd::NoMoreEvents));
            assert_eq!((off.contact.contact_nodes, off.contact.load), (0, 0.0));
            assert!((off.work - off.dissipated).abs() < 1e-12 * elastic.energy, "{work}");
        }
    }
}

/// Without any adhesion the states are those of the elastic path bit for bit, on the way there, back and there again.
#[test]
fn no_adhesion_is_the_elastic_path() {
    let (surface, grid) = (surface(), kernel().grid());
    let free: Box<dyn InfluenceKernel> = Box::new(kernel());
    let periodic: Box<dyn InfluenceKernel> = Box::new(PeriodicBoussinesq::new(grid, 1.0).unwrap());
    for kernel in [free, periodic] {
        let mut elastic =
            LoadingSolver::builder(&surface, &*kernel).max_area_fraction(0.3).build().unwrap();
        let expected: Vec<LoadingState> = elastic.by_ref().map(Result::unwrap).collect();
        let history: History = expected.iter().copied().collect();
        let end = expected.last().unwrap().contact;
        let mut path = AdhesivePath::builder(&surface, &*kernel, Adhesion::work(0.0))
            .until(ContactTarget::AreaFraction(0.3))
            .build()
            .unwrap();
        let loading = path.run().unwrap();
        assert_eq!(loading.states().len(), expected.len());
        for (found, expected) in loading.states().iter().zip(&expected) {
            let contact = expected.contact;
            assert_eq!((found.node, found.contact), (expected.node, contact));
            assert_eq!(found.work, contact.energy);
        }
        assert_eq!((loading.pull_off(), loading.dissipated()), (0.0, 0.0));
        assert_eq!(path.end(), Some(AdhesiveEnd::Target));
        // Back to a load between two events, and on to one beyond the first end.
        let (half, more) = (0.5 * end.load, 1.3 * end.load);
        path.unload_to(ContactTarget::Load(half)).unwrap();
        let back = path.run().unwrap();
        let last = back.states().last().unwrap();
        assert_eq!(last.contact, history.at_load(half).unwrap().contact);
        let parted = back.states().iter().filter(|state| state.event == AdhesiveEvent::Part);
        assert_eq!(parted.count(), end.contact_nodes - last.contact.contact_nodes);
        path.load_to(ContactTarget::Load(more)).unwrap();
        let again = path.run().unwrap();
        let mut further =
            LoadingSolver::builder(&surface, &*kernel).max_load(more).build().unwrap();
        let further: Vec<LoadingState> = further.by_ref().map(Result::unwrap).collect();
        let touches = again.states().iter().filter(|state| state.event == AdhesiveEvent::Touch);
        let touches: Vec<ContactState> = touches.map(|state| state.contact).collect();
        let end_of_touches = further.len() - 1;
        let begin = end_of_touches - touches.len();
        for (found, expected) in touches.iter().zip(&further[begin..end_of_touches]) {
            // A path that has continued beyond its end has other windows.
            assert_eq!(found.contact_nodes, expected.contact.contact_nodes);
            assert!((found.load / expected.contact.load - 1.0).abs() < 1e-10);
        }
        assert_eq!(path.state().unwrap().contact.load, more);
        // Fields of a state on the way back, and all the way, of a record too.
        let all = [&loading, &back, &again].into_iter().flat_map(|branch| branch.states());
        let record = AdhesiveRecord::new(&path, all.copied().collect()).unwrap();
        path.unload().unwrap();
        let off = path.run().unwrap();
        let mut other = record.path().unwrap();
        other.unload().unwrap();
        for (found, expected) in other.run().unwrap().states().iter().zip(off.states()) {
            assert_eq!((found.step, found.node), (expected.step, expected.node));
            let (found, expected) = (found.contact.load, expected.contact.load);
            assert!((found - expected).abs() <= 1e-10 * more);
        }
        assert_eq!(off.states().len(), last.contact.contact_nodes + touches.len());
        let first = off.states().last().unwrap();
        assert_eq!((first.contact.contact_nodes, first.contact.load), (0, 0.0));
        let state = back.states()[3];
        let fields = path.fields_at(&state).unwrap();
        let load = grid.cell_area() * fields.pressure.sum();
        assert!((load / state.contact.load - 1.0).abs() < 1e-10);
        assert!(fields.pressure.min() > -1e-10 * fields.pressure.max());
    }
}

/// Between two events of the elastic path the first target that is reached counts; in full contact an area does.
#[test]
fn without_adhesion_the_first_target_counts() {
    let grid = Grid::square(10, 1.0).unwrap();
    let kernel = PeriodicBoussinesq::new(grid, 1.0).unwrap();
    let surface = surface();
    let mut path = AdhesivePath::builder(&surface, &kernel, Adhesion::work(0.0)).build().unwrap();
    let states = run(&mut path);
    let [.., before, full] = &states[..] else { panic!() };
    let [before, full] = [before, full].map(|state| state.contact.load);
    let mut end_of = |targets: &[ContactTarget]| {
        path.unload().unwrap();
        run(&mut path);
        path.load_to_first_of(targets).unwrap();
        let last = *run(&mut path).last().unwrap();
        assert_eq!(path.end(), Some(AdhesiveEnd::Target), "{targets:?}");
        last.contact
    };
    let loads =
        |parts: [f64; 2]| parts.map(|part| ContactTarget::Load(before + part * (full - before)));
    for (parts, first) in [([0.75, 0.5], 0.5), ([0.25, 0.5], 0.25)] {
        let load = end_of(&loads(parts)).load;
        assert!((load / (before + first * (full - before)) - 1.0).abs() < 1e-12, "{parts:?}");
    }
    let area = ContactTarget::AreaFraction(1.0);
    assert_eq!(end_of(&[area]).contact_nodes, 100);
    assert_eq!(end_of(&[loads([2.0; 2])[0], area]).load, full);
}

/// A load of nothing is the difference of pulls and pushes that are not: it is met exactly.
#[test]
fn no_load_is_exactly_none() {
    let mut path = path(Some(ContactTarget::Load(3e-4)));
    run(&mut path);
    path.unload_to(ContactTarget::Load(0.0)).unwrap();
    let last = *run(&mut path).last().unwrap();
    assert_eq!((path.end(), last.event), (Some(AdhesiveEnd::Target), AdhesiveEvent::Limit));
    assert!(last.soft_nodes > 0);
    assert_eq!(last.contact.load, 0.0);
}

/// A state of the same number on another path, and one of the same approach with another load.
#[test]
fn states_of_another_path_are_refused() {
    for law in [0.0, 1e-3] {
        let kernel = kernel();
        let make = |height: f64| {
            let height = Amplitude::RmsHeight(height);
            let surface = SelfAffine::new(0.8, 0.5, 0.25, height, 5).unwrap();
            AdhesivePath::builder(&surface, &kernel, Adhesion::work(law)).build().unwrap()
        };
        let (mut own, mut other) = (make(0.02), make(0.03));
        let (states, foreign) = (run(&mut own), run(&mut other));
        for step in [2, 20, 60] {
            let state = states[step - 1];
            assert!(own.fields_at(&state).is_ok(), "{law} {step}");
            let mut altered = state;
            altered.contact.load += 0.1 * states.last().unwrap().contact.load;
            for wrong in [foreign[step - 1], altered] {
                let refused = own.fields_at(&wrong);
                assert!(
                    matches!(refused, Err(Error::NotOnPath { .. })),
                    "{law} {step}: {refused:?}"
                );
            }
        }
    }
}

#[test]
fn what_is_refused() {
    let (surface, kernel) = (surface(), kernel());
    let law = Adhesion::work(1e-3);
    let unknown =
        KernelTable::from_fn(kernel.grid(), Boundary::Free, ContactGrowth::Unknown, |di, dj| {
            kernel.coefficient(di, dj)
        });
    let refused = AdhesivePath::builder(&surface, &unknown.unwrap(), law).build();
    assert!(matches!(refused, Err(Error::Adhesion(AdhesionError::GrowthUnknown))));
    let refused = AdhesivePath::builder(&surface, &kernel, law.range(1e-3)).build();
    assert!(matches!(refused, Err(Error::Adhesion(AdhesionError::Unresolved { .. }))));
    for (window, memory) in [(0, usize::MAX), (1, 1000)] {
        let builder = AdhesivePath::builder(&surface, &kernel, law).window_size(window);
        assert!(builder.memory_budget(memory).build().is_err());
    }
    let mut path = path(Some(ContactTarget::Load(1e-3)));
    run(&mut path);
    for refused in
        [path.unload_to(ContactTarget::Load(2e-3)), path.load_to(ContactTarget::Approach(-1.0))]
    {
        assert!(
            matches!(refused, Err(Error::Adhesion(AdhesionError::Behind { .. }))),
            "{refused:?}"
        );
    }
    assert!(path.load_to(ContactTarget::Load(f64::NAN)).is_err());
    // A mean pressure is a load.
    let mut path = AdhesivePath::builder(&surface, &kernel, law)
        .until(ContactTarget::MeanPressure(1e-3))
        .build()
        .unwrap();
    let last = path.run().unwrap().states().last().copied().unwrap();
    assert_eq!(last.contact.load, 1e-3 * kernel.grid().nominal_area());
    // A budget that the factor outgrows ends the path with what fits, and nothing goes on behind it.
    let fixed = 24 * 8 * 400;
    let builder = AdhesivePath::builder(&surface, &kernel, law).memory_budget(fixed + 1_200_000);
    let mut path = builder.build().unwrap();
    let error = path.by_ref().find_map(Result::err);
    assert!(matches!(error, Some(Error::MemoryBudget { .. })), "{error:?}");
    assert_eq!(path.end(), Some(AdhesiveEnd::Failed));
    assert!(path.next().is_none());
    assert!(matches!(path.unload(), Err(Error::CannotContinue { .. })));
}
