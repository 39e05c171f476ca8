//! Which cells iterations are made for.

use crate::kernel::check_periodic_cells;
use crate::{Boundary, Error, Grid};

/// `Ok` for cells that are at most so many times as long as wide, of a single row, or of a grid that does not repeat.
/// Long waves along long cells of a periodic one displace so much more than short ones that nothing is seen of these.
///
/// # Errors
///
/// [`Error::OutOfRange`], with `expected` in words.
pub(crate) fn check_cells(
    grid: &Grid,
    boundary: Boundary,
    (most, expected): (f64, &'static str),
) -> Result<(), Error> {
    let is_strip = grid.nx() == 1 || grid.ny() == 1;
    if boundary == Boundary::Free || is_strip {
        return Ok(());
    }
    check_periodic_cells(grid, most, expected)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Up to 64 : 1 here, whichever side is the longer one, and any where nothing repeats or there is a single row.
    #[test]
    fn periodic_cells_may_not_be_too_long() -> Result<(), Error> {
        for (nx, ny, dx, boundary, refused) in [
            (4, 3, 64.0, Boundary::Periodic, None),
            (4, 3, 1.0 / 64.0, Boundary::Periodic, None),
            (4, 3, 65.0, Boundary::Periodic, Some(65.0)),
            (4, 3, 1.0 / 128.0, Boundary::Periodic, Some(128.0)),
            (4, 3, 64.0 * (1.0 + 2.0 * f64::EPSILON), Boundary::Periodic, None),
            (4, 3, 1e6, Boundary::Free, None),
            (4, 1, 1e6, Boundary::Periodic, None),
            (1, 3, 1e6, Boundary::Periodic, None),
        ] {
            let grid = Grid::new(nx, ny, dx, 1.0)?;
            let found = check_cells(&grid, boundary, (64.0, "at most 64"));
            let value = match found {
                Ok(()) => None,
                Err(Error::OutOfRange { value, .. }) => Some(value),
                Err(error) => return Err(error),
            };
            assert_eq!(value, refused, "{nx} x {ny}, {dx}");
        }
        Ok(())
    }
}
