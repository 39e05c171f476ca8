//! What to type in place of a command line without a command.

use std::path::Path;

use clap::CommandFactory;
use clap::error::{ContextKind, ContextValue, Error, ErrorKind};

use crate::path;

/// For a file where a command is expected, and for an option of `asperity path` before any command.
pub(crate) fn of(error: &Error) -> Option<String> {
    let word = |kind| match error.get(kind) {
        Some(ContextValue::String(word)) => Some(word.as_str()),
        _ => None,
    };
    match error.kind() {
        ErrorKind::InvalidSubcommand => {
            let file = word(ContextKind::InvalidSubcommand)?;
            let is_record = file.ends_with(".npz");
            Path::new(file).is_file().then(|| {
                let tip = if is_record {
                    format!(
                        "`asperity report {file}` shows it, `asperity patches {file}` describes it, and \
                         `asperity path --resume {file}` goes on with it"
                    )
                } else {
                    format!(
                        "`asperity info {file}` describes it, and `asperity path --surface {file} --material steel \
                         --mean-pressure 5MPa` presses it"
                    )
                };
                format!("error: '{file}' is a file, and no command\n\n  tip: {tip}\n")
            })
        }
        ErrorKind::UnknownArgument => {
            let option = word(ContextKind::InvalidArg)?;
            let name = option.strip_prefix("--")?.split([' ', '=']).next()?;
            // Within a command the usage names it.
            let is_before = match error.get(ContextKind::Usage)? {
                ContextValue::StyledStr(usage) => usage.to_string().contains("[COMMAND]"),
                _ => false,
            };
            let command = path::Options::command();
            let is_of_path = command.get_arguments().any(|arg| arg.get_long() == Some(name));
            (is_before && is_of_path).then(|| {
                format!(
                    "error: --{name} belongs to a command\n\n  tip: `asperity path --{name} ...`\n"
                )
            })
        }
        _ => None,
    }
}
