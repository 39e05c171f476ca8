//! Targets at the very values of events, and targets that are met already.

use asperity::adhesion::{
    Adhesion, AdhesiveBuilder, AdhesiveEnd, AdhesiveEvent, AdhesivePath, AdhesiveState,
};
use asperity::record::AdhesiveRecord;
use asperity::surface::{Amplitude, HeightMap, SelfAffine};
use asperity::{
    AdhesionError, Boussinesq, ContactState, ContactTarget, Error, Grid, InfluenceKernel,
    PeriodicBoussinesq,
};
use asperity_testing::assert_relative;
use asperity_testing::surfaces::scattered;
use nalgebra::DMatrix;

fn surface() -> SelfAffine {
    SelfAffine::new(0.8, 0.5, 0.25, Amplitude::RmsHeight(0.02), 5).unwrap()
}

fn kernels() -> [Box<dyn InfluenceKernel>; 2] {
    let grid = Grid::square(10, 1.0).unwrap();
    [
        Box::new(Boussinesq::new(grid, 1.0).unwrap()),
        Box::new(PeriodicBoussinesq::new(grid, 1.0).unwrap()),
    ]
}

/// With so few nodes to a window there are many ends of windows, at which a target is just ahead or just passed.
fn builder<'a>(
    surface: &'a SelfAffine,
    kernel: &'a dyn InfluenceKernel,
    work: f64,
) -> AdhesiveBuilder<'a> {
    AdhesivePath::builder(surface, kernel, Adhesion::work(work)).window_size(3)
}

fn run(path: &mut AdhesivePath) -> Vec<AdhesiveState> {
    path.by_ref().map(|state| state.unwrap()).collect()
}

/// What a state has, as targets.
fn targets_at(contact: &ContactState) -> [ContactTarget; 3] {
    [
        ContactTarget::Load(contact.load),
        ContactTarget::Approach(contact.approach),
        ContactTarget::MeanGap(contact.mean_gap),
    ]
}

/// What a target asks for, and what a state has of it.
fn compared(target: ContactTarget, contact: &ContactState) -> [f64; 2] {
    match target {
        ContactTarget::Load(load) => [load, contact.load],
        ContactTarget::Approach(approach) => [approach, contact.approach],
        ContactTarget::MeanGap(gap) => [gap, contact.mean_gap],
        _ => unreachable!(),
    }
}

/// Whether rounding puts an event before a target at its value or behind it, the branch ends there: on loading and on
/// unloading, also at the state at which a jump begins.
#[test]
fn targets_at_the_values_of_events_are_met() {
    let surface = surface();
    let (mut met, mut jumps) = (0, 0);
    for (kernel, work) in kernels().iter().flat_map(|kernel| [4e-4, 4e-3].map(|w| (kernel, w))) {
        let most = ContactTarget::AreaFraction(0.5);
        let mut whole = builder(&surface, &**kernel, work).until(most).build().unwrap();
        let loading = run(&mut whole);
        whole.unload().unwrap();
        let unloading = run(&mut whole);
        for (k, state) in loading.iter().chain(&unloading).enumerate() {
            let is_apart = state.contact.contact_nodes == 0 && state.soft_nodes == 0;
            if state.event == AdhesiveEvent::JumpEnd || is_apart || k + 1 == loading.len() {
                continue;
            }
            let turned = loading.last().unwrap().contact.load;
            for target in targets_at(&state.contact) {
                // A load that only rises on the way back is refused.
                let is_load = matches!(target, ContactTarget::Load(_));
                if k >= loading.len() && is_load && state.contact.load > turned {
                    continue;
                }
                let mut path = builder(&surface, &**kernel, work);
                if k < loading.len() {
                    path = path.until(target);
                } else {
                    path = path.until(most);
                }
                let mut path = path.build().unwrap();
                let mut states = run(&mut path);
                if k >= loading.len() {
                    path.unload_to(target).unwrap();
                    states = run(&mut path);
                }
                let last = states.last().unwrap();
                let [asked, found] = compared(target, &last.contact);
                assert_eq!(
                    (path.end(), found),
                    (Some(AdhesiveEnd::Target), asked),
                    "{work} {k} {target:?} {last:?}"
                );
                met += 1;
                jumps += usize::from(state.event == AdhesiveEvent::JumpStart);
            }
        }
    }
    assert!(met > 1000 && jumps > 30, "{met} {jumps}");
}

