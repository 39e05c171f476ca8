//! What a study writes: numbers, pictures, and its section of a page.

use std::path::{Path, PathBuf};

use asperity_cli::chart::{self, Chart};
use asperity_cli::outcome::{Failure, Outcome};
use asperity_cli::panel;

use crate::page::Section;

/// Where a study writes.
#[derive(Debug, clap::Args)]
pub struct Places {
    /// Directory for the files, made if it is not there
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,

    /// Also write the section of this page, and the pictures into images/ next to it
    #[arg(long, value_name = "FILE.md")]
    pub report: Option<PathBuf>,
}

/// Charts side by side in one picture.
pub struct Picture {
    /// Of the file, without its ending.
    pub name: &'static str,
    /// Row by row.
    pub charts: Vec<Chart>,
    /// Charts in a row.
    pub columns: usize,
}

/// All that a study has found.
pub struct Findings {
    /// Name of the study.
    pub study: &'static str,
    /// Its section.
    pub text: String,
    /// Names, without their ending, and contents of tables of comma-separated values.
    pub tables: Vec<(&'static str, String)>,
    /// Its pictures.
    pub pictures: Vec<Picture>,
}

impl Findings {
    /// Prints the section, and writes everything.
    pub fn write(&self, places: &Places) -> Result<(), Failure> {
        println!("{}", self.text);
        panel::register_font()?;
        let out = &places.out;
        std::fs::create_dir_all(out)
            .map_err(|error| Failure::new(format!("cannot make {}", out.display()), error))?;
        let mut outcome = Outcome::default();
        for (name, text) in &self.tables {
            outcome.written(write(&out.join(name).with_extension("csv"), text));
        }
        let mut files = Vec::new();
        for picture in &self.pictures {
            let file = out.join(picture.name).with_extension("png");
            outcome.written(chart::draw(&picture.charts, picture.columns, &file));
            files.push(file);
        }
        if let Some(page) = &places.report {
            let section = Section { study: self.study, text: &self.text, pictures: &files };
            outcome.written(section.publish(page));
        }
        outcome.finish()
    }
}

fn write(name: &Path, text: &str) -> Result<PathBuf, Failure> {
    std::fs::write(name, text)
        .map_err(|error| Failure::new(format!("cannot write {}", name.display()), error))?;
    Ok(name.to_path_buf())
}
