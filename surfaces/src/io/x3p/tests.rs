use std::io::{Cursor, Write};

use nalgebra::dmatrix;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use super::*;
use crate::io::ReadOptions;
use crate::io::testing::{TestResult, assert_refused, assert_whole, only};
use crate::{Error, Grid};

/// A compressed archive.
fn archive(members: &[(&str, &[u8])]) -> Result<Vec<u8>, Box<dyn std::error::Error>> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in members {
        zip.start_file(*name, SimpleFileOptions::default())?;
        zip.write_all(bytes)?;
    }
    Ok(zip.finish()?.into_inner())
}

/// A description of 2 x 1 points.
const DESCRIPTION: &str = "<ISO5436_2><Record1><FeatureType>SUR</FeatureType><Axes>\
    <CX><AxisType>I</AxisType><Increment>2e-6</Increment></CX>\
    <CY><AxisType>I</AxisType><Increment>3e-6</Increment></CY>\
    <CZ><AxisType>A</AxisType><DataType>I</DataType></CZ></Axes></Record1>\
    <Record3><MatrixDimension><SizeX>2</SizeX><SizeY>1</SizeY><SizeZ>1</SizeZ></MatrixDimension>\
    <DataLink><PointDataLink>data.bin</PointDataLink></DataLink></Record3></ISO5436_2>";

/// The heights 1 m and -2 m.
const DATA: [u8; 4] = [1, 0, 0xfe, 0xff];

/// What is read with a part of the description replaced.
fn with(part: &str, by: &str) -> Result<Parsed, Box<dyn std::error::Error>> {
    assert!(DESCRIPTION.contains(part), "{part}");
    let description = DESCRIPTION.replace(part, by);
    Ok(parse(&archive(&[("main.xml", description.as_bytes()), ("data.bin", &DATA)])?))
}

#[test]
fn what_is_written_is_read_back_to_the_last_bit() -> TestResult {
    let heights = dmatrix![
        0.1, -0.0, f64::NAN;
        f64::MIN_POSITIVE / 3.0, -1e300, f64::INFINITY
    ];
    let grid = Grid::new(2, 3, 1e-6 / 3.0, 0.1)?;
    let path = std::env::temp_dir().join(format!("asperity-x3p-{}.x3p", std::process::id()));
    write_x3p(&path, &grid, &heights)?;
    let first = std::fs::read(&path)?;
    write_x3p(&path, &grid, &heights)?;
    let second = std::fs::read(&path)?;
    let back = ReadOptions::new().read(&path);
    std::fs::remove_file(&path)?;
    assert!(first == second, "two files of the same heights differ");
    let back = back?;
    assert!(back.notes.is_empty(), "{:?}", back.notes);
    assert_eq!((back.cell, back.missing), (Some((grid.dx(), 0.1)), 2));
    for (found, written) in back.heights.iter().zip(&heights) {
        let expected = if written.is_finite() { *written } else { f64::NAN };
        assert_eq!(found.to_bits(), expected.to_bits());
    }
    let other = Grid::square(2, 1.0)?;
    assert!(matches!(write_x3p(&path, &other, &heights), Err(Error::GridMismatch { .. })));
    Ok(())
}

#[test]
fn a_plane_is_read_back() -> TestResult {
    // Deflate would make this a thousandth, which readers refuse.
    let grid = Grid::square(256, 1e-6)?;
    let mut file = Cursor::new(Vec::new());
    write::write(&mut file, &grid, &nalgebra::DMatrix::zeros(256, 256))?;
    assert!(only(parse(file.get_ref()))?.values.iter().all(|z| *z == 0.0));
    Ok(())
}

#[test]
fn the_simplest_file_is_read() -> TestResult {
    let expected = (vec![1.0, -2.0], Some((2e-6, 3e-6)));
    let marked = format!("\u{feff}{DESCRIPTION}");
    let (main, marked) = (DESCRIPTION.as_bytes(), marked.as_bytes());
    for members in [
        vec![("main.xml", main), ("data.bin", &DATA)],
        vec![("a/b/main.xml", b"not this one"), ("a/data.bin", &DATA), ("a/main.xml", main)],
        // Packed on Windows, and on macOS.
        vec![("a\\main.xml", main), ("a\\data.bin", &DATA)],
        vec![("__MACOSX/main.xml", b""), ("a/main.xml", main), ("a/data.bin", &DATA)],
        vec![("main.xml", marked), ("data.bin", &DATA)],
    ] {
        let found = only(parse(&archive(&members)?))?;
        assert_eq!((found.values, found.cell), expected, "{members:?}");
        assert!(found.notes.is_empty());
    }
    Ok(())
}

