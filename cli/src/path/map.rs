//! `contact_map.png`: a state of a path.

use std::path::{Path, PathBuf};

use asperity::LoadingState;

use super::Solver;
use super::job::Job;
use crate::contact_map;
use asperity_cli::outcome::Failure;

/// Draws a state of a path.
pub(super) fn draw(
    job: &Job,
    solver: &mut Solver,
    state: &LoadingState,
    name: &Path,
) -> Result<PathBuf, Failure> {
    let failed = |error| Failure::new("cannot compute the pressure for the map", error);
    let pressure = solver.pressure_at(state).map_err(failed)?;
    let contact_map = solver.contact_map_at(state).map_err(failed)?;
    let yielded = job.has_hardness().then(|| solver.yielded_map_at(state));
    let yielded = yielded.transpose().map_err(failed)?;
    contact_map::draw(&job.grid(), &state.contact, &pressure, &contact_map, yielded.as_ref(), name)
}
