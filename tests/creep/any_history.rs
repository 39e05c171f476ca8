//! The bed in steps of time against the solver in the same steps: receding and returning contact, separation.

use asperity::bed::Bed;
use asperity::creep::{Control, Prony, ViscoelasticBed};
use asperity::{
    Boundary, Boussinesq, Grid, InfluenceKernel, LoadingSolver, PeriodicBoussinesq, Spectral,
};
use proptest::prelude::*;

use crate::stepping::{Stepping, To, rough};

/// What a random history did.
#[derive(Debug, Default)]
struct Seen {
    joined: usize,
    left: usize,
    apart: usize,
    pressure: f64,
    scalars: f64,
}

/// The same steps on both sides.
fn compare(
    kernel: &dyn InfluenceKernel,
    (seed, body): (u64, &Prony),
    steps: &[(f64, Control)],
    fields_every: usize,
) -> Seen {
    let heights = rough(&kernel.grid(), seed);
    let mut path = LoadingSolver::builder(&heights, kernel).build().unwrap();
    let history = path.run().unwrap();
    let bed = Bed::new(&history).unwrap();
    // In parts of the load and approach of the path at half contact.
    let half = history.events()[history.events().len() / 2].contact;
    let mut contact = ViscoelasticBed::new(&bed, body).unwrap();
    let mut solver = Stepping::new(&heights, kernel, body);
    let mut seen = Seen::default();
    let (is_free, mut before) = (kernel.boundary() == Boundary::Free, 0);
    for (k, &(duration, control)) in steps.iter().enumerate() {
        let (control, to) = match control {
            Control::Load(part) => (Control::Load(part * half.load), To::Load(part * half.load)),
            Control::Approach(part) => {
                (Control::Approach(part * half.approach), To::Approach(part * half.approach))
            }
        };
        let state = contact.step(duration, control).unwrap();
        assert_eq!(contact.halvings(), 0, "{k}");
        solver.step(duration, to);
        assert_eq!(state.contact_nodes, solver.nodes(), "{k}: {state:?}");
        seen.joined += state.contact_nodes.saturating_sub(before);
        seen.left += before.saturating_sub(state.contact_nodes);
        seen.apart += usize::from(state.contact_nodes == 0);
        before = state.contact_nodes;
        let gap = bed.mean_gaps()[0];
        let errors =
            [(state.mean_gap - solver.mean_gap()) / gap, (state.load - solver.load()) / half.load];
        // On a periodic half-space the approach of the solver is that in the gauge of the kernel, and that of the mean
        // planes by how much the mean gap has closed.
        let expected = if is_free { solver.approach } else { gap - solver.mean_gap() };
        let approach = (state.approach - expected) / half.approach;
        for error in errors.into_iter().chain([approach]) {
            seen.scalars = seen.scalars.max(error.abs());
        }
        if k % fields_every == 0 {
            let contact_set: Vec<usize> = path.contact_order()[..state.contact_nodes].to_vec();
            assert!(contact_set.iter().all(|&node| solver.inside[node]), "{k}");
            let pressure = contact.pressure(usize::MAX).unwrap().pressure(&bed, &mut path).unwrap();
            let errors = pressure.iter().zip(&solver.pressure).map(|(a, b)| (a - b).abs());
            let error = errors.fold(0.0, f64::max) / solver.pressure.max().max(1e-6);
            seen.pressure = seen.pressure.max(error);
            let gap = contact.gap(usize::MAX, &mut path).unwrap();
            for (gap, expected) in gap.iter().zip(&solver.gap) {
                seen.scalars = seen.scalars.max((gap - expected).abs() / half.approach);
            }
        }
    }
    // At once so far apart that nothing touches, there are dents; on a periodic half-space the solver has another mean.
    let initial = bed.mean_gaps()[0];
    let far = -30.0 * initial;
    let apart = contact.step(0.0, Control::Approach(far)).unwrap();
    solver.step(0.0, To::Approach(far));
    assert_eq!((apart.contact_nodes, solver.nodes()), (0, 0));
    let gap = contact.gap(usize::MAX, &mut path).unwrap();
    let (mean, of_solver) = (gap.mean(), solver.mean_gap());
    let expected = if is_free { of_solver } else { initial - far };
    let means = [mean, apart.mean_gap].map(|mean| mean - expected);
    let dents = gap.iter().zip(&solver.gap).map(|(a, b)| (a - mean) - (b - of_solver));
    for error in dents.chain(means) {
        seen.scalars = seen.scalars.max(error.abs() / half.approach);
    }
    seen
}

/// Between random corners, in so many steps each.
fn between(
    corners: &[f64],
    steps: usize,
    duration: f64,
    of: fn(f64) -> Control,
) -> Vec<(f64, Control)> {
    let mut all = Vec::new();
    let mut from = 0.0;
    for &to in corners {
        for k in 1..=steps {
            all.push((duration, of(from + (to - from) * k as f64 / steps as f64)));
        }
        from = to;
    }
    all
}

fn solid() -> Prony {
    Prony::relaxation(0.2, &[(1.0, 0.3), (0.1, 0.5)]).unwrap()
}

fn fluid() -> Prony {
    Prony::relaxation(0.0, &[(1.0, 0.4), (0.1, 0.6)]).unwrap()
}

