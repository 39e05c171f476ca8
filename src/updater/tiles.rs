//! Tiles of columns of a matrix, which threads share where that pays.

use super::tuning::{PARALLEL, TILE};
use crate::parallel;

/// Calls `change(first column, tile)` for tiles of a matrix that is stored column by column, each of so many numbers.
pub(crate) fn for_each_tile(
    matrix: &mut [f64],
    height: usize,
    change: impl Fn(usize, &mut [f64]) + Sync + Send,
) {
    let tile = TILE * height;
    if matrix.len() < PARALLEL * height {
        let tiles = matrix.chunks_mut(tile.max(1)).zip((0..).step_by(TILE));
        tiles.for_each(|(target, first)| change(first, target));
    } else if tile > 0 {
        parallel::for_each_chunk(matrix, tile, |k, target| change(k * TILE, target));
    }
}
