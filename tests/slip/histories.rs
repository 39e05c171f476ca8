//! What any history of both loads fulfils.

use asperity::bed::Bed;
use asperity::loading::History;
use asperity::slip::{Friction, PartialSlip, SlipHistory, SlipState, SlipZone};
use asperity::{
    BedError, Boussinesq, Error, Grid, InfluenceKernel, LoadingSolver, PeriodicBoussinesq,
    SlipError,
};
use asperity_testing::close::relative;
use proptest::prelude::*;

use crate::joints::rough_path;

const MU: f64 = 0.4;

fn path(seed: u64) -> (LoadingSolver, History) {
    rough_path(&Boussinesq::new(Grid::new(16, 12, 1.0, 1.5).unwrap(), 2.0).unwrap(), seed, 0.7)
}

fn friction() -> Friction {
    Friction::new(MU, 1.2).unwrap()
}

/// Steps of a history: a share of the last load, and one of what friction bears there. Some leave the load as it is.
fn steps() -> impl Strategy<Value = Vec<(f64, f64)>> {
    let load = prop_oneof![3 => (0.02..1.0_f64).prop_map(Some), 2 => Just(None)];
    prop::collection::vec((load, -0.99..0.99_f64), 1..25).prop_map(|steps| {
        let mut load = 0.6;
        let steps = steps.into_iter().map(move |(next, force)| {
            load = next.unwrap_or(load);
            (load, force)
        });
        std::iter::once((0.6, 0.0)).chain(steps).collect()
    })
}

