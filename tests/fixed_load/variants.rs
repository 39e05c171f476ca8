//! What must not change the result: coarser grids, gauges, the way in which a kernel is given.

use asperity::kernel::MeanDisplacement;
use asperity::{Boussinesq, ContactGrowth, ContactState, FixedLoadSolver, Grid, KernelTable};

use crate::common::fixed_load::check;
use crate::problems::{Kernel, Plain, solver};
use asperity_testing::close::relative;
use asperity_testing::surfaces::rough;

/// The gauge of the kernel, zero included, is of no influence.
#[test]
fn gauges_do_not_matter() {
    let grid = Grid::square(48, 1.0).unwrap();
    let map = rough(&grid, 11);
    for kernel in Kernel::periodic(grid, 1.0) {
        for load in [1e-3, 0.05, 1.0] {
            let expected = solver(&map, &kernel, 1e-12).solve(load).unwrap();
            for factor in [0.0, 0.5, 10.0] {
                let mut solver = solver(&map, &kernel.clone().in_gauge(factor), 1e-12);
                let found = solver.solve(load).unwrap();
                check(&solver, &found, 1e-12);
                assert_eq!(found.fields.contact_map, expected.fields.contact_map);
                // The tolerance times the condition.
                let error = (&found.fields.pressure - &expected.fields.pressure).amax();
                assert!(error < 1e-10 * expected.fields.max_pressure(), "{error:e}");
                assert!(relative(found.contact.approach, expected.contact.approach) < 1e-10);
                assert!(relative(found.contact.energy, expected.contact.energy) < 1e-10);
                // Rounding of what the gauge adds to C(0, 0).
                let lengths = [&found, &expected].map(|solution| solution.certificate.length);
                assert!(relative(lengths[0], lengths[1]) < 1e-10);
            }
        }
    }
}

/// Nested grids, odd ones among them, change the cost and not the result.
#[test]
fn nested_or_not() {
    for (nx, ny) in [(96, 96), (75, 51), (130, 33)] {
        let grid = Grid::new(nx, ny, 0.01, 0.01).unwrap();
        let map = rough(&grid, 13);
        for kernel in Kernel::all(grid, 1.0) {
            let solve = |nested: bool| {
                FixedLoadSolver::builder(&map, &kernel)
                    .tolerance(1e-11)
                    .nested(nested)
                    .build()
                    .unwrap()
                    .solve(0.02 * grid.nominal_area())
                    .unwrap()
            };
            let (nested, plain) = (solve(true), solve(false));
            assert_eq!(nested.fields.contact_map, plain.fields.contact_map);
            // The tolerance times the condition.
            let error = (&nested.fields.pressure - &plain.fields.pressure).amax();
            assert!(error < 1e-8 * plain.fields.max_pressure(), "{error:e}");
            assert_eq!(plain.effort.coarse_convolutions, 0.0);
            // One at least on the next grid, a quarter of this one; all coarser ones have a third of its nodes, and ask
            // less of their solutions than it does.
            let coarse = nested.effort.coarse_convolutions;
            assert!(coarse >= 0.25 && coarse < 0.35 * plain.effort.convolutions as f64, "{coarse}");
            // One an iteration, and some to begin and to end with.
            for effort in [nested.effort, plain.effort] {
                let steps = effort.iterations + effort.stiffness_iterations;
                assert!((steps + 1..=2 * steps).contains(&effort.convolutions), "{effort:?}");
            }
            let [with, without] = [&nested, &plain].map(|solution| solution.effort.iterations);
            assert!(with < without, "{nx} x {ny}: {with} with, {without} without coarser grids");
        }
    }
}

/// A kernel that says nothing about itself, and a stiffness that comes later, give the same state.
#[test]
fn any_kernel_and_a_stiffness_that_comes_later() {
    let grid = Grid::square(96, 1.0).unwrap();
    let map = rough(&grid, 3);
    let plain = Plain(Boussinesq::new(grid, 1.0).unwrap());
    let mut expected = solver(&map, &plain, 1e-11).solve(0.02).unwrap();
    let mut plainly =
        FixedLoadSolver::builder(&map, &plain).tolerance(1e-11).stiffness(false).build().unwrap();
    let mut without = plainly.solve(0.02).unwrap();
    assert!(without.contact.contact_stiffness.is_none() && without.pressure_rate.is_empty());
    let next = plainly.solve_from(&without, 0.022).unwrap();
    check(&plainly, &next, 1e-11);
    let before = without.effort;
    plainly.add_stiffness(&mut without).unwrap();
    // One a step, one to begin with, and one for each time that five digits of eleven are won in single precision.
    let (after, steps) = (without.effort, without.effort.stiffness_iterations);
    let added = after.convolutions - before.convolutions;
    assert_eq!((before.stiffness_iterations, after.iterations), (0, before.iterations));
    assert!((steps + 1..=steps + 4).contains(&added), "{before:?} {after:?}");
    // The preconditioner remembers what was solved in between: stiffnesses agree to the tolerance.
    let stiffnesses = |state: &mut ContactState| {
        let stiffnesses = [&mut state.contact_stiffness, &mut state.interfacial_stiffness];
        stiffnesses.map(|stiffness| stiffness.take().unwrap())
    };
    let found = stiffnesses(&mut without.contact);
    for (found, expected) in found.into_iter().zip(stiffnesses(&mut expected.contact)) {
        assert!((found / expected - 1.0).abs() < 1e-11);
    }
    assert_eq!(without.contact, expected.contact);
}

/// A body of which nothing is known but its symbol, positive on each wave of the grid. On coarser grids of odd numbers
/// of nodes it need not be positive definite, and whole groups of nodes may come and go.
#[test]
fn any_symbol_is_solved_from_coarser_grids() {
    let grid = Grid::new(67, 1, 1.0, 1.0).unwrap();
    let map = rough(&grid, 5);
    for seed in 1..40 {
        let symbol = |qx: f64, _: f64| {
            let wave = (qx.abs() * 67.0 / std::f64::consts::TAU).round();
            // Somewhere between 0.01 and 100, another number for each wave.
            let random = (0.618_033_988_7 * f64::from(seed) * (wave + 1.0).powi(2)).fract();
            10_f64.powf(4.0 * random - 2.0)
        };
        let mean = MeanDisplacement::Physical;
        let kernel = KernelTable::from_symbol(grid, mean, ContactGrowth::Unknown, symbol).unwrap();
        for load in [0.1, 3.0] {
            let [nested, plain] = [true, false].map(|nested| {
                let builder = FixedLoadSolver::builder(&map, &kernel).tolerance(1e-11);
                let mut solver = builder.nested(nested).build().unwrap();
                let solution = solver.solve(load).unwrap();
                check(&solver, &solution, 1e-11);
                solution
            });
            // The solution is the only one: the tolerance times the condition.
            let error = (&nested.fields.pressure - &plain.fields.pressure).amax();
            assert!(error < 1e-7 * plain.fields.max_pressure(), "{error:e}");
        }
    }
}
