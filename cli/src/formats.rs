//! `asperity formats`: what files can be read.

use asperity::io::Format;
use asperity_cli::answer;
use asperity_cli::outcome::Failure;
use clap::Args;
use serde_json::{Map, Value, json};

/// List the formats of files with heights, and what the names of such files end with
///
/// A file is known by its content, whatever its name ends with.
#[derive(Debug, Args)]
pub(crate) struct Options {
    /// Print one JSON object with the endings of each format
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    if options.json {
        let endings = |format: Format| (format.name().to_string(), json!(format.endings()));
        let all: Map<String, Value> = Format::ALL.into_iter().map(endings).collect();
        answer!("{}", Value::Object(all));
        return Ok(());
    }
    for format in Format::ALL {
        let endings: Vec<String> =
            format.endings().iter().map(|ending| format!(".{ending}")).collect();
        answer!("{:<23}{}", format.name(), endings.join(" "));
    }
    Ok(())
}
