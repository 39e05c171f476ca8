//! Nested grids: from fine to coarse and back.

use super::level::{Level, Target};
use crate::kernel::KernelTable;
use crate::{Boundary, Error, Grid};

/// Sides of at most so many nodes are not coarsened further.
const COARSEST: usize = 16;

/// The grids, finest first.
pub(super) fn levels(
    table: &KernelTable,
    gap: Vec<f64>,
    nested: bool,
) -> Result<Vec<Level>, Error> {
    let mut levels = vec![Level::new(table, gap)?];
    let mut table = std::borrow::Cow::Borrowed(table);
    loop {
        let fine = &levels[levels.len() - 1];
        if !nested || fine.grid.nx().max(fine.grid.ny()) <= COARSEST {
            return Ok(levels);
        }
        let coarse = table.coarsened()?;
        let grid = coarse.grid();
        let blocks = Blocks::new(&fine.grid, &grid, table.boundary());
        let gap = blocks.restrict(&fine.gap);
        levels.push(Level::new(&coarse, gap)?);
        table = std::borrow::Cow::Owned(coarse);
    }
}

/// The target on the grid of `coarse` that corresponds to `target` on that of `fine`.
pub(super) fn coarse_target(target: Target, fine: &Grid, coarse: &Grid) -> Target {
    match target {
        Target::Sum(sum) => Target::Sum(sum * fine.cell_area() / coarse.cell_area()),
        approach @ Target::Approach(_) => approach,
    }
}

/// Blocks of nodes of a fine grid, each a node of a coarse one.
pub(super) struct Blocks<'a> {
    fine: &'a Grid,
    coarse: &'a Grid,
    boundary: Boundary,
}

impl<'a> Blocks<'a> {
    pub(super) fn new(fine: &'a Grid, coarse: &'a Grid, boundary: Boundary) -> Self {
        Self {
            fine,
            coarse,
            boundary,
        }
    }

    /// The block in which a node lies.
    fn of(&self, node: usize) -> usize {
        let (ix, iy) = self.fine.coordinates(node);
        let halve = |i: usize, fine: usize, coarse: usize| match self.boundary {
            Boundary::Free if fine == 1 => i,
            Boundary::Free => i / 2,
            // Blocks share the period equally.
            Boundary::Periodic => (2 * i + 1) * coarse / (2 * fine),
        };
        self.coarse.index(
            halve(ix, self.fine.nx(), self.coarse.nx()),
            halve(iy, self.fine.ny(), self.coarse.ny()),
        )
    }

    /// Averages over blocks.
    fn restrict(&self, values: &[f64]) -> Vec<f64> {
        let mut sums = vec![(0.0, 0_u32); self.coarse.nodes()];
        for (node, value) in values.iter().enumerate() {
            let (sum, count) = &mut sums[self.of(node)];
            *sum += value;
            *count += 1;
        }
        sums.into_iter()
            .map(|(sum, count)| sum / f64::from(count.max(1)))
            .collect()
    }

    /// The same pressure on all nodes of a block.
    pub(super) fn prolong(&self, values: &[f64], result: &mut [f64]) {
        for (node, value) in result.iter_mut().enumerate() {
            *value = values[self.of(node)];
        }
    }
}
