//! Many states, each from the one before.

use asperity::{ContactTarget, Error, FixedLoadSolver, Grid};

use crate::common::fixed_load::check;
use crate::problems::{Kernel, solver};
use asperity_testing::close::relative;
use asperity_testing::surfaces::rough;

#[test]
fn a_sweep_is_its_loads() {
    let grid = Grid::square(96, 1.0).unwrap();
    let map = rough(&grid, 17);
    for kernel in Kernel::all(grid, 1.0) {
        let mut solver = solver(&map, &kernel, 1e-11);
        // Up, in small and large steps, beyond full contact, and down again.
        let loads = [1e-6, 1e-4, 1e-2, 1.1e-2, 0.1, 0.12, 3.0, 0.05, 1e-5];
        let swept: Vec<_> =
            solver.sweep(loads.map(ContactTarget::Load)).map(Result::unwrap).collect();
        assert_eq!(swept.len(), loads.len());
        for (load, swept) in loads.into_iter().zip(swept) {
            check(&solver, &swept, 1e-11);
            let cold = solver.solve(load).unwrap();
            assert_eq!(swept.fields.contact_map, cold.fields.contact_map, "load {load}");
            let error = (&swept.fields.pressure - &cold.fields.pressure).amax()
                / cold.fields.max_pressure();
            // The tolerance times the condition.
            assert!(error < 1e-8, "load {load}: {error:e}");
            let states = [swept.contact, cold.contact];
            let stiffnesses = states.map(|state| state.interfacial_stiffness.unwrap());
            if stiffnesses[0].is_finite() {
                let error = relative(stiffnesses[0], stiffnesses[1]);
                assert!(error < 1e-8, "load {load}: {error:e}");
            } else {
                assert_eq!(stiffnesses[0], stiffnesses[1]);
            }
            match states.map(|state| state.contact_stiffness) {
                [Some(swept), Some(cold)] => assert!(relative(swept, cold) < 1e-10, "load {load}"),
                stiffnesses => assert_eq!(stiffnesses, [None, None]),
            }
        }
    }
}

/// A solution of another run is as good a start.
#[test]
fn from_a_solution() {
    let grid = Grid::square(64, 1.0).unwrap();
    let map = rough(&grid, 29);
    for kernel in Kernel::all(grid, 1.0) {
        let mut solver = solver(&map, &kernel, 1e-11);
        let start = solver.solve(0.02).unwrap();
        solver.solve(1.0).unwrap();
        // Near, on either side, and far.
        for load in [0.021, 0.018, 0.2] {
            let next = solver.solve_from(&start, load).unwrap();
            check(&solver, &next, 1e-11);
            let cold = solver.solve(load).unwrap();
            assert_eq!(next.fields.contact_map, cold.fields.contact_map, "load {load}");
            assert!(relative(next.contact.approach, cold.contact.approach) < 1e-10);
        }
    }
}

/// With its stiffness a solution is as good a start as the last state of a sweep.
#[test]
fn a_solution_brings_its_tangent() {
    let grid = Grid::square(64, 1.0).unwrap();
    let map = rough(&grid, 29);
    for kernel in Kernel::all(grid, 1.0) {
        let mut solver = solver(&map, &kernel, 1e-11);
        let loads = [0.02, 0.021];
        let swept: Vec<_> =
            solver.sweep(loads.map(ContactTarget::Load)).map(Result::unwrap).collect();
        let next = solver.solve_from(&swept[0], loads[1]).unwrap();
        let [again, once] = [&next, &swept[1]].map(|solution| solution.effort.iterations);
        // Its displacements are computed anew: rounding, which may cost a step.
        assert!(again <= once + 1, "{again} from a solution, {once} in a sweep");
        let cold = solver.solve(loads[1]).unwrap();
        assert!(once < cold.effort.iterations, "{once}");
    }
}

#[test]
fn an_error_ends_a_sweep() {
    let grid = Grid::square(16, 1.0).unwrap();
    let mut solver = solver(&rough(&grid, 1), &Kernel::free(grid, 1.0), 1e-8);
    let mut sweep = solver.sweep([1.0, -1.0, 2.0].map(ContactTarget::Load));
    assert!(sweep.next().unwrap().is_ok());
    assert!(matches!(sweep.next(), Some(Err(Error::NotPositive { .. }))));
    assert!(sweep.next().is_none());
}

/// A sweep promises no solution, which an error may keep from it, and no more than there are targets.
#[test]
fn size_hints() {
    let grid = Grid::square(16, 1.0).unwrap();
    let mut solver = solver(&rough(&grid, 1), &Kernel::free(grid, 1.0), 1e-8);
    for loads in [[1.0, 2.0, 3.0], [1.0, -1.0, 2.0]] {
        let mut sweep = solver.sweep(loads.map(ContactTarget::Load));
        assert_eq!(sweep.size_hint(), (0, Some(3)));
        sweep.next();
        assert_eq!(sweep.size_hint(), (0, Some(2)));
        while sweep.next().is_some() {}
        assert_eq!(sweep.size_hint(), (0, Some(0)));
    }
}

/// From far beyond full contact back to approaches close to the mean gap, where load grows without bound: without a
/// stiffness nothing says how far, and such a state is no good start.
#[test]
fn back_from_full_contact_without_stiffnesses() {
    let grid = Grid::square(64, 1.0).unwrap();
    let map = rough(&grid, 3);
    let mean_gap = map.max_height() - map.matrix().mean();
    for kernel in Kernel::periodic(grid, 1.0) {
        let approach = |part: f64| ContactTarget::Approach(part * mean_gap);
        let full = solver(&map, &kernel, 1e-10).solve_target(approach(0.99999)).unwrap();
        let mut solver = FixedLoadSolver::builder(&map, &kernel)
            .tolerance(1e-10)
            .stiffness(false)
            .build()
            .unwrap();
        let targets = [
            ContactTarget::Load(3.0 * full.contact.load),
            approach(0.9999),
            approach(0.99),
            approach(0.9),
        ];
        let swept: Vec<_> = solver.sweep(targets).map(Result::unwrap).collect();
        for (target, swept) in targets.into_iter().zip(swept) {
            check(&solver, &swept, 1e-10);
            let cold = solver.solve_target(target).unwrap();
            assert_eq!(swept.fields.contact_map, cold.fields.contact_map, "{target:?}");
        }
    }
}
