//! The composite modulus of one or two elastic bodies.

use crate::Error;

/// Plane-strain modulus of one body against a rigid one, $`E^* = E / (1 - \nu^2)`$ \[Pa\].
///
/// # Errors
///
/// [`Error::NotPositive`] for E, [`Error::OutOfRange`] unless −1 < ν ≤ ½.
pub fn plane_strain_modulus(youngs_modulus: f64, poissons_ratio: f64) -> Result<f64, Error> {
    let e = Error::require_positive("Young's modulus", youngs_modulus)?;
    let is_one = poissons_ratio > -1.0 && poissons_ratio <= 0.5;
    let expected = "above -1 and at most 1/2";
    Error::require("Poisson's ratio", poissons_ratio, is_one, expected)?;
    Error::require_positive("plane-strain modulus", e / (1.0 - poissons_ratio * poissons_ratio))
}

/// Composite modulus of two bodies, each given by (E, ν):
/// `1/E* = (1-ν₁²)/E₁ + (1-ν₂²)/E₂` \[Pa\].
///
/// No factor 2: the E′ of elastohydrodynamics is 2 E*.
///
/// # Errors
///
/// As [`plane_strain_modulus`], for either body.
pub fn composite_modulus(first: (f64, f64), second: (f64, f64)) -> Result<f64, Error> {
    let e1 = plane_strain_modulus(first.0, first.1)?;
    let e2 = plane_strain_modulus(second.0, second.1)?;
    Error::require_positive("composite modulus", 1.0 / (1.0 / e1 + 1.0 / e2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn equal_bodies_halve_the_modulus() -> Result<(), Error> {
        let one = plane_strain_modulus(210e9, 0.3)?;
        assert_relative_eq!(one, 210e9 / 0.91, epsilon = 0.0, max_relative = 1e-15);
        let both = composite_modulus((210e9, 0.3), (210e9, 0.3))?;
        assert_relative_eq!(both, 0.5 * one, epsilon = 0.0, max_relative = 1e-15);
        Ok(())
    }

    #[test]
    fn impossible_materials_are_refused() {
        for (e, nu) in [(0.0, 0.3), (-1.0, 0.3), (f64::NAN, 0.3), (f64::INFINITY, 0.3)] {
            assert!(matches!(plane_strain_modulus(e, nu), Err(Error::NotPositive { .. })));
        }
        for nu in [-1.0, 0.6, f64::NAN] {
            assert!(matches!(plane_strain_modulus(1.0, nu), Err(Error::OutOfRange { .. })));
        }
    }
}
