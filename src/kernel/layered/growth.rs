//! What layers let be promised of the growth of contact.

use nalgebra::DMatrix;

use super::body::LayeredBody;
use crate::Grid;
use crate::kernel::periodic::{Even, inverse, wave_number};

/// Wave numbers to a decade at which the compliance is looked at.
const PER_DECADE: f64 = 40.0;
/// Bounds of the slope. A little more than that of a half-space, −1, is nothing that contact can tell: incompressible
/// coats on compressible half-spaces have −1.1 and lose no pressure.
const FALLS: f64 = -1.1;
const RISES: f64 = 2.0 + 1e-6;

/// Whether the compliance falls with the wave number no faster than that of a half-space, 1/q, and rises no faster than
/// that of a thin incompressible film on a rigid base, q², at all wave numbers that a grid can tell.
///
/// A body that is nowhere stiffer than below, as a soft coat or a layer on a rigid base, is like that. The inverses of
/// its ends are operators with maximum principles, (−Δ)^½ and the inverse of −Δ: where pressure is added, it is taken
/// nowhere else. The compliance of a stiff coat falls faster, as that of a plate does, 1/q⁴ in the end; a plate over a
/// support rises beside it.
pub(super) fn is_soft(grid: &Grid, body: &LayeredBody) -> bool {
    let (lx, ly) = grid.sides();
    let least = 0.5 / lx.max(ly);
    let most = 10.0 / grid.dx().min(grid.dy());
    let decades = (most / least).log10();
    let steps = (PER_DECADE * decades).ceil().max(1.0);
    let factor = libm::exp(std::f64::consts::LN_10 * decades / steps);
    let mut q = least;
    let mut value = body.compliance(q);
    for _ in 0..steps as usize {
        let (next, after) = (q * factor, body.compliance(q * factor));
        let slope = libm::log(after / value) / libm::log(factor);
        let is_bounded = (FALLS..=RISES).contains(&slope);
        if !is_bounded {
            return false;
        }
        (q, value) = (next, after);
    }
    true
}

/// Whether the compliance still rises at the shortest wave of a grid, along x or along y.
pub(super) fn rises_at_the_end(grid: &Grid, body: &LayeredBody) -> bool {
    let (nx, ny) = grid.shape();
    [(nx, grid.dx()), (ny, grid.dy())].into_iter().filter(|(n, _)| *n > 1).any(|(n, cell)| {
        let q = wave_number(n / 2, n, cell);
        body.compliance(1.01 * q) > body.compliance(q)
    })
}

/// The greatest element off the diagonal of the inverse of a periodic kernel, over the one on it, given its symbol; the
/// uniform wave counts unless its value is zero.
pub(super) fn greatest_off_diagonal(symbol: &Even) -> f64 {
    let inverse = inverse(symbol);
    let others = inverse.values()[1..].iter().copied();
    others.fold(f64::NEG_INFINITY, f64::max) / inverse.values()[0]
}

/// What positive elements off the diagonal of an inverse may come to in a row, over the sum of the row. Up to a half is
/// enough for contact to grow; half of that, since the inverse may be one on a coarse grid.
const OUTWEIGHED: f64 = 0.25;

/// Whether contact grows by the inverse A of a free kernel on nx × ny nodes, given its coefficients at offsets that are
/// not negative, x fastest: where positive elements off the diagonal are outweighed.
///
/// With J the nodes out of a contact I, gaps close at the rates w = A_JJ⁻¹ s_J and pressures grow at s_I − A_IJ w,
/// where s are the row sums of A. Let P be the positive part of A off the diagonal, p its row sums, and p ≤ φ s. Then A
/// − P is an M-matrix with row sums of (1 − φ) s at least, so that w = (A − P)_JJ⁻¹ (s − P w)_J maps the box 0 ≤ w ≤ W
/// = 1 / (1 − φ) into itself if W p ≤ s, for φ ≤ ½; and s_I − A_IJ w ≥ s − W p ≥ 0.
pub(super) fn inverse_keeps_signs((nx, ny): (usize, usize), coefficients: &[f64]) -> bool {
    let nodes = nx * ny;
    let along = |a: usize, b: usize| (a % nx).abs_diff(b % nx) + nx * (a / nx).abs_diff(b / nx);
    let matrix = DMatrix::from_fn(nodes, nodes, |a, b| coefficients[along(a, b)]);
    let Some(factor) = matrix.cholesky() else {
        return false;
    };
    let inverse = factor.inverse();
    (0..nodes).all(|node| {
        let column = inverse.column(node);
        let others = column.iter().enumerate().filter(|(other, _)| *other != node);
        let positive: f64 = others.map(|(_, value)| value.max(0.0)).sum();
        positive <= OUTWEIGHED * column.sum()
    })
}

/// The same of a periodic kernel on nx × ny nodes, given its symbol. All rows are alike, and without a value for the
/// uniform wave their sum is zero.
pub(super) fn is_outweighed((nx, ny): (usize, usize), symbol: &Even) -> bool {
    let inverse = inverse(symbol);
    let all = (0..ny).flat_map(|j| (0..nx).map(move |i| (i as isize, j as isize)));
    let positive: f64 = all.skip(1).map(|(i, j)| inverse.at(i, j).max(0.0)).sum();
    let uniform = symbol.at(0, 0);
    uniform > 0.0 && positive <= OUTWEIGHED / uniform
}
