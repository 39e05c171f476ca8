//! Events of a path, as `asperity path` writes them.

use std::error::Error;
use std::path::Path;

/// An event.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Event {
    pub(crate) node: (usize, usize),
    pub(crate) approach: f64,
    pub(crate) load: f64,
    pub(crate) contact_stiffness: f64,
}

/// Reads a file `path.csv`.
pub(crate) fn read(file: &Path) -> Result<Vec<Event>, Box<dyn Error>> {
    let mut reader = csv::Reader::from_path(file)?;
    let columns = reader.headers()?.clone();
    let place = |name: &str| {
        let found = columns.iter().position(|column| column == name);
        found.ok_or_else(|| format!("no column {name}"))
    };
    let [ix, iy] = [place("ix")?, place("iy")?];
    let numbers = [place("approach")?, place("load")?, place("contact_stiffness")?];
    let mut events = Vec::new();
    for record in reader.records() {
        let record = record?;
        let [approach, load, contact_stiffness] = numbers.map(|column| record[column].parse());
        events.push(Event {
            node: (record[ix].parse()?, record[iy].parse()?),
            approach: approach?,
            load: load?,
            contact_stiffness: contact_stiffness?,
        });
    }
    Ok(events)
}
