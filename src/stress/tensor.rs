//! Stress fields, and what is made of them.

use std::f64::consts::FRAC_PI_6;

use nalgebra::{DMatrix, Matrix3};

use super::load::COMPONENTS;
use crate::parallel::for_each_chunk;

/// A measure of stress that criteria of yielding and fatigue take.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Measure {
    /// Von Mises' equivalent stress, $`\sqrt{\tfrac12 [(\sigma_1 - \sigma_2)^2 + (\sigma_2 - \sigma_3)^2 + (\sigma_3 -
    /// \sigma_1)^2]}`$.
    VonMises,
    /// Tresca's, the difference σ₁ − σ₃ of the greatest and the least principal stress.
    Tresca,
    /// The greatest shear stress, half of that.
    GreatestShear,
    /// The greatest principal stress σ₁: tension, which opens cracks.
    GreatestTension,
}

impl Measure {
    /// All measures.
    pub const ALL: [Self; 4] =
        [Self::VonMises, Self::Tresca, Self::GreatestShear, Self::GreatestTension];

    /// Its name in tables: `von_mises` and so on.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::VonMises => "von_mises",
            Self::Tresca => "tresca",
            Self::GreatestShear => "greatest_shear",
            Self::GreatestTension => "greatest_tension",
        }
    }
}

/// A stress tensor \[Pa\]: tension is positive; x and y along the surface, z into the body.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Stress {
    /// σxx.
    pub xx: f64,
    /// σyy.
    pub yy: f64,
    /// σzz, minus the pressure on the surface.
    pub zz: f64,
    /// σyz.
    pub yz: f64,
    /// σxz.
    pub xz: f64,
    /// σxy.
    pub xy: f64,
}

impl Stress {
    /// From its components in the order of Voigt: xx, yy, zz, yz, xz, xy.
    #[must_use]
    pub fn new([xx, yy, zz, yz, xz, xy]: [f64; COMPONENTS]) -> Self {
        Self { xx, yy, zz, yz, xz, xy }
    }

    /// Principal stresses, the greatest first.
    #[must_use]
    pub fn principal(&self) -> [f64; 3] {
        let Self { xx, yy, zz, yz, xz, xy } = *self;
        let values = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz).symmetric_eigenvalues();
        let mut values = [values.x, values.y, values.z];
        values.sort_by(|a, b| b.total_cmp(a));
        values
    }

    /// Von Mises' equivalent stress.
    #[must_use]
    pub fn von_mises(&self) -> f64 {
        let Self { xx, yy, zz, yz, xz, xy } = *self;
        let normal = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
        (0.5 * normal + 3.0 * (yz * yz + xz * xz + xy * xy)).sqrt()
    }

    /// A measure.
    #[must_use]
    pub fn measure(&self, measure: Measure) -> f64 {
        if measure == Measure::VonMises {
            return self.von_mises();
        }
        let [greatest, _, least] = self.principal();
        match measure {
            Measure::GreatestTension => greatest,
            Measure::GreatestShear => 0.5 * (greatest - least),
            _ => greatest - least,
        }
    }

    /// Whether a measure may exceed its greatest value so far, in the order of [`Measure::ALL`].
    ///
    /// With von Mises' stress s and the angle φ of Lode the difference of principal stresses is 2s/√3 cos(φ − π/6), and
    /// the greatest of them 2s/3 cos φ above their mean. Most nodes need no angle, and few of the others principal
    /// stresses, which have all digits.
    fn may_exceed(&self, [von_mises, tresca, _, tension]: [f64; 4]) -> bool {
        let own = self.von_mises();
        let mean = (self.xx + self.yy + self.zz) / 3.0;
        // A margin above all rounding: that of the angle is of the order of the root of one.
        let more = 1e-7 * (own + mean.abs());
        let (difference, above) = (own * (2.0 / 3.0_f64.sqrt()), own * (2.0 / 3.0));
        if own > von_mises {
            return true;
        }
        if difference + more <= tresca && mean + above + more <= tension {
            return false;
        }
        let third = own / 3.0;
        let cosine = self.third_invariant(mean) / (2.0 * third * third * third);
        let angle = libm::acos(cosine.clamp(-1.0, 1.0)) / 3.0;
        let difference = difference * libm::cos(angle - FRAC_PI_6);
        // Not a number is not known to be less.
        let is_less =
            difference + more <= tresca && mean + above * libm::cos(angle) + more <= tension;
        !is_less
    }

    /// Determinant of the deviator, the tensor less its mean.
    fn third_invariant(&self, mean: f64) -> f64 {
        let Self { xx, yy, zz, yz, xz, xy } = *self;
        let (xx, yy, zz) = (xx - mean, yy - mean, zz - mean);
        xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz)
    }

    /// All of them, in the order of [`Measure::ALL`].
    #[must_use]
    pub fn measures(&self) -> [f64; 4] {
        let [greatest, _, least] = self.principal();
        let tresca = greatest - least;
        [self.von_mises(), tresca, 0.5 * tresca, greatest]
    }
}

