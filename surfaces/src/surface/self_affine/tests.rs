use std::f64::consts::TAU;

use proptest::prelude::*;

use super::*;
use crate::surface::{HeightMap, Topography};

/// FNV-1a of the bits, to pin them.
fn fingerprint(heights: &DMatrix<f64>) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for byte in heights.iter().flat_map(|z| z.to_bits().to_le_bytes()) {
        hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    }
    hash
}

/// If this test fails, a change made every surface anybody has published from a seed come out
/// different: undo it, or say so in the changelog.
#[test]
fn heights_are_pinned_bit_for_bit() -> Result<(), Error> {
    let table = SelfAffine::zhang2020(2020).heights(&Grid::square(256, 1e-2)?)?;
    let odd = SelfAffine::new(0.5, 0.3, 0.06, Amplitude::RmsGradient(0.1), u64::MAX)?
        .with_long_cutoff_wavelength(0.7)?
        .heights(&Grid::with_sides(75, 98, 1.0, 1.3)?)?;
    assert_eq!(fingerprint(&table), 0x5780_49eb_cbc3_084d);
    assert_eq!(fingerprint(&odd), 0xfeaf_9559_ca9b_6e1d);
    Ok(())
}

/// The numbers of the paper's Table 1, and of a surface with a long cut-off.
#[test]
fn surfaces_say_what_they_were_made_of() -> Result<(), Error> {
    let paper = SelfAffine::zhang2020(7);
    assert_eq!((paper.hurst(), paper.seed()), (0.8, 7));
    assert_eq!(paper.rolloff_wavelength(), 2.5e-3);
    assert_eq!(paper.short_cutoff_wavelength(), 78.125e-6);
    assert_eq!(paper.long_cutoff_wavelength(), None);
    assert_eq!(paper.amplitude(), Amplitude::RmsHeight(50e-6));
    let cut = paper.with_long_cutoff_wavelength(5e-3)?;
    assert_eq!(cut.long_cutoff_wavelength(), Some(5e-3));
    assert_eq!(cut.rolloff_wavelength(), 2.5e-3);
    Ok(())
}

#[test]
fn table_1_has_the_gradient_that_follows_from_it() -> Result<(), Error> {
    let spectrum = SelfAffine::zhang2020(1).spectrum(&Grid::square(256, 1e-2)?)?;
    // 0.3314 was computed independently, to the digits given.
    assert!((spectrum.rms_gradient() - 0.3314).abs() < 5e-5);
    // Rounding of a sum of 26 000 waves.
    assert!((spectrum.rms_height() / 50e-6 - 1.0).abs() < 1e-13);
    Ok(())
}

#[test]
fn realised_moments_are_the_prescribed_ones() -> Result<(), Error> {
    for (nx, ny) in [(64, 64), (48, 81), (61, 97), (128, 1), (1, 75), (256, 32), (64, 81), (75, 70)]
    {
        let grid = Grid::with_sides(nx, ny, 1e-5 * nx as f64, 1.5e-5 * ny as f64)?;
        for (amplitude, seed) in [
            (Amplitude::RmsHeight(2e-6), 3),
            (Amplitude::RmsGradient(0.2), 4),
            (Amplitude::Prefactor(1e-7), 5),
        ] {
            let surface = SelfAffine::new(0.8, 2e-4, 3e-5, amplitude, seed)?;
            let spectrum = surface.spectrum(&grid)?;
            let topography = Topography::sample(&surface, grid)?;
            let (map, moments) = (topography.map(), topography.spectral_moments());
            // Parseval: only rounding of sums over at most 8000 waves and of two transforms.
            let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
            close(map.rms_height(), spectrum.rms_height());
            close(moments.rms_height(), spectrum.rms_height());
            close(moments.rms_gradient(), spectrum.rms_gradient());
            close(moments.rms_laplacian(), spectrum.rms_laplacian());
            close(moments.nayak_parameter(), spectrum.nayak_parameter());
            match amplitude {
                Amplitude::RmsHeight(prescribed) => close(map.rms_height(), prescribed),
                Amplitude::RmsGradient(prescribed) => close(moments.rms_gradient(), prescribed),
                Amplitude::Prefactor(prescribed) => close(spectrum.prefactor(), prescribed),
            }
            // The mean is a sum of cancelling heights.
            assert!(map.mean_height().abs() < 1e-14 * map.rms_height());
        }
    }
    Ok(())
}

