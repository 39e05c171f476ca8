//! The file behind an archive.

use std::io::{Error, ErrorKind, Result, Seek, SeekFrom, Write};

/// An output that keeps quiet once it has failed, and goes on as if all was written: an archive that is dropped
/// unfinished would try to end itself, and complain on stderr. The failure is told once more at the end.
pub(super) struct Output<W> {
    inner: W,
    failure: Option<ErrorKind>,
    /// Where the next byte goes, and how many there are.
    at: u64,
    end: u64,
}

impl<W> Output<W> {
    pub(super) fn new(inner: W) -> Self {
        Self { inner, failure: None, at: 0, end: 0 }
    }

    /// The outcome of some work on the output, unless it has failed before; then `otherwise`.
    fn attempt<T>(&mut self, otherwise: T, work: impl FnOnce(&mut W) -> Result<T>) -> Result<T> {
        if self.failure.is_some() {
            return Ok(otherwise);
        }
        let done = work(&mut self.inner);
        // What is interrupted is tried again.
        if let Err(error) = &done
            && error.kind() != ErrorKind::Interrupted
        {
            self.failure = Some(error.kind());
            // It may have been back in a header, before what an archive takes for the place where its members end.
            self.at = self.end;
        }
        done
    }
}

impl<W: Write> Output<W> {
    /// Writes what is still in a buffer: `Ok` if nothing has failed.
    pub(super) fn finish(mut self) -> Result<()> {
        self.flush()?;
        self.failure.map_or(Ok(()), |kind| Err(Error::from(kind)))
    }
}

impl<W: Write> Write for Output<W> {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        let written = self.attempt(bytes.len(), |inner| match inner.write(bytes)? {
            // Nothing is taken any more: a failure too.
            0 if !bytes.is_empty() => Err(ErrorKind::WriteZero.into()),
            taken => Ok(taken),
        })?;
        self.at += written as u64;
        self.end = self.end.max(self.at);
        Ok(written)
    }

    fn flush(&mut self) -> Result<()> {
        self.attempt((), Write::flush)
    }
}

impl<W: Seek> Seek for Output<W> {
    fn seek(&mut self, to: SeekFrom) -> Result<u64> {
        let place = match to {
            SeekFrom::Start(place) => place,
            SeekFrom::Current(change) => self.at.saturating_add_signed(change),
            SeekFrom::End(change) => self.end.saturating_add_signed(change),
        };
        self.at = self.attempt(place, |inner| inner.seek(to))?;
        Ok(self.at)
    }
}
