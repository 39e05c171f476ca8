//! Surfaces of many kinds, all on a side of 1.

use asperity::surface::{Amplitude, HeightMap, Paraboloid, SelfAffine};
use asperity::{Error, Grid, Surface, SurfaceError};
use nalgebra::DMatrix;

/// Nodes a side of the square surfaces.
const NODES: usize = 128;
const RMS_HEIGHT: f64 = 0.01;
/// Wavelengths of the roll-off and of the short cut-off.
const ROLLOFF: f64 = 0.25;
const CUTOFF: f64 = 4.0 / NODES as f64;
const SEED: u64 = 11;
/// How many times as long as wide the waves of the anisotropic surface are.
const LAY: f64 = 5.0;
/// Exponent of the Weibull distribution, and the standard deviation of the logarithm of log-normal heights.
const WEIBULL: f64 = 1.5;
const LOG_NORMAL: f64 = 0.5;
/// The ground surface: rms height of what varies along the lay too, and the height of the bow, over the rms height.
const ACROSS: f64 = 0.2;
const BOW: f64 = 3.0;
/// Height of a step over the rms height.
const STEP: f64 = 0.5;

/// A surface to be compared on.
pub(crate) struct Rough {
    pub(crate) name: &'static str,
    pub(crate) grid: Grid,
    pub(crate) heights: HeightMap,
}

/// All of them.
pub(crate) fn all() -> Result<Vec<Rough>, Error> {
    let square = Grid::square(NODES, 1.0)?;
    let on_square = |name, heights: DMatrix<f64>| -> Result<Rough, Error> {
        Ok(Rough { name, grid: square, heights: HeightMap::new(heights)? })
    };
    let self_affine = |hurst, amplitude| -> Result<DMatrix<f64>, SurfaceError> {
        SelfAffine::new(hurst, ROLLOFF, CUTOFF, amplitude, SEED)?.heights(&square)
    };
    let height = Amplitude::RmsHeight(RMS_HEIGHT);
    let gaussian = self_affine(0.8, height)?;
    let log_normal = |z: f64| RMS_HEIGHT * (LOG_NORMAL * z / RMS_HEIGHT).exp();
    let step = STEP * RMS_HEIGHT;
    Ok(vec![
        on_square("self-affine, H = 0.3", self_affine(0.3, height)?)?,
        on_square("self-affine, H = 0.9", self_affine(0.9, height)?)?,
        on_square("anisotropic", anisotropic()?)?,
        on_square("Weibull heights", weibull(&gaussian))?,
        on_square("log-normal heights", gaussian.map(log_normal))?,
        on_square("rms gradient 1", self_affine(0.8, Amplitude::RmsGradient(1.0))?)?,
        on_square("ground, with bow", ground(&square)?)?,
        on_square("steps", gaussian.map(|z| step * (z / step).floor()))?,
        on_grid("96 × 64, cells 3 : 1", Grid::with_sides(96, 64, 1.0, 2.0 / 9.0)?)?,
        on_grid("32 × 24, cells 3 : 1", Grid::with_sides(32, 24, 1.0, 0.25)?)?,
        on_grid("32 × 32", Grid::square(32, 1.0)?)?,
        on_grid("32 × 27", Grid::with_sides(32, 27, 1.0, 27.0 / 32.0)?)?,
        on_grid("27 × 32", Grid::with_sides(27, 32, 27.0 / 32.0, 1.0)?)?,
    ])
}

/// A self-affine surface with the shortest waves that such a grid has with four cells.
fn on_grid(name: &'static str, grid: Grid) -> Result<Rough, Error> {
    let cutoff = 4.0 * grid.dx().max(grid.dy());
    let amplitude = Amplitude::RmsHeight(RMS_HEIGHT);
    let surface = SelfAffine::new(0.8, 3.0 * cutoff, cutoff, amplitude, SEED)?;
    Ok(Rough { name, grid, heights: HeightMap::sample(&surface, &grid)? })
}

/// An isotropic surface on a longer side, pressed together.
fn anisotropic() -> Result<DMatrix<f64>, SurfaceError> {
    let long = Grid::with_sides(NODES, NODES, 1.0, LAY)?;
    let amplitude = Amplitude::RmsHeight(RMS_HEIGHT);
    SelfAffine::new(0.8, 2.0 * ROLLOFF, LAY * CUTOFF, amplitude, SEED)?.heights(&long)
}

/// The same order of heights, with the quantiles of a Weibull distribution.
fn weibull(heights: &DMatrix<f64>) -> DMatrix<f64> {
    let mut order: Vec<usize> = (0..heights.len()).collect();
    order.sort_by(|a, b| heights[*a].total_cmp(&heights[*b]));
    let mut mapped = heights.clone();
    for (rank, node) in order.into_iter().enumerate() {
        let below = (rank as f64 + 0.5) / heights.len() as f64;
        mapped[node] = RMS_HEIGHT * (-(-below).ln_1p()).powf(1.0 / WEIBULL);
    }
    mapped
}

/// Scratches along y that differ a little from place to place, on a paraboloid.
fn ground(grid: &Grid) -> Result<DMatrix<f64>, Error> {
    let profile = Grid::new(NODES, 1, grid.dx(), 1.0)?;
    let rough = |rms, grid: &Grid, seed| {
        let amplitude = Amplitude::RmsHeight(rms * RMS_HEIGHT);
        SelfAffine::new(0.8, ROLLOFF, CUTOFF, amplitude, seed)?.heights(grid)
    };
    let scratches = rough(1.0, &profile, SEED)?;
    let waviness = rough(ACROSS, grid, SEED + 1)?;
    // The corners are half a diagonal from the middle: r² = 1/2.
    let bow = Paraboloid::new(0.25 / (BOW * RMS_HEIGHT))?.heights(grid)?;
    Ok(DMatrix::from_fn(NODES, NODES, |ix, iy| {
        scratches[(ix, 0)] + waviness[(ix, iy)] + bow[(ix, iy)]
    }))
}
