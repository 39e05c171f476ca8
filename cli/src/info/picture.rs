//! Pictures of a measured surface.

use std::path::{Path, PathBuf};

use asperity::Grid;
use asperity::io::MeasuredSurface;
use asperity_cli::axis::Axis;
use asperity_cli::chart::{self, BLUE, Chart, Corner, GREY, Series, Style};
use asperity_cli::field_map::FieldMap;
use asperity_cli::number::quantity;
use asperity_cli::outcome::Failure;

use super::summary::Summary;

/// Bins of the distribution of heights.
const BINS: usize = 80;

/// The heights as a map, missing nodes left white.
pub(super) fn map(
    measured: &MeasuredSurface,
    summary: &Summary,
    directory: &Path,
) -> Result<PathBuf, Failure> {
    let (nx, ny) = measured.heights.shape();
    let (grid, length_unit) = match measured.grid() {
        Ok(grid) => (grid, "m"),
        // Of unknown size: counted in cells.
        Err(_) => {
            let grid = Grid::new(nx, ny, 1.0, 1.0);
            (grid.map_err(|error| Failure::new("no map", error))?, "cells")
        }
    };
    FieldMap {
        grid: &grid,
        length_unit,
        values: &measured.heights.map(|height| height - summary.mean),
        range: (summary.min - summary.mean, summary.max - summary.mean),
        label: ("height above the mean", "m"),
    }
    .write(
        &directory.join("surface_map.png"),
        &format!("{nx} × {ny} nodes, Sq = {}", quantity(summary.sq, "m", 4)),
    )
}