/// Small loads on stiff bodies that stick a little: what rounding of the height of the surface moves at the stiffness of
/// the contact is 10⁻⁸ to 10⁻¹² of them. They are met all the same, once and again.
#[test]
fn small_loads_on_stiff_bodies_are_met() {
    let grid = Grid::square(16, 16.0).unwrap();
    let kernel = Boussinesq::new(grid, 1.0).unwrap();
    for (work, load) in [(1e-9, 1e-9), (1e-7, 2e-8), (1e-8, 1e-10)] {
        for seed in 0..12 {
            let heights = scattered(grid.shape(), 100_003, seed) * 3.5e-6;
            let surface = HeightMap::new(heights).unwrap();
            let target = ContactTarget::Load(load);
            let path = AdhesivePath::builder(&surface, &kernel, Adhesion::work(work)).until(target);
            let mut path = path.build().unwrap();
            let last = *run(&mut path).last().unwrap();
            assert_eq!(last.contact.load, load, "{work} {seed}");
            path.load_to(target).unwrap();
            let again = *run(&mut path).last().unwrap();
            assert_eq!((path.end(), again.contact.load), (Some(AdhesiveEnd::Target), load));
            assert_eq!(again.contact.contact_nodes, last.contact.contact_nodes, "{work} {seed}");
        }
    }
}

/// Nodes that touch carry a load that is as good as none, however little more that is than none.
#[test]
fn the_least_load_is_met_in_contact() {
    let surface = surface();
    for kernel in kernels() {
        let least = |load| {
            let path = builder(&surface, &*kernel, 4e-3).until(ContactTarget::Load(load));
            *run(&mut path.build().unwrap()).last().unwrap()
        };
        let (none, some) = (least(0.0), least(1e-22));
        assert!(none.contact.contact_nodes > 0);
        assert_eq!(some.contact.contact_nodes, none.contact.contact_nodes);
    }
}

/// A periodic half-space has no stiffness about a distant point, without a node in contact either.
#[test]
fn without_adhesion_a_periodic_half_space_has_no_contact_stiffness() {
    let surface = surface();
    let [free, periodic] = kernels();
    for (kernel, has_stiffness) in [(free, true), (periodic, false)] {
        let target = ContactTarget::AreaFraction(0.1);
        let mut path = builder(&surface, &*kernel, 0.0).until(target).build().unwrap();
        let mut states = run(&mut path);
        path.unload().unwrap();
        states.extend(run(&mut path));
        assert!(states.last().unwrap().contact.contact_nodes == 0);
        let all = states.iter().all(|s| s.contact.contact_stiffness.is_some() == has_stiffness);
        assert!(all, "{states:?}");
    }
}

/// Without adhesion there and back, and a record is made of every one.
#[test]
fn without_adhesion_targets_at_touches_are_met() {
    let surface = surface();
    for kernel in kernels() {
        let build = |target| builder(&surface, &*kernel, 0.0).until(target).build().unwrap();
        let most = ContactTarget::AreaFraction(0.3);
        let touches = run(&mut build(most));
        for (k, touch) in touches.iter().enumerate().skip(1).take(touches.len() - 2) {
            for target in targets_at(&touch.contact) {
                let mut path = build(target);
                let first = run(&mut path);
                let [asked, found] = compared(target, &path.state().unwrap().contact);
                assert_eq!((path.end(), found), (Some(AdhesiveEnd::Target), asked), "{k}");
                // From there on as if nothing had been.
                path.load_to(most).unwrap();
                let later = run(&mut path);
                let own = first.iter().chain(&later).filter(|s| s.event == AdhesiveEvent::Touch);
                let own: Vec<ContactState> = own.map(|state| state.contact).collect();
                assert_eq!(own.len(), touches.len(), "{k} {target:?}");
                // Windows that begin at the first target round otherwise.
                let kind = targets_at(&touch.contact).iter().position(|other| *other == target);
                let target = targets_at(&own[k])[kind.unwrap()];
                path.unload_to(target).unwrap();
                run(&mut path);
                let back = path.state().unwrap();
                let [asked, found] = compared(target, &back.contact);
                assert_eq!((path.end(), found), (Some(AdhesiveEnd::Target), asked), "{k}");
                // The node that touched there is in contact, with no pressure.
                assert_eq!((back.event, back.contact.contact_nodes), (AdhesiveEvent::Limit, k + 1));
            }
        }
        let (low, high) = (touches[5].contact, touches[touches.len() - 2].contact);
        for (near, far) in targets_at(&low).into_iter().zip(targets_at(&high)) {
            for pair in [[near, far], [far, near]] {
                let path = builder(&surface, &*kernel, 0.0).until(pair[0]).until(pair[1]);
                let mut path = path.build().unwrap();
                let states = run(&mut path);
                let [asked, found] = compared(near, &states.last().unwrap().contact);
                assert_eq!(found, asked, "of {pair:?} the first that is reached");
                let (load, all) = (ContactTarget::Load(high.load), states.len());
                path.load_to(load).unwrap();
                let more = run(&mut path);
                path.unload_to(near).unwrap();
                let back = run(&mut path);
                let states = [states, more, back].concat().into_iter().collect();
                assert!(AdhesiveRecord::new(&path, states).is_ok(), "{pair:?} {all}");
            }
        }
    }
}

