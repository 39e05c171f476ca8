//! Heights of rough surfaces.

use asperity::Grid;
use asperity::surface::{Amplitude, HeightMap, SelfAffine};
use nalgebra::DMatrix;

/// A self-affine surface of this Hurst exponent and rms height, from half of the longer side to four cells.
#[must_use]
pub fn self_affine(grid: &Grid, hurst: f64, rms_height: f64, seed: u64) -> HeightMap {
    let (lx, ly) = grid.sides();
    let short = 4.0 * grid.dx().max(grid.dy());
    let height = Amplitude::RmsHeight(rms_height);
    let surface = SelfAffine::new(hurst, 0.5 * lx.max(ly), short, height, seed).unwrap();
    HeightMap::sample(&surface, grid).unwrap()
}

/// The same with H = 0.8 and the rms height a hundredth of the longer side.
#[must_use]
pub fn rough(grid: &Grid, seed: u64) -> HeightMap {
    let (lx, ly) = grid.sides();
    self_affine(grid, 0.8, 1e-2 * lx.max(ly), seed)
}

/// Whole numbers below `levels` without any correlation; few levels make ties.
#[must_use]
pub fn scattered((nx, ny): (usize, usize), levels: usize, seed: usize) -> DMatrix<f64> {
    let level = |ix: usize, iy: usize| 7919 * (ix + seed) + 104_729 * iy + 31 * ix * iy + seed;
    DMatrix::from_fn(nx, ny, |ix, iy| (level(ix, iy) % levels) as f64)
}

/// Means over the 3 × 3 neighbours that there are, and a little of the height itself, so that heights stay different on
/// grids of less than three nodes a side.
#[must_use]
pub fn smooth(heights: &DMatrix<f64>) -> DMatrix<f64> {
    let (nx, ny) = heights.shape();
    DMatrix::from_fn(nx, ny, |ix, iy| {
        let (left, right) = (ix.saturating_sub(1), (ix + 1).min(nx - 1));
        let (low, high) = (iy.saturating_sub(1), (iy + 1).min(ny - 1));
        let part = heights.view((left, low), (right - left + 1, high - low + 1));
        0.9 * part.mean() + 0.1 * heights[(ix, iy)]
    })
}

/// The surface with these initial gaps by node index.
#[must_use]
pub fn with_gaps(grid: &Grid, gaps: &[f64]) -> HeightMap {
    let (nx, ny) = grid.shape();
    HeightMap::new(DMatrix::from_fn(nx, ny, |ix, iy| -gaps[ix + nx * iy])).unwrap()
}
