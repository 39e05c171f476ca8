//! Growing contact in closed form, against the solver in steps of time and against itself.

use asperity::bed::Bed;
use asperity::creep::{
    Control, ControlHistory, Creep, CycleSettings, PiecewiseLinear, Prony, Relaxation, Steps,
    Unloading, ViscoelasticBed,
};
use asperity::loading::History;
use asperity::surface::HeightMap;
use asperity::{
    BedError, Boussinesq, CreepError, Error, Grid, InfluenceKernel, LoadingSolver,
    PeriodicBoussinesq, Spectral,
};
use proptest::prelude::*;

use crate::stepping::{Stepping, To, rough};

pub(crate) struct Case {
    heights: HeightMap,
    kernel: Box<dyn InfluenceKernel>,
    path: LoadingSolver,
    pub(crate) history: History,
}

pub(crate) fn case(kernel: Box<dyn InfluenceKernel>, seed: u64) -> Case {
    let heights = rough(&kernel.grid(), seed);
    let mut path = LoadingSolver::builder(&heights, &*kernel).build().unwrap();
    let history = path.by_ref().collect::<Result<_, _>>().unwrap();
    Case { heights, kernel, path, history }
}

fn free() -> Case {
    case(Box::new(Boussinesq::new(Grid::square(16, 1.0).unwrap(), 1.0).unwrap()), 5)
}

pub(crate) fn solid() -> Prony {
    Prony::shares(&[(0.1, 0.5), (1.0, 0.3)]).unwrap()
}

fn fluid() -> Prony {
    Prony::shares(&[(0.1, 0.6), (1.0, 0.4)]).unwrap()
}

/// A load held, and one that is taken away so slowly that contact grows all the same: contact, approach and mean gap to
/// rounding whatever the step, and pressures with errors that fall by the square of it.
#[test]
fn pressures_of_the_solver_converge_to_the_closed_form() {
    let mut case = free();
    let bed = Bed::new(&case.history).unwrap();
    for (body, corners, end) in [
        (solid(), vec![(0.0, 0.0), (0.0, bed.loads()[30])], 1.0),
        (
            fluid(),
            vec![
                (0.0, 0.0),
                (0.4, bed.loads()[30]),
                (0.8, bed.loads()[30]),
                (1.6, 0.8 * bed.loads()[30]),
            ],
            1.6,
        ),
    ] {
        let load = PiecewiseLinear::new(corners).unwrap();
        let creep = Creep::new(&bed, &body, &load).unwrap();
        let state = creep.at(end).unwrap();
        let truth = creep.pressure(end, usize::MAX).unwrap();
        let truth = truth.pressure(&bed, &mut case.path).unwrap();
        let mut errors = Vec::new();
        for steps in [20, 40, 80] {
            let mut solver = Stepping::new(&case.heights, &*case.kernel, &body);
            if load.value_at(0.0) > 0.0 {
                solver.step(0.0, To::Load(load.value_at(0.0)));
            }
            for k in 1..=steps {
                let time = f64::from(k) * end / f64::from(steps);
                solver.step(end / f64::from(steps), To::Load(load.value_at(time)));
            }
            assert_eq!(solver.nodes(), state.contact_nodes, "{steps}");
            // Rounding of the dense solves, with the condition number of some 10².
            assert!((solver.approach / state.approach - 1.0).abs() < 1e-12, "{steps}");
            assert!((solver.mean_gap() / state.mean_gap - 1.0).abs() < 1e-12, "{steps}");
            let differences = solver.pressure.iter().zip(&truth).map(|(a, b)| (a - b).abs());
            errors.push(differences.fold(0.0, f64::max) / truth.max());
        }
        println!("{errors:?}");
        // The square of the step, as far as these errors are asymptotic.
        assert!(errors[2] < 0.35 * errors[1] && errors[1] < 0.4 * errors[0], "{errors:?}");
        assert!(errors[2] < 1e-3, "{errors:?}");
    }
}

