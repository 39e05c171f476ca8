use std::f64::consts::TAU;

use nalgebra::DMatrix;

use super::*;
use crate::surface::fourier::tests::noise;
use crate::surface::{Amplitude, Axis, SelfAffine, Topography};
use crate::{Error, Grid};

/// A wave a cos(q·x + 0.3) with wave numbers (kx, ky), and its wavevector.
fn wave(grid: Grid, k: (i32, i32), a: f64) -> Result<(Topography, (f64, f64)), Error> {
    let (lx, ly) = grid.sides();
    let q = (TAU * f64::from(k.0) / lx, TAU * f64::from(k.1) / ly);
    let (nx, ny) = grid.shape();
    let heights = DMatrix::from_fn(nx, ny, |ix, iy| {
        let (x, y) = grid.position(ix, iy);
        5.0 * a + a * (q.0 * x + q.1 * y + 0.3).cos()
    });
    Ok((Topography::new(grid, heights)?, q))
}

/// Relative, for sums of a few thousand squares and angles of up to 100.
pub(super) fn close(found: f64, expected: f64) {
    assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
}

#[test]
fn moments_of_a_plane_wave() -> Result<(), Error> {
    let a = 2e-6;
    for (nx, ny, k) in
        [(40, 30, (3, -5)), (41, 33, (0, 7)), (35, 48, (17, 1)), (64, 1, (9, 0)), (1, 50, (0, 11))]
    {
        let (map, (qx, qy)) = wave(Grid::new(nx, ny, 1e-5, 1.5e-5)?, k, a)?;
        let m = map.spectral_moments();
        let half = 0.5 * a * a;
        let q2 = qx * qx + qy * qy;
        close(m.m0(), half);
        close(m.rms_height(), map.map().rms_height());
        // The smallest sums are rounded like the greatest.
        for (found, factor, greatest) in [
            (m.m20(), qx * qx, q2),
            (m.m02(), qy * qy, q2),
            (m.m40(), qx.powi(4), q2 * q2),
            (m.m22(), (qx * qy).powi(2), q2 * q2),
            (m.m04(), qy.powi(4), q2 * q2),
        ] {
            assert!((found - half * factor).abs() < 1e-11 * half * greatest, "{nx} {ny}");
        }
        close(m.m2(), 0.5 * half * q2);
        close(m.m4(), 0.375 * half * q2 * q2);
        close(m.rms_gradient(), (half * q2).sqrt());
        close(m.rms_gradient(), map.rms_gradient_spectral());
        close(m.rms_laplacian(), half.sqrt() * q2);
        close(m.rms_curvature(), 0.5 * half.sqrt() * q2);
        close(m.nayak_parameter(), 1.5);
        close(m.rms_full_contact_pressure(7e9), 3.5e9 * (half * q2).sqrt());
    }
    Ok(())
}

#[test]
fn a_flat_map_has_no_breadth() -> Result<(), Error> {
    let flat = Topography::new(Grid::square(4, 1.0)?, DMatrix::from_element(4, 4, 3.0))?;
    assert_eq!(flat.rms_gradient_spectral(), 0.0);
    assert!(flat.spectral_moments().nayak_parameter().is_nan());
    Ok(())
}

/// Differences see sin(q Δ/2)/(q Δ/2) of a wave, and the square of it for second ones.
#[test]
fn differences_of_a_wave_and_of_a_paraboloid() -> Result<(), Error> {
    let n = 4000;
    let (map, (q, _)) = wave(Grid::new(n, 1, 1e-3, 1.0)?, (400, 0), 2.0)?;
    let seen = (0.5 * q * 1e-3).sin() / (0.5 * q * 1e-3);
    // Missing: one or two differences of 4000.
    let slope = 2.0_f64.sqrt() * q * seen;
    assert!((map.rms_slopes().0 / slope - 1.0).abs() < 1e-3);
    assert!((map.rms_gradient() / slope - 1.0).abs() < 1e-3);
    let laplacian = 2.0_f64.sqrt() * (q * seen).powi(2);
    assert!((map.rms_laplacian() / laplacian - 1.0).abs() < 1e-3);

    let grid = Grid::new(9, 7, 0.5, 0.25)?;
    let paraboloid = DMatrix::from_fn(9, 7, |ix, iy| {
        let (x, y) = grid.position(ix, iy);
        x * x - 3.0 * y * y + x * y
    });
    let map = Topography::new(grid, paraboloid)?;
    // 2 − 6, exact for second differences of numbers of few digits.
    assert!((map.rms_laplacian() - 4.0).abs() < 1e-12);
    assert!((map.rms_curvature() - 2.0).abs() < 1e-12);
    Ok(())
}