#[test]
fn increments_and_offsets_are_lengths() -> TestResult {
    let cz = "<DataType>I</DataType>";
    let scaled =
        only(with(cz, "<DataType>I</DataType><Increment>-0.5</Increment><Offset>10</Offset>")?)?;
    assert_eq!(scaled.values, [9.5, 11.0]);
    let empty = only(with(cz, "<DataType>I</DataType><Increment/><Offset/>")?)?;
    assert_eq!(empty.values, [1.0, -2.0]);
    for wrong in ["0", "x", "inf", "NaN"] {
        let wrong = format!("<DataType>I</DataType><Increment>{wrong}</Increment>");
        assert!(matches!(with(cz, &wrong)?, Err(Fault::Malformed { .. })));
    }
    Ok(())
}

#[test]
fn heights_may_stand_in_the_description() -> TestResult {
    let link = "<DataLink><PointDataLink>data.bin</PointDataLink></DataLink>";
    let list = |inner: &str| format!("<DataList>{inner}</DataList>");
    let all = only(with(link, &list("<Datum>1.5e-6</Datum>\n<Datum> ;;-2 </Datum>"))?)?;
    assert_eq!(all.values, [1.5e-6, -2.0]);
    let missing = only(with(link, &list("<Datum/><Datum>3</Datum>"))?)?;
    assert!(missing.values[0].is_nan() && missing.values[1] == 3.0);
    // A sign behind the last number parts it from nothing.
    for ends in
        ["<Datum>1e-6;</Datum><Datum>;;-2;</Datum>", "<Datum>1e-6</Datum><Datum>-2 ; </Datum>"]
    {
        assert_eq!(only(with(link, &list(ends))?)?.values, [1e-6, -2.0], "{ends}");
    }
    let missing = only(with(link, &list("<Datum>1;2;</Datum><Datum>3</Datum>"))?)?;
    assert!(missing.values[0].is_nan() && missing.values[1] == 3.0);
    for wrong in ["<Datum>1</Datum>", "<Datum>1</Datum><Datum>x</Datum>"] {
        assert!(matches!(with(link, &list(wrong))?, Err(Fault::Malformed { .. })));
    }
    Ok(())
}

/// Positions of a profile may be uneven, and its heights in the description.
#[test]
fn profiles_have_positions_of_their_own() -> TestResult {
    let description = DESCRIPTION.replace("SUR", "PRF").replace("<SizeX>2", "<SizeX>4");
    let absolute = description
        .replace("<CX><AxisType>I", "<CX><DataType>F</DataType><AxisType>A")
        .replace("<Increment>2e-6", "<Increment>1e-3")
        .replace("<PointDataLink>data.bin</PointDataLink>", "")
        .replace(
            "<DataLink></DataLink>",
            "<DataList><Datum>0;;0</Datum><Datum>3;;6</Datum>\
            <Datum>4;;8</Datum><Datum>6;;12</Datum></DataList>",
        );
    let listed = only(parse(&archive(&[("main.xml", absolute.as_bytes())])?))?;
    assert_eq!((listed.shape, listed.cell), ((4, 1), Some((2e-3, 2e-3))));
    // A straight line stays one.
    for (k, height) in listed.values.iter().enumerate() {
        assert!((height - 4.0 * k as f64).abs() < 1e-14, "{k}: {height}");
    }
    assert!(listed.notes.len() == 1 && listed.notes[0].contains("uneven"));
    let narrow =
        description.replace("<Increment>3e-6", "<Increment>0").replace("<SizeX>4", "<SizeX>2");
    let members: [(&str, &[u8]); 2] = [("main.xml", narrow.as_bytes()), ("data.bin", &DATA)];
    let even = only(parse(&archive(&members)?))?;
    assert_eq!((even.values, even.cell), (vec![1.0, -2.0], Some((2e-6, 2e-6))));
    let wide = narrow.replace("<SizeY>1", "<SizeY>2");
    let members: [(&str, &[u8]); 2] = [("main.xml", wide.as_bytes()), ("data.bin", &DATA)];
    assert_refused(parse(&archive(&members)?), "SizeY is 2, but a profile has one line");
    Ok(())
}

