//! What is printed.

use asperity::stress::{Greatest, Measure, Survey};
use asperity_cli::number::{counted, quantity, significant};
use asperity_cli::say;
use serde_json::{Value, json};

use super::body::{Body, Material, Moment, Yielding};

/// Nodes in contact below which a first yield is that of the grid.
const FEW_NODES: usize = 50;

/// One object for programs.
pub(super) fn object(moment: &Moment, bodies: &[Body], warnings: &[String]) -> Value {
    let (friction, angle) = moment.friction;
    json!({
        "load": moment.state.contact.load,
        "mean_pressure": moment.state.contact.mean_pressure(),
        "friction": friction,
        "angle": angle,
        "bodies": bodies.iter().map(of_body).collect::<Vec<_>>(),
        "warnings": warnings,
    })
}

fn of_body(body: &Body) -> Value {
    let mut value = json!({
        "poissons_ratio": body.below.poissons_ratio(),
        "depths": body.survey.depths.iter().map(|depth| depth.depth).collect::<Vec<_>>(),
        "materials": body.materials.iter().map(of_material).collect::<Vec<_>>(),
    });
    put_greatest(&mut value, &body.survey);
    value
}

fn of_material(material: &Material) -> Value {
    let yielding = material.yielding.as_ref();
    let mut value = json!({
        "yield_stress": yielding.map(|yielding| yielding.stress),
        "first_yield": yielding.and_then(|yielding| yielding.first).map(|first| json!({
            "load": first.state.contact.load,
            "contact_nodes": first.state.contact.contact_nodes,
            "von_mises": place(first.greatest),
        })),
    });
    put_greatest(&mut value, &material.survey);
    value
}

/// The greatest stresses of a survey, null without a depth.
fn put_greatest(value: &mut Value, survey: &Survey) {
    for measure in Measure::ALL {
        value[measure.name()] = match survey.depths[..] {
            [] => Value::Null,
            _ => place(survey.greatest(measure)),
        };
    }
}

fn place(greatest: Greatest) -> Value {
    json!({
        "value": greatest.value,
        "depth": greatest.depth,
        "node": [greatest.node.0, greatest.node.1],
    })
}

/// Lines for people.
pub(super) fn print(moment: &Moment, bodies: &[Body]) {
    let contact = &moment.state.contact;
    let (nx, ny) = moment.record.grid().shape();
    say!(
        "state         W = {}, A/A0 = {:.2} %, mean pressure {}, greatest {}, on {nx} x {ny} nodes",
        quantity(contact.load, "N", 4),
        100.0 * contact.contact_area_fraction,
        quantity(contact.mean_pressure(), "Pa", 4),
        quantity(moment.pressure.max(), "Pa", 4)
    );
    let (friction, angle) = moment.friction;
    if friction > 0.0 {
        say!("friction      {friction} in a direction of {}° from x", significant(angle, 6));
    }
    for body in bodies {
        let depths = counted(body.survey.depths.len(), "depth");
        match body.below.layers() {
            Some(layers) => {
                let count = counted(layers.layers().len(), "layer");
                say!("{:<13} {count}, {depths}", body.name);
            }
            None => say!("{:<13} ν = {}, {depths}", body.name, body.below.poissons_ratio()),
        }
        for (measure, name) in [
            (Measure::VonMises, "von Mises"),
            (Measure::Tresca, "Tresca"),
            (Measure::GreatestShear, "greatest shear"),
            (Measure::GreatestTension, "greatest tension"),
        ] {
            say_greatest(&format!("  {name:<17}"), body.survey.greatest(measure));
            if measure == Measure::VonMises {
                for Material { name, survey, .. } in &body.materials {
                    if let (Some(name), false) = (name, survey.depths.is_empty()) {
                        let label = format!("    {:<15}", format!("in {name}"));
                        say_greatest(&label, survey.greatest(measure));
                    }
                }
            }
        }
        for Material { name, yielding, .. } in &body.materials {
            let Some(Yielding { stress, first }) = yielding else { continue };
            let who = name.as_ref().map_or(String::new(), |name| format!("{name} "));
            let strength = quantity(*stress, "Pa", 4);
            match first {
                Some(first) => say!(
                    "  {who}yields first at W = {}, where von Mises' stress is {strength} at a depth of {}, with {} in contact",
                    quantity(first.state.contact.load, "N", 4),
                    quantity(first.greatest.depth, "m", 4),
                    counted(first.state.contact.contact_nodes, "node")
                ),
                None => {
                    say!(
                        "  {who}does not yield on this path: von Mises' stress stays below {strength}"
                    );
                }
            }
        }
    }
}

fn say_greatest(label: &str, found: Greatest) {
    say!(
        "{label} {} at a depth of {}, below node ({}, {})",
        quantity(found.value, "Pa", 4),
        quantity(found.depth, "m", 4),
        found.node.0,
        found.node.1
    );
}

/// What the figures do not say; `searched` if the depths are not those of the user.
pub(super) fn warnings(moment: &Moment, bodies: &[Body], searched: bool) -> Vec<String> {
    let mut warnings = Vec::new();
    if moment.state.contact.plastic.is_some_and(|plastic| plastic.yielded_nodes > 0) {
        warnings.push(
            "nodes have yielded: these are the elastic stresses under the pressures, without the residual stresses that yielding leaves"
                .to_string(),
        );
    }
    let cell = moment.record.grid().cell_area().sqrt();
    for body in bodies {
        let greatest = body.survey.greatest(Measure::VonMises);
        if searched && greatest.depth > 0.0 && greatest.depth < 2.0 * cell {
            warnings.push(format!(
                "in the {} von Mises' stress is greatest {} below the surface, less than two cells: it is that of the grid. A finer one tells more",
                body.name,
                quantity(greatest.depth, "m", 3)
            ));
        }
        for Material { name, yielding, .. } in &body.materials {
            let first = yielding.as_ref().and_then(|yielding| yielding.first);
            if let Some(first) = first.filter(|first| first.state.contact.contact_nodes < FEW_NODES)
            {
                warnings.push(format!(
                    "{} yields with {} in contact: below some {FEW_NODES} of them the load of first yield is that of the grid",
                    name.clone().unwrap_or_else(|| format!("the {}", body.name)),
                    counted(first.state.contact.contact_nodes, "node")
                ));
            }
        }
    }
    warnings
}
