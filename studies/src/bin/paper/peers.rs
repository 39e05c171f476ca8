//! The same surface and loads by other programs.
//!
//! `peers.py` in this directory computes `peers.csv` with aspher and tamaas. Here their numbers are
//! read and ours computed.

use asperity::surface::HeightMap;
use asperity::{Boussinesq, FixedLoadSolver, LoadingSolver, Spectral};

use crate::run::TOLERANCE;
use crate::surfaces::{E_STAR, NOMINAL_AREA, Rough, grid};
use asperity_cli::outcome::Failure;

/// Nodes a side of the common surface, and its seed.
const NODES: usize = 256;
const SEED: u64 = 1;
const TABLE: &str = include_str!("peers.csv");

/// One program at one load, and asperity.
pub(crate) struct Comparison {
    pub(crate) program: String,
    pub(crate) version: String,
    pub(crate) tolerance: f64,
    /// W / A₀E*.
    pub(crate) load: f64,
    pub(crate) nodes: [usize; 2],
    /// Greatest pressure over E*.
    pub(crate) pressure: [f64; 2],
}

impl Comparison {
    /// Relative difference of the greatest pressures.
    pub(crate) fn difference(&self) -> f64 {
        (self.pressure[0] / self.pressure[1] - 1.0).abs()
    }
}

/// Heights of the common surface, from Table 1.
pub(crate) fn heights() -> Result<HeightMap, Failure> {
    let sample = || {
        let grid = grid(NODES)?;
        Rough::Table1.heights(&grid, SEED)
    };
    sample().map_err(|error| Failure::new("the surface of the comparison", error))
}

/// Computes our side of every line.
pub(crate) fn compare() -> Result<Vec<Comparison>, Failure> {
    eprintln!("other programs: the same loads by asperity");
    let failed = |error: asperity::Error| Failure::new("the comparison with other programs", error);
    let bad = |error: csv::Error| Failure::new("cannot read peers.csv", error);
    let heights = heights()?;
    let grid = grid(NODES).map_err(failed)?;
    let kernel = Boussinesq::new(grid, E_STAR).map_err(failed)?;
    let mut free = FixedLoadSolver::builder(&heights, &kernel)
        .tolerance(TOLERANCE)
        .stiffness(false)
        .build()
        .map_err(failed)?;
    let periodic = Spectral::new(grid, E_STAR).map_err(failed)?;
    let mut all = Vec::new();
    let mut reader = csv::Reader::from_reader(TABLE.as_bytes());
    for row in reader.deserialize::<(String, String, f64, f64, usize, f64)>() {
        let (program, version, tolerance, load, nodes, pressure) = row.map_err(bad)?;
        let force = load * NOMINAL_AREA * E_STAR;
        let (our_nodes, our_pressure) = if program == "aspher" {
            let solution = free.solve(force).map_err(failed)?;
            // Nodes with pressure, as the other programs count.
            let pressed = solution.pressure.iter().filter(|p| **p > 0.0);
            (pressed.count(), solution.max_pressure())
        } else {
            by_path(&heights, &periodic, force).map_err(failed)?
        };
        all.push(Comparison {
            program,
            version,
            tolerance,
            load,
            nodes: [nodes, our_nodes],
            pressure: [pressure, our_pressure / E_STAR],
        });
    }
    Ok(all)
}

/// Nodes in contact and greatest pressure at a load, from the path.
fn by_path(
    heights: &HeightMap,
    kernel: &Spectral,
    load: f64,
) -> Result<(usize, f64), asperity::Error> {
    let mut path = LoadingSolver::builder(heights, kernel).max_load(load).build()?;
    for state in path.by_ref() {
        state?;
    }
    // The last state is at exactly this load.
    let nodes = path.state().map_or(0, |state| state.contact.contact_nodes);
    Ok((nodes, path.max_pressure()?))
}
