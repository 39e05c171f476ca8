//! Cylinder on a half-space (Hertz).

use asperity::Error;
use asperity::reference::HertzLine;
use asperity_testing::assert_relative;
use std::f64::consts::PI;

use super::quadrature::integrate;

const LOADS: [f64; 3] = [1e-3, 250.0, 4e6];

fn line() -> Result<HertzLine, Error> {
    HertzLine::new(0.02, 115e9)
}

#[test]
fn pressure_adds_up_to_the_load() -> Result<(), Error> {
    let line = line()?;
    for load in LOADS {
        let a = line.half_width(load);
        let sum = integrate(|x| line.pressure(x, load), -a, a);
        // Accuracy of the quadrature.
        assert_relative!(sum, load, 1e-12);
        let mean = load / (2.0 * a);
        assert_relative!(mean, line.mean_pressure(load), 1e-14);
        assert_relative!(line.load_at_half_width(a), load, 1e-14);
        assert_eq!(line.pressure(0.0, load), line.max_pressure(load));
        assert_eq!(line.pressure(a, load), 0.0);
        assert_eq!(line.pressure(2.0 * a, load), 0.0);
    }
    Ok(())
}

/// Relative to the centre, the line loads −(2/πE*) p ln|x − s| must bend the surface to the
/// cylinder inside the contact and leave it clear of the cylinder outside.
#[test]
fn displacement_of_the_pressure_fits_the_cylinder() -> Result<(), Error> {
    let line = line()?;
    let load = 250.0;
    let a = line.half_width(load);
    let logarithmic = |x: f64| {
        // Both sides from x, so that the singular point is an end of the quadrature.
        let left = |t: f64| line.pressure(x - t, load) * (t / a).ln();
        let right = |t: f64| line.pressure(x + t, load) * (t / a).ln();
        let near = (x - a).max(0.0);
        let sum = integrate(left, near, x + a) + integrate(right, 0.0, (a - x).max(0.0));
        -2.0 / (PI * line.e_star()) * sum
    };
    let center = logarithmic(0.0);
    let depth = 0.5 * a * a / line.radius();
    for ratio in [0.1, 0.5, 0.9, 1.0] {
        let bent = logarithmic(ratio * a) - center;
        // Accuracy of the quadrature, in units of the depth of the contact.
        assert_relative!(bent / depth, -ratio * ratio, 1e-11);
    }
    for ratio in [1.1, 2.0, 10.0] {
        let bent = logarithmic(ratio * a) - center;
        assert!(bent / depth > -ratio * ratio);
    }
    Ok(())
}

#[test]
fn no_load_no_contact() -> Result<(), Error> {
    let line = line()?;
    for load in [0.0, -1.0] {
        for value in [
            line.half_width(load),
            line.load_at_half_width(load),
            line.max_pressure(load),
            line.mean_pressure(load),
            line.pressure(0.0, load),
        ] {
            assert_eq!(value, 0.0);
        }
    }
    Ok(())
}

#[test]
fn impossible_cylinders_are_refused() {
    for (radius, e_star) in [(0.0, 1.0), (1.0, f64::NAN)] {
        assert!(matches!(HertzLine::new(radius, e_star), Err(Error::NotPositive { .. })));
    }
}
