//! Gaps over 8, 10 and 12 decades in no order, conductances over three times as many: leak rates against a dense
//! elimination.

use asperity::surface::Axis;
use asperity::{Boundary, Grid};
use nalgebra::DMatrix;

use super::{BOUNDARIES, assert_conserved, leak};

/// How the gaps lie.
#[derive(Debug, Clone, Copy)]
enum Map {
    /// Each node by itself.
    Scattered,
    /// The same with three of ten nodes closed: next to percolation.
    Sieve,
    /// Squares of 5 by 5 nodes.
    Squares,
    /// Wide places and throats, and nothing between.
    Lakes,
}

/// Number `k` of a series of random ones between 0 and 1 (SplitMix64).
fn uniform(series: u64, k: usize) -> f64 {
    let mut z = (series << 32).wrapping_add(k as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

/// A gap map, 0 where it is closed.
fn gaps(map: Map, decades: f64, (nx, ny): (usize, usize), seed: u64) -> DMatrix<f64> {
    let some = |first: u64| DMatrix::from_fn(nx, ny, |ix, iy| uniform(first, ix + nx * iy));
    let (uniform, holes) = (some(2 * seed), some(2 * seed + 1));
    DMatrix::from_fn(nx, ny, |ix, iy| {
        let exponent = match map {
            Map::Scattered => uniform[(ix, iy)],
            Map::Sieve if holes[(ix, iy)] < 0.3 => return 0.0,
            Map::Sieve => uniform[(ix, iy)],
            Map::Squares => uniform[(ix / 5 * 5, iy / 5 * 5)],
            Map::Lakes => f64::from(u8::from(uniform[(ix, iy)] < 0.4)),
        };
        // A gap of 10⁻¹² of the greatest is the least that counts as one.
        10_f64.powf(-0.999 * decades * exponent)
    })
}

/// What flows along x under a pressure drop of 1 through gaps that conduct their cubes, from one cell to the next half
/// a cell of either in series. Nodes are eliminated in the order of their indices: a node at which conductances to
/// others have the sum d joins two of them by their product over d. All numbers are positive, so that the result is
/// right to the rounding of sums, some 10⁻¹⁶ for each node at worst.
fn dense(gap: &DMatrix<f64>, grid: &Grid, boundary: Boundary) -> f64 {
    let (nx, ny) = gap.shape();
    let n = nx * ny;
    let shape = grid.dy() / grid.dx();
    let half = |ix: usize, iy: usize| 2.0 * gap[(ix, iy)].powi(3);
    let mut joined = DMatrix::<f64>::zeros(n + 2, n + 2);
    let mut join = |a: usize, b: usize, conductance: f64| {
        joined[(a, b)] += conductance;
        joined[(b, a)] += conductance;
    };
    let series = |a: f64, b: f64| if a > 0.0 && b > 0.0 { 1.0 / (1.0 / a + 1.0 / b) } else { 0.0 };
    for iy in 0..ny {
        join(n, iy * nx, half(0, iy) * shape);
        join(n + 1, iy * nx + nx - 1, half(nx - 1, iy) * shape);
        for ix in 0..nx {
            let node = iy * nx + ix;
            if ix + 1 < nx {
                join(node, node + 1, series(half(ix, iy), half(ix + 1, iy)) * shape);
            }
            if iy + 1 < ny {
                join(node, node + nx, series(half(ix, iy), half(ix, iy + 1)) / shape);
            } else if boundary == Boundary::Periodic {
                join(node, ix, series(half(ix, iy), half(ix, 0)) / shape);
            }
        }
    }
    for node in 0..n {
        let sum: f64 = (node + 1..n + 2).map(|other| joined[(other, node)]).sum();
        for to in node + 1..n + 2 {
            let share = joined[(to, node)] / sum;
            if share > 0.0 {
                for from in (node + 1..n + 2).filter(|&from| from != to) {
                    joined[(from, to)] += joined[(from, node)] * share;
                }
            }
        }
    }
    joined[(n, n + 1)]
}

/// To 10⁻¹² of itself: some 400 nodes, each of which rounds twice.
#[test]
fn leaks_through_any_contrast_are_those_of_a_dense_elimination() {
    let mut leaking = 0;
    for map in [Map::Scattered, Map::Sieve, Map::Squares, Map::Lakes] {
        for decades in [8.0, 10.0, 12.0] {
            for seed in 0..4 {
                for (boundary, side) in BOUNDARIES.into_iter().zip([1.0, 30.0]) {
                    let grid = Grid::new(22, 17, side, 1.0).unwrap();
                    let gap = gaps(map, decades, grid.shape(), seed);
                    let found = leak(&gap, &grid, boundary, Axis::X).unwrap();
                    let expected = dense(&gap, &grid, boundary);
                    if expected == 0.0 {
                        assert!(found.is_closed());
                        continue;
                    }
                    leaking += 1;
                    let error = found.leak_rate / expected - 1.0;
                    assert!(error.abs() < 1e-12, "{map:?}, {decades}, {seed}: {error:e}");
                    assert!(found.imbalance < 1e-12, "{:e}", found.imbalance);
                    assert_conserved(&found);
                }
            }
        }
    }
    assert!(leaking > 80, "{leaking}");
}

/// On larger grids nothing is lost on the way: of the flow through each of up to 64² nodes some 10⁻¹⁶.
#[test]
fn nothing_is_lost_at_any_contrast() {
    for map in [Map::Scattered, Map::Sieve, Map::Squares, Map::Lakes] {
        for decades in [8.0, 10.0, 12.0] {
            for (seed, nodes) in (0..).zip([(16, 16), (33, 20), (64, 64), (200, 9)]) {
                for boundary in BOUNDARIES {
                    let grid = Grid::new(nodes.0, nodes.1, 1.0, 1.0).unwrap();
                    let gap = gaps(map, decades, nodes, seed);
                    let found = leak(&gap, &grid, boundary, Axis::X).unwrap();
                    assert!(found.imbalance < 1e-12, "{map:?}, {decades}: {:e}", found.imbalance);
                    if !found.is_closed() {
                        assert_conserved(&found);
                    }
                }
            }
        }
    }
}
