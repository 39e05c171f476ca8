//! What a file of an instrument holds.

use std::fmt;

use nalgebra::DMatrix;

use super::format::Format;
use crate::number::{counted, quantity};
use crate::surface::{FittedTrend, Topography, Trend, Warning, fill_missing, level_measured};
use crate::{Error, FileError, Grid};

/// Heights as they were measured: some may be missing, and the file may not know the size of the surface.
///
/// ```no_run
/// use asperity_surfaces::io::read_surface;
/// use asperity_surfaces::surface::Trend;
///
/// # fn main() -> Result<(), asperity_surfaces::Error> {
/// let surface = read_surface("ground.sdf")?.level(Trend::Plane)?.fill_missing()?.topography()?;
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct MeasuredSurface {
    /// Heights \[m\], NaN at missing nodes; element `[(ix, iy)]` belongs to node (ix, iy).
    pub heights: DMatrix<f64>,
    /// Number of missing nodes.
    pub missing: usize,
    /// Cell along x and y \[m\], `None` if neither the file nor the options gave it.
    pub cell: Option<(f64, f64)>,
    /// Name of the map in the file, empty if it has none.
    pub title: String,
    /// Names of all maps in the file, its own among them.
    pub channels: Vec<String>,
    /// Format of the file.
    pub format: Format,
    /// How the file was understood, where its format leaves that open: in a text, which numbers are heights, which sign
    /// parts them, and which lines above them were not used. Empty for other formats.
    pub understood: String,
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
        Ok(Self { heights: fill_missing(self.heights)?, missing: 0, ..self })
    }

    /// The polynomial that is closest to the heights that were measured; on cells of 1 m if their size is not known.
    ///
    /// # Errors
    ///
    /// Those of [`FittedTrend::of_measured`].
    pub fn trend(&self, trend: Trend) -> Result<FittedTrend, Error> {
        FittedTrend::of_measured(&self.any_grid()?, &self.heights, trend)
    }

    /// Takes that polynomial off; missing nodes stay missing, to be filled afterwards: see [`level_measured`].
    ///
    /// # Errors
    ///
    /// Those of [`level_measured`].
    pub fn level(self, trend: Trend) -> Result<Self, Error> {
        let heights = level_measured(&self.any_grid()?, &self.heights, trend)?;
        Ok(Self { heights, ..self })
    }

    /// Its grid, with cells of 1 m if their size is not known.
    fn any_grid(&self) -> Result<Grid, Error> {
        let (nx, ny) = self.heights.shape();
        let (dx, dy) = self.cell.unwrap_or((1.0, 1.0));
        Grid::new(nx, ny, dx, dy)
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
    /// ([`Warning::of_surface`]) goes to the crate `log` as a warning.
    ///
    /// # Errors
    ///
    /// [`FileError::NoSide`](crate::FileError::NoSide), and [`Error::HeightNotFinite`] as long as nodes are missing.
    pub fn topography(self) -> Result<Topography, Error> {
        let surface = Topography::new(self.grid()?, self.heights)?;
        for warning in Warning::of_surface(&surface) {
            log::warn!("{warning}");
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
            Some((dx, dy)) => {
                let side = |n: usize, cell: f64| quantity(n as f64 * cell, "m", 6);
                write!(f, ", {} x {}", side(nx, dx), side(ny, dy))?;
            }
            None => write!(f, ", of unknown size")?,
        }
        if self.missing > 0 {
            let share = 100.0 * self.missing as f64 / (nx * ny) as f64;
            write!(f, ", {} ({share:.2} %) missing", counted(self.missing, "node"))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 4 × 3 nodes on the plane z = x + 2 y (µm a node), node (1, 1) missing.
    fn plane(cell: Option<(f64, f64)>) -> MeasuredSurface {
        let mut heights = DMatrix::from_fn(4, 3, |ix, iy| 1e-6 * (ix as f64 + 2.0 * iy as f64));
        heights[(1, 1)] = f64::NAN;
        MeasuredSurface {
            heights,
            missing: 1,
            cell,
            title: "Topography".to_string(),
            channels: vec!["Topography".to_string()],
            format: Format::GwyddionSimpleField,
            understood: String::new(),
            notes: vec!["a note".to_string()],
        }
    }

    /// A plane is filled by itself, and nothing else changes.
    #[test]
    fn a_surface_with_a_hole_is_filled_and_put_on_its_grid() -> Result<(), Error> {
        let measured = plane(Some((0.5, 0.25)));
        assert_eq!(
            measured.to_string(),
            "Gwyddion Simple Field: 4 x 3 nodes, 2 m x 750 mm, 1 node (8.33 %) missing"
        );
        let (title, notes) = (measured.title.clone(), measured.notes.clone());
        let filled = measured.fill_missing()?;
        assert_eq!(filled.missing, 0);
        assert_eq!((&filled.title, &filled.notes), (&title, &notes));
        assert_eq!(filled.to_string(), "Gwyddion Simple Field: 4 x 3 nodes, 2 m x 750 mm");
        let grid = filled.grid()?;
        assert_eq!((grid.shape(), grid.dx(), grid.dy()), ((4, 3), 0.5, 0.25));
        let surface = filled.topography()?;
        assert_eq!(surface.grid(), &grid);
        for (k, z) in surface.map().matrix().iter().enumerate() {
            let expected = 1e-6 * ((k % 4) as f64 + 2.0 * (k / 4) as f64);
            // Node (1, 1) to what `fill_missing` promises, 1e-10 of the range; the others as they were.
            let error = if k == 5 { 1e-10 * 7e-6 } else { 0.0 };
            assert!((z - expected).abs() <= error, "{k}: {z}");
        }
        Ok(())
    }

    #[test]
    fn a_missing_node_and_an_unknown_size_are_refused() -> Result<(), Error> {
        let hole = plane(Some((0.5, 0.25))).topography();
        assert!(matches!(hole, Err(Error::HeightNotFinite { ix: 1, iy: 1, .. })), "{hole:?}");
        let unknown = plane(None);
        assert_eq!(
            unknown.to_string(),
            "Gwyddion Simple Field: 4 x 3 nodes, of unknown size, 1 node (8.33 %) missing"
        );
        assert!(matches!(unknown.grid(), Err(Error::File(FileError::NoSide))));
        let surface = unknown.fill_missing()?.topography();
        assert!(matches!(surface, Err(Error::File(FileError::NoSide))));
        Ok(())
    }
}
