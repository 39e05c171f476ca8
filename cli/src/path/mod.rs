//! `asperity path`: from a rough surface to its whole loading path.
//!
//! Writes `path.csv` with one line for each state, `loading_curve.svg` and
//! `contact_map.png`, the record of the path if it is asked for, and prints a short table. If the path ends with
//! an error, everything up to there is written all the same, and the exit code is 1.

mod curves;
mod fields;
mod follow;
mod job;
mod map;
mod options;
mod progress;
mod table;

use std::path::{Path, PathBuf};
use std::time::Instant;

use asperity::patches::ContactEdge;
use asperity::record::LoadingRecord;
use asperity::updater::LinearUpdater;
use asperity::{LoadingSolver, LoadingState};
use asperity_cli::outcome::{Failure, Outcome};
use asperity_cli::panel;
use asperity_cli::say;
use nalgebra::DMatrix;

use follow::{Followed, PathFile};
use job::Job;
pub(crate) use options::Options;

/// The path, whatever updater it has.
type Solver = LoadingSolver<Box<dyn LinearUpdater>>;

/// Follows one path, or that of each seed.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    if options.ensemble.seeds.is_none() {
        return follow_one(options);
    }
    let (members, there) = options.ensemble.members(&options.out);
    say!("{} paths to follow, {there} are there", members.len());
    if options.ensemble.dry_run {
        if let Some(first) = members.first() {
            say!("{}", Job::new(&options.of(first))?.expected());
        }
        return Ok(());
    }
    for member in &members {
        follow_one(&options.of(member))?;
        member.finish()?;
    }
    Ok(())
}

/// Does one job and writes its files.
fn follow_one(options: &Options) -> Result<(), Failure> {
    let job = Job::new(options)?;
    eprint!("{job}");
    for doubt in job.doubts() {
        eprintln!("warning: {doubt}");
    }
    let mut solver = job.solver()?;
    panel::register_font()?;

    std::fs::create_dir_all(&options.out)
        .map_err(|error| Failure::new(format!("cannot make {}", options.out.display()), error))?;
    let start = Instant::now();
    let file = PathFile::create(&options.out, ContactEdge::new(job.grid(), job.boundary()))?;
    let mut followed = Followed::new(job.begun(), file, options)?;
    let ended = followed.follow(&mut solver, |state| job.progress(state));
    let (states, file) = followed.end();
    let seconds = start.elapsed().as_secs_f64();

    // Each of these is tried whatever became of the others: nothing computed is lost.
    let mut outcome = Outcome::default();
    outcome.note(ended);
    match fields::of(&mut solver) {
        Ok(fields) => {
            if let Some(name) = &options.record {
                outcome.written(save(name, &solver, &states, &fields));
            }
            if let Some(format) = options.fields {
                let written = fields::write(&fields, &job.grid(), format, &options.out);
                outcome.all_written(written);
            }
        }
        Err(failure) => outcome.note(Err(failure)),
    }
    outcome.note(table::print(&job, &mut solver, &states, seconds));
    outcome.written(file.finish());
    outcome.written(curves::draw(&job, &states, &options.out));
    outcome.written(map::draw(&job, &mut solver, &options.out));
    outcome.finish()
}

/// Writes the record of the path so far, and fields of its last state.
fn save(
    name: &Path,
    solver: &Solver,
    states: &[LoadingState],
    fields: &[(&str, DMatrix<f64>)],
) -> Result<PathBuf, Failure> {
    let fields = fields.iter().map(|(name, field)| (*name, field));
    let fields: Vec<_> = fields.collect();
    LoadingRecord::new(solver, states.iter().copied().collect())
        .and_then(|record| record.write_npz(name, &fields))
        .map(|()| name.to_path_buf())
        .map_err(|error| Failure::writing(name, error))
}
