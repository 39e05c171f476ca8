//! Surfaces made so that a node leaves.

use super::table::Table;
use asperity::kernel::KernelTable;
use asperity::loading::{ContactEvent, LoadingEnd};
use asperity::surface::HeightMap;
use asperity::{Boundary, ContactGrowth, Grid, LoadingSolver};
use asperity_testing::dense::restrict;
use nalgebra::{DMatrix, DVector};
use rand::SeedableRng;
use rand_chacha::ChaCha12Rng;

/// A release exists if and only if, for some set J of holes and some i outside J,
/// 1 − A_iJ A_JJ⁻¹ e < 0, with A the pseudo-inverse of the kernel in the zero gauge: the share of i
/// in a growing load is negative. From such a set a surface is made whose node i leaves.
#[test]
fn a_surface_whose_node_leaves_can_be_made_from_any_set_of_holes_that_says_so() {
    let mut made = 0;
    for seed in 0..40 {
        let mut random = ChaCha12Rng::seed_from_u64(2000 + seed);
        let kernel = Table::random((3, 3), Boundary::Periodic, &mut random);
        let (n, matrix) = (9, kernel.matrix());
        // C⁻¹ = A + e eᵀ / (s M²) with s the gauge, the mean coefficient.
        let gauge = matrix.mean();
        let inverse = matrix.clone().cholesky().unwrap().inverse();
        let pseudo = inverse.map(|value| value - 1.0 / (gauge * (n * n) as f64));
        for holes in 0..(1_u32 << n) - 1 {
            let (out, inside): (Vec<usize>, Vec<usize>) =
                (0..n).partition(|&node| holes >> node & 1 == 1);
            let filled = restrict(&pseudo, &out).cholesky().unwrap();
            let filled = filled.solve(&DVector::from_element(out.len(), 1.0));
            let share = |i: usize| -> f64 {
                let terms = out.iter().zip(&filled);
                1.0 - terms.map(|(&j, x)| pseudo[(i, j)] * x).sum::<f64>()
            };
            let shares: Vec<f64> = inside.iter().map(|&i| share(i)).collect();
            let rates = restrict(&matrix, &inside).cholesky().unwrap();
            let rates = rates.solve(&DVector::from_element(inside.len(), 1.0));
            // The same sign as y2, in every gauge.
            let total = rates.sum();
            for (share, rate) in shares.iter().zip(&rates) {
                assert!((share / n as f64 - rate / total).abs() < 1e-10, "{share} {rate}");
            }
            let least = (0..inside.len()).min_by(|&a, &b| shares[a].total_cmp(&shares[b])).unwrap();
            // Others that lose pressure do so from a thousand times as much, and later.
            if shares[least] > -0.05 || made > 200 {
                continue;
            }
            let leaving = inside[least];
            let mut pressure = DVector::zeros(n);
            for &i in &inside {
                pressure[i] = if i == leaving { 1e-3 } else { 1.0 };
            }
            // Gaps out of contact that nothing closes before.
            let displacement = &matrix * &pressure;
            let gaps: Vec<f64> = (0..n)
                .map(|i| if holes >> i & 1 == 1 { 10.0 } else { 0.0 } - displacement[i])
                .collect();
            let first = gaps.iter().copied().fold(f64::INFINITY, f64::min);
            // In this gauge and from first touch, the pressure above is that at −first.
            let expected = -first - 1e-3 / rates[least];
            let path = kernel.path(&gaps);
            let found = path
                .map(Result::unwrap)
                .find(|state| kernel.own_approach(state) > -first * (1.0 + 1e-9));
            let found = found.unwrap();
            assert_eq!(found.event, ContactEvent::Release, "{found:?}");
            assert_eq!(found.node, kernel.grid.coordinates(leaving));
            let error = (kernel.own_approach(&found) - expected).abs();
            assert!(error < 1e-12 * (1.0 + expected), "{error:e}");
            made += 1;
        }
    }
    println!("{made} releases made");
    assert!(made >= 100, "{made}");
}

/// Five nodes in a row that see half of their neighbours: between two that carry the pressure of the middle one
/// stays as it is, `y₂ = (1, 0, 1)`, and it does not leave. The gap between two such nodes does not close.
#[test]
fn a_node_whose_pressure_stays_does_not_leave() {
    let grid = Grid::new(5, 1, 1.0, 1.0).unwrap();
    let coefficient = |di: isize, _| [1.0, 0.5, 0.0, 0.0, 0.0][di.unsigned_abs()];
    let growth = ContactGrowth::Unknown;
    let kernel = KernelTable::from_fn(grid, Boundary::Free, growth, coefficient).unwrap();
    let gaps = [0.1, 0.0, 0.2, 50.0, 5.0];
    let heights = HeightMap::new(DMatrix::from_fn(5, 1, |ix, _| -gaps[ix])).unwrap();
    let mut path = LoadingSolver::new(&heights, &kernel).unwrap();
    let states: Vec<_> = path.by_ref().map(Result::unwrap).collect();
    assert!(states.iter().all(|state| state.event == ContactEvent::Touch));
    let order: Vec<usize> = states.iter().map(|state| state.node.0).collect();
    assert_eq!(order, [1, 0, 2, 4]);
    assert_eq!(path.end(), Some(LoadingEnd::NoMoreEvents));
}
