//! Cone on a half-space.

use asperity::Error;
use asperity::reference::Cone;
use asperity_testing::assert_relative;
use std::f64::consts::PI;

use super::quadrature::{derivative, integrate, ring_displacement};

const APPROACHES: [f64; 3] = [1e-9, 2.3e-6, 1e-3];

fn cone() -> Result<Cone, Error> {
    Cone::new(0.07, 64e9)
}

#[test]
fn pressure_adds_up_to_load_and_its_mean() -> Result<(), Error> {
    let cone = cone()?;
    for d in APPROACHES {
        let a = cone.contact_radius(d);
        let load = integrate(|r| 2.0 * PI * r * cone.pressure(r, d), 0.0, a);
        // Accuracy of the quadrature.
        assert_relative!(load, cone.load(d), 1e-12);
        let mean = cone.load(d) / cone.contact_area(d);
        assert_relative!(mean, cone.mean_pressure(), 1e-14);
    }
    Ok(())
}

#[test]
fn load_is_the_slope_of_energy_and_stiffness_that_of_load() -> Result<(), Error> {
    let cone = cone()?;
    for d in APPROACHES {
        let work = integrate(|x| cone.load(x), 0.0, d);
        assert_relative!(work, cone.energy(d), 1e-13);
        let slope = derivative(|x| cone.load(x), d);
        // Stated error of the difference formula, with a margin of ten.
        assert_relative!(slope, cone.contact_stiffness(d), 2e-12);
        let back = cone.approach_at_load(cone.load(d));
        assert_relative!(back, d, 1e-15);
    }
    Ok(())
}

#[test]
fn displacement_is_that_of_the_pressure() -> Result<(), Error> {
    let cone = cone()?;
    let d = 2.3e-6;
    let a = cone.contact_radius(d);
    // At the apex every ring of load lies at its own radius.
    let apex = 2.0 / cone.e_star() * integrate(|r| cone.pressure(r, d), 0.0, a);
    assert_relative!(apex, cone.displacement(0.0, d), 1e-12);
    for ratio in [1.2, 2.0, 5.0, 40.0] {
        let r = ratio * a;
        let rings = ring_displacement(|s| cone.pressure(s, d), a, r, cone.e_star());
        // Accuracy of the quadrature, whose integrand is nearly singular close to the edge.
        assert_relative!(rings, cone.displacement(r, d), 1e-12);
        assert!(cone.displacement(r, d) + cone.slope() * r > d);
    }
    // Far away, a point load: the next term is of order (a/r)² = 1e-16.
    let r = 1e8 * a;
    let point = cone.load(d) / (PI * cone.e_star() * r);
    assert_relative!(cone.displacement(r, d), point, 1e-15);
    Ok(())
}

#[test]
fn edge_and_apex() -> Result<(), Error> {
    let cone = cone()?;
    let d = 1e-6;
    let a = cone.contact_radius(d);
    assert_eq!(cone.pressure(a, d), 0.0);
    assert_eq!(cone.pressure(0.0, d), f64::INFINITY);
    // The slope of the surface is continuous at the edge, so one rounding of r is one of u.
    let beyond = cone.displacement(a * (1.0 + 1e-15), d);
    assert_relative!(cone.displacement(a, d), beyond, 1e-14);
    Ok(())
}

#[test]
fn no_approach_no_contact() -> Result<(), Error> {
    let cone = cone()?;
    for d in [0.0, -1e-6] {
        for value in [
            cone.contact_radius(d),
            cone.contact_area(d),
            cone.load(d),
            cone.approach_at_load(d),
            cone.contact_stiffness(d),
            cone.energy(d),
            cone.pressure(0.0, d),
            cone.displacement(0.0, d),
            cone.displacement(1e-3, d),
        ] {
            assert_eq!(value, 0.0);
        }
    }
    Ok(())
}

#[test]
fn impossible_cones_are_refused() {
    for (slope, e_star) in [(0.0, 1.0), (1.0, f64::NAN)] {
        assert!(matches!(Cone::new(slope, e_star), Err(Error::NotPositive { .. })));
    }
}
