//! Lists of points.

use super::{MISSING, TestResult, assert_refused, parsed, parsed_as, shown};
use crate::io::{MeasuredSurface, ReadOptions};
use crate::{Error, FileError};

#[test]
fn a_list_of_points_is_read_in_any_order() -> TestResult {
    // z = 10 x + y on 3 x 2 nodes with spacings 2 and 5, one of them absent, one without height.
    let points = ["0 0 0", "2 0 20", "4 0 NaN", "0 5 5", "4 5 45"];
    let expected = [0.0, 20.0, MISSING, 5.0, MISSING, 45.0];
    for order in [[0, 1, 2, 3, 4], [0, 3, 1, 2, 4], [4, 3, 2, 1, 0], [2, 0, 4, 1, 3]] {
        let text: String = order.iter().map(|k| format!("{}\n", points[*k])).collect();
        let channel = parsed(&text)?;
        assert_eq!((channel.shape, channel.cell), ((3, 2), Some((2.0, 5.0))));
        assert_eq!(channel.height_unit, None);
        assert_eq!(channel.lateral_unit, None);
        assert_eq!(shown(&channel, |z| z), expected);
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
        ("X Position in mm  Y Position in mm  Z in in", Some("mm"), Some("in")),
        ("x/mm y/m z/m", Some("mm"), Some("m")),
        ("# Channel: a\n# Lateral units: µm\n# Value units: nm", Some("µm"), Some("nm")),
    ] {
        let channel = parsed(format!("{header}\n{points}"))?;
        assert_eq!(channel.shape, (2, 2), "{header}");
        assert_eq!(channel.lateral_unit.as_deref(), lateral, "{header}");
        assert_eq!(channel.height_unit.as_deref(), vertical, "{header}");
    }
    let coloured = parsed("X Y Z R G B\n0 0 7 1 1 1\n0 1 8 1 1 1\n1 0 9 1 1 1\n1 1 6 1 1 1\n")?;
    assert_eq!(coloured.values, [7.0, 9.0, 8.0, 6.0]);
    assert_eq!(coloured.notes.len(), 1);
    // Rows of an image are y.
    for names in ["row,col,value", "Row;Column;Z", "iy ix height"] {
        let of_image = parsed(format!("{names}\n0 0 7\n0 1 8\n0 2 4\n1 0 9\n1 1 6\n1 2 5\n"))?;
        assert_eq!((of_image.shape, of_image.values[1]), ((3, 2), 8.0), "{names}");
    }
    // Sides belong to a matrix, of however few columns, unless they are those of a grid.
    let sides = "# Width: 3 m\n# Height: 4 m\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n";
    assert_refused(sides, "'matrix', 4 rows of 3 heights; 'points', 4 points");
    assert_eq!(parsed(sides.replace("1 1 1", "0 1 2"))?.shape, (3, 4));
    Ok(())
}

/// In lists and in profiles, units of columns have to be those of the lines above, in whichever spelling.
#[test]
fn names_of_columns_agree_with_the_header() -> TestResult {
    let tables = [
        "x (um)  y (um)  z (nm)\n0 0 0\n2 0 20\n0 5 5\n2 5 25\n",
        "x (um)  z (nm)\n0 5\n1 7\n2 6\n3 9\n",
    ];
    for table in tables {
        for (line, said) in [
            (
                "Height conversion factor (->m): 1e-9",
                "heights, the name of the column says 'nm', but the header '1e-9 m'",
            ),
            ("Bit2nm: 2", "heights, the name of the column says 'nm', but the header '2.0 nm'"),
            ("Z unit: um", "heights, the name of the column says 'nm', but the header 'um'"),
            ("XY unit: mm", "x, the name of the column says 'um', but the header 'mm'"),
        ] {
            assert_refused(format!("# {line}\n{table}"), &format!("of {said}"));
        }
        let same = parsed(format!("# XY unit: µm\n# Z unit: nanometer\n{table}"))?;
        let units = [same.lateral_unit.as_deref(), same.height_unit.as_deref()];
        assert_eq!(units, [Some("um"), Some("nm")]);
    }
    let list = tables[0];
    assert!(parsed(format!("# Lateral units: µm\n{list}")).is_ok());
    let unnamed = list.replace(" (um)", "").replace(" (nm)", "");
    let channel = parsed(format!("# XY unit: µm\n{unnamed}"))?;
    assert_eq!((channel.lateral_unit.as_deref(), channel.height_unit), (Some("µm"), None));
    Ok(())
}

