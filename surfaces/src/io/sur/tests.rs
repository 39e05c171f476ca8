use std::io::Write;

use flate2::Compression;
use flate2::write::ZlibEncoder;

use super::*;
use crate::io::testing::{MISSING, TestResult, assert_refused, assert_whole, only, put, shown};

/// The header of a map of 3 x 2 nodes with 16 bits each: cells of 2 µm x 3 µm, steps of 0.5 nm.
fn header(magic: &[u8; 12]) -> Vec<u8> {
    let mut file = vec![0; HEADER];
    put(&mut file, 0, *magic);
    for (place, value) in [(14, 1_u16), (16, 1), (18, 2), (86, 1), (98, 16)] {
        put(&mut file, place, value.to_le_bytes());
    }
    for (place, value) in [(100, -5_i32), (104, 9), (108, 3), (112, 2), (116, 6)] {
        put(&mut file, place, value.to_le_bytes());
    }
    for (place, value) in [(120, 2.0_f32), (124, 3.0), (128, 0.5)] {
        put(&mut file, place, value.to_le_bytes());
    }
    for (place, text) in
        [(164, *b"Height"), (180, *b"\xb5m    "), (196, *b"\xb5m    "), (212, *b"nm    ")]
    {
        put(&mut file, place, text);
    }
    file
}

/// -7 is two below the least height.
const VALUES: [i16; 6] = [-5, 0, 2, 4, -7, 9];

fn plain() -> Vec<u8> {
    let mut file = header(b"DIGITAL SURF");
    file.extend(VALUES.map(i16::to_le_bytes).concat());
    file
}

fn zipped(bytes: &[u8]) -> std::io::Result<Vec<u8>> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes)?;
    encoder.finish()
}

/// A compressed file of these streams, each with the length it claims.
fn compressed(streams: &[(u32, Vec<u8>)]) -> Vec<u8> {
    let mut file = header(b"DSCOMPRESSED");
    file.extend((streams.len() as u32).to_le_bytes());
    for (claimed, stream) in streams {
        file.extend(claimed.to_le_bytes());
        file.extend((stream.len() as u32).to_le_bytes());
    }
    for (_, stream) in streams {
        file.extend(stream);
    }
    file
}

/// The heights in a file, in its units.
fn heights(file: &[u8]) -> Result<Vec<f64>, Fault> {
    Ok(shown(&only(parse(file))?, |z| z))
}

#[test]
fn a_map_is_read() -> TestResult {
    let found = only(parse(&plain()))?;
    assert_eq!(heights(&plain())?, [-2.5, 0.0, 1.0, 2.0, MISSING, 4.5]);
    assert_eq!((found.shape, found.cell), ((3, 2), Some((2.0, 3.0))));
    assert_eq!(found.lateral_unit.as_deref(), Some("µm"));
    assert_eq!(found.height_unit.as_deref(), Some("nm"));
    assert_eq!(found.name, "Height");
    assert_whole(parse, &plain(), 0);
    Ok(())
}

#[test]
fn texts_end_at_their_zero() -> TestResult {
    let mut file = plain();
    put(&mut file, 164, *b"Height\0xy");
    put(&mut file, 212, *b"nm\0um");
    let found = only(parse(&file))?;
    assert_eq!((found.name.as_str(), found.height_unit.as_deref()), ("Height", Some("nm")));
    Ok(())
}

#[test]
fn special_points_offset_and_zones_are_heeded() -> TestResult {
    let mut file = plain();
    put(&mut file, 86, [0, 0]);
    put(&mut file, 474, 100.0_f32.to_le_bytes());
    put(&mut file, 334, [3, 0, 4, 0]);
    file.splice(HEADER..HEADER, *b"comment");
    assert_eq!(heights(&file)?, [97.5, 100.0, 101.0, 102.0, 96.5, 104.5]);
    Ok(())
}

#[test]
fn thirty_two_bits_are_read() -> TestResult {
    let mut file = header(b"DIGITAL SURF");
    put(&mut file, 98, [32, 0]);
    // Two below the least of all numbers is no number of 32 bits.
    put(&mut file, 100, i32::MIN.to_le_bytes());
    let values = [i32::MIN, i32::MAX, 0, 1, 2, 3];
    file.extend(values.map(i32::to_le_bytes).concat());
    let expected = values.map(|value| 0.5 * f64::from(value));
    assert_eq!(heights(&file)?, expected);
    Ok(())
}

#[test]
fn units_may_differ_from_axis_to_axis() -> TestResult {
    for (x, y, cell, unit) in [
        (b"mm ", b"mm ", (2.0, 3.0), Some("mm")),
        (b"mm ", b"\xb5m ", (2e-3, 3e-6), Some("m")),
        // What is no length is passed on, so that the error names it.
        (b"mm ", b"V  ", (2.0, 3.0), Some("V")),
        (b"Hz ", b"mm ", (2.0, 3.0), Some("Hz")),
        (b"mm ", b"   ", (2.0, 3.0), None),
        (b"   ", b"   ", (2.0, 3.0), None),
    ] {
        let mut file = plain();
        put(&mut file, 180, *x);
        put(&mut file, 196, *y);
        let found = only(parse(&file))?;
        assert_eq!(found.lateral_unit.as_deref(), unit);
        let (dx, dy) = found.cell.ok_or("no cell")?;
        // One product each, rounded once.
        assert!((dx - cell.0).abs() <= f64::EPSILON * cell.0, "{dx}");
        assert!((dy - cell.1).abs() <= f64::EPSILON * cell.1, "{dy}");
    }
    Ok(())
}

