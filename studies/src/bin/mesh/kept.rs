//! States that an earlier run has left in its table.

use std::path::Path;

use crate::states::{LOADS, Mesh, State};

/// The table of an earlier run; empty if there is none that can be read.
#[derive(Default)]
pub(crate) struct Kept {
    rows: Vec<(Mesh, u64, State)>,
}

impl Kept {
    pub(crate) fn read(name: &Path) -> Self {
        let rows = csv::Reader::from_path(name).and_then(|mut reader| {
            let rows = reader.deserialize::<(usize, usize, u64, [f64; 5])>();
            let read = rows.map(|row| {
                let (band, cells, seed, [load, area, corrected, gap, stiffness]) = row?;
                let state = State { load, area, corrected, gap, stiffness };
                Ok((Mesh { band, cells }, seed, state))
            });
            read.collect()
        });
        Self { rows: rows.unwrap_or_default() }
    }

    /// The states of one surface under all loads, if all are there.
    pub(crate) fn states(&self, mesh: Mesh, seed: u64) -> Option<Vec<State>> {
        let of = |load: &f64| {
            let same =
                |row: &&(Mesh, u64, State)| row.0 == mesh && row.1 == seed && row.2.load == *load;
            self.rows.iter().find(same).map(|row| row.2)
        };
        LOADS.iter().map(of).collect()
    }
}
