//! One load on a periodic half-space: against another solver's results, against the path, against
//! the closed form of full contact, and at extremes.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

mod common;

use asperity::fixed_load::{FixedLoadSolution, FixedLoadSolver};
use asperity::loading::History;
use asperity::surface::{Amplitude, FlatPunch, HeightMap, SelfAffine};
use asperity::updater::ConjugateGradient;
use asperity::{
    Boundary, ContactGrowth, Error, Grid, InfluenceKernel, LoadingSolver, PeriodicBoussinesq,
    Spectral, Surface,
};
use common::fixed_load::relative;
use common::surface;
use nalgebra::DMatrix;

/// Every figure of a certificate within the tolerance, and no stiffness that would depend on the gauge.
fn check(solution: &FixedLoadSolution, tolerance: f64) {
    common::fixed_load::check(solution, tolerance);
    assert_eq!(solution.state.contact_stiffness, None);
}

/// A kernel through the interface that any has, so that one test serves two.
#[derive(Clone)]
enum Kernel {
    Love(PeriodicBoussinesq),
    Spectral(Spectral),
}

impl Kernel {
    fn both(grid: Grid, e_star: f64) -> [Self; 2] {
        [
            Self::Love(PeriodicBoussinesq::new(grid, e_star).unwrap()),
            Self::Spectral(Spectral::new(grid, e_star).unwrap()),
        ]
    }

    fn in_gauge(self, factor: f64) -> Self {
        match self {
            Self::Love(kernel) => {
                let gauge = factor * kernel.gauge();
                Self::Love(kernel.with_gauge(gauge).unwrap())
            }
            Self::Spectral(kernel) => {
                let gauge = factor * kernel.gauge();
                Self::Spectral(kernel.with_gauge(gauge).unwrap())
            }
        }
    }

    fn symbol(&self, kx: usize, ky: usize) -> f64 {
        let (kx, ky) = (kx as isize, ky as isize);
        match self {
            Self::Love(kernel) => kernel.symbol(kx, ky),
            Self::Spectral(kernel) => kernel.symbol(kx, ky),
        }
    }
}

impl InfluenceKernel for Kernel {
    fn grid(&self) -> Grid {
        match self {
            Self::Love(kernel) => kernel.grid(),
            Self::Spectral(kernel) => kernel.grid(),
        }
    }
    fn boundary(&self) -> Boundary {
        Boundary::Periodic
    }
    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        match self {
            Self::Love(kernel) => kernel.coefficient(di, dj),
            Self::Spectral(kernel) => kernel.coefficient(di, dj),
        }
    }
    fn contact_growth(&self) -> ContactGrowth {
        match self {
            Self::Love(kernel) => kernel.contact_growth(),
            Self::Spectral(kernel) => kernel.contact_growth(),
        }
    }
}

fn rough(grid: &Grid, seed: u64) -> HeightMap {
    let (lx, ly) = grid.sides();
    let long = lx.max(ly);
    let short = 4.0 * grid.dx().max(grid.dy());
    let height = Amplitude::RmsHeight(1e-2 * long);
    let surface = SelfAffine::new(0.8, long / 2.0, short, height, seed).unwrap();
    HeightMap::sample(&surface, grid).unwrap()
}

/// Contact nodes, greatest pressure and mean gap from tamaas 2.9.0 at a tolerance of 1e-13, given
/// in `tests/data/periodic_128_fixed_load.json`.
#[test]
fn reference_loads() {
    let grid = Grid::square(128, 1.0).unwrap();
    let kernel = Spectral::new(grid, 1.0).unwrap();
    let mut solver = FixedLoadSolver::builder(surface("periodic_128"), kernel)
        .tolerance(1e-12)
        .build()
        .unwrap();
    for (load, nodes, max_pressure, mean_gap) in [
        (1e-4, 34, 0.10545348200430753, 0.008637231899276225),
        (1e-3, 431, 0.14872619056802042, 0.005288125769841879),
        (1e-2, 3675, 0.18943174504772775, 0.0019625055948044364),
        (4e-2, 10901, 0.23198078863035695, 0.000312262401477235),
    ] {
        let solution = solver.solve(load).unwrap();
        check(&solution, 1e-12);
        assert_eq!(solution.state.contact_nodes, nodes, "load {load}");
        // Pressures err some hundred times as much as gaps, relative to the greatest of each.
        let error = relative(solution.state.max_pressure, max_pressure);
        assert!(error < 1e-9, "load {load}: pressure {error:e}");
        let error = relative(solution.state.mean_gap, mean_gap);
        assert!(error < 1e-9, "load {load}: mean gap {error:e}");
    }
}

