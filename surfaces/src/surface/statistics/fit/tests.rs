use nalgebra::DMatrix;

use super::*;
use crate::Grid;
use crate::surface::{Amplitude, SelfAffine, Surface, Trend, Window};

/// A surface whose phases alone are random has the density of the law in every wave: the fit finds its numbers to the
/// width of the rings, whatever the seed.
#[test]
fn exact_spectra_are_found() -> Result<(), Error> {
    for (hurst, rolloff, cutoff, seed) in
        [(0.8, 0.25, 0.03, 1), (0.3, 0.125, 0.025, 2), (1.0, 0.4, 0.1, 3)]
    {
        let surface = SelfAffine::new(hurst, rolloff, cutoff, Amplitude::RmsGradient(0.1), seed)?;
        let grid = Grid::with_sides(160, 128, 1.0, 0.9)?;
        let fitted = Topography::sample(&surface, grid)?.fit_self_affine()?;
        let spectrum = surface.spectrum(&grid)?;
        assert!((fitted.hurst.value - hurst).abs() < 2e-3, "{fitted:?}");
        let found = |estimate: Option<Estimate>, expected: f64, tolerance: f64| {
            assert!(
                estimate.is_some_and(|e| (e.value / expected - 1.0).abs() < tolerance),
                "{fitted:?}"
            );
        };
        found(fitted.rolloff_wavelength, rolloff, 3e-3);
        // Within a ring, of 1 %.
        found(fitted.short_cutoff_wavelength, cutoff, 1e-2);
        assert_eq!(fitted.long_cutoff_wavelength, None);
        // The prefactor belongs to ln q = 0, far from the waves.
        let at_cutoff = fitted.prefactor * (TAU / cutoff).powf(-2.0 * (1.0 + fitted.hurst.value));
        assert!((at_cutoff / spectrum.psd(0.999 * TAU / cutoff) - 1.0).abs() < 1e-2);
        assert!(fitted.dispersion < 1e-2);
    }
    Ok(())
}

/// The density of a profile falls with q^(−(1 + 2H)), whatever the width of its cells.
#[test]
fn profiles_have_the_exponent_of_their_surface() -> Result<(), Error> {
    for (hurst, width) in [(0.2, 1.0), (0.6, 1e-3), (0.9, 40.0)] {
        let row = SelfAffine::new(hurst, 0.2, 1.0 / 200.0, Amplitude::RmsHeight(1e-6), 5)?;
        for grid in [Grid::new(512, 1, 1.0 / 512.0, width)?, Grid::new(1, 512, width, 1.0 / 512.0)?]
        {
            let fitted = Topography::sample(&row, grid)?.fit_self_affine()?;
            assert!((fitted.hurst.value - hurst).abs() < 1e-3, "{fitted:?}");
            let at_cutoff = fitted.prefactor * (TAU * 200.0).powf(-1.0 - 2.0 * hurst);
            let spectrum = row.spectrum(&grid)?;
            let expected = spectrum.psd(0.999 * TAU * 200.0);
            assert!((at_cutoff / expected - 1.0).abs() < 3e-2, "{fitted:?}");
            // From the prefactor the same surface, to rounding.
            let amplitude = Amplitude::Prefactor(spectrum.prefactor());
            let again = SelfAffine::new(hurst, 0.2, 1.0 / 200.0, amplitude, 5)?.spectrum(&grid)?;
            assert!((again.rms_height() / 1e-6 - 1.0).abs() < 1e-13, "{again:?}");
        }
    }
    Ok(())
}

#[test]
fn spectra_without_rolloff_and_with_a_long_cutoff() -> Result<(), Error> {
    let grid = Grid::square(128, 1.0)?;
    let straight = SelfAffine::new(0.6, 1.0, 1.0 / 64.0, Amplitude::RmsHeight(1e-6), 4)?;
    let fitted = Topography::sample(&straight, grid)?.fit_self_affine()?;
    assert_eq!((fitted.rolloff_wavelength, fitted.short_cutoff_wavelength), (None, None));
    assert!((fitted.hurst.value - 0.6).abs() < 1e-3, "{fitted:?}");
    let band = SelfAffine::new(0.6, 0.1, 0.03, Amplitude::RmsHeight(1e-6), 4)?
        .with_long_cutoff_wavelength(0.21)?;
    let fitted = Topography::sample(&band, grid)?.fit_self_affine()?;
    let long = fitted.long_cutoff_wavelength;
    // Between the waves (4, 2) and (4, 3), of length 0.224 and 0.2.
    assert!(long.is_some_and(|long| (0.2..0.224).contains(&long.value)), "{fitted:?}");
    assert!(fitted.rolloff_wavelength.is_some_and(|r| (r.value / 0.1 - 1.0).abs() < 5e-3));
    Ok(())
}

/// A Gaussian surface: the sum of so many with random phases that its amplitudes are random too, but for a sixteenth
/// of their variance.
fn gaussian(
    parts: u64,
    number: u64,
    [hurst, rolloff, cutoff]: [f64; 3],
    grid: &Grid,
) -> Result<Topography, Error> {
    let mut sum = DMatrix::zeros(grid.nx(), grid.ny());
    for part in 0..parts {
        let seed = parts * number + part;
        sum += SelfAffine::new(hurst, rolloff, cutoff, Amplitude::RmsHeight(1.0), seed)?
            .heights(grid)?;
    }
    Topography::new(*grid, sum)
}

