//! Cycles of load and the energy that they cost.

use asperity::bed::Bed;
use asperity::creep::{Control, CycleSettings, Prony, ViscoelasticBed};
use asperity::loading::History;
use asperity::{
    Boussinesq, ContactEvent, ContactState, CreepError, Error, Grid, LoadingSolver, LoadingState,
};
use proptest::prelude::*;

use crate::stepping::rough;

/// The path of a rough surface of n × n nodes to full contact.
fn rough_path(n: usize, seed: u64) -> History {
    let grid = Grid::square(n, 1.0).unwrap();
    let half_space = Boussinesq::new(grid, 1.0).unwrap();
    let path = LoadingSolver::builder(&rough(&grid, seed), &half_space).build().unwrap();
    path.collect::<Result<_, _>>().unwrap()
}

/// A flat punch: one element, linear. The loss of a standard linear solid in closed form, with the phase of its complex
/// compliance.
#[test]
fn a_linear_contact_loses_what_its_compliance_says() {
    let grid = Grid::square(2, 1.0).unwrap();
    let stiffness = 10.0;
    let state = |k: usize, load: f64| {
        let mut contact = ContactState::new(&grid, k, load / stiffness, load, 10.0 - load / 40.0);
        contact.contact_stiffness = Some(stiffness);
        contact.interfacial_stiffness = Some(40.0);
        LoadingState::new(k, ContactEvent::Touch, (k - 1, 0), contact)
    };
    let history: History = [state(1, 0.0), state(2, 1e6)].into_iter().collect();
    let bed = Bed::new(&history).unwrap();
    let body = Prony::shares(&[(0.3, 0.6)]).unwrap();
    let (tau, j) = (body.creep_terms()[0].time, body.creep_terms()[0].amount);
    for period in [0.1, 1.0, 5.0, 100.0] {
        let mut contact = ViscoelasticBed::new(&bed, &body).unwrap();
        contact.settle(5.0).unwrap();
        let settings = CycleSettings { steps: 400, tolerance: 1e-12, most: 400 };
        let cycle = contact.cycle(5.0, 2.0, period, settings).unwrap();
        let omega = std::f64::consts::TAU / period;
        let lag = omega * tau;
        // J* = 1 + j/(1 + iωτ): D = π a² J''/K, and the amplitude a |J*|/K.
        let (real, imaginary) = (1.0 + j / (1.0 + lag * lag), j * lag / (1.0 + lag * lag));
        let lost = std::f64::consts::PI * 4.0 * imaginary / stiffness;
        let amplitude = 2.0 * real.hypot(imaginary) / stiffness;
        // 400 straight pieces in place of a sine: (2π/400)²/6, and the extremes lie between steps.
        assert!(
            (cycle.dissipation / lost - 1.0).abs() < 1e-4,
            "{period}: {} {lost}",
            cycle.dissipation
        );
        assert!((cycle.approach_amplitude / amplitude - 1.0).abs() < 1e-4, "{period}");
        assert!(cycle.distance <= 1e-12, "{cycle:?}");
        let sine = imaginary / real.hypot(imaginary);
        assert!((cycle.loss_factor / sine - 1.0).abs() < 2e-4);
        assert!((cycle.stiffness * amplitude / 2.0 - 1.0).abs() < 1e-4, "{period}");
        // An ellipse about what the mean load settles to.
        assert_eq!(cycle.path.len(), 401);
        for (step, (approach, load)) in cycle.path.iter().enumerate() {
            let (sine, cosine) = (std::f64::consts::TAU * step as f64 / 400.0).sin_cos();
            assert!((load - (5.0 + 2.0 * sine)).abs() < 1e-13, "{period}, {step}");
            let moves = 2.0 * (real * sine - imaginary * cosine) / stiffness;
            let error = approach - (5.0 * (1.0 + j) / stiffness + moves);
            assert!(error.abs() < 1e-4 * amplitude, "{period}, {step}: {error:e}");
        }
    }
}

