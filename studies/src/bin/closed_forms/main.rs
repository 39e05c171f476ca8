//! Contacts that have a closed form, on finer and finer meshes: in what order each quantity converges, and to what.
//!
//! ```text
//! cargo run --release -p asperity-studies --bin closed_forms -- --report docs/validation.md
//! ```
//!
//! Sphere, ellipse, cone, circular and square punch and cylinder on the free half-space, a wave and a wave in two
//! directions on the periodic one. Writes `closed_forms.csv` and `closed_forms.png`.

mod curve;
mod double_wave;
mod plane;
mod report;
mod round;

use std::path::PathBuf;
use std::process::ExitCode;

use asperity_cli::outcome::{Failure, Outcome};
use asperity_cli::{chart, panel};
use asperity_studies::page::Section;
use clap::Parser;

use double_wave::Comparison;
use report::Report;
use round::SquarePunch;

/// Contacts that have a closed form, on finer and finer meshes.
#[derive(Debug, Parser)]
#[command(name = "closed_forms")]
struct Options {
    /// Directory for the files, made if it is not there
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,

    /// Also write the section of this page, and the picture into images/ next to it
    #[arg(long, value_name = "FILE.md")]
    report: Option<PathBuf>,
}

fn main() -> ExitCode {
    match run(&Options::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.report();
            ExitCode::FAILURE
        }
    }
}

fn run(options: &Options) -> Result<(), Failure> {
    panel::register_font()?;
    std::fs::create_dir_all(&options.out)
        .map_err(|error| Failure::new(format!("cannot make {}", options.out.display()), error))?;
    let failed = |error: asperity::Error| Failure::new("a contact that has a closed form", error);
    let punch = SquarePunch::new().map_err(failed)?;
    let mut curves = round::curves().map_err(failed)?;
    curves.push(punch.curve());
    curves.extend(plane::curves().map_err(failed)?);
    let report = Report {
        curves,
        punch,
        wave: Comparison::new().map_err(failed)?,
    };
    let text = report.text();
    println!("{text}");

    let mut outcome = Outcome::default();
    let csv = options.out.join("closed_forms.csv");
    outcome.written(match std::fs::write(&csv, report.csv()) {
        Ok(()) => Ok(csv),
        Err(error) => Err(Failure::new(
            format!("cannot write {}", csv.display()),
            error,
        )),
    });
    let picture = options.out.join("closed_forms.png");
    outcome.written(chart::draw(&report.charts(), 3, &picture));
    if let Some(page) = &options.report {
        let section = Section {
            study: "closed_forms",
            text: &text,
            pictures: &[picture],
        };
        outcome.written(section.publish(page));
    }
    outcome.finish()
}
