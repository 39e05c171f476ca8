//! What lines above the numbers say of them.

use super::{MISSING, TestResult, assert_refused, matrix, parsed, shown};
use crate::io::ReadOptions;

/// Four rows of four heights that are those of no positions and no points.
const ROWS: &str = "1.5 4.25 1 5\n2 6.5 2 8\n5 8 9.75 3\n1 2 9 4\n";

/// A factor may have a unit behind it and a decimal comma; without a number the heights would be wrong by any factor.
#[test]
fn factors_are_used_or_refused() -> TestResult {
    let sides = "# Width: 1 µm\n# Height: 1 µm\n";
    for (line, factor) in [
        ("# Height conversion factor (->nm): 2.5 nm/LSB", 2.5),
        ("# Height conversion factor (->nm): 2.5e-1", 0.25),
        ("# Bit2nm: 0,01234 nm", 0.01234),
        // The factor of a unit stays with it, and a range without a unit names none.
        ("# Height conversion factor (->nm): 2.5\n# Z unit: m\n# Z Amplitude: 9 m", 2.5),
        ("# Bit2nm: 3\n# Height conversion factor (->nm): 2.5\n# Z unit: m", 2.5),
        ("# Value units: nm\n# Z Amplitude: 9", 1.0),
    ] {
        let channel = parsed(format!("{line}\n{sides}{ROWS}"))?;
        assert_eq!((channel.values[0], channel.factor), (1.5, factor), "{line}");
        assert_eq!(channel.height_unit.as_deref(), Some("nm"), "{line}");
    }
    for (key, value) in [
        ("height conversion factor (->nm)", "1,234.5"),
        ("height conversion factor (->nm)", "ca. 2"),
        ("bit2nm", "unknown"),
    ] {
        let said = format!("multiplied by '{key}', but '{value}' does not begin with a number");
        assert_refused(format!("# {key}: {value}\n{sides}{ROWS}"), &said);
    }
    Ok(())
}

fn assert_refused_unit(text: String, unit: &str) {
    let refused = ReadOptions::new().read_bytes(text, "list.csv").err();
    assert!(refused.as_ref().is_some_and(|error| error.to_string().contains(unit)), "{refused:?}");
}

/// A number before the unit in a name would be a factor, which is not read: it is no part that may be left out.
#[test]
fn factors_in_names_are_refused() -> TestResult {
    let list = |name: &str| format!("x [mm];y [mm];{name}\n0;0;1\n1;0;2\n0;1;3\n1;1;5\n");
    for (name, unit) in [
        ("Z x1000 um", "x1000 um"),
        ("Z 0.1 nm", "0.1 nm"),
        ("z / 10 nm", "10 nm"),
        ("z (x 10 nm)", "10 nm"),
        ("z (0.1 nm)", "0.1 nm"),
    ] {
        assert_refused_unit(list(name), unit);
    }
    for name in ["Z2 nm", "z nm", "z1 (nm)", "Z [nm]", "z2_nm"] {
        let read = ReadOptions::new().read_bytes(list(name), "list.csv")?;
        assert_eq!(read.heights[(1, 1)], 5e-9, "{name}");
    }
    Ok(())
}

/// Along y there may be another unit.
#[test]
fn a_unit_along_y_is_read() -> TestResult {
    let units = "# x unit: mm\n# y unit: um\n# z unit: nm\n";
    for text in [
        format!("{units}# Width: 4\n# Height: 4000\n{ROWS}"),
        format!("{units}# Width: 4 mm\n# Height: 4000\n{ROWS}"),
        format!("{units}x y z\n0 0 1\n1 0 2\n0 1000 3\n1 1000 5\n"),
    ] {
        let read = ReadOptions::new().read_bytes(&text, "map.txt")?;
        let (dx, dy) = read.cell.unwrap_or_default();
        assert!((dx / 1e-3 - 1.0).abs() < 1e-15 && (dy / 1e-3 - 1.0).abs() < 1e-15, "{text}");
    }
    let square = format!("{units}# Pixel size: 2\n{ROWS}");
    assert_eq!(ReadOptions::new().read_bytes(square, "map.txt")?.cell, Some((2e-3, 2e-3)));
    Ok(())
}