/// All nodes of a grid of 30 x 20, in so many columns.
fn grid(columns: usize) -> String {
    let more = |k: usize| (3..columns).map(move |c| format!(" {}", (k * k + c) % 13));
    let row =
        |k: usize| format!("{} {} {}{}\n", k % 30, k / 30, k * k % 17, more(k).collect::<String>());
    (0..600).map(row).collect()
}

/// Sides or numbers of nodes above a list make no matrix of it.
#[test]
fn a_list_under_lines_of_a_matrix_stays_one() -> TestResult {
    let lines =
        ["# Pixel size: 1 µm", "cellsize 1", "# Scale X: 1 µm", "# Width: 30\n# Height: 20"];
    for line in lines {
        let text = format!("{line}\n# Value units: µm\n{}", grid(3));
        assert_eq!(parsed_as("l.xyz", &text)?.shape, (30, 20), "{line}");
        assert_eq!(parsed(format!("# Lateral units: µm\n{text}"))?.shape, (30, 20), "{line}");
        assert_refused(&text, "'matrix', 600 rows of 3 heights; 'points', 600 points");
    }
    // Counts say which of the two it is.
    assert_eq!(parsed(format!("# nx: 30\n# ny: 20\n{}", grid(3)))?.shape, (30, 20));
    assert_eq!(parsed(format!("# nx: 3\n# ny: 600\n{}", grid(3)))?.shape, (3, 600));
    assert_refused(format!("# nx: 7\n{}", grid(3)), "'points', 600 points");
    Ok(())
}

/// Many columns, or a defect, make no matrix of a list: rows would be far longer.
#[test]
fn long_tables_of_few_columns_are_lists() -> TestResult {
    for columns in [4, 5, 9, 10, 12] {
        assert_eq!(parsed(grid(columns))?.shape, (30, 20), "{columns}");
    }
    let twice = |columns: usize| {
        let text = grid(columns);
        let first = text.lines().next().unwrap_or_default();
        format!("{text}{first}\n")
    };
    for columns in [3, 4, 9] {
        let said = format!("601 rows of {columns} numbers are taken for points x, y, z unless");
        assert_refused(twice(columns), &said);
        assert_refused(twice(columns), "'# Width: 1 mm'");
        let declared = format!("# Width: 1 mm\n# Height: 9 mm\n{}", twice(columns));
        assert_eq!(parsed(declared)?.shape, (columns, 601));
    }
    // A narrow map is one.
    let narrow: String =
        (0..40).map(|k| format!("{} {} {} {}\n", k % 7, k * k % 11, 3, 1)).collect();
    assert_eq!(parsed(narrow)?.shape, (4, 40));
    Ok(())
}

/// One of several names that begin with z is nothing but that.
#[test]
fn a_column_called_z_has_the_heights() -> TestResult {
    let rows = "0;0;7;1\n0;1;8;2\n1;0;9;3\n1;1;6;4\n";
    for (names, values) in [
        ("x;y;z;z_std", [7.0, 9.0, 8.0, 6.0]),
        ("x;y;z_raw;z", [1.0, 3.0, 2.0, 4.0]),
        ("x [mm];y [mm];Z (µm);z_std (µm)", [7.0, 9.0, 8.0, 6.0]),
        ("x_um;y_um;z_raw_um;z_um", [1.0, 3.0, 2.0, 4.0]),
    ] {
        assert_eq!(parsed(format!("{names}\n{rows}"))?.values, values, "{names}");
    }
    for names in ["x;y;z_raw;z_std", "x;y;z;z", "x;y;z [um];z [nm]"] {
        assert_refused(format!("{names}\n{rows}"), "it is not clear which has the heights");
    }
    Ok(())
}

