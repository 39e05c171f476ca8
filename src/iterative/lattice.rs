//! Nodes by level, coarse to fine, and where to look for the neighbours of each.
//!
//! The level of a node is how often both its indices halve. The nodes of level l and above form a
//! lattice with steps of 2ˡ cells; coarse levels come first, and within a level the order is that
//! of the node indices.

use crate::kernel::KernelTable;

/// Neighbours are looked for up to so many lattice steps along x and y.
const REACH: isize = 16;
/// Differences between two neighbours reach twice as far.
const SPAN: isize = 2 * REACH;
/// Distance of rows in the table of coefficients.
const WIDTH: isize = 2 * SPAN + 1;
/// Place of offset (0, 0) in it.
const CENTER: isize = SPAN + SPAN * WIDTH;

/// One lattice.
#[derive(Debug, Clone)]
pub(super) struct Lattice {
    /// Offsets in lattice steps at which an earlier node may be, those of the greatest influence
    /// first, by the parity of both lattice indices.
    candidates: [Vec<[i16; 2]>; 4],
    /// Influence coefficients relative to C(0, 0), WIDTH × WIDTH.
    coefficients: Vec<f32>,
}

/// The lattices of a grid, finest first.
#[derive(Debug, Clone)]
pub(super) struct Lattices {
    shape: [usize; 2],
    levels: Vec<Lattice>,
}

/// A neighbour found: its node index, and its place in the table of coefficients.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Neighbour {
    pub(super) node: u32,
    pub(super) offset: i32,
}

impl Lattices {
    pub(super) fn new(table: &KernelTable) -> Self {
        let (nx, ny) = table.grid().shape();
        let mut last = 0;
        while (nx.max(ny) >> last) > REACH as usize {
            last += 1;
        }
        Self {
            shape: [nx, ny],
            levels: (0..=last)
                .map(|level| Lattice::new(table, level, level == last))
                .collect(),
        }
    }

    /// Collects the earlier nodes with the greatest influence on `node`, as many as `neighbours`
    /// has room for, among those for which `is_in` holds. Returns how many there are, and the
    /// lattice on which they were found.
    pub(super) fn earlier(
        &self,
        node: usize,
        is_in: impl Fn(usize) -> bool,
        neighbours: &mut [Neighbour],
    ) -> (usize, &Lattice) {
        let [nx, ny] = self.shape;
        let (ix, iy) = (node % nx, node / nx);
        let level = (ix | iy).trailing_zeros().min(self.levels.len() as u32 - 1);
        let lattice = &self.levels[level as usize];
        let (a, b) = ((ix >> level) as isize, (iy >> level) as isize);
        let class = (a & 1) | ((b & 1) << 1);
        // Lattice indices within the grid.
        let ends = [((nx - 1) >> level) as isize, ((ny - 1) >> level) as isize];
        let mut count = 0;
        for &[da, db] in &lattice.candidates[class as usize] {
            let (da, db) = (da as isize, db as isize);
            let (x, y) = (a + da, b + db);
            if x < 0 || y < 0 || x > ends[0] || y > ends[1] {
                continue;
            }
            let other = ((x as usize) << level) + nx * ((y as usize) << level);
            if is_in(other) {
                neighbours[count] = Neighbour {
                    node: other as u32,
                    offset: (da + db * WIDTH) as i32,
                };
                count += 1;
                if count == neighbours.len() {
                    break;
                }
            }
        }
        (count, lattice)
    }
}

impl Lattice {
    fn new(table: &KernelTable, level: u32, is_last: bool) -> Self {
        let own = table.self_influence();
        let mut coefficients = Vec::with_capacity((WIDTH * WIDTH) as usize);
        for dj in -SPAN..=SPAN {
            for di in -SPAN..=SPAN {
                // Offsets beyond the grid are never asked for.
                let value = table.coefficient(di << level, dj << level).unwrap_or(0.0);
                coefficients.push((value / own) as f32);
            }
        }
        let mut offsets = Vec::new();
        for db in -REACH..=REACH {
            for da in -REACH..=REACH {
                if let Some(value) = table.coefficient(da << level, db << level) {
                    offsets.push((value, da, db));
                }
            }
        }
        offsets.sort_by(|x, y| y.0.total_cmp(&x.0).then((x.2, x.1).cmp(&(y.2, y.1))));
        let candidates = std::array::from_fn(|class| {
            let (a, b) = (class as isize & 1, class as isize >> 1);
            let is_earlier = |da: isize, db: isize| {
                let coarser = !is_last && ((a + da) | (b + db)) & 1 == 0;
                coarser || db < 0 || (db == 0 && da < 0)
            };
            offsets
                .iter()
                .filter(|&&(_, da, db)| is_earlier(da, db))
                .map(|&(_, da, db)| [da as i16, db as i16])
                .collect()
        });
        Self {
            candidates,
            coefficients,
        }
    }

    /// Influence coefficient between two offsets from the same node, relative to C(0, 0).
    #[inline(always)]
    pub(super) fn between(&self, offset: i32, other: i32) -> f32 {
        self.coefficients[(CENTER as i32 + offset - other) as usize]
    }
}