/// What is reached with the last node to touch is a target, however the branch came there, and has no state of its own.
#[test]
fn full_contact_is_a_target() {
    let surface = surface();
    for (kernel, work) in kernels().iter().flat_map(|kernel| [0.0, 4e-4].map(|w| (kernel, w))) {
        let whole = run(&mut builder(&surface, &**kernel, work).build().unwrap());
        let last = whole.last().unwrap().contact;
        assert_eq!(last.contact_area_fraction, 1.0);
        let targets = [
            ContactTarget::AreaFraction(1.0),
            ContactTarget::MeanGap(last.mean_gap),
            ContactTarget::Load(last.load),
            ContactTarget::Approach(last.approach),
        ];
        for target in targets {
            let mut path = builder(&surface, &**kernel, work).until(target).build().unwrap();
            let touched = |states: &[AdhesiveState]| {
                states.iter().filter(|s| s.event == AdhesiveEvent::Touch).count()
            };
            let first = run(&mut path);
            assert_eq!(path.end(), Some(AdhesiveEnd::Target), "{work} {target:?}");
            if work == 0.0 {
                assert_eq!(first, whole, "{target:?}");
            }
            // Again from where it is, and from less contact.
            let present = path.state().unwrap().contact;
            path.load_to(target).unwrap();
            run(&mut path);
            assert_eq!(path.end(), Some(AdhesiveEnd::Target), "{work} {target:?}");
            // A solution begins there once more, and rounds otherwise.
            assert_relative!(path.state().unwrap().contact.load, present.load, 1e-12);
            path.unload_to(ContactTarget::AreaFraction(0.3)).unwrap();
            run(&mut path);
            path.load_to(ContactTarget::AreaFraction(1.0)).unwrap();
            assert!(touched(&run(&mut path)) > 0);
            assert_eq!(path.end(), Some(AdhesiveEnd::Target), "{work} {target:?}");
        }
    }
}

/// A loading to an area has the same states whether it was interrupted or not.
#[test]
fn interrupted_loadings_to_an_area_end_alike() {
    let surface = surface();
    for (kernel, work) in kernels().iter().flat_map(|kernel| [0.0, 4e-4].map(|w| (kernel, w))) {
        let build = || {
            let area = ContactTarget::AreaFraction(0.3);
            builder(&surface, &**kernel, work).until(area).build().unwrap()
        };
        let whole = run(&mut build());
        for taken in [1, 7, whole.len() - 1] {
            let mut path = build();
            let states: Vec<AdhesiveState> =
                path.by_ref().take(taken).map(Result::unwrap).collect();
            let record = AdhesiveRecord::new(&path, states.into_iter().collect()).unwrap();
            let mut other = record.path().unwrap();
            let rest = run(&mut other);
            assert_eq!(other.end(), Some(AdhesiveEnd::Target), "{work} {taken}");
            assert_eq!(rest.len(), whole.len() - taken, "{work} {taken}");
            for (found, expected) in rest.iter().zip(&whole[taken..]) {
                assert_eq!((found.event, found.node), (expected.event, expected.node));
            }
        }
    }
}

