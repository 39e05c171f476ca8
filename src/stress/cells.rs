//! Responses to uniform loads on cells, in space.

use std::ops::Range;

use super::load::{COMPONENTS, Response};
use super::rectangle::Values;
use crate::kernel::FOUR;
use crate::parallel::for_each_chunk;

/// All components at offsets.
pub(super) type Stresses = [f64; COMPONENTS];

/// Rows whose corners are computed together.
pub(super) const ROWS: usize = 8;

/// From this depth on, in long sides of a cell, point forces are summed over Gauss's nodes in it.
///
/// Relative to the greatest stress, differences between corners err by 10⁻¹³ at 16 sides, 2·10⁻¹² at 64, 10⁻⁹ at 1024
/// and 10⁻⁷ at 16384: as the square of the depth. The rule errs by 10⁻¹³ at 16, and by rounding from 32 on. It takes
/// longer than corners do, and begins not where both errors cross but before any comparison can see that of corners.
const FAR: f64 = 64.0;

fn are_far((dx, dy): (f64, f64), depths: &[(f64, f64)]) -> bool {
    depths.iter().all(|(_, z)| *z >= FAR * dx.max(dy))
}

/// Gauss's nodes of the cell `place`, with their weights.
fn nodes(place: usize, side: f64) -> impl Iterator<Item = (f64, f64)> {
    let node = move |(node, weight): (f64, f64)| {
        [node, -node].map(|node| ((place as f64 + 0.5 * node) * side, 0.5 * weight * side))
    };
    FOUR.into_iter().flat_map(node)
}

/// Responses at offsets of 0 ≤ i < nx cells and of j in `rows`, i fastest, summed over `depths` with their weights.
/// Lengths are in any unit.
pub(super) fn rectangles(
    (nx, rows): (usize, Range<usize>),
    (dx, dy): (f64, f64),
    depths: &[(f64, f64)],
    response: &Response,
) -> Vec<Stresses> {
    let at = |place: usize, side: f64| (place as f64 - 0.5) * side;
    let mut values = vec![[0.0; COMPONENTS]; nx * rows.len()];
    if are_far((dx, dy), depths) {
        for_each_chunk(&mut values, nx, |row, values| {
            for (i, value) in values.iter_mut().enumerate() {
                let mut sum = Values::default();
                for (y, weight_y) in nodes(rows.start + row, dy) {
                    for (x, weight_x) in nodes(i, dx) {
                        for &(weight, z) in depths {
                            let weight = weight * weight_x * weight_y;
                            sum.add(weight, &Values::at_point(x, y, z));
                        }
                    }
                }
                *value = response.of(&sum);
            }
        });
        return values;
    }
    for_each_chunk(&mut values, ROWS * nx, |chunk, values| {
        let first = rows.start + chunk * ROWS;
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
        let mut below = corners(first);
        for (row, j) in values.chunks_mut(nx).zip(first..) {
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
    if are_far((dy, dy), depths) {
        let of_strip = |j: usize| {
            let mut sum = Values::default();
            for (y, weight_y) in nodes(j, dy) {
                for &(weight, z) in depths {
                    sum.add(weight * weight_y, &Values::of_line(y, z));
                }
            }
            response.of(&sum)
        };
        return (0..ny).map(of_strip).collect();
    }
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
