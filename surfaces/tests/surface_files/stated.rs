//! What a text says is used or named: small files of the kinds that programs and instruments export, all of one map.
//!
//! 12 × 9 nodes in cells of 2 µm, from a formula; `tests/data/README.md` says how each file writes them.

use std::path::PathBuf;

use asperity_surfaces::io::{LengthUnit, MeasuredSurface, ReadOptions, TextLayout};
use asperity_surfaces::surface::Warning;

use super::own;

const SHAPE: (usize, usize) = (12, 9);

/// The height of a node \[µm\], before it is written with five digits behind the point.
fn height(ix: usize, iy: usize) -> f64 {
    let (i, j) = (ix as f64, iy as f64);
    0.31 * (0.7 * i + 0.3).sin() + 0.17 * (0.9 * j - 0.2).cos() + 0.002 * i * j
}

/// Half of the last digit that is written \[µm\]; waves have one digit more, so that they add a tenth of it at most.
const DIGIT: f64 = 0.5e-5 * 1.1;

fn file(name: &str) -> PathBuf {
    own().with_file_name("text_files").join(name)
}

fn read(name: &str, options: ReadOptions) -> MeasuredSurface {
    options.read(file(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn refusal(name: &str, options: ReadOptions) -> String {
    match options.read(file(name)) {
        Ok(found) => panic!("{name} is read: {found}"),
        Err(error) => error.to_string(),
    }
}

fn micrometres() -> ReadOptions {
    ReadOptions::new().height_unit("um".parse().unwrap())
}

/// Asserts that this is the map, but for the nodes that are missing.
fn assert_is_the_map(name: &str, found: &MeasuredSurface, missing: &[(usize, usize)]) {
    assert_eq!(found.heights.shape(), SHAPE, "{name}");
    let (dx, dy) = found.cell.unwrap_or_else(|| panic!("{name} has no cell"));
    assert!(
        (dx / 2e-6 - 1.0).abs() < 1e-14 && (dy / 2e-6 - 1.0).abs() < 1e-14,
        "{name}: {dx} {dy}"
    );
    assert_eq!(found.missing, missing.len(), "{name}");
    for iy in 0..SHAPE.1 {
        for ix in 0..SHAPE.0 {
            let (found, expected) = (found.heights[(ix, iy)] * 1e6, height(ix, iy));
            match missing.contains(&(ix, iy)) {
                true => assert!(found.is_nan(), "{name}: {found} at ({ix}, {iy})"),
                false => assert!(
                    (found - expected).abs() <= DIGIT,
                    "{name}: {found} instead of {expected} at ({ix}, {iy})"
                ),
            }
        }
    }
}

fn note(found: &MeasuredSurface, words: &str) {
    assert!(found.notes.iter().any(|note| note.contains(words)), "{words}: {:?}", found.notes);
}

#[test]
fn axes_in_the_first_row_and_column_are_no_heights() {
    let name = "axes_row_and_column.txt";
    let found = read(name, micrometres().lateral_unit("mm".parse().unwrap()));
    assert_is_the_map(name, &found, &[]);
    note(&found, "first row");
    assert_is_the_map(name, &read(name, micrometres().side(24e-6)), &[]);
    // Of which unit the axes are, the file does not say.
    assert!(refusal(name, micrometres()).contains("lengths along x and y have no unit"));
}

#[test]
fn columns_are_found_by_their_names() {
    let name = "index_column.csv";
    assert_is_the_map(name, &read(name, ReadOptions::new()), &[]);
}

#[test]
fn blanks_before_one_line_are_no_cells() {
    let name = "leading_tabs.asc";
    let found = read(name, micrometres().lateral_unit("um".parse().unwrap()));
    assert_is_the_map(name, &found, &[]);
}

#[test]
fn numbers_may_stand_in_quotes() {
    assert_is_the_map("quoted.csv", &read("quoted.csv", micrometres().side(24e-6)), &[]);
}

/// The unit of the heights is stated, the side is not.
#[test]
fn a_stated_unit_is_used() {
    let name = "bruker_units.txt";
    assert_is_the_map(name, &read(name, ReadOptions::new().side(24e-6)), &[]);
    assert_eq!(read(name, ReadOptions::new()).cell, None);
    // Another one is used if it is asked for, but not in silence.
    note(&read(name, micrometres()), "nm");
}

#[test]
fn a_number_far_from_all_others_stands_for_missing() {
    let name = "marker_-9999.txt";
    let found = read(name, micrometres().side(24e-6));
    assert_is_the_map(name, &found, &[(0, 0), (4, 3), (11, 8)]);
    note(&found, "-9999");
    note(&found, "3 nodes");
}

#[test]
fn two_maps_in_one_text_are_refused() {
    let message = refusal("two_maps_blank_line.txt", micrometres().side(24e-6));
    assert!(message.contains("line 11") && message.contains("empty line"), "{message}");
}

#[test]
fn waves_of_wyko_are_lengths() {
    assert_is_the_map("wyko.asc", &read("wyko.asc", ReadOptions::new()), &[]);
}

#[test]
fn a_list_of_zygo_knows_its_pixels() {
    let name = "zygo_nodata.xyz";
    let found = read(name, ReadOptions::new());
    assert_is_the_map(name, &found, &[(0, 0), (4, 3), (11, 8)]);
}

#[test]
fn an_archive_may_call_its_root_by_the_name_of_the_standard() {
    let name = "root_iso5436.x3p";
    assert_is_the_map(name, &read(name, ReadOptions::new()), &[]);
}

#[test]
fn a_current_is_no_height() {
    let message = refusal("current_ampere.gsf", ReadOptions::new());
    assert!(message.contains("'A'") && message.contains("ampere"), "{message}");
    // A person who writes A means a length.
    let angstrom: LengthUnit = "A".parse().unwrap();
    assert_eq!(angstrom.metres(), 1e-10);
}

#[test]
fn points_on_no_grid_are_called_so() {
    let metre = ReadOptions::new().height_unit(LengthUnit::METRE).lateral_unit(LengthUnit::METRE);
    let message = refusal("scattered.xyz", metre);
    assert!(message.contains("200 points") && message.contains("no regular grid"), "{message}");
    assert!(!message.contains("more than 32768 different"), "{message}");
}

/// 64 of 400 nodes are finite: the rest is infinitely far away.
#[test]
fn infinite_heights_are_named() {
    let found = read("punch_inf.npy", ReadOptions::new().side(1e-3));
    assert_eq!((found.missing, found.heights.len()), (336, 400));
    note(
        &found,
        "336 heights are infinite, the first -inf at node (0, 0), and taken as missing, as",
    );
    let one =
        std::env::temp_dir().join(format!("asperity-one-infinite-{}.asc", std::process::id()));
    std::fs::write(&one, "1 2 3 4\n2 inf 4 5\n3 4 5 6\n").unwrap();
    let options = ReadOptions::new().height_unit(LengthUnit::METRE).side(1e-3);
    let options = options.layout(TextLayout::Matrix);
    let alone = options.read(&one);
    std::fs::remove_file(&one).unwrap();
    note(&alone.unwrap(), "1 height is infinite, inf at node (1, 1), and taken as missing, as");
    let warning = Warning::of_filling(found.missing, found.heights.len());
    assert!(matches!(warning, Some(Warning::Filled { filled: 336, nodes: 400 })));
}
