//! Numbers and names in quotes, as spreadsheets and data frames write them.

use std::borrow::Cow;

use super::header::{may_part_thousands, shown};
use super::table::Table;
use crate::io::fault::Fault;

/// The numbers in quotes whose comma became a point.
#[derive(Debug, Default)]
pub(super) struct Commas {
    count: usize,
    first: String,
    /// Whether one of them at least cannot part thousands.
    are_decimal: bool,
}

impl Commas {
    fn add(&mut self, number: &str) {
        if self.count == 0 {
            self.first = number.to_string();
        }
        self.count += 1;
        self.are_decimal |= !may_part_thousands(number);
    }

    /// Refuses commas that may part thousands, unless all numbers have one: then three digits are behind each point.
    pub(super) fn check(&self, table: &Table) -> Result<(), Fault> {
        let numbers = table.values.iter().filter(|number| number.is_finite()).count();
        ensure!(
            self.are_decimal || self.count == 0 || self.count >= numbers,
            "the comma of '{}' in quotes parts thousands or is a decimal one, while other numbers have none: write it \
             as a point, or leave it out",
            shown(&self.first)
        );
        Ok(())
    }
}

/// The text with blanks for quotes, so that every other byte keeps its place.
///
/// A comma inside of quotes parts nothing: in a number it is a decimal comma, which becomes a point unless `;` parts
/// the numbers of the line, or, beside a point or another comma, it parts thousands, which are no numbers to this
/// crate; between words it is a blank.
pub(super) fn removed(file: &[u8]) -> (Cow<'_, [u8]>, Commas) {
    let mut commas = Commas::default();
    if !file.contains(&b'"') {
        return (file.into(), commas);
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
            unquote(quoted, if has_cells { b',' } else { b'.' }, &mut commas);
            rest = after;
        }
    }
    (text.into(), commas)
}

/// Clears quotes and what is between them of signs that part cells.
fn unquote(quoted: &mut [u8], decimal_sign: u8, commas: &mut Commas) {
    let is_number = |byte: &u8| byte.is_ascii_digit() || b"+-.,eE \"".contains(byte);
    let is_number = quoted.iter().all(is_number);
    let is_decimal = quoted.iter().filter(|byte| matches!(byte, b',' | b'.')).count() == 1;
    if is_number && is_decimal && decimal_sign == b'.' && quoted.contains(&b',') {
        commas.add(String::from_utf8_lossy(quoted).trim_matches(['"', ' ']));
    }
    for byte in quoted {
        *byte = match *byte {
            b',' if is_number && is_decimal => decimal_sign,
            b',' if is_number => b'\'',
            b',' | b';' | b'\t' | b'"' => b' ',
            other => other,
        };
    }
}