/// The message says what lacks, not how many names there are.
#[test]
fn names_without_one_x_and_one_y_are_refused() {
    let rows = "0;0;7;1\n0;1;8;1\n1;0;9;1\n1;1;6;1\n";
    let said = "not one of the 4 that there are as x, one as y and one as the height";
    assert_refused(format!("X;Y;Z;X_err\n{rows}"), said);
}

#[test]
fn a_list_without_units_needs_both() -> TestResult {
    let read =
        |options: ReadOptions| options.read_bytes("0 0 0\n2 0 20\n0 5 5\n2 5 25\n", "test.xyz");
    let nothing = read(ReadOptions::new());
    let heights = ReadOptions::new().height_unit("nm".parse()?);
    let one = read(heights.clone());
    let both = read(heights.lateral_unit("mm".parse()?));
    let message =
        |result: Result<_, Error>| result.map(|_: MeasuredSurface| ()).map_err(|e| e.to_string());
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
        (0..60).map(|k| format!("{} {} {k}\n", x(k % 20), k / 20)).collect()
    };
    // Thirds with five digits are 3e-5 off at most, with two 0.03.
    let fine = parsed(list(&|k| format!("{:.5}", k as f64 / 3.0)))?;
    assert_eq!((fine.shape, fine.notes.len()), ((20, 3), 0));
    let coarse = parsed(list(&|k| format!("{:.2}", k as f64 / 3.0)))?;
    assert_eq!((coarse.shape, coarse.notes.len()), ((20, 3), 1));
    let dx = coarse.cell.ok_or("no cell")?.0;
    // The last coordinate, 6.33, is 0.0033 too small.
    assert!((dx * 19.0 - 6.33).abs() < 1e-14);
    // So are those of many columns, some of which may lack.
    for gap in [0, 7] {
        let place = |k: usize| if k < 30 { k } else { k + gap };
        let many: String = (0..180)
            .map(|k| format!("{:.2} {} {k}\n", place(k % 60) as f64 / 3.0, k / 60))
            .collect();
        assert_eq!(parsed(many)?.shape, (60 + gap, 3));
    }
    assert_refused(list(&|k| format!("{:.1}", k as f64 / 3.0)), "not evenly spaced");
    assert_refused(
        list(&|k| (k * k).to_string()),
        "x is not evenly spaced: it has 20 different values",
    );
    // Coordinates of an encoder that trembles.
    let trembling: String = (0..60)
        .map(|k| format!("{} {} {k}\n", (k % 20) as f64 + 1e-4 * (k as f64).sin(), k / 20))
        .collect();
    assert_eq!(parsed(&trembling)?.shape, (20, 3));
    Ok(())
}

#[test]
fn what_is_no_grid_is_refused() {
    for (text, expected) in [
        ("0 0 1\n1 0 2\n0 1 3\n1 1 4\n1 1 5\n", "point 5 at x = 1, y = 1 is not the first"),
        ("0 0 1\n0 1 2\n0 2 3\n0 3 4\n", "all points have x = 0: a profile"),
        ("0 0 1\nNaN 0 2\n0 1 3\n1 1 4\n", "point 2 has no x"),
        ("0 0 1\n1 0 1\n0 1 1\n.3 .7 1\n", "'# Width: 1 mm'"),
    ] {
        assert_refused(text, expected);
    }
    // A diagonal of 100 points on 100 x 100 nodes, and one that no grid can hold.
    let diagonal =
        |count: usize| -> String { (0..count).map(|k| format!("{k} {k} 1\n")).collect() };
    assert_refused(diagonal(100), "a grid of 100 x 100 nodes would be needed for the 100 points");
    assert_refused(diagonal(40_000), "the 40000 points lie on no regular grid");
    let two = parsed_as("two.xyz", "1 2\n3 4\n").map_err(|error| error.to_string());
    assert!(two.is_err_and(|text| text.contains("has three columns")));
    let extreme = parsed_as("test.xyz", "-1e308 0 1\n1e308 0 1\n0 1 1\n5e-324 1 1\n");
    assert!(matches!(extreme, Err(Error::File(FileError::BadFile { .. }))));
}
