//! Integrals over a rectangle of what the stresses below a load are made of.
//!
//! Each stress under a wave of pressure or traction $`e^{i \mathbf q \cdot \mathbf x}`$ on the surface is a sum of
//!
//! ```math
//! (a + b\, q z)\, e^{-q z}\, c(\mathbf q / q)
//! ```
//!
//! with a product c of direction cosines, times i if their number is odd. Of each c there is a function G(x, y) at the
//! depth z whose mixed derivative ∂²G/∂x∂y has the transform $`c\, e^{-q z}`$, so that differences of G between corners
//! are integrals over rectangles:
//!
//! ```math
//! \begin{array}{ll}
//! c & 2 \pi G \\ \hline
//! 1 & \arctan \frac{x y}{z \varrho} \\
//! i c_x & \operatorname{arsinh} \frac{y}{\sqrt{x^2 + z^2}} \\
//! c_x^2 & \arctan \frac yx - \arctan \frac{y z}{x \varrho} \\
//! c_x c_y & \ln (\varrho + z) \\
//! i c_x c_y^2 & \frac{y}{\varrho + z}
//! \end{array}
//! \qquad \varrho^2 = x^2 + y^2 + z^2 .
//! ```
//!
//! A factor q z is −z ∂/∂z. At depths of many cells that difference of almost equal numbers is left to sums of ∂²G/∂x∂y
//! itself: of point forces.

use std::f64::consts::TAU;

use super::lanes::{LANES, Lanes, each};

/// A product of direction cosines of a wave. Those with the square of c_y follow from `c_x² + c_y² = 1`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Cosines {
    One,
    X,
    Y,
    Xx,
    Xy,
    Xyy,
    Xxy,
}

/// How many there are.
const COUNT: usize = 7;

/// A value for each product: of what goes with $`e^{-q z}`$, and of what goes with $`q z\, e^{-q z}`$.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Values {
    plain: [f64; COUNT],
    deep: [f64; COUNT],
}

impl Values {
    /// a times the plain one and b times the deep one.
    pub(super) fn of(&self, cosines: Cosines, (a, b): (f64, f64)) -> f64 {
        let place = cosines as usize;
        a * self.plain[place] + b * self.deep[place]
    }

    /// Adds `weight` times the others.
    pub(super) fn add(&mut self, weight: f64, other: &Self) {
        for place in 0..COUNT {
            self.plain[place] += weight * other.plain[place];
            self.deep[place] += weight * other.deep[place];
        }
    }

    /// G of all products at the corner (x, y), which lies on neither axis, seen from the depth z ≥ 0. Lengths are in
    /// one unit, which changes nothing between corners.
    pub(super) fn at_corner(x: f64, y: f64, z: f64) -> Self {
        let (xx, yy, zz) = (x * x, y * y, z * z);
        let rho = (xx + yy + zz).sqrt();
        let (beside_x, beside_y) = (yy + zz, xx + zz);
        let below = rho + z;
        let angle = libm::atan2(x * y, z * rho);
        let plain = [
            angle,
            libm::asinh(y / beside_y.sqrt()),
            libm::asinh(x / beside_x.sqrt()),
            libm::atan(y / x) - libm::atan(y * z / (x * rho)),
            libm::log(below),
            y / below,
            x / below,
        ];
        let along = z / rho;
        let deep = [
            along * x * y * (1.0 / beside_x + 1.0 / beside_y),
            along * y * z / beside_y,
            along * x * z / beside_x,
            along * x * y / beside_y,
            -along,
            along * y / below,
            along * x / below,
        ];
        Self { plain: plain.map(|g| g / TAU), deep: deep.map(|g| g / TAU) }
    }

    /// ∂²G/∂x∂y of all products at (x, y), seen from the depth z > 0.
    pub(super) fn at_point(x: f64, y: f64, z: f64) -> Self {
        let scale = 1.0 / (x * x + y * y + z * z).sqrt();
        let (x, y, z) = (x * scale, y * scale, z * scale);
        let below = 1.0 + z;
        let per = 1.0 / below;
        let (xx, xy, yy) = (x * x, x * y, y * y);
        // Derivatives of 1/(ϱ + z), of ϱ = 1.
        let first = (below + 1.0) * per * per;
        let second = (below + 2.0) * per * per * per;
        let third = (3.0 * below * (below + 1.0) + 2.0) * per * per * per;
        let plain = [
            z,
            -x,
            -y,
            per - xx * first,
            -xy * first,
            x * (yy * second - per * per),
            y * (xx * second - per * per),
        ];
        let deep = [
            z * (3.0 * z * z - 1.0),
            -3.0 * x * z * z,
            -3.0 * y * z * z,
            z * (1.0 - 3.0 * xx),
            -3.0 * xy * z,
            x * z * (yy * third - first),
            y * z * (xx * third - first),
        ];
        let scale = scale * scale / TAU;
        Self { plain: plain.map(|g| scale * g), deep: deep.map(|g| scale * g) }
    }

