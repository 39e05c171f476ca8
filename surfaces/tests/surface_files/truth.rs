//! One map in every format: 7 x 5 nodes in cells of 2 µm x 3 µm, made from a formula.
//!
//! All but the files named `plain` lack two nodes. `tests/data/README.md` says who else has read them.

use asperity_surfaces::io::{LengthUnit, ReadOptions};

use super::own;

const SHAPE: (usize, usize) = (7, 5);
const CELL: (f64, f64) = (2e-6, 3e-6);
const MISSING: [(usize, usize); 2] = [(2, 1), (6, 4)];

/// The height of a node \[nm\].
fn height(ix: usize, iy: usize) -> f64 {
    let (x, y) = (ix as f64, iy as f64);
    100.0 * x + 17.0 * y * y - 3.0 * x * y - 250.0
}

/// Relative errors of a height that is written exactly and scaled once or twice, and of one in float32.
const EXACT: f64 = 4.0 * f64::EPSILON;
const SINGLE: f64 = 0.51 * f32::EPSILON as f64;

/// What lacks in a file without lengths.
fn sides() -> ReadOptions {
    ReadOptions::new().side(14e-6).side_y(15e-6)
}

/// What lacks in a text without any words.
fn in_metres() -> ReadOptions {
    let metre = LengthUnit::METRE;
    sides().height_unit(metre).lateral_unit(metre)
}

/// Name, heights beyond those of the formula \[nm\], relative error, and what the file does not say.
type File = (&'static str, f64, f64, fn() -> ReadOptions);

#[rustfmt::skip]
const FILES: &[File] = &[
    ("plain.gsf",                  0.0,   SINGLE, ReadOptions::new),
    ("missing.gsf",                0.0,   SINGLE, ReadOptions::new),
    ("missing.npy",                0.0,   EXACT,  sides),
    ("missing_ascii.sdf",          0.0,   EXACT,  ReadOptions::new),
    ("missing_bcr_ascii.sdf",      0.0,   EXACT,  ReadOptions::new),
    ("missing_bcr_i2.sdf",         0.0,   EXACT,  ReadOptions::new),
    ("missing_iso1_i2.sdf",        0.0,   EXACT,  ReadOptions::new),
    ("missing_iso1_i4.sdf",        0.0,   EXACT,  ReadOptions::new),
    ("missing_iso1_f8.sdf",        0.0,   EXACT,  ReadOptions::new),
    ("missing_iso2_i2.sdf",        0.0,   EXACT,  ReadOptions::new),
    ("missing_iso2_i4.sdf",        0.0,   EXACT,  ReadOptions::new),
    ("missing_iso2_f8.sdf",        0.0,   EXACT,  ReadOptions::new),
    ("plain_iso2_f4.sdf",          0.0,   EXACT,  ReadOptions::new),
    ("missing_i16.sur",            0.0,   EXACT,  ReadOptions::new),
    ("missing_i32.sur",            0.0,   EXACT,  ReadOptions::new),
    ("missing_i32_compressed.sur", 0.0,   EXACT,  ReadOptions::new),
    ("plain_i32_offset.sur",       500.0, EXACT,  ReadOptions::new),
    ("missing_f32.al3d",           0.0,   SINGLE, ReadOptions::new),
    ("missing_u32.vk4",            300.0, EXACT,  ReadOptions::new),
    ("missing_f64.x3p",            0.0,   EXACT,  ReadOptions::new),
    ("missing_f32.x3p",            0.0,   SINGLE, ReadOptions::new),
    ("plain_i16.x3p",              0.0,   EXACT,  ReadOptions::new),
    ("plain_i32.x3p",              0.0,   EXACT,  ReadOptions::new),
    ("missing_i16_mask.x3p",       0.0,   EXACT,  ReadOptions::new),
    ("missing_f64_scaled_folder_stored.x3p", 0.0, EXACT, ReadOptions::new),
    ("masked.gwy",                 0.0,   EXACT,  ReadOptions::new),
    ("plain_gwyddion.txt",         0.0,   EXACT,  ReadOptions::new),
    ("missing_matrix.asc",         0.0,   EXACT,  in_metres),
    ("plain_semicolon_comma.csv",  0.0,   EXACT,  in_metres),
    ("missing.xyz",                0.0,   EXACT,  in_metres),
];

#[test]
fn every_format_gives_the_same_map() {
    for (name, above, error, options) in FILES {
        let found = options().read(own().join(name)).unwrap();
        assert_eq!(found.heights.shape(), SHAPE, "{name}");
        let (dx, dy) = found.cell.unwrap();
        // Sides are written with nine digits or more, and divided once.
        assert!((dx - CELL.0).abs() <= 1e-9 * CELL.0, "{name}: {dx}");
        assert!((dy - CELL.1).abs() <= 1e-9 * CELL.1, "{name}: {dy}");
        let lacks = !name.starts_with("plain");
        assert_eq!(found.missing, if lacks { 2 } else { 0 }, "{name}");
        for iy in 0..SHAPE.1 {
            for ix in 0..SHAPE.0 {
                let found = found.heights[(ix, iy)];
                if lacks && MISSING.contains(&(ix, iy)) {
                    assert!(found.is_nan(), "{name} ({ix}, {iy}): {found}");
                    continue;
                }
                let expected = (height(ix, iy) + above) * 1e-9;
                assert!(
                    (found - expected).abs() <= error * expected.abs(),
                    "{name} ({ix}, {iy}): {found} instead of {expected}"
                );
            }
        }
    }
}
