//! Files that are whole once they have their name.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::outcome::Failure;

/// Writes a file under another name beside its place, and then gives it its own: a full disk or a killed process leaves no
/// part of it that looks like the whole.
pub fn write(name: &Path, bytes: impl AsRef<[u8]>) -> Result<PathBuf, Failure> {
    let mut part = name.as_os_str().to_os_string();
    part.push(".part");
    let part = PathBuf::from(part);
    let written = File::create(&part)
        .and_then(|mut file| file.write_all(bytes.as_ref()))
        .and_then(|()| fs::rename(&part, name));
    match written {
        Ok(()) => Ok(name.to_path_buf()),
        Err(error) => {
            // It may not even be there.
            let _ = fs::remove_file(&part);
            Err(failed(name, error))
        }
    }
}

/// That a file cannot be written.
pub fn failed(name: &Path, error: io::Error) -> Failure {
    Failure::new(format!("cannot write {}", name.display()), error)
}
