//! How long cells may be that repeat.

use crate::{Error, Grid};

/// `Ok` for cells of a periodic half-space that are at most so many times as long as wide, up to the rounding of sides
/// that are decimal numbers: cells of 10 µm and 1 µm are 10.000000000000002 : 1.
///
/// # Errors
///
/// [`Error::OutOfRange`] otherwise, with `expected` in words.
pub(crate) fn check_periodic_cells(
    grid: &Grid,
    most: f64,
    expected: &'static str,
) -> Result<(), Error> {
    let value = grid.cell_aspect();
    let is_short = value <= most * (1.0 + 4.0 * f64::EPSILON);
    let quantity = "ratio of the sides of a periodic cell";
    Error::require(quantity, value, is_short, expected).map(drop)
}
