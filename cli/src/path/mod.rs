//! `asperity path`: from a rough surface to its whole loading path.
//!
//! Writes `path.csv` with one line for each state, `loading_curve.svg` and
//! `contact_map.png`, and prints a short table. If the path ends with an error, everything up to
//! there is written all the same, and the exit code is 1.

mod curves;
mod follow;
mod job;
mod map;
mod options;
mod progress;
mod table;

use std::time::Instant;

use asperity::{Doubt, LoadingSolver};
use asperity::updater::LinearUpdater;
use asperity_cli::outcome::{Failure, Outcome};
use asperity_cli::panel;

use follow::{PathFile, follow};
use job::Job;
pub(crate) use options::Options;

/// The path, whatever updater it has.
type Solver = LoadingSolver<Box<dyn LinearUpdater>>;

/// Does the job and writes its files.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let job = Job::new(options)?;
    eprint!("{job}");
    for doubt in Doubt::of_surface(job.surface()) {
        eprintln!("warning: {doubt}");
    }
    let kernel = job.kernel()?;
    let mut builder = LoadingSolver::builder(job.heights(), &kernel)
        .updater(options.updater.make())
        .rule(job.rule());
    for &target in job.targets() {
        builder = builder.until(target);
    }
    let mut solver = builder
        .build()
        .map_err(|error| Failure::new("the path cannot begin", error))?;
    panel::register_font()?;

    std::fs::create_dir_all(&options.out)
        .map_err(|error| Failure::new(format!("cannot make {}", options.out.display()), error))?;
    let start = Instant::now();
    let mut file = PathFile::create(&options.out)?;
    let (states, ended) = follow(&mut solver, &mut file, |state| job.progress(state));
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
