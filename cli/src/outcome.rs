//! What went wrong, and what was written nevertheless.

use std::error::Error;
use std::io::Write;
use std::path::{Path, PathBuf};

use asperity::io::write_whole;

use crate::say;

/// An error with what could not be done because of it.
pub struct Failure {
    what: String,
    source: Option<Box<dyn Error>>,
}

impl Failure {
    /// Something that failed because of an error.
    pub fn new(what: impl Into<String>, source: impl Into<Box<dyn Error>>) -> Self {
        Self {
            what: what.into(),
            source: Some(source.into()),
        }
    }

    /// That a file cannot be written.
    pub fn writing(name: &Path, source: impl Into<Box<dyn Error>>) -> Self {
        Self::new(format!("cannot write {}", name.display()), source)
    }

    /// A request that cannot be met.
    pub fn request(what: impl Into<String>) -> Self {
        Self {
            what: what.into(),
            source: None,
        }
    }

    /// Prints the whole chain of causes on stderr.
    pub fn report(&self) {
        eprintln!("error: {}", self.what);
        let mut said = String::new();
        let mut cause: Option<&dyn Error> = self.source.as_deref();
        while let Some(error) = cause {
            let text = error.to_string();
            // Some errors quote their causes.
            if !said.ends_with(&text) {
                eprintln!("  because: {text}");
            }
            said = text;
            cause = error.source();
        }
    }
}

/// Writes a file that is whole once it has its name.
///
/// # Errors
///
/// If it cannot be written.
pub fn write(name: &Path, bytes: impl AsRef<[u8]>) -> Result<PathBuf, Failure> {
    write_whole(name, |output| output.write_all(bytes.as_ref()))
        .map(|()| name.to_path_buf())
        .map_err(|error| Failure::writing(name, error))
}

/// Collects failures and the names of the files that were written.
#[derive(Default)]
pub struct Outcome {
    failures: Vec<Failure>,
    files: Vec<PathBuf>,
}

impl Outcome {
    /// Keeps a failure for the end.
    pub fn note(&mut self, result: Result<(), Failure>) {
        self.failures.extend(result.err());
    }

    /// Keeps the name of a file, or the failure to write it.
    pub fn written(&mut self, result: Result<PathBuf, Failure>) {
        match result {
            Ok(file) => self.files.push(file),
            Err(failure) => self.failures.push(failure),
        }
    }

    /// Keeps the names of files, or the failure to write them.
    pub fn all_written(&mut self, result: Result<Vec<PathBuf>, Failure>) {
        match result {
            Ok(files) => self.files.extend(files),
            Err(failure) => self.failures.push(failure),
        }
    }

    /// Prints the files; reports all failures but the first, which it returns.
    pub fn finish(self) -> Result<(), Failure> {
        say!();
        for file in &self.files {
            say!("wrote {}", file.display());
        }
        self.finish_quietly()
    }

    /// The same where stdout is for programs.
    pub fn finish_on_stderr(self) -> Result<(), Failure> {
        for file in &self.files {
            eprintln!("wrote {}", file.display());
        }
        self.finish_quietly()
    }

    /// Reports all failures but the first, which it returns.
    pub fn finish_quietly(self) -> Result<(), Failure> {
        let mut failures = self.failures.into_iter();
        let first = failures.next();
        failures.for_each(|failure| failure.report());
        first.map_or(Ok(()), Err)
    }
}
