//! The same kernel on a grid of half as many nodes a side.

use super::KernelTable;
use crate::kernel::KernelOrigin;
use crate::{Boundary, ContactGrowth, Error, Grid};

/// Blocks of 2 × 2 nodes of a grid, each a node of a coarser grid. A direction with a single node
/// stays as it is.
///
/// Where the number of nodes is odd, the last block of a free grid reaches beyond its edge; those of
/// a periodic one are a little smaller than two cells, so that they fit the period.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Blocks {
    fine: Grid,
    coarse: Grid,
    boundary: Boundary,
}

impl Blocks {
    /// # Errors
    ///
    /// Those of [`Grid::new`].
    pub(crate) fn new(fine: Grid, boundary: Boundary) -> Result<Self, Error> {
        let (nx, ny) = fine.shape();
        let [cx, cy] = [nx, ny].map(|nodes| nodes.div_ceil(2));
        let [x_repeats, y_repeats] = boundary.repeats();
        let along = |cell: f64, nodes: usize, blocks: usize, repeats: bool| {
            if repeats {
                cell * nodes as f64 / blocks as f64
            } else {
                cell * Self::cells(nodes) as f64
            }
        };
        let (dx, dy) = (along(fine.dx(), nx, cx, x_repeats), along(fine.dy(), ny, cy, y_repeats));
        let coarse = Grid::new(cx, cy, dx, dy)?;
        Ok(Self { fine, coarse, boundary })
    }

    /// Cells of a free grid that make the side of a block, along a direction of so many nodes.
    fn cells(nodes: usize) -> usize {
        nodes.min(2)
    }

    /// The grid of blocks.
    pub(crate) fn grid(&self) -> Grid {
        self.coarse
    }

    /// The block in which a node lies.
    fn of(&self, node: usize) -> usize {
        let (ix, iy) = self.fine.coordinates(node);
        let [x_repeats, y_repeats] = self.boundary.repeats();
        let along = |i: usize, fine: usize, coarse: usize, repeats: bool| {
            // Blocks share the period equally.
            if repeats { (2 * i + 1) * coarse / (2 * fine) } else { i / Self::cells(fine) }
        };
        self.coarse.index(
            along(ix, self.fine.nx(), self.coarse.nx(), x_repeats),
            along(iy, self.fine.ny(), self.coarse.ny(), y_repeats),
        )
    }

    /// Averages over blocks.
    pub(crate) fn restrict(&self, values: &[f64]) -> Vec<f64> {
        let mut sums = vec![(0.0, 0_u32); self.coarse.nodes()];
        for (node, value) in values.iter().enumerate() {
            let (sum, count) = &mut sums[self.of(node)];
            *sum += value;
            *count += 1;
        }
        sums.into_iter().map(|(sum, count)| sum / f64::from(count.max(1))).collect()
    }

    /// The same value on all nodes of a block.
    pub(crate) fn prolong(&self, values: &[f64], result: &mut [f64]) {
        for (node, value) in result.iter_mut().enumerate() {
            *value = values[self.of(node)];
        }
    }
}

impl KernelTable {
    /// The coefficients between blocks under a common pressure, displacements averaged over a block:
    /// exactly what remains of this kernel for pressures that are uniform on blocks.
    ///
    /// Beyond the edge of a free grid the kernel is continued by its last value; cells that lie in two
    /// blocks of a periodic grid are weighted by how much of them lies in each.
    ///
    /// # Errors
    ///
    /// Those of [`Grid::new`].
    pub(crate) fn coarsened(&self) -> Result<(Self, Blocks), Error> {
        let blocks = Blocks::new(self.grid, self.boundary)?;
        let grid = blocks.grid();
        let (nx, ny) = self.grid.shape();
        let (cx, cy) = (grid.nx() as isize, grid.ny() as isize);
        let [x_repeats, y_repeats] = self.boundary.repeats();
        let (along_x, along_y) =
            (Overlaps::new(nx, grid.nx(), x_repeats), Overlaps::new(ny, grid.ny(), y_repeats));
        let width = 2 * nx as isize - 1;
        let mut values = Vec::with_capacity(((2 * cx - 1) * (2 * cy - 1)) as usize);
        for dj in 1 - cy..cy {
            for di in 1 - cx..cx {
                let mut sum = 0.0;
                for &(j, wj) in along_y.of(dj) {
                    let row = self.center() as isize + j * width;
                    for &(i, wi) in along_x.of(di) {
                        sum += wi * wj * self.values[(row + i) as usize];
                    }
                }
                values.push(sum);
            }
        }
        Ok((self.on_blocks(grid, values), blocks))
    }

