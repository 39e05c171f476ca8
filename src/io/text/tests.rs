use std::path::Path;

use super::super::raw::Channel;
use super::*;
use crate::Error;
use crate::io::truth::assert_read;
use crate::io::{LengthUnit, ReadOptions};

type TestResult = Result<(), Box<dyn std::error::Error>>;

fn parsed_as(name: &str, text: impl AsRef<[u8]>) -> Result<Channel, Error> {
    let path = Path::new(name);
    parse(text.as_ref(), path)
        .map_err(|fault| fault.in_file(path, "text"))
        .map(|mut channels| channels.swap_remove(0))
}

fn parsed(text: impl AsRef<[u8]>) -> Result<Channel, Error> {
    parsed_as("test.txt", text)
}

/// Shape and values, with a number for NaN, which equals nothing.
fn numbers(text: impl AsRef<[u8]>) -> Result<((usize, usize), Vec<f64>), Error> {
    let channel = parsed(text)?;
    let values = channel.values.iter();
    let shown = values.map(|value| if value.is_nan() { MISSING } else { *value });
    Ok((channel.shape, shown.collect()))
}

const MISSING: f64 = 999.0;

fn assert_refused(text: impl AsRef<[u8]>, expected: &str) {
    let message = parsed(text).map_err(|error| error.to_string());
    assert!(
        message.as_ref().is_err_and(|text| text.contains(expected)),
        "{message:?} says nothing of '{expected}'"
    );
}

#[test]
fn the_map_of_every_file_is_that_of_its_formula() -> TestResult {
    let metres = ReadOptions::new().height_unit(LengthUnit::METRE);
    // Heights have seven digits in the files, all of which are zero from the fourth on: only the conversion rounds.
    let digits = 5e-16;
    let gwyddion = assert_read("plain_gwyddion.txt", &ReadOptions::new(), digits, true)?;
    assert_eq!(gwyddion.title, "made");
    assert_read("missing_matrix.asc", &metres, digits, false)?;
    assert_read("plain_semicolon_comma.csv", &metres, digits, false)?;
    let list = metres.lateral_unit(LengthUnit::METRE);
    let list = assert_read("missing.xyz", &list, digits, true)?;
    assert!(list.notes.is_empty(), "{:?}", list.notes);
    Ok(())
}

#[test]
fn rows_of_the_text_are_rows_of_the_map() -> TestResult {
    let channel = parsed("1 2 3 4\n5 6 7 8\n")?;
    assert_eq!(channel.shape, (4, 2));
    assert_eq!(channel.values, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]);
    assert_eq!((channel.cell, channel.height_unit), (None, None));
    Ok(())
}

#[test]
fn numbers_are_parted_by_many_things() -> TestResult {
    let expected = ((4, 2), vec![1.5, -2e3, 3.0, 0.25, 5.0, 6.0, 7.0, 8.0]);
    for text in [
        "1.5 -2e3 3 .25\n5 6 7 8",
        "  1.5   -2E+3\t3. 0.25  \r\n5 6 7 8\r\n\r\n",
        "1.5\t-2e3\t3\t.25\r5\t6\t7\t8\r",
        "1.5,-2e3,3,.25\n5,6,7,8\n",
        "1.5, -2e3, 3, .25\n5, 6, 7, 8\n",
        "1.5;-2e3;3;.25\n5;6;7;8\n",
        "1.5 ; -2e3\t;\t3;.25;\n5;6;7;8;\n",
        // A decimal comma where something else parts numbers.
        "1,5;-2e3;3;0,25\n5;6;7;8\n",
        "1,5\t-2e3\t3\t0,25\n5\t6\t7\t8\n",
        "1,5 -2e3 3 0,25\n5,0 6 7 8\n",
        // Margins, and what is no row.
        "\t1.5\t-2e3\t3\t.25\t\n\t5\t6\t7\t8\t\n\t\n",
        "\u{feff}% a remark\n1.5 -2e3 3 .25\n\n# another, with a comma; and more\n5 6 7 8",
        "a header of 2 lines,\n1 of which looks like numbers\n1.5 -2e3 3 .25\n5 6 7 8",
        "*****\n--- ---\n1.5 -2e3 3 .25\n5 6 7 8",
    ] {
        assert_eq!(numbers(text)?, expected, "{text:?}");
    }
    Ok(())
}

