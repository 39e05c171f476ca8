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
mod punch;
mod report;
mod round;

use std::process::ExitCode;

use asperity_cli::outcome::Failure;
use asperity_studies::findings::{Findings, Picture, Places};
use asperity_studies::study;
use clap::Parser;

use double_wave::Comparison;
use punch::SquarePunch;
use report::Report;

/// Contacts that have a closed form, on finer and finer meshes.
#[derive(Debug, Parser)]
#[command(name = "closed_forms")]
struct Options {
    #[command(flatten)]
    places: Places,
}

fn main() -> ExitCode {
    study::main(run)
}

fn run(options: &Options) -> Result<(), Failure> {
    let failed = |error: asperity::Error| Failure::new("a contact that has a closed form", error);
    let square = SquarePunch::new().map_err(failed)?;
    let mut curves = round::curves().map_err(failed)?;
    curves.extend(punch::circular().map_err(failed)?);
    curves.push(square.curve());
    curves.extend(plane::curves().map_err(failed)?);
    let report = Report { curves, punch: square, wave: Comparison::new().map_err(failed)? };
    Findings {
        study: "closed_forms",
        text: report.text(),
        tables: vec![("closed_forms", report.csv())],
        pictures: vec![Picture { name: "closed_forms", charts: report.charts(), columns: 3 }],
    }
    .write(&options.places)
}
