//! Cells that hold no number, and what parts them.

use super::{
    MISSING, TestResult, assert_refused, looks_like, matrix, numbers, parsed, parsed_with,
};
use crate::io::{ReadOptions, TextLayout};

/// Twelve rows of ten heights, of which `cell` is written in other words.
fn table(separator: &str, cell: impl Fn(usize, usize) -> Option<String>) -> String {
    let number =
        |x: usize, y: usize| format!("{}.{}", (x * x + 7 * y) % 10, (x * y * y + 3 * x) % 89 + 10);
    let row = |y: usize| (0..10).map(move |x| (x, y));
    let rows = (0..12).map(|y| {
        let cells: Vec<String> =
            row(y).map(|(x, y)| cell(x, y).unwrap_or_else(|| number(x, y))).collect();
        cells.join(separator) + "\n"
    });
    rows.collect()
}

fn with(word: &str, at: (usize, usize)) -> String {
    table(";", |x, y| (at == (x, y)).then(|| word.to_string()))
}

/// Sides, so that nothing else is in doubt.
const SIDES: &str = "# Width: 10 µm\n# Height: 12 µm\n";

/// What a spreadsheet writes in place of a number begins with the sign of remarks.
#[test]
fn errors_of_spreadsheets_are_no_remarks() -> TestResult {
    for word in ["#DIV/0!", "#VALUE!", "#NUM!", "#WERT!", "#NAME?", "########"] {
        for at in [(0, 5), (3, 5), (0, 0), (3, 0)] {
            let said = format!("'{word}' in line {} is no number", at.1 + 3);
            assert_refused(format!("{SIDES}{}", with(word, at)), &said);
        }
    }
    for word in ["#N/A", "#NV"] {
        for at in [(0, 5), (3, 5), (0, 0), (3, 0)] {
            let channel = parsed(format!("{SIDES}{}", with(word, at)))?;
            assert_eq!(channel.shape, (10, 12), "{word}");
            let missing = channel.values.iter().position(|z| z.is_nan());
            assert_eq!(missing, Some(10 * at.1 + at.0), "{word}");
        }
    }
    // Remarks, a row that was taken out, and an ornament.
    for remark in ["# second half", "#1;2;3;4", "########", "### part 2", "% 5 6 7 8"] {
        let text = format!("1;2;3;4\n{remark}\n5;6;7;8\n");
        assert_eq!(matrix(text)?.shape, (4, 2), "{remark}");
    }
    Ok(())
}

/// A row with a word in it is none of the header.
#[test]
fn words_in_the_first_rows_are_refused_as_in_others() -> TestResult {
    for separator in [";", "\t", " ", ", "] {
        let text = table(separator, |x, y| (x == 4 && y < 5).then(|| "Saturated".to_string()));
        assert_refused(text, "'Saturated' in line 5 is no number, but 9 of its 10 cells are");
    }
    let minus = parsed(format!("{SIDES}{}", with("\u{2212}3.1", (0, 0))))?;
    assert_eq!((minus.shape, minus.values[0]), ((10, 12), -3.1));
    // The corner of positions, names, and what has as many words, but few numbers.
    for header in ["y/x;0;1;2;3", "a;b;c;d;e", "map 1 of 2 by", "1;b;c;d;2"] {
        let text = format!("{header}\n3;1;4;1;5\n9;2;6;5;3\n5;8;9;7;9\n2;3;8;4;6\n");
        assert_eq!(matrix(text)?.shape, (5, 4), "{header}");
    }
    Ok(())
}

#[test]
fn thousands_parted_by_blanks_are_no_numbers() -> TestResult {
    for separator in [";", "\t"] {
        let text = table(separator, |x, y| Some(format!("{} {},5", x + 1, 200 + (y * x * 7) % 91)));
        assert_refused(text, "line 1 has 2 numbers in one cell, '1 200,5'");
    }
    let list = parsed_with(Some(TextLayout::Points), "a.xyz", "0;0;1 234,5\n1;0;2\n0;1;3\n1;1;4\n");
    assert!(list.is_err_and(|error| error.to_string().contains("in one cell, '1 234,5'")));
    Ok(())
}

