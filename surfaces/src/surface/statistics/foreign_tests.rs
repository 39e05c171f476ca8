//! Numbers of tamaas 2.9.0 and SurfaceTopography 1.27.1 for two maps in `tests/data`, which the study `statistics`
//! compares with more of.

use std::path::PathBuf;

use super::*;
use crate::io::read_npy;
use crate::surface::{Axis, Topography, Trend};
use crate::{Error, Grid};

/// Relative: rounding of sums over at most 2304 nodes.
fn close(found: f64, expected: f64) {
    assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
}

fn map(name: &str, sides: (f64, f64)) -> Result<Topography, Error> {
    let data = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../tests/data");
    let heights = read_npy(data.join(name))?;
    let (nx, ny) = heights.shape();
    Topography::new(Grid::with_sides(nx, ny, sides.0, sides.1)?, heights)
}

/// tamaas: m₀, m₂ and m₄ (turned from turns into radians, on a square of side 1), rms gradient, least pressure of full contact.
#[test]
fn tamaas_finds_the_same() -> Result<(), Error> {
    for (name, [m0, m2, m4, gradient, pressure]) in [
        (
            "periodic_32x24.npy",
            [
                1.0320131029530287e-11,
                1.6157565076278941e-9,
                7.61601068499565e-7,
                5.6846398436979154e-5,
                7.882567207585579e-5,
            ],
        ),
        (
            "selfaffine_48.npy",
            [
                2.500000000000001e-9,
                1.3642891864885779e-6,
                0.0023753164095736837,
                0.0016518409042571727,
                0.0026643623813115383,
            ],
        ),
    ] {
        let map = map(name, (1.0, 1.0))?;
        let found = map.spectral_moments();
        close(found.m0(), m0);
        close(found.m2(), m2);
        // Its m₄ is another mean, which an isotropic surface has alike.
        close((found.m40() + 3.0 * found.m22() + found.m04()) / 3.0, m4);
        assert!((found.m4() / m4 - 1.0).abs() < 1e-2);
        close(found.rms_gradient(), gradient);
        close(-map.full_contact_pressure(1.0)?.min(), pressure);
    }
    Ok(())
}

/// SurfaceTopography: rms height, Laplacian of differences, slopes of the waves, levelled rms heights, tilt.
#[test]
fn surface_topography_finds_the_same() -> Result<(), Error> {
    for (name, sides, expected) in [
        (
            "periodic_32x24.npy",
            (32.0 * 2e-5, 24.0 * 3e-5),
            [
                3.212496074632667e-6,
                3018.306857698364,
                0.005175853879775595,
                0.002144064942321959,
                3.1403503666707427e-6,
                3.0788716101804472e-6,
                0.0036156139097143006,
            ],
        ),
        (
            "selfaffine_48.npy",
            (1e-2, 1e-2),
            [
                5.000000000000001e-5,
                731.3146855167627,
                0.013758260999503391,
                0.013527522730268117,
                4.9272417950906596e-5,
                4.89281448842993e-5,
                0.0029446855414139287,
            ],
        ),
    ] {
        let map = map(name, sides)?;
        let moments = map.spectral_moments();
        let found = [
            map.map().rms_height(),
            map.rms_laplacian(),
            moments.m20(),
            moments.m02(),
            map.level(Trend::Plane)?.map().rms_height(),
            map.level(Trend::Quadratic)?.map().rms_height(),
            map.trend(Trend::Plane).tilt(),
        ];
        for (found, expected) in found.into_iter().zip(expected) {
            close(found, expected);
        }
    }
    Ok(())
}

/// SurfaceTopography: the first five of `power_spectrum_from_area` with its own bins, and of
/// `power_spectrum_from_profile` without.
#[test]
fn surface_topography_has_the_same_spectra() -> Result<(), Error> {
    let map = map("periodic_32x24.npy", (32.0 * 2e-5, 24.0 * 3e-5))?;
    let wavevectors = [
        8726.646259971647,
        9817.477042468103,
        13135.34203688908,
        17453.292519943294,
        19894.978873356107,
    ];
    let densities = [
        1.5080026054307248e-20,
        2.166536934682488e-19,
        1.279900258488693e-19,
        2.214882198746087e-19,
        3.178667136356657e-20,
    ];
    let rings = map.radial_psd(&RadialBins::PerDecade(10))?;
    for (ring, (q, density)) in rings.iter().zip(wavevectors.into_iter().zip(densities)) {
        close(ring.wavevector, q);
        close(ring.density, density);
    }
    for (axis, expected) in [
        (
            Axis::X,
            [
                7.725010669761085e-16,
                1.4454850213537355e-15,
                3.435445707958421e-16,
                2.692130189710385e-16,
                5.639177758842875e-17,
            ],
        ),
        (
            Axis::Y,
            [
                1.6704115641218025e-15,
                9.818738165480812e-16,
                2.5698597822596167e-16,
                8.592285950233056e-17,
                3.172628122331524e-17,
            ],
        ),
    ] {
        let bins = map.psd_along(axis);
        assert!(bins.len() > expected.len());
        for (bin, expected) in bins.iter().zip(expected) {
            close(bin.density, expected);
        }
    }
    Ok(())
}
