//! Flat punches on a half-space.

use asperity::Error;
use asperity::reference::{CircularPunch, HertzSphere, SQUARE_PUNCH_STIFFNESS};
use asperity_testing::assert_relative;
use std::f64::consts::PI;

use super::quadrature::{integrate, ring_displacement};

fn punch() -> Result<CircularPunch, Error> {
    CircularPunch::new(0.003, 50e9)
}

#[test]
fn pressure_adds_up_to_load_and_its_mean() -> Result<(), Error> {
    let punch = punch()?;
    let d = 1e-6;
    let a = punch.radius();
    // Up to the infinite edge the quadrature is good to √ε; short of it, where the disc of
    // radius ca carries 1 − √(1 − c²) of the load, to rounding.
    for (c, tolerance) in [(0.3_f64, 1e-12), (0.9, 1e-12), (1.0, 1e-7)] {
        let inner = integrate(|r| 2.0 * PI * r * punch.pressure(r, d), 0.0, c * a);
        let share = 1.0 - (1.0 - c * c).sqrt();
        assert_relative!(inner, share * punch.load(d), tolerance);
    }
    let mean = punch.load(d) / punch.contact_area();
    assert_relative!(mean, punch.mean_pressure(d), 1e-15);
    let center = punch.pressure(0.0, d);
    assert_relative!(center, 0.5 * mean, 1e-15);
    Ok(())
}

#[test]
fn displacement_is_that_of_the_pressure() -> Result<(), Error> {
    let punch = punch()?;
    let d = 1e-6;
    let a = punch.radius();
    for ratio in [1.2, 2.0, 40.0] {
        let r = ratio * a;
        let rings = ring_displacement(|s| punch.pressure(s, d), a, r, punch.e_star());
        // √ε of the quadrature, as above.
        assert_relative!(rings, punch.displacement(r, d), 1e-7);
    }
    // Far away, a point load: the next term is (a/r)²/6 = 2e-17.
    let r = 1e8 * a;
    let point = punch.load(d) / (PI * punch.e_star() * r);
    assert_relative!(punch.displacement(r, d), point, 1e-15);
    Ok(())
}

/// Each step of approach of a round shape is a step of a punch as wide as the contact, so the
/// fields of the sphere are sums over punches.
#[test]
fn a_sphere_is_a_sequence_of_punches() -> Result<(), Error> {
    let sphere = HertzSphere::new(0.01, 50e9)?;
    let d = 1e-6;
    let step = |x: f64| CircularPunch::new(sphere.contact_radius(x), 50e9);
    let sum = |field: &dyn Fn(CircularPunch) -> f64| {
        integrate(|x| step(x).map_or(f64::NAN, field), 0.0, d)
    };
    let far = 1.7 * sphere.contact_radius(d);
    for (punches, whole) in [
        (sum(&|p| p.load(1.0)), sphere.load(d)),
        (sum(&|p| p.pressure(0.0, 1.0)), sphere.max_pressure(d)),
        (sum(&|p| p.displacement(far, 1.0)), sphere.displacement(far, d)),
    ] {
        // Accuracy of the quadrature.
        assert_relative!(punches, whole, 1e-12);
    }
    Ok(())
}

#[test]
fn energy_is_work_and_load_inverts() -> Result<(), Error> {
    let punch = punch()?;
    let d = 1e-6;
    let work = integrate(|x| punch.load(x), 0.0, d);
    assert_relative!(work, punch.energy(d), 1e-14);
    let back = punch.approach_at_load(punch.load(d));
    assert_relative!(back, d, 1e-15);
    Ok(())
}

#[test]
fn edge_and_rest() -> Result<(), Error> {
    let punch = punch()?;
    let a = punch.radius();
    assert_eq!(punch.pressure(a, 1e-6), f64::INFINITY);
    assert_eq!(punch.pressure(1.001 * a, 1e-6), 0.0);
    assert_eq!(punch.displacement(a, 1e-6), 1e-6);
    for d in [0.0, -1e-6] {
        for value in [
            punch.load(d),
            punch.approach_at_load(d),
            punch.mean_pressure(d),
            punch.energy(d),
            punch.pressure(a, d),
            punch.displacement(0.0, d),
            punch.displacement(2.0 * a, d),
        ] {
            assert_eq!(value, 0.0);
        }
    }
    Ok(())
}

/// Capacity grows with the body, and of all plates of one area the disc has the least
/// (Pólya & Szegő 1951).
#[test]
fn square_lies_between_the_discs_that_bound_it() -> Result<(), Error> {
    let same_area = CircularPunch::new(1.0 / PI.sqrt(), 1.0)?;
    let around = CircularPunch::new(0.5_f64.sqrt(), 1.0)?;
    assert!(same_area.contact_stiffness() < SQUARE_PUNCH_STIFFNESS);
    assert!(SQUARE_PUNCH_STIFFNESS < around.contact_stiffness());
    Ok(())
}

#[test]
fn impossible_punches_are_refused() {
    for (radius, e_star) in [(0.0, 1.0), (1.0, f64::NAN)] {
        assert!(matches!(CircularPunch::new(radius, e_star), Err(Error::NotPositive { .. })));
    }
}