/// The load that increments with the weights R(t − s) carry is W(t): ∫ R dW_e = W, in closed form on both sides.
#[test]
fn increments_carry_the_load() {
    let case = free();
    let bed = Bed::new(&case.history).unwrap();
    let wide = Prony::shares(&[(1e-4, 0.2), (1e-2, 0.2), (1.0, 0.3), (1e3, 0.25)]).unwrap();
    let top = bed.loads()[8];
    let load =
        PiecewiseLinear::ramp(top, 0.01).unwrap().hold(5.0).unwrap().to(1.3 * top, 2.0).unwrap();
    let load = load.jump(1.5 * top).unwrap();
    for body in [solid(), fluid(), wide] {
        let creep = Creep::new(&bed, &body, &load).unwrap();
        assert_eq!(creep.recession(), None);
        for time in [1e-5, 1e-3, 0.01, 0.02, 0.5, 5.0, 6.5, 7.01, 8.0] {
            let state = creep.at(time).unwrap();
            let carried = creep.pressure(time, usize::MAX).unwrap().load();
            // Sums of some hundred terms of one sign.
            assert!((carried / state.load - 1.0).abs() < 1e-12, "{time}: {carried} {}", state.load);
        }
    }
}

/// The time of an event is that at which the effective load is its load; states just before have one node less.
#[test]
fn events_have_their_times() {
    let case = free();
    let bed = Bed::new(&case.history).unwrap();
    let top = bed.loads()[20];
    let histories = [
        PiecewiseLinear::step(top).unwrap(),
        PiecewiseLinear::ramp(top, 0.3).unwrap().hold(2.0).unwrap().jump(2.0 * top).unwrap(),
        PiecewiseLinear::ramp(top, 1e-5).unwrap(),
    ];
    for body in [solid(), fluid(), Prony::elastic(1.0).unwrap()] {
        for load in &histories {
            let creep = Creep::new(&bed, &body, load).unwrap();
            let times = creep.times();
            assert!(times.len() > 20);
            assert!(times.windows(2).all(|pair| pair[0] <= pair[1]));
            let last = creep.effective_load(1e9).min(bed.last_load());
            let reached = bed.loads().iter().filter(|knot| **knot <= last * (1.0 - 1e-12)).count();
            assert!(times.len() >= reached, "{} of {reached}", times.len());
            for (time, knot) in times.iter().zip(bed.loads()) {
                let found = creep.effective_load(*time);
                let is_jump = load.corners().iter().any(|corner| corner.0 == *time);
                if !is_jump && *time < 1e6 {
                    // Rounding of times that are sums, where the load grows at its fastest rate.
                    assert!(
                        (found - knot).abs() <= 1e-12 * bed.last_load(),
                        "{time}: {found} {knot}"
                    );
                } else {
                    assert!(found >= knot * (1.0 - 1e-12));
                }
            }
            let one = creep.time_of(bed.loads()[15]).unwrap();
            assert!((one - times[15]).abs() <= 1e-13 * times[15].max(1e-6), "{one} {}", times[15]);
        }
    }
}

/// A bed that is stepped has the same contact, as long as it grows: whatever the steps.
#[test]
fn the_bed_grows_as_the_closed_form_does() {
    let case = free();
    let bed = Bed::new(&case.history).unwrap();
    let top = bed.loads()[25];
    let load = PiecewiseLinear::step(0.5 * top).unwrap().hold(0.7).unwrap().to(top, 0.4).unwrap();
    for body in [solid(), fluid()] {
        let creep = Creep::new(&bed, &body, &load).unwrap();
        let mut contact = ViscoelasticBed::new(&bed, &body).unwrap();
        let times = Steps::default().times(&body, &load, 3.0).unwrap();
        let states = contact.follow(&ControlHistory::Load(load.clone()), &times).unwrap();
        assert_eq!(states.len(), times.len());
        for (state, time) in states.iter().zip(times) {
            let expected = creep.at(time).unwrap();
            assert_eq!(state.time, time);
            assert_eq!(state.contact_nodes, expected.contact_nodes, "{time}");
            for (found, expected) in [
                (state.effective_load, expected.effective_load),
                (state.load, expected.load),
                (state.approach, expected.approach),
                (state.mean_gap, expected.mean_gap),
            ] {
                // Sums over two hundred elements and as many steps.
                assert!((found - expected).abs() <= 1e-12 * expected, "{time}: {found} {expected}");
            }
        }
        assert_eq!(contact.halvings(), 0);
    }
}

