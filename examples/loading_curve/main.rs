//! The main job: from a rough surface to its whole loading path.
//!
//! ```text
//! cargo run --release --example loading_curve
//! cargo run --release --example loading_curve -- --surface heights.npy --side 1e-3 --e-star 1e11
//! ```
//!
//! Writes `path.csv` with one line for each node that touches, `loading_curve.svg` and
//! `contact_map.png`, and prints a short table. If the path ends with an error, everything up to
//! there is written all the same, and the exit code is 1.
//!
//! With `--periodic love` or `--periodic spectral` surface and half-space repeat with the nominal
//! area: `approach` is then that of the mean planes, and `contact_stiffness` is empty, because there
//! is no distant point from which another approach could be counted.

#[allow(dead_code)] // shared: each example uses its part
#[path = "../common/axis.rs"]
mod axis;
mod curves;
#[allow(dead_code)] // shared: each example uses its part
#[path = "../common/half_space.rs"]
mod half_space;
mod job;
mod map;
#[allow(dead_code)] // shared: each example uses its part
#[path = "../common/number.rs"]
mod number;
mod options;
#[allow(dead_code)] // shared: each example uses its part
#[path = "../common/outcome.rs"]
mod outcome;
#[allow(dead_code)] // shared: each example uses its part
#[path = "../common/panel.rs"]
mod panel;
mod path;
mod table;

use std::process::ExitCode;
use std::time::Instant;

use asperity::LoadingSolver;
use clap::Parser;

use job::Job;
use options::Options;
use outcome::{Failure, Outcome};
use path::PathFile;

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
    let job = Job::new(options)?;
    eprint!("{job}");
    let kernel = job.kernel()?;
    let mut solver = LoadingSolver::builder(job.heights(), kernel)
        .rule(job.rule())
        .max_nodes(job.max_nodes())
        .build()
        .map_err(|error| Failure::new("the path cannot begin", error))?;
    panel::register_font()?;

    std::fs::create_dir_all(&options.out)
        .map_err(|error| Failure::new(format!("cannot make {}", options.out.display()), error))?;
    let start = Instant::now();
    let mut file = PathFile::create(&options.out)?;
    let (states, ended) = path::follow(&mut solver, &mut file, job.max_nodes());
    let seconds = start.elapsed().as_secs_f64();

    // Each of these is tried whatever became of the others: nothing computed is lost.
    let mut outcome = Outcome::default();
    outcome.note(ended);
    outcome.note(table::print(&job, &mut solver, &states, seconds));
    outcome.written(file.finish());
    outcome.written(curves::draw(&job, &states, &options.out));
    outcome.written(map::draw(&job, &mut solver, &options.out));
    outcome.finish()
}
