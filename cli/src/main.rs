//! The program `asperity`: contacts of rough surfaces on the command line.

mod elasticity;
mod ensemble;
mod gather;
mod info;
mod load;
mod patches;
mod path;
mod physics;
mod reading;
mod room;
mod settings;
mod values;

use std::process::ExitCode;

use asperity_cli::speech;
use clap::{Parser, Subcommand};

/// Exact elastic contact of rough surfaces.
///
/// Without a command, `path` of a generated surface: the whole loading to 10 % contact, in seconds.
/// `asperity path --help`, and the same of every other command, lists its options.
#[derive(Debug, Parser)]
#[command(name = "asperity", version, disable_help_subcommand = true)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    Path(path::Options),
    Load(load::Options),
    Info(info::Options),
    Gather(gather::Options),
    Patches(patches::Options),
}

fn main() -> ExitCode {
    let arguments = Arguments::try_parse().unwrap_or_else(|error| {
        if let Some(sentence) = physics::left_out(&error) {
            eprint!("{sentence}");
            std::process::exit(2);
        }
        error.exit()
    });
    let done = match arguments.command {
        None => path::run(&path::Options::parse_from(["asperity path"])),
        Some(Command::Path(options)) => path::run(&options),
        Some(Command::Load(options)) => load::run(&options),
        Some(Command::Info(options)) => info::run(&options),
        Some(Command::Gather(options)) => gather::run(&options),
        Some(Command::Patches(options)) => patches::run(&options),
    };
    match done.and_then(|()| speech::check()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.report();
            ExitCode::from(failure.code())
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn the_path_needs_no_options() {
        assert!(path::Options::try_parse_from(["asperity path"]).is_ok());
    }
}
