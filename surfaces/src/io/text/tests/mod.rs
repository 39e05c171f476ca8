mod cells;
mod headers;
mod points;
mod profiles;

use std::path::Path;

use proptest::prelude::*;

use super::super::raw::Channel;
use super::*;
use crate::Error;
use crate::io::testing::{self, MISSING, TestResult, only, shown};

/// Most texts here are so short that only the user can know what they are.
const MATRIX: Option<TextLayout> = Some(TextLayout::Matrix);

fn parsed_with(
    layout: Option<TextLayout>,
    name: &str,
    text: impl AsRef<[u8]>,
) -> Result<Channel, Error> {
    let path = Path::new(name);
    only(parse(text.as_ref(), path, layout)).map_err(|fault| fault.in_file(path, "text"))
}

fn parsed_as(name: &str, text: impl AsRef<[u8]>) -> Result<Channel, Error> {
    parsed_with(None, name, text)
}

fn parsed(text: impl AsRef<[u8]>) -> Result<Channel, Error> {
    parsed_as("test.txt", text)
}

fn matrix(text: impl AsRef<[u8]>) -> Result<Channel, Error> {
    parsed_with(MATRIX, "test.txt", text)
}

/// Shape and values.
fn numbers(text: impl AsRef<[u8]>) -> Result<((usize, usize), Vec<f64>), Error> {
    let channel = matrix(text)?;
    Ok((channel.shape, shown(&channel, |value| value)))
}

fn assert_refused(text: impl AsRef<[u8]>, expected: &str) {
    testing::assert_refused(parse(text.as_ref(), Path::new("test.txt"), None), expected);
}

#[test]
fn rows_of_the_text_are_rows_of_the_map() -> TestResult {
    let channel = matrix("1 2 3 4\n5 6 7 8\n")?;
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
    let words = "NaN nan -nan NAN inf -Inf +infinity BAD Bad *** ***** --- -- N/A na null 1.#QNAN -1.#IND 1.#INF00 \
        -nan(ind) #N/A";
    for word in words.split(' ') {
        let text = format!("1 2 {word} 4\n{word} 6 7 8\n");
        let channel = matrix(&text)?;
        assert_eq!(channel.shape, (4, 2), "{word}");
        for (k, value) in channel.values.iter().enumerate() {
            assert_eq!(!value.is_finite(), k == 2 || k == 4, "{word}: {value}");
        }
    }
    let expected = ((4, 2), vec![1.0, 2.0, MISSING, 4.0, 5.0, 6.0, 7.0, MISSING]);
    for text in
        ["1;2;;4\n5;6;7;\n", "1,2,,4\n5,6,7,", "1\t2\t\t4\n5\t6\t7\t\n", "1 ;2; ;4\n5;6;7; \n"]
    {
        assert_eq!(numbers(text)?, expected, "{text:?}");
    }
    // A row, and a margin, of which nothing was measured.
    for text in ["1\t2\t3\t4\n\t\t\t\n5\t6\t7\t8\n", "1;2;3;4\n;;;\n5;6;7;8\n"] {
        let row = numbers(text)?;
        assert_eq!((row.0, row.1[4..8].to_vec()), ((4, 3), vec![MISSING; 4]));
    }
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
    let latin1 = b"# Width: 8 \xb5m\n# Height: 7 \xb5m\n# Value units: \xc5\n1 2 3 4\n5 6 7 8\n";
    let channel = parsed(latin1)?;
    assert_eq!(channel.lateral_unit.as_deref(), Some("µm"));
    assert_eq!(channel.height_unit.as_deref(), Some("Å"));
    assert_refused(
        "# Width: 8 V\n# Height: 4 A\n3 1 4 1 5\n9 2 6 5 3\n5 8 9 7 9\n2 3 8 4 6\n",
        "the width in 'V', but the height in 'A'",
    );
    Ok(())
}

#[test]
fn factors_and_marks_of_other_headers_are_applied() -> TestResult {
    let channel = parsed(
        "h=2 w=4\npixel size=3.5e-007 m\ndata unit=rad\nheight conversion factor (-> m)=2.0e-008\n1 2 3 4\n5 6 7 8\n",
    )?;
    assert_eq!((&channel.values[..2], channel.factor), (&[1.0, 2.0][..], 2e-8));
    assert_eq!(channel.height_unit.as_deref(), Some("m"));
    assert_eq!(channel.cell, Some((3.5e-7, 3.5e-7)));
    let grid = "ncols 4\nnrows 1\nxllcorner 12.5\ncellsize 30\nNODATA_value -9999\n1 -9999 3 4\n";
    let channel = parsed(grid)?;
    assert!(channel.values[1].is_nan() && channel.values[0] == 1.0);
    assert_eq!((channel.cell, channel.lateral_unit), (Some((30.0, 30.0)), None));
    let with_unit = parsed(grid.replace("cellsize 30", "cellsize 30 mm"))?;
    assert_eq!((with_unit.cell, with_unit.lateral_unit.as_deref()), (channel.cell, Some("mm")));
    assert_eq!(with_unit.understood, channel.understood);
    Ok(())
}

