//! Conductance of a contact from its stiffness.

use asperity::Error;
use asperity::reference::{CircularPunch, HertzSphere, Westergaard, contact_conductance};
use asperity_testing::assert_relative;
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
        assert_relative!(found, holm, 1e-15);
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
        // At a/λ = 0.49 the logarithm is 5e-4, and shows 2000 rounding errors of its argument.
        assert_relative!(found, expected, 5e-12);
    }
    let full = wave.interfacial_stiffness(wave.full_contact_pressure());
    assert_eq!(contact_conductance(full, wave.e_star(), rho_1)?, f64::INFINITY);
    Ok(())
}

#[test]
fn no_stiffness_no_conductance_and_nonsense_is_refused() -> Result<(), Error> {
    assert_eq!(contact_conductance(0.0, 1.0, 1.0)?, 0.0);
    for stiffness in [-1.0, f64::NAN, f64::NEG_INFINITY] {
        assert!(matches!(contact_conductance(stiffness, 1.0, 1.0), Err(Error::OutOfRange { .. })));
    }
    for (e_star, resistivity) in [(0.0, 1.0), (1.0, f64::NAN)] {
        assert!(matches!(
            contact_conductance(1.0, e_star, resistivity),
            Err(Error::NotPositive { .. })
        ));
    }
    Ok(())
}
