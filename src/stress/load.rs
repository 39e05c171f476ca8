//! What a homogeneous half-space answers to a load on its surface.

use super::rectangle::{Cosines, Values};
use crate::convolution::Parity;

/// Stress components in the order of Voigt: xx, yy, zz, yz, xz, xy.
pub(super) const COMPONENTS: usize = 6;

/// The load on the surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Load {
    /// Pressure.
    Normal,
    /// Traction along x on the body.
    AlongX,
    /// Traction along y.
    AlongY,
}

/// The stresses under a wave of a load of 1: for each component up to two products of cosines with their factors a and
/// b of (a + b q z) e^(−q z).
///
/// Under pressure they are those of Boussinesq, with $`\sigma_{xx} = -[2 \nu + (1 - 2 \nu - q z)\, c_x^2]\, e^{-q z}`$;
/// under traction along x, of Cerruti, $`\sigma_{xx} = i\, [(2 - q z)\, c_x + (2 \nu + q z)\, c_x c_y^2]\, e^{-q z}`$.
/// Both follow from Airy's function in the plane of the wave, and from antiplane shear across it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Response {
    load: Load,
    poissons_ratio: f64,
    terms: [[(Cosines, (f64, f64)); 2]; COMPONENTS],
}

impl Response {
    pub(super) fn new(load: Load, poissons_ratio: f64) -> Self {
        use Cosines::{One, X, Xx, Xxy, Xy, Xyy, Y};
        const NONE: (Cosines, (f64, f64)) = (One, (0.0, 0.0));
        let nu = poissons_ratio;
        let shear = 1.0 - 2.0 * nu;
        let terms = match load {
            Load::Normal => [
                [(One, (-2.0 * nu, 0.0)), (Xx, (-shear, 1.0))],
                [(One, (-1.0, 1.0)), (Xx, (shear, -1.0))],
                [(One, (-1.0, -1.0)), NONE],
                [(Y, (0.0, 1.0)), NONE],
                [(X, (0.0, 1.0)), NONE],
                [(Xy, (-shear, 1.0)), NONE],
            ],
            Load::AlongX => [
                [(X, (2.0, -1.0)), (Xyy, (2.0 * nu, 1.0))],
                [(X, (2.0 * nu, 0.0)), (Xyy, (-2.0 * nu, -1.0))],
                [(X, (0.0, 1.0)), NONE],
                [(Xy, (0.0, 1.0)), NONE],
                [(One, (-1.0, 0.0)), (Xx, (0.0, 1.0))],
                [(Y, (1.0, 0.0)), (Xxy, (-2.0 * nu, -1.0))],
            ],
            Load::AlongY => [
                [(Y, (2.0 * nu, 0.0)), (Xxy, (-2.0 * nu, -1.0))],
                [(Y, (2.0, -1.0)), (Xxy, (2.0 * nu, 1.0))],
                [(Y, (0.0, 1.0)), NONE],
                [(One, (-1.0, 1.0)), (Xx, (0.0, -1.0))],
                [(Xy, (0.0, 1.0)), NONE],
                [(X, (1.0, 0.0)), (Xyy, (-2.0 * nu, -1.0))],
            ],
        };
        Self { load, poissons_ratio, terms }
    }

    /// All components, from the values of the products.
    pub(super) fn of(&self, values: &Values) -> [f64; COMPONENTS] {
        self.terms.map(|terms| terms.iter().map(|&(c, factors)| values.of(c, factors)).sum())
    }

    /// Under a load that is uniform everywhere, on a body that repeats with a given period: it cannot expand sideways.
    pub(super) fn uniform(&self) -> [f64; COMPONENTS] {
        let sideways = -self.poissons_ratio / (1.0 - self.poissons_ratio);
        match self.load {
            Load::Normal => [sideways, sideways, -1.0, 0.0, 0.0, 0.0],
            Load::AlongX => [0.0, 0.0, 0.0, 0.0, -1.0, 0.0],
            Load::AlongY => [0.0, 0.0, 0.0, -1.0, 0.0, 0.0],
        }
    }