    /// Properties of the body do not change with the grid, except for the promise of growth,
    /// which was made for the nodes of the fine one.
    fn on_blocks(&self, grid: Grid, values: Vec<f64>) -> Self {
        Self {
            grid,
            boundary: self.boundary,
            growth: ContactGrowth::Unknown,
            mean: self.mean,
            origin: KernelOrigin::Other,
            values,
        }
    }
}

/// For each offset of blocks along a direction the offsets of cells, and their weights: sums over the sources, averages
/// over the observers.
struct Overlaps {
    /// From minus the number of blocks, without it, to that number.
    offsets: Vec<Vec<(isize, f64)>>,
    blocks: isize,
}

impl Overlaps {
    fn new(nodes: usize, blocks: usize, repeats: bool) -> Self {
        let count = blocks as isize;
        let all = 1 - count..count;
        let offsets = if repeats {
            all.map(|offset| Self::on_a_period(nodes, blocks, offset)).collect()
        } else {
            all.map(|offset| Self::between_ends(nodes as isize, offset)).collect()
        };
        Self { offsets, blocks: count }
    }

    fn of(&self, offset: isize) -> &[(isize, f64)] {
        &self.offsets[(offset + self.blocks - 1) as usize]
    }

    fn on_a_period(nodes: usize, blocks: usize, offset: isize) -> Vec<(isize, f64)> {
        let width = nodes as f64 / blocks as f64;
        // Opposite offsets have opposite cells, to the last bit.
        let at = offset.unsigned_abs() as f64 * width;
        let first = at as isize - 1;
        let weight = |cell: isize| (1.0 - (cell as f64 - at).abs() / width).max(0.0);
        let sum: f64 = (first..first + 4).map(weight).sum();
        let cells = (first..first + 4).map(|cell| {
            let place = offset.signum() * cell.rem_euclid(nodes as isize);
            (if offset == 0 { cell } else { place }, weight(cell) * width / sum)
        });
        cells.filter(|(_, weight)| *weight > 0.0).collect()
    }

