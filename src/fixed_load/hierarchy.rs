//! Nested grids: from fine to coarse and back.

use super::level::{Level, Target};
use crate::kernel::KernelTable;
use crate::{Error, Grid};

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
        let gap = restrict(&fine.grid, &fine.gap, &coarse.grid());
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

/// The block in which a node lies.
fn block(fine: &Grid, coarse: &Grid, node: usize) -> usize {
    let (ix, iy) = fine.coordinates(node);
    let halve = |i: usize, fine: usize| if fine > 1 { i / 2 } else { i };
    coarse.index(halve(ix, fine.nx()), halve(iy, fine.ny()))
}

/// Averages over blocks.
fn restrict(fine: &Grid, values: &[f64], coarse: &Grid) -> Vec<f64> {
    let mut sums = vec![(0.0, 0_u32); coarse.nodes()];
    for (node, value) in values.iter().enumerate() {
        let (sum, count) = &mut sums[block(fine, coarse, node)];
        *sum += value;
        *count += 1;
    }
    sums.into_iter()
        .map(|(sum, count)| sum / f64::from(count.max(1)))
        .collect()
}

/// The same pressure on all nodes of a block.
pub(super) fn prolong(coarse: &Grid, values: &[f64], fine: &Grid, result: &mut [f64]) {
    for (node, value) in result.iter_mut().enumerate() {
        *value = values[block(fine, coarse, node)];
    }
}
