use super::*;
use crate::Error;
use crate::io::testing::{MISSING, assert_refused, assert_whole, only, shown};

/// A binary file, written by hand: spacings of 2 and 3 µm, a value of 1 is 1 nm.
fn binary(magic: &str, nx: u32, ny: u32, data_type: u8, data: &[u8]) -> Vec<u8> {
    let mut file = magic.as_bytes().to_vec();
    file.extend(b"made here 211120261200            ");
    for count in [nx, ny] {
        if magic.ends_with("ISO-2.0") {
            file.extend(count.to_le_bytes());
        } else {
            file.extend((count as u16).to_le_bytes());
        }
    }
    for length in [2e-6_f64, 3e-6, 1e-9, -1.0] {
        file.extend(length.to_le_bytes());
    }
    file.extend([0, data_type, 0]);
    file.extend(data);
    file
}

/// A text with the same lengths.
fn ascii(magic: &str, nx: u32, ny: u32, data_type: &str, rest: &str) -> String {
    format!(
        "{magic}\nManufacID = made here\nCreateDate = 211120261200\nModDate =\nNumPoints = {nx}\nNumProfiles = {ny}\n\
         Xscale = 2e-6\nYscale = 3e-6\nZscale = 1e-9\nZresolution = -1\nCompression = 0\nDataType = {data_type}\n\
         CheckType = 0\n*\n{rest}"
    )
}

/// Heights in nm.
fn nanometres(channel: &Channel) -> Vec<f64> {
    shown(channel, |z| (z * 1e9).round())
}

/// The heights of a binary file.
fn heights(magic: &str, nx: u32, code: u8, data: &[u8]) -> Result<Vec<f64>, Fault> {
    Ok(nanometres(&only(parse(&binary(magic, nx, 1, code, data)))?))
}

/// Each type with its own bytes for 1, 7, and its two limits. Oracle: the limits of Rust's types.
#[test]
fn every_type_of_both_families_is_read() -> Result<(), Fault> {
    macro_rules! bytes {
        ($($type:ty),*) => {
            [$([1 as $type, 7 as $type, <$type>::MIN, <$type>::MAX].map(<$type>::to_le_bytes).concat()),*]
        };
    }
    let data = bytes!(u8, u16, u32, f32, i8, i16, i32, f64);
    let limits = [
        (0.0, 255.0),
        (0.0, 65535.0),
        (0.0, 4_294_967_295.0),
        (f64::NAN, f64::NAN),
        (-128.0, 127.0),
        (-32768.0, 32767.0),
        (-2_147_483_648.0, 2_147_483_647.0),
        (f64::NAN, f64::NAN),
    ];
    for (code, (data, (least, greatest))) in data.iter().zip(limits).enumerate() {
        let float = least.is_nan();
        let signed = least < 0.0;
        for magic in ["bISO-1.0", "bISO-2.0", "bBCR-1.0", "BBCR-1.0", "bBCR-0.0"] {
            let file = binary(magic, 2, 2, code as u8, data);
            let found = only(parse(&file))?;
            let expected = if float {
                [1.0, 7.0, MISSING, MISSING]
            } else if magic.contains("ISO") && signed {
                [1.0, 7.0, MISSING, greatest]
            } else {
                [1.0, 7.0, least, MISSING]
            };
            assert_eq!(nanometres(&found), expected, "{magic}, type {code}");
            assert_eq!(found.shape, (2, 2));
            assert_eq!(found.cell, Some((2e-6, 3e-6)));
            let told = magic.contains("BCR") && (code == 5 || code == 6);
            assert_eq!(found.notes.len(), usize::from(told), "{:?}", found.notes);
            // The header takes 81 bytes, or 85; a trailer may follow; nothing may be missing.
            let length = if magic == "bISO-2.0" { 85 } else { 81 };
            assert_eq!(file.len(), length + data.len());
            let with_trailer = [&file[..], b"<OperatorName>*</OperatorName>"].concat();
            assert_eq!(nanometres(&only(parse(&with_trailer))?), expected);
            assert_whole(parse, &file, 0);
        }
    }
    Ok(())
}

#[test]
fn nan_is_missing_in_every_family() -> Result<(), Fault> {
    let data = [2.0_f64, f64::NAN].map(f64::to_le_bytes).concat();
    for magic in ["bISO-1.0", "bBCR-1.0"] {
        assert_eq!(heights(magic, 2, 7, &data)?, [2.0, MISSING]);
    }
    Ok(())
}

/// A profile has no width, whatever stands for its spacing along y.
#[test]
fn one_line_is_a_profile() -> Result<(), Fault> {
    let data = [5_i16, 6].map(i16::to_le_bytes).concat();
    let found = only(parse(&binary("bISO-1.0", 2, 1, 5, &data)))?;
    assert_eq!(
        (found.cell, found.understood.as_str()),
        (Some((2e-6, 2e-6)), "a profile of 2 points")
    );
    Ok(())
}

#[test]
fn the_longer_header_of_olympus_is_understood() -> Result<(), Fault> {
    let values = [5_i16, 6].map(i16::to_le_bytes).concat();
    let data = [&[5, 0, 0, 0, 1, 0, 0, 0], &values[..]].concat();
    let found = only(parse(&binary("bISO-1.0", 2, 1, 5, &data)))?;
    assert_eq!(nanometres(&found), [5.0, 6.0]);
    assert_eq!(found.notes.len(), 1);
    // Eight other bytes too many are a trailer, and so are these ones in other files.
    let other = [&values[..], b"trailers"].concat();
    assert_eq!(heights("bISO-1.0", 2, 5, &other)?, [5.0, 6.0]);
    assert_eq!(heights("bISO-2.0", 2, 5, &data)?, [5.0, 0.0]);
    Ok(())
}

