//! Leakage through gap maps and along paths.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

mod along_paths;
mod channels;
mod chequerboard;
mod contrast;
mod gases;
mod references;
mod refusals;

use asperity::leak::{Leak, Seal};
use asperity::surface::Axis;
use asperity::{Boundary, Error, Grid};
use nalgebra::DMatrix;

/// The leak of a fluid of viscosity 1/12 under a pressure drop of 1, so that a gap of 1 conducts 1; nodes without gap
/// are in contact.
fn leak(gap: &DMatrix<f64>, grid: &Grid, boundary: Boundary, along: Axis) -> Result<Leak, Error> {
    let seal = Seal::new(1.0 / 12.0, 1.0, along)?;
    seal.leak(gap, &gap.map(|gap| gap == 0.0), (grid, boundary))
}

/// Every section leaks as much as the whole: to the 10⁻¹¹ of what may be lost.
fn assert_conserved(leak: &Leak) {
    for section in &leak.sections {
        assert!((section / leak.leak_rate - 1.0).abs() < 1.1e-11, "{section:e} {leak:?}");
    }
    assert!(leak.imbalance <= 1e-11);
}

/// Both boundaries.
const BOUNDARIES: [Boundary; 2] = [Boundary::Free, Boundary::Periodic];
/// What may differ between two leak rates of one network: 10⁻¹¹ may be lost in each.
const SAME: f64 = 2.1e-11;
