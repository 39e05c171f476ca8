//! Input that is refused, with an error that says why.

use nalgebra::DMatrix;

use asperity::surface::FlatPunch;
use asperity::{
    Boundary, Boussinesq, Error, FixedLoadSolution, FixedLoadSolver, Grid, InfluenceKernel,
};

use crate::common::fixed_load::check;
use crate::problems::{Kernel, solver};
use asperity_testing::surfaces::rough;

#[test]
fn settings_and_loads() {
    let grid = Grid::square(8, 1.0).unwrap();
    let kernel = Boussinesq::new(grid, 1.0).unwrap();
    let punch = FlatPunch::new(1.0).unwrap();
    for tolerance in [0.0, -1.0, f64::NAN, 1.0] {
        let built = FixedLoadSolver::builder(&punch, &kernel).tolerance(tolerance).build();
        assert!(matches!(built, Err(Error::OutOfRange { .. })));
    }
    let mut solver = FixedLoadSolver::new(&punch, &kernel).unwrap();
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(solver.solve(bad), Err(Error::NotPositive { .. })));
        assert!(matches!(solver.solve_approach(bad), Err(Error::NotPositive { .. })));
    }
}

#[test]
fn too_few_iterations() {
    let grid = Grid::square(8, 1.0).unwrap();
    let map = rough(&grid, 3);
    let kernel = Kernel::free(grid, 1.0);
    for iterations in [0, 2] {
        let mut hasty = FixedLoadSolver::builder(&map, &kernel)
            .tolerance(1e-12)
            .max_iterations(iterations)
            .build()
            .unwrap();
        match hasty.solve(0.01) {
            Err(Error::NoConvergence { residual, iterations: spent, .. }) => {
                assert!(residual > 1e-12 && spent <= iterations)
            }
            other => panic!("{other:?}"),
        }
    }
}

/// Stiffnesses that are not reached leave the solution as it was.
#[test]
fn too_few_iterations_for_stiffnesses() {
    let grid = Grid::square(8, 1.0).unwrap();
    let map = rough(&grid, 3);
    for kernel in Kernel::all(grid, 1.0) {
        let mut solution = FixedLoadSolver::builder(&map, &kernel)
            .stiffness(false)
            .build()
            .and_then(|mut solver| solver.solve(0.01))
            .unwrap();
        let before = solution.clone();
        let mut hasty = FixedLoadSolver::builder(&map, &kernel)
            .tolerance(1e-12)
            .max_iterations(1)
            .build()
            .unwrap();
        match hasty.add_stiffness(&mut solution) {
            Err(Error::NoConvergence { residual, tolerance: 1e-12, iterations: 1 }) => {
                assert!(residual > 1e-12, "{residual}")
            }
            other => panic!("{other:?}"),
        }
        assert_eq!(solution.contact, before.contact);
        assert_eq!(solution.contact.interfacial_stiffness, None);
        assert_eq!(solution.pressure_rate, before.pressure_rate);
        let mut patient = solver(&map, &kernel, 1e-8);
        // Fields are public.
        let mut other = solution.clone();
        other.fields.yielded_map = DMatrix::from_element(1, 8, false);
        assert!(matches!(patient.add_stiffness(&mut other), Err(Error::GridMismatch { .. })));
        patient.add_stiffness(&mut solution).unwrap();
        assert!(solution.contact.interfacial_stiffness.unwrap() > 0.0);
    }
}

/// The grids are refused before they are allocated, the contact when it grows too large.
#[test]
fn memory() {
    let grid = Grid::square(64, 1.0).unwrap();
    let map = rough(&grid, 3);
    for kernel in Kernel::all(grid, 1.0) {
        let build =
            |budget: usize| FixedLoadSolver::builder(&map, &kernel).memory_budget(budget).build();
        let held = build(usize::MAX).unwrap().bytes();
        let Err(Error::MemoryBudget { needed, budget, nodes_that_fit: 0 }) = build(1000) else {
            panic!("built within 1000 bytes");
        };
        assert_eq!(budget, 1000);
        // Threads' own buffers weigh on a small grid.
        assert!(held < needed + needed / 2, "{held} of {needed}");

        let mut small = build(needed + 1000 * 500).unwrap();
        assert!(small.solve(1e-6).is_ok());
        match small.solve(1e3) {
            Err(Error::MemoryBudget { nodes_that_fit, .. }) => {
                assert!((1000..4096).contains(&nodes_that_fit), "{nodes_that_fit}");
            }
            other => panic!("{other:?}"),
        }
        // And is itself again.
        let again = small.solve(1e-6).unwrap();
        assert!(again == build(usize::MAX).unwrap().solve(1e-6).unwrap());
    }
}

