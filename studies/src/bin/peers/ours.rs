//! Our side of every problem.

use asperity::{Error, FixedLoadSolution, FixedLoadSolver};
use asperity_cli::half_space::{Periodic, half_space};

use crate::surfaces::Rough;

/// Mean pressures over E* and the rms gradient between nodes.
pub(crate) const LOADS: [f64; 3] = [0.01, 0.1, 0.5];
/// Relative to the approach.
pub(crate) const TOLERANCE: f64 = 1e-11;

/// One surface on one half-space under one load.
pub(crate) struct Solved {
    /// `free` or `periodic`.
    pub(crate) half_space: &'static str,
    /// Mean pressure over E*.
    pub(crate) mean_pressure: f64,
    /// Nodes with pressure.
    pub(crate) nodes: usize,
    pub(crate) solution: FixedLoadSolution,
}

/// All loads on both half-spaces.
pub(crate) fn solve(rough: &Rough) -> Result<Vec<Solved>, Error> {
    let gradient = rough.heights.rms_gradient(&rough.grid)?;
    let mut all = Vec::new();
    for (name, periodic) in [("free", None), ("periodic", Some(Periodic::Spectral))] {
        let kernel = half_space(periodic, rough.grid, 1.0)?;
        let mut solver =
            FixedLoadSolver::builder(&rough.heights, &kernel).tolerance(TOLERANCE).build()?;
        for load in LOADS {
            let mean_pressure = load * gradient;
            let solution = solver.solve(mean_pressure * rough.grid.nominal_area())?;
            let pressed = solution.fields.pressure.iter().filter(|p| **p > 0.0);
            all.push(Solved { half_space: name, mean_pressure, nodes: pressed.count(), solution });
        }
    }
    Ok(all)
}
