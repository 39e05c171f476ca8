//! The same states as along the path, computed by a factorisation that shares no code with the
//! iteration.

use asperity::loading::History;
use asperity::surface::HeightMap;
use asperity::{ContactTarget, FixedLoadSolver, Grid, LoadingSolver};

use crate::closed_forms::{initial_gap, pseudo_inverse};
use crate::common::fixed_load::check;
use crate::problems::{Kernel, solver};
use asperity_testing::close::relative;
use asperity_testing::surfaces::rough;

/// A path to its end, with its states.
fn path(map: &HeightMap, kernel: &Kernel) -> (LoadingSolver, History) {
    let mut path = LoadingSolver::new(map, kernel).unwrap();
    let history = path.by_ref().map(Result::unwrap).collect();
    (path, history)
}

/// At random loads on random surfaces, with every kernel, on even and odd grids and strips.
#[test]
fn random_loads() {
    let mut seed = 0x9E37_79B9_7F4A_7C15_u64;
    let mut uniform = || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    let shapes = [(32, 32), (40, 25), (33, 47), (64, 64), (1, 90), (24, 36)];
    for (case, (nx, ny)) in shapes.into_iter().enumerate() {
        let grid = Grid::new(nx, ny, 1e-4, if case == 1 { 2e-4 } else { 1e-4 }).unwrap();
        let (lx, ly) = grid.sides();
        let long = lx.max(ly);
        let map = rough(&grid, case as u64);
        for kernel in Kernel::all(grid, 1e9) {
            // The path of the spectral kernel is computed one event at a time.
            if matches!(kernel, Kernel::Spectral(_)) && nx * ny > 1200 {
                continue;
            }
            let is_free = matches!(kernel, Kernel::Free(_));
            let (mut path, history) = path(&map, &kernel);
            let last = history.states()[history.states().len() - 1].contact.load;
            let mut solver = solver(&map, &kernel, 1e-12);
            for i in 0..17 {
                let load = last * 10_f64.powf(-5.0 * uniform() + 0.3);
                let expected = history.at_load(load).unwrap();
                let interfacial = expected.contact.interfacial_stiffness.unwrap();
                // Near full contact the approach of mean planes says nothing about the load: where
                // it does, the tolerance of 1e-12 of the approach is below 1e-9 of the load.
                let slope = interfacial * expected.contact.approach / expected.contact.load;
                let by_approach = i % 4 == 3 && (is_free || slope < 1e3);
                let solution = if by_approach {
                    solver.solve_approach(expected.contact.approach).unwrap()
                } else {
                    solver.solve(load).unwrap()
                };
                check(&solver, &solution, 1e-12);
                let state = solution.contact;
                let context = format!("case {case}, load {load:e}: {state:?}, {expected:?}");
                assert_eq!(state.contact_nodes, expected.contact.contact_nodes, "{context}");
                // Near full contact the mean gap is a small difference; it is measured by the rms
                // height. Everything else is within some hundred times the tolerance, and 1e-8 is
                // what was asked for.
                let error = (state.mean_gap - expected.contact.mean_gap).abs();
                assert!(error < 1e-10 * long, "{context}");
                for (found, expected) in [
                    (state.load, expected.contact.load),
                    (state.approach, expected.contact.approach),
                    (state.energy, expected.contact.energy),
                ] {
                    assert!(relative(found, expected) < 1e-8, "{context}");
                }
                match (state.contact_stiffness, expected.contact.contact_stiffness) {
                    (Some(found), Some(expected)) => {
                        assert!(is_free && relative(found, expected) < 1e-8, "{context}");
                    }
                    (found, expected) => assert!(!is_free && found == expected, "{context}"),
                }
                let stiffness = state.interfacial_stiffness.unwrap();
                if interfacial.is_finite() {
                    // Its inverse is the mean of 1 − u₂ outside, which the error of u₂ < 1 in
                    // contact, the tolerance times the condition, does not spare.
                    let error = relative(stiffness, interfacial);
                    assert!(error < 1e-8, "{error:e} {context}");
                } else {
                    assert_eq!(stiffness, f64::INFINITY);
                }
                let pressure = path.fields_at(&expected).unwrap().pressure;
                let error = (&solution.fields.pressure - &pressure).amax() / pressure.amax();
                assert!(error < 1e-8, "{context}: {error:e}");
                if !is_free {
                    // The displacement is about its mean.
                    let mean = solution.fields.displacement.mean();
                    let most = solution.fields.displacement.amax();
                    assert!(mean.abs() < 1e-13 * most, "{mean:e}");
                }
            }
        }
    }
}

/// Mean gaps and approaches of states of the path.
#[test]
fn mean_gaps_and_approaches() {
    let grid = Grid::square(48, 1.0).unwrap();
    let map = rough(&grid, 5);
    let kernel = Kernel::free(grid, 1.0);
    let (_, history) = path(&map, &kernel);
    for stiffness in [true, false] {
        let mut solver = FixedLoadSolver::builder(&map, &kernel)
            .tolerance(1e-12)
            .stiffness(stiffness)
            .build()
            .unwrap();
        let gaps = [30, 200, 230, 1000, 2200, 400]
            .map(|step: usize| history.states()[step].contact.mean_gap);
        let targets = gaps.map(ContactTarget::MeanGap);
        for (gap, solution) in gaps.into_iter().zip(solver.sweep(targets)) {
            let state = solution.unwrap().contact;
            assert!((state.mean_gap - gap).abs() <= 1e-12 * state.approach);
            let expected = history.at_mean_gap(gap).unwrap();
            // The tolerance of the gap times the stiffness.
            assert!(relative(state.load, expected.contact.load) < 1e-8, "{state:?}");
        }
        let steps = [100, 110, 900, 850];
        let approaches = steps.map(|step: usize| history.states()[step].contact.approach);
        let targets = approaches.map(ContactTarget::Approach);
        for (step, solution) in steps.into_iter().zip(solver.sweep(targets)) {
            let load = solution.unwrap().contact.load;
            assert!(relative(load, history.states()[step].contact.load) < 1e-8);
        }
    }
}

/// The path of a periodic half-space ends at the mean pressure max C⁺ g, at which the last node, where
/// it is greatest, touches with no pressure.
#[test]
fn the_path_ends_at_the_pseudo_inverse() {
    let grid = Grid::new(20, 15, 1.0, 1.2).unwrap();
    let map = rough(&grid, 7);
    let gap = initial_gap(&map, &grid);
    for kernel in Kernel::periodic(grid, 3.0) {
        let relief = pseudo_inverse(&kernel, &gap);
        let (mut path, history) = path(&map, &kernel);
        let state = history.states()[history.states().len() - 1];
        // The sums have 300 terms: some 1e-14 of the greatest, magnified by a condition number of 30.
        assert!(relative(state.contact.mean_pressure(), relief.max()) < 1e-12);
        assert!(relative(state.contact.approach, gap.mean()) < 1e-12);
        let pressure = path.fields_at(&state).unwrap().pressure;
        let (node, least) =
            pressure.iter().enumerate().fold((0, f64::INFINITY), |least, (node, p)| {
                if *p < least.1 { (node, *p) } else { least }
            });
        assert!(least.abs() < 1e-12 * pressure.max());
        assert_eq!(relief[node], relief.max());
    }
}