/// Solutions to start from whose public fields were changed, and those of another grid.
#[test]
fn starts_that_are_no_solutions() {
    let grid = Grid::square(16, 1.0).unwrap();
    let map = rough(&grid, 3);
    let mut solver = solver(&map, &Kernel::free(grid, 1.0), 1e-8);
    let good = solver.solve(0.01).unwrap();
    let mut refused = |change: &dyn Fn(&mut FixedLoadSolution)| {
        let mut bad = good.clone();
        change(&mut bad);
        solver.solve_from(&bad, 0.011).unwrap_err()
    };
    for value in [f64::NAN, f64::INFINITY] {
        for error in [
            refused(&|bad| bad.fields.pressure[3] = value),
            refused(&|bad| bad.fields.displacement[5] = value),
            refused(&|bad| bad.pressure_rate[7] = value),
        ] {
            assert!(matches!(error, Error::FieldNotFinite { .. }), "{error}");
        }
        for error in [
            refused(&|bad| bad.contact.approach = value),
            refused(&|bad| bad.contact.contact_stiffness = Some(value)),
        ] {
            assert!(matches!(error, Error::OutOfRange { .. }), "{error}");
        }
    }
    let error =
        refused(&|bad| bad.fields.pressure = bad.fields.pressure.columns(0, 8).into_owned());
    assert!(matches!(error, Error::GridMismatch { .. }), "{error}");

    // The same shape with other cells.
    let coarse = Grid::square(16, 2.0).unwrap();
    let kernel = Kernel::free(coarse, 1.0);
    let mut other = FixedLoadSolver::new(&map, &kernel).unwrap();
    let error = other.solve_from(&good, 0.011).unwrap_err();
    assert!(matches!(error, Error::OutOfRange { .. }), "{error}");
    // Numbers that are finite and make no sense are only a poor start.
    let mut poor = good.clone();
    poor.fields.displacement.fill(1e3);
    let found = solver.solve_from(&poor, 0.011).unwrap();
    assert_eq!(found.fields.contact_map, solver.solve(0.011).unwrap().fields.contact_map);

    let mut none = good;
    none.fields.contact_map.fill(false);
    let error = solver.add_stiffness(&mut none).unwrap_err();
    assert!(matches!(error, Error::NotPositive { .. }), "{error}");
}

/// Rates that overflow as soon as they are used: the limit of iterations holds, whatever becomes of the start.
#[test]
fn starts_that_overflow_come_to_an_end() {
    let grid = Grid::square(16, 1.0).unwrap();
    let map = rough(&grid, 3);
    for kernel in Kernel::all(grid, 1.0) {
        let good = solver(&map, &kernel, 1e-8).solve(0.01).unwrap();
        // Without any limit it must be noticed that nothing is a number any more.
        for iterations in [7, 5000, usize::MAX] {
            for value in [f64::MAX, f64::MAX / 1e3, -f64::MAX, 1e200, -1e160, 1e-310] {
                let mut bad = good.clone();
                bad.pressure_rate.fill(value);
                let mut other = good.clone();
                other.fields.displacement.fill(value);
                let mut third = good.clone();
                third.fields.pressure[(3, 3)] = value.abs();
                for start in [bad, other, third] {
                    let mut solver = FixedLoadSolver::builder(&map, &kernel)
                        .max_iterations(iterations)
                        .build()
                        .unwrap();
                    match solver.solve_from(&start, 0.0101) {
                        Ok(solution) => check(&solver, &solution, 1e-8),
                        Err(Error::NoConvergence { iterations: spent, .. }) => {
                            assert!(spent <= iterations, "{spent} of {iterations}")
                        }
                        Err(Error::FactorizationFailed { .. }) => {}
                        Err(error) => panic!("{value:e}: {error}"),
                    }
                }
            }
        }
    }
}

/// A kernel by which a node displaces itself by 1 and all others by the same other number.
struct Uniform(Grid, f64);

impl InfluenceKernel for Uniform {
    fn grid(&self) -> Grid {
        self.0
    }

    fn boundary(&self) -> Boundary {
        Boundary::Free
    }

    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        if (di, dj) == (0, 0) { 1.0 } else { self.1 }
    }
}

/// Kernels that are not positive definite are refused as soon as the contact has a direction in which
/// it shows.
#[test]
fn indefinite_kernels() {
    let grid = Grid::square(8, 1.0).unwrap();
    let map = rough(&grid, 3);
    // Nodes attract one another, so that four of them are unstable: 1 − 3 · 0.4 < 0.
    let attraction = Uniform(grid, -0.4);
    for load in [1.0, 1e6] {
        let mut solver = FixedLoadSolver::new(&map, &attraction).unwrap();
        let error = solver.solve(load).unwrap_err();
        assert!(
            matches!(error, Error::FactorizationFailed { .. } | Error::NoConvergence { .. }),
            "load {load}: {error}"
        );
    }
    // A node pushes all others farther down than itself, and carries any load alone.
    let repulsion = Uniform(grid, 3.0);
    for load in [1e-6, 1.0, 1e6] {
        let mut solver = FixedLoadSolver::new(&map, &repulsion).unwrap();
        let solution = solver.solve(load).unwrap();
        check(&solver, &solution, 1e-8);
        assert_eq!(solution.contact.contact_nodes, 1);
    }
}
