//! `stick_map.png` and `wear_map.png`: which nodes slip, and what friction does to them.

use std::path::{Path, PathBuf};

use asperity::slip::SlipZone;
use asperity_cli::field_map::{FieldMap, Scale};
use asperity_cli::number::{counted, quantity};
use asperity_cli::outcome::Failure;
use nalgebra::DMatrix;

use super::joint::Joint;

/// The least work that is told from none in the map, over the greatest.
const WEAR: f64 = 1e-3;

/// Draws both.
pub(super) fn draw(joint: &Joint, directory: &Path) -> Result<Vec<PathBuf>, Failure> {
    let failed = |error| Failure::new("cannot compute the maps", error);
    let (slip, state) = (&joint.slip, &joint.state);
    let force = state.tangential_load;
    let mut path = joint.record.replay().map_err(failed)?;
    let zones = slip.zones(&path, force).map_err(failed)?;
    // Three fields of the path: the pressures under both loads, and the gap under one of them.
    let full = slip.bed().path_state(state.load).map_err(failed)?;
    let limit = path.fields_at(&full).map_err(failed)?.pressure * slip.friction().coefficient();
    let stick = slip.bed().path_state(state.stick_load).map_err(failed)?;
    let sticking = path.fields_at(&stick).map_err(failed)?.pressure * slip.friction().coefficient();
    let traction = &limit - sticking;
    let slipped = slip.slip(&mut path, force).map_err(failed)?;

    let share = DMatrix::from_fn(zones.nrows(), zones.ncols(), |ix, iy| match zones[(ix, iy)] {
        SlipZone::Slip => 1.0,
        SlipZone::Stick if limit[(ix, iy)] > 0.0 => {
            (traction[(ix, iy)] / limit[(ix, iy)]).clamp(0.0, 1.0)
        }
        _ => f64::NAN,
    });
    let work = DMatrix::from_fn(zones.nrows(), zones.ncols(), |ix, iy| match zones[(ix, iy)] {
        SlipZone::Slip => 4.0 * slipped[(ix, iy)] * limit[(ix, iy)].max(0.0),
        SlipZone::Stick => 0.0,
        _ => f64::NAN,
    });
    let grid = joint.record.grid();
    let map = |values, scale, range, label| FieldMap {
        grid: &grid,
        length_unit: "m",
        values,
        range,
        scale,
        contours: &[],
        label,
    };
    let label = ("traction over the limit of friction", "1 = slips");
    let stick_map = map(&share, Scale::Linear, (0.0, 1.0), label).write(
        &directory.join("stick_map.png"),
        &format!(
            "T = {} under P = {}: {} in stick, {} in slip",
            quantity(force, "N", 4),
            quantity(state.load, "N", 4),
            counted(state.stick_nodes, "node"),
            state.slipping_nodes
        ),
    )?;
    let mut maps = vec![stick_map];
    let greatest = work.iter().copied().filter(|work| !work.is_nan()).fold(0.0, f64::max);
    // Where nothing slips there is no wear.
    if greatest > 0.0 {
        let label = ("friction work of a cycle", "J/m²");
        let range = (WEAR * greatest, greatest);
        maps.push(map(&work, Scale::Logarithmic, range, label).write(
            &directory.join("wear_map.png"),
            &format!(
                "a cycle of T = {} loses {}",
                quantity(force, "N", 4),
                quantity(joint.cycle.dissipation, "J", 4)
            ),
        )?);
    }
    Ok(maps)
}
