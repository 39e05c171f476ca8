//! Files for readers that open what has a name.

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::verdict::Violation;

/// A folder that is removed with all that is in it. `TMPDIR` says where; in memory it is fastest.
pub(crate) struct Scratch(TempDir);

impl Scratch {
    pub(crate) fn new() -> Result<Self, Violation> {
        tempfile::tempdir()
            .map(Self)
            .map_err(|error| Violation::new(format!("no folder for files: {error}")))
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// A file of these bytes.
    pub(crate) fn file(&self, name: &str, bytes: &[u8]) -> Result<PathBuf, Violation> {
        let path = self.path(name);
        match fs::write(&path, bytes) {
            Ok(()) => Ok(path),
            Err(error) => Err(Violation::new(format!("{}: {error}", path.display()))),
        }
    }
}

/// The bytes of a file.
pub(crate) fn bytes_of(path: &Path) -> Result<Vec<u8>, Violation> {
    fs::read(path).map_err(|error| Violation::new(format!("{}: {error}", path.display())))
}