fn assert_same(a: &SlipState, b: &SlipState, tolerance: f64, scale: [f64; 2]) {
    let context = format!("{a:?} {b:?}");
    assert!((a.tangential_load - b.tangential_load).abs() <= tolerance * scale[0], "{context}");
    assert!((a.displacement - b.displacement).abs() <= tolerance * scale[1], "{context}");
    let interfacial = (a.interfacial_displacement - b.interfacial_displacement).abs();
    assert!(interfacial <= tolerance * scale[1], "{context}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// The tangential load is the one asked for; energy that is lost never comes back, and what is neither lost nor
    /// stored has been done by T; ratios stay within friction.
    #[test]
    fn loads_and_energies_add_up(seed in 0_u64..8, steps in steps()) {
        let (_, history) = path(seed);
        let bed = Bed::new(&history).unwrap();
        let top = bed.at_load(bed.last_load()).unwrap();
        let mut joint = SlipHistory::new(&bed, friction());
        let (mut lost, mut work) = (0.0, 0.0);
        let mut last = joint.state();
        let scale = MU * top.load;
        for (load, force) in steps {
            let (load, force) = (load * top.load, MU * force * load * top.load);
            // In parts, for the work of T: to the second order in them.
            let parts = 64;
            let from = (last.load, last.tangential_load);
            for part in 1..=parts {
                let share = f64::from(part) / f64::from(parts);
                let between = |a: f64, b: f64| a + share * (b - a);
                let state = joint.to(between(from.0, load), between(from.1, force)).unwrap();
                let mean = 0.5 * (state.tangential_load + last.tangential_load);
                work += mean * (state.displacement - last.displacement);
                prop_assert!(joint.dissipation() >= lost);
                lost = joint.dissipation();
                last = state;
            }
            prop_assert!((last.tangential_load - force).abs() < 1e-13 * scale);
            prop_assert!(last.stick_load <= last.load);
            prop_assert_eq!(last.stick_nodes + last.slipping_nodes, bed.at_load(load).unwrap().contact_nodes);
            let superposition = joint.superposition().unwrap();
            prop_assert!(superposition.pieces().iter().all(|piece| piece.weight.abs() <= MU));
            let scalars = superposition.scalars(&bed).unwrap();
            prop_assert!((scalars.load - force).abs() < 1e-13 * scale);
            prop_assert!((1.2 * scalars.approach - last.displacement).abs() < 1e-13 * top.approach);
            let stored = joint.stored_energy().unwrap();
            prop_assert!(stored >= -1e-15 * scale * top.approach);
            // 64 parts of a step, and up to 25 steps, of curves that bend at events.
            prop_assert!((work - stored - lost).abs() < 2e-3 * scale * MU * top.approach, "{} {} {}", work, stored, lost);
        }
    }

    /// One step is the same as many along the same line.
    #[test]
    fn parts_of_a_step_change_nothing(seed in 0_u64..8, steps in steps(), parts in 2_usize..9) {
        let (_, history) = path(seed);
        let bed = Bed::new(&history).unwrap();
        let top = bed.at_load(bed.last_load()).unwrap();
        let (mut whole, mut divided) = (SlipHistory::new(&bed, friction()), SlipHistory::new(&bed, friction()));
        let mut from = (0.0, 0.0);
        let mut lost = 0.0;
        for (load, force) in steps {
            let to = (load * top.load, MU * force * load * top.load);
            let state = whole.to(to.0, to.1).unwrap();
            let mut last = divided.state();
            for part in 1..=parts {
                let share = part as f64 / parts as f64;
                last = divided.to(from.0 + share * (to.0 - from.0), from.1 + share * (to.1 - from.1)).unwrap();
            }
            // The last part ends where the step does.
            last = divided.to(to.0, to.1).unwrap_or(last);
            assert_same(&state, &last, 1e-11, [top.load, top.approach]);
            lost = whole.dissipation();
            // Differences of energies, as large as μ² W δ.
            let error = (lost - divided.dissipation()).abs();
            prop_assert!(error < 1e-10 * top.load * top.approach, "{} {}", lost, divided.dissipation());
            from = to;
        }
        prop_assert!(lost >= 0.0);
    }

    /// A loop of T that closes at constant load leaves no trace but what it has cost.
    #[test]
    fn closed_loops_are_forgotten(
        seed in 0_u64..8,
        steps in steps(),
        depths in prop::collection::vec(0.1..0.9_f64, 1..8),
    ) {
        let (_, history) = path(seed);
        let bed = Bed::new(&history).unwrap();
        let top = bed.at_load(bed.last_load()).unwrap();
        let mut joint = SlipHistory::new(&bed, friction());
        for (load, force) in steps {
            joint.to(load * top.load, MU * force * load * top.load).unwrap();
        }
        // On to a point from which T turns; a loop from there is closed if it does not reach below the slip zone.
        let load = joint.state().load;
        let force = 0.5 * (joint.state().tangential_load + MU * load);
        let front = joint.to(load, force).unwrap().stick_load;
        let before = joint.clone();
        let mut turns = vec![force, force - 1.9 * MU * (load - front)];
        for depth in depths {
            let (last, inner) = (turns[turns.len() - 2], turns[turns.len() - 1]);
            turns.push(inner + depth * (last - inner));
        }
        let closing: Vec<f64> = turns.iter().rev().copied().collect();
        for force in turns.into_iter().chain(closing) {
            joint.to(load, force).unwrap();
        }
        assert_same(&joint.state(), &before.state(), 1e-12, [top.load, top.approach]);
        let pieces = |joint: &SlipHistory| joint.superposition().unwrap().pieces().len();
        prop_assert_eq!(pieces(&joint), pieces(&before));
        prop_assert!(joint.dissipation() >= before.dissipation());
        // And it goes on as it would have done.
        let (mut a, mut b) = (joint.clone(), before.clone());
        let on = 0.5 * (force + MU * load);
        assert_same(&a.to(load, on).unwrap(), &b.to(load, on).unwrap(), 1e-12, [top.load, top.approach]);
    }
}

/// A history that comes back to no tangential load and goes on with one of rounding ends: the front of a slip zone that
/// has just begun does not stay where it is.
#[test]
fn tangential_loads_of_rounding_end() {
    let grid = Grid::new(16, 12, 1.0, 1.5).unwrap();
    let (_, history) = path(1);
    let scale = 410.0 / Bed::new(&history).unwrap().last_load();
    let half_space = Boussinesq::new(grid, 2.0 * scale).unwrap();
    let (_, history) = rough_path(&half_space, 1, 0.7);
    let bed = Bed::new(&history).unwrap();
    let friction = Friction::new(0.3, 1.0).unwrap();
    for force in 1..110 {
        for low in [6.0, 96.0, 130.0, 201.0] {
            for rest in [1e-20, -1e-20, 1e-17, 0.0] {
                let mut joint = SlipHistory::new(&bed, friction);
                joint.to(400.0, 0.0).unwrap();
                joint.to(400.0, f64::from(force)).unwrap();
                joint.to(400.0, 0.0).unwrap();
                let state = joint.to(low, rest).unwrap();
                assert!((state.tangential_load - rest).abs() < 1e-11, "{force} {low} {rest}");
            }
        }
    }
}

/// Less than rounding of a step is taken off as well, so that nothing is left in contact without a load.
#[test]
fn no_load_is_none() {
    let (_, history) = path(1);
    let bed = Bed::new(&history).unwrap();
    let load = 0.6 * bed.last_load();
    for tiny in [1e-20, 1e-140, 1e-250] {
        let mut joint = SlipHistory::new(&bed, friction());
        joint.to(tiny * load, 0.1 * MU * tiny * load).unwrap();
        joint.to(load, 0.0).unwrap();
        joint.to(load, 1e-9 * MU * load).unwrap();
        let state = joint.to(0.0, 0.0).unwrap();
        assert_eq!((state.load, state.stick_load, state.tangential_load), (0.0, 0.0, 0.0));
        assert!(joint.superposition().unwrap().pieces().is_empty());
    }
}

/// Where P falls by less and less, and T as far as friction lets it, as much is lost as at constant P.
#[test]
fn dissipations_of_small_steps_of_the_load_are_not_rounding() {
    let (_, history) = path(1);
    let bed = Bed::new(&history).unwrap();
    let load = 0.6 * bed.last_load();
    let joint = PartialSlip::new(&bed, load, friction()).unwrap();
    for turn in [0.5, 0.1, 1e-2] {
        let force = turn * MU * load;
        let expected = joint.cycle(force).unwrap().dissipation;
        for change in [0.0, 1e-15, 1e-12, -1e-12, 1e-10, 1e-8, -1e-8] {
            let mut history = SlipHistory::new(&bed, friction());
            history.to(load, 0.0).unwrap();
            history.to(load, force).unwrap();
            let before = history.dissipation();
            // Half of a cycle.
            history.to(load * (1.0 - change), -force).unwrap();
            let lost = history.dissipation() - before;
            // What P changes by over what slips of it, and rounding of sums over μPδ.
            let allowed = 10.0 * change.abs() / turn + 1e-11 / turn.powi(2);
            let scale = turn.powi(2) * joint.sliding_load() * joint.sliding_displacement();
            let error = (2.0 * lost - expected).abs();
            assert!(error <= allowed * scale, "{turn} {change}: {lost} {expected}");
        }
    }
}

/// Masing: a branch behind a turn is the first loading, twice as large in both directions.
#[test]
fn branches_are_the_first_loading_doubled() {
    let (_, history) = path(1);
    let bed = Bed::new(&history).unwrap();
    let load = 0.8 * bed.last_load();
    let joint = PartialSlip::new(&bed, load, friction()).unwrap();
    let limit = joint.sliding_load();
    let mut history = SlipHistory::new(&bed, friction());
    history.to(load, 0.0).unwrap();
    let turn = history.to(load, 0.85 * limit).unwrap();
    let first = joint.monotone(0.85 * limit).unwrap();
    assert_same(&turn, &first, 1e-13, [limit, first.displacement]);
    assert_eq!((turn.stick_nodes, turn.slipping_nodes), (first.stick_nodes, first.slipping_nodes));
    // So little that no node slips.
    for cycle in
        [joint.cycle(1e-18 * limit), joint.cycle_of_displacement(1e-20 * turn.displacement)]
    {
        let (cycle, stuck) = (cycle.unwrap(), joint.monotone(0.0).unwrap());
        assert!(relative(cycle.secant_stiffness, stuck.tangential_stiffness) < 1e-13);
        assert_eq!(cycle.dissipation, 0.0);
    }
    for share in [0.8, 0.5, 0.0, -0.4, -0.85] {
        let branch = history.to(load, share * limit).unwrap();
        let half = joint.monotone(0.5 * (0.85 - share) * limit).unwrap();
        let expected = turn.displacement - 2.0 * half.displacement;
        assert!((branch.displacement - expected).abs() < 1e-13 * turn.displacement, "{share}");
        assert!(relative(branch.tangential_stiffness, half.tangential_stiffness) < 1e-13);
        assert_eq!(branch.stick_nodes, half.stick_nodes);
        let stick = load - 0.5 * (0.85 - share) * limit / MU;
        assert!((branch.stick_load - stick).abs() < 1e-13 * load);
        assert!((branch.slip_area - 1.5 * branch.slipping_nodes as f64).abs() < 1e-10);
    }
}

/// dT/dU where T goes on as it went is the secant of a step in which no node begins to slip.
#[test]
fn tangential_stiffnesses_are_secants() {
    let grid = Grid::new(16, 12, 1.0, 1.5).unwrap();
    let free = Boussinesq::new(grid, 2.0).unwrap();
    let periodic = PeriodicBoussinesq::new(grid, 2.0).unwrap();
    let bodies: [&dyn InfluenceKernel; 2] = [&free, &periodic];
    for body in bodies {
        let (_, history) = rough_path(body, 3, 0.7);
        let bed = Bed::new(&history).unwrap();
        let mut joint = SlipHistory::new(&bed, friction());
        // On the first loading, back, with more load, with less, and with more of both.
        for (load, force, sign) in [
            (0.5, 0.6, 1.0),
            (0.5, 0.8, 1.0),
            (0.5, 0.1, -1.0),
            (0.5, -0.3, -1.0),
            (0.8, -0.3, -1.0),
            (0.8, -0.5, -1.0),
            (0.6, -0.5, -1.0),
            (0.6, 0.2, 1.0),
            (0.7, 0.8, 1.0),
        ] {
            let (load, limit) = (load * bed.last_load(), 0.5 * MU * bed.last_load());
            let state = joint.to(load, force * limit).unwrap();
            // 10⁻⁷ of the limit, of which rounding is 10⁻⁹.
            let step = sign * 1e-7 * limit;
            let next = joint.clone().to(load, force * limit + step).unwrap();
            let secant = step / (next.displacement - state.displacement);
            let context = format!("{load} {force}: {state:?} {secant}");
            assert!(relative(state.tangential_stiffness, secant) < 1e-6, "{context}");
        }
    }
}

/// Loads that are asked for again, or that differ by their rounding, leave the slip zone as it is.
#[test]
fn what_is_held_does_not_stick() {
    let (_, history) = path(1);
    let bed = Bed::new(&history).unwrap();
    for part in 1..40 {
        let load = 0.0173 * f64::from(part) * bed.last_load();
        let mut joint = SlipHistory::new(&bed, friction());
        joint.to(load, 0.0).unwrap();
        for turn in [0.8, -0.53, 0.31, -0.17, 0.23, 0.9] {
            let force = turn * MU * load;
            let state = joint.to(load, force).unwrap();
            assert!(state.stick_load < 0.99 * load, "{state:?}");
            for again in [load, load.next_up(), load.next_down(), load] {
                let held = joint.to(again, force).unwrap();
                assert_same(&state, &held, 1e-13, [load, state.displacement.abs()]);
                assert_eq!(state.slipping_nodes, held.slipping_nodes, "{again} {turn}");
                assert!(relative(held.stick_load, state.stick_load) < 1e-12);
                assert!(relative(held.tangential_stiffness, state.tangential_stiffness) < 1e-12);
            }
        }
    }
}

/// An ulp below the limit of friction nothing sticks, whether at once or along a history.
#[test]
fn just_below_the_limit_all_slips() {
    let (_, history) = path(1);
    let bed = Bed::new(&history).unwrap();
    for part in 1..40 {
        let load = 0.0173 * f64::from(part) * bed.last_load();
        let joint = PartialSlip::new(&bed, load, friction()).unwrap();
        let force = joint.sliding_load().next_down();
        let mut history = SlipHistory::new(&bed, friction());
        history.to(load, 0.0).unwrap();
        for state in [joint.monotone(force).unwrap(), history.to(load, force).unwrap()] {
            assert_eq!((state.stick_nodes, state.tangential_stiffness), (0, 0.0), "{load}");
        }
    }
}

/// However short the steps along the limit are, T is known there and the displacement is not.
#[test]
fn short_steps_along_the_limit_are_refused() {
    let (_, history) = path(1);
    let bed = Bed::new(&history).unwrap();
    let load = 0.4 * bed.last_load();
    let mut joint = SlipHistory::new(&bed, friction());
    joint.to(load, 0.0).unwrap();
    joint.to(load, MU * load).unwrap();
    for exponent in 2..13 {
        for part in 1..=24 {
            let next = load * (1.0 + 10_f64.powi(-exponent) * f64::from(part) / 24.0);
            let refused = joint.to(next, MU * next);
            assert!(
                matches!(refused, Err(Error::Slip(SlipError::StaysAtLimit { .. }))),
                "{exponent} {part}: {refused:?}"
            );
        }
    }
}

/// The loop of a history loses what `cycle` says, a quarter of it at first, and so does the sum over nodes.
#[test]
fn cycles_are_those_of_histories_and_of_nodes() {
    let grid = Grid::new(16, 12, 1.0, 1.5).unwrap();
    for kernel in [
        &Boussinesq::new(grid, 2.0).unwrap() as &dyn asperity::InfluenceKernel,
        &PeriodicBoussinesq::new(grid, 2.0).unwrap(),
    ] {
        let (mut path, history) = rough_path(kernel, 2, 0.7);
        let bed = Bed::new(&history).unwrap();
        let load = 0.7 * bed.last_load();
        let joint = PartialSlip::new(&bed, load, friction()).unwrap();
        for share in [0.05, 0.2, 0.5, 0.8, 0.95, 1.0] {
            let amplitude = share * joint.sliding_load();
            let cycle = joint.cycle(amplitude).unwrap();
            let mut history = SlipHistory::new(&bed, friction());
            history.to(load, 0.0).unwrap();
            history.to(load, amplitude).unwrap();
            let first = history.dissipation();
            // Differences of energies up to that of the preload.
            let rounding = 1e-14 * joint.sliding_load() * joint.sliding_displacement();
            let error = (4.0 * first - cycle.dissipation).abs();
            assert!(error < rounding, "{share}: {error:e}");
            history.to(load, -amplitude).unwrap();
            let back = history.to(load, amplitude).unwrap();
            let error = (history.dissipation() - first - cycle.dissipation).abs();
            assert!(error < rounding, "{share}: {error:e}");
            assert!(relative(back.displacement, cycle.displacement) < 1e-12);
            assert!(relative(cycle.secant_stiffness, amplitude / cycle.displacement) < 1e-15);
            let work = std::f64::consts::PI * amplitude * back.displacement;
            assert!(
                (cycle.loss_factor - (history.dissipation() - first) / work).abs() * work
                    < rounding
            );
            let interfacial = cycle.interfacial_displacement;
            assert!(relative(interfacial, back.interfacial_displacement) < 1e-11);
            for stick in [cycle.stick_load, back.stick_load] {
                assert!((stick - (load - amplitude / MU)).abs() < 1e-13 * load);
            }
            let same = joint.cycle_of_displacement(cycle.displacement).unwrap();
            assert!((same.dissipation - cycle.dissipation).abs() < rounding);
            assert!(relative(same.amplitude, amplitude) < 1e-12);

            let work = joint.friction_work(&mut path, amplitude).unwrap();
            let sum = work.sum() * grid.cell_area();
            // Gaps of the path are right to 1e-14 of the greatest, which is ten times the approach.
            let error = (sum - cycle.dissipation).abs();
            assert!(error < 100.0 * rounding, "{share}: {error:e}");

            let (traction, slip) = (
                joint.traction(&mut path, -amplitude).unwrap(),
                joint.slip(&mut path, -amplitude).unwrap(),
            );
            let zones = joint.zones(&path, -amplitude).unwrap();
            assert!(relative(traction.sum() * grid.cell_area(), -amplitude) < 1e-12);
            let pressure = path.fields_at(&bed.path_state(load).unwrap()).unwrap().pressure;
            let greatest = pressure.max();
            let mut counts = [0; 3];
            for (node, zone) in zones.iter().enumerate() {
                let (q, p, slip) = (traction[node], pressure[node], slip[node]);
                match zone {
                    SlipZone::Open => assert_eq!((q, slip), (0.0, 0.0)),
                    SlipZone::Stick => assert!(slip == 0.0 && -q <= MU * p + 1e-12 * greatest),
                    SlipZone::Slip => {
                        assert!(slip <= 0.0 && (q + MU * p).abs() <= 1e-12 * greatest)
                    }
                    _ => unreachable!("three zones"),
                }
                counts[*zone as usize] += 1;
            }
            let state = joint.monotone(-amplitude).unwrap();
            assert_eq!(counts[1..], [state.stick_nodes, state.slipping_nodes]);
            assert!(relative(state.slip_area, counts[2] as f64 * grid.cell_area()) < 1e-12);
        }
        // Beyond sliding.
        let (limit, shift) = (joint.sliding_load(), joint.sliding_displacement());
        let [at, beyond] =
            [1.0, 1.5].map(|part| joint.cycle_of_displacement(part * shift).unwrap());
        assert!(relative(at.dissipation, joint.cycle(limit).unwrap().dissipation) < 1e-12);
        let more = 4.0 * limit * 0.5 * shift;
        assert!(relative(beyond.dissipation, at.dissipation + more) < 1e-14);
        assert!(relative(beyond.secant_stiffness, limit / (1.5 * shift)) < 1e-14);
        let more = beyond.interfacial_displacement - at.interfacial_displacement;
        assert!(relative(more, 0.5 * shift) < 1e-12);
    }
}

/// Loads that grow in proportion lose nothing, come back as they went, and leave nothing without load.
#[test]
fn proportional_loading_does_not_slip() {
    let (_, history) = path(4);
    let bed = Bed::new(&history).unwrap();
    let top = bed.at_load(0.9 * bed.last_load()).unwrap();
    let mut joint = SlipHistory::new(&bed, friction());
    for share in [0.3, 1.0, 0.4, 0.9] {
        let load = share * top.load;
        let state = joint.to(load, 0.2 * load).unwrap();
        let expected = 1.2 * 0.2 * bed.at_load(load).unwrap().approach;
        assert!(relative(state.displacement, expected) < 1e-13);
        assert_eq!((joint.dissipation(), state.slipping_nodes), (0.0, 0));
        assert_eq!(joint.superposition().unwrap().pieces().len(), 1);
    }
    let apart = joint.to(0.0, 0.0).unwrap();
    assert_eq!((apart.tangential_load, apart.displacement, joint.dissipation()), (0.0, 0.0, 0.0));
    assert!(joint.superposition().unwrap().pieces().is_empty());
    // What is lost on the way to no load is lost for good, and the next loading is as new.
    joint.to(top.load, 0.0).unwrap();
    joint.to(top.load, 0.3 * top.load).unwrap();
    joint.to(0.0, 0.0).unwrap();
    let lost = joint.dissipation();
    assert!(lost > 0.0);
    joint.to(top.load, 0.0).unwrap();
    assert_eq!((joint.state().displacement, joint.dissipation()), (0.0, lost));
}

/// A load that is the last of the path but for the rounding of a sum is that load, whatever came before it: the same
/// bits.
#[test]
fn a_load_beyond_the_last_by_rounding_is_the_last() {
    let (mut path, history) = path(2);
    let bed = Bed::new(&history).unwrap();
    let last = bed.last_load();
    for before in [None, Some(0.3), Some(1.0)] {
        let mut follow = |load: f64| {
            let mut joint = SlipHistory::new(&bed, friction());
            if let Some(part) = before {
                joint.to(part * last, -0.05 * part * last).unwrap();
            }
            let state = joint.to(load, 0.1 * last).unwrap();
            (state, joint.dissipation(), joint.traction(&mut path).unwrap())
        };
        let expected = follow(last);
        assert!((expected.0.tangential_load / (0.1 * last) - 1.0).abs() < 1e-13);
        assert!(expected.0.displacement > 0.0 && expected.0.stick_nodes > 0);
        for beyond in [last.next_up(), last * (1.0 + 5e-13), last * (1.0 + 9e-13)] {
            assert_eq!(follow(beyond), expected, "{before:?}");
        }
    }
    let refused = SlipHistory::new(&bed, friction()).to(last * (1.0 + 2e-12), 0.0);
    assert!(matches!(refused, Err(Error::Bed(BedError::PathEndsBefore { .. }))), "{refused:?}");
}

/// Where T arrives at what friction bears nothing sticks, whatever the ratio before; and no step along the limit has a
/// displacement.
#[test]
fn nothing_sticks_at_the_limit() {
    let (_path, history) = path(2);
    let bed = Bed::new(&history).unwrap();
    let share = |k: u32| (1e4 * libm::sin(f64::from(k))).rem_euclid(1.0);
    let mut slid = 0;
    for k in 0..2000 {
        let mut joint = SlipHistory::new(&bed, friction());
        let [first, second] =
            [1, 2].map(|prime| (0.01 + 0.99 * share(5 * k + prime)) * bed.last_load());
        // Up to a 10⁻⁶ of friction's limit.
        let ratio = MU * (1.0 - 10_f64.powf(-6.0 * share(5 * k + 3)));
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        joint.to(first, ratio * first).unwrap();
        if joint.to(second, sign * MU * second).is_err() {
            continue;
        }
        slid += 1;
        let state = joint.state();
        assert_eq!((state.stick_nodes, state.tangential_stiffness), (0, 0.0), "{k}: {state:?}");
        let further = joint.to(0.5 * second, sign * MU * 0.5 * second);
        assert!(matches!(further, Err(Error::Slip(SlipError::StaysAtLimit { .. }))), "{k}");
    }
    assert!(slid > 1900, "{slid}");
}

/// A cycle that hardly slips has few nodes to tell its dissipation, and one near sliding many: those of a tangential
/// load that grows to its amplitude.
#[test]
fn cycles_say_whether_few_nodes_slip() {
    let (_path, history) = path(2);
    let bed = Bed::new(&history).unwrap();
    let joint = PartialSlip::new(&bed, bed.last_load(), friction()).unwrap();
    for (part, few) in [(0.1, true), (0.98, false)] {
        let amplitude = part * joint.sliding_load();
        let (cycle, grown) = (joint.cycle(amplitude).unwrap(), joint.monotone(amplitude).unwrap());
        assert_eq!(cycle.slipping_nodes, grown.slipping_nodes, "{part}");
        assert_eq!(cycle.has_few_nodes(), few, "{part}: {}", cycle.slipping_nodes);
        assert_eq!(few, cycle.slipping_nodes < PartialSlip::FEW_NODES);
    }
}

/// The same loads once more are no turn: what a sum of pieces lacks of the load asked for is rounding, also where greater
/// loads came before, be it ten thousand times as great.
#[test]
fn a_corner_that_is_held_changes_nothing() {
    let (_path, history) = path(2);
    let bed = Bed::new(&history).unwrap();
    // Anything between 0 and 1.
    let share = |k: u32| (1e4 * libm::sin(f64::from(k))).rem_euclid(1.0);
    for k in 0..1000 {
        let mut joint = SlipHistory::new(&bed, friction());
        for corner in 0..3 {
            let [a, b] = [2, 3].map(|prime| share(6 * k + 2 * corner + prime));
            let below = if corner == 0 { 1.0 } else { 10_f64.powf(-4.0 * share(7 * k + corner)) };
            let load = (0.1 + 0.9 * a) * below * bed.last_load();
            let force = (1.2 * b - 0.6) * MU * load;
            // Friction bears 0.6 of its limit at both ends, and so on the way.
            let before = joint.to(load, force).unwrap();
            assert_eq!(joint.to(load, force).unwrap(), before, "{k}, corner {corner}");
        }
    }
}