#[test]
fn missing_values_have_many_names() -> TestResult {
    for word in [
        "NaN",
        "nan",
        "-nan",
        "NAN",
        "inf",
        "-Inf",
        "+infinity",
        "BAD",
        "Bad",
        "***",
        "*****",
        "---",
        "--",
        "N/A",
        "na",
        "null",
        "1.#QNAN",
        "-1.#IND",
        "1.#INF00",
        "-nan(ind)",
        "#N/A",
    ] {
        let text = format!("1 2 {word} 4\n{word} 6 7 8\n");
        let channel = parsed(&text)?;
        assert_eq!(channel.shape, (4, 2), "{word}");
        for (k, value) in channel.values.iter().enumerate() {
            assert_eq!(!value.is_finite(), k == 2 || k == 4, "{word}: {value}");
        }
    }
    let expected = ((4, 2), vec![1.0, 2.0, MISSING, 4.0, 5.0, 6.0, 7.0, MISSING]);
    for text in [
        "1;2;;4\n5;6;7;\n",
        "1,2,,4\n5,6,7,",
        "1\t2\t\t4\n5\t6\t7\t\n",
        "1 ;2; ;4\n5;6;7; \n",
    ] {
        assert_eq!(numbers(text)?, expected, "{text:?}");
    }
    // A row, and a margin, of which nothing was measured.
    let row = numbers("1\t2\t3\t4\n\t\t\t\n5\t6\t7\t8\n")?;
    assert_eq!((row.0, row.1[4..8].to_vec()), ((4, 3), vec![MISSING; 4]));
    let row = numbers("1;2;3;4\n;;;\n5;6;7;8\n")?;
    assert_eq!((row.0, row.1[4..8].to_vec()), ((4, 3), vec![MISSING; 4]));
    let first = numbers("nan nan nan nan\n1 2 3 4\n")?;
    assert_eq!((first.0, first.1[..4].to_vec()), ((4, 2), vec![MISSING; 4]));
    Ok(())
}

#[test]
fn the_header_of_gwyddion_is_understood() -> TestResult {
    let numbers = "1 2 3 4\n5 6 7 8\n";
    for header in [
        "# Channel: Topography\n# Width: 8 µm\n# Height: 5 µm\n# Value units: nm\n",
        "# Kanal: Topography\n# Breite: 8,0 µm\n# Höhe: 5,0 µm\n# Werteinheiten: nm\n",
        "# Kanál: Topography\n# Šířka: 8 µm\n# Výška: 5 µm\n# Jednotky hodnot: nm\n",
        "# Canal : Topography\n# Largeur : 8 µm\n# Hauteur : 5 µm\n# Unités : nm\n",
        "# チャネル：Topography\n# 幅：8 µm\n# 高さ：5 µm\n# 値の単位：nm\n",
        "# Канал: Topography\n# Ширина: 8 µm\n# Высота: 5 µm\n# Единицы измерения: nm\n",
        "Channel = Topography\nWidth = 8.000µm\r\nHeight = 5e-3 mm\rValue units = nm\n",
    ] {
        let channel = parsed(format!("{header}{numbers}"))?;
        assert_eq!(channel.name, "Topography", "{header}");
        assert_eq!(channel.height_unit.as_deref(), Some("nm"), "{header}");
        assert_eq!(channel.lateral_unit.as_deref(), Some("µm"), "{header}");
        let (dx, dy) = channel.cell.ok_or("no cell")?;
        // A ratio of two units rounds.
        assert!(dx == 2.0 && (dy - 2.5).abs() < 1e-14, "{header}: {dx} {dy}");
    }
    let latin1 = b"# Width: 8 \xb5m\n# Height: 4 \xb5m\n# Value units: \xc5\n1 2 3 4\n5 6 7 8\n";
    let channel = parsed(latin1)?;
    assert_eq!(channel.lateral_unit.as_deref(), Some("µm"));
    assert_eq!(channel.height_unit.as_deref(), Some("Å"));
    assert_refused(
        "# Width: 8 V\n# Height: 4 A\n1 2 3 4\n",
        "the width in 'V', but the height in 'A'",
    );
    Ok(())
}

#[test]
fn factors_and_marks_of_other_headers_are_applied() -> TestResult {
    let channel = parsed(
        "h=2 w=4\npixel size=3.5e-007 m\ndata unit=rad\nheight conversion factor (-> m)=2.0e-008\n1 2 3 4\n5 6 7 8\n",
    )?;
    assert_eq!(channel.values[..2], [2e-8, 4e-8]);
    assert_eq!(channel.height_unit.as_deref(), Some("m"));
    assert_eq!(channel.cell, Some((3.5e-7, 3.5e-7)));
    let grid = "ncols 4\nnrows 1\nxllcorner 12.5\ncellsize 30\nNODATA_value -9999\n1 -9999 3 4\n";
    let channel = parsed(grid)?;
    assert!(channel.values[1].is_nan() && channel.values[0] == 1.0);
    assert_eq!(
        (channel.cell, channel.lateral_unit),
        (Some((30.0, 30.0)), None)
    );
    Ok(())
}

