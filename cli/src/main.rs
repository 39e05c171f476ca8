//! The program `asperity`: contacts of rough surfaces on the command line.

mod adhesion;
mod advice;
mod at;
mod columns;
mod conduction;
mod contact_map;
mod creep;
mod earlier;
mod elasticity;
mod ensemble;
mod formats;
mod gather;
mod hardness;
mod history_table;
mod info;
mod layers;
mod leak;
mod lists;
mod load;
mod material;
mod passages;
mod patches;
mod path;
mod physics;
mod reading;
mod report;
mod resolution;
mod room;
mod settings;
mod shell;
mod slip;
mod state_table;
mod stress;
mod tips;
mod values;

use std::ffi::OsString;
use std::process::ExitCode;

use asperity_cli::chart_format::{self, ChartFormat};
use asperity_cli::outcome::Failure;
use asperity_cli::units::{self, Units};
use asperity_cli::{say, speech};
use clap::{ArgMatches, CommandFactory, FromArgMatches, Parser, Subcommand};

/// Elastic contact of rough surfaces by the boundary element method: the whole loading path, event by event, or single
/// loads.
///
/// The model: a rigid rough surface is pressed into an elastic half-space, without friction, and with small slopes,
/// well below 1. Nothing yields, unless a hardness is given, and nothing sticks, unless a work of adhesion is. Two
/// elastic bodies are equivalent to one with the composite modulus E*. The discrete problem has one pressure for each
/// cell of the grid. The program solves it to rounding, or prints the remaining error. `info`, `path`, `load` and
/// `patches` warn if the grid is too coarse for the surface.
///
/// Without a command the program follows the path of a generated surface to 10 % contact, in seconds, as an example.
/// For your own surface: `asperity info FILE`, then `asperity path --surface FILE --material steel`. `asperity path
/// --help` lists the options of that command; the other commands have such a list too.
///
/// Numbers are in SI units, or have a unit: 5MPa, 1.024mm, 250N, 2h, 10%, 60HRC.
#[derive(Debug, Parser)]
#[command(name = "asperity", version, disable_help_subcommand = true, after_help = EXIT_CODES)]
struct Arguments {
    /// Leave out descriptions, tables and progress
    #[arg(short, long, global = true)]
    quiet: bool,

    /// Units of tables, charts and --fe-table; files for programs and --json are in SI units
    #[arg(
        long,
        global = true,
        value_enum,
        ignore_case = true,
        default_value_t,
        hide_possible_values = true,
        value_name = "SI|mm-N-MPa"
    )]
    units: Units,

    /// Format of charts, png or svg [default: svg for loading_curve and unloading, else png]; maps are PNG
    #[arg(long, global = true, value_name = "png|svg", value_parser = ChartFormat::parse)]
    charts: Option<ChartFormat>,

    #[command(subcommand)]
    command: Option<Command>,
}

/// What the program ends with.
const EXIT_CODES: &str = "Exit codes: 0: done; 1: an error, and what was computed before it is written; 2: arguments that cannot be read; \
    130: a path interrupted by Ctrl-C or SIGTERM; while it adds states, those so far are saved; of --seeds the finished \
    paths stay, and the one in work begins anew.";

#[derive(Debug, Subcommand)]
enum Command {
    Path(Box<path::Options>),
    Load(Box<load::Options>),
    Info(info::Options),
    Formats(formats::Options),
    Gather(gather::Options),
    Report(report::Options),
    Patches(patches::Options),
    Slip(slip::Options),
    Leak(leak::Options),
    Stress(stress::Options),
    Creep(creep::Options),
    Completions(shell::Completions),
    Manual(shell::Manual),
}

fn main() -> ExitCode {
    let words = with_negative_values(std::env::args_os());
    let parsed = Arguments::command().try_get_matches_from(words).and_then(|given| {
        let arguments = Arguments::from_arg_matches(&given)?;
        lists::check(Arguments::command(), &given)?;
        Ok((given, arguments))
    });
    let (given, arguments) = parsed.unwrap_or_else(|error| {
        if let Some(sentence) = physics::left_out(&error).or_else(|| tips::of(&error)) {
            eprint!("{sentence}");
            std::process::exit(2);
        }
        error.exit()
    });
    if arguments.quiet {
        speech::be_quiet();
    }
    units::choose(arguments.units);
    arguments.charts.into_iter().for_each(chart_format::choose);
    let done = match arguments.command {
        None => example(&given),
        Some(Command::Path(options)) => {
            path::run(&options, given.subcommand_matches("path").unwrap_or(&given))
        }
        Some(Command::Load(options)) => load::run(&options),
        Some(Command::Info(options)) => info::run(&options),
        Some(Command::Formats(options)) => formats::run(&options),
        Some(Command::Gather(options)) => gather::run(&options),
        Some(Command::Report(options)) => report::run(&options),
        Some(Command::Patches(options)) => patches::run(&options),
        Some(Command::Slip(options)) => slip::run(&options),
        Some(Command::Leak(options)) => leak::run(&options),
        Some(Command::Stress(options)) => stress::run(&options),
        Some(Command::Creep(options)) => creep::run(&options),
        Some(Command::Completions(options)) => options.print(Arguments::command()),
        Some(Command::Manual(options)) => options.print(Arguments::command()),
    };
    match done.and_then(|()| speech::check()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.report();
            ExitCode::from(failure.code())
        }
    }
}

/// The words of a command line, `--side -1mm` as `--side=-1mm`: a number is the value of the option before it.
fn with_negative_values(words: impl Iterator<Item = OsString>) -> Vec<OsString> {
    let mut kept: Vec<OsString> = Vec::new();
    for word in words {
        let is_negative = matches!(word.as_encoded_bytes(), [b'-', b'.' | b'0'..=b'9', ..]);
        let awaits_value = |last: &&mut OsString| {
            let last = last.as_encoded_bytes();
            last.len() > 2 && last.starts_with(b"--") && !last.contains(&b'=')
        };
        match kept.last_mut().filter(|last| is_negative && awaits_value(last)) {
            Some(option) => {
                option.push("=");
                option.push(word);
            }
            None => kept.push(word),
        }
    }
    kept
}

/// The main job on a generated surface, and what to do next.
fn example(given: &ArgMatches) -> Result<(), Failure> {
    path::run(&path::Options::parse_from(["asperity path", "--report"]), given)?;
    say!(
        "\nnext: `asperity info FILE` describes your surface; `asperity path --help` lists the options of this command"
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }

    /// A heading stands above all options behind it that name no other. What is asked for most stands above all headings.
    #[test]
    fn main_options_are_under_no_heading() {
        let arguments = Arguments::command();
        for (command, options) in [
            (
                "path",
                &["surface", "material", "periodic", "at", "mean-pressure", "report", "out"][..],
            ),
            ("load", &["surface", "material", "periodic", "at", "load", "mean-pressure", "out"]),
        ] {
            let command = arguments.find_subcommand(command);
            let of = |option| {
                command?
                    .get_arguments()
                    .find(|arg| arg.get_long() == Some(option))?
                    .get_help_heading()
            };
            for option in options {
                assert_eq!(of(option), None, "{option}");
            }
            assert_eq!(of("resistivity"), Some("Joint"));
        }
    }

    #[test]
    fn the_path_needs_no_options() {
        assert!(path::Options::try_parse_from(["asperity path"]).is_ok());
    }
}
