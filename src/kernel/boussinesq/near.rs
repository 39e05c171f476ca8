//! Near the cell: exact along its long side, Gauss-Legendre quadrature across.
//!
//! Every term is positive, so nothing cancels. Lengths are in units of the short side.

use crate::kernel::gauss::{EIGHT, FOURTEEN, SIX, TEN, TWENTY};

/// ∫ dA / r over a cell of `aspect` × 1, observed at its centre.
pub(super) fn own_cell(aspect: f64) -> f64 {
    2.0 * (libm::asinh(aspect) + aspect * libm::asinh(1.0 / aspect))
}

/// ∫ dA / r over a cell of `aspect` × 1, observed at (x, y) from its centre, which must be the
/// centre of another cell: x is zero or at least `aspect`, y is zero or at least 1.
pub(super) fn integral(aspect: f64, x: f64, y: f64) -> f64 {
    let half = 0.5 * aspect;
    let line = |eta: f64| {
        if x > 0.0 {
            // ∫ dξ / r = 2 atanh(length / sum of the distances to both ends), here at most ½.
            let to_near_end = (x - half) * (x - half) + eta * eta;
            let to_far_end = (x + half) * (x + half) + eta * eta;
            2.0 * libm::atanh(aspect / (to_near_end.sqrt() + to_far_end.sqrt()))
        } else {
            2.0 * libm::asinh(half / eta.abs())
        }
    };
    // Sum from the small weights at the ends to the large ones inside.
    let sum: f64 = rule(half, x, y)
        .iter()
        .rev()
        .map(|&(node, weight)| weight * (line(y - 0.5 * node) + line(y + 0.5 * node)))
        .sum();
    0.5 * sum
}

/// The smallest rule that is exact to rounding.
///
/// As a function of the complex place z of the source on the short side, scaled to [−1, 1], the
/// inner integral is singular at z = 2 (y ± i (x − half)), and for x = 0 at z = 2 y. An n-point
/// rule converges as ϱ⁻²ⁿ with ϱ ≥ |z| + √(|z|² − 1).
///
/// The distances are where 40-digit arithmetic finds the truncation below 6 × 10⁻¹⁷ of the
/// integral, whatever the aspect. The nearest neighbours along the short side are at |z| = 2;
/// those along the long side are at |z| = 1 on a square and farther on any other cell.
fn rule(half: f64, x: f64, y: f64) -> &'static [(f64, f64)] {
    let beyond_end = (x - half).max(0.0);
    let z = 2.0 * (beyond_end * beyond_end + y * y).sqrt();
    if z < 1.5 {
        &TWENTY
    } else if z < 2.5 {
        &FOURTEEN
    } else if z < 5.0 {
        &TEN
    } else if z < 12.0 {
        &EIGHT
    } else {
        &SIX
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn own_square_cell() {
        let exact = 4.0 * (1.0 + 2f64.sqrt()).ln();
        // Two rounding errors on either side.
        assert!((own_cell(1.0) - exact).abs() <= 2.0 * f64::EPSILON * exact);
    }
}
