//! A wave in one direction on a half-space (Westergaard).

use approx::assert_abs_diff_eq;
use asperity::Error;
use asperity::reference::{HertzLine, Westergaard};
use asperity_testing::assert_relative;
use std::f64::consts::PI;

use super::quadrature::{derivative, integrate};

const RATIOS: [f64; 5] = [1e-6, 0.03, 0.5, 0.9, 0.999];

fn wave() -> Result<Westergaard, Error> {
    Westergaard::new(0.8e-6, 70e-6, 110e9)
}

#[test]
fn pressure_averages_to_the_mean_pressure() -> Result<(), Error> {
    let wave = wave()?;
    for ratio in RATIOS {
        let mean = ratio * wave.full_contact_pressure();
        let a = wave.contact_half_width(mean);
        let sum = integrate(|x| wave.pressure(x, mean), -a, a);
        // Accuracy of the quadrature.
        assert_relative!(sum / wave.wavelength(), mean, 1e-12);
        let back = wave.mean_pressure_at_half_width(a);
        // A few rounding errors: where arcsin √P loses digits, sin² is flat and does not miss them.
        assert_relative!(back, mean, 1e-14);
    }
    Ok(())
}

#[test]
fn gap_averages_to_the_mean_gap() -> Result<(), Error> {
    let wave = wave()?;
    for ratio in RATIOS {
        let mean = ratio * wave.full_contact_pressure();
        let a = wave.contact_half_width(mean);
        let sum = integrate(|x| wave.gap(x, mean), a, wave.wavelength() - a);
        let found = sum / wave.wavelength() / wave.amplitude();
        // Rounding of gaps that are differences of heights of order D.
        let expected = wave.mean_gap(mean) / wave.amplitude();
        assert_abs_diff_eq!(found, expected, epsilon = 1e-14);
    }
    Ok(())
}

/// In each harmonic the pressure, the displacement 2 p_n/(E* q_n) and the wave must add up to
/// the gap: the two fields are checked against elasticity, not only against each other.
#[test]
fn harmonics_of_the_gap_are_those_of_the_pressure() -> Result<(), Error> {
    let wave = wave()?;
    let period = wave.wavelength();
    for ratio in RATIOS {
        let mean = ratio * wave.full_contact_pressure();
        let a = wave.contact_half_width(mean);
        for n in 1..8 {
            let q = 2.0 * PI * f64::from(n) / period;
            let pressure =
                2.0 / period * integrate(|x| (q * x).cos() * wave.pressure(x, mean), -a, a);
            let gap =
                2.0 / period * integrate(|x| (q * x).cos() * wave.gap(x, mean), a, period - a);
            let shape = if n == 1 { -wave.amplitude() } else { 0.0 };
            let displacement = 2.0 * pressure / (wave.e_star() * q);
            // Accuracy of the quadrature, in units of D.
            assert_abs_diff_eq!(
                gap / wave.amplitude(),
                (shape + displacement) / wave.amplitude(),
                epsilon = 1e-13
            );
        }
    }
    Ok(())
}

#[test]
fn stiffness_and_energy_follow_from_the_mean_gap() -> Result<(), Error> {
    let wave = wave()?;
    let full = wave.full_contact_pressure();
    for ratio in [0.03, 0.5, 0.9] {
        let mean = ratio * full;
        let compliance = -derivative(|p| wave.mean_gap(p), mean);
        // The rounding of the gap, 1e-16 D, over steps of 1e-3 p*, against D ln(1/P)/p* ≥ 0.1.
        let stiffness = wave.interfacial_stiffness(mean);
        assert_relative!(compliance * stiffness, 1.0, 1e-11);
        let work = integrate(|p| p / wave.interfacial_stiffness(p), 0.0, mean);
        assert_relative!(work, wave.energy(mean), 1e-13);
    }
    let work = integrate(|p| p / wave.interfacial_stiffness(p), 0.0, full);
    assert_relative!(work, wave.energy(full), 1e-13);
    // Complete contact stores half of pressure times displacement of a cosine.
    let cosine = 0.25 * full * wave.amplitude();
    assert_relative!(wave.energy(full), cosine, 1e-15);
    Ok(())
}

