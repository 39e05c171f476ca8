//! What a periodic half-space is for: rough contact against its theories, and a wave against its
//! closed form.
//!
//! ```text
//! cargo run --release -p asperity-studies --bin periodic_study
//! ```
//!
//! * Contact area, mean gap and interfacial stiffness of several self-affine surfaces that differ in
//!   nothing but the seed, under the same loads, against Persson, Bush-Gibson-Thomas and the exponential
//!   law of the mean gap, with the spread of the surfaces.
//! * The contact of a wave on finer and finer grids with both kernels against Westergaard: in what order
//!   mean gap, area and stiffness converge.
//!
//! Writes `periodic_study.csv` and `periodic_study.png`, `westergaard.csv` and `westergaard.png`, and the
//! tables of both as `periodic_study.md`.

mod rough;
mod wave;

use std::path::PathBuf;
use std::process::ExitCode;

use asperity_cli::half_space::Periodic;
use asperity_cli::outcome::{Failure, Outcome};
use asperity_cli::{chart, panel};
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

    /// Directory for the files, made if it is not there
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
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
    let study = rough::Study::run(options)?;
    let convergence = wave::Convergence::run(options)?;
    let tables = format!("{}\n{}", study.table(), convergence.table());
    print!("{tables}");

    let mut outcome = Outcome::default();
    let file = |name: &str| options.out.join(name);
    outcome.written(write(file("periodic_study.csv"), study.csv()));
    outcome.written(chart::draw(&study.charts(), 2, &file("periodic_study.png")));
    outcome.written(write(file("westergaard.csv"), convergence.csv()));
    outcome.written(chart::draw(
        &convergence.charts(),
        3,
        &file("westergaard.png"),
    ));
    outcome.written(write(file("periodic_study.md"), tables));
    outcome.finish()
}

fn write(name: PathBuf, text: String) -> Result<PathBuf, Failure> {
    match std::fs::write(&name, text) {
        Ok(()) => Ok(name),
        Err(error) => Err(Failure::new(
            format!("cannot write {}", name.display()),
            error,
        )),
    }
}
