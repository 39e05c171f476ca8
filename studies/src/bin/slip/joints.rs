//! The joints that are sheared: surfaces of 32 × 32 nodes in cells of side 1, E* = 1.

use asperity::loading::History;
use asperity::surface::{Amplitude, Paraboloid};
use asperity::{Boussinesq, Error, Grid, HeightMap, LoadingSolver, SelfAffine, Surface};
use nalgebra::DMatrix;

/// Nodes along a side.
pub(crate) const SIDE: usize = 32;
/// Coefficient of friction.
pub(crate) const FRICTION: f64 = 0.3;
/// Displacements, over that at which the joint slides.
pub(crate) const LEVELS: [f64; 5] = [0.03, 0.1, 0.3, 0.6, 0.9];

/// The values of several joints at each level: the least and the greatest, where they differ.
pub(crate) fn ranges(joints: &[Vec<f64>], digits: usize) -> String {
    let levels = joints.first().map_or(0, Vec::len);
    let each = (0..levels).map(|level| {
        let of = || joints.iter().map(|joint| joint[level]);
        let (least, most) =
            (of().fold(f64::INFINITY, f64::min), of().fold(f64::NEG_INFINITY, f64::max));
        let [least, most] = [least, most].map(|value| format!("{value:.digits$}"));
        if least == most { least } else { format!("{least}–{most}") }
    });
    each.collect::<Vec<_>>().join(", ")
}

/// A surface with its path.
pub(crate) struct Pressed {
    pub(crate) history: History,
    /// Nodes in the order in which they touch.
    pub(crate) order: Vec<usize>,
    /// Initial gaps.
    pub(crate) gap: Vec<f64>,
    /// The load at which they are sheared, between two events.
    pub(crate) load: f64,
    /// Pressures there.
    pub(crate) pressure: DMatrix<f64>,
}

impl Pressed {
    /// A surface under the load between its events `nodes` and `nodes + 1`.
    fn new(heights: HeightMap, nodes: usize) -> Result<Self, Error> {
        let grid = Grid::square(SIDE, SIDE as f64)?;
        let kernel = Boussinesq::new(grid, 1.0)?;
        let mut path = LoadingSolver::builder(&heights, &kernel).max_nodes(nodes + 1).build()?;
        let history = path.run()?;
        let at = |step: usize| history.states().get(step).map_or(0.0, |state| state.contact.load);
        let load = 0.5 * (at(nodes - 1) + at(nodes));
        let state = history.at(asperity::ContactTarget::Load(load))?;
        let pressure = path.fields_at(&state)?.pressure;
        let mut order = path.contact_order();
        order.truncate(state.contact.contact_nodes);
        let gap = path.problem().initial_gap().to_vec();
        Ok(Self { history, order, gap, load, pressure })
    }

    pub(crate) fn sphere(nodes: usize) -> Result<Self, Error> {
        let grid = Grid::square(SIDE, SIDE as f64)?;
        let sphere = Paraboloid::new(10.0 * SIDE as f64)?;
        Self::new(HeightMap::sample(&sphere, &grid)?, nodes)
    }

    pub(crate) fn rough(seed: u64, nodes: usize) -> Result<Self, Error> {
        let grid = Grid::square(SIDE, SIDE as f64)?;
        let surface = SelfAffine::new(0.8, 8.0, 2.0, Amplitude::RmsHeight(0.3), seed)?;
        Self::new(HeightMap::sample(&surface, &grid)?, nodes)
    }

    /// Ridges four times as long as wide, along x or along y: a rough surface whose cells were four times as wide as
    /// long.
    pub(crate) fn ridges(seed: u64, along_x: bool, nodes: usize) -> Result<Self, Error> {
        let stretched = Grid::new(SIDE, SIDE, 0.5, 2.0)?;
        let surface = SelfAffine::new(0.8, 16.0, 4.0, Amplitude::RmsHeight(0.3), seed)?;
        let heights = surface.heights(&stretched)?;
        let heights = if along_x { heights } else { heights.transpose() };
        Self::new(HeightMap::new(heights)?, nodes)
    }
}