/// At random loads on random surfaces the state is that of the path, computed by a factorisation
/// that shares no code with the iteration; with either kernel, on even and odd grids and strips.
#[test]
fn loads_on_the_path() {
    let mut seed = 0x9E37_79B9_7F4A_7C15_u64;
    let mut uniform = || {
        seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    let shapes = [(32, 32), (40, 25), (33, 47), (48, 48), (1, 90), (24, 36)];
    for (case, (nx, ny)) in shapes.into_iter().enumerate() {
        let grid = Grid::new(nx, ny, 1e-4, if case == 1 { 2e-4 } else { 1e-4 }).unwrap();
        let (lx, ly) = grid.sides();
        let long = lx.max(ly);
        let map = rough(&grid, case as u64);
        for (which, kernel) in Kernel::both(grid, 1e9).into_iter().enumerate() {
            // Love's kernel as it is, which contact can only grow on, and the other as it comes.
            if which == 1 && nx * ny > 1200 {
                continue;
            }
            let mut path = LoadingSolver::new(map.clone(), kernel.clone()).unwrap();
            let history: History = path.by_ref().map(Result::unwrap).collect();
            let last = history.states()[history.states().len() - 1];
            let mut solver = FixedLoadSolver::builder(map.clone(), kernel)
                .tolerance(1e-12)
                .build()
                .unwrap();
            for i in 0..17 {
                let load = last.load * 10_f64.powf(-5.0 * uniform() + 0.3);
                let expected = history.at_load(load).unwrap();
                // Near full contact the approach says nothing about the load: where it does, the
                // tolerance of 1e-12 of the approach is below 1e-9 of the load.
                let slope = expected.interfacial_stiffness * expected.approach / expected.load;
                let by_approach = i % 4 == 3 && slope < 1e3;
                let solution = if by_approach {
                    solver.solve_approach(expected.approach).unwrap()
                } else {
                    solver.solve(load).unwrap()
                };
                check(&solution, 1e-12);
                let state = solution.state;
                let context = format!("case {case}, load {load:e}: {state:?}, {expected:?}");
                assert_eq!(state.contact_nodes, expected.step, "{context}");
                // Near full contact the mean gap is a small difference; it is measured by the rms
                // height. Everything else is within some hundred times the tolerance, and 1e-8 is
                // what was asked for.
                assert!(
                    (state.mean_gap - expected.mean_gap).abs() < 1e-10 * long,
                    "{context}"
                );
                for (found, expected) in [
                    (state.load, expected.load),
                    (state.approach, expected.approach),
                    (state.energy, expected.energy),
                ] {
                    assert!(relative(found, expected) < 1e-8, "{context}");
                }
                let stiffness = state.interfacial_stiffness.unwrap();
                if expected.interfacial_stiffness.is_finite() {
                    // Its inverse is the mean of 1 − u₂ outside, which the error of u₂ < 1 in
                    // contact, the tolerance times the condition, does not spare.
                    let error = relative(stiffness, expected.interfacial_stiffness);
                    assert!(error < 1e-8, "{error:e} {context}");
                } else {
                    assert_eq!(stiffness, f64::INFINITY);
                }
                let pressure = path.pressure_at(&expected).unwrap();
                let error = (&solution.pressure - &pressure).amax() / pressure.amax();
                assert!(error < 1e-8, "{context}: {error:e}");
                // The displacement is about its mean.
                let mean = solution.displacement.mean();
                assert!(
                    mean.abs() < 1e-13 * solution.displacement.amax(),
                    "{mean:e}"
                );
            }
        }
    }
}

/// C⁺ g by the sum over all waves.
fn pseudo_inverse(kernel: &Kernel, values: &DMatrix<f64>) -> DMatrix<f64> {
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

/// In full contact p = p̄ − C⁺ g, from the mean pressure max C⁺ g on, at which the last node, where
/// it is greatest, touches with no pressure.
#[test]
fn full_contact_is_the_pseudo_inverse() {
    let grid = Grid::new(20, 15, 1.0, 1.2).unwrap();
    let map = rough(&grid, 7);
    let heights = map.heights(&grid).unwrap();
    let gap = heights.map(|height| heights.max() - height);
    for kernel in Kernel::both(grid, 3.0) {
        let relief = pseudo_inverse(&kernel, &gap);
        let full = relief.max();
        let state = LoadingSolver::new(&map, kernel.clone())
            .unwrap()
            .last()
            .unwrap()
            .unwrap();
        // The sums have 300 terms: some 1e-14 of the greatest, magnified by a condition number of 30.
        assert!(relative(state.mean_pressure(), full) < 1e-12);
        assert_eq!(relief[state.node], full);
        assert!(relative(state.approach, gap.mean()) < 1e-12);

        let mut solver = FixedLoadSolver::builder(&map, kernel)
            .tolerance(1e-12)
            .build()
            .unwrap();
        for factor in [1.0 + 1e-9, 1.001, 2.0, 1e3] {
            let mean = factor * full;
            let solution = solver.solve(mean * grid.nominal_area()).unwrap();
            check(&solution, 1e-12);
            let state = solution.state;
            assert_eq!(state.contact_nodes, grid.nodes());
            assert_eq!(state.mean_gap, 0.0);
            assert_eq!(state.interfacial_stiffness, Some(f64::INFINITY));
            // The tolerance of 1e-12 times the condition.
            assert!(relative(state.approach, gap.mean()) < 1e-10);
            let expected = relief.map(|relief| mean - relief);
            let error = (&solution.pressure - &expected).amax() / mean;
            assert!(error < 1e-10, "{factor}: {error:e}");
        }
        let short = solver.solve(0.999 * full * grid.nominal_area()).unwrap();
        check(&short, 1e-12);
        assert!(short.state.contact_nodes < grid.nodes() && short.state.mean_gap > 0.0);
    }
}

/// The gauge of the kernel, zero included, is of no influence.
#[test]
fn gauges_do_not_matter() {
    let grid = Grid::square(48, 1.0).unwrap();
    let map = rough(&grid, 11);
    for kernel in Kernel::both(grid, 1.0) {
        let solve = |factor: f64, load: f64| {
            FixedLoadSolver::builder(&map, kernel.clone().in_gauge(factor))
                .tolerance(1e-12)
                .build()
                .unwrap()
                .solve(load)
                .unwrap()
        };
        for load in [1e-3, 0.05, 1.0] {
            let expected = solve(1.0, load);
            for factor in [0.0, 0.5, 10.0] {
                let found = solve(factor, load);
                check(&found, 1e-12);
                assert_eq!(found.contact, expected.contact);
                // The tolerance times the condition.
                let error = (&found.pressure - &expected.pressure).amax();
                assert!(error < 1e-10 * expected.pressure.max(), "{error:e}");
                assert!(relative(found.state.approach, expected.state.approach) < 1e-10);
                assert!(relative(found.state.energy, expected.state.energy) < 1e-10);
            }
        }
    }
}

#[test]
fn single_node_to_far_beyond_full_contact() {
    let grid = Grid::square(64, 1.0).unwrap();
    let map = rough(&grid, 3);
    for kernel in Kernel::both(grid, 1.0) {
        let mean = DMatrix::from_fn(64, 64, |i, j| kernel.coefficient(i as isize, j as isize));
        let own = kernel.coefficient(0, 0) - mean.mean();
        for tolerance in [1e-8, 1e-12] {
            let mut solver = FixedLoadSolver::builder(&map, kernel.clone())
                .tolerance(tolerance)
                .build()
                .unwrap();
            for exponent in -60..=6 {
                let load = 10_f64.powi(exponent);
                let solution = solver.solve(load).unwrap();
                check(&solution, tolerance);
                if exponent <= -10 {
                    assert_eq!(solution.state.contact_nodes, 1);
                    // δ = C₀ p and K = ΔA / C₀, in the zero gauge.
                    let approach = own * load / grid.cell_area();
                    assert!(relative(solution.state.approach, approach) < tolerance.max(1e-11));
                    let stiffness = solution.state.interfacial_stiffness.unwrap();
                    assert!(relative(stiffness, grid.cell_area() / own) < tolerance.max(1e-11));
                }
                if exponent >= 1 {
                    assert_eq!(solution.state.contact_nodes, grid.nodes());
                    assert_eq!(solution.state.interfacial_stiffness, Some(f64::INFINITY));
                    assert_eq!(solution.state.mean_gap, 0.0);
                }
            }
        }
    }
}

/// The approach determines the state up to full contact, and no farther.
#[test]
fn approaches_up_to_the_mean_gap() {
    let grid = Grid::new(48, 40, 1.0, 1.0).unwrap();
    let map = rough(&grid, 5);
    let heights = map.heights(&grid).unwrap();
    let mean_gap = heights.max() - heights.mean();
    for kernel in Kernel::both(grid, 1.0) {
        let mut solver = FixedLoadSolver::builder(&map, kernel)
            .tolerance(1e-11)
            .build()
            .unwrap();
        for part in [1e-6, 0.1, 0.5, 0.9, 0.99, 0.999, 0.999_99] {
            let by_approach = solver.solve_approach(part * mean_gap).unwrap();
            check(&by_approach, 1e-11);
            let state = by_approach.state;
            // The mean gap closes by what the mean planes approach: an identity, but for gaps in
            // contact of the tolerance.
            let error = state.mean_gap - (1.0 - part) * mean_gap;
            assert!(error.abs() < 1e-10 * mean_gap, "{part}: {error:e}");
            let by_load = solver.solve(state.load).unwrap();
            let error = relative(by_load.state.approach, state.approach);
            assert!(error < 1e-9, "{part}: {error:e}");
        }
        for part in [1.0, 1.5] {
            match solver.solve_approach(part * mean_gap * (1.0 + 1e-12)) {
                Err(Error::ApproachNotReached {
                    mean_gap: limit, ..
                }) => {
                    assert!(relative(limit, mean_gap) < 1e-12);
                }
                other => panic!("{other:?}"),
            }
        }
    }
}

/// Nested grids, odd ones among them, change the cost and not the result; flat surfaces and single
/// nodes are in full contact under any load.
#[test]
fn nested_or_not_and_flat() {
    for (nx, ny) in [(96, 96), (75, 51), (130, 33)] {
        let grid = Grid::new(nx, ny, 0.01, 0.01).unwrap();
        let map = rough(&grid, 13);
        for kernel in Kernel::both(grid, 1.0) {
            let solve = |nested: bool| {
                FixedLoadSolver::builder(&map, kernel.clone())
                    .tolerance(1e-11)
                    .nested(nested)
                    .build()
                    .unwrap()
                    .solve(0.02 * grid.nominal_area())
                    .unwrap()
            };
            let (nested, plain) = (solve(true), solve(false));
            assert_eq!(nested.contact, plain.contact);
            // The tolerance times the condition.
            assert!((&nested.pressure - &plain.pressure).amax() < 1e-8 * plain.pressure.max());
            assert!(
                nested.iterations < plain.iterations,
                "{nx} x {ny}: {} with, {} without coarser grids",
                nested.iterations,
                plain.iterations
            );
        }
    }
    for (nx, ny) in [(1, 1), (2, 1), (16, 16), (33, 20)] {
        let grid = Grid::new(nx, ny, 1.0, 2.0).unwrap();
        for kernel in Kernel::both(grid, 1.0) {
            let mut solver = FixedLoadSolver::new(FlatPunch::default(), kernel).unwrap();
            for load in [1e-9, 1.0, 1e9] {
                let solution = solver.solve(load).unwrap();
                let pressure = load / grid.nominal_area();
                let error = solution.pressure.map(|p| (p / pressure - 1.0).abs()).max();
                assert!(error < 1e-12, "{error:e}");
                assert_eq!(solution.state.mean_gap, 0.0);
                assert_eq!(solution.state.interfacial_stiffness, Some(f64::INFINITY));
            }
            assert!(matches!(
                solver.solve_approach(1e-9),
                Err(Error::ApproachNotReached { .. })
            ));
        }
    }
}

#[test]
fn a_sweep_is_its_loads() {
    let grid = Grid::square(96, 1.0).unwrap();
    let map = rough(&grid, 17);
    for kernel in Kernel::both(grid, 1.0) {
        let mut solver = FixedLoadSolver::builder(&map, kernel)
            .tolerance(1e-11)
            .build()
            .unwrap();
        // Up, in small and large steps, beyond full contact, and down again.
        let loads = [1e-6, 1e-4, 1e-2, 1.1e-2, 0.1, 0.12, 3.0, 0.05, 1e-5];
        let swept: Vec<_> = solver.sweep(loads).map(Result::unwrap).collect();
        assert_eq!(swept.len(), loads.len());
        for (load, swept) in loads.into_iter().zip(swept) {
            check(&swept, 1e-11);
            let cold = solver.solve(load).unwrap();
            assert_eq!(swept.contact, cold.contact, "load {load}");
            let error = (&swept.pressure - &cold.pressure).amax() / cold.pressure.max();
            // The tolerance times the condition.
            assert!(error < 1e-8, "load {load}: {error:e}");
            let stiffnesses = [swept, cold].map(|s| s.state.interfacial_stiffness.unwrap());
            if stiffnesses[0].is_finite() {
                let error = relative(stiffnesses[0], stiffnesses[1]);
                assert!(error < 1e-8, "load {load}: {error:e}");
            } else {
                assert_eq!(stiffnesses[0], stiffnesses[1]);
            }
        }
    }
}

/// The updater without a factor gives the same periodic path, and its preconditioner the same
/// operator in any gauge.
#[test]
fn conjugate_gradients_follow_a_periodic_path() {
    let grid = Grid::new(20, 16, 1.0, 1.0).unwrap();
    let map = rough(&grid, 19);
    for kernel in Kernel::both(grid, 1.0) {
        let factored: Vec<_> = LoadingSolver::new(&map, kernel.clone())
            .unwrap()
            .map(Result::unwrap)
            .collect();
        let iterated: Vec<_> = LoadingSolver::builder(&map, kernel)
            .updater(ConjugateGradient::new())
            .window_size(12)
            .build()
            .unwrap()
            .map(Result::unwrap)
            .collect();
        assert_eq!(factored.len(), iterated.len());
        let first = factored[0].mean_gap;
        for (a, b) in factored.iter().zip(&iterated) {
            assert_eq!((a.step, a.node), (b.step, b.node));
            // A tolerance of 1e-12 times a condition of some hundred, as for the free half-space.
            assert!((a.load - b.load).abs() <= 1e-9 * a.load, "{a:?} {b:?}");
            assert!(
                (a.mean_gap - b.mean_gap).abs() <= 1e-10 * first,
                "{a:?} {b:?}"
            );
        }
    }
}

/// Sums are taken in fixed chunks: the number of threads does not touch a bit.
#[cfg(feature = "rayon")]
#[test]
fn threads_do_not_change_a_bit() {
    let grid = Grid::new(150, 130, 1.0 / 150.0, 1.0 / 150.0).unwrap();
    let map = rough(&grid, 3);
    let solve = || {
        let kernel = PeriodicBoussinesq::new(grid, 1.0).unwrap();
        FixedLoadSolver::new(&map, kernel)
            .unwrap()
            .solve(0.05)
            .unwrap()
    };
    let in_threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(solve)
    };
    let one = in_threads(1);
    for threads in [2, 3] {
        assert!(in_threads(threads) == one);
    }
}

/// The fields of a path do not depend on the gauge either: its displacement is about the mean.
#[test]
fn fields_of_a_path_in_two_gauges() {
    let grid = Grid::new(24, 18, 1.0, 1.0).unwrap();
    let map = rough(&grid, 23);
    let kernel = PeriodicBoussinesq::new(grid, 1.0).unwrap();
    let larger = kernel.gauge() * 4.0;
    let [mut a, mut b] = [kernel.clone(), kernel.with_gauge(larger).unwrap()]
        .map(|kernel| LoadingSolver::new(&map, kernel).unwrap());
    for step in 1..=grid.nodes() {
        let states = [a.next().unwrap().unwrap(), b.next().unwrap().unwrap()];
        assert_eq!(states[0].node, states[1].node);
        if step % 60 != 0 && step != grid.nodes() {
            continue;
        }
        let [u, v] = [&mut a, &mut b].map(|path| path.displacement().unwrap());
        // Rounding of the uniform displacement, which is some ten times as large in the second.
        assert!((&u - &v).amax() < 1e-11 * u.amax(), "step {step}");
        assert!(u.mean().abs() < 1e-12 * u.amax(), "step {step}");
        let expected = a.gap().unwrap();
        let gap = map.heights(&grid).unwrap();
        let gap = gap.map(|height| gap.max() - height) + u;
        let gap = gap.map(|value| value - states[0].approach);
        assert!((gap - expected).amax() < 1e-12 * v.amax(), "step {step}");
    }
}
