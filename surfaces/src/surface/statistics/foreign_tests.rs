//! Numbers of tamaas 2.9.0, SurfaceTopography 1.27.1 and surfalize 0.19.2 for two maps in `tests/data`, with the first
//! two of which the study `statistics` compares more.

use std::path::PathBuf;

use super::tests::close;
use super::*;
use crate::io::read_npy;
use crate::surface::{Axis, Topography, Trend};
use crate::{Error, Grid};

fn map(name: &str, sides: (f64, f64)) -> Result<Topography, Error> {
    let data = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    let heights = read_npy(data.join(name))?;
    let (nx, ny) = heights.shape();
    Topography::new(Grid::with_sides(nx, ny, sides.0, sides.1)?, heights)
}

/// A quantity of a map, and what it is of both maps.
type Quantity = (fn(&Topography) -> f64, [f64; 2]);

/// tamaas: m₀, m₂ and m₄ (turned from turns into radians, on a square of side 1), rms gradient, least pressure of full
/// contact.
#[test]
fn tamaas_finds_the_same() -> Result<(), Error> {
    // Its m₄ is another mean, which an isotropic surface has alike.
    let m4: fn(&Topography) -> f64 = |map| {
        let found = map.spectral_moments();
        (found.m40() + 3.0 * found.m22() + found.m04()) / 3.0
    };
    let quantities: [Quantity; 4] = [
        (|map| map.spectral_moments().m0(), [1.0320131029530287e-11, 2.500000000000001e-9]),
        (|map| map.spectral_moments().m2(), [1.6157565076278941e-9, 1.3642891864885779e-6]),
        (m4, [7.61601068499565e-7, 0.0023753164095736837]),
        (|map| map.rms_gradient_spectral(), [5.6846398436979154e-5, 0.0016518409042571727]),
    ];
    let pressures = [7.882567207585579e-5, 0.0026643623813115383];
    for (k, name) in ["periodic_32x24.npy", "selfaffine_48.npy"].into_iter().enumerate() {
        let map = map(name, (1.0, 1.0))?;
        for (quantity, expected) in quantities {
            close(quantity(&map), expected[k]);
        }
        assert!((map.spectral_moments().m4() / quantities[2].1[k] - 1.0).abs() < 1e-2);
        close(-map.full_contact_pressure(1.0)?.min(), pressures[k]);
    }
    Ok(())
}

/// SurfaceTopography: rms height, Laplacian of differences, slopes of the waves, levelled rms heights, tilt.
#[test]
fn surface_topography_finds_the_same() -> Result<(), Error> {
    let quantities: [Quantity; 5] = [
        (|map| map.map().rms_height(), [3.212496074632667e-6, 5.000000000000001e-5]),
        (|map| map.rms_laplacian(), [3018.306857698364, 731.3146855167627]),
        (|map| map.spectral_moments().m20(), [0.005175853879775595, 0.013758260999503391]),
        (|map| map.spectral_moments().m02(), [0.002144064942321959, 0.013527522730268117]),
        (|map| map.trend(Trend::Plane).tilt(), [0.0036156139097143006, 0.0029446855414139287]),
    ];
    let levelled = [
        (Trend::Plane, [3.1403503666707427e-6, 4.9272417950906596e-5]),
        (Trend::Quadratic, [3.0788716101804472e-6, 4.89281448842993e-5]),
    ];
    let maps = [
        map("periodic_32x24.npy", (32.0 * 2e-5, 24.0 * 3e-5))?,
        map("selfaffine_48.npy", (1e-2, 1e-2))?,
    ];
    for (k, map) in maps.iter().enumerate() {
        for (quantity, expected) in quantities {
            close(quantity(map), expected[k]);
        }
        for (trend, expected) in levelled {
            close(map.level(trend)?.map().rms_height(), expected[k]);
        }
    }
    Ok(())
}

