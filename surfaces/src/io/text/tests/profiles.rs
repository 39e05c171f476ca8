//! Profiles: one column, or two.

use super::{MISSING, TestResult, assert_refused, matrix, parsed, shown};
use crate::io::ReadOptions;

#[test]
fn columns_are_profiles() -> TestResult {
    // One column has no positions.
    let channel = parsed("1\n2\n\n4\n8\n".replace("\n\n", "\n"))?;
    assert_eq!((channel.shape, channel.cell), ((4, 1), None));
    assert_eq!(shown(&channel, |z| z), [1.0, 2.0, 4.0, 8.0]);
    // Two have, in any unit and from either end.
    for text in ["0 5\n0.5 6\n1 NaN\n1.5 8\n", "1.5 8\n1 NaN\n0.5 6\n0 5\n"] {
        let channel = parsed(text)?;
        assert_eq!((channel.shape, channel.cell), ((4, 1), Some((0.5, 0.5))));
        assert_eq!(shown(&channel, |z| z), [5.0, 6.0, MISSING, 8.0]);
        assert!(channel.notes.is_empty(), "{:?}", channel.notes);
    }
    let named = "# x [mm]; z [µm]\n0;5\n0.5;6\n1;7\n1.5;9\n";
    let measured = ReadOptions::new().read_bytes(named, "profile.csv")?;
    assert_eq!(measured.cell, Some((0.5e-3, 0.5e-3)));
    for (height, micrometres) in measured.heights.iter().zip([5.0, 6.0, 7.0, 9.0]) {
        assert!((height / (1e-6 * micrometres) - 1.0).abs() < 1e-15, "{height}");
    }
    assert!(measured.understood.starts_with("a profile of 4 points, a position and a height"));
    Ok(())
}

/// Called x and y as on paper, and with the empty rows that spreadsheets write below.
#[test]
fn profiles_of_spreadsheets_are_read() -> TestResult {
    for names in ["X (mm);Y (um)", "x [mm]; y [um]", "x [mm];z [um]"] {
        for end in ["", ";\n", ";\n;\n;\n"] {
            let text = format!("{names}\n0;5\n0.5;6\n1;7\n1.5;9\n{end}");
            let measured = ReadOptions::new().read_bytes(&text, "profile.csv")?;
            assert_eq!((measured.heights.shape(), measured.cell), ((4, 1), Some((5e-4, 5e-4))));
            assert!((measured.heights[(3, 0)] / 9e-6 - 1.0).abs() < 1e-15, "{text}");
        }
    }
    Ok(())
}

/// Names say which of two columns has the positions.
#[test]
fn heights_may_stand_before_positions() -> TestResult {
    let rows = "5;0\n6;0.5\n7;1\n9;1.5\n";
    for names in ["# z [µm]; x [mm]", "height [µm];x [mm]"] {
        let channel = parsed(format!("{names}\n{rows}"))?;
        assert_eq!((channel.shape, channel.cell), ((4, 1), Some((0.5, 0.5))), "{names}");
        assert_eq!(channel.values, [5.0, 6.0, 7.0, 9.0], "{names}");
        let units = [channel.height_unit.as_deref(), channel.lateral_unit.as_deref()];
        assert_eq!(units, [Some("µm"), Some("mm")], "{names}");
    }
    Ok(())
}

/// A unit of heights overrules `Bit2nm`, on whichever line it stands; without one it counts.
#[test]
fn units_overrule_bit2nm() -> TestResult {
    let lines = ["# Bit2nm = 0.5\n", "# z-unit = nm\n"];
    for (head, step) in [
        (lines.concat(), 1e-9),
        ([lines[1], lines[0]].concat(), 1e-9),
        (lines[0].to_string(), 0.5e-9),
    ] {
        let text = format!("{head}# Width = 2 um\n# Height = 1 um\n1 2\n");
        let options = ReadOptions::new().layout(crate::io::TextLayout::Matrix);
        let measured = options.read_bytes(text, "map.txt")?;
        for (height, number) in measured.heights.iter().zip([1.0, 2.0]) {
            assert!((height / (step * number) - 1.0).abs() < 1e-15, "{head}: {height}");
        }
    }
    Ok(())
}