/// The cut-off of Table 1 is the Nyquist wavelength of a 256 × 256 grid: both waves are inside.
#[test]
fn a_cutoff_at_two_cells_is_inside_however_it_is_rounded() -> Result<(), Error> {
    for n in [6, 10, 14, 96, 100, 256] {
        for side in [1e-2, 0.1, 0.3, 7.7e-3, 1.0 / 3.0] {
            let grid = Grid::square(n, side)?;
            for cutoff in [2.0 * side / n as f64, 2.0 * grid.dx(), side / (n / 2) as f64] {
                let amplitude = Amplitude::RmsHeight(1.0);
                let at = SelfAffine::new(0.8, side, cutoff, amplitude, 1)?;
                let longer = SelfAffine::new(0.8, side, cutoff * (1.0 + 1e-9), amplitude, 1)?;
                let shorter = SelfAffine::new(0.8, side, cutoff * (1.0 - 1e-9), amplitude, 1)?;
                let heights = at.heights(&grid)?;
                // Σ h (−1)^ix / nodes, the amplitude of the wave with two nodes along x.
                let nyquist = |h: &DMatrix<f64>| {
                    let sum: f64 = h.row_iter().enumerate().fold(0.0, |sum, (ix, row)| {
                        sum + if ix % 2 == 0 { row.sum() } else { -row.sum() }
                    });
                    (sum / grid.nodes() as f64).abs()
                };
                let spectrum = at.spectrum(&grid)?;
                let amplitude = TAU * (spectrum.psd(TAU / cutoff) / grid.nominal_area()).sqrt();
                // Rounding of heights of order 1.
                assert!((nyquist(&heights) - amplitude).abs() < 1e-14, "{n} {side}");
                assert!(nyquist(&longer.heights(&grid)?) < 1e-14, "{n} {side}");
                assert!(matches!(shorter.heights(&grid), Err(Error::CutoffBelowGrid { .. })));
            }
        }
    }
    Ok(())
}

/// Sum of the waves at a point, straight from the documented definition.
fn direct(surface: &SelfAffine, grid: &Grid, x: f64, y: f64) -> Result<f64, Error> {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};
    let spectrum = surface.spectrum(grid)?;
    let (lx, ly) = grid.sides();
    let mut key = [0; 32];
    key[..8].copy_from_slice(&surface.seed().to_le_bytes());
    let mut height = 0.0;
    for m in 0_i64..=64 {
        for n in -64_i64..=64 {
            if m == 0 && n <= 0 {
                continue;
            }
            let (qx, qy) = (TAU * m as f64 / lx, TAU * n as f64 / ly);
            let amplitude = TAU * (spectrum.psd(qx.hypot(qy)) / grid.nominal_area()).sqrt();
            let mut generator = ChaCha8Rng::from_seed(key);
            generator.set_stream(m as u64);
            let k = if n >= 0 { 2 * n } else { -2 * n - 1 };
            generator.set_word_pos(2 * k as u128);
            let phase = TAU * (generator.next_u64() >> 11) as f64 * 2.0_f64.powi(-53);
            // The wave and its conjugate.
            height += 2.0 * amplitude * (qx * x + qy * y + phase).cos();
        }
    }
    Ok(height)
}

#[test]
fn heights_are_the_documented_sum_at_the_positions_of_the_nodes() -> Result<(), Error> {
    let surface = SelfAffine::new(0.8, 0.4, 0.11, Amplitude::RmsHeight(1.0), 99)?
        .with_long_cutoff_wavelength(1.0)?;
    for (nx, ny) in [(24, 30), (25, 37), (30, 64)] {
        let grid = Grid::with_sides(nx, ny, 1.0, 1.5)?;
        let heights = surface.heights(&grid)?;
        for node in (0..grid.nodes()).step_by(29) {
            let (ix, iy) = grid.coordinates(node);
            let (x, y) = grid.position(ix, iy);
            let expected = direct(&surface, &grid, x, y)?;
            // Some 200 waves with angles of up to 150, each rounded to 2e-14.
            assert!((heights[(ix, iy)] - expected).abs() < 1e-12);
        }
    }
    Ok(())
}

/// Nodes are cell centres: tripling the grid keeps every node, and node i becomes node 3i + 1.
#[test]
fn refinement_keeps_the_surface() -> Result<(), Error> {
    let surface = SelfAffine::new(0.8, 2.5e-3, 2e-4, Amplitude::RmsHeight(50e-6), 7)?;
    let coarse = surface.heights(&Grid::square(128, 1e-2)?)?;
    let fine = surface.heights(&Grid::square(384, 1e-2)?)?;
    for ix in 0..128 {
        for iy in 0..128 {
            let difference = coarse[(ix, iy)] - fine[(3 * ix + 1, 3 * iy + 1)];
            // Two transforms of 8000 waves round differently.
            assert!(difference.abs() < 1e-12 * 50e-6);
        }
    }
    Ok(())
}

/// Doubling shares no node, but a band-limited surface is known between nodes: interpolate the
/// coarse grid with all its waves and compare.
#[test]
fn doubling_keeps_the_surface() -> Result<(), Error> {
    let surface = SelfAffine::new(0.8, 0.5, 0.05, Amplitude::RmsHeight(1.0), 11)?;
    let coarse = Grid::square(128, 1.0)?;
    let fine = Grid::square(256, 1.0)?;
    let heights = surface.heights(&fine)?;
    for node in (0..fine.nodes()).step_by(4999) {
        let (ix, iy) = fine.coordinates(node);
        let (x, y) = fine.position(ix, iy);
        // 650 waves with angles of up to 180, each rounded to 2e-14.
        assert!((heights[(ix, iy)] - direct(&surface, &coarse, x, y)?).abs() < 1e-12);
    }
    Ok(())
}