/// Random loads and approaches, a solid and a fluid: the same nodes at every step, and everything else to the rounding
/// of dense solves with a condition number of some 10² (measured: pressures 2·10⁻¹³, scalars 10⁻¹⁵).
#[test]
fn any_load_and_approach() {
    let kernel = Boussinesq::new(Grid::square(16, 1.0).unwrap(), 1.0).unwrap();
    let loads = [0.3, 0.05, 0.5, 0.2, 0.22, 0.01, 0.4, 0.0, 0.3, 0.1];
    let approaches = [0.9, 0.4, 0.95, 0.3, 1.2, 0.9, 0.1, -0.2, 0.7, 1.0];
    for (body, scale) in [(solid(), 1.0), (fluid(), 0.4)] {
        let loads: Vec<f64> = loads.iter().map(|load| scale * load).collect();
        let seen = compare(&kernel, (5, &body), &between(&loads, 20, 0.02, Control::Load), 5);
        println!("load: {seen:?}");
        assert!(seen.joined > 150 && seen.left > 100, "{seen:?}");
        assert!(seen.pressure < 1e-11 && seen.scalars < 1e-12, "{seen:?}");
        let steps = between(&approaches, 20, 0.02, Control::Approach);
        let seen = compare(&kernel, (5, &body), &steps, 5);
        println!("approach: {seen:?}");
        assert!(seen.joined > 150 && seen.left > 100 && seen.apart > 10, "{seen:?}");
        assert!(seen.pressure < 1e-11 && seen.scalars < 1e-12, "{seen:?}");
    }
}

#[test]
fn other_half_spaces() {
    let square = Grid::square(12, 1.0).unwrap();
    let kernels: [Box<dyn InfluenceKernel>; 3] = [
        Box::new(PeriodicBoussinesq::new(square, 1.0).unwrap()),
        Box::new(Spectral::new(square, 1.0).unwrap()),
        Box::new(Boussinesq::new(Grid::new(12, 20, 0.2, 0.1).unwrap(), 1.0).unwrap()),
    ];
    let loads = [0.3, 0.05, 0.6, 0.1, 0.3, 0.0, 0.2];
    for kernel in kernels {
        let seen = compare(&*kernel, (9, &solid()), &between(&loads, 15, 0.05, Control::Load), 4);
        println!("{seen:?}");
        assert!(seen.left > 30, "{seen:?}");
        assert!(seen.pressure < 1e-10 && seen.scalars < 1e-11, "{seen:?}");
    }
}

/// Jumps between far apart loads, and steps of 10⁻³ to 10² of the shortest relaxation time.
#[test]
fn jumps_and_long_steps() {
    let kernel = Boussinesq::new(Grid::square(12, 1.0).unwrap(), 1.0).unwrap();
    let body = Prony::relaxation(0.05, &[(1.0, 0.35), (0.01, 0.6)]).unwrap();
    let steps: Vec<(f64, Control)> = (0..60)
        .map(|k| {
            let load = 0.001 + 0.12 * (0.5 + 0.5 * (7.3 * f64::from(k)).sin());
            let duration = if k % 3 == 0 { 0.0 } else { 10_f64.powf(f64::from(k % 6) - 5.0) };
            (duration, Control::Load(load))
        })
        .collect();
    let seen = compare(&kernel, (3, &body), &steps, 1);
    println!("{seen:?}");
    assert!(seen.pressure < 1e-10 && seen.scalars < 1e-11, "{seen:?}");
}

/// A step far too long would bring out negative pressures; it is halved until it does not, and the states are sound: no
/// pressure in contact is negative, and none is missing.
#[test]
fn a_step_that_is_too_long_is_halved() {
    let grid = Grid::square(12, 1.0).unwrap();
    let kernel = Boussinesq::new(grid, 1.0).unwrap();
    let heights = rough(&grid, 3);
    let mut path = LoadingSolver::builder(&heights, &kernel).build().unwrap();
    let history = path.run().unwrap();
    let bed = Bed::new(&history).unwrap();
    let body = Prony::relaxation(0.001, &[(1.0, 0.3), (1e-3, 0.699)]).unwrap();
    let mut contact = ViscoelasticBed::new(&bed, &body).unwrap();
    let load = bed.loads()[40] * 1e-3;
    let mut least = f64::INFINITY;
    for k in 0..40 {
        let part = 0.5 + 0.5 * (2.1 * f64::from(k)).cos();
        contact.step(300.0, Control::Load(load * part)).unwrap();
        let pressure = contact.pressure(usize::MAX).unwrap();
        assert!((pressure.load() - load * part).abs() <= 1e-11 * load);
        let field = pressure.pressure(&bed, &mut path).unwrap();
        least = least.min(field.min() / field.max().max(f64::MIN_POSITIVE));
    }
    println!("{} halvings, least pressure {least:e}", contact.halvings());
    assert!(contact.halvings() > 0);
    assert!(least > -1e-9, "{least:e}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    /// Random bodies, surfaces, loads and steps on small grids.
    #[test]
    fn random_histories(
        seed in 0..1000_u64,
        terms in prop::collection::vec((-2.0..1.0_f64, 0.05..0.33_f64), 1..3),
        corners in prop::collection::vec(0.0..0.35_f64, 2..6),
        by_approach in any::<bool>(),
        duration in -3.0..0.0_f64,
    ) {
        let kernel = Boussinesq::new(Grid::square(10, 1.0).unwrap(), 1.0).unwrap();
        let terms: Vec<_> = terms.iter().map(|t| (10_f64.powf(t.0), t.1)).collect();
        let body = Prony::shares(&terms).unwrap();
        let steps = if by_approach {
            let corners: Vec<f64> = corners.iter().map(|part| 3.0 * part - 0.1).collect();
            between(&corners, 8, 10_f64.powf(duration), Control::Approach)
        } else {
            between(&corners, 8, 10_f64.powf(duration), Control::Load)
        };
        let seen = compare(&kernel, (seed, &body), &steps, 7);
        prop_assert!(seen.pressure < 1e-10 && seen.scalars < 1e-11, "{:?}", seen);
    }
}
