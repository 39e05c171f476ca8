//! Lines on stdout.

use std::fmt::Arguments;
use std::io::{ErrorKind, Write};
use std::sync::OnceLock;

use crate::outcome::Failure;

/// Why the first line was lost that somebody waits for.
static LOST: OnceLock<ErrorKind> = OnceLock::new();

/// Prints a line. If nobody reads any more (`asperity … | head`), it is lost, and the work goes on; if it cannot be
/// written (a full disk), the work goes on as well, and [`check`] says so at its end.
pub fn print(line: Arguments<'_>) {
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
