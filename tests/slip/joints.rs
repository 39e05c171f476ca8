//! Paths that the tests shear, and histories made of curves.

use asperity::contact::ContactState;
use asperity::loading::{History, LoadingBuilder};
use asperity::{ContactEvent, Grid, InfluenceKernel, LoadingSolver, LoadingState};
use asperity_testing::surfaces::rough;

/// A rough surface and its path up to a share of the area.
pub(crate) fn rough_path(
    kernel: &dyn InfluenceKernel,
    seed: u64,
    area_fraction: f64,
) -> (LoadingSolver, History) {
    let surface = rough(&kernel.grid(), seed);
    read(LoadingSolver::builder(&surface, kernel).max_area_fraction(area_fraction))
}

/// A path, and its states.
pub(crate) fn read(builder: LoadingBuilder<'_>) -> (LoadingSolver, History) {
    let mut path = builder.build().unwrap();
    let history = path.by_ref().map(Result::unwrap).collect();
    (path, history)
}

/// A history of N nodes that touch at these approaches, each adding to the stiffness, so that the load at the knots is
/// that of a curve W(δ).
pub(crate) fn of_curve(approaches: &[f64], load: impl Fn(f64) -> f64) -> History {
    let nodes = approaches.len();
    let grid = Grid::new(256, nodes / 256 + 1, 1.0, 1.0).unwrap();
    let states = approaches.iter().enumerate().map(|(k, &approach)| {
        let mut contact = ContactState::new(&grid, k + 1, approach, load(approach), -approach);
        let next = approaches.get(k + 1).map_or(1.001 * approach, |next| *next);
        let slope = (load(next) - load(approach)) / (next - approach);
        contact.contact_stiffness = Some(slope);
        contact.interfacial_stiffness = Some(slope);
        LoadingState::new(k + 1, ContactEvent::Touch, (k % 256, k / 256), contact)
    });
    states.collect()
}