/// A straight line stays one on even steps, and what happened is said; where a height is missing its neighbours between
/// are too.
#[test]
fn uneven_steps_are_made_even() -> TestResult {
    let positions = [0.0, 1.0, 1.5, 3.0, 4.0, 6.0, 6.5, 7.0];
    let line = |x: f64| 2.0 * x - 3.0;
    let text: String = positions.iter().map(|x| format!("{x} {}\n", line(*x))).collect();
    let channel = parsed(&text)?;
    assert_eq!((channel.shape, channel.cell), ((8, 1), Some((1.0, 1.0))));
    for (k, value) in channel.values.iter().enumerate() {
        assert!((value - line(k as f64)).abs() < 1e-12, "{k}: {value}");
    }
    assert!(
        channel.notes.iter().any(|note| note.contains("up to 1.000 steps off")),
        "{:?}",
        channel.notes
    );
    let holed = parsed(text.replace("3 3\n", "3 NaN\n"))?;
    let missing = holed.values.iter().filter(|value| value.is_nan()).count();
    assert_eq!(missing, 2, "{:?}", holed.values);
    Ok(())
}

/// What only maps have above two columns leaves a choice, which names of columns make, or the user.
#[test]
fn columns_below_a_line_of_maps_are_no_profile_unless_they_say_so() -> TestResult {
    let rows = "0 5\n0.5 6\n1 7\n1.5 9\n";
    for line in ["\\Exported image units: m", "# Width: 2 m", "# Höhe: 8 m", "Scale Y: 2 m"] {
        let key = line.trim_start_matches(['#', '\\', ' ']);
        let said = format!("the line '{key}' is one of a map, but 4 rows of 2 numbers are taken");
        assert_refused(format!("{line}\n{rows}"), &said);
        assert_refused(format!("{line}\n5\n6\n7\n9\n"), "but 4 rows of 1 number are taken");
        let text = format!("{line}\n{rows}");
        assert_eq!(matrix(text)?.shape, (2, 4), "{line}");
        let named = parsed(format!("{line}\n# x [m]; z [m]\n{rows}"))?;
        assert_eq!(named.shape, (4, 1), "{line}");
        let notes = format!("{:?}", named.notes);
        assert!(notes.contains("is a line of maps, but names say"), "{line}: {notes}");
    }
    Ok(())
}

/// A refusal of columns that lines call a map says what they are without these.
#[test]
fn a_profile_below_a_pixel_size_is_named() {
    for rows in ["1\n2\n3\n4\n5\n", "0 5\n0.5 6\n1 7\n1.5 9\n"] {
        let text = format!("# Pixel size: 0.5 µm\n{rows}");
        assert_refused(text, "without the lines that say that it is a map, it is a profile");
    }
}

/// A side that stands alone gives no cell, and that is said.
#[test]
fn one_side_of_two_is_named() -> TestResult {
    let lone = matrix("# Width: 6 m\n5 1 4\n2 6 2\n5 8 5\n1 2 9\n")?;
    assert_eq!((lone.shape, lone.cell), ((3, 4), None));
    assert_eq!(lone.notes, ["'Width: 6 m' gives one side of two, and is not used"]);
    Ok(())
}

#[test]
fn positions_that_go_back_are_refused() {
    for text in ["0 1\n1 2\n1 3\n2 4\n", "0 1\n2 2\n1 3\n3 4\n"] {
        assert_refused(text, "rise or fall from row to row, but row 3 has 1 behind");
    }
    assert_refused("0 1\nNaN 2\n1 3\n3 4\n", "row 2 has NaN behind 0");
}