/// An approach that is held: the contact stays, and W = R W_el. One that grows in steps and ramps, against the solver.
#[test]
fn loads_relax_at_a_given_approach() {
    let mut case = free();
    let bed = Bed::new(&case.history).unwrap();
    let approach = bed.approaches()[60];
    let body = solid();
    let held = Relaxation::new(&bed, &body, &PiecewiseLinear::step(approach).unwrap()).unwrap();
    for time in [0.0, 0.05, 1.0, 20.0] {
        let state = held.at(time).unwrap();
        let expected = bed.loads()[60] * body.relaxation_at(time);
        assert!((state.load / expected - 1.0).abs() < 1e-13, "{time}");
        assert_eq!((state.contact_nodes, state.approach), (61, approach));
        let pressure = held.pressure(time, usize::MAX).unwrap();
        assert_eq!(held.pressure(time, 1).unwrap().pieces().len(), 1);
        assert!((pressure.load() / expected - 1.0).abs() < 1e-13);
    }
    // First apart, then in contact, with a jump; at the end between two events, so that both sides count the same
    // nodes.
    let between = 0.5 * (approach + bed.approaches()[61]);
    let corners = [
        (0.0, -approach),
        (0.5, 0.6 * approach),
        (0.8, 0.6 * approach),
        (0.8, 0.7 * approach),
        (1.5, between),
    ];
    let course = PiecewiseLinear::new(corners).unwrap();
    let growing = Relaxation::new(&bed, &body, &course).unwrap();
    assert_eq!(growing.recession(), None);
    let apart = growing.at(0.1).unwrap();
    assert_eq!((apart.contact_nodes, apart.load), (0, 0.0));
    assert!((apart.mean_gap - (bed.mean_gaps()[0] - apart.approach)).abs() < 1e-15);
    let mut errors = Vec::new();
    for steps in [60, 120, 240] {
        let mut solver = Stepping::new(&case.heights, &*case.kernel, &body);
        solver.step(0.0, To::Approach(-approach));
        for k in 1..=steps {
            let time = 1.5 * f64::from(k) / f64::from(steps);
            if k * 15 == 8 * steps {
                solver.step(1.5 / f64::from(steps), To::Approach(0.6 * approach));
                solver.step(0.0, To::Approach(0.7 * approach));
            } else {
                solver.step(1.5 / f64::from(steps), To::Approach(course.value_at(time)));
            }
        }
        let state = growing.at(1.5).unwrap();
        assert_eq!(state.contact_nodes, solver.nodes());
        errors.push((solver.load() / state.load - 1.0).abs());
        let pressure = growing.pressure(1.5, usize::MAX).unwrap();
        assert!((pressure.load() / state.load - 1.0).abs() < 1e-12);
        let pressure = pressure.pressure(&bed, &mut case.path).unwrap();
        let differences = solver.pressure.iter().zip(&pressure).map(|(a, b)| (a - b).abs());
        assert!(differences.fold(0.0, f64::max) < 30.0 / f64::from(steps * steps) * pressure.max());
    }
    println!("{errors:?}");
    assert!(errors[2] < 0.3 * errors[1] && errors[1] < 0.3 * errors[0], "{errors:?}");
    // Times of the knots: δ of each.
    let times = growing.times();
    assert_eq!(times.len(), 61);
    for (time, knot) in times.iter().zip(bed.approaches()) {
        assert!(course.value_at(*time) >= knot - 1e-12 * approach, "{time} {knot}");
        assert!(course.value_at(*time * (1.0 - 1e-12)) <= knot + 1e-11 * approach);
    }
    let falling = PiecewiseLinear::ramp(approach, 1.0).unwrap().to(0.5 * approach, 1.0).unwrap();
    let falling = Relaxation::new(&bed, &body, &falling).unwrap();
    assert_eq!(falling.recession(), Some(1.0));
    assert!(falling.at(1.0).is_ok());
    // As far as it rises, in proportion; whether the last knot is reached when it turns is rounding.
    let times = falling.times();
    assert!((60..=61).contains(&times.len()), "{}", times.len());
    for (time, knot) in times.iter().zip(bed.approaches()) {
        assert!((time - knot / approach).abs() < 1e-12, "{time}");
    }
    let refused = falling.at(1.001);
    assert!(matches!(refused, Err(Error::Creep(CreepError::ContactRecedes { time: 1.0, .. }))));
    // Behind a jump down not even the state at once is one of the path.
    let jump = [(0.0, 0.0), (1.0, approach), (1.0, 0.5 * approach)];
    let jump = Relaxation::new(&bed, &body, &PiecewiseLinear::new(jump).unwrap()).unwrap();
    assert!(jump.at(0.999).is_ok());
    let refused = jump.at(1.0);
    assert!(matches!(refused, Err(Error::Creep(CreepError::ContactRecedes { time: 1.0, .. }))));
    // Contact that has been beyond the path has no state behind it, wherever the approach is then.
    let end = case.history.states()[99].contact.approach;
    let short: History = case.history.states()[..100].iter().copied().collect();
    let short = Bed::new(&short).unwrap();
    let there = PiecewiseLinear::new([(0.0, 0.0), (1.0, 2.0 * end), (2.0, 0.5 * end)]).unwrap();
    let there = Relaxation::new(&short, &body, &there).unwrap();
    assert!(there.at(0.499).is_ok());
    for time in [0.51, 1.0, 1.9, 3.0] {
        match there.at(time) {
            Err(Error::Bed(BedError::PathEndsBefore { value, end: found, .. })) => {
                assert!(value > end && found == end, "{time}: {value}");
            }
            other => panic!("{other:?}"),
        }
    }
}

