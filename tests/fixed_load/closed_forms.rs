//! Full contact, punches and identities that need no other solver.

use asperity::surface::{FlatPunch, HeightMap, Paraboloid};
use asperity::{ContactTarget, Error, FixedLoadSolver, Grid, Surface};
use nalgebra::DMatrix;

use crate::common::fixed_load::check;
use crate::problems::{Kernel, solver};
use asperity_testing::close::relative;
use asperity_testing::surfaces::rough;

/// C⁺ g by the sum over all waves.
pub(crate) fn pseudo_inverse(kernel: &Kernel, values: &DMatrix<f64>) -> DMatrix<f64> {
    let (nx, ny) = values.shape();
    let turn = |k: usize, n: usize| std::f64::consts::TAU * (k % n) as f64 / n as f64;
    let kernel = DMatrix::from_fn(nx, ny, |x, y| {
        let mut sum = 0.0;
        for (kx, ky) in (1..nx * ny).map(|k| (k % nx, k / nx)) {
            sum += (turn(kx * x, nx) + turn(ky * y, ny)).cos() / kernel.symbol(kx, ky);
        }
        sum / (nx * ny) as f64
    });
    DMatrix::from_fn(nx, ny, |x, y| {
        let mut sum = 0.0;
        for (ix, iy) in (0..nx * ny).map(|i| (i % nx, i / nx)) {
            sum += kernel[((x + nx - ix) % nx, (y + ny - iy) % ny)] * values[(ix, iy)];
        }
        sum
    })
}

/// Initial gap.
pub(crate) fn initial_gap(map: &HeightMap, grid: &Grid) -> DMatrix<f64> {
    let heights = map.heights(grid).unwrap();
    heights.map(|height| heights.max() - height)
}

/// In full contact of a periodic half-space p = p̄ − C⁺ g, from the mean pressure max C⁺ g on.
#[test]
fn full_contact_is_the_pseudo_inverse() {
    let grid = Grid::new(20, 15, 1.0, 1.2).unwrap();
    let map = rough(&grid, 7);
    let gap = initial_gap(&map, &grid);
    for kernel in Kernel::periodic(grid, 3.0) {
        let relief = pseudo_inverse(&kernel, &gap);
        let full = relief.max();
        let mut solver = solver(&map, &kernel, 1e-12);
        for factor in [1.0 + 1e-9, 1.001, 2.0, 1e3] {
            let mean = factor * full;
            let solution = solver.solve(mean * grid.nominal_area()).unwrap();
            check(&solver, &solution, 1e-12);
            let state = solution.contact;
            assert_eq!(state.contact_nodes, grid.nodes());
            assert_eq!(state.mean_gap, 0.0);
            assert_eq!(state.interfacial_stiffness, Some(f64::INFINITY));
            // The tolerance of 1e-12 times the condition.
            assert!(relative(state.approach, gap.mean()) < 1e-10);
            let expected = relief.map(|relief| mean - relief);
            let error = (&solution.fields.pressure - &expected).amax() / mean;
            assert!(error < 1e-10, "{factor}: {error:e}");
        }
        let short = solver.solve(0.999 * full * grid.nominal_area()).unwrap();
        check(&solver, &short, 1e-12);
        assert!(short.contact.contact_nodes < grid.nodes() && short.contact.mean_gap > 0.0);
    }
}

/// The approach of a periodic half-space determines the state up to full contact, and no farther.
#[test]
fn approaches_up_to_the_mean_gap() {
    let grid = Grid::new(48, 40, 1.0, 1.0).unwrap();
    let map = rough(&grid, 5);
    let mean_gap = initial_gap(&map, &grid).mean();
    for kernel in Kernel::periodic(grid, 1.0) {
        let mut solver = solver(&map, &kernel, 1e-11);
        for part in [1e-6, 0.1, 0.5, 0.9, 0.99, 0.999, 0.999_99] {
            let by_approach = solver.solve_approach(part * mean_gap).unwrap();
            check(&solver, &by_approach, 1e-11);
            let state = by_approach.contact;
            // The mean gap closes by what the mean planes approach: an identity, up to gaps in
            // contact of the tolerance.
            let error = state.mean_gap - (1.0 - part) * mean_gap;
            assert!(error.abs() < 1e-10 * mean_gap, "{part}: {error:e}");
            let by_load = solver.solve(state.load).unwrap();
            let error = relative(by_load.contact.approach, state.approach);
            assert!(error < 1e-9, "{part}: {error:e}");
        }
        for part in [1.0, 1.5] {
            match solver.solve_approach(part * mean_gap * (1.0 + 1e-12)) {
                Err(Error::ApproachNotReached { mean_gap: limit, .. }) => {
                    assert!(relative(limit, mean_gap) < 1e-12);
                }
                other => panic!("{other:?}"),
            }
        }
    }
}

