use std::fs;
use std::path::PathBuf;

use nalgebra::dmatrix;
use proptest::prelude::*;

use super::matrix as parse;
use super::*;
use crate::surface::HeightMap;

type TestResult = Result<(), Box<dyn std::error::Error>>;

/// A version 1.0 file, written by hand.
fn file(header: &str, data: &[u8]) -> Vec<u8> {
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(data);
    bytes
}

fn is_bad(result: Result<DMatrix<f64>, Fault>) -> bool {
    matches!(result, Err(Fault::Malformed { .. }))
}

#[test]
fn every_type_and_order_gives_the_same_matrix() -> TestResult {
    let expected = dmatrix![1.0, 2.0, 3.0; 4.0, 5.0, -0.5];
    let c_order = [1.0_f32, 2.0, 3.0, 4.0, 5.0, -0.5];
    let fortran_order = [1.0_f32, 4.0, 2.0, 5.0, 3.0, -0.5];
    for (order, values) in [("False", c_order), ("True", fortran_order)] {
        let doubles = values.map(f64::from);
        for (descr, data) in [
            ("<f4", values.map(f32::to_le_bytes).concat()),
            (">f4", values.map(f32::to_be_bytes).concat()),
            ("<f8", doubles.map(f64::to_le_bytes).concat()),
            (">f8", doubles.map(f64::to_be_bytes).concat()),
        ] {
            let header =
                format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': (2, 3), }}\n");
            let found = parse(&file(&header, &data))?;
            assert_eq!(found, expected, "{header}");
        }
    }
    Ok(())
}

#[test]
fn a_file_written_by_numpy_is_read() -> TestResult {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data/selfaffine_48.npy");
    let map = HeightMap::new(read_npy(&path)?)?;
    assert_eq!(map.shape(), (48, 48));
    let bytes = fs::read(path)?;
    // What NumPy has written, this crate writes again to the last byte.
    let mut again = Vec::new();
    write(&mut again, map.matrix())?;
    assert_eq!(again, bytes);
    // A header of 128 bytes, then rows of 48 doubles.
    assert_eq!(bytes.len(), 128 + 48 * 48 * 8);
    for (ix, iy) in [(0, 0), (0, 1), (1, 0), (5, 31), (31, 5), (47, 47)] {
        let at = 128 + 8 * (48 * ix + iy);
        let expected = f64::from_le_bytes(bytes[at..at + 8].try_into()?);
        assert_eq!(map.matrix()[(ix, iy)].to_bits(), expected.to_bits());
    }
    Ok(())
}

#[test]
fn what_is_written_is_read_back() -> TestResult {
    let path = std::env::temp_dir().join(format!("asperity-npy-{}.npy", std::process::id()));
    let matrix = DMatrix::from_fn(7, 5, |ix, iy| (ix as f64).exp() - 0.1 * iy as f64);
    write_npy(&path, &matrix)?;
    let back = read_npy(&path);
    let bytes = fs::read(&path);
    fs::remove_file(&path)?;
    assert_eq!(back?, matrix);
    let bytes = bytes?;
    assert!(bytes.starts_with(b"\x93NUMPY\x01\x00"));
    // The second element of the file is [0, 1], as in C order.
    let data = &bytes[bytes.len() - 7 * 5 * 8..];
    assert_eq!(data[8..16], matrix[(0, 1)].to_le_bytes());
    let header = String::from_utf8_lossy(&bytes[10..bytes.len() - data.len()]).into_owned();
    assert!(header.contains("'<f8'") && header.contains("(7, 5"), "{header}");
    Ok(())
}

#[test]
fn the_elements_begin_at_a_multiple_of_64() {
    for shape in [(1, 1), (7, 5), (48, 48), (32768, 32768), (9_999_999, 12_345_678)] {
        let header = header_of("<f8", &[shape.0, shape.1]);
        assert!(header.len().is_multiple_of(64) && header.ends_with(b"\n"));
        let length = u16::from_le_bytes([header[8], header[9]]);
        assert_eq!(header.len(), 10 + usize::from(length));
        let understood = Header::read(&mut Bytes::new(&header));
        assert!(matches!(understood, Ok(header) if header.shape == [shape.0, shape.1]));
    }
}

#[test]
fn heights_that_are_not_finite_are_refused() -> TestResult {
    let mut bytes = Vec::new();
    write(&mut bytes, &dmatrix![0.0, 1.0; f64::NAN, 2.0])?;
    let map = HeightMap::new(parse(&bytes)?);
    assert!(matches!(map, Err(Error::HeightNotFinite { ix: 1, iy: 0, .. })));
    Ok(())
}