/// A layout does not say what a comma is.
#[test]
fn decimal_commas_are_doubtful_in_every_layout() -> TestResult {
    let one = "1,5\n2,5\n3,7\n1,2\n0,3\n";
    let zeros = "1,05,2,07\n2,5,3,08\n1,25,4,01\n";
    let blanks = table(", ", |x, y| Some(format!("{},{}", x * x + 1, (x * y * 5) % 9 + 1)));
    for (text, said) in [
        (one, "each line has one comma"),
        (zeros, "begin with zeros, as what follows a decimal comma does"),
        (&blanks, "blanks follow some commas, but others stand within numbers"),
    ] {
        for layout in [None, Some(TextLayout::Matrix)] {
            let error = parsed_with(layout, "a.txt", text).map_err(|error| error.to_string());
            assert!(error.as_ref().is_err_and(|error| error.contains(said)), "{error:?}");
        }
    }
    // Numbers of one width, which leaves no room for blanks in some places.
    let aligned = "  1, 20,300,400\n 10,200,  3, 40\n100,  2, 30,  4\n  7,  8,  9,-10\n";
    assert_eq!(matrix(aligned)?.shape, (4, 4));
    assert_eq!(matrix(" 1,-2, 3,-4\n-5, 6,-7, 8\n")?.shape, (4, 2));
    Ok(())
}

/// An empty cell at the beginning of one row is a node, unless tabs are blanks.
#[test]
fn rows_of_other_lengths_are_refused() -> TestResult {
    let rows = "3;1;4;1\n9;2;6;5\n;3.323;0.226;-0.353;9.999\n5;8;9;7\n";
    assert_refused(rows, "line 3 has 5 numbers, but line 1 has 4");
    assert_refused(rows.replace(';', ","), "line 3 has 5 numbers, but line 1 has 4");
    let first = ";3.323;0.226;-0.353;9.999\n3;1;4;1\n9;2;6;5\n5;8;9;7\n";
    assert_refused(first, "line 2 has 4 numbers, but line 1 has 5");
    assert_eq!(matrix(rows.replace(';', "\t"))?.shape, (4, 4));
    Ok(())
}

/// A row without heights has as many cells as the others, wherever it stands; hyphens between blanks underline names.
#[test]
fn rows_of_hyphens_are_rows_between_signs() -> TestResult {
    for hyphens in ["---;---;---;---", "-;-;-;-"] {
        let (shape, values) = numbers(format!("{hyphens}\n1;2;3;4\n5;6;7;8\n"))?;
        assert_eq!((shape, &values[..4]), ((4, 3), &[MISSING; 4][..]), "{hyphens}");
    }
    assert_eq!(numbers("a b c d\n-- -- -- --\n1 2 3 4\n5 6 7 8\n")?.0, (4, 2));
    Ok(())
}

#[test]
fn empty_columns_beside_a_map_with_sides_are_noted() -> TestResult {
    let sides = "# Width: 3 m\n# Height: 4 m\n";
    let rows = ";3;1;4\n;9;2;6\n;5;8;9\n;2;3;8\n";
    let channel = parsed(format!("{sides}{rows}"))?;
    assert_eq!((channel.shape, channel.cell), ((3, 4), Some((1.0, 1.0))));
    assert!(channel.notes.len() == 1 && channel.notes[0].contains("an empty column at the left"));
    // So is a side that the user gives, of which only the reader of options knows.
    let options = ReadOptions::new().height_unit("um".parse()?).layout(TextLayout::Matrix);
    for (text, place) in
        [(rows, "an empty column at the left is"), ("3;1;4;\n9;2;6;\n5;8;9;\n2;3;8;\n", "right is")]
    {
        let unknown = options.read_bytes(text, "map.txt")?;
        assert!(unknown.notes.is_empty(), "{:?}", unknown.notes);
        let read = options.clone().side(3e-3).side_y(4e-3).read_bytes(text, "map.txt")?;
        assert_eq!(read.cell, Some((1e-3, 1e-3)));
        let said = format!("{place} not counted, unless NaN is written there");
        assert!(read.notes.len() == 1, "{:?}", read.notes);
        assert!(read.notes[0].starts_with("the side along x is that of the 3 columns"));
        assert!(read.notes[0].contains(&said), "{:?}", read.notes);
    }
    let counted = rows.replacen(';', "NaN;", 1);
    let counted = options.side(4e-3).side_y(4e-3).read_bytes(counted, "map.txt")?;
    assert_eq!((counted.heights.shape(), counted.notes.len()), ((4, 4), 0));
    Ok(())
}

