//! How the nodes around a node make groups, and the patch of the grid that holds them.

use super::tuning::BLOCK;
use crate::Grid;
use crate::convolution::Convolution;
use crate::kernel::KernelTable;
use std::collections::HashMap;

/// The same around each node of a grid.
#[derive(Debug, Clone)]
pub(super) struct Grouping {
    pub(super) blocks: Blocks,
    /// Cells from a node to the sides of a patch of the grid that holds all of them.
    pub(super) half_patch: [i32; 2],
    /// That of the patch, if there is one.
    pub(super) convolution: Option<Convolution>,
}

impl Grouping {
    /// Of the nodes at some offsets from a node, nearest first. Sides of a cell are relative to those of a square one of the same area.
    pub(super) fn new(
        table: &KernelTable,
        offsets: impl Iterator<Item = [i32; 2]> + Clone,
        sides: [f64; 2],
    ) -> Self {
        let half_patch =
            [0, 1].map(|axis| offsets.clone().map(|d| d[axis].abs()).max().unwrap_or_default());
        Self {
            blocks: Blocks::new(offsets, sides),
            half_patch,
            convolution: convolution(table, half_patch),
        }
    }
}

/// Blocks around a node: those of 3 × 3 square cells, and of three by three of these, the same in all directions.
#[derive(Debug, Clone, Default)]
pub(super) struct Blocks {
    /// Of each offset.
    pub(super) of: Vec<BlocksOf>,
    pub(super) count: usize,
}

/// The blocks of an offset.
#[derive(Debug, Clone, Copy)]
pub(super) struct BlocksOf {
    pub(super) small: u32,
    pub(super) large: u32,
    /// From the node to the centre of the larger one \[sides of a square cell of the same area\].
    pub(super) distance: f64,
}

impl Blocks {
    fn new(offsets: impl Iterator<Item = [i32; 2]>, sides: [f64; 2]) -> Self {
        let mut known = HashMap::new();
        let small = sides.map(|side| ((BLOCK / side).round() as i32).max(1));
        let block = |[dx, dy]: [i32; 2]| {
            let along = |d: i32, cells: i32| d.signum() * ((d.abs() + cells / 2) / cells);
            let mut place = |factor: i32| {
                let [bx, by] = small.map(|cells| factor * cells);
                let (qx, qy) = (along(dx, bx), along(dy, by));
                let next = known.len() as u32;
                let block = *known.entry((factor, qy, qx)).or_insert(next);
                let x = f64::from(qx * bx) * sides[0];
                (block, x.hypot(f64::from(qy * by) * sides[1]))
            };
            let (small, _) = place(1);
            let (large, distance) = place(3);
            BlocksOf { small, large, distance }
        };
        let of = offsets.map(block).collect();
        Self { of, count: known.len() }
    }
}

/// The convolution of a patch so many cells to both sides of a node; `None` if there is none.
fn convolution(table: &KernelTable, [hx, hy]: [i32; 2]) -> Option<Convolution> {
    let grid = table.grid();
    let [nx, ny] = [hx, hy].map(|half| 2 * half as usize + 1);
    let grid = Grid::new(nx, ny, grid.dx(), grid.dy()).ok()?;
    Convolution::from_table(&table.patch(grid)).ok()
}
