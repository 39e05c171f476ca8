//! How the contact area of a rough surface grows with the load.

use asperity::Error;
use asperity::reference::AreaLoadLaw;
use asperity_testing::assert_relative;
use std::f64::consts::PI;

use super::quadrature::integrate;

fn law() -> Result<AreaLoadLaw, Error> {
    AreaLoadLaw::new(0.2, 50e9)
}

/// The integral of the density over p > 0 is the area, and its first moment the load: two closed forms that the
/// density does not use.
#[test]
fn perssons_area_is_that_of_his_pressure_distribution() -> Result<(), Error> {
    let law = law()?;
    for mean in [1e3, 1e7, 1e9, 2e10] {
        let density = |p: f64| law.persson_density(p, mean);
        let far = mean + 12.0 * law.full_contact_deviation();
        // The quadrature has a few hundred terms of rounding.
        assert_relative!(integrate(density, 0.0, far), law.persson(mean), 1e-12);
        let load = integrate(|p| p * density(p), 0.0, far);
        assert_relative!(load, mean, 1e-12);
    }
    Ok(())
}

/// Against the difference of two Gaussians as it is written, which loses digits by cancellation: where the
/// smaller is below half of the larger, no more than a factor of three.
#[test]
fn perssons_density_is_a_gaussian_less_its_image() -> Result<(), Error> {
    let law = law()?;
    let deviation = law.full_contact_deviation();
    for mean in [0.5, 1.0, 3.0] {
        for p in [0.7, 1.0, 2.0, 5.0] {
            let gauss = |z: f64| (-0.5 * z * z).exp() / (2.0 * PI).sqrt() / deviation;
            let expected = gauss(p - mean) - gauss(p + mean);
            let found = law.persson_density(p * deviation, mean * deviation);
            // Arguments of up to 32 in the exponential carry as many rounding errors.
            assert_relative!(found, expected, 1e-13);
        }
    }
    assert_eq!(law.persson_density(0.0, 1e9), 0.0);
    assert_eq!(law.persson_density(-1.0, 1e9), 0.0);
    assert_eq!(law.persson_density(1e9, 0.0), 0.0);
    assert_eq!(law.persson_density(1e9, -1.0), 0.0);
    assert!(law.persson_density(1e9, f64::NAN).is_nan());
    assert!(law.persson_density(f64::NAN, 1e9).is_nan());
    Ok(())
}

#[test]
fn perssons_curve_starts_along_his_line_and_ends_at_one() -> Result<(), Error> {
    let law = law()?;
    // erf x departs from its tangent by x²/3, here 7e-13.
    let light = 1e4;
    let line = law.proportional(AreaLoadLaw::PERSSON, light);
    assert_relative!(law.persson(light), line, 1e-12);
    for mean in [1e8, 1e9, 1e10] {
        assert!(law.persson(mean) < law.proportional(AreaLoadLaw::PERSSON, mean));
    }
    assert_eq!(law.persson(1e12), 1.0);
    assert_eq!(law.proportional(AreaLoadLaw::HYUN, 1e12), 1.0);
    Ok(())
}

#[test]
fn slopes_are_what_their_formulas_say() {
    // The constants are rounded once, the roots of a rounded π twice.
    assert_relative!(AreaLoadLaw::BUSH_GIBSON_THOMAS, (2.0 * PI).sqrt(), 4e-16);
    assert_relative!(AreaLoadLaw::PERSSON, (8.0 / PI).sqrt(), 4e-16);
    // The asperity theory gives π/2 times the area of Persson's.
    assert_relative!(AreaLoadLaw::BUSH_GIBSON_THOMAS / AreaLoadLaw::PERSSON, 0.5 * PI, 1e-15);
}

#[test]
fn no_load_no_contact() -> Result<(), Error> {
    let law = law()?;
    for mean in [0.0, -1.0] {
        assert_eq!(law.persson(mean), 0.0);
        assert_eq!(law.proportional(AreaLoadLaw::HYUN, mean), 0.0);
    }
    assert!(law.persson(f64::NAN).is_nan());
    Ok(())
}

/// Gradient and modulus are kept, and not exchanged.
#[test]
fn a_law_says_what_it_is_for() -> Result<(), Error> {
    let law = law()?;
    assert_eq!((law.rms_gradient(), law.e_star()), (0.2, 50e9));
    Ok(())
}

#[test]
fn impossible_surfaces_are_refused() {
    for (gradient, e_star) in [(0.0, 1.0), (1.0, f64::NAN)] {
        assert!(matches!(AreaLoadLaw::new(gradient, e_star), Err(Error::NotPositive { .. })));
    }
}
