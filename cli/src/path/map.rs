//! `contact_map.png`: a state of a path.

use std::path::{Path, PathBuf};

use asperity::LoadingState;
use asperity::contact::ContactFields;

use super::job::Job;
use crate::contact_map;
use asperity_cli::outcome::Failure;

/// Draws a state of a path.
pub(super) fn draw(
    job: &Job,
    state: &LoadingState,
    fields: &ContactFields,
    name: &Path,
) -> Result<PathBuf, Failure> {
    contact_map::draw(
        &job.grid(),
        &state.contact,
        &fields.pressure,
        &fields.contact_map,
        job.has_hardness().then_some(&fields.yielded_map),
        name,
    )
}
