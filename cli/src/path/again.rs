//! The command that goes on with an interrupted path.

use std::path::Path;

use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, CommandFactory};

use super::Options;
use crate::shell::quoted;

/// The words of a command that continues the path of a record with all options that were given, but for those that the
/// record knows.
pub(super) fn command(record: &Path, given: &ArgMatches) -> String {
    let mut command = Options::command();
    command.build();
    let mut words = format!("asperity path --resume {}", quoted(record.as_os_str()));
    let Some(resume) = command.get_arguments().find(|arg| arg.get_id() == "resume") else {
        return words;
    };
    let known = command.get_arg_conflicts_with(resume);
    let is_known = |arg: &Arg| {
        let is_record = ["resume", "record"].contains(&arg.get_id().as_str());
        is_record || known.iter().any(|other| other.get_id() == arg.get_id())
    };
    let is_given = |id: &str| {
        given.try_contains_id(id).is_ok_and(|is| is)
            && given.value_source(id) == Some(ValueSource::CommandLine)
    };
    for arg in command.get_arguments().filter(|arg| !is_known(arg)) {
        let id = arg.get_id().as_str();
        let (Some(name), true) = (arg.get_long(), is_given(id)) else { continue };
        if !arg.get_action().takes_values() {
            words += &format!(" --{name}");
            continue;
        }
        let delimiter = arg.get_value_delimiter().map_or_else(String::new, String::from);
        for values in given.get_raw_occurrences(id).into_iter().flatten() {
            let values: Vec<String> = values.map(quoted).collect();
            words += &format!(" --{name} {}", values.join(&delimiter));
        }
    }
    // Options of all commands, which are not among those of this one.
    for name in ["units", "charts"] {
        if is_given(name) {
            for value in given.get_raw(name).into_iter().flatten() {
                words += &format!(" --{name} {}", quoted(value));
            }
        }
    }
    if is_given("quiet") {
        words += " --quiet";
    }
    words
}
