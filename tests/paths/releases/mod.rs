//! Kernels under which nodes leave the contact: paths against an independent solver of the linear
//! complementarity problem, at and between events.

mod check;
mod failures;
mod made;
mod resumed;
mod table;
mod windows;

use asperity::Boundary;
use asperity::updater::{ConjugateGradient, Dense, Handover};
use check::{EXACT, ITERATED, check};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;
use table::{Table, case};

#[test]
fn random_kernels_against_an_independent_solver() {
    let mut releases = 0;
    for seed in 0..250 {
        let (kernel, gaps) = case(seed);
        releases += check(&kernel, &gaps, kernel.path(&gaps), EXACT);
    }
    println!("{releases} releases");
    assert!(releases >= 100, "{releases}");
}

#[test]
fn other_updaters_on_random_kernels() {
    let mut releases = 0;
    for seed in 250..310 {
        let (kernel, gaps) = case(seed);
        let own = check(&kernel, &gaps, kernel.path_with(&gaps, Dense::new()), EXACT);
        let iterative = ConjugateGradient::with_tolerance(1e-14).unwrap();
        let iterative = kernel.path_with(&gaps, iterative);
        assert_eq!(check(&kernel, &gaps, iterative, ITERATED), own);
        let handover = kernel.path_with(&gaps, Handover::new());
        assert_eq!(check(&kernel, &gaps, handover, EXACT), own);
        releases += own;
    }
    println!("{releases} releases");
    assert!(releases >= 30, "{releases}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn any_seed(seed in any::<u64>()) {
        let (kernel, gaps) = case(seed);
        check(&kernel, &gaps, kernel.path(&gaps), EXACT);
    }
}

/// Gaps that are few small integers, kernels with the symmetry of the rectangle: many nodes touch
/// and leave together.
#[test]
fn nodes_that_touch_and_leave_together() {
    let mut releases = 0;
    for seed in 0..60 {
        let mut random = ChaCha12Rng::seed_from_u64(1000 + seed);
        let shape = [(4, 4), (5, 3), (6, 5), (9, 1)][random.random_range(0..4)];
        let values: Vec<f64> = (0..36).map(|_| random.random_range(-0.6..1.0)).collect();
        let boundary = [Boundary::Free, Boundary::Periodic][seed as usize % 2];
        let kernel =
            Table::new(shape, boundary, |di, dj| values[di.unsigned_abs() + 6 * dj.unsigned_abs()]);
        let steps = random.random_range(1..4);
        let levels: Vec<f64> = (0..36).map(|_| f64::from(random.random_range(0..steps))).collect();
        let (nx, ny) = shape;
        let gaps: Vec<f64> = (0..nx * ny)
            .map(|node| {
                let (ix, iy) = kernel.grid.coordinates(node);
                levels[ix.min(nx - 1 - ix) + 6 * iy.min(ny - 1 - iy)]
            })
            .collect();
        releases += check(&kernel, &gaps, kernel.path(&gaps), EXACT);
    }
    println!("{releases} releases");
    assert!(releases >= 50, "{releases}");
}