    /// The difference of the same between x = ∞ and x = −∞, but for what does not depend on y: of a strip along x.
    pub(super) fn of_strip(y: f64, z: f64) -> Self {
        let square = y * y + z * z;
        let (mut plain, mut deep) = ([0.0; COUNT], [0.0; COUNT]);
        plain[Cosines::One as usize] = 2.0 * libm::atan2(y, z) / TAU;
        plain[Cosines::Y as usize] = -libm::log(square) / TAU;
        deep[Cosines::One as usize] = 2.0 * z * y / square / TAU;
        deep[Cosines::Y as usize] = 2.0 * z * z / square / TAU;
        Self { plain, deep }
    }

    /// Its derivative along y: of a line along x.
    pub(super) fn of_line(y: f64, z: f64) -> Self {
        let rho = (y * y + z * z).sqrt();
        let (y, z) = (y / rho, z / rho);
        let (mut plain, mut deep) = ([0.0; COUNT], [0.0; COUNT]);
        let scale = 2.0 / rho / TAU;
        plain[Cosines::One as usize] = scale * z;
        plain[Cosines::Y as usize] = -scale * y;
        deep[Cosines::One as usize] = scale * z * (z * z - y * y);
        deep[Cosines::Y as usize] = -2.0 * scale * y * z * z;
        Self { plain, deep }
    }
}

/// Sums over waves, of neighbours side by side.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct WaveSums {
    plain: [Lanes; COUNT],
    deep: [Lanes; COUNT],
}

impl WaveSums {
    /// Adds the products themselves for waves along (cx, cy), times the sums `plain` of $`e^{-q z}`$ and `deep` of $`q
    /// z\, e^{-q z}`$.
    #[inline(always)]
    pub(super) fn add(&mut self, (cx, cy): (&Lanes, &Lanes), (plain, deep): (&Lanes, &Lanes)) {
        let xx = each(|k| cx[k] * cx[k]);
        let xy = each(|k| cx[k] * cy[k]);
        let products =
            [[1.0; LANES], *cx, *cy, xx, xy, each(|k| xy[k] * cy[k]), each(|k| xx[k] * cy[k])];
        for (place, c) in products.iter().enumerate() {
            for k in 0..LANES {
                self.plain[place][k] += c[k] * plain[k];
                self.deep[place][k] += c[k] * deep[k];
            }
        }
    }

