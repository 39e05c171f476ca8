//! Files for readers that open what has a name.

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::verdict::Violation;

/// Where Linux has files in memory: writers wait until what they have written has reached its place.
const IN_MEMORY: &str = "/dev/shm";

/// A folder that is removed with all that is in it.
pub(crate) struct Scratch(TempDir);

impl Scratch {
    pub(crate) fn new() -> Result<Self, Violation> {
        let in_memory = Path::new(IN_MEMORY);
        let folder = match in_memory.is_dir() {
            true => tempfile::tempdir_in(in_memory).or_else(|_| tempfile::tempdir()),
            false => tempfile::tempdir(),
        };
        folder.map(Self).map_err(|error| Violation::new(format!("no folder for files: {error}")))
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
