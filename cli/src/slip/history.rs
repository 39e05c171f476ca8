//! The joint along a history of both loads from a table.

use std::path::Path;

use asperity::slip::{SlipHistory, SlipState};
use asperity_cli::outcome::Failure;

use super::joint::Joint;

/// Points between two rows, for the picture.
const BETWEEN: usize = 24;

/// What a history has done to the joint.
pub(super) struct Sheared {
    /// At each row, with the energy lost so far.
    pub(super) rows: Vec<(SlipState, f64)>,
    /// The same with states in between.
    pub(super) curve: Vec<SlipState>,
}

impl Sheared {
    /// From no load along the rows of a file.
    pub(super) fn follow(joint: &Joint, name: &Path) -> Result<Self, Failure> {
        let text = std::fs::read_to_string(name)
            .map_err(|error| Failure::new(format!("cannot read {}", name.display()), error))?;
        let steps = rows(&text)
            .map_err(|wrong| Failure::request(format!("cannot use {}: {wrong}", name.display())))?;
        let mut history = SlipHistory::new(joint.slip.bed(), joint.slip.friction());
        let (mut rows, mut curve) = (Vec::new(), Vec::new());
        let mut from = (0.0, 0.0);
        for (line, load, force) in steps {
            let failed = |error| Failure::new(format!("line {line} of {}", name.display()), error);
            // In parts, which change nothing.
            for part in 1..=BETWEEN {
                let share = part as f64 / BETWEEN as f64;
                let between =
                    |a: f64, b: f64| if part == BETWEEN { b } else { a + share * (b - a) };
                let to = (between(from.0, load), between(from.1, force));
                let state = history.to(to.0, to.1).map_err(failed)?;
                curve.push(state);
            }
            rows.push((history.state(), history.dissipation()));
            from = (load, force);
        }
        Ok(Self { rows, curve })
    }

    /// Energy lost in all \[J\].
    pub(super) fn dissipation(&self) -> f64 {
        self.rows.last().map_or(0.0, |row| row.1)
    }
}

/// Line, load and tangential load of each row.
fn rows(text: &str) -> Result<Vec<(usize, f64, f64)>, String> {
    let mut lines = (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty());
    let (_, header) = lines.next().ok_or("it is empty")?;
    let names: Vec<&str> = header.split(',').map(str::trim).collect();
    let place = |name: &str| {
        let found = names.iter().position(|other| *other == name);
        found.ok_or_else(|| format!("its first line names no column `{name}`, but `{header}`"))
    };
    let (load, force) = (place("load")?, place("tangential_load")?);
    let rows = lines.map(|(line, text)| {
        let cells: Vec<&str> = text.split(',').map(str::trim).collect();
        let number = |place: usize| {
            let cell = cells.get(place).copied().unwrap_or_default();
            let value = cell.parse().ok().filter(|value: &f64| value.is_finite());
            value.ok_or_else(|| format!("`{cell}` in line {line} is no finite number"))
        };
        Ok((line, number(load)?, number(force)?))
    });
    let rows: Vec<_> = rows.collect::<Result<_, String>>()?;
    if rows.is_empty() { Err("it has no rows".to_string()) } else { Ok(rows) }
}

#[cfg(test)]
mod tests {
    use super::rows;

    #[test]
    fn tables_are_read_by_their_names() {
        let found = rows("t, tangential_load, load\n0,1.5,2\n\n1,-0.5,2e3\n");
        assert_eq!(found, Ok(vec![(2, 2.0, 1.5), (4, 2000.0, -0.5)]));
        for (text, word) in [
            ("", "empty"),
            ("load,tangential_load\n", "rows"),
            ("1,2\n3,4\n", "no column `load`"),
            ("load,tangential_load\n1\n", "line 2"),
            ("load,tangential_load\n1,nan\n", "`nan`"),
        ] {
            assert!(rows(text).is_err_and(|wrong| wrong.contains(word)), "{text}");
        }
    }
}
