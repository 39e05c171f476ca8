//! Lists of numbers: a decimal comma makes two of one.

use clap::error::{Error, ErrorKind};
use clap::{ArgMatches, Command};

/// `Ok` unless a number without a unit stands before one that has a unit, as in `1,5MPa`.
pub(crate) fn check(mut command: Command, given: &ArgMatches) -> Result<(), Error> {
    let Some((name, given)) = given.subcommand() else { return Ok(()) };
    command.build();
    let Some(command) = command.find_subcommand_mut(name) else { return Ok(()) };
    for arg in command.get_arguments().filter(|arg| arg.get_value_delimiter() == Some(',')) {
        let lists = given.try_get_raw_occurrences(arg.get_id().as_str()).ok().flatten();
        for list in lists.into_iter().flatten() {
            let list: Vec<String> = list.map(|word| word.to_string_lossy().into_owned()).collect();
            if list.windows(2).any(|pair| !has_unit(&pair[0]) && has_unit(&pair[1])) {
                let told = format!(
                    "'--{} {}' has a number without a unit before one with a unit: write a decimal point, or a unit after \
                     each",
                    arg.get_long().unwrap_or_default(),
                    list.join(",")
                );
                return Err(command.clone().error(ErrorKind::ValueValidation, told));
            }
        }
    }
    Ok(())
}

fn has_unit(number: &str) -> bool {
    number.trim().parse::<f64>().is_err()
}