    /// The signs that a component takes where x, and where y, changes its sign.
    pub(super) fn signs(&self, component: usize) -> (f64, f64) {
        let (x, y) = match component {
            3 => (1.0, -1.0),
            4 => (-1.0, 1.0),
            5 => (-1.0, -1.0),
            _ => (1.0, 1.0),
        };
        match self.load {
            Load::Normal => (x, y),
            Load::AlongX => (-x, y),
            Load::AlongY => (x, -y),
        }
    }

    pub(super) fn parity(&self, component: usize) -> Parity {
        let (x, y) = self.signs(component);
        if x == y { Parity::Even } else { Parity::Odd }
    }

    /// Whether an exchange of x and y changes nothing but the names of components.
    pub(super) fn is_symmetric(&self) -> bool {
        self.load == Load::Normal
    }

    /// The same with x and y exchanged; components are exchanged by [`transposed`].
    pub(super) fn transposed(&self) -> Self {
        let load = match self.load {
            Load::Normal => Load::Normal,
            Load::AlongX => Load::AlongY,
            Load::AlongY => Load::AlongX,
        };
        Self::new(load, self.poissons_ratio)
    }
}

/// The component that another one is with x and y exchanged.
pub(super) fn transposed(component: usize) -> usize {
    [1, 0, 2, 4, 3, 5][component]
}

#[cfg(test)]
mod tests {
    use super::super::lanes::LANES;
    use super::super::rectangle::WaveSums;
    use super::*;

    /// On the surface a wave has the traction of the load, and nothing else; below, it is in equilibrium, and
    /// compatible: the trace, which is 2(1 + ν) times something harmonic, fades as e^(−qz).
    #[test]
    fn waves_are_in_equilibrium() {
        for nu in [-0.4, 0.0, 0.3, 0.5] {
            for load in [Load::Normal, Load::AlongX, Load::AlongY] {
                let response = Response::new(load, nu);
                let (qx, qy) = (0.8_f64, -1.7_f64);
                let q = qx.hypot(qy);
                let at = |z: f64| {
                    let fades = (-q * z).exp();
                    let mut sums = WaveSums::default();
                    let lanes = |value: f64| [value; LANES];
                    sums.add(
                        (&lanes(qx / q), &lanes(qy / q)),
                        (&lanes(fades), &lanes(q * z * fades)),
                    );
                    response.of(&sums.values(0))
                };
                let [_, _, zz, yz, xz, _] = at(0.0);
                let expected = match load {
                    Load::Normal => [0.0, 0.0, -1.0],
                    Load::AlongX => [-1.0, 0.0, 0.0],
                    Load::AlongY => [0.0, -1.0, 0.0],
                };
                for (found, expected) in [xz, yz, zz].into_iter().zip(expected) {
                    assert!((found - expected).abs() < 1e-15, "{load:?} {found} {expected}");
                }
                // Odd components are i times real ones: i q on an odd one gives −q, on an even one i q, whose i goes
                // with that of the odd ones.
                let h = 1e-4;
                let slope = |c: usize, z: f64| (at(z + h)[c] - at(z - h)[c]) / (2.0 * h);
                let across = |c: usize| if response.parity(c) == Parity::Odd { -1.0 } else { 1.0 };
                let z = 0.6;
                let s = at(z);
                let rows = [(0, 5, 4), (5, 1, 3), (4, 3, 2)];
                for (x, y, down) in rows {
                    let sum = across(x) * qx * s[x] + across(y) * qy * s[y] + slope(down, z);
                    // The difference errs by h² times third derivatives of some ten.
                    assert!(sum.abs() < 1e-6, "{nu} {load:?}: {sum}");
                }
                let trace = |z: f64| at(z)[..3].iter().sum::<f64>();
                let ratio = trace(z) - trace(0.0) * (-q * z).exp();
                assert!(ratio.abs() < 1e-14, "{nu} {load:?}");
            }
        }
    }
}
