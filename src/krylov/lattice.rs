//! Nodes by level, coarse to fine, and where to look for the neighbours of each.
//!
//! The level of a node is how often both its indices halve. The nodes of level l and above form a
//! lattice with steps of 2ˡ cells; coarse levels come first, and within a level the order is that
//! of the node indices. On a periodic grid a lattice goes on beyond the edge wherever its steps fit
//! the period.

use super::tuning::REACH;
use crate::kernel::KernelTable;

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
    /// Whether the lattice is periodic along x and along y.
    wraps: [bool; 2],
    /// If it is, all offsets to other nodes of it, those of the greatest influence first; each node once, however small
    /// the lattice.
    around: Vec<[i16; 2]>,
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
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
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
            levels: (0..=last).map(|level| Lattice::new(table, level, level == last)).collect(),
        }
    }

    /// Collects the earlier nodes with the greatest influence on `node`, as many as `neighbours`
    /// has room for, among those for which `is_in` holds. Returns how many there are, and the
    /// level of the lattice on which they were found.
    pub(super) fn earlier(
        &self,
        node: usize,
        is_in: impl Fn(usize) -> bool,
        neighbours: &mut [Neighbour],
    ) -> (usize, u32) {
        let [nx, ny] = self.shape;
        let (ix, iy) = (node % nx, node / nx);
        let level = (ix | iy).trailing_zeros().min(self.levels.len() as u32 - 1);
        let lattice = &self.levels[level as usize];
        let (a, b) = ((ix >> level) as isize, (iy >> level) as isize);
        let class = (a & 1) | ((b & 1) << 1);
        // Lattice indices within the grid.
        let ends = [((nx - 1) >> level) as isize, ((ny - 1) >> level) as isize];
        let reaches_over = |at: isize, end: isize| at < REACH || at + REACH > end;
        let [x_wraps, y_wraps] = lattice.wraps;
        if (x_wraps && reaches_over(a, ends[0])) || (y_wraps && reaches_over(b, ends[1])) {
            let found = self.earlier_around(node, level, is_in, neighbours);
            return (found, level);
        }
        let mut count = 0;
        for &[da, db] in &lattice.candidates[class as usize] {
            let (da, db) = (da as isize, db as isize);
            let (x, y) = (a + da, b + db);
            if x < 0 || y < 0 || x > ends[0] || y > ends[1] {
                continue;
            }
            let other = ((x as usize) << level) + nx * ((y as usize) << level);
            if is_in(other) {
                neighbours[count] =
                    Neighbour { node: other as u32, offset: (da + db * WIDTH) as i32 };
                count += 1;
                if count == neighbours.len() {
                    break;
                }
            }
        }
        (count, level)
    }

    /// The lattice of a level.
    pub(super) fn level(&self, level: u32) -> &Lattice {
        &self.levels[level as usize]
    }

    /// [`Self::earlier`] on a periodic lattice of level `level`, beyond the edges too: what is earlier
    /// there depends on the nodes themselves and not on their offset.
    fn earlier_around(
        &self,
        node: usize,
        level: u32,
        is_in: impl Fn(usize) -> bool,
        neighbours: &mut [Neighbour],
    ) -> usize {
        let [nx, ny] = self.shape;
        let (ix, iy) = (node % nx, node / nx);
        let last = self.levels.len() as u32 - 1;
        let lattice = &self.levels[level as usize];
        let mut count = 0;
        for &[da, db] in &lattice.around {
            let (da, db) = (da as isize, db as isize);
            let places = (lattice.to(0, ix, da << level, nx), lattice.to(1, iy, db << level, ny));
            let (Some(x), Some(y)) = places else {
                continue;
            };
            let other = x + nx * y;
            let coarser = (x | y).trailing_zeros().min(last) > level;
            if (coarser || other < node) && is_in(other) {
                neighbours[count] =
                    Neighbour { node: other as u32, offset: (da + db * WIDTH) as i32 };
                count += 1;
                if count == neighbours.len() {
                    break;
                }
            }
        }
        count
    }

    /// Calls `found` with nodes that may have `node` for a neighbour, and with the size of its influence on them
    /// relative to C(0, 0): all that could find it, and some that come before it.
    pub(super) fn later(&self, node: usize, mut found: impl FnMut(usize, f32)) {
        let [nx, ny] = self.shape;
        let (ix, iy) = (node % nx, node / nx);
        let last = self.levels.len() as u32 - 1;
        let own = (ix | iy).trailing_zeros().min(last);
        for (level, lattice) in (0..=own).zip(&self.levels) {
            for db in -REACH..=REACH {
                let Some(y) = lattice.to(1, iy, db << level, ny) else { continue };
                for da in -REACH..=REACH {
                    let Some(x) = lattice.to(0, ix, da << level, nx) else { continue };
                    if (x | y).trailing_zeros().min(last) == level && (da, db) != (0, 0) {
                        let offset = (da + db * WIDTH) as i32;
                        found(x + nx * y, lattice.between(offset, 0).abs());
                    }
                }
            }
        }
    }
}

