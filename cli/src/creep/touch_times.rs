//! `touch_times.png`: how long after the beginning each node touched, which is every contact map of growing contact in
//! one.

use std::path::{Path, PathBuf};

use asperity::ContactEvent;
use asperity::record::LoadingRecord;
use asperity_cli::field_map::{FieldMap, Scale};
use asperity_cli::number::counted;
use asperity_cli::outcome::Failure;
use asperity_cli::units;
use nalgebra::DMatrix;

use super::followed::Followed;

/// Draws the map; `None` if all nodes touched at once, or none did.
pub(super) fn draw(
    record: &LoadingRecord,
    followed: &Followed,
    directory: &Path,
) -> Option<Result<PathBuf, Failure>> {
    let grid = record.grid();
    let begin = followed.states.first()?.time;
    let mut times = DMatrix::from_element(grid.nx(), grid.ny(), f64::NAN);
    for (state, time) in record.states().iter().zip(&followed.times) {
        if state.event == ContactEvent::Touch {
            times[state.node] = time - begin;
        }
    }
    let touched = times.iter().filter(|time| !time.is_nan()).count();
    // What has touched at once has no place on a logarithmic scale: it has the colour of its beginning.
    let at_once = times.iter().filter(|time| **time <= 0.0).count();
    let later = || times.iter().copied().filter(|time| *time > 0.0);
    let (first, last) = (later().fold(f64::INFINITY, f64::min), later().fold(0.0, f64::max));
    let first = first.max(1e-6 * last);
    if first >= last {
        return None;
    }
    let values = times.map(|time| if time.is_nan() { time } else { time.max(first) });
    let caption = format!(
        "{touched} of {} touched, {at_once} at once, the last after {}",
        counted(grid.nodes(), "node"),
        units::time(last)
    );
    let map = FieldMap {
        grid: &grid,
        length_unit: "m",
        values: &values,
        range: (first, last),
        scale: Scale::Logarithmic,
        contours: &[],
        label: ("time until the node touched", "s"),
    };
    Some(map.write(&directory.join("touch_times.png"), &caption))
}
