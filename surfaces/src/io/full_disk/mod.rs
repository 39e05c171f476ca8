//! Outputs on which there is no room, for tests of everything that writes.

mod disk;

use std::io::ErrorKind;
use std::path::Path;

use nalgebra::DMatrix;

use self::disk::is_refused_at_every_byte;
use super::{gsf, npy, vti, x3p};
use crate::{Error, Grid};

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

/// The same of the functions that take a path: the error names the file and the cause, and the device is still one.
#[cfg(target_os = "linux")]
#[test]
fn files_on_a_full_device() -> std::result::Result<(), Box<dyn std::error::Error>> {
    use std::os::unix::fs::FileTypeExt;

    let grid = Grid::new(4, 3, 2e-6, 3e-6)?;
    let field = DMatrix::zeros(4, 3);
    let full = Path::new("/dev/full");
    for written in [
        npy::write_npy(full, &field),
        gsf::write_gsf(full, &grid, &field, "m"),
        x3p::write_x3p(full, &grid, &field),
        vti::write_vti(full, &grid, &[("gap", &field)]),
    ] {
        let is_full = |source: &std::io::Error| source.kind() == ErrorKind::StorageFull;
        let Err(Error::File(crate::FileError::Io { path, source })) = written else {
            return Err("no error, or another one".into());
        };
        assert!(path == full && is_full(&source), "{source}");
        assert!(std::fs::metadata(full)?.file_type().is_char_device());
    }
    Ok(())
}
