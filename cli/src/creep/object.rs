//! One object for programs.

use serde_json::{Map, Value, json};

use asperity::Error;

use super::course::Task;
use super::cycles::Sweep;
use super::followed::{Followed, Method};
use super::leaks::Leaks;
use super::words;
use crate::passages::Passage;

pub(super) fn object(
    task: &Task,
    followed: &Followed,
    passages: &[Passage<f64>],
    sweep: Option<&Result<Sweep, Error>>,
    (leaks, warnings): (Option<&Leaks>, &[String]),
) -> Value {
    let mut object = Map::new();
    let mut put = |key: &str, value: Value| {
        object.insert(key.to_string(), value);
    };
    if let Some(last) = followed.states.last() {
        put("time", json!(last.time));
        put("load", json!(last.load));
        put("effective_load", json!(last.effective_load));
        put("approach", json!(last.approach));
        put("contact_nodes", json!(last.contact_nodes));
        put("contact_area_fraction", json!(last.contact_area_fraction));
        put("mean_gap", json!(last.mean_gap));
    }
    let (method, error) = match followed.method {
        Method::ClosedForm => ("closed form", None),
        Method::Steps { error, .. } => ("steps", Some(error)),
    };
    put("method", json!(method));
    put("step_error", json!(error));
    put("recedes", json!(followed.recedes));
    put("enough_until", json!(followed.enough_until));
    put("states", json!(followed.states.len()));
    put("fluidity", json!(task.prony.fluidity()));
    for passage in passages {
        put(passage.key, json!(passage.at));
    }
    let cycles = sweep.and_then(|sweep| sweep.as_ref().ok()).map(|sweep| {
        let cycles = sweep.cycles.iter().map(|cycle| {
            json!({
                "frequency": 1.0 / cycle.period,
                "mean_load": cycle.mean_load,
                "amplitude": cycle.amplitude,
                "approach_amplitude": cycle.approach_amplitude,
                "dissipation": cycle.dissipation,
                "loss_factor": cycle.loss_factor,
            })
        });
        cycles.collect::<Vec<_>>()
    });
    put("cycles", json!(cycles));
    if let Some(leaks) = leaks {
        put("leaks", leaks.object());
    }
    if let Some(Err(error)) = sweep {
        put("no_cycles", json!(words::no_cycles(error)));
    }
    put("warnings", json!(warnings));
    Value::Object(object)
}
