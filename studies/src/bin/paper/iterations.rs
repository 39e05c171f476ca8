//! What conjugate gradients take under an infinitesimal load and under a moderate one.

use asperity::convolution::Convolution;
use asperity::{Boussinesq, FixedLoadSolver};

use crate::polonsky_keer;
use crate::run::TOLERANCE;
use crate::surfaces::{E_STAR, NOMINAL_AREA, Rough, grid};
use asperity_cli::outcome::Failure;

/// Nodes a side at most: plain conjugate gradients take a while.
const MOST_NODES: usize = 256;
/// W/A₀E*: one node in contact, and a load that counts as moderate.
pub(crate) const LIGHTEST: f64 = 1e-9;
pub(crate) const MODERATE: f64 = 1e-2;

/// One load.
pub(crate) struct Steps {
    pub(crate) load: f64,
    /// Steps of this crate's solver on the finest grid.
    pub(crate) ours: usize,
    /// Steps of plain conjugate gradients, of two convolutions each.
    pub(crate) plain: Option<usize>,
}

pub(crate) struct Iterations {
    pub(crate) steps: Vec<Steps>,
}

impl Iterations {
    /// Table 1, seed 1, by both.
    pub(crate) fn new(nodes: usize) -> Result<Self, Failure> {
        let nodes = nodes.min(MOST_NODES);
        eprintln!("conjugate gradients from the lightest load on: {nodes} x {nodes}");
        let failed = |error: asperity::Error| Failure::new("conjugate gradients", error);
        let grid = grid(nodes).map_err(failed)?;
        let heights = Rough::Table1.heights(&grid, 1).map_err(failed)?;
        let kernel = Boussinesq::new(grid, E_STAR).map_err(failed)?;
        let mut convolution = Convolution::new(&kernel).map_err(failed)?;
        let highest = heights.max_height();
        let gap: Vec<f64> = heights.matrix().iter().map(|z| highest - z).collect();
        let mut solver = FixedLoadSolver::builder(&heights, &kernel)
            .tolerance(TOLERANCE)
            .stiffness(false)
            .build()
            .map_err(failed)?;
        let mut steps = Vec::new();
        for load in [LIGHTEST, MODERATE] {
            let force = load * NOMINAL_AREA * E_STAR;
            let solution = solver.solve(force).map_err(failed)?;
            let sum = force / grid.cell_area();
            let plain = polonsky_keer::steps(&gap, &mut convolution, sum, TOLERANCE);
            steps.push(Steps {
                load,
                ours: solution.effort.iterations,
                plain: plain.map_err(failed)?,
            });
        }
        Ok(Self { steps })
    }

    /// What was found at one of the loads.
    pub(crate) fn at(&self, load: f64) -> Option<&Steps> {
        self.steps.iter().find(|steps| steps.load == load)
    }
}
