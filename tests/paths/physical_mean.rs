//! A periodic body whose mean displacement is a property of it: a layer on a rigid base.

use crate::common::half_way;
use crate::problems::{COMPLIANCE, grid, layer, rough};
use asperity::{ContactGrowth, FixedLoadSolver, Grid, KernelTable, LoadingSolver};
use asperity_testing::close::assert_close;

/// The mean displacement under a load.
fn mean_displacement(load: f64, grid: &Grid) -> f64 {
    COMPLIANCE * load / grid.nominal_area()
}

#[test]
fn the_approach_contains_the_mean_displacement() {
    let grid = grid();
    let surface = rough(&grid, 13);
    let kernel = layer(grid, ContactGrowth::Unknown);
    assert_eq!(kernel.gauge(), None);
    let mut path = LoadingSolver::new(&surface, &kernel).unwrap();
    let mut before: Option<(f64, f64, f64)> = None;
    let mut unloaded = 0.0;
    while let Some(state) = path.next() {
        let state = state.unwrap();
        if state.step == 1 {
            unloaded = state.contact.mean_gap;
        }
        // ḡ = ḡ₀ + ū − δ: sums of some hundred lengths of the size of the approach.
        let mean = mean_displacement(state.contact.load, &grid);
        let error = state.contact.mean_gap - (unloaded + mean - state.contact.approach);
        assert!(error.abs() <= 1e-12 * (unloaded + state.contact.approach), "{state:?}: {error:e}");
        let displacement = path.fields().unwrap().displacement.mean();
        assert!((displacement - mean).abs() <= 1e-12 * mean, "{state:?}");
        // There is a base to approach: dW/dδ, which is the slope from event to event.
        let stiffness = state.contact.contact_stiffness.unwrap();
        let interfacial = state.contact.interfacial_stiffness.unwrap();
        // Base and interface in series: 1/K = 1/Kᵢ + compliance/area. Rounding of two inverses.
        let series = 1.0 / interfacial + COMPLIANCE / grid.nominal_area();
        assert!((stiffness * series - 1.0).abs() < 1e-9, "{state:?}");
        if let Some((approach, load, last)) = before {
            let change = last * (state.contact.approach - approach);
            assert!(
                (state.contact.load - load - change).abs() <= 1e-11 * state.contact.load,
                "{state:?}"
            );
        }
        before = Some((state.contact.approach, state.contact.load, stiffness));
    }
    // Full contact goes on as the base lets it.
    let last = path.state().unwrap();
    assert_eq!(last.contact.contact_nodes, grid.nodes());
    let stiffest = grid.nominal_area() / COMPLIANCE;
    assert!((last.contact.contact_stiffness.unwrap() / stiffest - 1.0).abs() < 1e-11);
    assert_eq!(last.contact.interfacial_stiffness, Some(f64::INFINITY));
}

#[test]
fn fixed_loads_agree_with_the_path() {
    let grid = grid();
    let surface = rough(&grid, 14);
    let kernel = layer(grid, ContactGrowth::Unknown);
    let mut path = LoadingSolver::new(&surface, &kernel).unwrap();
    let all: Vec<_> = path.by_ref().map(Result::unwrap).collect();
    let mut solver = FixedLoadSolver::builder(&surface, &kernel).tolerance(1e-11).build().unwrap();
    for step in [5, 30, 90, 160, 230] {
        let expected = half_way(all[step - 1], Some(all[step]));
        let pressure = path.fields_at(&expected).unwrap().pressure;
        for solution in [
            solver.solve(expected.contact.load).unwrap(),
            solver.solve_approach(expected.contact.approach).unwrap(),
        ] {
            let found = expected_like(expected, solution.contact);
            // The tolerance, times a condition number of some 1e2.
            assert_close(&found, &expected, 1e-9, all[0].contact.mean_gap);
            assert!(found.contact.contact_stiffness.is_some());
            let error = (&solution.fields.pressure - &pressure).amax();
            assert!(error <= 1e-9 * pressure.amax(), "step {step}: {error:e}");
            let mean = solution.fields.displacement.mean();
            let error = mean / mean_displacement(found.contact.load, &grid) - 1.0;
            assert!(error.abs() < 1e-11, "step {step}: {error:e}");
        }
    }
}

/// The same event with the scalars of another solver.
fn expected_like(
    mut state: asperity::LoadingState,
    contact: asperity::ContactState,
) -> asperity::LoadingState {
    state.contact = contact;
    state
}

/// A physical mean is not a gauge: a table says which it is, and the load that goes with an approach
/// depends on it.
#[test]
fn an_arbitrary_mean_is_another_body() {
    let grid = grid();
    let surface = rough(&grid, 15);
    let physical = layer(grid, ContactGrowth::Unknown);
    let arbitrary: KernelTable =
        physical.clone().with_mean_displacement(asperity::MeanDisplacement::Arbitrary);
    let a = LoadingSolver::new(&surface, &physical).unwrap();
    let b = LoadingSolver::new(&surface, &arbitrary).unwrap();
    for (a, b) in a.map(Result::unwrap).zip(b.map(Result::unwrap)) {
        assert_eq!(a.node, b.node);
        assert!((a.contact.load - b.contact.load).abs() <= 1e-10 * a.contact.load, "{a:?} {b:?}");
        assert_eq!(b.contact.contact_stiffness, None);
        let difference =
            a.contact.approach - b.contact.approach - mean_displacement(a.contact.load, &grid);
        assert!(difference.abs() <= 1e-11 * a.contact.approach, "{a:?} {b:?}");
    }
}
