//! The program `asperity`: contacts of rough surfaces on the command line.

mod advice;
mod columns;
mod contact_map;
mod elasticity;
mod ensemble;
mod gather;
mod hardness;
mod info;
mod layers;
mod load;
mod patches;
mod path;
mod physics;
mod reading;
mod resolution;
mod room;
mod settings;
mod values;

use std::process::ExitCode;

use asperity_cli::speech;
use clap::{Parser, Subcommand};

/// Elastic contact of rough surfaces by the boundary element method: the whole loading path, event by event, or single loads.
///
/// The model: a rigid rough surface is pressed into an elastic half-space, without friction and adhesion, and with
/// slopes well below 1. Nothing yields, unless a hardness is given. Two elastic bodies are equivalent to one with the composite modulus E*. The discrete problem has one
/// pressure for each cell of the grid. The program solves it to rounding, or prints the remaining error. Every command warns if
/// the grid is too coarse for the surface.
///
/// Without a command the program follows the path of a generated surface to 10 % contact, in seconds, as an example. For your
/// own surface: `asperity info FILE`, then `asperity path --surface FILE --material steel`. `asperity path --help` lists
/// the options of that command; the other commands have such a list too. All numbers are in SI units.
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
