//! A wave in two directions on a half-space (Johnson, Greenwood & Higginson).

use approx::assert_abs_diff_eq;
use asperity::Error;
use asperity::reference::{DoubleWave, HertzSphere};
use asperity_testing::assert_relative;
use std::f64::consts::PI;
use std::f64::consts::SQRT_2;

use super::quadrature::integrate;

fn wave() -> Result<DoubleWave, Error> {
    DoubleWave::new(0.5e-6, 40e-6, 90e9)
}

#[test]
fn light_contact_is_hertz_on_every_crest() -> Result<(), Error> {
    let wave = wave()?;
    let q = 2.0 * PI / wave.wavelength();
    let crest = HertzSphere::new(1.0 / (wave.amplitude() * q * q), wave.e_star())?;
    let cell = wave.wavelength() * wave.wavelength();
    for ratio in [1e-9, 1e-3, 0.1] {
        let mean = ratio * wave.full_contact_pressure();
        let approach = crest.approach_at_load(0.5 * mean * cell);
        let expected = 2.0 * crest.contact_area(approach) / cell;
        let found = wave.contact_area_fraction_light(mean);
        // Both are the same expression: rounding only.
        assert_relative!(found, expected, 1e-14);
    }
    Ok(())
}

/// Without a crack the valleys would carry the tension T(r) = p*(1 − P) − ½ p* q² r². The
/// stress intensity of a penny crack under it, ∝ ∫ T r/√(b² − r²) dr, must vanish.
#[test]
fn heavy_contact_leaves_no_stress_intensity() -> Result<(), Error> {
    let wave = wave()?;
    let q = 2.0 * PI / wave.wavelength();
    let full = wave.full_contact_pressure();
    let cell = wave.wavelength() * wave.wavelength();
    for ratio in [0.9, 0.999] {
        let open = 1.0 - wave.contact_area_fraction_heavy(ratio * full);
        let b = (0.5 * open * cell / PI).sqrt();
        // r = b sin t takes the root away.
        let intensity = |t: f64| {
            let r = b * t.sin();
            ((1.0 - ratio) - 0.5 * q * q * r * r) * r
        };
        let found = integrate(intensity, 0.0, 0.5 * PI) / ((1.0 - ratio) * b);
        // 1 − P has lost three digits, the quadrature nothing to speak of.
        assert_abs_diff_eq!(found, 0.0, epsilon = 1e-12);
    }
    Ok(())
}

/// Complete contact flattens the harmonics (±q, ±q), of wave number √2 q, under the pressure
/// ½ E* |q| times the height; the valley is then just free of pressure.
#[test]
fn full_contact_pressure_flattens_the_wave() -> Result<(), Error> {
    let wave = wave()?;
    let wave_number = SQRT_2 * 2.0 * PI / wave.wavelength();
    let valley = 0.5 * wave.e_star() * wave_number * wave.amplitude();
    assert_relative!(wave.full_contact_pressure(), valley, 1e-15);
    Ok(())
}

#[test]
fn ends_of_the_range() -> Result<(), Error> {
    let wave = wave()?;
    let full = wave.full_contact_pressure();
    for mean in [0.0, -1.0] {
        assert_eq!(wave.contact_area_fraction_light(mean), 0.0);
    }
    for mean in [full, 2.0 * full] {
        assert_eq!(wave.contact_area_fraction_heavy(mean), 1.0);
    }
    assert!(wave.contact_area_fraction_heavy(f64::NAN).is_nan());
    Ok(())
}

#[test]
fn impossible_waves_are_refused() {
    for (d, period, e_star) in [(0.0, 1.0, 1.0), (1.0, f64::NAN, 1.0), (1.0, 1.0, -1.0)] {
        assert!(matches!(DoubleWave::new(d, period, e_star), Err(Error::NotPositive { .. })));
    }
}
