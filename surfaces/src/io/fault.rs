//! What can be wrong with the bytes of a file, before the file is named.

use std::io;
use std::path::Path;

use crate::{Error, FileError};

/// Why bytes could not be read as a map of heights.
#[derive(Debug)]
pub(super) enum Fault {
    /// Reading failed.
    Io(io::Error),
    /// The bytes are not what the format asks for.
    Malformed {
        /// Where, in bytes from the start of the file (of the member, in an archive).
        offset: Option<usize>,
        /// What was found, and what was expected.
        reason: String,
    },
    /// What no file can be blamed for alone: a shape that no grid can have, a unit that is missing.
    Refused(Error),
}

impl Fault {
    /// A defect of the file as a whole.
    pub(super) fn malformed(reason: impl Into<String>) -> Self {
        Self::Malformed { offset: None, reason: reason.into() }
    }

    /// A defect at a place in the file.
    pub(super) fn at(offset: usize, reason: impl Into<String>) -> Self {
        Self::Malformed { offset: Some(offset), reason: reason.into() }
    }

    /// The error of the whole operation, which says which file it is about.
    pub(super) fn in_file(self, path: &Path, format: &'static str) -> Error {
        let path = path.to_path_buf();
        match self {
            Self::Io(source) => Error::File(FileError::Io { path, source }),
            Self::Malformed { offset, reason } => {
                Error::File(FileError::BadFile { path, format, offset, reason })
            }
            Self::Refused(error) => error,
        }
    }
}

impl From<io::Error> for Fault {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}
