//! The order and the kinds of all events, and the scalars at each.

use asperity::patches::{Connectivity, ContactEdge, PatchHistory};
use asperity::record::LoadingRecord;
use asperity::{ContactEvent, Error, LoadingState};
use serde_json::{Map, Value, json};

use crate::blob::planes;
use crate::column::{count, optional, quantity};

/// All events of a record.
pub(crate) fn of(record: &LoadingRecord) -> Result<Value, Error> {
    let (states, grid) = (record.states(), record.grid());
    let nodes: Vec<u32> =
        states.iter().map(|state| (state.node.0 + grid.nx() * state.node.1) as u32).collect();
    let kinds: Vec<u32> = states.iter().map(|state| state.event.code().into()).collect();
    let column = |unit: &str, value: fn(&LoadingState) -> f64| {
        quantity(unit, &states.iter().map(value).collect::<Vec<_>>())
    };
    let stiffness = |value: fn(&LoadingState) -> Option<f64>| {
        optional("N/m", &states.iter().map(value).collect::<Vec<_>>())
    };
    let boundary = record.kernel().boundary;
    let mut edge = ContactEdge::new(grid, boundary);
    let corrected = states.iter().map(|state| {
        edge.follow(state.event, state.node)?;
        Ok(edge.corrected_area() / grid.nominal_area())
    });
    let mut columns = Map::new();
    let mut add = |name: &str, column: Option<Value>| {
        columns.extend(column.map(|column| (name.to_string(), column)));
    };
    add("load", Some(column("N", |state| state.contact.load)));
    add("approach", Some(column("m", |state| state.contact.approach)));
    add("corrected", Some(quantity("1", &corrected.collect::<Result<Vec<_>, Error>>()?)));
    add("mean_gap", Some(column("m", |state| state.contact.mean_gap)));
    add("contact_stiffness", stiffness(|state| state.contact.contact_stiffness));
    add("interfacial_stiffness", stiffness(|state| state.contact.interfacial_stiffness));
    // Where nodes leave, patches cannot be followed.
    if !states.iter().any(|state| state.event == ContactEvent::Release) {
        let contact = record.contact()?;
        let mut patches = PatchHistory::new(&contact, boundary, Connectivity::Four);
        let (mut number, mut largest) = (Vec::new(), Vec::new());
        let mut present = (0, 0);
        for state in states {
            if state.event == ContactEvent::Touch
                && let Some(found) = patches.next()
            {
                present = (found.patches, found.largest);
            }
            number.push(present.0);
            largest.push(present.1);
        }
        add("patches", Some(count(&number)));
        add("largest_patch", Some(count(&largest)));
    }
    let plastic: Vec<_> =
        states.iter().map(|state| state.contact.plastic.map(|plastic| plastic.volume)).collect();
    add("plastic_volume", optional("m³", &plastic));
    Ok(json!({
        "count": states.len(),
        "nodes": planes(&nodes),
        "kinds": planes(&kinds),
        "columns": columns,
    }))
}