#[test]
fn a_file_of_another_length_than_it_says_is_refused() -> TestResult {
    let mut whole = Vec::new();
    write(&mut whole, &DMatrix::from_element(4, 3, 1.0))?;
    assert!(parse(&whole).is_ok());
    for length in 0..whole.len() {
        assert!(is_bad(parse(&whole[..length])), "{length} bytes");
    }
    whole.push(0);
    assert!(is_bad(parse(&whole)));
    Ok(())
}

#[test]
fn absurd_sizes_are_refused_before_allocating() {
    let with_shape = |shape: &str| {
        let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}");
        parse(&file(&header, &[0; 64]))
    };
    assert!(is_bad(with_shape("(32768, 32768)")));
    for shape in [
        "(32769, 1)",
        "(4294967296, 4294967296)",
        "(18446744073709551616, 18446744073709551616)",
        "(1, 99999999999999999999999999999999999999999999)",
    ] {
        assert!(
            matches!(with_shape(shape), Err(Fault::Refused(Error::GridTooLarge { .. }))),
            "{shape}"
        );
    }
    for shape in ["(0, 0)", "(0, 8)", "(8, 0)", "(0, 18446744073709551616)"] {
        assert!(
            matches!(with_shape(shape), Err(Fault::Refused(Error::EmptyGrid { .. }))),
            "{shape}"
        );
    }
    for shape in ["()", "(8,)", "(2, 2, 2)"] {
        assert!(is_bad(with_shape(shape)), "{shape}");
    }
}

#[test]
fn absurd_headers_are_refused() {
    // Four gigabytes of header in a short file.
    assert!(is_bad(parse(b"\x93NUMPY\x02\x00\xff\xff\xff\xff{'descr'")));
    // A header that is there, but longer than that of any matrix; brackets nested in it.
    let mut long = b"\x93NUMPY\x03\x00".to_vec();
    long.extend(200_000_u32.to_le_bytes());
    long.resize(12 + 200_000, b'(');
    assert!(is_bad(parse(&long)));
    assert!(is_bad(parse(&file(&"(".repeat(65_000), &[]))));
    assert!(is_bad(parse(&file(&"{'shape':(1,".repeat(5_000), &[]))));
    // Not text, another version, another format.
    assert!(is_bad(parse(b"\x93NUMPY\x01\x00\x02\x00\xff\xfe")));
    assert!(is_bad(parse(b"\x93NUMPY\x09\x00\x02\x00{}")));
    assert!(is_bad(parse(b"PK\x03\x04 is a zip archive")));
}

proptest! {
    /// Whatever one byte of a file is changed to, there is an answer and no panic.
    #[test]
    fn a_changed_byte_is_harmless(place in 0_usize..200, byte in any::<u8>()) {
        let mut bytes = file(
            "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), }\n",
            &[0; 96],
        );
        let place = place % bytes.len();
        bytes[place] = byte;
        if let Ok(matrix) = parse(&bytes) {
            prop_assert!(matrix.shape() == (3, 4) || matrix.shape() == (4, 3));
        }
    }

    /// Nor is any garbage, with or without a valid beginning.
    #[test]
    fn garbage_is_harmless(text in "[{}()\\[\\]':, a-zL0-9<>]{0,200}", data in any::<Vec<u8>>()) {
        prop_assert!(parse(&file(&text, &data)).is_err());
        prop_assert!(parse(&data).is_err());
    }
}

/// Vectors and texts, as archives hold them, are not read from arrays of other dimensions.
#[cfg(feature = "io")]
#[test]
fn dimensions_are_those_asked_for() -> TestResult {
    let of = |descr: &str, shape: &[usize], data: &[u8]| {
        let mut bytes = header_of(descr, shape);
        bytes.extend(data);
        bytes
    };
    let (number, letter) = (2.5_f64.to_le_bytes(), u32::from('é').to_le_bytes());
    let (single, plain) = (of("<f8", &[1], &number), of("<U1", &[], &letter));
    assert_eq!(vector(&single)?, [2.5]);
    assert_eq!(text(&plain)?, "é");
    let flat = of("<f8", &[1, 1], &number);
    for (fault, expected) in [
        (vector(&flat).err(), "of dimensions is 2, but 1 was expected"),
        (vector(&plain).err(), "of dimensions is 0, but 1 was expected"),
        (text(&single).err(), "of dimensions is 1, but 0 was expected"),
        (matrix(&single).err(), "of dimensions is 1, but 2 was expected"),
    ] {
        assert!(fault.is_some_and(|fault| fault.to_string().ends_with(expected)), "{expected}");
    }
    Ok(())
}