    fn between_ends(nodes: isize, offset: isize) -> Vec<(isize, f64)> {
        // Differences between the places of two cells within their blocks, and how often each occurs.
        let differences: &[(isize, f64)] =
            if nodes > 1 { &[(-1, 0.5), (0, 1.0), (1, 0.5)] } else { &[(0, 1.0)] };
        let factor = nodes.min(2);
        let place = |difference: isize| (offset * factor + difference).clamp(1 - nodes, nodes - 1);
        differences.iter().map(|&(difference, weight)| (place(difference), weight)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::{Boussinesq, PeriodicBoussinesq, Spectral};

    /// The average over the nodes of one block of the displacement by unit pressure on another.
    #[test]
    fn periodic_blocks_are_averages() -> Result<(), Error> {
        let grid = Grid::new(8, 6, 1.0, 1.5)?;
        let fine = KernelTable::new(&PeriodicBoussinesq::new(grid, 1.0)?)?;
        let (coarse, _) = fine.coarsened()?;
        assert_eq!(coarse.grid(), Grid::new(4, 3, 2.0, 3.0)?);
        for (di, dj) in (0..7 * 5).map(|i| (i % 7 - 3, i / 7 - 2)) {
            let mut sum = 0.0;
            for i in 0..16 {
                let (ax, ay, bx, by) = (i % 2, i / 2 % 2, i / 4 % 2, i / 8);
                let (x, y) = (2 * di + ax - bx, 2 * dj + ay - by);
                sum += fine.coefficient(x % 8, y % 6).unwrap_or(f64::NAN);
            }
            let found = coarse.coefficient(di, dj).unwrap_or(f64::NAN);
            // 16 terms near 1.
            assert!((found - sum / 4.0).abs() < 1e-14, "{found} {sum}");
        }
        Ok(())
    }

    /// The same on a free half-space, and on a strip, whose blocks are two cells.
    #[test]
    fn free_blocks_are_averages() -> Result<(), Error> {
        for (nx, ny) in [(8, 6), (8, 1), (1, 6)] {
            let grid = Grid::new(nx, ny, 1.0, 1.5)?;
            let fine = KernelTable::new(&Boussinesq::new(grid, 1.0)?)?;
            let (coarse, _) = fine.coarsened()?;
            let [bx, by] = [nx, ny].map(|n| n.min(2) as isize);
            let (cx, cy) = (nx as isize / bx, ny as isize / by);
            assert_eq!(coarse.grid().shape(), (cx as usize, cy as usize));
            for (di, dj) in (1 - cx..cx).flat_map(|di| (1 - cy..cy).map(move |dj| (di, dj))) {
                let mut sum = 0.0;
                for (ax, px) in (0..bx * bx).map(|k| (k % bx, k / bx)) {
                    for (ay, py) in (0..by * by).map(|k| (k % by, k / by)) {
                        let value = fine.coefficient(bx * di + ax - px, by * dj + ay - py);
                        sum += value.unwrap_or(f64::NAN);
                    }
                }
                let found = coarse.coefficient(di, dj).unwrap_or(f64::NAN);
                let expected = sum / (bx * by) as f64;
                // 16 terms near 1.
                assert!((found - expected).abs() < 1e-14, "{found} {expected}");
            }
        }
        Ok(())
    }

    /// Blocks that do not fit a whole number of times: long waves answer as on the fine grid, and
    /// all do positively.
    #[test]
    fn odd_periodic_grids_coarsen() -> Result<(), Error> {
        for n in [17_usize, 25, 33, 99] {
            let grid = Grid::square(n, 1.0)?;
            let tables = [
                KernelTable::new(&PeriodicBoussinesq::new(grid, 1.0)?)?,
                KernelTable::new(&Spectral::new(grid, 1.0)?)?,
            ];
            for fine in tables {
                let (coarse, _) = fine.coarsened()?;
                coarse.check_periodicity()?;
                // Along x; across, waves that do not vary.
                let symbol = |table: &KernelTable, k: usize| {
                    let (nx, ny) = table.grid().shape();
                    let mut sum = 0.0;
                    for (i, j) in (0..nx * ny).map(|node| (node % nx, node / nx)) {
                        let turn = std::f64::consts::TAU * (k * i % nx) as f64 / nx as f64;
                        let value = table.coefficient(i as isize, j as isize);
                        sum += value.unwrap_or(f64::NAN) * turn.cos();
                    }
                    sum
                };
                let ratio = symbol(&coarse, 1) / symbol(&fine, 1);
                // Averages over blocks of 2/n of a wave, of pressure and displacement, and what
                // weights at fractions of a cell do: (π / n)² and a little.
                assert!((ratio - 1.0).abs() < 40.0 / (n * n) as f64, "{n}: {ratio}");
                for k in 1..coarse.grid().nx() {
                    let value = symbol(&coarse, k);
                    assert!(value > 0.0, "{n}, wave {k}: {value}");
                }
            }
        }
        Ok(())
    }
}
