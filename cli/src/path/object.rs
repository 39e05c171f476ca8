//! What is printed for programs.

use asperity::LoadingState;
use asperity_cli::answer;
use asperity_cli::outcome::Failure;
use serde_json::json;

use super::Solver;
use super::job::Job;
use super::table::{corrected_areas, reason, verify, warnings};

/// Prints the end of the path as one line, and checks it as the table does.
pub(super) fn print(
    job: &Job,
    solver: &mut Solver,
    states: &[LoadingState],
    seconds: f64,
) -> Result<(), Failure> {
    let failed = |error| Failure::new("cannot compute the last state", error);
    let corrected = corrected_areas(job, states).map_err(failed)?;
    let contact = states.last().map(|state| state.contact);
    let plastic = contact.and_then(|contact| contact.plastic);
    answer!(
        "{}",
        json!({
            "states": states.len(),
            "ended_by": solver.end().map(reason),
            "seconds": seconds,
            "step": states.last().map(|state| state.step),
            "load": contact.map(|c| c.load),
            "mean_pressure": contact.map(|c| c.mean_pressure()),
            "max_pressure": solver.fields().map_err(failed)?.max_pressure(),
            "contact_nodes": contact.map(|c| c.contact_nodes),
            "contact_area": contact.map(|c| c.contact_area),
            "contact_area_fraction": contact.map(|c| c.contact_area_fraction),
            "corrected_contact_area": corrected.last(),
            "yielded_area_fraction": plastic.map(|p| p.yielded_area_fraction),
            "plastic_volume": plastic.map(|p| p.volume),
            "plastic_work": plastic.map(|p| p.work),
            "approach": contact.map(|c| c.approach),
            "approach_error": states.last().map(|state| state.approach_error),
            "mean_gap": contact.map(|c| c.mean_gap),
            "contact_stiffness": contact.and_then(|c| c.contact_stiffness),
            "interfacial_stiffness": contact.and_then(|c| c.interfacial_stiffness),
            "energy": contact.map(|c| c.energy),
            "warnings": warnings(job, solver)?,
        })
    );
    verify(solver)
}
