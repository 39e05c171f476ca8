//! The same problems by other programs: tamaas, aspher and ContactMechanics.
//!
//! ```text
//! studies/src/bin/peers/peers.sh
//! cargo run --release -p asperity-studies --bin peers -- --report docs/validation.md
//! ```
//!
//! The first line solves everything with the other programs and writes `peers.csv` and `waves.csv`; the second solves
//! it again here and makes the table. `--write DIR` writes the surfaces and our solutions, which the first line wants.

mod ours;
mod report;
mod surfaces;
mod table;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use asperity::io::write_npy;
use asperity_cli::outcome::Failure;
use asperity_studies::page::Section;
use asperity_studies::study;
use clap::Parser;

/// The same problems by other programs.
#[derive(Debug, Parser)]
#[command(name = "peers")]
struct Options {
    /// Write the surfaces and our solutions into this directory, for `peers.py`, and nothing else
    #[arg(long, value_name = "DIR")]
    write: Option<PathBuf>,

    /// Also write the section of this page
    #[arg(long, value_name = "FILE.md", conflicts_with = "write")]
    report: Option<PathBuf>,
}

fn main() -> ExitCode {
    study::main(run)
}

fn run(options: &Options) -> Result<(), Failure> {
    if let Some(directory) = &options.write {
        return write(directory);
    }
    let text = report::text(&table::read()?, &table::waves()?);
    let section = Section { study: "peers", text: &text, pictures: &[] };
    section.show(options.report.as_deref())
}

/// Surfaces and pressures as NumPy's files, and everything else as `ours.csv`.
fn write(directory: &Path) -> Result<(), Failure> {
    let what = "cannot write the problems";
    let failed = |error: asperity::Error| Failure::new(what, error);
    let unwritten = |error: asperity::SurfaceError| Failure::new(what, error);
    let lost = |error: csv::Error| Failure::new("cannot write ours.csv", error);
    std::fs::create_dir_all(directory)
        .map_err(|error| Failure::new(format!("cannot make {}", directory.display()), error))?;
    let mut table = csv::Writer::from_path(directory.join("ours.csv")).map_err(lost)?;
    let header = [
        "surface",
        "half_space",
        "lx",
        "ly",
        "load",
        "nodes",
        "mean_gap",
        "stiffness",
        "heights",
        "pressure",
    ];
    table.write_record(header).map_err(lost)?;
    for (place, rough) in surfaces::all().map_err(failed)?.iter().enumerate() {
        let heights = format!("surface{place}.npy");
        write_npy(directory.join(&heights), rough.heights.matrix()).map_err(unwritten)?;
        for (number, solved) in ours::solve(rough).map_err(failed)?.iter().enumerate() {
            let pressure = format!("pressure{place}_{number}.npy");
            write_npy(directory.join(&pressure), &solved.solution.fields.pressure)
                .map_err(unwritten)?;
            let state = &solved.solution.contact;
            let stiffness = state.interfacial_stiffness.unwrap_or(f64::NAN);
            let (lx, ly) = rough.grid.sides();
            let numbers = [lx, ly, solved.mean_pressure].map(|x| x.to_string());
            let results = [state.mean_gap, stiffness].map(|x| format!("{x:e}"));
            let mut row = vec![rough.name.to_string(), solved.half_space.to_string()];
            row.extend(numbers);
            row.push(solved.nodes.to_string());
            row.extend(results);
            row.extend([heights.clone(), pressure]);
            table.write_record(row).map_err(lost)?;
        }
    }
    table.flush().map_err(|error| Failure::new("cannot write ours.csv", error))
}