/// A branch that was left before its end has no say in the next one.
#[test]
fn without_adhesion_an_early_turn_forgets_the_first_target() {
    let surface = surface();
    for kernel in kernels() {
        let whole = builder(&surface, &*kernel, 0.0).until(ContactTarget::AreaFraction(0.5));
        let whole = run(&mut whole.build().unwrap());
        let (near, far) = (whole[12].contact, whole[25].contact);
        for target in targets_at(&near).into_iter().chain([ContactTarget::AreaFraction(0.15)]) {
            for asked in targets_at(&far).into_iter().chain([ContactTarget::AreaFraction(0.3)]) {
                let mut path = builder(&surface, &*kernel, 0.0).until(target).build().unwrap();
                assert_eq!(path.by_ref().take(3).count(), 3);
                path.unload().unwrap();
                assert_eq!(run(&mut path).len(), 3);
                path.load_to(asked).unwrap();
                let last = *run(&mut path).last().unwrap();
                assert_eq!(path.end(), Some(AdhesiveEnd::Target), "{target:?} {asked:?}");
                match asked {
                    ContactTarget::AreaFraction(_) => assert_eq!(last.contact.contact_nodes, 30),
                    _ => {
                        let [asked, found] = compared(asked, &last.contact);
                        assert_eq!(found, asked);
                    }
                }
            }
        }
    }
}

/// What is met already is where the path is.
#[test]
fn what_is_met_already_changes_nothing() {
    let surface = surface();
    for (kernel, work) in kernels().iter().flat_map(|kernel| [0.0, 4e-4].map(|w| (kernel, w))) {
        let path = builder(&surface, &**kernel, work).until(ContactTarget::AreaFraction(0.4));
        let states = run(&mut path.build().unwrap());
        let [.., before, last] = &states[..] else { panic!() };
        let load = ContactTarget::Load(0.5 * (before.contact.load + last.contact.load));
        let path = builder(&surface, &**kernel, work).until(load);
        let mut path = path.build().unwrap();
        run(&mut path);
        let here = path.state().unwrap();
        let area = ContactTarget::AreaFraction(here.contact.contact_area_fraction);
        for target in targets_at(&here.contact) {
            path.load_to(target).unwrap();
            assert_eq!(
                run(&mut path).last().unwrap().contact.contact_nodes,
                here.contact.contact_nodes
            );
            // Of an approach or a gap the load is interpolated.
            let is_here = |load: f64| (load / here.contact.load - 1.0).abs() < 1e-13;
            assert!(is_here(path.state().unwrap().contact.load), "{work} {target:?}");
            path.unload_to(target).unwrap();
            run(&mut path);
            assert!(is_here(path.state().unwrap().contact.load), "{work} {target:?}");
        }
        path.load_to(area).unwrap();
        let states = run(&mut path);
        // Not back to where the last of these nodes touched, and not beyond the next touch.
        assert!(states.iter().all(|state| state.contact.load >= here.contact.load), "{work}");
        let there = path.state().unwrap().contact;
        assert_eq!(
            (path.end(), there.contact_nodes),
            (Some(AdhesiveEnd::Target), here.contact.contact_nodes)
        );
        path.unload_to(area).unwrap();
        run(&mut path);
        assert_eq!(
            path.state().unwrap().contact.contact_nodes,
            here.contact.contact_nodes,
            "{work}"
        );
    }
}

/// Targets behind the state: before the first one too, at no net load, and pulls where nothing sticks.
#[test]
fn what_lies_behind_is_refused() {
    let surface = surface();
    let is_behind = |done: Result<(), Error>| {
        matches!(done, Err(Error::Adhesion(AdhesionError::Behind { .. })))
    };
    for kernel in kernels() {
        let sticky = || builder(&surface, &*kernel, 4e-4).build().unwrap();
        for target in [ContactTarget::Approach(-10.0), ContactTarget::MeanGap(10.0)] {
            assert!(is_behind(sticky().load_to(target)), "{target:?}");
        }
        let mut path = sticky();
        path.load_to(ContactTarget::Load(-1e-6)).unwrap();
        assert_eq!(run(&mut path).last().unwrap().contact.load, -1e-6);
        path.load_to(ContactTarget::Load(1e-3)).unwrap();
        run(&mut path);
        path.unload_to(ContactTarget::Load(0.0)).unwrap();
        run(&mut path);
        assert!(path.state().unwrap().soft_nodes > 0);
        assert!(is_behind(path.load_to(ContactTarget::Load(-1e-6))));
        let mut plain = builder(&surface, &*kernel, 0.0).build().unwrap();
        assert!(is_behind(plain.load_to(ContactTarget::Load(-1.0))));
        plain.load_to(ContactTarget::Load(1e-3)).unwrap();
        assert_eq!(run(&mut plain).last().unwrap().contact.load, 1e-3);
        plain.unload().unwrap();
        run(&mut plain);
        assert!(is_behind(plain.load_to(ContactTarget::Load(-1.0))));
    }
}

