//! Outputs on which there is no room, for tests of everything that writes.

use std::io::{Cursor, ErrorKind, Result};

use nalgebra::DMatrix;

use super::{gsf, npy, vti, x3p};
use crate::Grid;

/// Whatever the room, from nothing on: what does not fit is refused by the writer, and what was written of it by the
/// reader. All of it fits into as much as it takes.
fn is_refused_at_every_byte(
    write: impl Fn(&mut Cursor<&mut [u8]>) -> Result<()>,
    reads: impl Fn(&[u8]) -> bool,
) -> Result<()> {
    for room in 0..1 << 16 {
        let mut disk = vec![0; room];
        match write(&mut Cursor::new(&mut disk[..])) {
            Ok(()) => {
                assert!(room > 0 && reads(&disk), "{room} bytes are not read");
                return Ok(());
            }
            Err(error) if error.kind() == ErrorKind::WriteZero => {
                assert!(!reads(&disk), "{room} bytes are read, but more was written");
            }
            Err(error) => return Err(error),
        }
    }
    Err(ErrorKind::StorageFull.into())
}

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