/// Kernels of periodic half-spaces and long cells: a held load against the solver, contact and mean gap to rounding.
#[test]
fn other_half_spaces() {
    let square = Grid::square(12, 1.0).unwrap();
    let kernels: [Box<dyn InfluenceKernel>; 3] = [
        Box::new(PeriodicBoussinesq::new(square, 1.0).unwrap()),
        Box::new(Spectral::new(square, 1.0).unwrap()),
        Box::new(Boussinesq::new(Grid::new(12, 20, 0.2, 0.1).unwrap(), 1.0).unwrap()),
    ];
    for kernel in kernels {
        let case = case(kernel, 9);
        let bed = Bed::new(&case.history).unwrap();
        let body = solid();
        let load = PiecewiseLinear::step(bed.loads()[12]).unwrap();
        let creep = Creep::new(&bed, &body, &load).unwrap();
        let mut solver = Stepping::new(&case.heights, &*case.kernel, &body);
        solver.step(0.0, To::Load(bed.loads()[12]));
        for k in 1..=20 {
            solver.step(0.1, To::Load(bed.loads()[12]));
            let state = creep.at(0.1 * f64::from(k)).unwrap();
            assert_eq!(solver.nodes(), state.contact_nodes);
            let scale = bed.mean_gaps()[0];
            assert!((solver.mean_gap() - state.mean_gap).abs() < 1e-12 * scale);
        }
    }
}

/// Behind full contact everything is linear, and contact stays full.
#[test]
fn full_contact_stays() {
    let grid = Grid::square(8, 1.0).unwrap();
    let case = case(Box::new(PeriodicBoussinesq::new(grid, 1.0).unwrap()), 2);
    let bed = Bed::new(&case.history).unwrap();
    let last = bed.last_load();
    let creep = Creep::new(&bed, &solid(), &PiecewiseLinear::step(0.5 * last).unwrap()).unwrap();
    let state = creep.at(1e3).unwrap();
    assert!(state.effective_load > last);
    assert_eq!((state.contact_nodes, state.contact_area_fraction), (64, 1.0));
    assert_eq!(creep.times().len(), 64);
    let mut contact = ViscoelasticBed::new(&bed, &solid()).unwrap();
    let course = ControlHistory::Load(PiecewiseLinear::step(0.5 * last).unwrap());
    let stepped = contact.follow(&course, &[0.0, 0.1, 1.0, 10.0, 1e3]).unwrap();
    let stepped = stepped.last().unwrap();
    assert_eq!(stepped.contact_nodes, 64);
    assert!((stepped.effective_load / state.effective_load - 1.0).abs() < 1e-12);
    assert!((stepped.approach / state.approach - 1.0).abs() < 1e-12);
    assert!(stepped.mean_gap.abs() < 1e-14 && state.mean_gap.abs() < 1e-14);
    let carried = contact.pressure(usize::MAX).unwrap().load();
    assert!((carried / (0.5 * last) - 1.0).abs() < 1e-12);
}

