//! The states of a path, from `path.csv`.

use std::fs;
use std::path::Path;

use asperity_cli::outcome::Failure;

/// Columns besides the load, and whether they are linear in the load between two events; others change at events.
pub(super) const COLUMNS: [(&str, bool); 6] = [
    ("contact_area_fraction", false),
    ("corrected_contact_area", false),
    ("approach", true),
    ("mean_gap", true),
    ("contact_stiffness", false),
    ("interfacial_stiffness", false),
];

/// Loads and columns of all states.
pub(super) struct Table {
    /// The load and the columns of each state.
    rows: Vec<(f64, Vec<f64>)>,
}

impl Table {
    pub(super) fn read(file: &Path) -> Result<Self, Failure> {
        let bad = |what: String| Failure::request(format!("{}: {what}", file.display()));
        let text = fs::read_to_string(file)
            .map_err(|error| Failure::new(format!("cannot read {}", file.display()), error))?;
        let mut lines = text.lines();
        let header: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
        let place = |name: &str| {
            let found = header.iter().position(|other| *other == name);
            found.ok_or_else(|| bad(format!("there is no column {name}")))
        };
        let load = place("load")?;
        let columns: Vec<usize> =
            COLUMNS.iter().map(|(name, _)| place(name)).collect::<Result<_, _>>()?;
        let mut rows: Vec<(f64, Vec<f64>)> = Vec::new();
        for (number, line) in lines.enumerate() {
            let cells: Vec<&str> = line.split(',').collect();
            let value = |place: usize| match cells.get(place) {
                // A stiffness that there is not.
                Some(&"") => Some(f64::NAN),
                Some(cell) => cell.parse::<f64>().ok(),
                None => None,
            };
            let row: Option<Vec<f64>> = columns.iter().map(|&place| value(place)).collect();
            let (Some(load), Some(row)) = (value(load).filter(|w| !w.is_nan()), row) else {
                return Err(bad(format!("line {} is no state", number + 2)));
            };
            rows.push((load, row));
        }
        Ok(Self { rows })
    }

    /// The first and the last load above zero.
    pub(super) fn loads(&self) -> Option<(f64, f64)> {
        let mut loads = self.rows.iter().map(|(load, _)| *load).filter(|load| *load > 0.0);
        let first = loads.next()?;
        Some((first, loads.next_back()?))
    }

    /// The columns at a load: of the last event up to it, or between that and the next.
    pub(super) fn at(&self, load: f64) -> Vec<f64> {
        let after = self.rows.partition_point(|(other, _)| *other <= load);
        let Some((from, before)) = after.checked_sub(1).and_then(|k| self.rows.get(k)) else {
            return vec![f64::NAN; COLUMNS.len()];
        };
        let Some((to, next)) = self.rows.get(after) else {
            return before.clone();
        };
        let way = (load - from) / (to - from);
        let both = before.iter().zip(next).zip(COLUMNS);
        both.map(|((a, b), (_, is_linear))| if is_linear { a + way * (b - a) } else { *a })
            .collect()
    }
}