/// Nodes that one thread searches for the greatest values at a time.
const PART: usize = 1 << 14;

/// Replaces what is less; of equals the first stays.
fn keep_greater(greatest: &mut [(f64, usize); 4], others: [(f64, usize); 4]) {
    for (greatest, other) in greatest.iter_mut().zip(others) {
        if other.0 > greatest.0 {
            *greatest = other;
        }
    }
}

/// The stresses at one depth, with nx rows and ny columns each.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct StressField {
    /// Depth z \[m\].
    pub depth: f64,
    /// σxx \[Pa\]; tension is positive.
    pub xx: DMatrix<f64>,
    /// σyy \[Pa\].
    pub yy: DMatrix<f64>,
    /// σzz \[Pa\].
    pub zz: DMatrix<f64>,
    /// σyz \[Pa\].
    pub yz: DMatrix<f64>,
    /// σxz \[Pa\].
    pub xz: DMatrix<f64>,
    /// σxy \[Pa\].
    pub xy: DMatrix<f64>,
}

impl StressField {
    pub(super) fn new(depth: f64, [xx, yy, zz, yz, xz, xy]: [DMatrix<f64>; COMPONENTS]) -> Self {
        Self { depth, xx, yy, zz, yz, xz, xy }
    }

    /// The components in the order of Voigt: xx, yy, zz, yz, xz, xy.
    #[must_use]
    pub fn components(&self) -> [&DMatrix<f64>; COMPONENTS] {
        [&self.xx, &self.yy, &self.zz, &self.yz, &self.xz, &self.xy]
    }

    /// The tensor at a node, by its index as in [`Grid::index`](crate::Grid::index); `None` beyond the grid.
    #[must_use]
    pub fn at(&self, node: usize) -> Option<Stress> {
        let mut values = [0.0; COMPONENTS];
        for (value, field) in values.iter_mut().zip(self.components()) {
            *value = *field.as_slice().get(node)?;
        }
        Some(Stress::new(values))
    }

    /// A measure at each node.
    #[must_use]
    pub fn map(&self, measure: Measure) -> DMatrix<f64> {
        let (nx, ny) = self.xx.shape();
        let mut map = DMatrix::zeros(nx, ny);
        self.fill(map.as_mut_slice(), nx, |stress| stress.measure(measure));
        map
    }

    /// The greatest value of each measure at this depth and the node where it is, in the order of [`Measure::ALL`].
    #[must_use]
    pub fn greatest(&self) -> [(f64, usize); 4] {
        const NONE: [(f64, usize); 4] = [(f64::NEG_INFINITY, 0); 4];
        let fields = self.components().map(DMatrix::as_slice);
        let nodes = self.xx.len();
        let mut parts = vec![NONE; nodes.div_ceil(PART)];
        for_each_chunk(&mut parts, 1, |chunk, part| {
            for greatest in part {
                for node in chunk * PART..nodes.min((chunk + 1) * PART) {
                    let stress = Stress::new(fields.map(|field| field[node]));
                    if stress.may_exceed(greatest.map(|(value, _)| value)) {
                        keep_greater(greatest, stress.measures().map(|value| (value, node)));
                    }
                }
            }
        });
        let mut all = NONE;
        parts.into_iter().for_each(|part| keep_greater(&mut all, part));
        all
    }

