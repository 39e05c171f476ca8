//! `contact_map.png`: the nodes in contact, coloured by pressure.

use std::path::{Path, PathBuf};

use super::Solver;
use super::job::Job;
use asperity_cli::field_map::{FieldMap, Scale};
use asperity_cli::number::quantity;
use asperity_cli::outcome::Failure;

/// Draws the present state of a path into a directory.
pub(super) fn draw(job: &Job, solver: &mut Solver, directory: &Path) -> Result<PathBuf, Failure> {
    let pressure = solver
        .pressure()
        .map_err(|error| Failure::new("no pressure for the map", error))?;
    let caption = solver.state().map_or_else(String::new, |state| {
        format!(
            "{} nodes in contact, A/A₀ = {:.2} %, W = {}",
            state.contact_nodes,
            100.0 * state.contact_area_fraction,
            quantity(state.load, "N", 4)
        )
    });
    // Below zero are pressures that only the paper's rule gives.
    let greatest = pressure.iter().copied().fold(0.0, f64::max);
    let in_contact = |pressure: f64, is_in| if is_in { pressure } else { f64::NAN };
    FieldMap {
        grid: &job.grid(),
        length_unit: "m",
        values: &pressure.zip_map(&solver.contact_map(), in_contact),
        range: (0.0, greatest),
        scale: Scale::Linear,
        contours: &[],
        label: ("pressure", "Pa"),
    }
    .write(&directory.join("contact_map.png"), &caption)
}
