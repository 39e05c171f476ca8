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
/// The same where only one or two products round, in reading and in the formula.
const CLOSE: f64 = 5e-16;
const CLOSE_SINGLE: f64 = 6e-8;

/// Of a sum with -33 µm, which rounds to half a unit in 2^53 of it; the least height is 6 nm.
const SUM: f64 = 33e3 / 6.0 * f64::EPSILON;

/// What lacks in a file without lengths, or whose pixels are square.
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
    ("plain_i32.mnt",              0.0,   EXACT,  ReadOptions::new),
    ("missing_i32.mnt",            0.0,   EXACT,  ReadOptions::new),
    ("plain_i32_large_sectors.mnt", 0.0,  EXACT,  ReadOptions::new),
    ("missing_f32.al3d",           0.0,   SINGLE, ReadOptions::new),
    ("missing_u32.vk4",            300.0, EXACT,  ReadOptions::new),
    ("missing_f64.x3p",            0.0,   CLOSE,  ReadOptions::new),
    ("missing_f32.x3p",            0.0,   CLOSE_SINGLE, ReadOptions::new),
    ("plain_i16.x3p",              0.0,   CLOSE,  ReadOptions::new),
    ("plain_i32.x3p",              0.0,   CLOSE,  ReadOptions::new),
    ("missing_i16_mask.x3p",       0.0,   CLOSE,  ReadOptions::new),
    ("missing_f64_scaled_folder_stored.x3p", 0.0, CLOSE, ReadOptions::new),
    ("masked.gwy",                 0.0,   EXACT,  ReadOptions::new),
    ("missing_i16_colours.sur",    0.0,   EXACT,  ReadOptions::new),
    ("missing_u32.vk6",            300.0, EXACT,  ReadOptions::new),
    ("plain_i16.spm",              0.0,   EXACT,  ReadOptions::new),
    ("plain_i32.spm",              0.0,   EXACT,  ReadOptions::new),
    ("missing_f32.ibw",            0.0,   SINGLE, ReadOptions::new),
    ("missing_f64_big.ibw",        0.0,   EXACT,  ReadOptions::new),
    ("plain_i16.nid",              0.0,   SUM,    ReadOptions::new),
    ("missing_i16.opd",            0.0,   EXACT,  sides),
    ("missing_f32.opd",            0.0,   EXACT,  sides),
    ("missing_f32.opdx",           0.0,   EXACT,  ReadOptions::new),
    ("missing_i32.dat",            0.0,   SINGLE, sides),
    ("missing_f32.plu",            0.0,   SINGLE, ReadOptions::new),
    ("plain_gwyddion.txt",         0.0,   CLOSE,  ReadOptions::new),
    ("missing_matrix.asc",         0.0,   CLOSE,  in_metres),
    ("plain_semicolon_comma.csv",  0.0,   CLOSE,  in_metres),
    ("missing.xyz",                0.0,   CLOSE,  in_metres),
];

#[test]
fn every_format_gives_the_same_map() {
    for (name, above, error, options) in FILES {
        let found = options().read(own().join(name)).unwrap();
        assert_eq!(found.heights.shape(), SHAPE, "{name}");
        let (dx, dy) = found.cell.unwrap();
        // Sides and spacings are written with digits that end, in float32 in `.sur`; a division and a unit round.
        let rounding = if name.ends_with(".sur") { 1e-9 } else { 1e-14 };
        assert!((dx / CELL.0 - 1.0).abs() <= rounding, "{name}: {dx}");
        assert!((dy / CELL.1 - 1.0).abs() <= rounding, "{name}: {dy}");
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

#[test]
fn titles_and_notes_are_those_of_the_file() {
    let read = |name: &str, options: ReadOptions| options.read(own().join(name)).unwrap();
    for (name, _, _, options) in FILES.iter().filter(|(name, ..)| name.ends_with(".x3p")) {
        assert!(read(name, options()).notes.is_empty(), "{name}");
    }
    assert!(read("missing.xyz", in_metres()).notes.is_empty());
    assert_eq!(read("plain_gwyddion.txt", ReadOptions::new()).title, "made");
    let masked = read("masked.gwy", ReadOptions::new());
    assert_eq!(masked.title, "made");
    assert_eq!(masked.notes, ["2 nodes that a mask marks are taken as missing"]);
    let all = read("masked.gwy", ReadOptions::new().ignore_mask());
    assert_eq!((all.missing, all.notes.len()), (0, 0));
    assert!((all.heights[(2, 1)] + 39e-9).abs() < 1e-22);
}

/// A matrix without a header has no size; a list of points has.
#[test]
fn sides_are_not_made_up() {
    let metre = ReadOptions::new().height_unit(LengthUnit::METRE).lateral_unit(LengthUnit::METRE);
    for (name, sized) in
        [("missing_matrix.asc", false), ("plain_semicolon_comma.csv", false), ("missing.xyz", true)]
    {
        let found = metre.read(own().join(name)).unwrap();
        assert_eq!(found.cell.is_some(), sized, "{name}");
        let is_close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-14;
        assert!(found.cell.is_none_or(|cell| is_close(cell.0, CELL.0) && is_close(cell.1, CELL.1)));
    }
}

#[test]
fn no_beginning_of_a_file_of_gwyddion_is_taken_for_the_file() {
    let bytes = std::fs::read(own().join("masked.gwy")).unwrap();
    for length in 0..bytes.len() {
        let cut = ReadOptions::new().read_bytes(&bytes[..length], "masked.gwy");
        assert!(cut.is_err(), "{length} bytes");
    }
}
