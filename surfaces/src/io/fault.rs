//! What can be wrong with the bytes of a file, before the file is named.

use std::io;
use std::path::Path;

use crate::{Error, FileError};

/// A defect of the file as a whole, `fault!("{nx} maps")`, or at a place in it, `fault!(at(12), "{nx} maps")`.
macro_rules! fault {
    (at($offset:expr), $($reason:tt)+) => {
        $crate::io::fault::Fault::Malformed { offset: Some($offset), reason: format!($($reason)+) }
    };
    ($($reason:tt)+) => {
        $crate::io::fault::Fault::Malformed { offset: None, reason: format!($($reason)+) }
    };
}

/// Returns a [`fault!`].
macro_rules! bail {
    ($($fault:tt)+) => { return Err(fault!($($fault)+)) };
}

/// Returns a [`fault!`] unless something holds.
macro_rules! ensure {
    ($holds:expr, $($fault:tt)+) => {
        let holds: bool = $holds;
        if !holds {
            bail!($($fault)+);
        }
    };
}

/// Why bytes could not be read as a map of heights.
#[derive(Debug, thiserror::Error)]
pub(super) enum Fault {
    /// Reading failed.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The bytes are not what the format asks for.
    #[error("{reason}")]
    Malformed {
        /// Where, in bytes from the start of the file (of the member, in an archive).
        offset: Option<usize>,
        /// What was found, and what was expected.
        reason: String,
    },
    /// What no file can be blamed for alone: a shape that no grid can have, a unit that is missing.
    #[error(transparent)]
    Refused(#[from] Error),
}

impl Fault {
    /// The same defect, of some part of the file or with some remark.
    #[cfg(feature = "io")]
    pub(super) fn prefixed(mut self, prefix: &str) -> Self {
        if let Self::Malformed { reason, .. } = &mut self {
            reason.insert_str(0, prefix);
        }
        self
    }

    /// The error of the whole operation, which says which file it is about.
    pub(super) fn in_file(self, path: &Path, format: &'static str) -> Error {
        let path = path.to_path_buf();
        Error::File(match self {
            Self::Io(source) => FileError::Io { path, source },
            Self::Malformed { offset, reason } => {
                FileError::BadFile { path, format, offset, reason: printable(&reason) }
            }
            Self::Refused(error) => return error,
        })
    }
}

/// A text of a file with U+FFFD in place of control characters, which terminals obey, and a blank for a tab.
pub(super) fn printable(text: &str) -> String {
    text.replace('\t', " ").replace(char::is_control, "\u{fffd}")
}