/// The path ends where it ends: with the time until which it is enough.
#[test]
fn the_end_of_the_path_has_a_time() {
    let grid = Grid::square(12, 1.0).unwrap();
    let half_space = Boussinesq::new(grid, 1.0).unwrap();
    let path = LoadingSolver::builder(&rough(&grid, 3), &half_space).max_nodes(40).build().unwrap();
    let history: History = path.collect::<Result<_, _>>().unwrap();
    let bed = Bed::new(&history).unwrap();
    let load = 0.5 * bed.last_load();
    let creep = Creep::new(&bed, &fluid(), &PiecewiseLinear::step(load).unwrap()).unwrap();
    let Err(Error::Creep(CreepError::PathEnds { until, path_ends, effective_load, .. })) =
        creep.at(100.0)
    else {
        panic!("the path is long enough");
    };
    assert_eq!(path_ends, bed.last_load());
    assert!(effective_load > path_ends);
    assert!((creep.effective_load(until) / path_ends - 1.0).abs() < 1e-13);
    assert_eq!(creep.at(until * (1.0 - 1e-12)).unwrap().contact_nodes, 39);
    // A solid that the path is enough for for ever.
    let weak = Creep::new(&bed, &solid(), &PiecewiseLinear::step(0.15 * bed.last_load()).unwrap())
        .unwrap();
    assert!(weak.at(f64::INFINITY).is_ok());
    assert_eq!(weak.time_of(bed.last_load()), None);
}

/// At an approach that is held, contact and gaps stay, also where a body has flowed until nothing but rounding is left
/// of its load.
#[test]
fn a_fluid_keeps_its_contact_at_an_approach_that_is_held() {
    let case = free();
    let bed = Bed::new(&case.history).unwrap();
    // At the first touch, between two events, and between the last two.
    for (from, to) in [(0, 1), (60, 61), (254, 255)] {
        let approach = 0.5 * (bed.approaches()[from] + bed.approaches()[to]);
        for body in [fluid(), Prony::shares(&[(1.0, 1.0)]).unwrap()] {
            let course = PiecewiseLinear::step(approach).unwrap();
            let held = Relaxation::new(&bed, &body, &course).unwrap();
            for step in [0.25, 1.0, 7.0] {
                let mut contact = ViscoelasticBed::new(&bed, &body).unwrap();
                contact.step(0.0, Control::Approach(approach)).unwrap();
                for _ in 0..200 {
                    let state = contact.step(step, Control::Approach(approach)).unwrap();
                    let expected = held.at(state.time).unwrap();
                    assert_eq!(state.contact_nodes, expected.contact_nodes, "{state:?}");
                    assert_eq!(state.contact_area, expected.contact_area);
                    let off = (state.mean_gap - expected.mean_gap).abs();
                    assert!(off <= 1e-12 * bed.mean_gaps()[0], "{state:?}");
                }
                let first = bed.at_approach(approach).unwrap().load;
                assert!(contact.state().load <= 1e-12 * first);
            }
        }
    }
}

/// A body that only flows: contact grows as long as the load times its fluidity outweighs the fall of the load.
#[test]
fn a_fluid_recedes_on_a_long_ramp() {
    let case = free();
    let bed = Bed::new(&case.history).unwrap();
    let maxwell = Prony::shares(&[(1.0, 1.0)]).unwrap();
    let load = 0.1 * bed.last_load();
    // Wₑ = W + ∫ W dt: its rate L(−1 + 1 − z) falls at once, and L(−1/4 + 1 − z/4) behind three.
    for (length, from) in [(1.0, 1.0), (4.0, 4.0)] {
        let falls = PiecewiseLinear::ramp(load, 1.0).unwrap().to(0.0, length).unwrap();
        let creep = Creep::new(&bed, &maxwell, &falls).unwrap();
        let found = creep.recession().map(|recession| recession.time);
        assert!(found.is_some_and(|time| (time - from).abs() < 1e-12), "{found:?}");
        assert!(creep.at(1.0 + length).is_err() && creep.at(0.5).is_ok());
    }
    // Elastic bodies recede as soon as the load falls.
    let falls = PiecewiseLinear::ramp(load, 1.0).unwrap().to(0.0, 1e9).unwrap();
    let creep = Creep::new(&bed, &Prony::elastic(1.0).unwrap(), &falls).unwrap();
    assert_eq!(creep.recession().map(|recession| recession.time), Some(1.0));
}