/// As many nodes as there are: none parts, also where the next one is about to.
#[test]
fn areas_that_are_met_lose_no_node() {
    for kernel in kernels() {
        for work in [1e-3, 0.0] {
            let mut nodes = 0;
            for steps in 1.. {
                let mut path = builder(&surface(), &*kernel, work).build().unwrap();
                let states: Vec<_> = path.by_ref().take(steps).map(Result::unwrap).collect();
                let last = states[states.len() - 1];
                if last.contact.contact_nodes > nodes {
                    nodes = last.contact.contact_nodes;
                    let area = ContactTarget::AreaFraction(last.contact.contact_area_fraction);
                    path.unload_to(area).unwrap();
                    let back = run(&mut path);
                    let found = path.state().unwrap().contact;
                    assert_eq!(found.contact_nodes, nodes, "{work} {steps} {back:?}");
                    assert_eq!(path.end(), Some(AdhesiveEnd::Target));
                }
                if states.len() < steps {
                    break;
                }
            }
            assert_eq!(nodes, kernel.grid().nodes());
        }
    }
}

/// Without adhesion a path may turn around between two touches, and end before the first of them.
#[test]
fn limits_behind_the_last_touch_turn_around() {
    for kernel in kernels() {
        let whole = run(&mut builder(&surface(), &*kernel, 0.0).build().unwrap());
        let between = |part: f64| {
            let [from, to] = [30, 31].map(|k| whole[k].contact.load);
            ContactTarget::Load((1.0 - part) * from + part * to)
        };
        let limit = |path: &mut AdhesivePath| {
            let states = run(path);
            assert_eq!(path.end(), Some(AdhesiveEnd::Target));
            states[states.len() - 1]
        };
        let mut path = builder(&surface(), &*kernel, 0.0).until(between(0.7)).build().unwrap();
        assert_eq!(limit(&mut path).event, AdhesiveEvent::Limit);
        path.unload_to(between(0.4)).unwrap();
        let back = limit(&mut path);
        let mut straight = builder(&surface(), &*kernel, 0.0).until(between(0.4)).build().unwrap();
        assert_eq!(back.contact, limit(&mut straight).contact);
        path.unload().unwrap();
        assert_eq!(run(&mut path).len(), 31);
    }
}

/// Of several areas the one that is behind is named, and a single cell that repeats says what is wrong.
#[test]
fn what_is_refused_is_named() {
    let [kernel, _] = kernels();
    let mut path = builder(&surface(), &*kernel, 1e-3)
        .until(ContactTarget::AreaFraction(0.3))
        .build()
        .unwrap();
    run(&mut path);
    let areas = [0.5, 0.2].map(ContactTarget::AreaFraction);
    let refused = path.load_to_first_of(&areas);
    let named = |value: f64| value == 0.2;
    assert!(
        matches!(refused, Err(Error::Adhesion(AdhesionError::Behind { value, .. })) if named(value)),
        "{refused:?}"
    );
    let cell = PeriodicBoussinesq::new(Grid::square(1, 1.0).unwrap(), 1.0).unwrap();
    let flat = HeightMap::new(DMatrix::zeros(1, 1)).unwrap();
    for law in [Adhesion::work(1.0), Adhesion::work(1.0).range(0.5)] {
        let refused = AdhesivePath::builder(&flat, &cell, law).build();
        assert!(
            matches!(refused, Err(Error::OutOfRange { value: 0.0, expected, .. }) if expected.contains("single cell")),
            "{refused:?}"
        );
    }
}
