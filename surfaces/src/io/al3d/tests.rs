use super::*;
use crate::io::testing::{MISSING, assert_refused, assert_whole, only, shown};

fn tag(key: &str, value: &str) -> Vec<u8> {
    let mut tag = key.as_bytes().to_vec();
    tag.resize(KEY, 0);
    tag.extend(value.as_bytes());
    tag.resize(KEY + VALUE, 0);
    tag.extend(b"\r\n");
    tag
}

const TAGS: [(&str, &str); 6] = [
    ("Cols", "3"),
    ("Rows", "2"),
    ("PixelSizeXMeter", "2e-06"),
    ("PixelSizeYMeter", "3e-06"),
    ("InvalidPixelValue", "3.000000028082e+15"),
    ("DepthImageOffset", "500"),
];

/// A file of these tags and of 3 x 2 heights from byte 500 on: 12 bytes a row, and 4 that pad it.
fn file(tags: &[(&str, &str)]) -> Vec<u8> {
    let mut file = MAGIC.to_vec();
    file.extend(tag("Version", "1"));
    file.extend(tag("TagCount", &tags.len().to_string()));
    for (key, value) in tags {
        file.extend(tag(key, value));
    }
    file.resize(500, 0);
    for row in [[1e-6_f32, 2e-6, f32::NAN], [3e15, 5e-6, -6e-6]] {
        file.extend(row.map(f32::to_le_bytes).concat());
        file.extend(b"pad.");
    }
    file
}

/// The file with one tag changed.
fn with(key: &str, value: &str) -> Vec<u8> {
    file(&TAGS.map(|tag| if tag.0 == key { (key, value) } else { tag }))
}

/// Heights in µm; float32 has seven digits.
fn micrometres(file: &[u8]) -> Result<Vec<f64>, Fault> {
    Ok(shown(&only(parse(file))?, |z| (z * 1e11).round() / 1e5))
}

#[test]
fn padded_rows_and_both_markers_are_understood() -> Result<(), Fault> {
    let whole = file(&TAGS);
    let expected = [1.0, 2.0, MISSING, MISSING, 5.0, -6.0];
    let found = only(parse(&whole))?;
    assert_eq!((found.shape, found.cell), ((3, 2), Some((2e-6, 3e-6))));
    // The last padding may be absent, and anything may follow it.
    let last = whole.len() - 4;
    for file in [&whole[..], &whole[..last], &[&whole[..], b"texture"].concat()] {
        assert_eq!(micrometres(file)?, expected);
    }
    assert_whole(parse, &whole, 4);
    Ok(())
}

#[test]
fn without_a_marker_only_nan_is_missing() -> Result<(), Fault> {
    let no_marker =
        TAGS.map(|tag| if tag.0 == "InvalidPixelValue" { ("PlaceHolder", "0") } else { tag });
    // A marker of zero is zero, and nothing near it.
    let (nan, zero) = (with("InvalidPixelValue", "NaN"), with("InvalidPixelValue", "0"));
    for file in [file(&no_marker), nan, zero] {
        let missing = micrometres(&file)?.iter().filter(|z| **z == MISSING).count();
        assert_eq!(missing, 1);
    }
    Ok(())
}

#[test]
fn defects_are_named() {
    for (key, value, reason) in [
        ("Cols", "three", "tag Cols is 'three'"),
        ("Cols", "-3", "tag Cols is '-3'"),
        ("Rows", "3", "expected 44 more bytes, but the file ends after 32"),
        ("DepthImageOffset", "0", "no depth image"),
        ("DepthImageOffset", "99999999999", "but the file has 532 bytes"),
        ("InvalidPixelValue", "none", "tag InvalidPixelValue is 'none'"),
        ("PixelSizeXMeter", "", "tag PixelSizeXMeter is ''"),
    ] {
        assert_refused(parse(&with(key, value)), reason);
    }
    assert_refused(parse(&file(&TAGS[1..])), "there is no tag Cols");
    let mut no_line_end = file(&TAGS);
    no_line_end[MAGIC.len() + 3 * TAG - 1] = b' ';
    assert_refused(parse(&no_line_end), "expected CR LF at the end of tag 1");
    let mut many = file(&TAGS);
    let place = MAGIC.len() + TAG + KEY;
    many[place..place + 18].copy_from_slice(b"999999999999999999");
    assert_refused(parse(&many), "more bytes");
    for (cols, rows) in [("0", "2"), ("3", "40000"), ("18446744073709551615", "2")] {
        let tags = TAGS.map(|tag| match tag.0 {
            "Cols" => ("Cols", cols),
            "Rows" => ("Rows", rows),
            _ => tag,
        });
        assert!(matches!(parse(&file(&tags)), Err(Fault::Refused(_))));
    }
}
