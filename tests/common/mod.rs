//! Reference data and set-ups shared by the integration tests.
#![allow(clippy::unwrap_used, dead_code, unreachable_pub, missing_docs)]

pub mod fixed_load;

use std::path::PathBuf;

use asperity::fixed_load::FixedLoadBuilder;
use asperity::loading::{History, LoadingBuilder};
use asperity::surface::{HeightMap, Paraboloid};
use asperity::updater::LinearUpdater;
use asperity::{Boussinesq, FixedLoadSolver, Grid, LoadingSolver, LoadingState};

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

/// The builder with windows of so many nodes, if that is given.
pub fn with_window<U: LinearUpdater>(
    builder: LoadingBuilder<'_, U>,
    window: Option<usize>,
) -> LoadingBuilder<'_, U> {
    match window {
        Some(size) => builder.window_size(size),
        None => builder,
    }
}

/// A sphere on a square of side 1.
pub struct Sphere {
    surface: Paraboloid,
    kernel: Boussinesq,
}

impl Sphere {
    pub fn on(n: usize) -> Self {
        Self {
            surface: Paraboloid::new(10.0).unwrap(),
            kernel: Boussinesq::new(Grid::square(n, 1.0).unwrap(), 1.0).unwrap(),
        }
    }

    pub fn builder(&self) -> LoadingBuilder<'_> {
        LoadingSolver::builder(&self.surface, &self.kernel)
    }

    pub fn fixed_load(&self) -> FixedLoadBuilder<'_> {
        FixedLoadSolver::builder(&self.surface, &self.kernel)
    }

    /// Every state to full contact.
    pub fn states(&self) -> Vec<LoadingState> {
        self.builder().build().unwrap().map(Result::unwrap).collect()
    }
}

/// The state half-way, by approach, from one event to the next; beyond full contact, if that is where
/// the path ends, at twice the approach.
pub fn half_way(state: LoadingState, next: Option<LoadingState>) -> LoadingState {
    let end = next.map_or(3.0 * state.contact.approach, |next| next.contact.approach);
    let interval: History = [state].into_iter().chain(next).collect();
    interval.at_approach(0.5 * (state.contact.approach + end)).unwrap()
}

/// The same nodes in contact under another load, whether or not that is a state.
pub fn loaded(mut state: LoadingState, load: f64) -> LoadingState {
    let change = load - state.contact.load;
    let rate = state.contact.contact_stiffness.or(state.contact.interfacial_stiffness);
    state.contact.approach += change / rate.unwrap();
    state.contact.mean_gap -= change / state.contact.interfacial_stiffness.unwrap();
    state.contact.energy += 0.5 * (state.contact.load + load) * change / rate.unwrap();
    state.contact.load = load;
    state
}

fn data(name: String) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

/// Heights of a reference surface.
pub fn surface(name: &str) -> HeightMap {
    HeightMap::new(asperity::io::read_npy(data(format!("{name}.npy"))).unwrap()).unwrap()
}

/// The events of a reference path.
pub fn read_events(name: &str) -> Vec<Event> {
    let rows = asperity_testing::table::read(data(format!("{name}_events.csv"))).into_iter();
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
