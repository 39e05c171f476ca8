//! What can be wrong with the bytes of a `.npy` file, before the file is named.

use std::io;
use std::path::Path;

use crate::Error;

/// Why bytes could not be read as a matrix.
#[derive(Debug)]
pub(super) enum Fault {
    /// Reading failed.
    Io(io::Error),
    /// The bytes are not those of a matrix of floating-point numbers.
    Malformed(String),
    /// The matrix is one that no [`Grid`](crate::Grid) can hold.
    Shape(Error),
}

impl Fault {
    pub(super) fn malformed(reason: impl Into<String>) -> Self {
        Self::Malformed(reason.into())
    }

    /// The error of the whole operation, which says which file it is about.
    pub(super) fn in_file(self, path: &Path) -> Error {
        let path = path.to_path_buf();
        match self {
            Self::Io(source) => Error::Io { path, source },
            Self::Malformed(reason) => Error::BadNpy { path, reason },
            Self::Shape(error) => error,
        }
    }
}

impl From<io::Error> for Fault {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}
