//! Heights on their grid: what a measurement is prepared as, and what its statistics are taken of.

use nalgebra::DMatrix;

use crate::surface::HeightMap;
use crate::surface::placement::all_finite;
use crate::{Error, Grid, Surface};

/// Heights \[m\] of a surface on the grid that they belong to: a [`HeightMap`] that knows its lengths.
///
/// Every step of preparation returns a new one, so that steps can be strung together:
///
/// ```
/// use asperity_surfaces::surface::{Amplitude, Filter, SelfAffine, Topography, Trend};
/// use asperity_surfaces::{Error, Grid};
///
/// # fn main() -> Result<(), Error> {
/// let surface = SelfAffine::new(0.8, 2e-4, 4e-5, Amplitude::RmsHeight(1e-6), 1)?;
/// let measured = Topography::sample(&surface, Grid::square(64, 1e-3)?)?;
/// let prepared = measured
///     .level(Trend::Plane)?
///     .crop(8..56, ..)?
///     .low_pass(5e-5, Filter::Gaussian)?;
/// assert_eq!(prepared.grid().shape(), (48, 64));
/// assert!(prepared.map().rms_height() < measured.map().rms_height());
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Topography {
    pub(super) grid: Grid,
    pub(super) map: HeightMap,
}

impl Topography {
    /// Heights on their grid.
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`] if the shapes differ, and those of [`HeightMap::new`].
    pub fn new(grid: Grid, heights: DMatrix<f64>) -> Result<Self, Error> {
        grid.check_shape(heights.shape())?;
        Ok(Self { grid, map: HeightMap::new(heights)? })
    }

    /// The heights of any surface on a grid.
    ///
    /// # Errors
    ///
    /// Those of the surface, and those of [`Topography::new`].
    pub fn sample(surface: &(impl Surface + ?Sized), grid: Grid) -> Result<Self, Error> {
        Self::new(grid, surface.heights(&grid)?)
    }

    /// Other heights on the same grid, if none has overflown.
    pub(super) fn with_heights(&self, heights: DMatrix<f64>) -> Result<Self, Error> {
        Ok(Self { grid: self.grid, map: HeightMap::of_finite(all_finite(heights)?) })
    }

    /// The grid.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The heights \[m\].
    #[must_use]
    pub fn heights(&self) -> &DMatrix<f64> {
        self.map.matrix()
    }

    /// The heights without their lengths.
    #[must_use]
    pub fn map(&self) -> &HeightMap {
        &self.map
    }
}

/// The surface itself, on its own grid and no other.
impl Surface for Topography {
    /// # Errors
    ///
    /// [`Error::GridMismatch`] and [`Error::CellMismatch`] on another grid.
    fn heights(&self, grid: &Grid) -> Result<DMatrix<f64>, Error> {
        let heights = self.map.heights(grid)?;
        let cells = |grid: &Grid| (grid.dx(), grid.dy());
        let (expected, found) = (cells(&self.grid), cells(grid));
        let is_same = |a: f64, b: f64| (a - b).abs() <= SAME_CELL * a;
        if is_same(expected.0, found.0) && is_same(expected.1, found.1) {
            return Ok(heights);
        }
        Err(Error::CellMismatch { expected, found })
    }
}

/// Cells that differ by no more than this are one: sides are written with some nine digits.
const SAME_CELL: f64 = 1e-9;
