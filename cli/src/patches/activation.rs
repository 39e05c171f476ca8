//! `activation.png`: the load at which each node touched, which is every contact map of the path in one.

use std::path::{Path, PathBuf};

use asperity::patches::activation_map;
use asperity::record::LoadingRecord;
use asperity_cli::field_map::{FieldMap, Scale};
use asperity_cli::number::{counted, quantity};
use asperity_cli::outcome::Failure;

/// The share of the nodes that touch below the range of the colours, so that the first few take no decades of it.
const BELOW: f64 = 1e-3;

/// Draws the map, with lines where the contact ends at round loads.
pub(super) fn draw(record: &LoadingRecord, name: &Path) -> Result<PathBuf, Failure> {
    let grid = record.grid();
    let loads = activation_map(&grid, record.states(), |state| state.contact.load)
        .map_err(|error| Failure::new("cannot make the map of activation", error))?;
    let mut positive: Vec<f64> = loads.iter().copied().filter(|load| *load > 0.0).collect();
    positive.sort_by(f64::total_cmp);
    let place = ((BELOW * grid.nodes() as f64) as usize).min(positive.len() / 2);
    let (Some(&least), Some(&greatest)) = (positive.get(place), positive.last()) else {
        return Err(Failure::request("there is no map of activation: no node touched under load"));
    };
    let touched = loads.iter().filter(|load| !load.is_nan()).count();
    // The first node touches at no load: it is as light as the end of the scale.
    let values = loads.map(|load| if load.is_nan() { load } else { load.max(least) });
    FieldMap {
        grid: &grid,
        length_unit: "m",
        values: &values,
        range: (least, greatest),
        scale: Scale::Logarithmic,
        contours: &rounds(least, greatest),
        label: ("load at which the node touched", "N"),
    }
    .write(
        name,
        &format!(
            "{touched} of {} touched, up to W = {}",
            counted(grid.nodes(), "node"),
            quantity(greatest, "N", 4)
        ),
    )
}

/// Powers of ten between two loads; if there is only one or none, twice and five times those too.
fn rounds(least: f64, greatest: f64) -> Vec<f64> {
    let (first, last) = (least.log10().floor() as i32, greatest.log10().ceil() as i32);
    let between = |digits: &[f64]| -> Vec<f64> {
        let all =
            (first..=last).flat_map(|decade| digits.iter().map(move |d| d * 10_f64.powi(decade)));
        all.filter(|load| (least..greatest).contains(load)).collect()
    };
    let decades = between(&[1.0]);
    if decades.len() > 1 { decades } else { between(&[1.0, 2.0, 5.0]) }
}

#[cfg(test)]
mod tests {
    use super::rounds;

    #[test]
    fn lines_are_at_round_loads() {
        assert_eq!(rounds(0.5, 300.0), [1.0, 10.0, 100.0]);
        assert_eq!(rounds(0.15, 3.0), [0.2, 0.5, 1.0, 2.0]);
        assert!(rounds(2.1, 4.9).is_empty());
    }
}
