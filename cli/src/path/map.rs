//! `contact_map.png`: the last state of a path.

use std::path::{Path, PathBuf};

use super::Solver;
use super::job::Job;
use crate::contact_map;
use asperity_cli::outcome::Failure;

/// Draws the present state of a path into a directory.
pub(super) fn draw(job: &Job, solver: &mut Solver, directory: &Path) -> Result<PathBuf, Failure> {
    let fields = solver
        .fields()
        .map_err(|error| Failure::new("cannot compute the pressure for the map", error))?;
    let Some(state) = solver.state() else {
        return Err(Failure::request("there is no state to draw a map of"));
    };
    contact_map::draw(
        &job.grid(),
        &state.contact,
        &fields.pressure,
        &fields.contact_map,
        job.has_hardness().then_some(&fields.yielded_map),
        &directory.join("contact_map.png"),
    )
}
