//! `von_mises_map.png` and `shear_map.png`: the stresses at the depths where they are greatest.

use std::path::{Path, PathBuf};

use asperity::stress::Measure;
use asperity_cli::field_map::{FieldMap, Scale};
use asperity_cli::number::quantity;
use asperity_cli::outcome::Failure;

use super::body::{Body, Moment};

/// Draws both.
pub(super) fn draw(
    moment: &Moment,
    body: &Body,
    directory: &Path,
) -> Result<Vec<PathBuf>, Failure> {
    let grid = &moment.record.grid();
    let maps = [
        (Measure::VonMises, "von Mises' stress", "von_mises_map.png"),
        (Measure::GreatestShear, "greatest shear stress", "shear_map.png"),
    ];
    let drawn = maps.into_iter().map(|(measure, label, name)| {
        let greatest = body.survey.greatest(measure);
        let field = body
            .below
            .at_depth(&moment.pressure, greatest.depth)
            .map_err(|error| Failure::new("cannot compute the map of stress", error))?;
        let map = FieldMap {
            grid,
            length_unit: "m",
            values: &field.map(measure),
            range: (0.0, greatest.value),
            scale: Scale::Linear,
            contours: &[],
            label: (label, "Pa"),
        };
        let caption = format!(
            "W = {}, at a depth of {}: at most {}",
            quantity(moment.state.contact.load, "N", 4),
            quantity(greatest.depth, "m", 4),
            quantity(greatest.value, "Pa", 4)
        );
        map.write(&directory.join(name), &caption)
    });
    drawn.collect()
}
