//! Numbers and names in quotes, as spreadsheets and data frames write them.

use std::borrow::Cow;

/// The text with blanks for quotes, so that every other byte keeps its place.
///
/// A comma inside of quotes parts nothing: in a number it is a decimal comma, which becomes a point unless `;` parts
/// the numbers of the line, or, beside a point or another comma, it parts thousands, which are no numbers to this
/// crate; between words it is a blank.
pub(super) fn removed(file: &[u8]) -> Cow<'_, [u8]> {
    if !file.contains(&b'"') {
        return file.into();
    }
    let mut text = file.to_vec();
    for line in text.split_mut(|byte| matches!(byte, b'\n' | b'\r')) {
        let has_cells = line.contains(&b';');
        let mut rest = line;
        while let Some(start) = rest.iter().position(|byte| *byte == b'"') {
            let (_, from) = rest.split_at_mut(start);
            let end = from.iter().skip(1).position(|byte| *byte == b'"').map(|end| end + 1);
            // A quote alone encloses nothing.
            let (quoted, after) = from.split_at_mut(end.map_or(1, |end| end + 1));
            unquote(quoted, if has_cells { b',' } else { b'.' });
            rest = after;
        }
    }
    text.into()
}

/// Clears quotes and what is between them of signs that part cells.
fn unquote(quoted: &mut [u8], decimal_sign: u8) {
    let is_number = |byte: &u8| byte.is_ascii_digit() || b"+-.,eE \"".contains(byte);
    let is_number = quoted.iter().all(is_number);
    let is_decimal = quoted.iter().filter(|byte| matches!(byte, b',' | b'.')).count() == 1;
    for byte in quoted {
        *byte = match *byte {
            b',' if is_number && is_decimal => decimal_sign,
            b',' if is_number => b'\'',
            b',' | b';' | b'\t' | b'"' => b' ',
            other => other,
        };
    }
}