#[test]
fn texts_of_every_kind_are_read() -> Result<(), Fault> {
    let plain = ascii("aISO-1.0", 3, 2, "7", "1 2 3\n4 BAD 6\n*\nmore *\n*\n");
    let expected = [1.0, 2.0, 3.0, 4.0, MISSING, 6.0];
    for text in [
        plain.clone(),
        plain.replace('\n', "\r\n"),
        plain.replace('\n', "\r"),
        plain.replace(" = ", "="),
        plain.replace(" = ", "\t"),
        plain.replace("BAD", "nan"),
        plain.replace("BAD", "-1.7977e308"),
        // Lines may break anywhere, and comments stand behind them.
        plain.replace("1 2 3\n4", "1\n\n  2 ; 99\n;all * of it\n3 4"),
        plain.replace("Zscale = 1e-9", "; Zscale = 5\n Zscale = 1e-9 ; m"),
        plain.replace("aISO-1.0\n", "aISO-1.0 ; text\n"),
        // The end of the heights and the trailer may lack.
        plain.replace("\n*\nmore *\n*\n", "\n"),
        plain.replace("\n*\nmore *\n*\n", "\n*"),
        plain.to_lowercase().replacen("aiso", "aISO", 1),
        // BCR, with names for codes.
        plain.replace("aISO-1.0", "ABCR-1.0").replace("DataType = 7", "DataType = double"),
        plain.replace("aISO-1.0", "aBCR-0.0").replace("BAD", "1.7E+308"),
        ascii("aBCR-1.0", 3, 2, "INTEGER", "1 2 3 4 32767 6")
            .replace("Compression = 0", "Compression = null"),
        ascii("aISO-2.0", 3, 2, "5", "1 2 3 4 -32768 6\n*"),
    ] {
        let found = only(parse(text.as_bytes()))?;
        assert_eq!(nanometres(&found), expected, "{text}");
        assert_eq!((found.shape, found.cell), ((3, 2), Some((2e-6, 3e-6))));
        assert_eq!(found.notes.is_empty(), !text.ends_with('6'), "{text}");
    }
    Ok(())
}

#[test]
fn a_text_that_is_cut_is_refused_before_its_last_height() {
    let text = ascii("aISO-1.0", 3, 2, "7", "10 20 30\n40 50 60\n*\n");
    // Of the last height one digit is enough, and a note tells what may have happened.
    let optional = "0\n*\n".len();
    assert_whole(parse, text.as_bytes(), optional);
    let first = text.len() - optional;
    for end in first..=text.len() {
        let found = only(parse(&text.as_bytes()[..end]));
        let notes = found.map_or(9, |channel| channel.notes.len());
        assert_eq!(notes, usize::from(end < first + 2), "{end} bytes");
    }
}

#[test]
fn defects_are_named_with_their_place() {
    let text = ascii("aISO-1.0", 3, 2, "7", "1 2 3\n4 5 6\n*\n");
    for (from, to, reason) in [
        ("4 5 6", "4 five 6", "found 'five' at 209"),
        ("4 5 6", "4 5 6 7", "expected '*' after 3 x 2 heights, but found '7'"),
        ("4 5 6", "4 5", "only 5 are there"),
        ("\n*\n1 2 3\n4 5 6\n*\n", "\n", "a line '*' after the header was expected"),
        ("DataType = 7", "DataType = 8", "DataType is 8, but it has to be 0 to 7"),
        ("DataType = 7", "DataType = quadruple", "DataType is 'quadruple'"),
        ("DataType = 7", "Data = 7", "the header lacks DataType"),
        ("NumPoints = 3", "NumPoints = -3", "NumPoints is '-3', but a number was expected"),
        ("NumPoints = 3", "NumPoints = 30000", "do not fit into the"),
        ("Xscale = 2e-6", "Xscale = ", "Xscale is '', but a number was expected"),
        ("Compression = 0", "Compression = RLL", "Compression is 1"),
        ("CheckType = 0", "CheckType = 3", "CheckType is 3"),
        ("aISO-1.0", "aISO-3.0", "neither of ISO-1.0"),
    ] {
        assert_refused(parse(text.replace(from, to).as_bytes()), reason);
    }
    let data = [0; 4];
    for (place, byte, reason) in [
        (78, 2, "Compression is 2, but only files without it (0) are read at 78"),
        (79, 9, "DataType is 9, but it has to be 0 to 7 at 79"),
        (80, 1, "CheckType is 1"),
        (42, 3, "expected 6 more bytes, but the file ends after 4 at 81"),
    ] {
        let mut file = binary("bISO-1.0", 2, 1, 5, &data);
        file[place] = byte;
        assert_refused(parse(&file), reason);
    }
}

#[test]
fn absurd_sizes_and_scales_are_refused() {
    let shaped = |nx, ny| parse(&binary("bISO-2.0", nx, ny, 7, &[0; 64]));
    assert!(matches!(shaped(32768, 32768), Err(Fault::Malformed { .. })));
    for nx in [32769, u32::MAX] {
        assert!(matches!(shaped(nx, 1), Err(Fault::Refused(Error::GridTooLarge { .. }))));
    }
    assert!(matches!(shaped(0, 3), Err(Fault::Refused(Error::EmptyGrid { .. }))));
    for scale in ["0", "-1e-9", "nan", "inf"] {
        let text = ascii("aISO-1.0", 1, 1, "7", "1\n*\n")
            .replace("Zscale = 1e-9", &format!("Zscale = {scale}"));
        assert_refused(parse(text.as_bytes()), "a positive number was expected");
    }
}
