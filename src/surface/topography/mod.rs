//! Heights on their grid: what a measurement is prepared as, and what its statistics are taken of.

use nalgebra::DMatrix;

use super::HeightMap;
use crate::{Error, Grid, Surface};

/// Heights \[m\] of a surface on the grid that they belong to: a [`HeightMap`] that knows its lengths.
///
/// Every step of preparation returns a new one, so that steps can be strung together.
#[derive(Debug, Clone, PartialEq)]
pub struct Topography {
    grid: Grid,
    map: HeightMap,
}

impl Topography {
    /// Heights on their grid.
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`] if the shapes differ, and those of [`HeightMap::new`].
    pub fn new(grid: Grid, heights: DMatrix<f64>) -> Result<Self, Error> {
        grid.check_shape(heights.shape())?;
        Ok(Self {
            grid,
            map: HeightMap::new(heights)?,
        })
    }

    /// The heights of any surface on a grid.
    ///
    /// # Errors
    ///
    /// Those of the surface, and those of [`Topography::new`].
    pub fn sample(surface: &(impl Surface + ?Sized), grid: Grid) -> Result<Self, Error> {
        Self::new(grid, surface.heights(&grid)?)
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
    fn heights(&self, grid: &Grid) -> Result<DMatrix<f64>, Error> {
        self.map.heights(grid)
    }
}