#[test]
fn too_few_nodes_have_no_differences() -> Result<(), Error> {
    for (nx, ny) in [(1, 1), (2, 2), (1, 2), (2, 5)] {
        let heights = DMatrix::from_fn(nx, ny, |ix, iy| (ix + iy) as f64);
        let map = Topography::new(Grid::new(nx, ny, 1.0, 1.0)?, heights)?;
        assert_eq!(map.rms_laplacian(), 0.0);
        let slope = |nodes: usize| if nodes > 1 { 1.0 } else { 0.0 };
        assert_eq!(map.rms_slopes(), (slope(nx), slope(ny)));
    }
    let column = DMatrix::from_column_slice(1, 3, &[0.0, 1.0, 0.0]);
    let map = Topography::new(Grid::new(1, 3, 1.0, 0.5)?, column)?;
    assert_eq!(map.rms_laplacian(), 8.0);
    Ok(())
}

/// The density of a generated surface, in every ring, is that of its spectrum times (2π)²; and all of it is the mean
/// square height.
#[test]
fn densities_of_generated_surfaces() -> Result<(), Error> {
    let surface = SelfAffine::new(0.8, 0.25, 0.05, Amplitude::RmsHeight(1e-6), 8)?;
    let grid = Grid::with_sides(96, 64, 1.5, 1.0)?;
    let (spectrum, map) = (surface.spectrum(&grid)?, Topography::sample(&surface, grid)?);
    let bins = map.radial_psd(&RadialBins::PerDecade(2000))?;
    for bin in &bins {
        let expected = TAU * TAU * spectrum.psd(bin.wavevector);
        let plateau = TAU * TAU * spectrum.psd(0.0 + TAU);
        // A ring spans 0.0012 of its wavevector, in which the density, of exponent 3.6, is curved: 3.6 × 4.6/24 of its
        // square. Rings with the roll-off in them differ by half of 3.6 × 0.0012, and beyond the cut-off there is
        // rounding.
        let inside = (bin.wavevector * 0.05 / TAU - 1.0).abs() > 0.002;
        let tolerance = if (bin.wavevector * 0.25 / TAU - 1.0).abs() > 0.002 { 2e-6 } else { 3e-3 };
        assert!(
            !inside || (bin.density - expected).abs() < tolerance * expected + 1e-25 * plateau,
            "{bin:?} {expected}"
        );
    }
    let square = 1e-12;
    for bins in
        [RadialBins::Linear, RadialBins::PerDecade(1), RadialBins::Edges(vec![1.0, 9.0, 200.0])]
    {
        let found = map.radial_psd(&bins)?;
        let sum: f64 = found.iter().map(|bin| bin.waves as f64 * bin.density).sum();
        close(sum / grid.nominal_area(), square);
        assert!(found.windows(2).all(|pair| pair[0].wavevector < pair[1].wavevector));
    }
    Ok(())
}

#[test]
fn linear_rings_hold_their_waves() -> Result<(), Error> {
    let (map, _) = wave(Grid::with_sides(32, 32, 2.0, 2.0)?, (3, 4), 1.0)?;
    let bins = map.radial_psd(&RadialBins::Linear)?;
    assert_eq!(bins.len(), 16);
    for (bin, k) in bins.iter().zip(1..) {
        // Points of the square lattice in the ring.
        let lattice =
            (-16..16).flat_map(|x| (-16..16).map(move |y| f64::from(x * x + y * y).sqrt()));
        let distances: Vec<_> = lattice.filter(|r| (r - f64::from(k)).abs() <= 0.5).collect();
        assert_eq!(bin.waves, distances.len(), "{k}");
        close(bin.wavevector, TAU / 2.0 * distances.iter().sum::<f64>() / distances.len() as f64);
        // Two waves of half the amplitude.
        let expected = if k == 5 { 4.0 * 0.5 / distances.len() as f64 } else { 0.0 };
        assert!((bin.density - expected).abs() < 1e-15);
    }
    Ok(())
}