/// Another unit of the numbers takes the place of that in the file together with its factor, and that is said.
#[test]
fn a_unit_that_is_given_leaves_no_factor() -> TestResult {
    for (line, unit, metres, said) in [
        ("Height conversion factor (->m): 1e-9", "nm", 1e-9, "'1e-9 m'"),
        ("Bit2nm: 2", "um", 1e-6, "'2.0 nm'"),
        ("Bit2nm: 2", "nm", 1e-9, "'2.0 nm'"),
    ] {
        let options = ReadOptions::new().height_unit(unit.parse()?);
        let text = format!("# {line}\n# Width: 1 µm\n# Height: 1 µm\n{ROWS}");
        let measured = options.read_bytes(text, "map.txt")?;
        assert_eq!(measured.heights[(0, 0)], 1.5 * metres, "{line}");
        assert!(measured.notes[0].ends_with(said), "{:?}", measured.notes);
    }
    Ok(())
}

/// 1,250 is 1.25 or 1250: only numbers with decimal commas say that it is the former.
#[test]
fn a_comma_before_three_digits_may_part_thousands() -> TestResult {
    let sides = |width: &str| format!("# Width: {width} µm\n# Height: 1,000 µm\n");
    let said = "the header has '1,250 µm', whose comma parts thousands or is a decimal one";
    assert_refused(format!("{}{ROWS}", sides("1,250")), said);
    assert_refused(format!("{}{}", sides("1,250"), ROWS.replace('.', "")), said);
    let commas = ROWS.replace('.', ",");
    assert_eq!(parsed(format!("{}{commas}", sides("1,250")))?.cell, Some((1.25 / 4.0, 0.25)));
    // What can only be decimal.
    for (width, dx) in [("0,250", 0.0625), ("1,25", 0.3125), ("12,5000", 3.125)] {
        let channel = parsed(format!("# Width: {width} µm\n# Height: 1 µm\n{ROWS}"))?;
        assert_eq!(channel.cell.map(|cell| cell.0), Some(dx), "{width}");
    }
    Ok(())
}

#[test]
fn lines_whose_value_cannot_be_read_are_named() -> TestResult {
    for line in ["Width: 1.250,5 µm", "Width: ca. 12 µm", "Pixel size: small", "nx: four"] {
        let channel = matrix(format!("# {line}\n{ROWS}"))?;
        assert_eq!(channel.cell, None, "{line}");
        let said = format!("a line above them is not used: '{line}'");
        assert!(channel.understood.contains(&said), "{}", channel.understood);
    }
    Ok(())
}

/// Sides from the first position to the last are those of one cell less than there are nodes.
#[test]
fn steps_of_positions_say_whether_sides_end_at_nodes() -> TestResult {
    let table = "0 10 11 12 13 14\n10 3 1 4 1 5\n11 9 2 6 5 3\n12 5 8 9 7 9\n13 2 3 8 4 6\n";
    let sides = |x: f64, y: f64| format!("# Width: {x} mm\n# Height: {y} mm\n{table}");
    for (header, notes) in [(sides(4.0, 3.0), 3), (sides(5.0, 4.0), 2), (sides(4.0, 4.0), 3)] {
        let channel = parsed(&header)?;
        assert_eq!((channel.shape, channel.cell), ((5, 4), Some((1.0, 1.0))), "{header}");
        assert_eq!(channel.notes.len(), notes, "{:?}", channel.notes);
    }
    // Many positions, whose steps the sides of both kinds are close to.
    let row = |y: usize| (0..100).map(move |x| format!(" {}", x * x * (y + 3) % 101));
    let rows = (0..3).map(|y| row(y).collect::<String>() + "\n");
    let axis: String = (0..100).map(|x| format!(" {}", 2 * x + 7)).collect();
    let text = format!("# Width: 198 m\n# Height: 6 m\n{axis}\n{}", rows.collect::<String>());
    assert_eq!(parsed(text)?.cell, Some((2.0, 2.0)));
    Ok(())
}

/// A mark is written with as many digits as its program likes, and may not be the only one.
#[test]
fn stated_marks_may_be_rounded_and_others_count_too() -> TestResult {
    let expected = [MISSING, 4.25, MISSING, 5.0];
    for (mark, written) in [("-3.4028234663852886e+38", "-3.402823e+38"), ("-32768", "-9999")] {
        let rows = ROWS.replacen("1.5", written, 1).replacen(" 1 ", &format!(" {mark} "), 1);
        let channel = matrix(format!("NODATA_value {mark}\n{rows}"))?;
        assert_eq!(shown(&channel, |z| z)[..4], expected, "{mark}");
    }
    Ok(())
}

