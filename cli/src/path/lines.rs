//! A table that is written line by line, as a path is followed.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use asperity_cli::outcome::Failure;

/// Lines between two visits to the disk.
pub(super) const STRIDE: usize = 64;

/// A file of lines. Until its path has ended its name ends with `.part`, and what it holds are whole lines.
pub(super) struct Lines {
    name: PathBuf,
    part: PathBuf,
    output: File,
    /// Lines that are not in the file yet, and their number.
    text: String,
    waiting: usize,
}

impl Lines {
    /// Begins the file `path.csv` in a directory, in place of one that may be there from another path.
    pub(super) fn create(directory: &Path, header: &str) -> Result<Self, Failure> {
        let (name, part) = (directory.join("path.csv"), directory.join("path.csv.part"));
        let begin = || {
            let output = OpenOptions::new().write(true).create(true).truncate(false).open(&part)?;
            // On Windows nobody else could read what is locked. Where there are no locks nothing is refused.
            if cfg!(unix) && matches!(output.try_lock(), Err(TryLockError::WouldBlock)) {
                return Err(std::io::Error::new(
                    ErrorKind::ResourceBusy,
                    "another run is writing into this folder: give another --out",
                ));
            }
            output.set_len(0)?;
            match fs::remove_file(&name) {
                Err(error) if error.kind() != ErrorKind::NotFound => Err(error),
                _ => Ok(output),
            }
        };
        let output = begin().map_err(|error| Failure::writing(&part, error))?;
        Ok(Self { name, part, output, text: format!("{header}\n"), waiting: 0 })
    }

    /// The name while it is written.
    pub(super) fn part(&self) -> &Path {
        &self.part
    }

    /// Adds a line.
    pub(super) fn add(&mut self, line: &str) -> Result<(), Failure> {
        self.text += line;
        self.text.push('\n');
        self.waiting += 1;
        if self.waiting == STRIDE {
            self.flush().map_err(|error| Failure::writing(&self.part, error))?;
        }
        Ok(())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.output.write_all(self.text.as_bytes())?;
        self.text.clear();
        self.waiting = 0;
        Ok(())
    }

    /// Ends the file, and gives it its name if it is that of a whole path.
    pub(super) fn finish(mut self, is_whole: bool) -> Result<PathBuf, Failure> {
        let written = self.flush().and_then(|()| match is_whole {
            true => fs::rename(&self.part, &self.name),
            false => Ok(()),
        });
        written.map_err(|error| Failure::writing(&self.part, error))?;
        Ok(if is_whole { self.name } else { self.part })
    }
}

/// A number, or nothing where there is none: the stiffness of a contact on a periodic half-space.
pub(super) fn printed(number: Option<f64>) -> String {
    number.map_or_else(String::new, |number| format!("{number:e}"))
}