/// All that the path bears, in one step or in two, now and after creep; and not a thousandth more.
#[test]
fn the_whole_path_is_borne() {
    let case = free();
    let short: History = case.history.states()[..100].iter().copied().collect();
    let bed = Bed::new(&short).unwrap();
    let (last, body) = (bed.last_load(), Prony::shares(&[(1.0, 0.5)]).unwrap());
    for part in [0.37, 0.61, 0.9] {
        let mut contact = ViscoelasticBed::new(&bed, &body).unwrap();
        contact.step(0.0, Control::Load(part * last)).unwrap();
        let state = contact.step(0.0, Control::Load(last)).unwrap();
        assert!((state.effective_load / last - 1.0).abs() < 1e-11);
        assert!(contact.step(0.0, Control::Load(1.001 * last)).is_err());
        // And the whole approach, again and again.
        let end = bed.approaches()[99];
        let mut contact = ViscoelasticBed::new(&bed, &body).unwrap();
        for control in [part * end, end, part * end, end.next_up(), part * end, end] {
            let state = contact.step(0.3, Control::Approach(control)).unwrap();
            assert!((state.approach / control - 1.0).abs() < 1e-11, "{state:?}");
        }
        assert!(contact.step(0.0, Control::Approach(1.001 * end)).is_err());
    }
    for beyond in [last.next_up(), last * (1.0 + 1e-13)] {
        assert_eq!(bed.at_load(beyond).unwrap(), bed.at_load(last).unwrap());
    }
    assert_eq!(bed.at_approach(bed.approaches()[99].next_up()).unwrap().load, last);
    // A load that grows for twenty relaxation times has come to some 1.9 times itself.
    for (load, is_borne) in [(0.5 * last, true), (0.6 * last, false)] {
        let mut contact = ViscoelasticBed::new(&bed, &body).unwrap();
        let refused = contact.step(20.0, Control::Load(load)).is_err();
        assert_eq!(refused, !is_borne, "{load}");
        // A step that is refused is none: the history begins with its own corner.
        let course = ControlHistory::Load(PiecewiseLinear::step(0.1 * last).unwrap());
        if refused {
            let states = contact.follow(&course, &[0.0, 1.0]).unwrap();
            assert!((states[0].load / (0.1 * last) - 1.0).abs() < 1e-12);
        }
    }
    let mut settled = ViscoelasticBed::new(&bed, &body).unwrap();
    settled.settle(0.5 * last).unwrap();
    // A recession from the very end of the path.
    let course = PiecewiseLinear::step(0.5 * last).unwrap().hold(100.0).unwrap();
    let creep = Creep::new(&bed, &body, &course.jump(0.1 * last).unwrap()).unwrap();
    let unloading = Unloading::new(&creep).unwrap();
    assert!(unloading.at(100.0).unwrap().contact.load < last);
}

/// At the load, or the approach, of an event its node touches, at once and however long it is held: elastic bodies do
/// not creep.
#[test]
fn knots_that_are_held_have_the_nodes_of_the_path() {
    let case = free();
    let bed = Bed::new(&case.history).unwrap();
    let elastic = Prony::elastic(1.0).unwrap();
    // The last one has no knot behind it.
    let events = case.history.states();
    for state in &events[1..events.len() - 1] {
        let mut contacts = [0, 1].map(|_| ViscoelasticBed::new(&bed, &elastic).unwrap());
        let control =
            [Control::Load(state.contact.load), Control::Approach(state.contact.approach)];
        for (contact, control) in contacts.iter_mut().zip(control) {
            for duration in [0.0, 0.3, 0.4, 0.3] {
                let found = contact.step(duration, control).unwrap();
                assert_eq!(found.contact_nodes, state.contact.contact_nodes, "{control:?}");
            }
        }
    }
}

/// A history that is asked for before its first corner has nothing there, and the corner is a jump all the same.
#[test]
fn nothing_bears_before_the_first_corner() {
    let case = free();
    let bed = Bed::new(&case.history).unwrap();
    let load = 0.1 * bed.last_load();
    let course = ControlHistory::Load(PiecewiseLinear::step(load).unwrap());
    let follow = |times: &[f64]| {
        let mut contact = ViscoelasticBed::new(&bed, &solid()).unwrap();
        contact.follow(&course, times).unwrap()
    };
    let (early, from_start) = (follow(&[-1.0, 0.0, 0.5]), follow(&[0.0, 0.5]));
    assert_eq!((early[0].time, early[0].load), (-1.0, 0.0));
    for (a, b) in early[1..].iter().zip(&from_start) {
        assert_eq!((a.time, a.load, a.approach), (b.time, b.load, b.approach));
    }
    // Piece by piece as well.
    let mut contact = ViscoelasticBed::new(&bed, &solid()).unwrap();
    for (time, once) in [-1.0, 0.0, 0.5].into_iter().zip(&early) {
        let states = contact.follow(&course, &[time]).unwrap();
        assert_eq!((states[0].load, states[0].approach), (once.load, once.approach));
    }
}