/// A line across both axes is as long as from point to point, whether its places are even steps or numbers.
#[test]
fn profiles_may_run_across_both_axes() -> TestResult {
    let absolute = |description: &str, axis: &str| {
        let [old, new] = ["", "<DataType>F</DataType>"].map(|kind| format!("<{axis}>{kind}"));
        let text = description.replace(&old, &new);
        let (before, after) = text.split_once(&new)?;
        Some(format!("{before}{new}{}", after.replacen("<AxisType>I", "<AxisType>A", 1)))
    };
    let profile = |axes: &[&str], points: &str| -> Result<Parsed, Box<dyn std::error::Error>> {
        let count = points.split(' ').count();
        let list: String =
            points.split(' ').map(|point| format!("<Datum>{point}</Datum>")).collect();
        let mut text = DESCRIPTION
            .replace("SUR", "PRF")
            .replace("<Increment>2e-6", "<Increment>3e-6")
            .replace(
                "<CY><AxisType>I</AxisType><Increment>3e-6",
                "<CY><AxisType>I</AxisType><Increment>1e-6",
            )
            .replace("<SizeX>2", &format!("<SizeX>{count}"))
            .replace("<PointDataLink>data.bin</PointDataLink>", "")
            .replace("<DataLink></DataLink>", &format!("<DataList>{list}</DataList>"));
        for axis in axes {
            text = absolute(&text, axis).ok_or("no axis")?;
        }
        Ok(parse(&archive(&[("main.xml", text.as_bytes())])?))
    };
    // Units of 3 µm along x and of 1 µm along y.
    for (axes, points, step) in [
        (&["CX", "CY"][..], "0;0;1 1;4;2 2;8;4", 5e-6),
        (&["CX", "CY"], "7;0;1 7;4;2 7;8;4", 4e-6),
        (&["CX", "CY"], "2;5;1 1;9;2 0;13;4", 5e-6),
        (&["CY"], ";0;1 ;4;2 ;8;4", 5e-6),
        (&["CX", "CY"], "0;3;1 2;3;2 4;3;4", 6e-6),
        (&["CX", "CY"], "0;;1 2;;2 4;;4", 6e-6),
    ] {
        let found = only(profile(axes, points)?)?;
        assert_eq!((found.values, found.notes.len()), (vec![1.0, 2.0, 4.0], 0), "{points}");
        let (dx, dy) = found.cell.ok_or("no cell")?;
        assert!((dx / step - 1.0).abs() < 1e-14 && dx == dy, "{points}: {dx}");
    }
    let back = profile(&["CX", "CY"], "0;0;1 2;8;2 1;4;3 3;12;4")?;
    assert_refused(back, "rise or fall from row to row, but row 3");
    Ok(())
}

#[test]
fn checksums_and_rotations_are_noted() -> TestResult {
    let sum = |sum: &str| {
        format!("data.bin</PointDataLink><MD5ChecksumPointData>{sum}</MD5ChecksumPointData>")
    };
    // What `md5sum` says of the four bytes, in capital letters.
    let right = md5_of(&DATA).to_uppercase();
    assert!(only(with("data.bin</PointDataLink>", &sum(&right))?)?.notes.is_empty());
    let wrong = only(with("data.bin</PointDataLink>", &sum(&"0".repeat(32)))?)?;
    assert!(wrong.notes.len() == 1 && wrong.notes[0].contains("'data.bin'"));
    let members: [(&str, &[u8]); 3] = [
        ("main.xml", DESCRIPTION.as_bytes()),
        ("data.bin", &DATA),
        ("md5checksum.hex", b"0123456789abcdef0123456789ABCDEF *main.xml\r\n"),
    ];
    let wrong = only(parse(&archive(&members)?))?;
    assert!(wrong.notes.len() == 1 && wrong.notes[0].contains("'main.xml'"));
    let turned = |r11: &str| {
        let rotation = format!("<Rotation><r11>{r11}</r11><r12>0</r12></Rotation></Axes>");
        with("</Axes>", &rotation)
    };
    assert!(only(turned("1.0")?)?.notes.is_empty());
    assert_eq!(only(turned("0.5")?)?.notes.len(), 1);
    Ok(())
}

/// RFC 1321, appendix A.5.
#[test]
fn md5_is_that_of_the_standard() {
    assert_eq!(md5_of(b""), "d41d8cd98f00b204e9800998ecf8427e");
    assert_eq!(md5_of(b"abc"), "900150983cd24fb0d6963f7d28e17f72");
}

