//! What a periodic half-space is for: rough contact against its theories, and a wave against its
//! closed form.
//!
//! ```text
//! cargo run --release -p asperity-studies --bin periodic_study -- --report docs/validation.md
//! ```
//!
//! * Contact area, mean gap and interfacial stiffness of several self-affine surfaces that differ in
//!   nothing but the seed, under the same loads, against Persson, Bush-Gibson-Thomas and the exponential
//!   law of the mean gap, with the spread of the surfaces.
//! * The contact of a wave on finer and finer grids with both kernels against Westergaard: in what order
//!   mean gap, area and stiffness converge.
//!
//! Writes `periodic_study.csv` and `periodic_study.png`, `westergaard.csv` and `westergaard.png`.

mod rough;
mod rough_charts;
mod rough_report;
mod wave;
mod wave_report;

use std::process::ExitCode;

use asperity_cli::half_space::Periodic;
use asperity_cli::outcome::Failure;
use asperity_studies::findings::{Findings, Picture, Places};
use asperity_studies::study;
use clap::Parser;

/// Rough contact on a periodic half-space against theory, and a wave against its closed form.
#[derive(Debug, Parser)]
#[command(name = "periodic_study")]
pub(crate) struct Options {
    /// Surfaces, with seeds from 1
    #[arg(long, default_value_t = 6)]
    surfaces: u64,

    /// Nodes along each side of a surface
    #[arg(long, default_value_t = 256)]
    nodes: usize,

    /// Loads on each surface
    #[arg(long, default_value_t = 25)]
    loads: usize,

    /// Kernel of the half-space under the rough surfaces
    #[arg(long, value_enum, default_value = "love")]
    kernel: Periodic,

    /// Nodes along the finest wave
    #[arg(long, default_value_t = 1024)]
    wave_nodes: usize,

    #[command(flatten)]
    places: Places,
}

fn main() -> ExitCode {
    study::main(run)
}

fn run(options: &Options) -> Result<(), Failure> {
    let study = rough::Study::run(options)?;
    let convergence = wave::Convergence::run(options)?;
    let text = format!(
        "## The periodic half-space\n\n\
         Study `periodic_study`.\n\n{}\n\n{}",
        convergence.text(),
        study.text(),
    );
    Findings {
        study: "periodic_study",
        text,
        tables: vec![("periodic_study", study.csv()), ("westergaard", convergence.csv())],
        pictures: vec![
            Picture { name: "periodic_study", charts: study.charts(), columns: 2 },
            Picture { name: "westergaard", charts: convergence.charts(), columns: 3 },
        ],
    }
    .write(&options.places)
}
