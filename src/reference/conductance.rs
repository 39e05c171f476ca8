//! Conductance of a contact from its stiffness.

use crate::Error;

/// Electrical conductance of a contact, from its stiffness:
/// ```math
/// \frac{1}{R} = \frac{2}{\rho E^\ast} \frac{\mathrm{d}W}{\mathrm{d}\delta}
/// ```
///
/// `contact_stiffness` is `dW/dδ` \[N/m\] and `e_star` the composite modulus \[Pa\]; `resistivity` is
/// `ρ = ρ₁ + ρ₂`, the *sum* over both bodies \[Ω m\]. The result \[S\] is the conductance of the
/// constriction alone, between half-spaces without films. It holds for any shape of the contact: the
/// potential under a current and the displacement under a further load solve the same problem.
/// With thermal resistivities \[m K/W\] the result is the thermal conductance \[W/K\]. A stiffness per
/// area gives a conductance per area.
///
/// Barber, Proc. R. Soc. A 459 (2003) 53.
///
/// # Errors
///
/// [`Error::NotPositive`] for `e_star` and `resistivity`; [`Error::OutOfRange`] for a stiffness that
/// is negative or not finite.
pub fn contact_conductance(
    contact_stiffness: f64,
    e_star: f64,
    resistivity: f64,
) -> Result<f64, Error> {
    if !(contact_stiffness >= 0.0 && contact_stiffness.is_finite()) {
        return Err(Error::OutOfRange {
            quantity: "contact stiffness",
            value: contact_stiffness,
            expected: "finite and not negative",
        });
    }
    let e_star = Error::require_positive("plane-strain modulus", e_star)?;
    let resistivity = Error::require_positive("resistivity", resistivity)?;
    Ok(2.0 * contact_stiffness / e_star / resistivity)
}

#[cfg(test)]
mod tests {
    use super::super::{CircularPunch, HertzSphere};
    use super::*;
    use approx::assert_relative_eq;

    /// Holm's constriction resistance of a spot of radius a is ρ/4a in each body, whatever presses
    /// the bodies together.
    #[test]
    fn a_circular_spot_has_holms_resistance() -> Result<(), Error> {
        let (rho_1, rho_2, e_star) = (1.7e-8, 5.6e-8, 80e9);
        let sphere = HertzSphere::new(0.01, e_star)?;
        let approach = 1e-6;
        let a = sphere.contact_radius(approach);
        let punch = CircularPunch::new(a, e_star)?;
        let holm = 1.0 / (rho_1 / (4.0 * a) + rho_2 / (4.0 * a));
        for stiffness in [
            sphere.contact_stiffness(approach),
            punch.contact_stiffness(),
        ] {
            let found = contact_conductance(stiffness, e_star, rho_1 + rho_2)?;
            assert_relative_eq!(found, holm, max_relative = 1e-15);
        }
        Ok(())
    }

    #[test]
    fn no_stiffness_no_conductance_and_nonsense_is_refused() -> Result<(), Error> {
        assert_eq!(contact_conductance(0.0, 1.0, 1.0)?, 0.0);
        for stiffness in [-1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(
                contact_conductance(stiffness, 1.0, 1.0),
                Err(Error::OutOfRange { .. })
            ));
        }
        for (e_star, resistivity) in [(0.0, 1.0), (1.0, f64::NAN)] {
            assert!(matches!(
                contact_conductance(1.0, e_star, resistivity),
                Err(Error::NotPositive { .. })
            ));
        }
        Ok(())
    }
}