/// A body that does not creep goes up and down the path of its modulus, and loses nothing.
#[test]
fn elastic_cycles_are_the_path() {
    let history = rough_path(10, 1);
    let bed = Bed::new(&history).unwrap();
    // Half of the modulus of the path: as much approach as of twice the load.
    let of_path = |load: f64| bed.at_load(2.0 * load).unwrap().approach;
    let (mean, amplitude) = (0.1 * bed.last_load(), 0.05 * bed.last_load());
    let mut contact = ViscoelasticBed::new(&bed, &Prony::elastic(0.5).unwrap()).unwrap();
    let cycle = contact.cycle(mean, amplitude, 3.0, CycleSettings::default()).unwrap();
    for &(approach, load) in &cycle.path {
        // A sum over a hundred elements.
        assert!((approach / of_path(load) - 1.0).abs() < 1e-12, "{load}");
    }
    let half = 0.5 * (of_path(mean + amplitude) - of_path(mean - amplitude));
    assert!((cycle.approach_amplitude / half - 1.0).abs() < 1e-11);
    assert!((cycle.stiffness * half / amplitude - 1.0).abs() < 1e-11);
    // Twice the same chords, 96 of them.
    assert!(cycle.dissipation.abs() < 1e-11 * amplitude * half, "{:e}", cycle.dissipation);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    /// No steady cycle of any body on any rough surface gives energy, and steps half as long lose the same.
    #[test]
    fn no_cycle_gives_energy(
        seed in 0..1000_u64,
        terms in prop::collection::vec((-2.0..1.0_f64, 0.05..0.3_f64), 1..3),
        part in 0.05..1.0_f64,
        period in -2.0..2.0_f64,
    ) {
        let history = rough_path(10, seed);
        let bed = Bed::new(&history).unwrap();
        let terms: Vec<_> = terms.iter().map(|t| (10_f64.powf(t.0), t.1)).collect();
        let body = Prony::shares(&terms).unwrap();
        let load = 0.1 * bed.last_load();
        let lost = [64, 128].map(|steps| {
            let mut contact = ViscoelasticBed::new(&bed, &body).unwrap();
            contact.settle(load).unwrap();
            let settings = CycleSettings { steps, tolerance: 1e-4, most: 200 };
            let cycle = contact.cycle(load, part * load, 10_f64.powf(period), settings).unwrap();
            (cycle.dissipation, cycle.amplitude * cycle.approach_amplitude)
        });
        let scale = lost[1].1;
        prop_assert!(lost[0].0 >= -1e-3 * scale && lost[1].0 >= -1e-3 * scale, "{:?}", lost);
        // Within what is left of transients and of steps.
        prop_assert!((lost[0].0 - lost[1].0).abs() < 0.02 * scale, "{:?}", lost);
    }

    /// Whatever the history from rest and back to rest: work that is done is not negative.
    #[test]
    fn no_history_from_rest_gives_work(
        seed in 0..1000_u64,
        loads in prop::collection::vec(0.0..0.3_f64, 1..30),
        duration in -3.0..1.0_f64,
    ) {
        let history = rough_path(10, seed);
        let bed = Bed::new(&history).unwrap();
        let body = Prony::shares(&[(0.1, 0.5), (1.0, 0.3)]).unwrap();
        // By the trapezoidal rule, whose error is of second order where contact grows within a step.
        let [(coarse, _), (work, put_in)] = [8, 16].map(|parts| {
            let mut contact = ViscoelasticBed::new(&bed, &body).unwrap();
            let (mut work, mut put_in, mut before) = (0.0, 0.0, contact.state());
            for load in loads.iter().copied().chain([0.0]) {
                let from = before.load;
                for part in 1..=parts {
                    let part = f64::from(part) / f64::from(parts);
                    let load = from + part * (load * bed.last_load() - from);
                    let duration = 10_f64.powf(duration) / f64::from(parts);
                    let state = contact.step(duration, Control::Load(load)).unwrap();
                    let way = state.approach - before.approach;
                    let done = 0.5 * (state.load + before.load) * way;
                    work += done;
                    put_in += done.abs();
                    before = state;
                }
            }
            (work, put_in)
        });
        let error = (work - coarse).abs();
        prop_assert!(error < 0.02 * put_in, "{} {}", coarse, work);
        prop_assert!(work >= -error - 1e-12 * put_in, "{} of {}, {} before", work, put_in, coarse);
    }
}

/// Energy lost in the last of many cycles of half the load around it, and half the range of the approach in it, step by
/// step.
fn stepped(contact: &mut ViscoelasticBed, load: f64, period: f64, cycles: usize) -> (f64, f64) {
    const STEPS: usize = 16;
    let mut before = contact.step(0.0, Control::Load(load)).unwrap();
    let (mut lost, mut low, mut high) = (0.0, f64::INFINITY, f64::NEG_INFINITY);
    for cycle in 0..cycles {
        for step in 1..=STEPS {
            let sine = (std::f64::consts::TAU * step as f64 / STEPS as f64).sin();
            let to = if step == STEPS { load } else { load + 0.5 * load * sine };
            let state = contact.step(period / STEPS as f64, Control::Load(to)).unwrap();
            if cycle + 1 == cycles {
                let middle = 0.5 * (state.load + before.load) - load;
                lost += middle * (state.approach - before.approach);
                (low, high) = (low.min(state.approach), high.max(state.approach));
            }
            before = state;
        }
    }
    (lost, 0.5 * (high - low))
}

/// A default cycle is as near to the steady one as its distance says, which is within the tolerance: also if the period
/// is far below the retardation times, where a cycle differs little from the one before long before it is steady. The
/// truth are cycles over 16 of the longest time after the mean load has settled for 40, from a change of some tenths by
/// e^-16 or more.
#[test]
fn a_steady_cycle_is_one() {
    let body = Prony::shares(&[(0.1, 0.3), (10.0, 0.4)]).unwrap();
    let longest = body.creep_terms().last().unwrap().time;
    for seed in [1, 2] {
        let history = rough_path(12, seed);
        let bed = Bed::new(&history).unwrap();
        let load = 0.05 * bed.last_load();
        for share in [0.02, 0.1, 1.0] {
            let period = share * longest;
            check_steady(&bed, &body, load, period, (16.0 / share) as usize + 1);
        }
    }
}