/// SPIP writes 1 for each height that was measured, and 0 for each that was not, behind all heights.
#[test]
fn void_heights_of_spip_are_marked() -> TestResult {
    let head = |count: usize| {
        format!(
            "# File Format = ASCII\n# x-pixels = 4\n# y-pixels = 4\n# x-length = 4000\n# y-length = 4000\n\
             # z-unit = nm\n# voidpixels = {count}\n# Start of Data:\n"
        )
    };
    let mask = "1 1 1 0\n1 1 1 1\n1 1 1 1\n0 1 1 1\n";
    for between in ["", "\n", "# valid\n"] {
        let text = format!("{}{ROWS}{between}{mask}", head(2));
        let read = ReadOptions::new().read_bytes(&text, "map.asc")?;
        assert_eq!((read.heights.shape(), read.missing), ((4, 4), 2), "{between:?}");
        assert!(read.heights[(3, 0)].is_nan() && read.heights[(0, 3)].is_nan());
        assert_eq!(read.notes, ["2 nodes that a mask marks are taken as missing"]);
        let all = ReadOptions::new().ignore_mask().read_bytes(&text, "map.asc")?;
        assert_eq!((all.missing, all.heights[(3, 0)]), (0, 5e-9));
    }
    let none = parsed(format!("{}{ROWS}", head(0)))?;
    assert_eq!((none.shape, none.notes.len(), none.mask), ((4, 4), 0, None));
    let lone = parsed(format!("{}{ROWS}", head(2)))?;
    let said = "2 of the heights are void, but no rows behind them say which";
    assert!(lone.shape == (4, 4) && lone.notes.iter().any(|note| note.contains(said)));
    let doubtful = mask.replacen('1', "0.5", 1);
    for text in [
        format!("{}{ROWS}{doubtful}", head(2)),
        format!("{}{ROWS}1 1 1 0\n", head(2)),
        format!("{}{ROWS}{mask}", head(2).replace("# x-pixels = 4\n", "")),
    ] {
        assert_refused(
            text,
            "the header says that 2 of the heights are void: it has to say as well",
        );
    }
    Ok(())
}

/// A file may have anything in it, and be of any length.
#[test]
fn texts_of_files_are_shown_in_part() {
    let long = "z".repeat(1000);
    for text in [
        format!("x;y;{long};{long}\n0;0;1;1;1\n"),
        format!("# Width: 1 m {long}\n1\n2\n3\n4\n"),
        format!("# Bit2nm: {long}\n1 2 3\n"),
        format!("x;y;z {long};z {long}\n0;0;1;1\n1;0;1;1\n"),
        format!("1;2;3 4{long}\n").replace('z', "1"),
    ] {
        let refused = parsed(&text).map_err(|error| error.to_string());
        assert!(refused.as_ref().is_err_and(|said| said.len() < 600), "{refused:?}");
    }
}

/// Texts of two makers, which know their layout, and one that is not read.
#[test]
fn texts_of_instruments_are_named() -> TestResult {
    let wyko = "Wyko ASCII Data File Format 0 0 1\nX Size\t1\t2\t2\nY Size\t1\t2\t2\nWavelength\t7\t4\t500\n\
                Mult\t6\t2\t1\nRAW_DATA\n1 2\n3 4\n";
    let channel = parsed(wyko)?;
    assert!(channel.notes.is_empty());
    assert_eq!((channel.factor, channel.height_unit.as_deref()), (500.0, Some("nm")));
    let noted = matrix(wyko)?.notes;
    assert!(noted.len() == 1 && noted[0].contains("the layout 'matrix' is not used"), "{noted:?}");
    let dark = super::parse(wyko.replace("500", "0").as_bytes(), "a.asc".as_ref(), None);
    let said = "Wavelength is 0, but a positive number was expected";
    assert!(
        matches!(dark, Err(super::Fault::Malformed { offset: None, reason }) if reason == said)
    );
    assert_refused("Zygo ASCII Data File - Format 2\n0 0 0 0 \"\"\n1 2 3\n", "which is not read");
    Ok(())
}

#[test]
fn an_ornament_is_unused_but_a_row_is_not() -> TestResult {
    let channel = matrix(format!("****\n* * * *\n{ROWS}"))?;
    assert_eq!(channel.shape, (4, 5));
    assert!(channel.understood.ends_with("a line above them is not used: '****'"));
    Ok(())
}
