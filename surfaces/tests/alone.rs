//! A program that knows nothing but this crate: it reads a file of an instrument, prepares the surface and describes
//! it.
#![allow(clippy::panic)]
#![cfg(feature = "io")]

use std::fs::File;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use asperity_surfaces::io::{MeasuredSurface, ReadOptions, read_npy, read_npy_from, read_surface};
use asperity_surfaces::nalgebra::DMatrix;
use asperity_surfaces::surface::Trend;
use asperity_surfaces::{Error, FileError};

type Done = Result<(), Box<dyn std::error::Error>>;

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data").join(name)
}

/// Bit for bit, NaN too.
fn bits(heights: &DMatrix<f64>) -> Vec<u64> {
    heights.iter().map(|height| height.to_bits()).collect()
}

/// The map z = 100 x + 17 y² − 3 x y − 250 nm of 7 × 5 nodes, two of them missing.
#[test]
fn a_measurement_is_read_filled_levelled_and_described() -> Done {
    let measured = read_surface(data("surface_files/missing_i32.sur"))?;
    assert_eq!(measured.missing, 2);
    assert_eq!(
        measured.to_string(),
        "Digital Surf: 7 x 5 nodes, 14 µm x 15 µm, 2 nodes (5.71 %) missing"
    );
    let refused = measured.clone().topography();
    assert!(matches!(refused, Err(Error::HeightNotFinite { count: 2, .. })), "{refused:?}");
    let tilted = measured.clone().fill_missing()?.topography()?;
    let (tilt, _) = measured.trend(Trend::Plane)?.slopes();
    // 100 nm − 3 nm y on average in 2 µm, of which the missing nodes take a little.
    assert!((tilt / 47e-3 - 1.0).abs() < 0.05, "{tilt}");
    let level = measured.level(Trend::Plane)?;
    let known = level.heights.iter().filter(|height| height.is_finite());
    let sum: f64 = known.sum();
    let levelled = level.fill_missing()?.topography()?;
    let map = levelled.map();
    let statistics = format!(
        "Sq = {:e} m, Sa = {:e} m, Sz = {:e} m, gradient {}",
        map.rms_height(),
        map.mean_absolute_height(),
        map.peak_to_valley(),
        levelled.rms_gradient()
    );
    println!("{statistics}");
    // Heights of 0.3 µm and their sums, rounded: 33 nodes, 2⁻⁵² of each. What is filled in moves the mean by no more
    // than the two nodes that are, at the highest or lowest measured one.
    assert!(sum.abs() < 1e-18, "{sum:e}: {statistics}");
    assert!(map.mean_height().abs() < 2.0 / 35.0 * map.peak_to_valley(), "{statistics}");
    assert!(map.rms_height() < 0.2 * tilted.map().rms_height(), "{statistics}");
    assert!(map.mean_absolute_height() <= map.rms_height(), "{statistics}");
    assert!(levelled.rms_gradient() < tilted.rms_gradient(), "{statistics}");
    Ok(())
}

/// From the disk, from bytes and from a source: the same surface and the same errors, whatever the format.
#[test]
fn bytes_are_read_as_files_are() -> Done {
    let options = ReadOptions::new().height_unit("nm".parse()?).lateral_unit("um".parse()?);
    let told = |read: Result<MeasuredSurface, Error>| match read {
        Ok(mut surface) => {
            let heights = bits(&std::mem::replace(&mut surface.heights, DMatrix::zeros(0, 0)));
            format!("{surface:?} {heights:?}")
        }
        Err(error) => format!("{error}: {error:?}"),
    };
    let mut surfaces = 0;
    for entry in std::fs::read_dir(data("surface_files"))? {
        let path = entry?.path();
        let bytes = std::fs::read(&path)?;
        let expected = options.read(&path);
        surfaces += usize::from(expected.is_ok());
        let expected = told(expected);
        assert_eq!(told(options.read_bytes(&bytes, &path)), expected);
        assert_eq!(told(options.read_from(File::open(&path)?, &path)), expected);
        assert_eq!(told(options.read_from(Cursor::new(bytes), &path)), expected);
    }
    assert!(surfaces >= 20, "{surfaces}");
    let array = data("selfaffine_48.npy");
    assert_eq!(bits(&read_npy_from(File::open(&array)?, "array")?), bits(&read_npy(&array)?));
    Ok(())
}

/// What is wrong is told with the name that the caller gives.
#[test]
fn errors_of_bytes_carry_the_name() {
    let cut = ReadOptions::new().read_bytes(b"DIGITAL SURF", "upload 7.sur");
    let Err(Error::File(FileError::BadFile { path, format, .. })) = cut else {
        panic!("{cut:?}");
    };
    assert_eq!((path.as_path(), format), (Path::new("upload 7.sur"), "Digital Surf"));
    let unknown = ReadOptions::new().read_bytes([0, 1, 2], "");
    assert!(matches!(unknown, Err(Error::File(FileError::UnknownFormat { .. }))), "{unknown:?}");
    let array = read_npy_from(&b"\x93NUMPY"[..], "cut.npy").map_err(|error| error.to_string());
    assert!(array.is_err_and(|text| text.starts_with("cut.npy is no readable NumPy file")));
}

/// A source that fails is told as a file that cannot be read.
#[test]
fn a_source_that_fails_is_an_error() {
    struct Broken;
    impl std::io::Read for Broken {
        fn read(&mut self, _: &mut [u8]) -> std::io::Result<usize> {
            Err(std::io::ErrorKind::ConnectionReset.into())
        }
    }
    let read = ReadOptions::new().read_from(Broken, "remote.sdf");
    assert!(
        matches!(&read, Err(Error::File(FileError::Io { path, source }))
            if path == Path::new("remote.sdf") && source.kind() == std::io::ErrorKind::ConnectionReset),
        "{read:?}"
    );
}