/// The same for terms that are up to some thousand periods slow, and for bodies of which little is left: plain cycles
/// are 10⁻³ and more away from the steady one after a thousand.
#[test]
fn slow_terms_reach_the_steady_cycle() {
    let history = rough_path(10, 1);
    let bed = Bed::new(&history).unwrap();
    for terms in [
        &[(1.0, 0.3), (1000.0, 0.3)][..],
        &[(0.3, 0.2), (20.0, 0.3), (800.0, 0.2)],
        &[(1.0, 0.1), (200.0, 0.8)],
    ] {
        let body = Prony::shares(terms).unwrap();
        let longest = body.creep_terms().last().unwrap().time;
        check_steady(&bed, &body, 0.05 * bed.last_load(), 1.0, (16.0 * longest) as usize);
    }
}

fn check_steady(bed: &Bed, body: &Prony, load: f64, period: f64, cycles: usize) {
    let settings = CycleSettings { steps: 16, ..CycleSettings::default() };
    let mut contact = ViscoelasticBed::new(bed, body).unwrap();
    contact.settle(load).unwrap();
    let truth = stepped(&mut contact, load, period, cycles);
    let mut contact = ViscoelasticBed::new(bed, body).unwrap();
    contact.step(0.0, Control::Load(load)).unwrap();
    let found = contact.cycle(load, 0.5 * load, period, settings).unwrap();
    let off = (found.dissipation - truth.0).abs() / (0.5 * load * truth.1);
    let apart = (found.approach_amplitude / truth.1 - 1.0).abs();
    assert!(found.distance <= settings.tolerance, "{period}: {}", found.distance);
    // What truth and rounding leave is below 1e-7.
    let within = found.distance + 1e-7;
    assert!(off <= within, "{period}: {off:e} after {}", found.cycles);
    assert!(apart <= within, "{period}: {apart:e} after {}", found.cycles);
    assert!(found.cycles < 200, "{period}: {}", found.cycles);
    // Steady is also what comes next.
    let next = stepped(&mut contact, load, period, 1);
    assert!((next.0 - truth.0).abs() <= within * 0.5 * load * truth.1, "{period}: {}", next.0);
}

/// Too few cycles are an error that says how near they came.
#[test]
fn cycles_that_are_not_steady_yet_are_no_steady_ones() {
    let history = rough_path(10, 1);
    let bed = Bed::new(&history).unwrap();
    let body = Prony::shares(&[(1.0, 0.3), (1000.0, 0.3)]).unwrap();
    let load = 0.05 * bed.last_load();
    let mut before = f64::INFINITY;
    for most in [1, 3, 6] {
        let mut contact = ViscoelasticBed::new(&bed, &body).unwrap();
        let settings = CycleSettings { most, steps: 16, ..CycleSettings::default() };
        match contact.cycle(load, 0.5 * load, 1.0, settings) {
            Err(Error::Creep(CreepError::NotSteady { cycles, distance, tolerance })) => {
                assert_eq!((cycles, tolerance), (most, settings.tolerance));
                assert!(distance > tolerance && (most == 1 || distance < before), "{distance}");
                before = distance;
            }
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn cycles_that_are_none_are_refused() {
    let history = rough_path(8, 1);
    let bed = Bed::new(&history).unwrap();
    let fluid = Prony::shares(&[(1.0, 1.0)]).unwrap();
    let mut flows = ViscoelasticBed::new(&bed, &fluid).unwrap();
    let load = 0.1 * bed.last_load();
    for refused in
        [flows.settle(load).err(), flows.cycle(load, load, 1.0, CycleSettings::default()).err()]
    {
        assert!(matches!(refused, Some(Error::Creep(CreepError::NoSteadyCycle { .. }))));
    }
    let solid = Prony::shares(&[(1.0, 0.5)]).unwrap();
    let mut contact = ViscoelasticBed::new(&bed, &solid).unwrap();
    let settings = CycleSettings::default();
    for (mean, amplitude, period, settings) in [
        (load, 2.0 * load, 1.0, settings),
        (load, 0.0, 1.0, settings),
        (load, f64::NAN, 1.0, settings),
        (load, load, -1.0, settings),
        (f64::INFINITY, load, 1.0, settings),
        (load, load, 1.0, CycleSettings { steps: 7, ..settings }),
        (load, load, 1.0, CycleSettings { most: 0, ..settings }),
    ] {
        let refused = contact.cycle(mean, amplitude, period, settings);
        assert!(
            matches!(refused, Err(Error::OutOfRange { .. } | Error::NotPositive { .. })),
            "{refused:?}"
        );
    }
    // The path ends.
    let refused = contact.cycle(0.9 * bed.last_load(), 0.5 * bed.last_load(), 1.0, settings);
    assert!(refused.is_ok(), "full contact goes on: {refused:?}");
}
