//! Profiles of instruments: one line of 7 points in steps of 2 µm, of heights 100 k − 250 nm, in every format that
//! holds such lines. The third point is missing but in texts, which have no sign for that.

use std::fs;

use asperity_surfaces::io::{Format, ReadOptions};

use super::own;

type TestResult = Result<(), Box<dyn std::error::Error>>;

/// Name, format, and whether the third point is missing.
const FILES: [(&str, Format, bool); 8] = [
    ("profile_f64.x3p", Format::X3p, true),
    ("profile_positions.x3p", Format::X3p, true),
    ("profile_i16.pro", Format::DigitalSurf, true),
    ("profile_npl.sdf", Format::Sdf, true),
    ("profile_iso1_i2.sdf", Format::Sdf, true),
    ("profile_f64.opdx", Format::Vision64, true),
    ("profile.prf", Format::Profile, false),
    ("profile.smd", Format::Profile, false),
];

#[test]
fn every_format_gives_the_same_profile() -> TestResult {
    for (name, format, lacks) in FILES {
        let found = ReadOptions::new().read(own().join(name))?;
        assert_eq!((found.format, found.heights.shape()), (format, (7, 1)), "{name}");
        assert_eq!(found.missing, usize::from(lacks), "{name}");
        assert_eq!(found.understood, "a profile of 7 points", "{name}");
        assert!(found.notes.is_empty(), "{name}: {:?}", found.notes);
        let (dx, dy) = found.cell.ok_or("no cell")?;
        // A spacing has float32 in `.pro`; elsewhere a product and a quotient round, or positions that begin at 5 mm.
        let rounding = match name {
            "profile_i16.pro" => 1e-9,
            "profile_positions.x3p" => 5e-3 / 2e-6 * f64::EPSILON,
            _ => 1e-14,
        };
        assert!((dx / 2e-6 - 1.0).abs() <= rounding && dx == dy, "{name}: {dx} x {dy}");
        for (k, height) in found.heights.iter().enumerate() {
            if lacks && k == 2 {
                assert!(height.is_nan(), "{name}: {height}");
                continue;
            }
            let expected = (100.0 * k as f64 - 250.0) * 1e-9;
            // Two products round, and digits of a decimal.
            assert!((height / expected - 1.0).abs() <= 1e-15, "{name} {k}: {height}");
        }
    }
    Ok(())
}

#[test]
fn no_beginning_of_a_profile_is_taken_for_it() -> TestResult {
    for (name, ..) in FILES {
        let bytes = fs::read(own().join(name))?;
        // What follows the heights is no part of them, nor what ends the last of them in a text.
        let behind = match name {
            // The end of the last number, of one digit.
            "profile_npl.sdf" => 12,
            "profile_f64.opdx" => 58,
            "profile.prf" => 7,
            "profile.smd" => 13,
            _ => 0,
        };
        for end in 0..bytes.len() - behind {
            let cut = ReadOptions::new().read_bytes(&bytes[..end], name);
            let whole = cut.is_ok_and(|found| found.format != Format::Text);
            assert!(!whole, "{name}: {end} of {} bytes", bytes.len());
        }
    }
    Ok(())
}

/// A file with words replaced, and why it is not read.
fn refused(name: &str, edits: &[(&str, &str)]) -> Result<String, Box<dyn std::error::Error>> {
    let text = fs::read_to_string(own().join(name))?;
    let text = edits.iter().fold(text, |text, (old, new)| {
        assert!(text.contains(old), "{name} has no {old}");
        text.replacen(old, new, 1)
    });
    match ReadOptions::new().read_bytes(text, name) {
        Ok(found) => Err(format!("{name} is read: {found}").into()),
        Err(error) => Ok(error.to_string()),
    }
}

#[test]
fn what_does_not_fit_together_is_refused() -> TestResult {
    for (name, edits, reason) in [
        ("profile.prf", ("CZ M 7.0", "CZ M 8.0"), "7 points along CX and 8 along CZ"),
        ("profile.prf", ("CZ M 7.0", "CZ M 9e8.0"), "the number of points along CZ"),
        ("profile.prf", ("CZ M 7.000000e+000", "CZ M 9e8"), "900000000 heights do not fit"),
        ("profile.prf", ("CZ M 7.000000e+000", "CZ M 7.5"), "CZ has 7.5 points"),
        ("profile.prf", ("CX M", "CX A"), "CX has the type 'A'"),
        ("profile.prf", ("SPACING CX 2", "SPACING CX -2"), "the spacing along CX is -0.002"),
        ("profile.prf", ("SPACING CX", "SPACING CY"), "no spacing of the points along CX"),
        ("profile.prf", ("-250000\r\n", "-250000 1\r\n"), "holds more than the heights"),
        ("profile.prf", ("-250000\r\n", "BAD\r\n"), "a height is 'BAD'"),
        ("profile.prf", ("1.000000e-006 L", "0 L"), "the factor of CZ is 0"),
        ("profile.prf", (" UM ", " V "), "'v'"),
        ("profile.smd", ("-0.25000\r\n", ""), "but there are 6 heights"),
        ("profile.smd", ("\u{3}\r\n13", "\r\n13"), "line 19 holds more"),
        ("profile.prf", ("EOR\r\nEOF", ""), "the file ends within the heights"),
        ("profile.smd", ("2.00000e-003", ""), "no spacing of the points along CX"),
        ("profile_npl.sdf", ("Xscale = 2E-06", "Xscale = 0"), "cell along x"),
    ] {
        let message = refused(name, &[edits])?;
        assert!(message.contains(reason), "{name} {edits:?}: {message}");
    }
    Ok(())
}

/// Whether the spacing counts in units or in those times a factor no description says: it is told.
#[test]
fn a_factor_of_positions_is_told() -> TestResult {
    let text = fs::read_to_string(own().join("profile.prf"))?;
    let text = text.replace("MM 1.000000e+000 D", "MM 1.000000e-001 D");
    let found = ReadOptions::new().read_bytes(text, "profile.prf")?;
    assert_eq!(found.notes.len(), 1);
    assert!(found.notes[0].contains("multiplied by 1e-1: the spacing, 0.002 mm"));
    Ok(())
}
