//! The nodes in contact, coloured by pressure.

use std::path::{Path, PathBuf};

use asperity::{ContactState, Grid};
use asperity_cli::field_map::{FieldMap, Scale};
use asperity_cli::number::{counted, quantity};
use asperity_cli::outcome::Failure;
use nalgebra::DMatrix;

/// Draws a state of contact.
pub(crate) fn draw(
    grid: &Grid,
    state: &ContactState,
    pressure: &DMatrix<f64>,
    contact_map: &DMatrix<bool>,
    yielded_map: Option<&DMatrix<bool>>,
    name: &Path,
) -> Result<PathBuf, Failure> {
    let yielded = yielded_map.map_or(0, |map| map.iter().filter(|has| **has).count());
    let of_them = if yielded > 0 { format!(", {yielded} of them yielded") } else { String::new() };
    let caption = format!(
        "{} in contact{of_them}, A/A₀ = {:.4} %, W = {}",
        counted(state.contact_nodes, "node"),
        100.0 * state.contact_area_fraction,
        quantity(state.load, "N", 4)
    );
    let greatest = pressure.iter().copied().fold(0.0, f64::max);
    let in_contact = |pressure: f64, is_in| if is_in { pressure } else { f64::NAN };
    let mut values = pressure.zip_map(contact_map, in_contact);
    for (value, has_yielded) in values.iter_mut().zip(yielded_map.into_iter().flatten()) {
        if *has_yielded {
            *value = f64::INFINITY;
        }
    }
    FieldMap {
        grid,
        length_unit: "m",
        values: &values,
        range: (0.0, greatest),
        scale: Scale::Linear,
        contours: &[],
        label: ("pressure", "Pa"),
    }
    .write(name, &caption)
}
