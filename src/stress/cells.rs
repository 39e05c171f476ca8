//! Responses to uniform loads on cells, in space.

use super::load::{COMPONENTS, Response};
use super::rectangle::Values;
use crate::parallel::for_each_chunk;

/// All components at offsets.
pub(super) type Stresses = [f64; COMPONENTS];

/// Rows whose corners are computed together.
const ROWS: usize = 8;

/// Responses at offsets of 0 ≤ i < nx and 0 ≤ j < ny cells, i fastest, summed over `depths` with their weights. Lengths
/// are in any unit.
pub(super) fn rectangles(
    (nx, ny): (usize, usize),
    (dx, dy): (f64, f64),
    depths: &[(f64, f64)],
    response: &Response,
) -> Vec<Stresses> {
    let at = |place: usize, side: f64| (place as f64 - 0.5) * side;
    let mut values = vec![[0.0; COMPONENTS]; nx * ny];
    for_each_chunk(&mut values, ROWS * nx, |chunk, rows| {
        let corners = |j: usize| -> Vec<Stresses> {
            let of_corner = |i: usize| {
                let mut sum = [0.0; COMPONENTS];
                for &(weight, z) in depths {
                    let found = response.of(&Values::at_corner(at(i, dx), at(j, dy), z));
                    add(&mut sum, weight, &found);
                }
                sum
            };
            (0..=nx).map(of_corner).collect()
        };
        let mut below = corners(chunk * ROWS);
        for (row, j) in rows.chunks_mut(nx).zip(chunk * ROWS..) {
            let above = corners(j + 1);
            for (i, value) in row.iter_mut().enumerate() {
                *value = std::array::from_fn(|c| {
                    (above[i + 1][c] - above[i][c]) - (below[i + 1][c] - below[i][c])
                });
            }
            below = above;
        }
    });
    values
}

/// The same of strips along x, at offsets of 0 ≤ j < ny.
pub(super) fn strips(
    ny: usize,
    dy: f64,
    depths: &[(f64, f64)],
    response: &Response,
) -> Vec<Stresses> {
    let edge = |j: usize| {
        let mut sum = [0.0; COMPONENTS];
        for &(weight, z) in depths {
            let found = response.of(&Values::of_strip((j as f64 - 0.5) * dy, z));
            add(&mut sum, weight, &found);
        }
        sum
    };
    let of_strip = |j: usize| {
        let (below, above) = (edge(j), edge(j + 1));
        std::array::from_fn(|c| above[c] - below[c])
    };
    (0..ny).map(of_strip).collect()
}

/// Adds `weight` times `values`.
pub(super) fn add(sum: &mut Stresses, weight: f64, values: &Stresses) {
    for (sum, value) in sum.iter_mut().zip(values) {
        *sum += weight * value;
    }
}
