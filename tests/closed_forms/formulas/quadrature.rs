//! Quadrature and differentiation for the tests of the closed forms.

use std::f64::consts::PI;

/// ∫ f over (lo, hi) by the tanh-sinh rule: near rounding accuracy for integrands that are smooth
/// inside and have algebraic or logarithmic ends. The ends themselves are never evaluated: a node
/// that rounding moves onto one is left out, which an infinite end other than zero notices by
/// about √ε.
pub(super) fn integrate(f: impl Fn(f64) -> f64, lo: f64, hi: f64) -> f64 {
    let length = hi - lo;
    let step = 1.0 / 32.0;
    let mut sum = 0.0;
    // Beyond |t| = 4 nodes are within 1e-37 of the ends, where even an inverse square root adds
    // nothing.
    for i in -128..=128 {
        let t = f64::from(i) * step;
        let grow = (PI * t.sinh()).exp();
        let (to_lo, to_hi) = (grow / (1.0 + grow), 1.0 / (1.0 + grow));
        let x = if t < 0.0 { lo + length * to_lo } else { hi - length * to_hi };
        if x > lo && x < hi {
            sum += PI * t.cosh() * step * length * to_lo * to_hi * f(x);
        }
    }
    sum
}

/// f′(x) by the five-point central difference with steps of h = 1e-3 |x|: a truncation of
/// h⁴ f⁗′/30, some 1e-13 relative for powers of x, and 1e-13 of rounding.
pub(super) fn derivative(f: impl Fn(f64) -> f64, x: f64) -> f64 {
    let h = 1e-3 * x.abs();
    let near = f(x + h) - f(x - h);
    let far = f(x + 2.0 * h) - f(x - 2.0 * h);
    (8.0 * near - far) / (12.0 * h)
}

/// Displacement at r > a of a half-space under an axisymmetric pressure on the disc of radius a:
/// rings of point loads, summed with the complete elliptic integral (Johnson §3.8).
pub(super) fn ring_displacement(
    pressure: impl Fn(f64) -> f64,
    contact_radius: f64,
    r: f64,
    e_star: f64,
) -> f64 {
    let ring = |s: f64| {
        let complement = (r - s) / (r + s);
        pressure(s) * s / (r + s) * complete_elliptic(complement)
    };
    4.0 / (PI * e_star) * integrate(ring, 0.0, contact_radius)
}

/// K by the arithmetic-geometric mean, from the complementary modulus √(1 − k²).
fn complete_elliptic(complement: f64) -> f64 {
    let (mut a, mut g) = (1.0, complement);
    while a - g > 1e-15 * a {
        (a, g) = (0.5 * (a + g), (a * g).sqrt());
    }
    0.5 * PI / a
}
