//! Sphere on a half-space (Hertz).

use asperity::Error;
use asperity::reference::HertzSphere;
use asperity_testing::assert_relative;
use std::f64::consts::PI;

use super::quadrature::{derivative, integrate, ring_displacement};

const APPROACHES: [f64; 3] = [1e-9, 3.7e-6, 1e-3];

fn sphere() -> Result<HertzSphere, Error> {
    HertzSphere::new(0.013, 77e9)
}

#[test]
fn pressure_adds_up_to_load_and_its_mean() -> Result<(), Error> {
    let sphere = sphere()?;
    for d in APPROACHES {
        let a = sphere.contact_radius(d);
        let load = integrate(|r| 2.0 * PI * r * sphere.pressure(r, d), 0.0, a);
        // Accuracy of the quadrature.
        assert_relative!(load, sphere.load(d), 1e-12);
        let mean = sphere.load(d) / sphere.contact_area(d);
        assert_relative!(mean, sphere.mean_pressure(d), 1e-14);
        assert_relative!(sphere.contact_area(d), PI * a * a, 1e-15);
        assert_eq!(sphere.pressure(0.0, d), sphere.max_pressure(d));
    }
    Ok(())
}

#[test]
fn load_is_the_slope_of_energy_and_stiffness_that_of_load() -> Result<(), Error> {
    let sphere = sphere()?;
    for d in APPROACHES {
        let work = integrate(|x| sphere.load(x), 0.0, d);
        assert_relative!(work, sphere.energy(d), 1e-13);
        let slope = derivative(|x| sphere.load(x), d);
        // Stated error of the difference formula, with a margin of ten.
        assert_relative!(slope, sphere.contact_stiffness(d), 2e-12);
        let back = sphere.approach_at_load(sphere.load(d));
        assert_relative!(back, d, 1e-15);
    }
    Ok(())
}

#[test]
fn displacement_is_that_of_the_pressure() -> Result<(), Error> {
    let sphere = sphere()?;
    let d = 3.7e-6;
    let a = sphere.contact_radius(d);
    // At the centre every ring of load lies at its own radius.
    let center = 2.0 / sphere.e_star() * integrate(|r| sphere.pressure(r, d), 0.0, a);
    assert_relative!(center, sphere.displacement(0.0, d), 1e-13);
    for ratio in [1.2, 1.9, 2.0, 2.1, 5.0, 40.0] {
        let r = ratio * a;
        let rings = ring_displacement(|s| sphere.pressure(s, d), a, r, sphere.e_star());
        // Accuracy of the quadrature, whose integrand is nearly singular close to the edge.
        assert_relative!(rings, sphere.displacement(r, d), 1e-12);
        assert!(sphere.displacement(r, d) + 0.5 * r * r / sphere.radius() > d);
    }
    // Far away, a point load: the next term is 0.1 (a/r)² = 1e-15.
    let r = 1e7 * a;
    let point = sphere.load(d) / (PI * sphere.e_star() * r);
    assert_relative!(sphere.displacement(r, d), point, 2e-15);
    Ok(())
}

#[test]
fn both_branches_meet() -> Result<(), Error> {
    let sphere = sphere()?;
    let d = 1e-6;
    let a = sphere.contact_radius(d);
    // Across one rounding of r, at the edge and where the series takes over.
    for r in [a, 2.0 * a] {
        let beyond = sphere.displacement(r * (1.0 + 1e-15), d);
        assert_relative!(sphere.displacement(r, d), beyond, 1e-14);
    }
    assert_eq!(sphere.pressure(a, d), 0.0);
    assert_eq!(sphere.displacement(-0.3 * a, d), sphere.displacement(0.3 * a, d));
    Ok(())
}

#[test]
fn no_approach_no_contact() -> Result<(), Error> {
    let sphere = sphere()?;
    for d in [0.0, -1e-6] {
        for value in [
            sphere.contact_radius(d),
            sphere.contact_area(d),
            sphere.load(d),
            sphere.approach_at_load(d),
            sphere.max_pressure(d),
            sphere.mean_pressure(d),
            sphere.contact_stiffness(d),
            sphere.energy(d),
            sphere.pressure(0.0, d),
            sphere.displacement(0.0, d),
            sphere.displacement(1e-3, d),
        ] {
            assert_eq!(value, 0.0);
        }
    }
    assert!(sphere.load(f64::NAN).is_nan());
    Ok(())
}

#[test]
fn impossible_spheres_are_refused() {
    for (radius, e_star) in [(0.0, 1.0), (1.0, -1.0), (f64::NAN, 1.0), (1.0, f64::INFINITY)] {
        assert!(matches!(HertzSphere::new(radius, e_star), Err(Error::NotPositive { .. })));
    }
}