    fn fill<T: Send>(&self, values: &mut [T], row: usize, of: impl Fn(&Stress) -> T + Sync + Send) {
        let fields = self.components().map(DMatrix::as_slice);
        for_each_chunk(values, row.max(1), |chunk, values| {
            for (value, node) in values.iter_mut().zip(chunk * row.max(1)..) {
                *value = of(&Stress::new(fields.map(|field| field[node])));
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// States of which every measure is known: uniaxial, hydrostatic, simple shear, and one that is turned.
    #[test]
    fn measures_of_simple_states() {
        let close = |found: [f64; 4], expected: [f64; 4]| {
            for (found, expected) in found.into_iter().zip(expected) {
                // Eigenvalues of numbers of order 3, to a few roundings.
                assert!((found - expected).abs() < 1e-14, "{found} {expected}");
            }
        };
        let uniaxial = Stress { zz: -2.0, ..Stress::default() };
        close(uniaxial.measures(), [2.0, 2.0, 1.0, 0.0]);
        let hydrostatic = Stress { xx: -3.0, yy: -3.0, zz: -3.0, ..Stress::default() };
        close(hydrostatic.measures(), [0.0, 0.0, 0.0, -3.0]);
        let shear = Stress { xz: 1.0, ..Stress::default() };
        close(shear.measures(), [3.0_f64.sqrt(), 2.0, 1.0, 1.0]);
        // Uniaxial along (1, 1, 0).
        let turned = Stress { xx: 1.0, yy: 1.0, xy: 1.0, ..Stress::default() };
        close(turned.measures(), [2.0, 2.0, 1.0, 2.0]);
        for (measure, value) in Measure::ALL.into_iter().zip(turned.measures()) {
            assert!((turned.measure(measure) - value).abs() < 1e-14, "{measure:?}");
        }
    }

    /// Sum, sum of products and product of the principal stresses are the invariants of the tensor.
    #[test]
    fn principal_stresses_have_the_invariants_of_the_tensor() {
        for values in [
            [1.0, 2.0, -3.0, 0.5, -0.7, 1.1],
            [-2.0, 0.3, 0.3, 0.0, 1.5, 0.0],
            [0.1, -0.2, 0.4, 2.0, -1.0, 3.0],
            [-5.0, -4.0, -1.0, 1e-3, 0.0, 1e-3],
        ] {
            let stress = Stress::new(values);
            let [first, second, third] = stress.principal();
            assert!(first >= second && second >= third, "{stress:?}");
            let Stress { xx, yy, zz, yz, xz, xy } = stress;
            let minors = xx * yy - xy * xy + yy * zz - yz * yz + zz * xx - xz * xz;
            let product = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz).determinant();
            let found = [
                first + second + third,
                first * second + second * third + third * first,
                first * second * third,
            ];
            let greatest: f64 = values.iter().map(|value| value.abs()).sum();
            for ((found, expected), power) in
                found.into_iter().zip([xx + yy + zz, minors, product]).zip(1..)
            {
                // Eigenvalues to a few roundings of the greatest, and each product of so many.
                assert!(
                    (found - expected).abs() < 1e-14 * greatest.powi(power),
                    "{stress:?} {power}"
                );
            }
        }
    }

    /// What is left out is never greater, and few that are not are left in: states around simple ones, where two
    /// principal stresses are equal, and anywhere.
    #[test]
    fn nothing_greater_is_left_out() {
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        let mut kept = 0;
        for k in 0..20_000 {
            let size = [1.0, 1e-3, 1e-8, 0.0][k % 4];
            let base = [[-1.0, -1.0, -2.0], [1.0, 0.5, -0.5], [3.0, 3.0, 3.0], [-1.0, 2.0, 2.0]]
                [k / 4 % 4];
            let values: [f64; 6] =
                std::array::from_fn(|c| size * random() + if c < 3 { base[c] } else { 0.0 });
            let stress = Stress::new(values);
            let own = stress.measures();
            // Each by itself, a little less than it is.
            for c in 0..4 {
                let mut best = own.map(|value| value + 1.0);
                best[c] = own[c] - 1e-14;
                // The third is half of the second.
                best[1] = best[1].min(2.0 * best[2]);
                assert!(stress.may_exceed(best), "{values:?} {c}");
            }
            kept += usize::from(stress.may_exceed(own.map(|value| value + 2e-6)));
        }
        assert_eq!(kept, 0);
    }
}
