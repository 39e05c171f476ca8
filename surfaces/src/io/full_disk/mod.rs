//! Outputs on which there is no room, for tests of everything that writes.

mod disk;

use nalgebra::DMatrix;

use self::disk::is_refused_at_every_byte;
use super::{gsf, npy, vti, x3p};
use crate::Grid;

#[test]
fn fields_do_not_fit() -> std::result::Result<(), Box<dyn std::error::Error>> {
    let grid = Grid::new(4, 3, 2e-6, 3e-6)?;
    let field = DMatrix::from_fn(4, 3, |ix, iy| 0.25 * ix as f64 - iy as f64);
    is_refused_at_every_byte(
        |disk| npy::write(disk, &field),
        |bytes| npy::matrix(bytes).is_ok_and(|read| read == field),
    )?;
    is_refused_at_every_byte(
        |disk| gsf::write(disk, &grid, &field, "m"),
        |bytes| gsf::parse(bytes).is_ok(),
    )?;
    is_refused_at_every_byte(
        |disk| x3p::write(disk, &grid, &field),
        |bytes| x3p::parse(bytes).is_ok(),
    )?;
    // No reader here: an image without its end is no XML.
    is_refused_at_every_byte(
        |disk| vti::write(disk, &grid, &[("gap", &field)]),
        |bytes| bytes.ends_with(b"</VTKFile>\n"),
    )?;
    Ok(())
}
