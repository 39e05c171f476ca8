//! `Wᵀ C W` of a contact, by aggregates of cells: distant ones act as single nodes.

use std::ops::Range;

use super::bilinear::BilinearBasis;
use crate::kernel::KernelTable;
use crate::krylov::NodeSet;
use crate::krylov::tuning::{LANES, LARGE_SIDE, PARTS, SIDE, SMALL};
use crate::parallel::{for_each_chunk, vectorized};

/// Influence between aggregates of cells: exact between nodes of the same or of adjacent aggregates; an aggregate
/// farther off acts as its number of nodes in contact at the node next to their centre of gravity.
#[derive(Debug, Clone)]
pub(super) struct Aggregates {
    side: usize,
    /// Nodes and aggregates along x and y.
    shape: [usize; 2],
    counts: [usize; 2],
    wraps: [bool; 2],
    /// Influence coefficients relative to C(0, 0) as in the table of the kernel, each row followed by
    /// zeros for the length of an aggregate.
    coefficients: Vec<f32>,
    stride: usize,
}

/// The contact as aggregates see it.
struct Contact {
    /// One at the nodes in contact, else zero, up to the end of the last aggregate of each row.
    inside: Vec<f32>,
    lumps: Vec<Lump>,
}

/// An aggregate as seen from afar.
#[derive(Debug, Clone, Copy, Default)]
struct Lump {
    /// Where in the table its node is.
    place: usize,
    nodes: f32,
    hats: [u32; 4],
    weights: [f32; 4],
}

/// Influence between the hat functions of a contact by aggregates, in units of C(0, 0).
pub(super) struct CoarseInfluence {
    /// Column by column, a matrix of which `Wᵀ C W` is the sum with its transpose.
    pub(super) half: Vec<f64>,
    /// The sums of the columns of W. Not those of the nodes: means over hat functions must be of the same W.
    pub(super) masses: Vec<f64>,
}

