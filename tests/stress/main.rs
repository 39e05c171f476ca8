//! Stress below the surface.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

mod equilibrium;
mod layers;
mod materials;
mod periodic;
mod points;
mod refusals;
mod smooth;
mod surveys;

use asperity::Grid;
use nalgebra::DMatrix;

/// Hertz's pressure of radius 1 and greatest value 1 on cells of width 1/`cells`, averaged over each cell, about the
/// node in the middle of a grid that is `reach` cells wide on either side.
fn hertz(cells: usize, reach: usize) -> (Grid, DMatrix<f64>) {
    const PARTS: usize = 16;
    let n = 2 * reach + 1;
    let width = 1.0 / cells as f64;
    let at = |i: usize, k: usize| {
        let part = (k as f64 + 0.5) / PARTS as f64 - 0.5;
        (i as f64 - reach as f64 + part) * width
    };
    let pressure = DMatrix::from_fn(n, n, |ix, iy| {
        let parts = (0..PARTS).flat_map(|a| (0..PARTS).map(move |b| (a, b)));
        let sum: f64 = parts
            .map(|(a, b)| {
                let (x, y) = (at(ix, a), at(iy, b));
                (1.0 - x * x - y * y).max(0.0).sqrt()
            })
            .sum();
        sum / (PARTS * PARTS) as f64
    });
    (Grid::new(n, n, width, width).unwrap(), pressure)
}