#[test]
fn seeds_differ() -> Result<(), Error> {
    let grid = Grid::square(32, 1.0)?;
    let heights =
        |seed| SelfAffine::new(0.8, 0.5, 0.1, Amplitude::RmsHeight(1.0), seed)?.heights(&grid);
    let one = heights(1)?;
    assert_eq!(one, heights(1)?);
    for seed in [0, 2, 1 << 32, u64::MAX] {
        // Independent surfaces of rms 1 differ by about 1.4 rms.
        assert!((&one - heights(seed)?).norm() / 32.0 > 1.0);
    }
    Ok(())
}

#[test]
fn bad_parameters_are_refused() {
    let unit = Amplitude::RmsHeight(1.0);
    for hurst in [0.0, -0.1, 1.0 + 1e-9, f64::NAN, f64::INFINITY] {
        assert!(matches!(SelfAffine::new(hurst, 1.0, 0.1, unit, 0), Err(Error::OutOfRange { .. })));
    }
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for surface in [
            SelfAffine::new(0.8, bad, 0.1, unit, 0),
            SelfAffine::new(0.8, 1.0, bad, unit, 0),
            SelfAffine::new(0.8, 1.0, 0.1, Amplitude::RmsHeight(bad), 0),
            SelfAffine::new(0.8, 1.0, 0.1, Amplitude::RmsGradient(bad), 0),
            SelfAffine::new(0.8, 1.0, 0.1, Amplitude::Prefactor(bad), 0),
            SelfAffine::zhang2020(0).with_long_cutoff_wavelength(bad),
        ] {
            assert!(matches!(surface, Err(Error::NotPositive { .. })));
        }
    }
    assert!(matches!(SelfAffine::new(0.8, 1.0, 1.1, unit, 0), Err(Error::OutOfRange { .. })));
    assert!(matches!(
        SelfAffine::zhang2020(0).with_long_cutoff_wavelength(2.4e-3),
        Err(Error::OutOfRange { .. })
    ));
}

#[test]
fn grids_that_cannot_carry_the_surface_are_refused() -> Result<(), Error> {
    let table = SelfAffine::zhang2020(0);
    assert!(matches!(table.heights(&Grid::square(255, 1e-2)?), Err(Error::CutoffBelowGrid { .. })));
    assert!(table.heights(&Grid::with_sides(256, 1, 1e-2, 1.0)?).is_ok());
    // Too small for any wave in the band.
    assert!(matches!(table.heights(&Grid::square(64, 5e-5)?), Err(Error::NoWaves { .. })));
    assert!(matches!(table.heights(&Grid::square(1, 1.0)?), Err(Error::NoWaves { .. })));
    // Between the waves of 1/9 and 1/8 of the side.
    let narrow = SelfAffine::new(0.8, 0.12, 0.113, Amplitude::RmsHeight(1.0), 0)?
        .with_long_cutoff_wavelength(0.12)?;
    assert!(matches!(
        narrow.heights(&Grid::with_sides(100, 1, 1.0, 1.0)?),
        Err(Error::NoWaves { .. })
    ));
    Ok(())
}

proptest! {
    /// Whatever the numbers, the answer is a finite surface with the right moments or an error.
    #[test]
    fn any_input_gives_a_surface_or_an_error(
        hurst in 0.01_f64..=1.0,
        exponents in (-320.0_f64..300.0, -12.0_f64..1.0, -320.0_f64..300.0),
        nodes in (1_usize..24, 1_usize..24),
        seed in any::<u64>(),
    ) {
        let cell = 10_f64.powf(exponents.0);
        let rolloff = cell * 10_f64.powf(1.5 - exponents.1);
        let amplitude = Amplitude::RmsHeight(10_f64.powf(exponents.2));
        let made = Grid::new(nodes.0, nodes.1, cell, 0.7 * cell).and_then(|grid| {
            let surface = SelfAffine::new(hurst, rolloff, 2.5 * cell, amplitude, seed)?;
            Ok((surface.spectrum(&grid)?, HeightMap::sample(&surface, &grid)?))
        });
        if let Ok((spectrum, map)) = made {
            let peak = map.max_height().max(-map.min_height());
            prop_assert!(peak.is_finite());
            // Squares of heights outside this range leave that of numbers.
            if (1e-140..1e140).contains(&peak) {
                // Sums over at most 575 waves.
                prop_assert!((map.rms_height() / spectrum.rms_height() - 1.0).abs() < 1e-12);
            }
        }
    }
}