/// A light contact is that of a cylinder with the curvature of the crest.
#[test]
fn light_contact_is_hertzian() -> Result<(), Error> {
    let wave = wave()?;
    let q = 2.0 * PI / wave.wavelength();
    let line = HertzLine::new(1.0 / (wave.amplitude() * q * q), wave.e_star())?;
    let mean = 1e-8 * wave.full_contact_pressure();
    let load = mean * wave.wavelength();
    let a = wave.contact_half_width(mean);
    // The difference is of the order of P.
    assert_relative!(a, line.half_width(load), 1e-8);
    let x = 0.6 * a;
    assert_relative!(wave.pressure(x, mean), line.pressure(x, load), 2e-8);
    Ok(())
}

#[test]
fn no_load_leaves_the_wave_as_it_is() -> Result<(), Error> {
    let wave = wave()?;
    let (d, period) = (wave.amplitude(), wave.wavelength());
    for mean in [0.0, -1.0] {
        assert_eq!(wave.contact_half_width(mean), 0.0);
        assert_eq!(wave.contact_area_fraction(mean), 0.0);
        assert_eq!(wave.pressure(0.0, mean), 0.0);
        assert_eq!(wave.mean_gap(mean), d);
        assert_eq!(wave.interfacial_stiffness(mean), 0.0);
        assert_eq!(wave.energy(mean), 0.0);
        assert_eq!(wave.gap(0.0, mean), 0.0);
        for i in 1..8 {
            let x = 0.3 * f64::from(i) * period;
            let initial = d * (1.0 - (2.0 * PI * x / period).cos());
            assert_abs_diff_eq!(wave.gap(x, mean) / d, initial / d, epsilon = 1e-14);
        }
    }
    Ok(())
}

#[test]
fn complete_contact_and_beyond() -> Result<(), Error> {
    let wave = wave()?;
    let (full, period) = (wave.full_contact_pressure(), wave.wavelength());
    for factor in [1.0, 1.5] {
        let mean = factor * full;
        assert_eq!(wave.contact_area_fraction(mean), 1.0);
        assert_eq!(wave.contact_half_width(mean), 0.5 * period);
        assert_eq!(wave.mean_gap(mean), 0.0);
        assert_eq!(wave.interfacial_stiffness(mean), f64::INFINITY);
        assert_eq!(wave.energy(mean), wave.energy(full));
        assert_eq!(wave.gap(0.5 * period, mean), 0.0);
        for x in [0.0, 0.2 * period, 0.5 * period, 7.3 * period] {
            let expected = mean + full * (2.0 * PI * x / period).cos();
            assert_abs_diff_eq!(wave.pressure(x, mean) / full, expected / full, epsilon = 1e-13);
        }
    }
    // Just below, the same to the order of √(1 − P).
    let below = wave.pressure(0.1 * period, full * (1.0 - 1e-12));
    let at = wave.pressure(0.1 * period, full);
    assert_relative!(below, at, 1e-11);
    assert_eq!(wave.mean_pressure_at_half_width(period), full);
    Ok(())
}

#[test]
fn edge_of_the_contact() -> Result<(), Error> {
    let wave = wave()?;
    for ratio in RATIOS {
        let mean = ratio * wave.full_contact_pressure();
        let a = wave.contact_half_width(mean);
        let scale = wave.full_contact_pressure();
        // One rounding of a beside the edge is √ε of pressure, but nothing of the gap.
        assert_abs_diff_eq!(wave.pressure(a, mean) / scale, 0.0, epsilon = 1e-7);
        assert_abs_diff_eq!(wave.gap(a, mean) / wave.amplitude(), 0.0, epsilon = 1e-15);
        assert_eq!(wave.pressure(1.001 * a, mean), 0.0);
        assert!(wave.pressure(0.999 * a, mean) > 0.0);
    }
    Ok(())
}

#[test]
fn impossible_waves_are_refused() {
    for (d, period, e_star) in [(0.0, 1.0, 1.0), (1.0, f64::NAN, 1.0), (1.0, 1.0, -1.0)] {
        assert!(matches!(Westergaard::new(d, period, e_star), Err(Error::NotPositive { .. })));
    }
}
