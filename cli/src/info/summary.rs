//! What is known of a measured surface.

use std::path::Path;

use asperity::Grid;
use asperity::io::MeasuredSurface;
use asperity::surface::{Topography, Trend};
use asperity_cli::outcome::Failure;
use nalgebra::DMatrix;

use crate::reading::Reading;

/// A measured surface without holes, prepared as the command line asks. All figures are of this one.
pub(super) struct Whole {
    /// On cells of 1 m where the file does not give the size: heights have figures all the same.
    pub(super) surface: Topography,
    /// The same for figures without the tilt: holes were filled without it, as they would be tipped with it.
    pub(super) filled_flat: Topography,
    /// Rms height of its plane \[m\], of the measured nodes alone, continued over all.
    pub(super) tilt: f64,
    /// Whether the size is known.
    pub(super) has_size: bool,
    /// Heights for the picture, NaN at nodes that are missing and stay so.
    pub(super) shown: DMatrix<f64>,
}

impl Whole {
    pub(super) fn of(
        file: &Path,
        measured: &MeasuredSurface,
        reading: &Reading,
    ) -> Result<Self, Failure> {
        let failed = |error| Failure::new(format!("cannot use {}", file.display()), error);
        let has_size = measured.cell.is_some();
        let on_grid = |measured: MeasuredSurface| {
            let (dx, dy) = measured.cell.unwrap_or((1.0, 1.0));
            let filled = measured.fill_missing()?;
            let (nx, ny) = filled.heights.shape();
            let surface = Topography::new(Grid::new(nx, ny, dx, dy)?, filled.heights)?;
            Ok(reading.inverted(surface))
        };
        let levelled = reading.levelled(measured.clone()).map_err(failed)?;
        let surface = on_grid(levelled.clone()).map_err(failed)?;
        let (sx, sy) = levelled.trend(Trend::Plane).map_err(failed)?.slopes();
        let (nx, ny) = surface.grid().shape();
        let rms = |slope: f64, cell: f64, nodes: usize| {
            slope * cell * ((nodes * nodes - 1) as f64 / 12.0).sqrt()
        };
        let tilt = rms(sx, surface.grid().dx(), nx).hypot(rms(sy, surface.grid().dy(), ny));
        // What is left of rounding is none.
        let tilt = if tilt > 1e-6 * surface.map().rms_height() { tilt } else { 0.0 };
        let filled_flat = match measured.missing {
            0 => surface.clone(),
            _ => levelled.level(Trend::Plane).and_then(on_grid).map_err(failed)?,
        };
        let is_shown = |height, found: f64| match found.is_nan() && !reading.fills() {
            true => f64::NAN,
            false => height,
        };
        Ok(Self {
            shown: surface.heights().zip_map(&measured.heights, is_shown),
            surface,
            filled_flat,
            tilt,
            has_size,
        })
    }

    /// Mean height \[m\], 0 where only rounding is left of it.
    pub(super) fn mean(&self) -> f64 {
        let map = self.surface.map();
        let mean = map.mean_height();
        let is_rounding = mean.abs() < 1e-12 * map.peak_to_valley();
        if is_rounding { 0.0 } else { mean }
    }

    /// Without unit, `None` where the size is not known.
    pub(super) fn rms_gradient(&self) -> Option<f64> {
        let gradient = self.surface.map().rms_gradient(self.surface.grid());
        gradient.ok().filter(|_| self.has_size)
    }
}
