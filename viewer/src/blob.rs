//! Numbers as text: planes of bytes, deflated, in base 64.

use miniz_oxide::deflate::compress_to_vec_zlib;
use serde_json::{Value, json};

/// How hard is tried to make it short: with 9, twice the time gains a fortieth.
const LEVEL: u8 = 6;

/// Bytes, deflated, as the page inflates them.
pub(crate) fn deflated(bytes: &[u8]) -> String {
    base64(&compress_to_vec_zlib(bytes, LEVEL))
}

/// Whole numbers, byte by byte from the lowest: small ones have few planes, and each plane deflates well.
pub(crate) fn planes(values: &[u32]) -> Value {
    let greatest = values.iter().copied().max().unwrap_or(0);
    let count = (32 - greatest.leading_zeros()).div_ceil(8);
    let bytes = |plane: u32| values.iter().map(move |value| (value >> (8 * plane)) as u8);
    let bytes: Vec<u8> = (0..count).flat_map(bytes).collect();
    json!({"count": values.len(), "planes": count, "data": deflated(&bytes)})
}

/// The same for numbers of which each is near the one before: by their differences, small ones first whatever their
/// sign.
pub(crate) fn differences(values: &[i32]) -> Value {
    let mut before = 0_i32;
    let change = |&value: &i32| {
        let change = value.wrapping_sub(before);
        before = value;
        ((change << 1) ^ (change >> 31)) as u32
    };
    planes(&values.iter().map(change).collect::<Vec<_>>())
}

/// RFC 4648, section 4.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let bits =
            (0..3).fold(0, |bits, i| bits << 8 | u32::from(group.get(i).copied().unwrap_or(0)));
        for i in 0..4 {
            let digit = DIGITS[(bits >> (18 - 6 * i)) as usize % 64];
            text.push(if i <= group.len() { char::from(digit) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The examples of the RFC.
    #[test]
    fn base_64_is_that_of_the_rfc() {
        for (bytes, text) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
        assert_eq!(base64(&[0xff, 0xef, 0xbe]), "/+++");
    }

    #[test]
    fn small_numbers_have_few_planes() {
        for (greatest, count) in [(0, 0), (1, 1), (255, 1), (256, 2), (65_536, 3), (u32::MAX, 4)] {
            assert_eq!(planes(&[0, greatest])["planes"], count, "{greatest}");
        }
    }
}
