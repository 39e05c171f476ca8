//! Archives, trees and texts that other programs wrote: what is read is what SurfaceTopography 1.27.1 and, of `.x3p`,
//! x3pio 2.0.0 and surfalize 0.19.2 find in them. The files are not part of this repository; a test without them says
//! so.

use asperity_surfaces::io::{LengthUnit, MeasuredSurface, ReadOptions, channels};
use asperity_surfaces::{Error, FileError};

use super::third_party::path;

type TestResult = Result<(), Box<dyn std::error::Error>>;

/// What other readers find in a file; lengths in metres.
struct Found<'a> {
    shape: (usize, usize),
    /// Nodes times spacing.
    sides: Option<(f64, f64)>,
    min: f64,
    max: f64,
    mean: f64,
    missing: usize,
    samples: &'a [((usize, usize), f64)],
}

impl Found<'_> {
    fn assert_in(&self, name: &str, options: &ReadOptions) -> TestResult {
        let Some(path) = path(name) else {
            return Ok(());
        };
        let found = options.read(path)?;
        self.assert_equals(name, &found);
        assert!(found.notes.is_empty(), "{name}: {:?}", found.notes);
        Ok(())
    }

    fn assert_equals(&self, name: &str, found: &MeasuredSurface) {
        assert_eq!(found.heights.shape(), self.shape, "{name}");
        assert_eq!(found.missing, self.missing, "{name}");
        let (nx, ny) = self.shape;
        let sides = found.cell.map(|(dx, dy)| (nx as f64 * dx, ny as f64 * dy));
        // Products with a unit, a number of nodes, a factor: a few rounding errors.
        let close = |a: f64, b: f64, scale: f64| (a - b).abs() <= 1e-14 * scale;
        match (sides, self.sides) {
            (Some(a), Some(b)) => {
                assert!(close(a.0, b.0, b.0), "{name}: {} x {}", a.0, a.1);
                assert!(close(a.1, b.1, b.1), "{name}: {} x {}", a.0, a.1);
            }
            (a, b) => assert_eq!(a, b, "{name}"),
        }
        let scale = self.min.abs().max(self.max.abs());
        let measured = || found.heights.iter().copied().filter(|z| !z.is_nan());
        let min = measured().fold(f64::INFINITY, f64::min);
        let max = measured().fold(f64::NEG_INFINITY, f64::max);
        assert!(close(min, self.min, scale), "{name}: {min}");
        assert!(close(max, self.max, scale), "{name}: {max}");
        // Sums of up to half a million heights in another order: each addition rounds a partial sum that is smaller
        // than all heights together.
        let count = (nx * ny - found.missing) as f64;
        let mean = measured().sum::<f64>() / count;
        let error = (mean - self.mean).abs();
        assert!(error <= f64::EPSILON * count * scale, "{name}: {mean}");
        for (node, expected) in self.samples {
            let height = found.heights[*node];
            let same = height.is_nan() && expected.is_nan();
            assert!(same || close(height, *expected, scale), "{name}: {height} at {node:?}");
        }
    }
}

fn metres() -> ReadOptions {
    ReadOptions::new().height_unit(LengthUnit::METRE).lateral_unit(LengthUnit::METRE)
}

#[test]
fn an_archive_of_mountains_map() -> TestResult {
    Found {
        shape: (650, 650),
        sides: Some((8.29767313942749e-05, 0.0002044783737930349)),
        min: -3.144206865877671e-07,
        max: 2.3991551341223285e-07,
        mean: -2.491824169305576e-09,
        missing: 0,
        samples: &[
            ((0, 0), 6.579781341223288e-08),
            ((649, 0), -4.133318658776711e-08),
            ((0, 649), 9.597611341223287e-08),
            ((649, 649), -3.276918658776711e-08),
            ((1, 0), 7.419121341223288e-08),
            ((0, 1), 6.233641341223288e-08),
            ((325, 216), 9.285913412232885e-09),
        ],
    }
    .assert_in("x3p-2.x3p", &ReadOptions::new())
}

/// Its dates are no dates, and its revision has an en dash.
#[test]
fn a_small_archive_of_x3ptools() -> TestResult {
    Found {
        shape: (5, 5),
        sides: Some((5.0, 5.0)),
        min: 2.0,
        max: 10.0,
        mean: 3.6,
        missing: 0,
        samples: &[],
    }
    .assert_in("x3ptools-pyramid.x3p", &ReadOptions::new())
}

/// Everything in a folder, and a checksum that does not match: of the other readers only x3pio reads it, if told not to
/// look at checksums. The member seems to hold metres, but the description says to multiply by 1e-6, which both do.
#[test]
fn an_archive_with_a_wrong_checksum() -> TestResult {
    let name = "x3ptools-csafe-logo.x3p";
    let Some(path) = path(name) else {
        return Ok(());
    };
    let found = ReadOptions::new().read(path)?;
    Found {
        shape: (741, 419),
        sides: Some((741.0 * 6.45000000000095e-07, 419.0 * 6.45e-07)),
        min: 2.078431372549019e-13,
        max: 8.274509803921565e-13,
        mean: 4.2006709556751295e-13,
        missing: 0,
        samples: &[((0, 0), 4e-13), ((370, 200), 5.098039215686274e-13)],
    }
    .assert_equals(name, &found);
    assert!(found.notes.len() == 1 && found.notes[0].contains("main.xml"));
    Ok(())
}

