//! What went wrong, and what was written nevertheless.

use std::error::Error;
use std::io::Write;
use std::path::{Path, PathBuf};

use asperity::io::write_whole;
use asperity::{FileError, SurfaceError};

use crate::{note, say};

/// An error with what could not be done because of it.
pub struct Failure {
    what: String,
    source: Option<Box<dyn Error>>,
    code: u8,
}

impl Failure {
    /// Something that failed because of an error.
    pub fn new(what: impl Into<String>, source: impl Into<Box<dyn Error>>) -> Self {
        Self { what: what.into(), source: Some(source.into()), code: 1 }
    }

    /// That a file cannot be written.
    pub fn writing(name: &Path, source: impl Into<Box<dyn Error>>) -> Self {
        Self::new(format!("cannot write {}", name.display()), source)
    }

    /// A request that cannot be met.
    pub fn request(what: impl Into<String>) -> Self {
        Self::with_code(what, 1)
    }

    /// An end that has an exit code of its own.
    pub fn with_code(what: impl Into<String>, code: u8) -> Self {
        Self { what: what.into(), source: None, code }
    }

    /// The same, with what can be done.
    #[must_use]
    pub fn with_advice(mut self, advice: &str) -> Self {
        self.what = format!("{}; {advice}", self.what);
        self
    }

    /// What the program ends with.
    pub fn code(&self) -> u8 {
        self.code
    }

    /// Prints the whole chain of causes on stderr.
    pub fn report(&self) {
        match self.code {
            1 => eprintln!("error: {}", self.what),
            // Not an error, but what was asked for.
            _ => eprintln!("{}", self.what),
        }
        let mut said = String::new();
        let mut cause: Option<&dyn Error> = self.source.as_deref();
        while let Some(error) = cause {
            let text = error.to_string();
            // Some errors quote their causes.
            if !said.ends_with(&text) {
                match option(error) {
                    Some(option) => eprintln!("  because: {text} (`{option}`)"),
                    None => eprintln!("  because: {text}"),
                }
            }
            said = text;
            cause = error.source();
        }
    }
}

/// The option of the command line that supplies what an error says is not there.
fn option(error: &(dyn Error + 'static)) -> Option<&'static str> {
    let error = match error.downcast_ref() {
        Some(asperity::Error::Surface(error)) => Some(error),
        _ => error.downcast_ref(),
    };
    match error? {
        SurfaceError::HeightNotFinite { .. } => Some("--fill"),
        SurfaceError::File(FileError::NoSide) => Some("--side"),
        SurfaceError::File(FileError::WhichChannel { wanted: None, .. }) => Some("--channel"),
        SurfaceError::File(FileError::NoUnit { quantity, .. }) => Some(match *quantity {
            "heights" => "--height-unit",
            _ => "--lateral-unit",
        }),
        _ => None,
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

/// `Ok` if a file can be written: before the work whose result it is to hold. What is there stays as it is.
///
/// # Errors
///
/// If it cannot be written.
pub fn check_place(name: &Path) -> Result<(), Failure> {
    let failed = |error| Failure::writing(name, error);
    if name.is_dir() {
        return Err(failed(std::io::ErrorKind::IsADirectory.into()));
    }
    if name.exists() && !name.is_file() {
        // A device is written to as it is.
        return Ok(());
    }
    // As it will be written: beside its place.
    let place = name.canonicalize().unwrap_or_else(|_| name.to_path_buf());
    let mut probe = place.file_name().unwrap_or_default().to_os_string();
    probe.push(format!(".{}.probe", std::process::id()));
    let probe = place.with_file_name(probe);
    std::fs::File::create(&probe).and_then(|_| std::fs::remove_file(&probe)).map_err(failed)
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

    /// Prints the files, unless people want none; reports all failures but the first, which it returns.
    pub fn finish(self) -> Result<(), Failure> {
        say!();
        // What shows all of it comes first.
        let is_page = |file: &&PathBuf| file.extension().is_some_and(|end| end == "html");
        let (pages, others): (Vec<_>, Vec<_>) = self.files.iter().partition(is_page);
        for file in pages.into_iter().chain(others) {
            say!("wrote {}", file.display());
        }
        self.finish_quietly()
    }

    /// The same where stdout is for programs.
    pub fn finish_on_stderr(self) -> Result<(), Failure> {
        for file in &self.files {
            note!("wrote {}", file.display());
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Whatever is not in a file has an option, also where it comes out of the solver's crate; nothing else has.
    #[test]
    fn what_is_not_there_has_an_option() {
        let no_unit = |quantity| FileError::NoUnit {
            path: PathBuf::new(),
            quantity,
            found: None,
            option: "",
        };
        let which = |wanted: Option<&str>| FileError::WhichChannel {
            path: PathBuf::new(),
            wanted: wanted.map(str::to_string),
            channels: Vec::new(),
        };
        let missing = || SurfaceError::HeightNotFinite { ix: 0, iy: 0, value: f64::NAN, count: 1 };
        for (error, expected) in [
            (missing(), Some("--fill")),
            (FileError::NoSide.into(), Some("--side")),
            (no_unit("heights").into(), Some("--height-unit")),
            (no_unit("lengths along x and y").into(), Some("--lateral-unit")),
            (which(None).into(), Some("--channel")),
            (which(Some("Height")).into(), None),
            (SurfaceError::EmptyGrid { nx: 0, ny: 1 }, None),
        ] {
            assert_eq!(option(&error), expected, "{error}");
        }
        let of_solver = asperity::Error::from(missing());
        assert_eq!(option(&of_solver), Some("--fill"));
        assert_eq!(option(&asperity::Error::ForeignKernel), None);
        assert_eq!(option(&std::io::Error::from(std::io::ErrorKind::NotFound)), None);
    }
}
