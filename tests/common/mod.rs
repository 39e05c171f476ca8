//! Reference data shared by the integration tests.
#![allow(clippy::unwrap_used, dead_code, unreachable_pub, missing_docs)]

use std::path::PathBuf;

use asperity::surface::HeightMap;

/// One line of an event file.
#[derive(Debug, Clone)]
pub struct Event {
    pub step: usize,
    pub node: (usize, usize),
    pub approach: f64,
    pub load: f64,
    pub contact_area: f64,
    pub contact_area_fraction: f64,
    pub mean_gap: f64,
    pub contact_stiffness: f64,
    pub interfacial_stiffness: f64,
    pub max_pressure: f64,
}

fn data(name: String) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data")
        .join(name)
}

/// Heights of a reference surface.
pub fn surface(name: &str) -> HeightMap {
    HeightMap::from_npy(data(format!("{name}.npy"))).unwrap()
}

/// The events of a reference path.
pub fn read_events(name: &str) -> Vec<Event> {
    let mut reader = csv::Reader::from_path(data(format!("{name}_events.csv"))).unwrap();
    let rows = reader.deserialize::<Vec<f64>>().map(Result::unwrap);
    rows.map(|row| Event {
        step: row[0] as usize,
        node: (row[1] as usize, row[2] as usize),
        approach: row[3],
        load: row[4],
        contact_area: row[5],
        contact_area_fraction: row[6],
        mean_gap: row[7],
        contact_stiffness: row[8],
        interfacial_stiffness: row[9],
        max_pressure: row[10],
    })
    .collect()
}
