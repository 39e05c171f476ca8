//! The main function of a study.

use std::process::ExitCode;

use asperity_cli::outcome::Failure;
use clap::Parser;

/// Reads the options, runs a study, and says what went wrong.
pub fn main<O: Parser>(run: impl FnOnce(&O) -> Result<(), Failure>) -> ExitCode {
    match run(&O::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.report();
            ExitCode::FAILURE
        }
    }
}
