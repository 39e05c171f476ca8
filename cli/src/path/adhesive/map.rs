//! `contact_map.png` of a state with adhesion: out of range, pulled, and in contact.

use std::path::{Path, PathBuf};

use asperity::Grid;
use asperity::adhesion::{AdhesiveState, NodeState};
use asperity_cli::field_map::{FieldMap, Scale};
use asperity_cli::number::{counted, quantity};
use asperity_cli::outcome::Failure;
use nalgebra::DMatrix;

use super::super::fields::Fields;

/// Draws a state. Nodes that are pulled across a gap have a colour of their own, and so have those in contact whose
/// pressure is below 0.
pub(super) fn draw(
    grid: &Grid,
    state: &AdhesiveState,
    (fields, nodes): (&Fields, &DMatrix<NodeState>),
    name: &Path,
) -> Result<PathBuf, Failure> {
    let pressure = fields.iter().find(|(name, _)| *name == "pressure").map(|(_, field)| field);
    let Some(pressure) = pressure else { return Ok(name.to_path_buf()) };
    let values = pressure.zip_map(nodes, |pressure, node| match node {
        NodeState::Contact => pressure,
        NodeState::Open => f64::NAN,
        _ => f64::NEG_INFINITY,
    });
    let caption = format!(
        "{} in contact, {} pulled, A/A₀ = {:.4} %, W = {}",
        counted(state.contact.contact_nodes, "node"),
        state.soft_nodes + state.cohesive_nodes,
        100.0 * state.contact.contact_area_fraction,
        quantity(state.contact.load, "N", 4)
    );
    FieldMap {
        grid,
        length_unit: "m",
        values: &values,
        range: (0.0, pressure.max().max(0.0)),
        scale: Scale::Linear,
        contours: &[],
        label: ("pressure", "Pa"),
    }
    .write(name, &caption)
}
