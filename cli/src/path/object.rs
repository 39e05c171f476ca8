//! What is printed for programs.

use asperity::LoadingState;
use asperity_cli::answer;
use asperity_cli::outcome::Failure;
use serde_json::{Map, Value, json};

use super::Solver;
use super::job::Job;
use super::moments;
use super::table::{all_warnings, corrected_areas, reason, verify};
use crate::conduction::{Named, conductances};

/// Prints the end of the path as one line, with the states that were asked for and the seed of one of many, and checks it as the table does.
pub(super) fn print(
    job: &Job,
    solver: &mut Solver,
    states: &[LoadingState],
    (conductions, seconds, seed): (&[Named], f64, Option<u64>),
) -> Result<(), Failure> {
    let failed = |error| Failure::new("cannot compute the last state", error);
    let corrected = corrected_areas(job, states).map_err(failed)?;
    let area = |state: &LoadingState| corrected.get(state.step - 1).copied();
    let greatest = solver.fields().map_err(failed)?.max_pressure();
    let scalars = |state: Option<&LoadingState>, greatest, corrected_area| {
        let mut object = scalars(state, greatest, corrected_area);
        if let Some(state) = state {
            let found = conductances(conductions, &state.contact, job.layering());
            let named = found
                .into_iter()
                .map(|(carrier, value)| (carrier.column().to_string(), json!(value)));
            object.extend(named);
        }
        object
    };
    let mut object = scalars(states.last(), greatest, corrected.last().copied());
    if let Some(seed) = seed {
        object.insert("seed".to_string(), json!(seed));
    }
    object.insert("states".to_string(), json!(states.len()));
    object.insert("ended_by".to_string(), json!(solver.end().map(reason)));
    object.insert("seconds".to_string(), json!(seconds));
    object.insert("warnings".to_string(), json!(all_warnings(job, solver, states)?));
    if !job.at().is_empty() {
        let mut asked = Vec::new();
        for (at, state) in moments::reached(job, states).0 {
            let greatest = solver.fields_at(&state).map_err(failed)?.max_pressure();
            let mut object = scalars(Some(&state), greatest, area(&state));
            object.insert("at".to_string(), json!(at.to_string()));
            asked.push(Value::Object(object));
        }
        object.insert("at".to_string(), Value::Array(asked));
    }
    answer!("{}", Value::Object(object));
    verify(solver)
}

/// The scalars of a state; null where there is none.
fn scalars(
    state: Option<&LoadingState>,
    max_pressure: f64,
    corrected_area: Option<f64>,
) -> Map<String, Value> {
    let contact = state.map(|state| state.contact);
    let plastic = contact.and_then(|contact| contact.plastic);
    let scalars = [
        ("step", json!(state.map(|state| state.step))),
        ("load", json!(contact.map(|c| c.load))),
        ("mean_pressure", json!(contact.map(|c| c.mean_pressure()))),
        ("max_pressure", json!(max_pressure)),
        ("contact_nodes", json!(contact.map(|c| c.contact_nodes))),
        ("contact_area", json!(contact.map(|c| c.contact_area))),
        ("contact_area_fraction", json!(contact.map(|c| c.contact_area_fraction))),
        ("corrected_contact_area", json!(corrected_area)),
        ("yielded_area_fraction", json!(plastic.map(|p| p.yielded_area_fraction))),
        ("plastic_volume", json!(plastic.map(|p| p.volume))),
        ("plastic_work", json!(plastic.map(|p| p.work))),
        ("approach", json!(contact.map(|c| c.approach))),
        ("approach_error", json!(state.map(|state| state.approach_error))),
        ("mean_gap", json!(contact.map(|c| c.mean_gap))),
        ("contact_stiffness", json!(contact.and_then(|c| c.contact_stiffness))),
        ("interfacial_stiffness", json!(contact.and_then(|c| c.interfacial_stiffness))),
        ("energy", json!(contact.map(|c| c.energy))),
    ];
    scalars.map(|(name, value)| (name.to_string(), value)).into_iter().collect()
}
