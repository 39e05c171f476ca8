//! `asperity completions` and `asperity manual`: what a shell and `man` read.

use std::ffi::OsStr;
use std::io;

use asperity_cli::outcome::Failure;
use clap::{Args, Command};
use clap_complete::Shell;

/// Print the completions for a shell: `asperity completions bash > ~/.local/share/bash-completion/completions/asperity`
#[derive(Debug, Args)]
pub(crate) struct Completions {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

impl Completions {
    pub(crate) fn print(&self, mut command: Command) -> Result<(), Failure> {
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut command, "asperity", &mut script);
        written(&script)
    }
}

/// Print the page of the manual: `asperity manual | man -l -`
#[derive(Debug, Args)]
pub(crate) struct Manual {
    /// The page of one command
    #[arg(value_name = "COMMAND")]
    of: Option<String>,
}

impl Manual {
    pub(crate) fn print(&self, mut command: Command) -> Result<(), Failure> {
        command.build();
        let page = match &self.of {
            None => command,
            Some(name) => match command.find_subcommand(name) {
                Some(found) => found.clone(),
                None => return Err(Failure::request(format!("there is no command '{name}'"))),
            },
        };
        let mut text = Vec::new();
        clap_mangen::Man::new(page)
            .render(&mut text)
            .map_err(|error| Failure::new("cannot write the manual", error))?;
        written(&text)
    }
}

/// Writes to stdout, unless nobody reads it.
fn written(text: &[u8]) -> Result<(), Failure> {
    match io::Write::write_all(&mut io::stdout(), text) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::new("cannot write to stdout", error))
        }
        _ => Ok(()),
    }
}

/// A word as a shell reads it.
pub(crate) fn quoted(word: &OsStr) -> String {
    let word = word.to_string_lossy();
    let is_plain = |c: char| c.is_alphanumeric() || "_-./,:+=@%".contains(c);
    match !word.is_empty() && word.chars().all(is_plain) {
        true => word.into_owned(),
        false => format!("'{}'", word.replace('\'', r"'\''")),
    }
}

/// The command that was given.
pub(crate) fn command() -> String {
    let mut words = std::env::args_os();
    // Wherever the program lies.
    words.next();
    let words = words.map(|word| quoted(&word));
    std::iter::once("asperity".to_string()).chain(words).collect::<Vec<_>>().join(" ")
}