/// The sum over the line of wave numbers is the mean square about the mean of each profile.
#[test]
fn densities_of_profiles() -> Result<(), Error> {
    for (nx, ny) in [(24, 15), (15, 24), (16, 1)] {
        let grid = Grid::new(nx, ny, 0.5, 0.2)?;
        let map = Topography::new(grid, DMatrix::from_fn(nx, ny, |ix, iy| noise(ix + nx * iy)))?;
        for (axis, map_along_x) in [(Axis::X, map.clone()), (Axis::Y, map.transpose())] {
            let bins = map.psd_along(axis);
            let (n, side) = (map_along_x.grid().nx(), map_along_x.grid().sides().0);
            assert_eq!(bins.len(), n / 2);
            // The definition, term by term.
            for (bin, k) in bins.iter().zip(1..) {
                close(bin.wavevector, TAU * k as f64 / side);
                // Forwards and backwards, and each with all waves across.
                let ways = if 2 * k == n { 1 } else { 2 };
                assert_eq!(bin.waves, ways * map_along_x.grid().ny(), "{axis:?} {k}");
                let profile = |profile: nalgebra::DVectorView<f64>| {
                    let parts = profile.iter().enumerate().map(|(i, z)| {
                        let angle = TAU * ((i * k) % n) as f64 / n as f64;
                        (z * angle.cos(), z * angle.sin())
                    });
                    let (re, im) =
                        parts.fold((0.0, 0.0), |sum, part| (sum.0 + part.0, sum.1 + part.1));
                    (re * re + im * im) * (side / n as f64).powi(2) / side
                };
                let mean = map_along_x.heights().column_iter().map(profile).sum::<f64>()
                    / map_along_x.grid().ny() as f64;
                assert!((bin.density - mean).abs() < 1e-13, "{axis:?} {k} {bin:?} {mean}");
            }
            let sum: f64 = bins
                .iter()
                .zip(1..)
                .map(|(bin, k)| if 2 * k == n { bin.density } else { 2.0 * bin.density })
                .sum();
            let squares = map_along_x.heights().column_iter().map(|profile| profile.variance());
            let mean_square = squares.sum::<f64>() / map_along_x.grid().ny() as f64;
            // Sums of a few hundred squares below 1.
            assert!((sum / side - mean_square).abs() < 1e-13);
        }
    }
    Ok(())
}

#[test]
fn bins_that_are_none() -> Result<(), Error> {
    let (map, _) = wave(Grid::square(8, 1.0)?, (1, 1), 1.0)?;
    for bins in [
        RadialBins::PerDecade(0),
        RadialBins::PerDecade(usize::MAX),
        RadialBins::Edges(vec![1.0, 1.0]),
        RadialBins::Edges(vec![1.0, f64::NAN, 2.0]),
        RadialBins::Edges(vec![1.0, f64::INFINITY]),
        RadialBins::Edges(vec![f64::NAN]),
    ] {
        let refused = map.radial_psd(&bins);
        assert!(matches!(refused, Err(Error::OutOfRange { .. })), "{bins:?} {refused:?}");
    }
    assert_eq!(map.radial_psd(&RadialBins::Edges(Vec::new()))?, Vec::new());
    for (nx, ny) in [(1, 1), (1, 2), (2, 2), (1, 7), (7, 1), (2, 300)] {
        let flat = Topography::new(Grid::new(nx, ny, 1.0, 1e-3)?, DMatrix::zeros(nx, ny))?;
        for bins in [RadialBins::Linear, RadialBins::PerDecade(10)] {
            assert!(flat.radial_psd(&bins)?.iter().all(|bin| bin.density == 0.0));
        }
    }
    Ok(())
}

#[test]
fn bandwidth_is_two_cells_to_the_side() -> Result<(), Error> {
    let bandwidth = |nx, ny| -> Result<(f64, f64), Error> {
        let flat = DMatrix::zeros(nx, ny);
        Ok(Topography::new(Grid::new(nx, ny, 0.5, 2.0)?, flat)?.bandwidth())
    };
    for (shape, (shortest, longest)) in
        [((8, 4), (4.0, 8.0)), ((8, 1), (1.0, 4.0)), ((1, 8), (4.0, 16.0))]
    {
        let found = bandwidth(shape.0, shape.1)?;
        close(found.0, shortest);
        close(found.1, longest);
    }
    Ok(())
}

/// Westergaard: a wave of amplitude a is pressed flat by π E* a/λ, in phase with it.
#[test]
fn pressure_of_full_contact() -> Result<(), Error> {
    let (e_star, a) = (2e9, 1e-6);
    let (map, (qx, qy)) = wave(Grid::new(36, 50, 1e-6, 2e-6)?, (4, -7), a)?;
    let pressure = map.full_contact_pressure(e_star)?;
    let q = qx.hypot(qy);
    let expected = map.heights().map(|z| 0.5 * e_star * q * (z - 5.0 * a));
    // Transforms of an offset of 5 amplitudes, and angles of up to 70.
    assert!((pressure - &expected).amax() < 1e-12 * expected.amax());
    let rms = map.spectral_moments().rms_full_contact_pressure(e_star);
    close(rms, (expected.norm_squared() / 1800.0).sqrt());
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(map.full_contact_pressure(bad), Err(Error::NotPositive { .. })));
    }
    let overflow = map.scaled(1e300)?.full_contact_pressure(1e300);
    assert!(matches!(overflow, Err(Error::FieldNotFinite { .. })));
    Ok(())
}