/// A picture without units: counts are no heights.
#[test]
fn a_map_without_a_unit_is_refused() -> TestResult {
    let Some(path) = path("gwyfile-test.gwy") else {
        return Ok(());
    };
    assert_eq!(channels(&path)?, ["Test"]);
    let refused = ReadOptions::new().read(&path);
    assert!(matches!(refused, Err(Error::File(FileError::NoUnit { found: None, .. }))));
    // With units it can be read: xreal and yreal are 128.
    let found = metres().read(path)?;
    assert_eq!(found.heights.shape(), (128, 128));
    assert_eq!(found.cell, Some((1.0, 1.0)));
    Ok(())
}

#[test]
fn a_matrix_with_a_factor_in_its_header() -> TestResult {
    Found {
        shape: (75, 305),
        sides: Some((2.773965e-05, 0.00011280791)),
        min: -2.968808672092e-07,
        max: 2.929150022256e-07,
        mean: -1.1915104334671043e-15,
        missing: 0,
        samples: &[
            ((0, 0), -1.298199355698e-07),
            ((74, 0), -2.453013937096e-07),
            ((0, 304), 2.13665054148e-07),
            ((74, 304), 1.980200491684e-07),
            ((1, 0), -1.341206325266e-07),
            ((0, 1), -1.24608036908e-07),
            ((37, 101), 9.338730454199999e-09),
        ],
    }
    .assert_in("matrix-4.txt", &ReadOptions::new())
}

#[test]
fn matrices_without_a_header_and_with_one() -> TestResult {
    Found {
        shape: (10, 10),
        sides: None,
        min: 0.0,
        max: 2.0,
        mean: 1.0,
        missing: 0,
        samples: &[((0, 0), 2.0), ((9, 0), 2.0), ((0, 9), 0.0), ((5, 3), 2.0)],
    }
    .assert_in("matrix-5.txt", &metres())?;
    Found {
        shape: (4, 3),
        sides: Some((1e-5, 1e-5)),
        min: 1.0,
        max: 12.0,
        mean: 6.5,
        missing: 0,
        samples: &[((3, 0), 4.0), ((0, 2), 9.0), ((2, 1), 7.0)],
    }
    .assert_in("matrix-6.txt", &ReadOptions::new())?;
    // Three columns, but sides: a matrix.
    Found {
        shape: (3, 4),
        sides: Some((1.234e-05, 5.6789e-06)),
        min: -6.0,
        max: 9.0,
        mean: 1.7916666666666667,
        missing: 0,
        samples: &[((2, 0), 3.0), ((1, 0), 1.5), ((0, 1), -2.0), ((1, 1), -3.0)],
    }
    .assert_in("gwyddion-export-english.txt", &ReadOptions::new())?;
    Found {
        shape: (6, 3),
        sides: Some((1e-06, 5e-07)),
        min: 0.0,
        max: 1e-07,
        mean: 1.111111111111111e-08,
        missing: 0,
        samples: &[((0, 0), 1e-7), ((0, 1), 5e-8), ((3, 1), 0.0)],
    }
    .assert_in("txt_example.txt", &ReadOptions::new())?;
    let Some(path) = path("gwyddion-export-english.txt") else {
        return Ok(());
    };
    assert_eq!(ReadOptions::new().read(path)?.title, "My Channel Name");
    Ok(())
}

/// Of the last of these surfalize makes the transpose; SurfaceTopography agrees with the coordinates in the file.
#[test]
fn lists_of_points() -> TestResult {
    let found = |mean, missing, samples| Found {
        shape: (4, 4),
        sides: Some((4.0, 4.0)),
        min: 1.0,
        max: 2.0,
        mean,
        missing,
        samples,
    };
    found(1.125, 0, &[((0, 0), 1.0), ((2, 1), 1.0), ((1, 2), 2.0)])
        .assert_in("xyz-1.txt", &metres())?;
    found(1.125, 0, &[((0, 0), 1.0), ((2, 1), 1.0), ((1, 2), 2.0)])
        .assert_in("xyz-1-different-order.txt", &metres())?;
    let gaps = [((3, 0), 2.0), ((0, 3), 1.0), ((1, 0), f64::NAN), ((2, 1), f64::NAN)];
    found(1.4285714285714286, 2, &gaps).assert_in("xyz-2.txt", &metres())
}

/// SurfaceTopography takes it for a line scan, which it is.
#[test]
fn a_line_scan_is_a_profile() -> TestResult {
    let Some(path) = path("nonuniform.asc") else {
        return Ok(());
    };
    let found = metres().read(path)?;
    assert_eq!(found.heights.ncols(), 1);
    assert!(found.notes.iter().any(|note| note.contains("uneven")), "{:?}", found.notes);
    Ok(())
}
