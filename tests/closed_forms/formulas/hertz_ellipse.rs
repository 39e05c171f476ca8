//! Elliptic paraboloid on a half-space (Hertz).

use approx::assert_abs_diff_eq;
use asperity::Error;
use asperity::reference::{HertzEllipse, HertzLine, HertzSphere};
use asperity_testing::assert_relative;
use std::f64::consts::PI;

use super::quadrature::{derivative, integrate};

fn ellipse() -> Result<HertzEllipse, Error> {
    HertzEllipse::new(0.004, 0.021, 91e9)
}

#[test]
fn equal_radii_make_a_sphere() -> Result<(), Error> {
    let sphere = HertzSphere::new(0.01, 80e9)?;
    let d = 2e-6;
    // Radii that differ by η change everything by O(η); the load only by O(η²) once the
    // sphere has the mean curvature, as here.
    for (eta, tolerance) in [(0.0, 1e-15), (1e-15, 2e-15), (1e-9, 2e-9), (1e-5, 2e-5)] {
        let ellipse = HertzEllipse::new(0.01 * (1.0 + eta), 0.01 / (1.0 + eta), 80e9)?;
        let (along_x, along_y) = ellipse.semi_axes(d);
        let a = sphere.contact_radius(d);
        let r = 0.5 * a;
        for (found, expected) in [
            (along_x, a),
            (along_y, a),
            (ellipse.load(d), sphere.load(d)),
            (ellipse.contact_area(d), sphere.contact_area(d)),
            (ellipse.max_pressure(d), sphere.max_pressure(d)),
            (ellipse.contact_stiffness(d), sphere.contact_stiffness(d)),
            (ellipse.energy(d), sphere.energy(d)),
            (ellipse.pressure(0.6 * r, 0.8 * r, d), sphere.pressure(r, d)),
            (ellipse.approach_at_load(3.0), sphere.approach_at_load(3.0)),
        ] {
            assert_relative!(found, expected, tolerance);
        }
    }
    // To first order b/a = 1 − (2/3)(1 − R_min/R_max), so e² = (4/3) η; the next order is η.
    let ellipse = HertzEllipse::new(1.0, 1.0 - 1e-8, 1.0)?;
    let square = ellipse.eccentricity() * ellipse.eccentricity();
    assert_relative!(square, 4.0 / 3.0 * 1e-8, 2e-8);
    Ok(())
}

/// Across its middle a slender contact is a line contact under the load per length there,
/// (π/2) p0 b.
#[test]
fn a_slender_contact_is_a_line_contact() -> Result<(), Error> {
    let (radius, d) = (0.01, 1e-6);
    for ratio in [1e-6, 1e-9, 1e-12] {
        let ellipse = HertzEllipse::new(radius, radius / ratio, 80e9)?;
        let line = HertzLine::new(radius, 80e9)?;
        let (minor, _) = ellipse.semi_axes(d);
        let per_length = 0.5 * PI * ellipse.max_pressure(d) * minor;
        // The difference is of order (b/a)² ln(a/b), which is about the ratio of radii.
        let tolerance = f64::max(2.0 * ratio, 2e-14);
        assert_relative!(minor, line.half_width(per_length), tolerance);
        let pressure = line.max_pressure(per_length);
        assert_relative!(ellipse.max_pressure(d), pressure, tolerance);
    }
    Ok(())
}

