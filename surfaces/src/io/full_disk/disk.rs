//! An output with room for so many bytes. Tests of records in `asperity` include this file.

use std::io::{Cursor, ErrorKind, Result, Seek, SeekFrom, Write};

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
