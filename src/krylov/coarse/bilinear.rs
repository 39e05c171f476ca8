//! Bilinear hat functions on blocks of cells.

use crate::krylov::NodeSet;
use crate::krylov::tuning::{CHUNK, ROWS};
use crate::parallel::for_each_chunk;

/// Hat functions with evenly spaced knots along both axes of a grid, `W` of the module. They sum to one
/// everywhere; at the edges of a grid that ends the outermost are constant.
#[derive(Debug, Clone)]
pub(super) struct BilinearBasis {
    along: [Axis; 2],
    /// Sums over each row of the grid by hat function along x.
    rows: Vec<f64>,
}

/// The hat functions along one axis.
#[derive(Debug, Clone)]
struct Axis {
    count: usize,
    /// For each index the two hat functions that are not zero there, and the value of the second.
    pairs: Vec<[u32; 2]>,
    parts: Vec<f64>,
}

impl Axis {
    fn new(nodes: usize, count: usize, wraps: bool) -> Self {
        let mut axis =
            Self { count, pairs: Vec::with_capacity(nodes), parts: Vec::with_capacity(nodes) };
        for index in 0..nodes {
            let knots = (index as f64 + 0.5) * count as f64 / nodes as f64 - 0.5;
            let (first, second, part) = if wraps {
                let below = knots.floor();
                let first = (below as isize).rem_euclid(count as isize) as usize;
                (first, (first + 1) % count, knots - below)
            } else {
                let knots = knots.clamp(0.0, (count - 1) as f64);
                let first = (knots as usize).min(count.saturating_sub(2));
                (first, (first + 1).min(count - 1), knots - first as f64)
            };
            axis.pairs.push([first as u32, second as u32]);
            axis.parts.push(part);
        }
        axis
    }
}

impl BilinearBasis {
    /// So many hat functions along x and y of a grid of the given shape, which wrap around where it repeats.
    pub(super) fn new(shape: (usize, usize), counts: (usize, usize), wraps: [bool; 2]) -> Self {
        Self {
            along: [Axis::new(shape.0, counts.0, wraps[0]), Axis::new(shape.1, counts.1, wraps[1])],
            rows: vec![0.0; counts.0 * shape.1],
        }
    }

    /// Number of hat functions.
    pub(super) fn len(&self) -> usize {
        self.along[0].count * self.along[1].count
    }

    /// The four hat functions that are not zero at a node, and their values there.
    pub(super) fn at(&self, ix: usize, iy: usize) -> [(usize, f64); 4] {
        let [x, y] = &self.along;
        let ([left, right], u) = (x.pairs[ix], x.parts[ix]);
        let ([lower, upper], v) = (y.pairs[iy], y.parts[iy]);
        let hat = |i: u32, j: u32| i as usize + x.count * j as usize;
        [
            (hat(left, lower), (1.0 - u) * (1.0 - v)),
            (hat(right, lower), u * (1.0 - v)),
            (hat(left, upper), (1.0 - u) * v),
            (hat(right, upper), u * v),
        ]
    }

    /// `Wᵀ r` for values at the nodes in contact.
    pub(super) fn restrict(&mut self, contact: &NodeSet, r: &[f64], sums: &mut Vec<f64>) {
        let [x, y] = &self.along;
        let (nx, nodes) = (x.pairs.len(), contact.nodes());
        for_each_chunk(&mut self.rows, ROWS * x.count, |chunk, rows| {
            rows.fill(0.0);
            let first = chunk * ROWS;
            let mut place = nodes.partition_point(|&node| (node as usize) < first * nx);
            for (i, row) in rows.chunks_exact_mut(x.count).enumerate() {
                let base = (first + i) * nx;
                // Of a run of nodes between the same two knots: all, and what the second hat function has.
                let (mut pair, mut all, mut second) = ([0; 2], 0.0, 0.0);
                while let Some(&node) = nodes.get(place)
                    && (node as usize) < base + nx
                {
                    let ix = node as usize - base;
                    if x.pairs[ix] != pair {
                        row[pair[0] as usize] += all - second;
                        row[pair[1] as usize] += second;
                        (pair, all, second) = (x.pairs[ix], 0.0, 0.0);
                    }
                    all += r[place];
                    second += x.parts[ix] * r[place];
                    place += 1;
                }
                row[pair[0] as usize] += all - second;
                row[pair[1] as usize] += second;
            }
        });
        sums.clear();
        sums.resize(x.count * y.count, 0.0);
        let rows = self.rows.chunks_exact(x.count);
        for ((row, pair), part) in rows.zip(&y.pairs).zip(&y.parts) {
            for (hat, weight) in pair.iter().zip([1.0 - part, *part]) {
                let sums = &mut sums[*hat as usize * x.count..][..x.count];
                for (sum, value) in sums.iter_mut().zip(row) {
                    *sum += weight * value;
                }
            }
        }
    }

    /// `z ← z + W m` at the nodes in contact.
    pub(super) fn spread(&self, contact: &NodeSet, m: &[f64], z: &mut [f64]) {
        let [x, y] = &self.along;
        let (nx, nodes) = (x.pairs.len(), contact.nodes());
        for_each_chunk(z, CHUNK, |chunk, z| {
            let mut line = vec![0.0; x.count];
            // The row that `line` is of.
            let mut row = 0..0;
            for (z, &node) in z.iter_mut().zip(&nodes[chunk * CHUNK..]) {
                let node = node as usize;
                if !row.contains(&node) {
                    let iy = node / nx;
                    row = iy * nx..(iy + 1) * nx;
                    let ([lower, upper], part) = (y.pairs[iy], y.parts[iy]);
                    let lower = &m[lower as usize * x.count..][..x.count];
                    let upper = &m[upper as usize * x.count..][..x.count];
                    for ((value, lower), upper) in line.iter_mut().zip(lower).zip(upper) {
                        *value = lower + part * (upper - lower);
                    }
                }
                let ix = node - row.start;
                let [left, right] = x.pairs[ix].map(|hat| line[hat as usize]);
                *z += left + x.parts[ix] * (right - left);
            }
        });
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.rows[..])
    }
}
