//! What is printed.

use asperity::leak::{CriticalConstriction, Leak, LeakCurve, LeakPoint, Seal};
use asperity::record::LoadingRecord;
use asperity::surface::Axis;
use asperity::{Boundary, LoadingState};
use asperity_cli::number::{counted, quantity, scientific, significant};
use asperity_cli::say;
use serde_json::{Value, json};

use crate::columns::{Column, print};

/// Rows of the table on the screen.
const ROWS: usize = 14;

/// In m³/s.
const MILLILITRE_A_MINUTE: f64 = 1e-6 / 60.0;

/// The side across the flow \[m\].
fn across(record: &LoadingRecord, seal: &Seal) -> f64 {
    let (lx, ly) = record.grid().sides();
    match seal.along() {
        Axis::X => ly,
        Axis::Y => lx,
    }
}

fn axis(seal: &Seal) -> &'static str {
    match seal.along() {
        Axis::X => "x",
        Axis::Y => "y",
    }
}

/// What is pressed through, and where.
pub(super) fn print_seal(record: &LoadingRecord, seal: &Seal) {
    let (nx, ny) = record.grid().shape();
    let sides = match record.kernel().boundary {
        Boundary::Free => "sides closed",
        Boundary::Periodic => "sides joined, as the half-space is periodic",
        Boundary::PeriodicX | Boundary::PeriodicY => {
            let [x_repeats, y_repeats] = record.kernel().boundary.repeats();
            let across = if seal.along() == Axis::X { y_repeats } else { x_repeats };
            if across { "sides joined, as the half-space repeats across" } else { "sides closed" }
        }
    };
    say!("{} on {nx} x {ny} nodes", counted(record.states().len(), "state"));
    say!(
        "fluid of {} under {} along {}, {sides}",
        quantity(seal.viscosity(), "Pa s", 4),
        quantity(seal.pressure_drop(), "Pa", 4),
        axis(seal)
    );
    if let Some(outlet) = seal.outlet_pressure() {
        say!(
            "it is an ideal gas, which leaves at {}: leak rates are volumes there; it does not slip on the surfaces",
            quantity(outlet, "Pa", 4)
        );
    }
    let narrow = match seal.least_gap() {
        0.0 => String::new(),
        gap => format!(", through gaps of {} and less", quantity(gap, "m", 4)),
    };
    say!(
        "nothing flows through contact{narrow} or across corners of cells; the fluid does not open the gap"
    );
    say!();
}

/// Some of the points, and where the last channel closes.
pub(super) fn print_curve(curve: &LeakCurve, record: &LoadingRecord, seal: &Seal) {
    let points = &curve.points;
    let some = (0..points.len())
        .filter(|k| (points.len() - 1 - k).is_multiple_of(1 + points.len() / ROWS));
    let rows: Vec<&LeakPoint> = some.map(|k| &points[k]).collect();
    let of = |quantity: fn(&LeakPoint) -> f64| rows.iter().map(move |point| quantity(point));
    let narrowest = |point: &LeakPoint| point.constriction.map_or(f64::NAN, |c| c.gap);
    print(&[
        Column::new("load", "N", of(|point| point.state.contact.load)),
        Column::new("pressure", "Pa", of(|point| point.state.contact.mean_pressure())),
        Column::percent("area", of(|point| point.state.contact.contact_area_fraction)),
        Column::new("mean gap", "m", of(|point| point.state.contact.mean_gap)),
        Column::new("narrowest", "m", of(narrowest)),
        Column::new("leak rate", "m³/s", of(|point| point.leak_rate)),
        Column::scaled("leak rate", ("ml/min", MILLILITRE_A_MINUTE), of(|point| point.leak_rate)),
        Column::scaled(
            "per metre",
            ("ml/min/m", MILLILITRE_A_MINUTE),
            rows.iter().map(|point| point.leak_rate / across(record, seal)),
        ),
        Column::new("mean field", "m³/s", of(|point| point.mean_field_leak_rate)),
        Column::percent(
            "drop share",
            of(|point| point.constriction.map_or(f64::NAN, |c| c.pressure_drop)),
        ),
        Column::percent(
            "power share",
            of(|point| point.constriction.map_or(f64::NAN, |c| c.dissipation)),
        ),
    ]);
    say!();
    say!("narrowest: the least gap of the widest channel");
    say!(
        "drop share: of the pressure drop, at that cell; power share: of the power, in the 9 x 9 cells about it"
    );
    say!("mean field: Bruggeman's estimate for a random mixture of these gaps");
    match &curve.closing {
        Some(state) => say!(
            "the last channel closes at W = {}, A/A0 = {:.2} %, mean pressure {}: from there on the leak rate is 0",
            quantity(state.contact.load, "N", 4),
            100.0 * state.contact.contact_area_fraction,
            quantity(state.contact.mean_pressure(), "Pa", 4)
        ),
        None => {
            let reached = record.states().last().map_or(0.0, |s| s.contact.contact_area_fraction);
            say!("it still leaks at the end of the path, at {:.2} % contact", 100.0 * reached);
        }
    }
    say!();
}

