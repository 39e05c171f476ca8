//! What is printed for programs.

use asperity::patches::constriction;
use asperity::record::LoadingRecord;
use asperity::surface::Axis;
use asperity::{Error, LoadingState};
use serde_json::{Value, json};

use super::followed::Followed;
use super::moment::Moment;
use super::words::warnings;

/// Percolation and sealing if patches could be followed, and one state with its patches and channels.
pub(super) fn of(
    record: &LoadingRecord,
    followed: Option<&Followed>,
    moment: &Moment,
) -> Result<Value, Error> {
    let mut object = json!({
        "states": record.states().len(),
        "state": state(&moment.state),
        "patches": moment.patches.len(),
        "largest_patch": moment.patches.first().map(|(patch, carried)| json!({
            "nodes": patch.nodes,
            "area": patch.area,
            "load": carried.load,
            "mean_pressure": carried.mean_pressure,
        })),
    });
    if let Some(followed) = followed {
        for passage in followed.passages.iter().chain(&followed.around) {
            object[passage.key] = json!(passage.at.as_ref().map(state));
        }
    }
    let on = (&record.grid(), record.kernel().boundary);
    for (name, axis) in [("channel_x", Axis::X), ("channel_y", Axis::Y)] {
        let narrowest = constriction(&moment.gap, &moment.contact_map, on, axis)?;
        object[name] = json!(
            narrowest
                .map(|place| json!({ "node": [place.node.0, place.node.1], "gap": place.gap }))
        );
    }
    object["warnings"] = json!(warnings(record, moment)?);
    Ok(object)
}

fn state(state: &LoadingState) -> Value {
    json!({
        "step": state.step,
        "load": state.contact.load,
        "mean_pressure": state.contact.mean_pressure(),
        "contact_area_fraction": state.contact.contact_area_fraction,
        "mean_gap": state.contact.mean_gap,
    })
}
