//! The rough surfaces that are compared, in the paper's units: E* = 1, sides 10⁻².

use asperity::surface::{Amplitude, HeightMap};
use asperity::{Error, Grid, SelfAffine};

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
    /// The same without roll-off, λ_r = L: the rms gradient is the paper's.
    NoRollOff,
}

impl Rough {
    pub(crate) const ALL: [Self; 2] = [Self::Table1, Self::NoRollOff];

    /// Name in pictures and tables.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Table1 => "Table 1",
            Self::NoRollOff => "no roll-off",
        }
    }

    /// Name in files.
    pub(crate) fn key(self) -> &'static str {
        match self {
            Self::Table1 => "table1",
            Self::NoRollOff => "no_rolloff",
        }
    }

    fn rolloff(self) -> f64 {
        match self {
            Self::Table1 => SIDE / 4.0,
            Self::NoRollOff => SIDE,
        }
    }

    /// The surface with a seed on a grid, with the short cut-off of Table 1, or of two cells if the grid
    /// is too coarse for it.
    pub(crate) fn surface(self, grid: &Grid, seed: u64) -> Result<SelfAffine, Error> {
        SelfAffine::new(
            0.8,
            self.rolloff(),
            short_cutoff(grid.nx()),
            Amplitude::RmsHeight(SQ),
            seed,
        )
    }

    /// Rms gradients of the sum of waves (the same for every seed), and by central differences
    /// between the nodes.
    pub(crate) fn gradients(self, nodes: usize, seed: u64) -> Result<(f64, f64), Error> {
        let grid = grid(nodes)?;
        let surface = self.surface(&grid, seed)?;
        let heights = HeightMap::sample(&surface, &grid)?;
        let exact = surface.spectrum(&grid)?.rms_gradient();
        Ok((exact, central_gradient(&heights, &grid)))
    }
}

/// The grid of the study.
pub(crate) fn grid(nodes: usize) -> Result<Grid, Error> {
    Grid::square(nodes, SIDE)
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
