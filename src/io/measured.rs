//! What a file of an instrument holds.

use std::fmt;

use nalgebra::DMatrix;

use super::format::Format;
use crate::surface::{Topography, fill_missing};
use crate::{Doubt, Error, FileError, Grid};

/// Heights as they were measured: some may be missing, and the file may not know the size of the surface.
///
/// ```no_run
/// use asperity::io::read_surface;
///
/// # fn main() -> Result<(), asperity::Error> {
/// let surface = read_surface("ground.sdf")?.fill_missing()?.topography()?;
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredSurface {
    /// Heights \[m\], NaN at missing nodes; element `[(ix, iy)]` belongs to node (ix, iy).
    pub heights: DMatrix<f64>,
    /// Number of missing nodes.
    pub missing: usize,
    /// Cell along x and y \[m\], `None` if neither the file nor the options gave it.
    pub cell: Option<(f64, f64)>,
    /// Name of the map in the file, empty if it has none.
    pub title: String,
    /// Format of the file.
    pub format: Format,
    /// What was noticed in reading: a checksum that does not match, a mask taken for missing nodes.
    pub notes: Vec<String>,
}

impl MeasuredSurface {
    /// Fills missing nodes from their neighbours: see [`fill_missing`].
    ///
    /// # Errors
    ///
    /// Those of [`fill_missing`].
    pub fn fill_missing(self) -> Result<Self, Error> {
        Ok(Self {
            heights: fill_missing(self.heights)?,
            missing: 0,
            ..self
        })
    }

    /// The grid of the measurement.
    ///
    /// # Errors
    ///
    /// [`FileError::NoSide`](crate::FileError::NoSide) if the file does not give its size.
    pub fn grid(&self) -> Result<Grid, Error> {
        let (dx, dy) = self.cell.ok_or(Error::File(FileError::NoSide))?;
        let (nx, ny) = self.heights.shape();
        Grid::new(nx, ny, dx, dy)
    }

    /// The heights on their grid, for preparation, statistics and contact. What looks wrong with them
    /// ([`Doubt::of_surface`]) goes to the crate `log` as a warning.
    ///
    /// # Errors
    ///
    /// [`FileError::NoSide`](crate::FileError::NoSide), and [`Error::HeightNotFinite`] as long as nodes are missing.
    pub fn topography(self) -> Result<Topography, Error> {
        let surface = Topography::new(self.grid()?, self.heights)?;
        for doubt in Doubt::of_surface(&surface) {
            log::warn!("{doubt}");
        }
        Ok(surface)
    }
}

/// One line: format, nodes, sides and what is missing.
impl fmt::Display for MeasuredSurface {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (nx, ny) = self.heights.shape();
        write!(f, "{}: {nx} x {ny} nodes", self.format)?;
        match self.cell {
            Some((dx, dy)) => write!(f, ", {:e} x {:e} m", nx as f64 * dx, ny as f64 * dy)?,
            None => write!(f, ", of unknown size")?,
        }
        if self.missing > 0 {
            let share = 100.0 * self.missing as f64 / (nx * ny) as f64;
            write!(f, ", {} nodes ({share:.2} %) missing", self.missing)?;
        }
        Ok(())
    }
}
