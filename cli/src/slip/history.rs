//! The joint along a history of both loads from a table.

use std::path::Path;

use asperity::slip::{SlipHistory, SlipState};
use asperity_cli::outcome::Failure;

use super::joint::Joint;
use crate::history_table::HistoryTable;
use crate::values::FORCE;

/// Points between two rows, for the picture.
const BETWEEN: usize = 24;

/// What a history has done to the joint.
pub(super) struct Sheared {
    /// At each row, with the energy lost so far.
    pub(super) rows: Vec<(SlipState, f64)>,
    /// The way to each row, from the one before.
    pub(super) ways: Vec<Vec<SlipState>>,
}

impl Sheared {
    /// From no load along the rows of a file.
    pub(super) fn follow(joint: &Joint, name: &Path) -> Result<Self, Failure> {
        let steps = HistoryTable::read(name, loads)?;
        let mut history = SlipHistory::new(joint.slip.bed(), joint.slip.friction());
        let (mut rows, mut ways) = (Vec::new(), Vec::new());
        let mut from = (0.0, 0.0);
        for (line, load, force) in steps {
            let failed = |error| Failure::new(format!("line {line} of {}", name.display()), error);
            let mut way = vec![history.state()];
            // In parts, which change nothing.
            for part in 1..=BETWEEN {
                let share = part as f64 / BETWEEN as f64;
                let between =
                    |a: f64, b: f64| if part == BETWEEN { b } else { a + share * (b - a) };
                let to = (between(from.0, load), between(from.1, force));
                let state = history.to(to.0, to.1).or_else(|error| {
                    // The row as it is written says more than a part of the way there.
                    history.to(load, force).and(Err(error))
                });
                way.push(state.map_err(failed)?);
            }
            ways.push(way);
            rows.push((history.state(), history.dissipation()));
            from = (load, force);
        }
        Ok(Self { rows, ways })
    }

    /// Energy lost in all \[J\].
    pub(super) fn dissipation(&self) -> f64 {
        self.rows.last().map_or(0.0, |row| row.1)
    }
}

/// Line, load and tangential load of each row.
fn loads(table: &HistoryTable) -> Result<Vec<(usize, f64, f64)>, String> {
    let pairs =
        table.column("load", &FORCE)?.into_iter().zip(table.column("tangential_load", &FORCE)?);
    let rows: Vec<_> = table.lines().zip(pairs).map(|(line, (p, t))| (line, p, t)).collect();
    if rows.is_empty() { Err("it has no rows".to_string()) } else { Ok(rows) }
}

#[cfg(test)]
mod tests {
    use super::{HistoryTable, loads};

    #[test]
    fn loads_are_read_by_their_names() {
        let read = |text| HistoryTable::parse(text).and_then(|table| loads(&table));
        let found = read("t, tangential_load, load\n0,1.5,2\n\n1,-0.5,2e3\n");
        assert_eq!(found, Ok(vec![(2, 2.0, 1.5), (4, 2000.0, -0.5)]));
        for (text, word) in
            [("load,tangential_load\n", "rows"), ("load,t\n1,2", "`tangential_load`")]
        {
            assert!(read(text).is_err_and(|wrong| wrong.contains(word)), "{text}");
        }
    }
}