#[test]
fn one_and_several_streams_are_read() -> TestResult {
    let data = VALUES.map(i16::to_le_bytes).concat();
    let expected = heights(&plain())?;
    for cuts in [&[0, 12][..], &[0, 5, 12], &[0, 4, 4, 12]] {
        let mut streams = Vec::new();
        for cut in cuts.windows(2) {
            streams.push(((cut[1] - cut[0]) as u32, zipped(&data[cut[0]..cut[1]])?));
        }
        let file = compressed(&streams);
        assert_eq!(heights(&file)?, expected);
        assert_whole(parse, &file, 0);
    }
    Ok(())
}

#[test]
fn streams_that_lie_are_refused() -> TestResult {
    let data = VALUES.map(i16::to_le_bytes).concat();
    let whole = zipped(&data)?;
    let mut damaged = whole.clone();
    damaged[4] ^= 0x55;
    for (streams, reason) in [
        (vec![(11, whole.clone())], "hold 11 bytes, but the heights take 12"),
        (vec![(12, zipped(&[&data[..], b"x"].concat())?)], "holds more than the 12 bytes"),
        (vec![(12, zipped(&data[1..])?)], "holds less than the 12 bytes"),
        (vec![(u32::MAX, whole.clone()), (13, whole)], "hold 4294967308 bytes"),
        (vec![(12, damaged)], "damaged"),
    ] {
        assert_refused(parse(&compressed(&streams)), reason);
    }
    let many = [header(b"DSCOMPRESSED"), vec![0xff; 64]].concat();
    assert_refused(parse(&many), "more bytes");
    Ok(())
}

/// 32768 x 32768 nodes in 20 bytes.
#[test]
fn no_stream_expands_more_than_deflate_can() {
    let mut file = compressed(&[(1 << 31, vec![0; 20])]);
    put(&mut file, 108, 32768_u32.to_le_bytes());
    put(&mut file, 112, 32768_u32.to_le_bytes());
    put(&mut file, 116, (1_u32 << 30).to_le_bytes());
    assert_refused(parse(&file), "no 20 compressed bytes can hold 2147483648");
}

/// Colours and intensities are further objects behind the heights; their number does not matter.
#[test]
fn the_surface_of_one_with_images_is_read() -> TestResult {
    for kind in [11, 13, 16] {
        let mut file = plain();
        put(&mut file, 18, [kind, 0]);
        put(&mut file, 14, [4, 0]);
        file.extend(header(b"DIGITAL SURF"));
        let found = only(parse(&file))?;
        assert_eq!(heights(&file)?, heights(&plain())?);
        assert_eq!(found.notes.len(), 1);
    }
    Ok(())
}

#[test]
fn what_is_no_single_map_is_refused() {
    for (place, bytes, reason) in [
        (12, [1, 1], "big-endian"),
        (14, [3, 0], "there are 3 objects"),
        (18, [5, 0], "a series of surfaces (type 5)"),
        (18, [8, 0], "a surface with layers (type 8)"),
        (18, [12, 0], "a colour image (type 12)"),
        (18, [0, 9], "something unknown (type 2304)"),
        (98, [24, 0], "24 bits"),
        (116, [7, 0], "7 points in the file, but 3 x 2 in a map"),
        (336, [2, 0], "expected 12 more bytes, but the file ends after 10"),
    ] {
        let mut file = plain();
        put(&mut file, place, bytes);
        assert_refused(parse(&file), reason);
    }
    let longer = [plain(), vec![0; 3]].concat();
    assert_refused(parse(&longer), "but 3 bytes follow");
}

/// Of several lines it is a map; of one it has lengths along x alone.
#[test]
fn a_profile_is_a_map_if_it_has_several_lines() -> TestResult {
    let mut file = plain();
    put(&mut file, 18, [1, 0]);
    let map = only(parse(&file))?;
    assert_eq!((map.shape, map.cell), ((3, 2), Some((2.0, 3.0))));
    put(&mut file, 108, 6_u32.to_le_bytes());
    put(&mut file, 112, 1_u32.to_le_bytes());
    put(&mut file, 124, 0.0_f32.to_le_bytes());
    put(&mut file, 196, [b' '; 16]);
    let profile = only(parse(&file))?;
    assert_eq!((profile.shape, profile.cell), ((6, 1), Some((2.0, 2.0))));
    assert_eq!(profile.lateral_unit.as_deref(), Some("µm"));
    Ok(())
}

#[test]
fn absurd_numbers_are_refused() {
    for (place, value) in [(128, f32::NAN), (128, 0.0), (128, -1.0), (474, f32::INFINITY)] {
        let mut file = plain();
        put(&mut file, place, value.to_le_bytes());
        assert!(parse(&file).is_err(), "{value} at {place}");
    }
    for nx in [0, 32769, u32::MAX] {
        let mut file = plain();
        put(&mut file, 108, nx.to_le_bytes());
        put(&mut file, 116, nx.wrapping_mul(2).to_le_bytes());
        assert!(parse(&file).is_err(), "{nx}");
    }
}