/// Flat surfaces and single nodes are in full contact under any load; on a periodic half-space the
/// pressure is uniform.
#[test]
fn flat_surfaces() {
    for (nx, ny) in [(1, 1), (2, 1), (16, 16), (33, 20)] {
        let grid = Grid::new(nx, ny, 1.0, 2.0).unwrap();
        for kernel in Kernel::periodic(grid, 1.0) {
            let mut solver = FixedLoadSolver::new(&FlatPunch::default(), &kernel).unwrap();
            for load in [1e-9, 1.0, 1e9] {
                let solution = solver.solve(load).unwrap();
                check(&solver, &solution, 1e-8);
                let pressure = load / grid.nominal_area();
                let error = solution.fields.pressure.map(|p| (p / pressure - 1.0).abs()).max();
                assert!(error < 1e-12, "{error:e}");
                assert_eq!(solution.contact.mean_gap, 0.0);
                assert_eq!(solution.contact.interfacial_stiffness, Some(f64::INFINITY));
            }
            assert!(matches!(solver.solve_approach(1e-9), Err(Error::ApproachNotReached { .. })));
        }
    }
    let grid = Grid::square(64, 1.0).unwrap();
    let flat = HeightMap::new(DMatrix::from_element(64, 64, 3.0)).unwrap();
    let mut punch = solver(&flat, &Kernel::free(grid, 1.0), 1e-12);
    let solution = punch.solve(1.0).unwrap();
    check(&punch, &solution, 1e-12);
    assert_eq!(solution.contact.contact_nodes, 4096);
    // The square punch on 64 × 64 cells from a dense solver, given to eight digits.
    assert!(relative(solution.contact.contact_stiffness.unwrap(), 1.1461731) < 1e-7);
}

/// Symmetric shapes have ties at every step.
#[test]
fn a_sphere_is_symmetric() {
    let grid = Grid::square(64, 1.0).unwrap();
    let map = HeightMap::sample(&Paraboloid::new(10.0).unwrap(), &grid).unwrap();
    let mut sphere = solver(&map, &Kernel::free(grid, 1.0), 1e-12);
    let solution = sphere.solve(0.001).unwrap();
    check(&sphere, &solution, 1e-12);
    let p = &solution.fields.pressure;
    for ((ix, iy), value) in (0..64 * 64).map(|k| ((k % 64, k / 64), p[(k % 64, k / 64)])) {
        // Mirror images are equal to the tolerance times the condition.
        assert!((value - p[(63 - ix, iy)]).abs() < 1e-9 * p.max());
        assert!((value - p[(iy, ix)]).abs() < 1e-9 * p.max());
    }
}

/// Two nodes of a periodic half-space, from full contact back to approaches at which one of them carries: with
/// the eigenvalue λ of the only wave, it takes all of the load `ΔA 2δ / λ`. The prediction has pressure at both.
#[test]
fn from_full_contact_to_an_approach() {
    let grid = Grid::new(2, 1, 1.0, 1.5).unwrap();
    let map = HeightMap::new(DMatrix::from_column_slice(2, 1, &[0.0, -0.01])).unwrap();
    for kernel in Kernel::periodic(grid, 1.0) {
        let symbol = kernel.symbol(1, 0);
        let load = |approach: f64| grid.cell_area() * 2.0 * approach / symbol;
        let mut solver = FixedLoadSolver::builder(&map, &kernel)
            .tolerance(1e-12)
            .stiffness(false)
            .build()
            .unwrap();
        // Full contact begins at the mean gap.
        let mean_gap = 0.005;
        let targets = [
            ContactTarget::Load(1.1 * load(mean_gap)),
            ContactTarget::Approach(0.95 * mean_gap),
            ContactTarget::Approach(0.9 * mean_gap),
        ];
        let solutions: Vec<_> = solver.sweep(targets).map(Result::unwrap).collect();
        assert_eq!(solutions[0].contact.contact_nodes, 2);
        for (solution, part) in solutions[1..].iter().zip([0.95, 0.9]) {
            check(&solver, solution, 1e-12);
            assert_eq!(solution.contact.contact_nodes, 1);
            // One equation, whose error is the tolerance.
            let error = relative(solution.contact.load, load(part * mean_gap));
            assert!(error < 1e-11, "{error:e}");
        }
    }
}
