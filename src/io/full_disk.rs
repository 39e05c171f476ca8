//! Outputs on which there is no room, for tests of everything that writes.

use std::io::{Cursor, ErrorKind, Result, Seek, SeekFrom, Write};
use std::path::Path;

use nalgebra::DMatrix;

use super::{gsf, npy, vti, x3p};
use crate::{Error, Grid};

/// Takes a number of bytes, and then no more.
pub(crate) struct FullDisk {
    held: Cursor<Vec<u8>>,
    room: usize,
}

impl Write for FullDisk {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        if self.room == 0 && !bytes.is_empty() {
            return Err(ErrorKind::StorageFull.into());
        }
        let taken = self.held.write(&bytes[..bytes.len().min(self.room)])?;
        self.room -= taken;
        Ok(taken)
    }

    fn flush(&mut self) -> Result<()> {
        Ok(())
    }
}

impl Seek for FullDisk {
    fn seek(&mut self, to: SeekFrom) -> Result<u64> {
        self.held.seek(to)
    }
}

/// Whatever the room, down to nothing: what does not fit is refused by the writer, and what was written of it by the
/// reader. All of it fits into as much as it takes.
pub(crate) fn is_refused_at_every_byte(
    write: impl Fn(&mut FullDisk) -> Result<()>,
    mut reads: impl FnMut(&[u8]) -> bool,
) -> Result<()> {
    let mut disk = |room: usize| {
        let held = Cursor::new(Vec::new());
        let mut disk = FullDisk { held, room };
        let written = write(&mut disk);
        (written, reads(disk.held.get_ref()), disk.room)
    };
    let (written, is_read, left) = disk(usize::MAX);
    written?;
    assert!(is_read);
    let taken = usize::MAX - left;
    for room in 0..taken {
        let (written, is_read, _) = disk(room);
        let refused = written.is_err_and(|error| error.kind() == ErrorKind::StorageFull);
        assert!(refused, "{room} of {taken} bytes, and no error");
        assert!(!is_read, "{room} of {taken} bytes are read");
    }
    let (written, is_read, _) = disk(taken);
    written?;
    assert!(is_read);
    Ok(())
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
