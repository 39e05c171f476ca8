//! The states that `--at` asks for: their maps and fields.

use std::path::{Path, PathBuf};

use asperity::LoadingState;
use asperity::loading::History;
use asperity_cli::outcome::Failure;

use super::Solver;
use super::fields::{self, Format};
use super::job::Job;
use super::map;
use crate::at::At;

/// Those of them that a path has reached, and an error that names the first one that it has not.
pub(super) fn reached(
    job: &Job,
    states: &[LoadingState],
) -> (Vec<(At, LoadingState)>, Result<(), Failure>) {
    let history: History = states.iter().copied().collect();
    let nominal = job.grid().nominal_area();
    let mut found = Vec::new();
    let mut missed = Ok(());
    for &at in job.at() {
        match history.at(at.target(nominal)) {
            Ok(state) => found.push((at, state)),
            Err(error) if missed.is_ok() => {
                let what = format!("the path has no state at {at}");
                missed = Err(match states.last().map(|last| at.of_same_kind(last, nominal)) {
                    Some(end) if at.is_beyond(end) => {
                        Failure::request(format!("{what}: it ends at {end}"))
                    }
                    _ => Failure::new(what, error),
                });
            }
            Err(_) => {}
        }
    }
    (found, missed)
}

/// Draws the map of a state and writes its fields, both named after it.
pub(super) fn write(
    job: &Job,
    solver: &mut Solver,
    (at, state): &(At, LoadingState),
    (directory, format): (&Path, Option<Format>),
) -> Result<Vec<PathBuf>, Failure> {
    let failed = |error| Failure::new(format!("cannot compute the fields at {at}"), error);
    let found = solver.fields_at(state).map_err(failed)?;
    let ending = at.ending();
    let name = directory.join(format!("contact_map{ending}.png"));
    let mut files = vec![map::draw(job, state, &found, &name)?];
    if let Some(format) = format {
        let found = fields::of(found, job.has_hardness());
        files.extend(fields::write(&found, &job.grid(), format, (directory, &ending))?);
    }
    Ok(files)
}