    /// Those of one of the neighbours.
    pub(super) fn values(&self, lane: usize) -> Values {
        Values { plain: self.plain.map(|sums| sums[lane]), deep: self.deep.map(|sums| sums[lane]) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::FOUR;

    const ALL: [Cosines; COUNT] = [
        Cosines::One,
        Cosines::X,
        Cosines::Y,
        Cosines::Xx,
        Cosines::Xy,
        Cosines::Xyy,
        Cosines::Xxy,
    ];

    /// Mixed derivatives of G beside what they should be, from the potentials of Boussinesq and Cerruti: derivatives of
    /// 1/ϱ, ln (ϱ + z) and z ln (ϱ + z) − ϱ, taken by central differences.
    #[test]
    fn corners_integrate_derivatives_of_potentials() {
        let rho = |x: f64, y: f64, z: f64| (x * x + y * y + z * z).sqrt();
        // e^(−qz)/q, e^(−qz)/q² and e^(−qz)/q³.
        let first = move |x: f64, y: f64, z: f64| 1.0 / rho(x, y, z) / TAU;
        let second = move |x: f64, y: f64, z: f64| -(rho(x, y, z) + z).ln() / TAU;
        let third =
            move |x: f64, y: f64, z: f64| (z * (rho(x, y, z) + z).ln() - rho(x, y, z)) / TAU;
        const H: f64 = 2e-3;
        type Function<'a> = &'a dyn Fn(f64, f64, f64) -> f64;
        fn dx(f: Function<'_>, x: f64, y: f64, z: f64) -> f64 {
            (f(x + H, y, z) - f(x - H, y, z)) / (2.0 * H)
        }
        fn dy(f: Function<'_>, x: f64, y: f64, z: f64) -> f64 {
            (f(x, y + H, z) - f(x, y - H, z)) / (2.0 * H)
        }
        fn dz(f: Function<'_>, x: f64, y: f64, z: f64) -> f64 {
            (f(x, y, z + H) - f(x, y, z - H)) / (2.0 * H)
        }
        let x1 = |x: f64, y: f64, z: f64| dx(&first, x, y, z);
        let y1 = |x: f64, y: f64, z: f64| dy(&first, x, y, z);
        let z1 = |x: f64, y: f64, z: f64| -dz(&first, x, y, z);
        let x2 = |x: f64, y: f64, z: f64| dx(&second, x, y, z);
        let xx2 = |x: f64, y: f64, z: f64| -dx(&x2, x, y, z);
        let xy2 = |x: f64, y: f64, z: f64| -dy(&x2, x, y, z);
        let x3 = |x: f64, y: f64, z: f64| dx(&third, x, y, z);
        let xy3 = |x: f64, y: f64, z: f64| dy(&x3, x, y, z);
        let xyy3 = |x: f64, y: f64, z: f64| -dy(&xy3, x, y, z);
        let xxy3 = |x: f64, y: f64, z: f64| -dx(&xy3, x, y, z);
        let cases: [(Cosines, Function<'_>); COUNT] = [
            (Cosines::One, &z1),
            (Cosines::X, &x1),
            (Cosines::Y, &y1),
            (Cosines::Xx, &xx2),
            (Cosines::Xy, &xy2),
            (Cosines::Xyy, &xyy3),
            (Cosines::Xxy, &xxy3),
        ];
        for (x, y, z) in [(0.7, 0.9, 0.8), (-1.2, 0.6, 0.7), (0.8, -1.1, 1.5)] {
            for (cosines, expected) in cases {
                let plain =
                    |x: f64, y: f64, z: f64| Values::at_corner(x, y, z).of(cosines, (1.0, 0.0));
                let deep =
                    |x: f64, y: f64, z: f64| Values::at_corner(x, y, z).of(cosines, (0.0, 1.0));
                let mixed = |f: Function<'_>| {
                    let along_x = |x: f64, y: f64, z: f64| dx(f, x, y, z);
                    dy(&along_x, x, y, z)
                };
                // Differences err by h² times fifth derivatives, which are some hundreds at these distances, and by
                // rounding over h³.
                let (found, wanted) = (mixed(&plain), expected(x, y, z));
                assert!((found - wanted).abs() < 3e-4, "{cosines:?} {x} {y} {z}: {found} {wanted}");
                let (found, wanted) = (mixed(&deep), -z * dz(expected, x, y, z));
                assert!((found - wanted).abs() < 2e-3, "{cosines:?} {x} {y} {z}: {found} {wanted}");
            }
        }
    }

    /// Over a cell points and lines add up to differences of corners and edges: at a depth of twenty sides Gauss's rule
    /// of four points errs by 10⁻¹⁴ of them.
    #[test]
    fn points_are_derivatives_of_corners() {
        let rule = |at: f64| {
            FOUR.map(|(node, weight)| [(at + 0.5 * node, weight), (at - 0.5 * node, weight)])
        };
        let each = |at: f64| rule(at).into_iter().flatten().map(|(at, weight)| (at, 0.5 * weight));
        for (x, y, z) in [(0.0, 0.0, 20.0), (3.0, -7.0, 20.0), (-30.0, 11.0, 25.0)] {
            for cosines in ALL {
                for factors in [(1.0, 0.0), (0.0, 1.0)] {
                    let corner = |x: f64, y: f64| Values::at_corner(x, y, z).of(cosines, factors);
                    let (left, right, low, high) = (x - 0.5, x + 0.5, y - 0.5, y + 0.5);
                    let expected = (corner(right, high) - corner(left, high))
                        - (corner(right, low) - corner(left, low));
                    let mut found = 0.0;
                    for (x, by) in each(x) {
                        for (y, weight) in each(y) {
                            found += by * weight * Values::at_point(x, y, z).of(cosines, factors);
                        }
                    }
                    // Corners are some 1, and round a few times.
                    let error = found - expected;
                    assert!(error.abs() < 4e-15, "{cosines:?} {factors:?} {x} {y} {z}: {error:e}");
                    let edge = |y: f64| Values::of_strip(y, z).of(cosines, factors);
                    let expected = edge(high) - edge(low);
                    let line = |(y, weight): (f64, f64)| {
                        weight * Values::of_line(y, z).of(cosines, factors)
                    };
                    let error = each(y).map(line).sum::<f64>() - expected;
                    assert!(error.abs() < 4e-15, "{cosines:?} {factors:?} {y} {z}: {error:e}");
                }
            }
        }
    }

    /// Strips are very long rectangles, but for a constant.
    #[test]
    fn strips_are_limits_of_rectangles() {
        for (y, z) in [(0.5, 0.0), (0.5, 0.3), (-2.5, 1.0), (7.5, 4.0)] {
            let of_long = |y: f64, place: usize, deep: bool| {
                let part = |x: f64| {
                    let values = Values::at_corner(x, y, z);
                    if deep { values.deep[place] } else { values.plain[place] }
                };
                part(1e8) - part(-1e8)
            };
            let (here, above) = (Values::of_strip(y, z), Values::of_strip(y + 1.0, z));
            for place in 0..COUNT {
                // What is left at a distance of 10⁸.
                let plain = of_long(y + 1.0, place, false) - of_long(y, place, false);
                assert!((above.plain[place] - here.plain[place] - plain).abs() < 1e-7, "{place}");
                let deep = of_long(y + 1.0, place, true) - of_long(y, place, true);
                assert!((above.deep[place] - here.deep[place] - deep).abs() < 1e-7, "{place}");
            }
        }
    }
}