/// surfalize, of the map without its tilt. Height parameters, gradient and developed area are the same; it takes
/// autocorrelations that repeat, and the straight line of the core from heights on a grid of its own.
#[test]
fn surfalize_finds_the_same_texture() -> Result<(), Error> {
    let maps = [
        map("periodic_32x24.npy", (32.0 * 2e-5, 24.0 * 3e-5))?,
        map("selfaffine_48.npy", (1e-2, 1e-2))?,
    ];
    let same = [
        [2.5474378303458636e-6, 3.140350366670743e-6, 1.618307293499642e-5, 7.638806458060798e-6],
        [4.03260990181282e-5, 4.927241795090659e-5, 2.908552907756209e-4, 1.36849536013268e-4],
    ];
    let shapes = [
        [-0.15209990894215986, 2.6459090850027187, 0.08327803952568055, 0.003420289902963613],
        [-0.22279367316293242, 2.7047350100874663, 0.16056774761123846, 0.012741512046081098],
    ];
    let lengths =
        [(6.974974974974975e-5, 0.559257632894753), (7.406297977836231e-4, 0.8993571780378337)];
    let cores = [
        [
            8.377345619687002e-6,
            2.4072981363689943e-6,
            2.8885569367810215e-6,
            0.08228544,
            0.89203250,
        ],
        [1.4001827540970658e-4, 3.573682598541806e-5, 4.766117953121485e-5, 0.05589529, 0.90627888],
    ];
    for (k, map) in maps.iter().enumerate() {
        let found = map.areal_parameters()?;
        let heights = [found.sa, found.sq, found.sz, found.sp];
        for (found, expected) in heights.into_iter().zip(same[k]) {
            close(found, expected);
        }
        for (found, expected) in
            [found.ssk, found.sku, found.sdq, found.sdr].into_iter().zip(shapes[k])
        {
            // Rounding of third and fourth powers.
            assert!((found / expected - 1.0).abs() < 1e-11, "{found} {expected}");
        }
        let near = |found: f64, expected: f64, most: f64| {
            assert!((found / expected - 1.0).abs() < most, "{found} {expected}");
        };
        near(found.sal.unwrap_or_default(), lengths[k].0, 5e-3);
        near(found.str.unwrap_or_default(), lengths[k].1, 2e-2);
        let core = found.core;
        let parts = [core.sk, core.spk, core.svk, core.smrk1, core.smrk2];
        for (found, expected) in parts.into_iter().zip(cores[k]) {
            near(found, expected, 1.5e-2);
        }
    }
    Ok(())
}

/// SurfaceTopography: the first five of `power_spectrum_from_area` with its own bins, and of
/// `power_spectrum_from_profile` without.
#[test]
fn surface_topography_has_the_same_spectra() -> Result<(), Error> {
    let map = map("periodic_32x24.npy", (32.0 * 2e-5, 24.0 * 3e-5))?;
    let rings = map.radial_psd(&RadialBins::PerDecade(10))?;
    for (ring, (q, density)) in rings.iter().zip([
        (8726.646259971647, 1.5080026054307248e-20),
        (9817.477042468103, 2.166536934682488e-19),
        (13135.34203688908, 1.279900258488693e-19),
        (17453.292519943294, 2.214882198746087e-19),
        (19894.978873356107, 3.178667136356657e-20),
    ]) {
        close(ring.wavevector, q);
        close(ring.density, density);
    }
    let (along_x, along_y) = (map.psd_along(Axis::X), map.psd_along(Axis::Y));
    assert!(along_x.len() > 5 && along_y.len() > 5);
    for ((x, y), expected) in along_x.iter().zip(&along_y).zip([
        (7.725010669761085e-16, 1.6704115641218025e-15),
        (1.4454850213537355e-15, 9.818738165480812e-16),
        (3.435445707958421e-16, 2.5698597822596167e-16),
        (2.692130189710385e-16, 8.592285950233056e-17),
        (5.639177758842875e-17, 3.172628122331524e-17),
    ]) {
        close(x.density, expected.0);
        close(y.density, expected.1);
    }
    Ok(())
}
