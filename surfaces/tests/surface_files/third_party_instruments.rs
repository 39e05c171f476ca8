//! Files of instruments beside what SurfaceTopography 1.27.1 finds in each of their channels (`NAME.ref.json`). The
//! files are not part of this repository; a test without them says so.

use std::fs;

use asperity_surfaces::io::{LengthUnit, MeasuredSurface, ReadOptions, channels};
use serde_json::Value;

use super::third_party::path;

type TestResult = Result<(), Box<dyn std::error::Error>>;

/// Relative error of heights and sides: each is scaled a few times, from numbers of 15 digits.
const ROUNDING: f64 = 1e-13;

/// Asserts that channels of a file are those that the other reader finds, each under our name for it.
fn assert_channels(file: &str, names: &[(usize, &str)]) -> TestResult {
    let Some(path) = path(file) else {
        return Ok(());
    };
    let reference: Value = serde_json::from_str(&fs::read_to_string(
        path.with_file_name(format!("{file}.ref.json")),
    )?)?;
    let ours = channels(&path)?;
    for (k, name) in names {
        assert!(ours.iter().any(|found| found == name), "{file}: {ours:?}");
        let expected = &reference["SurfaceTopography"]["channels"][*k];
        let unit: Option<LengthUnit> = match expected["unit"].as_str() {
            Some(unit) => Some(unit.parse()?),
            None => None,
        };
        let mut options = ReadOptions::new().channel(*name);
        if unit.is_none() {
            options = options.height_unit(LengthUnit::METRE).lateral_unit(LengthUnit::METRE);
        }
        let found = options.read(&path)?;
        assert_equals(
            &format!("{file} {name}"),
            &found,
            expected,
            unit.map_or(1.0, LengthUnit::metres),
        );
    }
    Ok(())
}

fn assert_equals(what: &str, found: &MeasuredSurface, expected: &Value, unit: f64) {
    let (nx, ny) = found.heights.shape();
    let count = |value: &Value| value.as_u64().unwrap_or_default() as usize;
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN) * unit;
    let shape = &expected["nb_grid_pts"];
    assert_eq!((nx, ny), (count(&shape[0]), count(&shape[1])), "{what}");
    let heights = &expected["heights_in_unit"];
    assert_eq!(found.missing, count(&heights["missing"]), "{what}");
    let near = |found: f64, expected: f64, scale: f64, of: &str| {
        assert!(
            (found - expected).abs() <= ROUNDING * scale,
            "{what}, {of}: {found:e}, not {expected:e}"
        );
    };
    let sides = &expected["physical_sizes"];
    if let Some((dx, dy)) = found.cell {
        let (lx, ly) = (number(&sides[0]), number(&sides[1]));
        near(nx as f64 * dx, lx, lx, "side along x");
        near(ny as f64 * dy, ly, ly, "side along y");
    }
    let known = || found.heights.iter().copied().filter(|z| !z.is_nan());
    let (min, max) = (number(&heights["min"]), number(&heights["max"]));
    let scale = min.abs().max(max.abs());
    near(known().fold(f64::INFINITY, f64::min), min, scale, "least height");
    near(known().fold(f64::NEG_INFINITY, f64::max), max, scale, "greatest height");
    let mean = known().sum::<f64>() / known().count() as f64;
    // A sum of half a million heights rounds each of its partial sums.
    near(mean, number(&heights["mean"]), scale * 10.0, "mean height");
    for (place, height) in heights["samples_ix_iy"].as_object().into_iter().flatten() {
        let mut indices = place.split(',').filter_map(|index| index.parse::<usize>().ok());
        let (ix, iy) = (indices.next().unwrap_or(nx), indices.next().unwrap_or(ny));
        near(found.heights[(ix, iy)], number(height), scale, place);
    }
}

#[test]
fn nanoscope() -> TestResult {
    let names = [(0, "Height [1]"), (1, "Height [2]"), (2, "Deflection")];
    assert_channels("di-2.di", &names)?;
    assert_channels("di-3.di", &[(0, "Height Sensor"), (3, "Height")])
}

#[test]
fn igor() -> TestResult {
    let names =
        [(0, "HeightTrace"), (1, "HeightRetrace"), (2, "AmplitudeTrace"), (3, "AmplitudeRetrace")];
    assert_channels("spot_1-1000nm.ibw", &names)?;
    assert_channels("10x10-one_channel_without_name.ibw", &[(0, "gwy3093074346")])
}

#[test]
fn nanosurf() -> TestResult {
    let names = [
        (0, "Scan forward (Z-Axis)"),
        (1, "Scan forward (Z-AxisSensor)"),
        (2, "Scan backward (Z-Axis)"),
        (3, "Scan backward (Z-AxisSensor)"),
    ];
    assert_channels("nid-1.nid", &names)
}

#[test]
fn wyko() -> TestResult {
    assert_channels("surfalize-1.opd", &[(0, "RAW_DATA")])
}

#[test]
fn metropro() -> TestResult {
    assert_channels("metropro-1.dat", &[(0, "")])
}

#[test]
fn sensofar() -> TestResult {
    assert_channels("plu-1.plu", &[(0, "")])
}

#[test]
fn mountains() -> TestResult {
    assert_channels("mnt-1.mnt", &[(0, "A48_10x_P1")])
}

/// The other reader finds 3001 points on 49.98 µm, and no heights. Its first height is the number 11.0474 in the file,
/// times a scale of 0.124 nm, by hand.
#[test]
fn a_profile_of_a_stylus() -> TestResult {
    let Some(path) = path("opdx-3.opdx") else {
        return Ok(());
    };
    let found = ReadOptions::new().read(path)?;
    assert_eq!((found.heights.shape(), found.missing), ((3001, 1), 0));
    let (dx, dy) = found.cell.ok_or("no cell")?;
    assert!(dx == dy && (3001.0 * dx / 49.983_344_425_752_584e-6 - 1.0).abs() < ROUNDING);
    let first = f64::from_bits(0x4026_1843_1a87_6de8) * 0.000_124_176_928_358_892_2e-6;
    assert!((found.heights[(0, 0)] / first - 1.0).abs() < ROUNDING);
    Ok(())
}

/// What cannot be read says why.
#[test]
fn what_is_no_surface_or_no_known_format_is_refused() {
    for (file, reason) in [("nc-1.nc", "a NetCDF file")] {
        let Some(path) = path(file) else {
            continue;
        };
        let message = ReadOptions::new().read(path).map_err(|error| error.to_string());
        assert!(message.as_ref().is_err_and(|text| text.contains(reason)), "{file}: {message:?}");
    }
}

/// Its side is that of the spacing in the file, and Sq that of its integers, by hand.
#[test]
fn a_surface_with_colours() -> TestResult {
    let Some(path) = path("surface_with_colours.sur") else {
        return Ok(());
    };
    let found = ReadOptions::new().read(path)?;
    assert_eq!((found.heights.shape(), found.missing), ((10, 10), 0));
    let (dx, _) = found.cell.ok_or("no cell")?;
    assert!((10.0 * dx / 0.000_134_513_108_059_763_91 - 1.0).abs() < ROUNDING);
    let (min, max) = (found.heights.min(), found.heights.max());
    assert!(((max - min) / 0.000_253_970_607_882_365_6 - 1.0).abs() < ROUNDING, "{}", max - min);
    let mean = found.heights.mean();
    let sq = (found.heights.map(|z| (z - mean) * (z - mean)).mean()).sqrt();
    assert!((sq / 7.473_487_604_942_528e-5 - 1.0).abs() < ROUNDING, "{sq}");
    Ok(())
}
