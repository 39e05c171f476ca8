//! Lines on stdout and stderr, for people and for programs.

use std::fmt::{Arguments, Display};
use std::io::{ErrorKind, Write};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::outcome::Failure;

/// Why the first line was lost that somebody waits for.
static LOST: OnceLock<ErrorKind> = OnceLock::new();

/// Whether people want to read nothing but warnings and errors.
static QUIET: AtomicBool = AtomicBool::new(false);

/// From here on only answers for programs, warnings and errors are printed.
pub fn be_quiet() {
    QUIET.store(true, Ordering::Relaxed);
}

/// Whether descriptions and progress are left out.
pub fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// Prints a line for people, unless they [want none](be_quiet).
pub fn print(line: Arguments<'_>) {
    if !is_quiet() {
        answer(line);
    }
}

/// Prints a line for people on stderr, unless they [want none](be_quiet).
pub fn note(line: Arguments<'_>) {
    if !is_quiet() {
        eprintln!("{line}");
    }
}

/// Prints a warning: among the lines for people, or on stderr if they [want none](be_quiet).
pub fn warn(warning: impl Display) {
    match is_quiet() {
        true => eprintln!("warning: {warning}"),
        false => answer(format_args!("warning: {warning}")),
    }
}

/// Prints a line for programs. If nobody reads any more (`asperity … | head`), it is lost, and the work goes on; if it
/// cannot be written (a full disk), the work goes on as well, and [`check`] says so at its end.
pub fn answer(line: Arguments<'_>) {
    let written = writeln!(std::io::stdout(), "{line}");
    if let Err(error) = written
        && error.kind() != ErrorKind::BrokenPipe
    {
        // One is enough.
        let _ = LOST.set(error.kind());
    }
}

/// `Ok` if all lines were written for which there is a reader.
pub fn check() -> Result<(), Failure> {
    match LOST.get() {
        None => Ok(()),
        Some(kind) => Err(Failure::new("cannot write to stdout", std::io::Error::from(*kind))),
    }
}
