//! What is printed for programs.

use asperity::adhesion::AdhesiveState;
use asperity_cli::answer;
use serde_json::{Map, Value, json};

use super::super::job::Job;
use super::course::Followed;
use super::words::{Pulled, pull};

/// Prints the end of loading as one line, with what pulls and what the loop costs, and the seed of one of many.
pub(super) fn print(
    job: &Job,
    followed: &Followed,
    warnings: &[String],
    (max_pressure, seconds, seed): (f64, f64, Option<u64>),
) {
    let law = followed.path.law();
    let pulled = Pulled::of(followed);
    let mut object = scalars(pulled.pressed.as_ref());
    let force = |state: Option<AdhesiveState>| json!(state.as_ref().map(pull));
    let approach = |state: Option<AdhesiveState>| json!(state.map(|s| s.contact.approach));
    let more = [
        ("max_pressure", json!(max_pressure)),
        ("states", json!(followed.states.len())),
        ("ended_by", json!(followed.ended_by)),
        ("pull_in", force(pulled.pull_in)),
        ("pull_in_approach", approach(pulled.pull_in)),
        ("pull_off", force(pulled.pull_off)),
        ("pull_off_approach", approach(pulled.pull_off)),
        ("loop_energy", json!(pulled.pull_off.map(|_| pulled.dissipated))),
        ("jumps", json!(pulled.jumps)),
        (
            "law",
            json!({
                "work": law.work(),
                "stress": law.stress(),
                "flat_range": law.flat_range(),
                "range": law.range(),
                "resolution": law.resolution(),
            }),
        ),
        ("seconds", json!(seconds)),
        ("warnings", json!(warnings)),
    ];
    object.extend(more.map(|(name, value)| (name.to_string(), value)));
    if let Some(seed) = seed {
        object.insert("seed".to_string(), json!(seed));
    }
    if !job.at().is_empty() {
        let asked = followed.reached.iter().map(|(at, state)| {
            let mut object = scalars(Some(state));
            object.insert("at".to_string(), json!(at.to_string()));
            Value::Object(object)
        });
        object.insert("at".to_string(), asked.collect());
    }
    answer!("{}", Value::Object(object));
}

/// The scalars of a state; null where there is none.
fn scalars(state: Option<&AdhesiveState>) -> Map<String, Value> {
    let contact = state.map(|state| state.contact);
    let scalars = [
        ("step", json!(state.map(|state| state.step))),
        ("load", json!(contact.map(|c| c.load))),
        ("mean_pressure", json!(contact.map(|c| c.mean_pressure()))),
        ("contact_nodes", json!(contact.map(|c| c.contact_nodes))),
        ("soft_nodes", json!(state.map(|state| state.soft_nodes))),
        ("cohesive_nodes", json!(state.map(|state| state.cohesive_nodes))),
        ("contact_area", json!(contact.map(|c| c.contact_area))),
        ("contact_area_fraction", json!(contact.map(|c| c.contact_area_fraction))),
        ("approach", json!(contact.map(|c| c.approach))),
        ("mean_gap", json!(contact.map(|c| c.mean_gap))),
        ("contact_stiffness", json!(contact.and_then(|c| c.contact_stiffness))),
        ("interfacial_stiffness", json!(contact.and_then(|c| c.interfacial_stiffness))),
        ("energy", json!(contact.map(|c| c.energy))),
        ("adhesive_energy", json!(state.map(|state| state.adhesive_energy))),
        ("dissipated", json!(state.map(|state| state.dissipated))),
        ("work", json!(state.map(|state| state.work))),
    ];
    scalars.map(|(name, value)| (name.to_string(), value)).into_iter().collect()
}
