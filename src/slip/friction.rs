//! Friction between two bodies, and how they yield tangentially.

use crate::{Error, plane_strain_modulus};

/// Coulomb friction, and the ratio of tangential to normal compliance of the bodies.
///
/// ```
/// use asperity::slip::Friction;
///
/// # fn main() -> Result<(), asperity::Error> {
/// let steel = (210e9, 0.3);
/// let alike = Friction::between(0.3, steel, Some(steel))?;
/// assert!((alike.compliance_ratio() - 1.7 / 1.4).abs() < 1e-15);
/// assert_eq!(alike.dundurs_beta(), Some(0.0));
/// let against_rigid = Friction::between(0.3, steel, None)?;
/// assert!((against_rigid.dundurs_beta().unwrap_or(0.0) - 0.4 / 1.4).abs() < 1e-15);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Friction {
    coefficient: f64,
    compliance_ratio: f64,
    dundurs_beta: Option<f64>,
}

impl Friction {
    /// |β| from which on the results of [`slip`](super) are to be read with care: see there.
    pub const COUPLED: f64 = 0.1;

    /// Friction of coefficient μ between bodies whose ratio of compliances is `κ = E*/G*`.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for either.
    pub fn new(coefficient: f64, compliance_ratio: f64) -> Result<Self, Error> {
        Ok(Self {
            coefficient: Error::require_positive("coefficient of friction", coefficient)?,
            compliance_ratio: Error::require_positive(
                "ratio of tangential to normal compliance",
                compliance_ratio,
            )?,
            dundurs_beta: None,
        })
    }

    /// Friction of coefficient μ between two bodies, each given by (E, ν) with E in Pa; without a second one that is
    /// rigid.
    ///
    /// ```math
    /// \kappa = \frac{E^\ast}{G^\ast}, \qquad
    /// \frac{1}{E^\ast} = \sum_i \frac{1-\nu_i}{2 G_i}, \qquad
    /// \frac{1}{G^\ast} = \sum_i \frac{2-\nu_i}{4 G_i}, \qquad
    /// \beta = \frac{(1-2\nu_1)/G_1 - (1-2\nu_2)/G_2}{2 \sum_i (1-\nu_i)/G_i}
    /// ```
    /// with Gᵢ = Eᵢ/(2(1 + νᵢ)). Of bodies alike, and against a rigid one, κ = (2 − ν)/(2(1 − ν)). The G* of Johnson,
    /// *Contact Mechanics*, §7.2, is a quarter of this.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for μ and E; [`Error::OutOfRange`] unless −1 < ν ≤ ½.
    pub fn between(
        coefficient: f64,
        first: (f64, f64),
        second: Option<(f64, f64)>,
    ) -> Result<Self, Error> {
        let compliances = |(modulus, ratio): (f64, f64)| -> Result<[f64; 3], Error> {
            let normal = 1.0 / plane_strain_modulus(modulus, ratio)?;
            // Over (1 − ν)/(2G), the normal one.
            let tangential = (2.0 - ratio) / (2.0 * (1.0 - ratio));
            let coupling = (1.0 - 2.0 * ratio) / (2.0 * (1.0 - ratio));
            Ok([normal, normal * tangential, normal * coupling])
        };
        let one = compliances(first)?;
        let other = second.map_or(Ok([0.0; 3]), compliances)?;
        let normal = one[0] + other[0];
        let friction = Self::new(coefficient, (one[1] + other[1]) / normal)?;
        Ok(Self { dundurs_beta: Some((one[2] - other[2]) / normal), ..friction })
    }

    /// Coefficient of friction μ.
    #[must_use]
    pub fn coefficient(&self) -> f64 {
        self.coefficient
    }

    /// Ratio of tangential to normal compliance, `κ = E*/G*`.
    #[must_use]
    pub fn compliance_ratio(&self) -> f64 {
        self.compliance_ratio
    }

    /// Dundurs' β of the two bodies, `None` if they are not known.
    #[must_use]
    pub fn dundurs_beta(&self) -> Option<f64> {
        self.dundurs_beta
    }

    /// Whether tangential tractions move the surfaces normally by more than can be neglected: |β| is at least
    /// [`Self::COUPLED`].
    #[must_use]
    pub fn is_coupled(&self) -> bool {
        // 0.1 of ν = 4/9 is 0.1 to rounding.
        self.dundurs_beta.is_some_and(|beta| beta.abs() >= Self::COUPLED * (1.0 - 1e-12))
    }

    /// κμ: the displacement for a change of the approach.
    pub(super) fn displacement_per_approach(&self) -> f64 {
        self.compliance_ratio * self.coefficient
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bodies_alike_are_not_coupled_and_rigid_ones_are() -> Result<(), Error> {
        for (ratio, expected) in [(0.0, 1.0), (0.3, 1.7 / 1.4), (0.5, 1.5)] {
            for second in [None, Some((1.0, ratio))] {
                let friction = Friction::between(0.3, (1.0, ratio), second)?;
                assert!((friction.compliance_ratio() - expected).abs() < 1e-15);
                let beta = if second.is_some() { 0.0 } else { (0.5 - ratio) / (1.0 - ratio) };
                assert!((friction.dundurs_beta().unwrap_or(f64::NAN) - beta).abs() < 1e-15);
                assert_eq!(friction.is_coupled(), beta >= 0.1);
            }
        }
        // ν = 4/9 against rigid is just the limit.
        assert!(Friction::between(0.3, (1.0, 4.0 / 9.0), None)?.is_coupled());
        assert!(!Friction::new(0.3, 1.2)?.is_coupled());
        Ok(())
    }

    /// Of two different bodies, by the sums of the definition: G₁ = 1, ν₁ = 0.25, G₂ = 3, ν₂ = 0.4.
    #[test]
    fn two_bodies_add_their_compliances() -> Result<(), Error> {
        let friction = Friction::between(0.5, (2.5, 0.25), Some((8.4, 0.4)))?;
        let normal = 0.75 / 2.0 + 0.6 / 6.0;
        let tangential = 1.75 / 4.0 + 1.6 / 12.0;
        let beta = (0.5 - 0.2 / 3.0) / (2.0 * (0.75 + 0.2));
        assert!((friction.compliance_ratio() - tangential / normal).abs() < 1e-15);
        assert!((friction.dundurs_beta().unwrap_or(0.0) - beta).abs() < 1e-15);
        assert_eq!(friction.coefficient(), 0.5);
        Ok(())
    }

    #[test]
    fn impossible_friction_is_refused() {
        for bad in [0.0, -0.3, f64::NAN, f64::INFINITY] {
            assert!(matches!(Friction::new(bad, 1.2), Err(Error::NotPositive { .. })));
            assert!(matches!(Friction::new(0.3, bad), Err(Error::NotPositive { .. })));
            let refused = Friction::between(0.3, (bad, 0.3), None);
            assert!(matches!(refused, Err(Error::NotPositive { .. })));
        }
        let refused = Friction::between(0.3, (1.0, 0.3), Some((1.0, 0.6)));
        assert!(matches!(refused, Err(Error::OutOfRange { .. })));
    }
}