#[test]
fn what_is_no_surface_of_one_layer_is_refused() -> TestResult {
    for (part, by, expected) in [
        ("SUR", "PRX", "the FeatureType is 'PRX'"),
        ("SUR", "PCL", "the FeatureType is 'PCL'"),
        ("<SizeZ>1", "<SizeZ>2", "SizeZ is 2"),
        ("<SizeX>2", "<SizeX>two", "SizeX is 'two'"),
        ("<SizeX>2", "<SizeX>3", "has to have 6 bytes, but it has 4"),
        ("<SizeX>2", "<SizeX>1", "has to have 2 bytes, but it has more"),
        ("<SizeX>2</SizeX><SizeY>1", "<SizeX>32768</SizeX><SizeY>9", "more than 256 times"),
        ("<CX><AxisType>I", "<CX><AxisType>A", "CX has the AxisType 'A'"),
        ("<CZ><AxisType>A", "<CZ><AxisType>I", "CZ has the AxisType 'I'"),
        ("<DataType>I", "<DataType>X", "the DataType 'X'"),
        ("2e-6", "-2e-6", "a spacing was expected"),
        ("<CX>", "<CW>", "'main.xml'"),
        ("data.bin", "../data.bin", "leaves the archive"),
        ("data.bin", "/data.bin", "leaves the archive"),
        ("data.bin", "C:\\data.bin", "leaves the archive"),
        ("data.bin", "http://opengps.eu/data.bin", "leaves the archive"),
        ("data.bin", "other.bin", "has no member 'other.bin'"),
        ("data.bin", "", "names no PointDataLink"),
        ("Record3>", "Record5>", "expected an element Record3"),
        ("ISO5436_2>", "html>", "expected the element ISO5436_2"),
        ("<ISO5436_2>", "<!DOCTYPE a [<!ENTITY b 'c'>]><ISO5436_2>", "DTD"),
    ] {
        assert_refused(with(part, by)?, expected);
    }
    let sized = |by| with("<SizeX>2", by);
    assert!(matches!(sized("<SizeX>0")?, Err(Fault::Refused(Error::EmptyGrid { .. }))));
    assert!(matches!(sized("<SizeX>99999")?, Err(Fault::Refused(Error::GridTooLarge { .. }))));
    let other = parse(&archive(&[("other.xml", b"<a/>")])?);
    assert_refused(other, "it is a zip archive without a member 'main.xml', so no X3P");
    Ok(())
}

#[test]
fn an_archive_that_only_wants_to_fill_the_memory_is_refused() -> TestResult {
    let zeros = vec![b' '; 1 << 20];
    let refused = |members: &[(&str, &[u8])], expected: &str| -> TestResult {
        assert_refused(parse(&archive(members)?), expected);
        Ok(())
    };
    // A megabyte of blanks takes a kilobyte.
    refused(&[("main.xml", &zeros)], "longer than 64 times")?;
    let large = DESCRIPTION.replace("<SizeX>2", "<SizeX>32768").replace("<SizeY>1", "<SizeY>16");
    let members: [(&str, &[u8]); 2] = [("main.xml", large.as_bytes()), ("data.bin", &zeros)];
    refused(&members, "more than 256 times")?;
    let elements = [DESCRIPTION, &"<a/>".repeat(3000)].concat();
    refused(&[("main.xml", elements.as_bytes())], "elements")?;
    let attributes: String = (0..2000).map(|k| format!(" a{k}='{k}'")).collect();
    refused(&[("main.xml", format!("<ISO5436_2{attributes}/>").as_bytes())], "attributes")
}

#[test]
fn no_depth_of_elements_exhausts_the_stack() -> TestResult {
    // Names that hardly repeat, so that the archive is not refused for shrinking too much.
    let names: Vec<String> =
        (0_u64..100_000).map(|k| format!("a{:x}", k.wrapping_mul(0x9e37_79b9_7f4a_7c15))).collect();
    let opened: String = names.iter().map(|name| format!("<{name}>")).collect();
    let closed: String = names.iter().rev().map(|name| format!("</{name}>")).collect();
    let deep = format!("{opened}{closed}</ISO5436_2>");
    let description = DESCRIPTION.replace("</ISO5436_2>", &deep);
    let file = archive(&[("main.xml", description.as_bytes()), ("data.bin", &DATA)])?;
    assert_eq!(only(parse(&file))?.values, [1.0, -2.0]);
    Ok(())
}

#[test]
fn no_beginning_of_a_file_is_taken_for_the_file() -> TestResult {
    for name in ["missing_i16_mask.x3p", "missing_f64_scaled_folder_stored.x3p"] {
        let data = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/surface_files");
        assert_whole(parse, &std::fs::read(std::path::Path::new(data).join(name))?, 0);
    }
    Ok(())
}