/// The leak at one state.
pub(super) fn print_leak(state: &LoadingState, leak: &Leak, seal: &Seal) {
    let contact = &state.contact;
    let at = format!(
        "W = {}, A/A0 = {:.2} %, mean pressure {}",
        quantity(contact.load, "N", 4),
        100.0 * contact.contact_area_fraction,
        quantity(contact.mean_pressure(), "Pa", 4)
    );
    let Some(narrowest) = leak.constriction else {
        say!("{at}: no channel leads along {}, and the leak rate is 0", axis(seal));
        return;
    };
    let throughput = match seal.outlet_pressure() {
        None => String::new(),
        // 1 Pa m³/s are 10 mbar l/s.
        Some(outlet) => {
            format!(", throughput {} mbar l/s", scientific(10.0 * outlet * leak.leak_rate, 4))
        }
    };
    say!(
        "{at}: leak rate {} m³/s, {} ml/min{throughput}",
        scientific(leak.leak_rate, 4),
        significant(leak.leak_rate / MILLILITRE_A_MINUTE, 4)
    );
    say!(
        "  narrowest at node ({}, {}), where the gap is {}: {:.1} % of the pressure drop at its cell, {:.1} % of the power in the 9 x 9 cells about it",
        narrowest.node.0,
        narrowest.node.1,
        quantity(narrowest.gap, "m", 4),
        100.0 * narrowest.pressure_drop,
        100.0 * narrowest.dissipation
    );
    say!(
        "  the fluid flows through {}; {} cut off; conserved to {:.0e}",
        counted(leak.flowing_nodes, "node"),
        match leak.pools {
            1 => "1 island is".to_string(),
            islands => format!("{islands} islands are"),
        },
        leak.imbalance
    );
}

/// A point of the curve as JSON, in SI units.
pub(super) fn point(point: &LeakPoint) -> Value {
    let mut value = state(&point.state);
    value["leak_rate"] = json!(point.leak_rate);
    value["mean_field_leak_rate"] = json!(point.mean_field_leak_rate);
    value["permeability"] = json!(point.permeability);
    value["transverse_permeability"] = json!(point.transverse_permeability);
    value["constriction"] = constriction(point.constriction);
    value["imbalance"] = json!(point.imbalance);
    value
}

/// The leak at one state, with what there is besides.
pub(super) fn leak(at: &LoadingState, leak: &Leak) -> Value {
    let mut value = state(at);
    value["leak_rate"] = json!(leak.leak_rate);
    value["mean_field_leak_rate"] = json!(leak.mean_field_leak_rate);
    value["permeability"] = json!(leak.permeability);
    value["transverse_permeability"] = json!(leak.transverse_permeability);
    value["constriction"] = constriction(leak.constriction);
    value["imbalance"] = json!(leak.imbalance);
    value["flowing_nodes"] = json!(leak.flowing_nodes);
    value["pools"] = json!(leak.pools);
    value
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

fn constriction(constriction: Option<CriticalConstriction>) -> Value {
    constriction.map_or(Value::Null, |narrowest| {
        json!({
            "node": [narrowest.node.0, narrowest.node.1],
            "gap": narrowest.gap,
            "pressure_drop": narrowest.pressure_drop,
            "dissipation": narrowest.dissipation,
        })
    })
}

/// The last of all states, with all of them, the outlet pressure of a gas, and what looks wrong.
pub(super) fn document(states: Vec<Value>, seal: &Seal, warning: Option<String>) -> Option<Value> {
    let mut document = states.last()?.clone();
    document["gas_outlet_pressure"] = json!(seal.outlet_pressure());
    document["states"] = Value::Array(states);
    document["warnings"] = warning.into_iter().collect();
    Some(document)
}