#[test]
fn a_list_of_points_is_read_in_any_order() -> TestResult {
    // z = 10 x + y on 3 x 2 nodes with spacings 2 and 5, one of them absent, one without height.
    let points = ["0 0 0", "2 0 20", "4 0 NaN", "0 5 5", "4 5 45"];
    let expected = [0.0, 20.0, MISSING, 5.0, MISSING, 45.0];
    for order in [
        [0, 1, 2, 3, 4],
        [0, 3, 1, 2, 4],
        [4, 3, 2, 1, 0],
        [2, 0, 4, 1, 3],
    ] {
        let text: String = order.iter().map(|k| format!("{}\n", points[*k])).collect();
        let channel = parsed(&text)?;
        assert_eq!((channel.shape, channel.cell), ((3, 2), Some((2.0, 5.0))));
        assert_eq!(channel.height_unit, None);
        assert_eq!(channel.lateral_unit, None);
        for (found, expected) in channel.values.iter().zip(expected) {
            assert!(*found == expected || found.is_nan() && expected == MISSING);
        }
        assert_eq!(parsed_as("test.XYZ", &text)?.shape, (3, 2));
    }
    Ok(())
}

#[test]
fn names_of_columns_tell_a_list_and_its_units() -> TestResult {
    let points = "0 0 0\n2 0 20\n0 5 5\n2 5 25\n";
    for (header, lateral, vertical) in [
        ("x y z", None, None),
        ("# X [µm], Y [µm], Z [nm]", Some("µm"), Some("nm")),
        ("\"x (mm)\";\"y (mm)\";\"z (µm)\"", Some("mm"), Some("µm")),
        ("x_um,y_um,height_nm", Some("um"), Some("nm")),
        (
            "X Position in mm  Y Position in mm  Z in in",
            Some("mm"),
            Some("in"),
        ),
        ("x/mm y/m z/m", None, Some("m")),
        (
            "# Channel: a\n# Lateral units: µm\n# Value units: nm",
            Some("µm"),
            Some("nm"),
        ),
    ] {
        let channel = parsed(format!("{header}\n{points}"))?;
        assert_eq!(channel.shape, (2, 2), "{header}");
        assert_eq!(channel.lateral_unit.as_deref(), lateral, "{header}");
        assert_eq!(channel.height_unit.as_deref(), vertical, "{header}");
    }
    let coloured = parsed("X Y Z R G B\n0 0 7 1 1 1\n0 1 8 1 1 1\n1 0 9 1 1 1\n1 1 6 1 1 1\n")?;
    assert_eq!(coloured.values, [7.0, 9.0, 8.0, 6.0]);
    assert_eq!(coloured.notes.len(), 1);
    // Sides belong to a matrix, of however few columns.
    let sides = "# Width: 3 m\n# Height: 4 m\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n";
    assert_eq!(parsed(sides)?.shape, (3, 4));
    Ok(())
}

#[test]
fn a_list_without_units_needs_both() -> TestResult {
    let path = std::env::temp_dir().join(format!("asperity-units-{}.xyz", std::process::id()));
    std::fs::write(&path, "0 0 0\n2 0 20\n0 5 5\n2 5 25\n")?;
    let nothing = ReadOptions::new().read(&path);
    let heights = ReadOptions::new().height_unit("nm".parse()?);
    let one = heights.clone().read(&path);
    let both = heights.lateral_unit("mm".parse()?).read(&path);
    std::fs::remove_file(&path)?;
    let message = |result: Result<_, Error>| {
        result
            .map(|_: crate::io::MeasuredSurface| ())
            .map_err(|e| e.to_string())
    };
    assert!(message(nothing).is_err_and(|text| text.contains("height_unit")));
    assert!(message(one).is_err_and(|text| text.contains("lateral_unit")));
    // A product with the unit rounds.
    let (dx, dy) = both?.cell.ok_or("no cell")?;
    assert!((dx / 2e-3 - 1.0).abs() < 1e-15 && (dy / 5e-3 - 1.0).abs() < 1e-15);
    Ok(())
}

