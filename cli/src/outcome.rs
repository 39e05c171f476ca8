//! What went wrong, and what was written nevertheless.

use std::borrow::Cow;
use std::error::Error;
use std::io::Write;
use std::path::{Path, PathBuf};

use asperity::io::write_whole;

use crate::say;

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
            let text = of_program(&error.to_string());
            // Some errors quote their causes.
            if !said.ends_with(&text) {
                eprintln!("  because: {}", without_name(&text, &self.what));
            }
            said = text;
            cause = error.source();
        }
    }
}

/// Words of the library in those of the command line.
#[must_use]
pub fn of_program(text: &str) -> String {
    const WORDS: [(&str, &str); 9] = [
        ("`surface::fill_missing`", "`--fill`"),
        ("`ReadOptions::height_unit`", "`--height-unit`"),
        ("`ReadOptions::lateral_unit`", "`--lateral-unit`"),
        ("`ReadOptions::side`", "`--side`"),
        ("`ReadOptions::channel`", "`--channel`"),
        ("`ReadOptions::layout`", "`--layout`"),
        ("`ReadOptions::rows_are_y`", "`--rows-are-y`"),
        ("`Topography::level`", "`--level plane`"),
        ("`AdhesiveRecord` reads it", "`asperity path --resume` goes on with it"),
    ];
    WORDS.iter().fold(text.to_string(), |text, (rust, option)| text.replace(rust, option))
}

/// A cause that begins with the name of a file, without it where what failed has named the file already.
fn without_name<'a>(cause: &'a str, what: &str) -> Cow<'a, str> {
    let is_named = |name: &str| !name.is_empty() && what.ends_with(&format!(" {name}"));
    match (cause.split_once(": "), cause.split_once(" is ")) {
        (Some((name, rest)), _) if is_named(name) => rest.into(),
        (_, Some((name, rest))) if is_named(name) => format!("it is {rest}").into(),
        _ => cause.into(),
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

/// Whether a name is of something else than a file.
#[must_use]
pub fn is_device(name: &Path) -> bool {
    name.exists() && !name.is_file()
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
    if is_device(name) {
        // It is written to as it is.
        return Ok(());
    }
    // As it will be written: beside its place.
    let place = name.canonicalize().unwrap_or_else(|_| name.to_path_buf());
    let mut probe = place.file_name().unwrap_or_default().to_os_string();
    probe.push(format!(".{}.probe", std::process::id()));
    let probe = place.with_file_name(probe);
    std::fs::File::create(&probe).and_then(|_| std::fs::remove_file(&probe)).map_err(failed)
}

/// Where files are written: into the folder that is given, or `out`; nowhere if a program asks for an object alone.
#[must_use]
pub fn directory(given: Option<&Path>, json: bool) -> Option<&Path> {
    given.or_else(|| (!json).then(|| Path::new("out")))
}

/// Makes a folder for files unless it is there.
///
/// # Errors
///
/// If it cannot be made.
pub fn create_folder(folder: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(folder)
        .map_err(|error| Failure::new(format!("cannot create {}", folder.display()), error))
}

/// Whether two names are of one file that is there.
#[must_use]
pub fn is_same(one: &Path, other: &Path) -> bool {
    match (one.canonicalize(), other.canonicalize()) {
        (Ok(one), Ok(other)) => one == other,
        _ => false,
    }
}

/// `Ok` if a file that is read is none of those that are written into a directory.
///
/// # Errors
///
/// If it would be replaced.
pub fn check_input(
    input: &Path,
    directory: &Path,
    names: &[impl AsRef<Path>],
) -> Result<(), Failure> {
    match names.iter().map(|name| directory.join(name)).find(|file| is_same(file, input)) {
        None => Ok(()),
        Some(_) => Err(Failure::request(format!(
            "{} would be replaced by a file of that name: give another --out",
            input.display()
        ))),
    }
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

    /// The files that were written.
    #[must_use]
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// Keeps the name of a file, or the failure to write it.
    pub fn written(&mut self, result: Result<PathBuf, Failure>) {
        match result {
            Ok(file) => self.files.push(file),
            Err(failure) => self.failures.push(failure),
        }
    }

    /// Keeps the names of files, or the failure to write them.
    pub fn all_written(&mut self, result: Result<impl IntoIterator<Item = PathBuf>, Failure>) {
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
    use asperity::{AdhesionError, FileError, SurfaceError};

    use super::*;

    /// Whatever errors and warnings advise in Rust has an option of the program, and no name of Rust is left.
    #[test]
    fn advice_names_options() {
        let no_unit = |quantity, option| FileError::NoUnit {
            path: PathBuf::new(),
            quantity,
            found: None,
            option,
        };
        let which =
            FileError::WhichChannel { path: PathBuf::new(), wanted: None, channels: Vec::new() };
        let missing = SurfaceError::HeightNotFinite { ix: 0, iy: 0, value: f64::NAN, count: 1 };
        let lateral = "`ReadOptions::lateral_unit` or `ReadOptions::side`";
        let sticks = AdhesionError::Record { path: PathBuf::new() };
        let tilted = asperity::surface::Warning::Tilted { plane: 1e-6, left: 1e-9 };
        for (text, option) in [
            (missing.to_string(), "`--fill`"),
            (FileError::NoSide.to_string(), "`--side`"),
            (no_unit("heights", "`ReadOptions::height_unit`").to_string(), "`--height-unit`"),
            (no_unit("lengths", lateral).to_string(), "`--lateral-unit` or `--side`"),
            (which.to_string(), "`--channel`"),
            (tilted.to_string(), "`--level plane`"),
            (sticks.to_string(), "`asperity path --resume`"),
        ] {
            let told = of_program(&text);
            assert!(told.contains(option), "{told}");
            assert!(!told.contains("::") && !told.contains("AdhesiveRecord"), "{told}");
        }
    }

    #[test]
    fn a_file_is_named_once() {
        let cause = "map.npy: No such file or directory";
        assert_eq!(without_name(cause, "cannot read map.npy"), "No such file or directory");
        assert_eq!(without_name(cause, "cannot read a map.npy of mine"), cause);
        assert_eq!(without_name(cause, "cannot read other-map.npy"), cause);
        assert_eq!(without_name("no colon", "cannot read map.npy"), "no colon");
        assert_eq!(without_name(": nothing", "cannot read "), ": nothing");
    }
}