#[test]
fn defects_are_named_with_their_line() {
    for (text, expected) in [
        ("# a\n1 2 3 4\n\n5 6 7\n", "line 4 has 3 numbers, but line 2 has 4"),
        ("1;2;3;4\n5;6;7;8;9\n", "line 2 has 5 numbers, but line 1 has 4"),
        ("1 2 3 4\r\n5 6 x 8\r\n", "'x' in line 2 is no number"),
        ("1.000,5;2;3;4\n5;6;7;8\n", "'1.000,5' in line 1 is no number"),
        ("1 2 3 4\n# Channel: b\n5 6 7 8\n", "line 2 begins another map"),
        ("Dear reader,\nthere are no numbers here.\n", "no line in it that consists"),
        ("", "no line in it that consists"),
        ("\u{feff}", "no line in it that consists"),
    ] {
        assert_refused(text, expected);
    }
    assert_refused(b"\xff\xfe1\0 \x002\0\n\0", "UTF-16");
    let long = format!("1;2;3;4\n5;6;7;{}\n", "8,".repeat(1000));
    assert_refused(long, "in line 2 is no number");
    let wide = "1 ".repeat(40_000);
    assert!(matches!(matrix(wide), Err(Error::GridTooLarge { .. })));
}

/// A plane, a few rows, a column that may be one of positions, or one comma a line: nobody can tell but the user.
#[test]
fn what_can_be_read_in_two_ways_is_refused_with_both() -> TestResult {
    let plane = "0 1 2 3 4\n1 2 3 4 5\n2 3 4 5 6\n3 4 5 6 7\n4 5 6 7 8\n";
    assert_refused(
        plane,
        "'matrix', 5 rows of 5 heights; 'x-row', 4 rows of 5 heights below a row of positions",
    );
    assert_refused(plane, "choose one with `ReadOptions::layout`");
    assert_refused("3 1 4 1 5\n9 2 6 5 3\n", "'y-column', 2 rows of 4 heights beside a column");
    assert_refused("# Width: 1 m\n# Height: 2 m\n0,5\n1,5\n", "one with a decimal comma");
    // What follows decimal commas, not heights; two numbers could also be one.
    let commas = "1,25,0,007\n0,5,2,25\n";
    assert_refused(commas, "begin with zeros, as what follows a decimal comma does");
    assert_eq!(matrix("1,-0.25,0,0.5\n")?.values, [1.0, -0.25, 0.0, 0.5]);
    assert_refused("7", "one number is no surface");
    let shapes = [
        (TextLayout::Matrix, (5, 5), 0.0),
        (TextLayout::RowOfX, (5, 4), 1.0),
        (TextLayout::ColumnOfY, (4, 5), 1.0),
        (TextLayout::Axes, (4, 4), 2.0),
    ];
    for (layout, shape, first) in shapes {
        let channel = parsed_with(Some(layout), "plane.txt", plane)?;
        assert_eq!((channel.shape, channel.values[0]), (shape, first), "{layout}");
    }
    let points = parsed_with(Some(TextLayout::Points), "a.txt", "0 0 5\n1 0 6\n0 1 7\n")?;
    assert_eq!(shown(&points, |z| z), [5.0, 6.0, 7.0, MISSING]);
    // The header says how many columns there are: then the first is one of positions.
    let counted = parsed("nx = 4\nny = 2\n3 1 4 1 5\n9 2 6 5 3\n")?;
    assert_eq!(counted.values, [1.0, 4.0, 1.0, 5.0, 2.0, 6.0, 5.0, 3.0]);
    Ok(())
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

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    /// Whatever stands in a text, it gives a value for every node, or an error.
    #[test]
    fn any_text_is_a_map_or_an_error(text in "([0-9xyzNa#%:.,;\t \n-]|1\n|[xyz] |1 |2;|# Width: 2 m\n){0,80}") {
        for name in ["test.txt", "test.xyz"] {
            if let Ok(channel) = parsed_as(name, &text) {
                prop_assert_eq!(channel.values.len(), channel.shape.0 * channel.shape.1);
            }
        }
    }
}