/// The ground below a disc, and a plateau: only numbers that programs use as marks are no heights.
#[test]
fn a_repeated_number_far_from_all_others_stays_a_height() -> TestResult {
    let ground = |number: &str| {
        let is_ground = |x: usize, y: usize| (x + y).is_multiple_of(3);
        table(" ", |x, y| is_ground(x, y).then(|| number.to_string()))
    };
    let count = (0..120).filter(|k: &usize| (k % 10 + k / 10).is_multiple_of(3)).count();
    for number in ["-1e5", "123456.5"] {
        let channel = matrix(ground(number))?;
        let number: f64 = number.parse()?;
        assert_eq!(channel.values.iter().filter(|z| **z == number).count(), count);
        let said = format!("{count} nodes have the number {number:?}, ");
        assert!(channel.notes.len() == 1, "{:?}", channel.notes);
        assert!(channel.notes[0].starts_with(&said), "{:?}", channel.notes);
        // What the note advises.
        let line = format!("NODATA_value {number:?}");
        assert!(channel.notes[0].contains(&format!("write '{line}' in a line")));
        let marked = matrix(format!("{line}\n{}", ground(&number.to_string())))?;
        assert_eq!(marked.values.iter().filter(|z| z.is_nan()).count(), count);
        assert!(marked.notes.is_empty(), "{:?}", marked.notes);
    }
    for number in ["-9999", "32767", "-1e30", "3.4e38"] {
        let channel = matrix(ground(number))?;
        assert_eq!(channel.values.iter().filter(|z| z.is_nan()).count(), count, "{number}");
        assert!(channel.notes[0].contains("are taken as missing"), "{:?}", channel.notes);
    }
    Ok(())
}

/// DOS ends a text with a byte of its own; tabs before it are cells.
#[test]
fn the_end_of_a_text_of_dos_is_no_number() -> TestResult {
    let rows = "1\t2\t3\n4\t5\t\n7\t8\t9\n1\t2\t";
    for end in ["\x1a", "\r\n\x1a", "\r\n\x1a\x1a\r\n", "\n\x1a \n"] {
        let text = format!("{rows}{end}");
        assert!(looks_like(text.as_bytes()), "{end:?}");
        let (shape, values) = numbers(&text)?;
        assert_eq!((shape, values[11]), ((3, 4), MISSING), "{end:?}");
    }
    assert_refused("1 2 3 4\n5 \x1a 7 8\n", "in line 2 is no number");
    Ok(())
}

/// Numbers in quotes have the decimal sign of those without.
#[test]
fn quotes_change_no_decimal_sign() -> TestResult {
    let mixed = "\"1,5\";2,5;3,25;4\n5;6;\"7,25\";8\n";
    assert_eq!(numbers(mixed)?.1, [1.5, 2.5, 3.25, 4.0, 5.0, 6.0, 7.25, 8.0]);
    assert_refused("\"1,5\";2.5;3,25;4\n5;6;7;8\n", "line 1 has a decimal point");
    // Behind a comma that may part thousands all numbers have three digits, or one has others.
    for text in ["987.5,\"1,023\",998.25\n", "987,\"1,023\",\"998\"\n"] {
        assert_refused(text, "the comma of '1,023' in quotes parts thousands or is a decimal one");
    }
    assert_eq!(numbers("\"1,023\",NaN,\"-12,125\"\n")?.1, [1.023, MISSING, -12.125]);
    assert_eq!(numbers("\"1,023\",7,\"0,125\"\n")?.1, [1.023, 7.0, 0.125]);
    Ok(())
}