/// A cut-off is anywhere between two rings.
#[test]
fn cutoffs_lie_between_two_rings() {
    let [long, short] =
        [3.0, 1.0].map(|length| SpectralBin { wavevector: TAU / length, density: 1.0, waves: 1 });
    let found = place_between(&long, &short);
    assert!((found.value - 2.0).abs() < 1e-15, "{found:?}");
    // The variance of a uniform distribution is 1/12 of the square of its width.
    assert!((12.0 * found.standard_error.powi(2) - 4.0).abs() < 1e-14, "{found:?}");
}

/// Standard errors are what they are called: 68 of 100 estimates lie within one of the truth, and the mean error is
/// none.
#[test]
fn standard_errors_cover() -> Result<(), Error> {
    let grid = Grid::square(80, 1.0)?;
    let surfaces = 150_u32;
    let mut hurst = (0_u32, 0.0);
    let (mut of_profiles, mut rolloff) = (hurst, hurst);
    // Without a roll-off: a plateau of the few waves that a profile has is not always seen.
    let row = Grid::new(512, 1, 1.0 / 512.0, 1.0)?;
    for number in 0..surfaces {
        let fitted = gaussian(16, u64::from(number), [0.7, 0.2, 0.04], &grid)?.fit_self_affine()?;
        let count = |estimate: Estimate, truth: f64, (covered, sum): (u32, f64)| {
            let error = (estimate.value - truth) / estimate.standard_error;
            (covered + u32::from(error.abs() < 1.0), sum + error)
        };
        hurst = count(fitted.hurst, 0.7, hurst);
        let profile =
            gaussian(16, u64::from(number), [0.7, 1.0, 0.005], &row)?.fit_self_affine()?;
        of_profiles = count(profile.hurst, 0.7, of_profiles);
        let found = fitted.rolloff_wavelength.ok_or(Error::TooFewWaves { found: 0, needed: 1 })?;
        rolloff = count(found, 0.2, rolloff);
        let cutoff = fitted.short_cutoff_wavelength;
        assert!(cutoff.is_some_and(|c| (c.value / 0.04 - 1.0).abs() < 0.03), "{fitted:?}");
        // χ² of some 100 rings, over their number.
        assert!((fitted.dispersion - 1.0).abs() < 0.7, "{fitted:?}");
    }
    for (name, (covered, sum)) in [("H", hurst), ("H of profiles", of_profiles), ("λ_r", rolloff)]
    {
        let share = f64::from(covered) / f64::from(surfaces);
        let mean = sum / f64::from(surfaces);
        // A share of 0.68 of 150 has a standard deviation of 0.038: three of them, and what small numbers of waves do
        // to errors of first order.
        assert!((share - 0.68).abs() < 0.15, "{name} {share}");
        // In standard errors; of 150, their mean has a standard deviation of 0.08.
        assert!(mean.abs() < 0.4, "{name} {mean}");
    }
    Ok(())
}

/// In units of their standard errors, errors of H have a mean square of 1: of surfaces with random amplitudes and with
/// random phases alone, and with a window, which makes waves depend on each other.
#[test]
fn standard_errors_are_those_of_many_surfaces() -> Result<(), Error> {
    let grid = Grid::square(80, 1.0)?;
    for (parts, window) in [
        (16, None),
        (16, Some(Window::Tukey(0.5))),
        (16, Some(Window::Hann)),
        (1, Some(Window::Hann)),
    ] {
        let mut squares = Vec::new();
        for hurst in [0.3, 0.6, 0.9] {
            for number in 0..50 {
                let surface = gaussian(parts, number, [hurst, 0.2, 0.04], &grid)?;
                let surface = match window {
                    // It repeats as it is.
                    None => surface,
                    Some(window) => surface.level(Trend::Plane)?.window(window)?,
                };
                let found = surface.fit_self_affine()?.hurst;
                squares.push(((found.value - hurst) / found.standard_error).powi(2));
            }
        }
        let mean = squares.iter().sum::<f64>() / squares.len() as f64;
        // Of 150 normal errors it has a standard deviation of 0.12.
        assert!((0.64..1.44).contains(&mean), "{mean} with {window:?} and {parts}");
    }
    Ok(())
}

/// A piece of a larger surface, which is not periodic: the window makes its exponent appear.
#[test]
fn a_window_shows_the_exponent_of_a_piece() -> Result<(), Error> {
    let surface = SelfAffine::new(0.8, 0.1, 1.0 / 128.0, Amplitude::RmsHeight(1.0), 9)?;
    let whole = Topography::sample(&surface, Grid::square(256, 1.0)?)?;
    let fitted = whole.crop(30..158, 50..178)?.window(Window::Hann)?.fit_self_affine()?;
    assert!((fitted.hurst.value - 0.8).abs() < 2.0 * fitted.hurst.standard_error, "{fitted:?}");
    Ok(())
}

#[test]
fn maps_without_waves_are_refused() -> Result<(), Error> {
    for (nx, ny) in [(1, 1), (40, 40), (3, 3), (1, 9)] {
        let flat = Topography::new(Grid::new(nx, ny, 1.0, 1.0)?, DMatrix::zeros(nx, ny))?;
        assert!(matches!(flat.fit_self_affine(), Err(Error::TooFewWaves { .. })));
    }
    let noise = DMatrix::from_fn(4, 4, |ix, iy| ((ix + 4 * iy) as f64 * 0.618).fract());
    let small = Topography::new(Grid::square(4, 1.0)?, noise)?.fit_self_affine();
    assert!(matches!(small, Err(Error::TooFewWaves { needed: 8, .. })), "{small:?}");
    Ok(())
}
