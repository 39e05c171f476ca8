//! Partial slip: Mindlin's sphere over meshes, and joints against an incremental solution of Coulomb's law on Cerruti's
//! half-space, which shares neither the path nor its assumptions.
//!
//! ```text
//! cargo run --release -p asperity-studies --bin slip -- --report docs/joints_that_slip.md
//! ```

mod cerruti;
mod costs;
mod coulomb;
mod coupled;
mod joints;
mod resolution;
mod sphere;
mod uncoupled;

use std::path::PathBuf;
use std::process::ExitCode;

use asperity::Error;
use asperity_cli::outcome::Failure;
use asperity_studies::page::Section;
use asperity_studies::study;
use clap::Parser;

/// Partial slip against closed forms and an incremental solution.
#[derive(Debug, Parser)]
#[command(name = "slip")]
struct Options {
    /// Also write the section of this page
    #[arg(long, value_name = "FILE.md")]
    report: Option<PathBuf>,

    /// Nodes in contact of the joints that are solved incrementally
    #[arg(long, value_name = "N", default_value_t = 250)]
    nodes: usize,
}

fn main() -> ExitCode {
    study::main(run)
}

fn run(options: &Options) -> Result<(), Failure> {
    let failed = |error: Error| Failure::new("cannot shear a joint", error);
    let mut text = String::from("## Measured\n");
    sphere::write(&mut text).map_err(failed)?;
    resolution::write(&mut text).map_err(failed)?;
    uncoupled::write(options.nodes, &mut text)?;
    coupled::write(options.nodes, &mut text)?;
    costs::write(&mut text).map_err(failed)?;
    let section = Section { study: "slip", text: &text, pictures: &[] };
    section.show(options.report.as_deref())
}
