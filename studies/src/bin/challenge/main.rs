//! The geometry of the contact-mechanics challenge (Müser et al., Tribol. Lett. 65 (2017) 118), without adhesion.
//!
//! ```text
//! cargo run --release -p asperity-studies --bin challenge -- --report docs/validation.md
//! ```
//!
//! Writes `challenge.csv` and `challenge.png`.

mod contact;
mod report;

use std::process::ExitCode;

use asperity_cli::outcome::Failure;
use asperity_studies::findings::{Findings, Picture, Places};
use asperity_studies::study;
use clap::Parser;

use contact::{BAND, solve};
use report::Report;

/// Mean pressures over E*; the second is the reference load of the challenge, 250 kPa.
const LOADS: [f64; 4] = [0.003, 0.01, 0.03, 0.1];
const REFERENCE: f64 = 0.01;
/// Cells to the shortest wave on the coarsest mesh.
const CELLS: usize = 4;

/// The geometry of the contact-mechanics challenge, without adhesion.
#[derive(Debug, Parser)]
#[command(name = "challenge")]
struct Options {
    /// Nodes a side of the finest grid; it has room for the whole spectrum of the challenge from 4000 on
    #[arg(long, default_value_t = 4096, value_parser = clap::value_parser!(u16).range(256..=8192))]
    nodes: u16,

    #[command(flatten)]
    places: Places,
}

fn main() -> ExitCode {
    study::main(run)
}

fn run(options: &Options) -> Result<(), Failure> {
    let failed = |error: asperity::Error| Failure::new("a contact of the challenge", error);
    let finest = usize::from(options.nodes);
    // The meshes have one surface, with 4, 8 and 16 cells to its shortest wave, on up to half the nodes of the finest
    // grid.
    let common = finest / 8;
    let mut meshes = Vec::new();
    for nodes in [common, 2 * common, 4 * common] {
        eprintln!("{nodes}² nodes, L/λₛ = {}", common / CELLS);
        meshes.push(solve(nodes, common / CELLS, &LOADS, true).map_err(failed)?);
    }
    let widest = BAND.min(finest / CELLS);
    let mut bands = Vec::new();
    for nodes in [common, 2 * common, 4 * common, finest] {
        let band = (nodes / CELLS).min(widest);
        eprintln!("{nodes}² nodes, L/λₛ = {band}");
        bands.extend(solve(nodes, band, &[REFERENCE], false).map_err(failed)?);
    }
    eprintln!("{}² nodes, L/λₛ = {widest}", finest / 2);
    let report = Report {
        meshes,
        bands,
        loads: solve(finest / 2, widest.min(finest / 4), &LOADS, true).map_err(failed)?,
    };
    Findings {
        study: "challenge",
        text: report.text(),
        tables: vec![("challenge", report.csv())],
        pictures: vec![Picture {
            name: "challenge",
            charts: report.charts(REFERENCE).map_err(failed)?,
            columns: 2,
        }],
    }
    .write(&options.places)
}
