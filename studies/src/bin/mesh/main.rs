//! Area, mean gap and interfacial stiffness of rough contact against the mesh and against the width of the spectrum.
//!
//! ```text
//! cargo run --release -p asperity-studies --bin mesh -- --report docs/validation.md
//! ```
//!
//! Writes `mesh.csv` and `mesh.png`.

mod charts;
mod kept;
mod report;
mod states;
mod study;

use std::process::ExitCode;

use asperity_cli::outcome::Failure;
use asperity_studies::findings::{Findings, Picture, Places};
use clap::Parser;

use kept::Kept;
use study::Study;

/// Area, mean gap and interfacial stiffness against the mesh and against the width of the spectrum.
#[derive(Debug, Parser)]
#[command(name = "mesh")]
struct Options {
    /// Surfaces, with seeds from 1
    #[arg(long, default_value_t = 6, value_parser = clap::value_parser!(u64).range(2..))]
    surfaces: u64,

    /// Most cells to the shortest wave, and widest spectrum
    #[arg(long, default_value_t = 32, value_parser = clap::value_parser!(u16).range(8..=32))]
    finest: u16,

    /// Take the states that --out holds already instead of computing them
    #[arg(long)]
    reuse: bool,

    #[command(flatten)]
    places: Places,
}

fn main() -> ExitCode {
    asperity_studies::study::main(run)
}

fn run(options: &Options) -> Result<(), Failure> {
    let kept = match options.reuse {
        true => Kept::read(&options.places.out.join("mesh.csv")),
        false => Kept::default(),
    };
    let study = Study::new(options.surfaces, options.finest.into(), &kept)
        .map_err(|error| Failure::new("a rough surface", error))?;
    Findings {
        study: "mesh",
        text: study.text(),
        tables: vec![("mesh", study.csv())],
        pictures: vec![Picture { name: "mesh", charts: study.charts(), columns: 2 }],
    }
    .write(&options.places)
}