impl Aggregates {
    pub(super) fn new(table: &KernelTable) -> Self {
        let (nx, ny) = table.grid().shape();
        let side = if nx * ny <= SMALL { SIDE } else { LARGE_SIDE };
        let stride = 2 * nx - 1 + side;
        let own = table.self_influence();
        let mut coefficients = vec![0.0; stride * (2 * ny - 1)];
        for (dj, row) in (1 - ny as isize..).zip(coefficients.chunks_exact_mut(stride)) {
            for (di, value) in (1 - nx as isize..nx as isize).zip(row) {
                *value = table.coefficient(di, dj).map_or(0.0, |c| (c / own) as f32);
            }
        }
        Self {
            side,
            shape: [nx, ny],
            counts: [nx.div_ceil(side), ny.div_ceil(side)],
            wraps: table.boundary().repeats(),
            coefficients,
            stride,
        }
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.coefficients[..])
    }

    /// The influence between all hat functions on a contact.
    pub(super) fn influence(&self, basis: &BilinearBasis, contact: &NodeSet) -> CoarseInfluence {
        let size = basis.len();
        let seen = self.see(basis, contact);
        let aggregates: Vec<usize> =
            (0..seen.lumps.len()).filter(|&aggregate| seen.lumps[aggregate].nodes > 0.0).collect();
        let mut parts = vec![0.0; PARTS * size * size];
        for_each_chunk(&mut parts, size * size, |part, half| {
            let mut displacements = vec![[0.0; LANES]; size];
            for aggregates in aggregates.chunks(LANES).skip(part).step_by(PARTS) {
                vectorized(
                    #[inline(always)]
                    || self.displacements(aggregates, &seen, &mut displacements),
                );
                for (lane, &aggregate) in aggregates.iter().enumerate() {
                    let lump = &seen.lumps[aggregate];
                    for (&hat, weight) in lump.hats.iter().zip(lump.weights) {
                        let column = &mut half[size * hat as usize..][..size];
                        for (sum, displacement) in column.iter_mut().zip(&displacements) {
                            *sum += f64::from(0.5 * weight * displacement[lane]);
                        }
                    }
                }
            }
        });
        let (half, rest) = parts.split_at_mut(size * size);
        for part in rest.chunks_exact(size * size) {
            for (sum, value) in half.iter_mut().zip(part) {
                *sum += value;
            }
        }
        parts.truncate(size * size);
        let mut masses = vec![0.0; size];
        for lump in &seen.lumps {
            for (&hat, weight) in lump.hats.iter().zip(lump.weights) {
                masses[hat as usize] += f64::from(weight * lump.nodes);
            }
        }
        CoarseInfluence { half: parts, masses }
    }

    /// The contact by aggregates.
    fn see(&self, basis: &BilinearBasis, contact: &NodeSet) -> Contact {
        let [nx, _] = self.shape;
        let mut inside = vec![0.0; self.counts[0] * self.side * self.shape[1]];
        let mut tallies = vec![[0_usize; 3]; self.counts[0] * self.counts[1]];
        for &node in contact.nodes() {
            let (ix, iy) = (node as usize % nx, node as usize / nx);
            inside[ix + self.counts[0] * self.side * iy] = 1.0;
            let tally = &mut tallies[ix / self.side + self.counts[0] * (iy / self.side)];
            for (sum, value) in tally.iter_mut().zip([1, ix, iy]) {
                *sum += value;
            }
        }
        let lump = |&[nodes, x, y]: &[usize; 3]| {
            if nodes == 0 {
                return Lump::default();
            }
            let [ix, iy] = [x, y].map(|sum| (sum + nodes / 2) / nodes);
            let at = basis.at(ix, iy);
            Lump {
                place: ix + self.stride * iy,
                nodes: nodes as f32,
                hats: at.map(|(hat, _)| hat as u32),
                weights: at.map(|(_, value)| value as f32),
            }
        };
        Contact { inside, lumps: tallies.iter().map(lump).collect() }
    }

    /// Displacements of up to `LANES` aggregates under unit pressure on each of the hat functions.
    #[inline(always)]
    fn displacements(&self, aggregates: &[usize], seen: &Contact, sums: &mut [[f32; LANES]]) {
        sums.fill([0.0; LANES]);
        let mut own = [Lump::default(); LANES];
        for (own, &aggregate) in own.iter_mut().zip(aggregates) {
            *own = seen.lumps[aggregate];
        }
        for lump in seen.lumps.iter().filter(|lump| lump.nodes > 0.0) {
            let values: [f32; LANES] = std::array::from_fn(|lane| self.between(&own[lane], lump));
            for (&hat, weight) in lump.hats.iter().zip(lump.weights) {
                for (sum, value) in sums[hat as usize].iter_mut().zip(values) {
                    *sum += weight * value;
                }
            }
        }
        for (lane, &aggregate) in aggregates.iter().enumerate() {
            for near in self.around(aggregate) {
                let lump = &seen.lumps[near];
                let exact = self.exact(aggregate, near, seen) - self.between(&own[lane], lump);
                for (&hat, weight) in lump.hats.iter().zip(lump.weights) {
                    sums[hat as usize][lane] += weight * exact;
                }
            }
        }
    }

    /// Influence between two aggregates seen from afar.
    #[inline(always)]
    fn between(&self, lump: &Lump, other: &Lump) -> f32 {
        lump.nodes * other.nodes * self.coefficients[self.center() + other.place - lump.place]
    }

    /// Influence between two aggregates, node by node.
    #[inline(always)]
    fn exact(&self, aggregate: usize, other: usize, seen: &Contact) -> f32 {
        let width = self.counts[0] * self.side;
        let ([columns, rows], [others, other_rows]) = (self.cells(aggregate), self.cells(other));
        let mut lanes = [0.0; LANES];
        for iy in rows {
            for ix in columns.clone() {
                if seen.inside[ix + width * iy] == 0.0 {
                    continue;
                }
                let start = self.center() - (ix + self.stride * iy) + others.start;
                for row in other_rows.clone() {
                    let inside = &seen.inside[others.start + width * row..][..self.side];
                    let influence = &self.coefficients[start + self.stride * row..][..self.side];
                    let inside = inside.as_chunks::<LANES>().0;
                    let influence = influence.as_chunks::<LANES>().0;
                    for (inside, influence) in inside.iter().zip(influence) {
                        for (lane, (a, b)) in lanes.iter_mut().zip(inside.iter().zip(influence)) {
                            *lane += a * b;
                        }
                    }
                }
            }
        }
        lanes.iter().sum()
    }

    /// Where offset (0, 0) is in the table.
    #[inline(always)]
    fn center(&self) -> usize {
        self.shape[0] - 1 + self.stride * (self.shape[1] - 1)
    }

    /// Indices along x and y of the nodes of an aggregate.
    fn cells(&self, aggregate: usize) -> [Range<usize>; 2] {
        let at = [aggregate % self.counts[0], aggregate / self.counts[0]];
        [0, 1].map(|axis| {
            let first = at[axis] * self.side;
            first..(first + self.side).min(self.shape[axis])
        })
    }

    /// An aggregate and those adjacent to it.
    fn around(&self, aggregate: usize) -> Vec<usize> {
        let near = |at: usize, axis: usize| {
            let count = self.counts[axis];
            let mut near: Vec<usize> = if self.wraps[axis] {
                [at + count - 1, at, at + 1].map(|i| i % count).to_vec()
            } else {
                (at.saturating_sub(1)..count.min(at + 2)).collect()
            };
            near.sort_unstable();
            near.dedup();
            near
        };
        let columns = near(aggregate % self.counts[0], 0);
        let rows = near(aggregate / self.counts[0], 1);
        let of_row = |row| columns.iter().map(move |column| column + self.counts[0] * row);
        rows.into_iter().flat_map(of_row).collect()
    }
}
