//! What the boundary of the half-space does to the contact area at the same load on the same surface.

use asperity::{Boussinesq, FixedLoadSolver, InfluenceKernel, Spectral};

use crate::run::TOLERANCE;
use crate::surfaces::{E_STAR, NOMINAL_AREA, Rough, grid};
use asperity_cli::outcome::Failure;

/// Nodes a side of the surface, and its seed.
const NODES: usize = 256;
const SEED: u64 = 1;
/// W/A₀E*.
const LOADS: [f64; 2] = [1e-3, 1e-2];

/// The nodes in contact at one load.
pub(crate) struct Boundary {
    pub(crate) load: f64,
    pub(crate) free: usize,
    pub(crate) periodic: usize,
}

/// The surface of Table 1 on a free and on a periodic half-space.
pub(crate) fn effect() -> Result<Vec<Boundary>, Failure> {
    eprintln!("the same loads on a periodic half-space");
    let compare = || {
        let grid = grid(NODES)?;
        let heights = Rough::Table1.heights(&grid, SEED)?;
        let nodes = |kernel: &dyn InfluenceKernel| {
            let mut solver = FixedLoadSolver::builder(&heights, kernel)
                .tolerance(TOLERANCE)
                .stiffness(false)
                .build()?;
            let solve = |load: f64| {
                let solution = solver.solve(load * NOMINAL_AREA * E_STAR)?;
                Ok(solution.fields.pressure.iter().filter(|p| **p > 0.0).count())
            };
            LOADS.into_iter().map(solve).collect::<Result<Vec<usize>, asperity::Error>>()
        };
        let free = nodes(&Boussinesq::new(grid, E_STAR)?)?;
        let periodic = nodes(&Spectral::new(grid, E_STAR)?)?;
        let both = LOADS.into_iter().zip(free).zip(periodic);
        Ok(both.map(|((load, free), periodic)| Boundary { load, free, periodic }).collect())
    };
    compare().map_err(|error: asperity::Error| Failure::new("the two half-spaces", error))
}