#[test]
fn coordinates_may_be_rounded_but_not_scattered() -> TestResult {
    let list = |x: &dyn Fn(usize) -> String| -> String {
        (0..60)
            .map(|k| format!("{} {} {k}\n", x(k % 20), k / 20))
            .collect()
    };
    // Thirds with five digits are 3e-5 off at most, with two 0.03.
    let fine = parsed(list(&|k| format!("{:.5}", k as f64 / 3.0)))?;
    assert_eq!((fine.shape, fine.notes.len()), ((20, 3), 0));
    let coarse = parsed(list(&|k| format!("{:.2}", k as f64 / 3.0)))?;
    assert_eq!((coarse.shape, coarse.notes.len()), ((20, 3), 1));
    let dx = coarse.cell.ok_or("no cell")?.0;
    // The last coordinate, 6.33, is 0.0033 too small.
    assert!((dx * 19.0 - 6.33).abs() < 1e-14);
    assert_refused(
        list(&|k| format!("{:.1}", k as f64 / 3.0)),
        "not evenly spaced",
    );
    assert_refused(
        list(&|k| (k * k).to_string()),
        "x is not evenly spaced: it has 20 different values",
    );
    // Coordinates of an encoder that trembles.
    let trembling: String = (0..60)
        .map(|k| {
            format!(
                "{} {} {k}\n",
                (k % 20) as f64 + 1e-4 * (k as f64).sin(),
                k / 20
            )
        })
        .collect();
    assert_eq!(parsed(&trembling)?.shape, (20, 3));
    Ok(())
}

#[test]
fn what_is_no_grid_is_refused() {
    for (text, expected) in [
        (
            "0 0 1\n1 0 2\n0 1 3\n1 1 4\n1 1 5\n",
            "point 5 at x = 1, y = 1 is not the first",
        ),
        (
            "0 0 1\n0 1 2\n0 2 3\n0 3 4\n",
            "all points have x = 0: a profile",
        ),
        ("0 0 1\nNaN 0 2\n0 1 3\n1 1 4\n", "point 2 has no x"),
        ("1 2\n2 3\n3 4\n4 5\n", "are a profile"),
        ("1\n2\n3\n4\n", "are a profile"),
        ("0 0 1\n1 0 1\n0 1 1\n.3 .7 1\n", "'# Width: 1 mm'"),
    ] {
        assert_refused(text, expected);
    }
    // A diagonal of 100 points on 100 x 100 nodes, and one that no grid can hold.
    let diagonal =
        |count: usize| -> String { (0..count).map(|k| format!("{k} {k} 1\n")).collect() };
    assert_refused(
        diagonal(100),
        "a grid of 100 x 100 nodes would be needed for the 100 points",
    );
    assert_refused(diagonal(40_000), "more than 32768 different values");
    let two = parsed_as("two.xyz", "1 2\n3 4\n").map_err(|error| error.to_string());
    assert!(two.is_err_and(|text| text.contains("has three columns")));
    let extreme = parsed_as("test.xyz", "-1e308 0 1\n1e308 0 1\n0 1 1\n5e-324 1 1\n");
    assert!(matches!(extreme, Err(Error::BadFile { .. })));
}

#[test]
fn defects_are_named_with_their_line() {
    for (text, expected) in [
        (
            "# a\n1 2 3 4\n\n5 6 7\n",
            "line 4 has 3 numbers, but line 2 has 4",
        ),
        (
            "1;2;3;4\n5;6;7;8;9\n",
            "line 2 has 5 numbers, but line 1 has 4",
        ),
        ("1 2 3 4\r\n5 6 x 8\r\n", "'x' in line 2 is no number"),
        (
            "1.000,5;2;3;4\n5;6;7;8\n",
            "'1.000,5' in line 1 is no number",
        ),
        (
            "1 2 3 4\n# Channel: b\n5 6 7 8\n",
            "line 2 begins another map",
        ),
        (
            "Dear reader,\nthere are no numbers here.\n",
            "no line in it that consists",
        ),
        ("", "no line in it that consists"),
        ("\u{feff}", "no line in it that consists"),
    ] {
        assert_refused(text, expected);
    }
    assert_refused(b"\xff\xfe1\0 \x002\0\n\0", "UTF-16");
    let long = format!("1;2;3;4\n5;6;7;{}\n", "8,".repeat(1000));
    assert_refused(long, "in line 2 is no number");
    let wide = "1 ".repeat(40_000);
    assert!(matches!(parsed(wide), Err(Error::GridTooLarge { .. })));
}

#[test]
fn text_is_told_from_other_bytes() {
    for text in ["", "1 2 3\n", "# Höhe\r\n\t1\x0c", "\u{feff}1"] {
        assert!(looks_like(text.as_bytes()), "{text:?}");
    }
    assert!(looks_like(b"# 5 \xb5m\n1 2\n") && looks_like(b"\xff\xfe1\0"));
    for bytes in [&b"1 2\0 3"[..], b"\x01\x02\x03", b"abc\x1b\x07\x08"] {
        assert!(!looks_like(bytes), "{bytes:?}");
    }
}
