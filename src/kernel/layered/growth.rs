//! What layers let be promised of the growth of contact.

use super::body::LayeredBody;
use crate::Grid;
use crate::kernel::periodic::Even;

/// Wave numbers to a decade at which the compliance is looked at.
const PER_DECADE: f64 = 40.0;
/// Bounds of the slope. A little more than that of a half-space, −1, is nothing that contact can tell: incompressible coats on compressible
/// half-spaces have −1.1 and lose no pressure.
const FALLS: f64 = -1.1;
const RISES: f64 = 2.0 + 1e-6;

/// Whether the compliance falls with the wave number no faster than that of a half-space, 1/q, and rises no faster than that of a thin
/// incompressible film on a rigid base, q², at all wave numbers that a grid can tell.
///
/// A body that is nowhere stiffer than below, as a soft coat or a layer on a rigid base, is like that. The inverses of its ends are
/// operators with maximum principles, (−Δ)^½ and the inverse of −Δ: where pressure is added, it is taken nowhere else. The compliance
/// of a stiff coat falls faster, as that of a plate does, 1/q⁴ in the end; a plate over a support rises beside it.
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

/// The greatest element off the diagonal of the inverse of a periodic kernel, over the one on it, given its symbol; the uniform wave
/// counts unless its value is zero.
pub(super) fn greatest_off_diagonal(symbol: &Even) -> f64 {
    let inverse = symbol.map(|value| if value == 0.0 { 0.0 } else { 1.0 / value });
    let inverse = inverse.inverse_transform();
    let others = inverse.values()[1..].iter().copied();
    others.fold(f64::NEG_INFINITY, f64::max) / inverse.values()[0]
}