/// Displacement of the pressure at points of the contact, in polar coordinates about each
/// point so that the 1/r of the point load cancels. It ties both radii, the modulus and the
/// approach to the pressure, without elliptic integrals.
#[test]
fn displacement_of_the_pressure_fits_the_paraboloid() -> Result<(), Error> {
    let ellipse = ellipse()?;
    let d = 1.3e-6;
    let (along_x, along_y) = ellipse.semi_axes(d);
    for (u, v) in [(0.0, 0.0), (0.5, 0.0), (0.0, 0.6), (-0.4, 0.7)] {
        let (x, y) = (u * along_x, v * along_y);
        let directions = 400;
        let mut sum = 0.0;
        for i in 0..directions {
            let angle = 2.0 * PI * f64::from(i) / f64::from(directions);
            let (sin, cos) = angle.sin_cos();
            // Distance to the edge: the positive root of qr² + 2hr − c = 0.
            let (du, dv) = (cos / along_x, sin / along_y);
            let (q, h, c) = (du * du + dv * dv, u * du + v * dv, 1.0 - u * u - v * v);
            let edge = ((h * h + q * c).sqrt() - h) / q;
            sum += integrate(|r| ellipse.pressure(x + r * cos, y + r * sin, d), 0.0, edge);
        }
        let found = sum * 2.0 * PI / f64::from(directions) / (PI * ellipse.e_star());
        let profile = 0.5 * x * x / ellipse.radius_x() + 0.5 * y * y / ellipse.radius_y();
        // The sum over directions is exact to rounding. Near the edge the pressure loses digits
        // to 1 − x² − y², which costs 1e-12 over a chord.
        assert_abs_diff_eq!(found / d, (d - profile) / d, epsilon = 1e-11);
    }
    Ok(())
}

#[test]
fn load_is_the_slope_of_energy_and_stiffness_that_of_load() -> Result<(), Error> {
    let ellipse = ellipse()?;
    for d in [1e-9, 1.3e-6, 1e-3] {
        let work = integrate(|x| ellipse.load(x), 0.0, d);
        assert_relative!(work, ellipse.energy(d), 1e-13);
        let slope = derivative(|x| ellipse.load(x), d);
        // Stated error of the difference formula, with a margin of ten.
        assert_relative!(slope, ellipse.contact_stiffness(d), 2e-12);
        let back = ellipse.approach_at_load(ellipse.load(d));
        assert_relative!(back, d, 2e-15);
    }
    Ok(())
}

#[test]
fn swapping_the_radii_turns_the_contact() -> Result<(), Error> {
    let (one, other) = (ellipse()?, HertzEllipse::new(0.021, 0.004, 91e9)?);
    let d = 1e-6;
    let (along_x, along_y) = one.semi_axes(d);
    assert_eq!(other.semi_axes(d), (along_y, along_x));
    assert!(along_x < along_y);
    assert_relative!(one.load(d), other.load(d), 1e-15);
    assert_relative!(
        one.pressure(0.3 * along_x, 0.5 * along_y, d),
        other.pressure(0.5 * along_y, 0.3 * along_x, d),
        1e-15
    );
    Ok(())
}

#[test]
fn no_approach_no_contact() -> Result<(), Error> {
    let ellipse = ellipse()?;
    for d in [0.0, -1e-6] {
        for value in [
            ellipse.semi_axes(d).0,
            ellipse.semi_axes(d).1,
            ellipse.contact_area(d),
            ellipse.load(d),
            ellipse.approach_at_load(d),
            ellipse.max_pressure(d),
            ellipse.contact_stiffness(d),
            ellipse.energy(d),
            ellipse.pressure(0.0, 0.0, d),
        ] {
            assert_eq!(value, 0.0);
        }
    }
    let (along_x, along_y) = ellipse.semi_axes(1e-6);
    assert_eq!(ellipse.pressure(along_x, 0.0, 1e-6), 0.0);
    assert_eq!(ellipse.pressure(0.9 * along_x, -0.9 * along_y, 1e-6), 0.0);
    Ok(())
}

#[test]
fn impossible_paraboloids_are_refused() {
    for (rx, ry, e_star) in [(0.0, 1.0, 1.0), (1.0, f64::NAN, 1.0), (1.0, 1.0, 0.0)] {
        assert!(matches!(HertzEllipse::new(rx, ry, e_star), Err(Error::NotPositive { .. })));
    }
    assert!(matches!(HertzEllipse::new(1e-200, 1e200, 1.0), Err(Error::OutOfRange { .. })));
}
