//! Rough surfaces on half-spaces of every kind, for tests of what all paths have in common.

use asperity::kernel::KernelTable;
use asperity::surface::{Amplitude, HeightMap, SelfAffine};
use asperity::{
    Boussinesq, ContactGrowth, Grid, InfluenceKernel, LoadingSolver, LoadingState,
    MeanDisplacement, PeriodicBoussinesq, Spectral,
};

const E_STAR: f64 = 1e9;
const THICKNESS: f64 = 3e-4;
/// What a uniform pressure of 1 Pa compresses the layer by \[m\]: h (1 − 2ν)/((1 − ν)² E*), ν = 0.3.
pub(crate) const COMPLIANCE: f64 = THICKNESS * 0.4 / (0.49 * E_STAR);

/// A rough surface whose events are never simultaneous.
pub(crate) fn rough(grid: &Grid, seed: u64) -> HeightMap {
    // Two cells at least.
    let short = (0.15 * grid.sides().0).max(2.0 * grid.dx().max(grid.dy()));
    let surface = SelfAffine::new(0.8, 2.7 * short, short, Amplitude::RmsHeight(1e-5), seed);
    HeightMap::sample(&surface.unwrap(), grid).unwrap()
}

pub(crate) fn grid() -> Grid {
    Grid::new(18, 15, 1e-4, 1.2e-4).unwrap()
}

/// A layer on a rigid base without friction (Johnson, Contact Mechanics, §5.8), whose mean displacement
/// is a property of the body.
pub(crate) fn layer(grid: Grid, growth: ContactGrowth) -> KernelTable {
    let symbol = |qx: f64, qy: f64| {
        let q = qx.hypot(qy);
        if q == 0.0 {
            return COMPLIANCE;
        }
        let x = (2.0 * q * THICKNESS).min(80.0);
        2.0 / (E_STAR * q) * (x.cosh() - 1.0) / (x.sinh() + x)
    };
    KernelTable::from_symbol(grid, MeanDisplacement::Physical, growth, symbol).unwrap()
}

/// A kernel of every kind of procedure: convex, checked windows, event by event; with and without an
/// arbitrary mean displacement.
pub(crate) fn kernels(grid: Grid) -> Vec<(&'static str, Box<dyn InfluenceKernel>)> {
    vec![
        ("free", Box::new(Boussinesq::new(grid, E_STAR).unwrap())),
        ("Love", Box::new(PeriodicBoussinesq::new(grid, E_STAR).unwrap())),
        ("spectral", Box::new(Spectral::new(grid, E_STAR).unwrap())),
        ("layer", Box::new(layer(grid, ContactGrowth::Unknown))),
    ]
}

/// All states to full contact.
pub(crate) fn states(surface: &HeightMap, kernel: &dyn InfluenceKernel) -> Vec<LoadingState> {
    let path = LoadingSolver::new(surface, kernel).unwrap();
    path.map(Result::unwrap).collect()
}
