//! `Wᵀ C W` of a contact, from patches that see distant patches as single nodes.

use std::ops::Range;

use super::hats::Hats;
use crate::Boundary;
use crate::kernel::KernelTable;
use crate::krylov::NodeSet;
use crate::parallel::{for_each_chunk, vectorized};

/// Patches that are summed over at the same time, and values of a row that are.
const LANES: usize = 8;
/// Cells of a patch a side, on grids of at most `SMALL` nodes and on larger ones: sums over pairs of
/// nodes and over pairs of patches take about as long.
const SIDE: usize = LANES;
const LARGE_SIDE: usize = 2 * LANES;
const SMALL: usize = 1 << 19;
/// Sums over patches that threads work on at the same time.
const PARTS: usize = 8;

/// Influence between patches of cells: exact between nodes of the same or of adjacent patches; a patch
/// farther off acts as its number of nodes in contact at the node next to their centre of gravity.
#[derive(Debug, Clone)]
pub(super) struct Patches {
    side: usize,
    /// Nodes and patches along x and y.
    shape: [usize; 2],
    counts: [usize; 2],
    wraps: bool,
    /// Influence coefficients relative to C(0, 0) as in the table of the kernel, each row followed by
    /// zeros for the length of a patch.
    coefficients: Vec<f32>,
    stride: usize,
}

/// The contact as patches see it.
struct Contact {
    /// One at the nodes in contact, else zero, up to the end of the last patch of each row.
    inside: Vec<f32>,
    lumps: Vec<Lump>,
}

/// A patch as seen from afar.
#[derive(Debug, Clone, Copy, Default)]
struct Lump {
    /// Where in the table its node is.
    place: usize,
    nodes: f32,
    hats: [u32; 4],
    weights: [f32; 4],
}

/// What patches make of the hats of a contact, in units of C(0, 0).
pub(super) struct HatInfluence {
    /// Column by column, a matrix of which `Wᵀ C W` is the sum with its transpose.
    pub(super) half: Vec<f64>,
    /// The sums of the columns of W. Not those of the nodes: means over hats must be of the same W.
    pub(super) masses: Vec<f64>,
}

impl Patches {
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
            wraps: table.boundary() == Boundary::Periodic,
            coefficients,
            stride,
        }
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.coefficients[..])
    }

    /// The influence between all hats on a contact.
    pub(super) fn influence(&self, hats: &Hats, contact: &NodeSet) -> HatInfluence {
        let size = hats.len();
        let seen = self.see(hats, contact);
        let patches: Vec<usize> =
            (0..seen.lumps.len()).filter(|&patch| seen.lumps[patch].nodes > 0.0).collect();
        let mut parts = vec![0.0; PARTS * size * size];
        for_each_chunk(&mut parts, size * size, |part, half| {
            let mut displacements = vec![[0.0; LANES]; size];
            for patches in patches.chunks(LANES).skip(part).step_by(PARTS) {
                vectorized(
                    #[inline(always)]
                    || self.displacements(patches, &seen, &mut displacements),
                );
                for (lane, &patch) in patches.iter().enumerate() {
                    let lump = &seen.lumps[patch];
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
        HatInfluence { half: parts, masses }
    }

    /// The contact by patches.
    fn see(&self, hats: &Hats, contact: &NodeSet) -> Contact {
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
            let at = hats.at(ix, iy);
            Lump {
                place: ix + self.stride * iy,
                nodes: nodes as f32,
                hats: at.map(|(hat, _)| hat as u32),
                weights: at.map(|(_, value)| value as f32),
            }
        };
        Contact { inside, lumps: tallies.iter().map(lump).collect() }
    }

    /// Displacements of up to `LANES` patches under unit pressure on each of the hats.
    #[inline(always)]
    fn displacements(&self, patches: &[usize], seen: &Contact, sums: &mut [[f32; LANES]]) {
        sums.fill([0.0; LANES]);
        let mut own = [Lump::default(); LANES];
        for (own, &patch) in own.iter_mut().zip(patches) {
            *own = seen.lumps[patch];
        }
        for lump in seen.lumps.iter().filter(|lump| lump.nodes > 0.0) {
            let values: [f32; LANES] = std::array::from_fn(|lane| self.between(&own[lane], lump));
            for (&hat, weight) in lump.hats.iter().zip(lump.weights) {
                for (sum, value) in sums[hat as usize].iter_mut().zip(values) {
                    *sum += weight * value;
                }
            }
        }
        for (lane, &patch) in patches.iter().enumerate() {
            for near in self.around(patch) {
                let lump = &seen.lumps[near];
                let exact = self.exact(patch, near, seen) - self.between(&own[lane], lump);
                for (&hat, weight) in lump.hats.iter().zip(lump.weights) {
                    sums[hat as usize][lane] += weight * exact;
                }
            }
        }
    }

    /// Influence between two patches seen from afar.
    #[inline(always)]
    fn between(&self, lump: &Lump, other: &Lump) -> f32 {
        lump.nodes * other.nodes * self.coefficients[self.center() + other.place - lump.place]
    }

    /// Influence between two patches, node by node.
    #[inline(always)]
    fn exact(&self, patch: usize, other: usize, seen: &Contact) -> f32 {
        let width = self.counts[0] * self.side;
        let ([columns, rows], [others, other_rows]) = (self.cells(patch), self.cells(other));
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

    /// Indices along x and y of the nodes of a patch.
    fn cells(&self, patch: usize) -> [Range<usize>; 2] {
        let at = [patch % self.counts[0], patch / self.counts[0]];
        [0, 1].map(|axis| {
            let first = at[axis] * self.side;
            first..(first + self.side).min(self.shape[axis])
        })
    }

    /// A patch and those adjacent to it.
    fn around(&self, patch: usize) -> Vec<usize> {
        let near = |at: usize, count: usize| {
            let mut near: Vec<usize> = if self.wraps {
                [at + count - 1, at, at + 1].map(|i| i % count).to_vec()
            } else {
                (at.saturating_sub(1)..count.min(at + 2)).collect()
            };
            near.sort_unstable();
            near.dedup();
            near
        };
        let columns = near(patch % self.counts[0], self.counts[0]);
        let rows = near(patch / self.counts[0], self.counts[1]);
        let of_row = |row| columns.iter().map(move |column| column + self.counts[0] * row);
        rows.into_iter().flat_map(of_row).collect()
    }
}