/// In full contact of a periodic half-space mean planes come no closer: a cycle is steady at once, and loses nothing.
#[test]
fn a_cycle_in_full_contact_is_steady() {
    let grid = Grid::square(8, 1.0).unwrap();
    let case = case(Box::new(PeriodicBoussinesq::new(grid, 1.0).unwrap()), 2);
    let bed = Bed::new(&case.history).unwrap();
    let load = bed.last_load();
    let mut contact = ViscoelasticBed::new(&bed, &solid()).unwrap();
    let cycle = contact.cycle(3.0 * load, 0.1 * load, 1.0, CycleSettings::default()).unwrap();
    assert!(cycle.approach_amplitude.abs() < 1e-14 && cycle.dissipation.abs() < 1e-14 * load);
    assert!(cycle.cycles < 50, "{}", cycle.cycles);
    for tolerance in [0.0, f64::NAN] {
        let settings = CycleSettings { tolerance, ..CycleSettings::default() };
        let refused = contact.cycle(3.0 * load, 0.1 * load, 1.0, settings);
        assert!(matches!(refused, Err(Error::NotPositive { .. })), "{refused:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    /// Where contact recedes: the effective load grows up to there, and falls behind it; the rate of a fine search
    /// finds no earlier fall. Bodies of up to four terms over eight decades, loads of up to eight corners and jumps.
    #[test]
    fn contact_recedes_where_the_effective_load_first_falls(
        terms in prop::collection::vec((-4.0..4.0_f64, 0.05..0.3_f64), 1..4),
        corners in prop::collection::vec((0.0..1.0_f64, -4.0..3.0_f64, prop::bool::weighted(0.2)), 1..8),
        flows in prop::bool::ANY,
    ) {
        let case = (1..40).map(|k| {
            let grid = Grid::square(8, 1.0).unwrap();
            let mut contact = asperity::ContactState::new(&grid, k, 0.1 * (k - 1) as f64, (k - 1) as f64, 10.0 - 0.1 * k as f64);
            contact.contact_stiffness = Some(10.0);
            contact.interfacial_stiffness = Some(10.0);
            asperity::LoadingState::new(k, asperity::ContactEvent::Touch, (k % 8, k / 8), contact)
        });
        let history: History = case.collect();
        let bed = Bed::new(&history).unwrap();
        let mut terms: Vec<_> = terms.iter().map(|t| (10_f64.powf(t.0), t.1)).collect();
        if flows {
            terms[0].1 += 1.0 - terms.iter().map(|term| term.1).sum::<f64>();
        }
        let body = Prony::shares(&terms).unwrap();
        let mut all = vec![(0.0, 0.0)];
        for (load, duration, jumps) in corners {
            let last = all[all.len() - 1].0;
            all.push((if jumps { last } else { last + 10_f64.powf(duration) }, load));
        }
        let load = PiecewiseLinear::new(all.clone()).unwrap();
        let creep = Creep::new(&bed, &body, &load).unwrap();
        let until = creep.recession().map_or(1e6, |recession| recession.time);
        // Times behind each corner, on a fine logarithmic grid.
        let mut before = 0.0_f64;
        for (k, &(start, _)) in all.iter().enumerate() {
            let end = all.get(k + 1).map_or(1e6, |next| next.0).min(until);
            for i in 0..300 {
                let time = start + (end - start) * 10_f64.powf(-9.0 + 0.03 * f64::from(i));
                if time >= until || time <= start {
                    continue;
                }
                let now = creep.effective_load(time);
                prop_assert!(now >= before * (1.0 - 1e-13), "{} after {} at {}", now, before, time);
                before = before.max(now);
            }
        }
        if let Some(recession) = creep.recession() {
            let span = recession.time + 1e-6;
            let later = (1..=40).map(|k| creep.effective_load(recession.time + span * 0.5_f64.powi(k)));
            let least = later.fold(f64::INFINITY, f64::min);
            prop_assert!(least < recession.effective_load, "{} {}", least, recession.effective_load);
            let refused = creep.at(recession.time + span);
            let is_refused = matches!(refused, Err(Error::Creep(CreepError::ContactRecedes { .. })));
            prop_assert!(is_refused);
        }
    }
}
