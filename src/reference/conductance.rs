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
/// # Which stiffness
///
/// The incremental one: the derivative on further loading of the nodes in contact, which every state of a path
/// has. The secant W/δ has no such meaning.
///
/// * *Free half-space* ([`Boussinesq`](crate::Boussinesq)): `contact_stiffness`, dW/dδ for the approach of distant
///   points. The resistance is that between points far off in both bodies, with the constriction of the current into
///   the nominal area as a whole, so that it stays finite in full contact: a punch has a resistance too.
/// * *Periodic half-space* ([`PeriodicBoussinesq`](crate::PeriodicBoussinesq), [`Spectral`](crate::Spectral)):
///   `interfacial_stiffness`, −dW/dḡ. The resistance is what the interface adds to that of the
///   bodies with a uniform current, for one period of the surface. In full contact it adds nothing, and the
///   conductance is infinite.
///
/// `contact.contact_stiffness.or(contact.interfacial_stiffness)` is the right one on either. A layer, or a graded
/// body, has no such analogy: current and displacement solve different problems there.
///
/// ```
/// use asperity::reference::contact_conductance;
/// use asperity::{Grid, LoadingSolver, PeriodicBoussinesq, SelfAffine};
///
/// # fn main() -> Result<(), asperity::Error> {
/// let (e_star, copper) = (115e9, 1.7e-8);
/// let half_space = PeriodicBoussinesq::new(Grid::square(32, 1.25e-3)?, e_star)?;
/// let mut last = 0.0;
/// for state in LoadingSolver::builder(&SelfAffine::zhang2020(1), &half_space).build()? {
///     let contact = state?.contact;
///     if let Some(stiffness) = contact.contact_stiffness.or(contact.interfacial_stiffness) {
///         last = contact_conductance(stiffness, e_star, copper + copper)?;
///         println!("{} N: {last} S", contact.load);
///     }
/// }
/// assert_eq!(last, f64::INFINITY); // full contact
/// # Ok(())
/// # }
/// ```
///
/// Barber, Proc. R. Soc. A 459 (2003) 53.
///
/// # Errors
///
/// [`Error::NotPositive`] for `e_star` and `resistivity`; [`Error::OutOfRange`] for a stiffness that
/// is negative or NaN.
pub fn contact_conductance(
    contact_stiffness: f64,
    e_star: f64,
    resistivity: f64,
) -> Result<f64, Error> {
    let is_one = contact_stiffness >= 0.0;
    Error::require("contact stiffness", contact_stiffness, is_one, "not negative")?;
    let e_star = Error::require_positive("plane-strain modulus", e_star)?;
    let resistivity = Error::require_positive("resistivity", resistivity)?;
    Ok(2.0 * contact_stiffness / e_star / resistivity)
}

#[cfg(test)]
mod tests {
    use super::super::{CircularPunch, HertzSphere, Westergaard};
    use super::*;
    use approx::assert_relative_eq;
    use std::f64::consts::PI;

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
        for stiffness in [sphere.contact_stiffness(approach), punch.contact_stiffness()] {
            let found = contact_conductance(stiffness, e_star, rho_1 + rho_2)?;
            assert_relative_eq!(found, holm, max_relative = 1e-15);
        }
        Ok(())
    }

    /// Strips of width 2a at distances λ, without any elasticity: the potential in each body is the real part of
    /// arcosh(sin(π z/λ) / sin(π a/λ)), zero on the strips. Far off that is π y/λ + ln(1/sin(π a/λ)), so that the
    /// strips add the resistance of a layer of thickness (λ/π) ln(1/sin(π a/λ)).
    #[test]
    fn strips_have_the_resistance_of_a_conformal_map() -> Result<(), Error> {
        let (rho_1, rho_2, wavelength) = (2.0, 0.5, 3e-4);
        let wave = Westergaard::new(1e-6, wavelength, 80e9)?;
        for part in [1e-3, 0.1, 0.4, 0.49] {
            let half_width = part * wavelength;
            let mean_pressure = wave.mean_pressure_at_half_width(half_width);
            let stiffness = wave.interfacial_stiffness(mean_pressure);
            let found = contact_conductance(stiffness, wave.e_star(), rho_1 + rho_2)?;
            let resistance = |rho: f64| rho * wavelength / PI * -(PI * part).sin().ln();
            let expected = 1.0 / (resistance(rho_1) + resistance(rho_2));
            // At a/λ = 0.49 the logarithm is 5e-4, and shows 2000 roundings of its argument.
            assert_relative_eq!(found, expected, max_relative = 5e-12);
        }
        let full = wave.interfacial_stiffness(wave.full_contact_pressure());
        assert_eq!(contact_conductance(full, wave.e_star(), rho_1)?, f64::INFINITY);
        Ok(())
    }

    #[test]
    fn no_stiffness_no_conductance_and_nonsense_is_refused() -> Result<(), Error> {
        assert_eq!(contact_conductance(0.0, 1.0, 1.0)?, 0.0);
        for stiffness in [-1.0, f64::NAN, f64::NEG_INFINITY] {
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