impl Lattice {
    fn new(table: &KernelTable, level: u32, is_last: bool) -> Self {
        let own = table.self_influence();
        let (nx, ny) = table.grid().shape();
        let step = 1_usize << level;
        let [x_repeats, y_repeats] = table.boundary().repeats();
        // Where both repeat, along both or along none.
        let fits = |repeats: bool, nodes: usize| !repeats || nodes.is_multiple_of(step);
        let fit = fits(x_repeats, nx) && fits(y_repeats, ny);
        let wraps = [x_repeats && fit, y_repeats && fit];
        // In cells, beyond the grid in its next period if there is one.
        let cells = |steps: isize, nodes: usize, wraps: bool| {
            let cells = steps << level;
            if wraps { cells % nodes as isize } else { cells }
        };
        let coefficient =
            |di, dj| table.coefficient(cells(di, nx, wraps[0]), cells(dj, ny, wraps[1]));
        let mut coefficients = Vec::with_capacity((WIDTH * WIDTH) as usize);
        for dj in -SPAN..=SPAN {
            for di in -SPAN..=SPAN {
                // Offsets beyond a grid that ends are never asked for.
                let value = coefficient(di, dj).unwrap_or(0.0);
                coefficients.push((value / own) as f32);
            }
        }
        let mut offsets = Vec::new();
        for db in -REACH..=REACH {
            for da in -REACH..=REACH {
                if let Some(value) = coefficient(da, db) {
                    // A layer that cannot be compressed rises beside a pressure: that is influence too.
                    offsets.push((value.abs(), da, db));
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
        // Half a period each way, of which the far end counts once; the node itself is not another.
        let half = |steps: isize, nodes: usize, wraps: bool| {
            let period = (nodes / step) as isize;
            !wraps || (-period < 2 * steps && 2 * steps <= period)
        };
        let is_other = |da: isize, db: isize| {
            (da, db) != (0, 0) && half(da, nx, wraps[0]) && half(db, ny, wraps[1])
        };
        let around = offsets
            .iter()
            .filter(|&&(_, da, db)| wraps != [false; 2] && is_other(da, db))
            .map(|&(_, da, db)| [da as i16, db as i16])
            .collect();
        Self { candidates, wraps, around, coefficients }
    }

    /// The index so many cells further along an axis of so many nodes.
    fn to(&self, axis: usize, at: usize, cells: isize, nodes: usize) -> Option<usize> {
        let to = at as isize + cells;
        let to = if self.wraps[axis] { to.rem_euclid(nodes as isize) } else { to };
        (0..nodes as isize).contains(&to).then_some(to as usize)
    }

    /// Influence coefficient between two offsets from the same node, relative to C(0, 0).
    #[inline(always)]
    pub(super) fn between(&self, offset: i32, other: i32) -> f32 {
        self.coefficients[(CENTER as i32 + offset - other) as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Error, Grid, PeriodicBoussinesq};

    /// Every neighbour is another node, once, and earlier in one order of all nodes; and its place in
    /// the table of coefficients is that of its influence, across the edges too.
    #[test]
    fn neighbours_on_a_periodic_grid() -> Result<(), Error> {
        for (nx, ny) in [(64, 48), (40, 24), (33, 20), (16, 16), (50, 1), (2, 3)] {
            let grid = Grid::new(nx, ny, 1.0, 1.5)?;
            let table = KernelTable::new(&PeriodicBoussinesq::new(grid, 1.0)?)?;
            let lattices = Lattices::new(&table);
            let last = lattices.levels.len() as u32 - 1;
            let order = |node: usize| {
                let level = ((node % nx) | (node / nx)).trailing_zeros().min(last);
                (last - level, node)
            };
            for node in 0..grid.nodes() {
                let mut found = [Neighbour::default(); 8];
                let (count, level) = lattices.earlier(node, |_| true, &mut found);
                let lattice = lattices.level(level);
                let mut seen = vec![node];
                for neighbour in &found[..count] {
                    let other = neighbour.node as usize;
                    assert!(order(other) < order(node), "{other} and {node}");
                    assert!(!seen.contains(&other), "{other} twice");
                    seen.push(other);
                    let influence = table.between(table.place(other), table.place(node));
                    let expected = (influence / table.self_influence()) as f32;
                    let stored = lattice.between(neighbour.offset, 0);
                    // The same coefficient, from one period or the next.
                    assert!((stored - expected).abs() <= 1e-6, "{stored} and {expected}");
                }
            }
        }
        Ok(())
    }

    /// The corner next to all others across both edges sees them.
    #[test]
    fn edges_are_no_edges() -> Result<(), Error> {
        let grid = Grid::square(64, 1.0)?;
        let table = KernelTable::new(&PeriodicBoussinesq::new(grid, 1.0)?)?;
        let lattices = Lattices::new(&table);
        let mut found = [Neighbour::default(); 8];
        let (count, _) = lattices.earlier(63 + 64 * 63, |_| true, &mut found);
        let nodes: Vec<usize> = found[..count].iter().map(|n| n.node as usize).collect();
        // All eight around it are earlier: it is the last of the finest level.
        for (x, y) in [(62, 62), (63, 62), (0, 62), (62, 63), (0, 63), (62, 0), (63, 0), (0, 0)] {
            assert!(nodes.contains(&(x + 64 * y)), "({x}, {y}) in {nodes:?}");
        }
        Ok(())
    }
}
