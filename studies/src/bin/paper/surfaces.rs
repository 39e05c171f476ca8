//! The rough surfaces that are compared, in the paper's units: E* = 1, sides 10⁻².

use std::f64::consts::TAU;

use asperity::convolution::Convolution;
use asperity::kernel::KernelTable;
use asperity::surface::{Amplitude, HeightMap, Topography};
use asperity::{ContactGrowth, Error, Grid, MeanDisplacement, SelfAffine};

/// Side of the nominal square, Table 1.
pub(crate) const SIDE: f64 = 1e-2;
/// Nominal area.
pub(crate) const NOMINAL_AREA: f64 = SIDE * SIDE;
/// Rms height, Table 1.
pub(crate) const SQ: f64 = 50e-6;
/// Composite modulus: results are over E*.
pub(crate) const E_STAR: f64 = 1.0;
/// Short cut-off wavelength, Table 1.
const SHORT_CUTOFF: f64 = 7.8125e-5;
/// The mesh of the paper.
pub(crate) const PAPER_NODES: usize = 512;
/// The rms gradient that the paper states.
pub(crate) const PAPER_GRADIENT: f64 = 0.112;

/// A random surface of the study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Rough {
    /// Table 1 and eq. (23) taken literally.
    Table1,
    /// The same without roll-off, λ_r = L.
    NoRollOff,
    /// All of Table 1, but amplitudes of waves in proportion to C instead of √C.
    AmplitudesC,
}

impl Rough {
    pub(crate) const ALL: [Self; 3] = [Self::Table1, Self::NoRollOff, Self::AmplitudesC];

    /// Name in pictures and tables.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Table1 => "Table 1",
            Self::NoRollOff => "no roll-off",
            Self::AmplitudesC => "amplitudes ∝ C",
        }
    }

    /// Name in files.
    pub(crate) fn key(self) -> &'static str {
        match self {
            Self::Table1 => "table1",
            Self::NoRollOff => "no_rolloff",
            Self::AmplitudesC => "amplitudes_c",
        }
    }

    fn rolloff(self) -> f64 {
        match self {
            Self::Table1 | Self::AmplitudesC => SIDE / 4.0,
            Self::NoRollOff => SIDE,
        }
    }

    /// Heights with a seed on a grid, with the short cut-off of Table 1, or of two cells if the grid is
    /// too coarse for it. Every surface has the same phases for a seed, and Sq to rounding.
    pub(crate) fn heights(self, grid: &Grid, seed: u64) -> Result<HeightMap, Error> {
        let surface = SelfAffine::new(
            0.8,
            self.rolloff(),
            short_cutoff(grid.nx()),
            Amplitude::RmsHeight(SQ),
            seed,
        )?;
        match self {
            Self::Table1 | Self::NoRollOff => Ok(HeightMap::sample(&surface, grid)?),
            Self::AmplitudesC => with_amplitudes_c(&surface, grid),
        }
    }

    /// Rms gradient of the sum of waves on so many nodes a side, the same for every seed.
    pub(crate) fn gradient(self, nodes: usize) -> Result<f64, Error> {
        let grid = grid(nodes)?;
        let waves = Topography::sample(&self.heights(&grid, 1)?, grid)?;
        Ok(waves.spectral_moments().rms_gradient())
    }

    /// The same by central differences between the nodes, of seed 1.
    pub(crate) fn central_gradient(self, nodes: usize) -> Result<f64, Error> {
        let grid = grid(nodes)?;
        Ok(central_gradient(&self.heights(&grid, 1)?, &grid))
    }
}

/// The waves of a surface, each multiplied by √(C(q)/C(0)): their amplitudes, in proportion to √C before, are
/// so to C. Then all are scaled to Sq.
///
/// The product is the convolution with the periodic kernel of this symbol.
fn with_amplitudes_c(surface: &SelfAffine, grid: &Grid) -> Result<HeightMap, Error> {
    let spectrum = surface.spectrum(grid)?;
    // A symbol must be positive everywhere; beyond the cut-off there are no waves, and any value does.
    let shortest = TAU / surface.short_cutoff_wavelength();
    let plateau = spectrum.psd(0.0);
    let factor = |qx: f64, qy: f64| (spectrum.psd(qx.hypot(qy).min(shortest)) / plateau).sqrt();
    let table = KernelTable::from_symbol(
        *grid,
        MeanDisplacement::Physical,
        ContactGrowth::Unknown,
        factor,
    )?;
    let heights = HeightMap::sample(surface, grid)?;
    let filtered = Convolution::from_table(&table)?.convolve(heights.matrix())?;
    let filtered = HeightMap::new(filtered)?;
    let scaled = filtered.matrix() * (SQ / filtered.rms_height());
    Ok(HeightMap::new(scaled)?)
}

/// The grid of the study.
pub(crate) fn grid(nodes: usize) -> Result<Grid, Error> {
    Ok(Grid::square(nodes, SIDE)?)
}

/// Short cut-off wavelength on so many nodes a side.
pub(crate) fn short_cutoff(nodes: usize) -> f64 {
    SHORT_CUTOFF.max(2.0 * SIDE / nodes as f64)
}

/// Rms gradient by central differences, at the nodes that have neighbours on all sides.
fn central_gradient(heights: &HeightMap, grid: &Grid) -> f64 {
    let z = heights.matrix();
    let (nx, ny) = heights.shape();
    let mut sum = 0.0;
    for iy in 1..ny - 1 {
        for ix in 1..nx - 1 {
            let along_x = (z[(ix + 1, iy)] - z[(ix - 1, iy)]) / (2.0 * grid.dx());
            let along_y = (z[(ix, iy + 1)] - z[(ix, iy - 1)]) / (2.0 * grid.dy());
            sum += along_x * along_x + along_y * along_y;
        }
    }
    (sum / ((nx - 2) * (ny - 2)) as f64).sqrt()
}
