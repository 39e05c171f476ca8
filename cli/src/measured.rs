//! A surface from a file, on its grid.

use std::path::Path;

use asperity::{Grid, HeightMap};
use asperity_cli::outcome::Failure;

/// Reads heights; cells are square unless the side along y is given.
pub(crate) fn read(
    file: &Path,
    side: f64,
    side_y: Option<f64>,
) -> Result<(Grid, HeightMap), Failure> {
    let read = || {
        let heights = HeightMap::new(asperity::io::read_npy(file)?)?;
        let (nx, ny) = heights.shape();
        let dx = side / nx as f64;
        let dy = side_y.map_or(dx, |side| side / ny as f64);
        Ok((Grid::new(nx, ny, dx, dy)?, heights))
    };
    read().map_err(|error: asperity::Error| {
        Failure::new(format!("cannot use {}", file.display()), error)
    })
}
