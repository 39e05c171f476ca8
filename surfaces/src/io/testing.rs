//! What the tests of readers share.

use super::fault::Fault;
use super::raw::{Channel, Parsed};

pub(super) type TestResult = Result<(), Box<dyn std::error::Error>>;

/// Stands for NaN, which equals nothing.
pub(super) const MISSING: f64 = -1e9;

/// The only map in a file.
pub(super) fn only(parsed: Parsed) -> Result<Channel, Fault> {
    let mut channels = parsed?;
    assert_eq!(channels.len(), 1);
    Ok(channels.remove(0))
}

/// Heights in another unit, [`MISSING`] where there is none.
pub(super) fn shown(channel: &Channel, height: impl Fn(f64) -> f64) -> Vec<f64> {
    channel.values.iter().map(|z| if z.is_nan() { MISSING } else { height(*z) }).collect()
}

/// Asserts that a file is refused with these words; ` at 12` is the place of the defect.
pub(super) fn assert_refused(parsed: Parsed, expected: &str) {
    let message = match parsed {
        Err(Fault::Malformed { offset: Some(at), reason }) => format!("{reason} at {at}"),
        Err(Fault::Malformed { offset: None, reason }) => reason,
        other => format!("{other:?}"),
    };
    assert!(message.contains(expected), "'{message}' says nothing of '{expected}'");
}

/// Asserts that nothing but the whole of a file is taken for it, up to some bytes at its end.
pub(super) fn assert_whole(parse: impl Fn(&[u8]) -> Parsed, file: &[u8], optional: usize) {
    for end in 0..file.len() - optional {
        assert!(parse(&file[..end]).is_err(), "{end} bytes of {}", file.len());
    }
}

/// Overwrites bytes of a file.
pub(super) fn put<const N: usize>(file: &mut [u8], place: usize, bytes: [u8; N]) {
    file[place..place + N].copy_from_slice(&bytes);
}
