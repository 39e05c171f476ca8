//! How a text writes numbers: what stands between them, what a comma means, and what stands for none.

use std::str;

use crate::io::lines::Lines;

/// What is between the cells of a row, and within numbers.
///
/// Blanks always part numbers. In addition there is one sign that makes cells, which may be empty: `;` if there is one,
/// otherwise a comma that is no decimal comma, otherwise a tab.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Dialect {
    pub(super) separator: Option<u8>,
    decimal_comma: bool,
}

/// The longest number that is read: a double in full takes 1079 digits, but nobody writes them.
const LONGEST: usize = 128;

impl Dialect {
    /// The dialect of the lines of numbers in a file.
    pub(super) fn of(lines: &Lines) -> Self {
        let rest = lines.rest();
        let semicolon = rest.contains(&b';');
        let decimal_comma =
            rest.contains(&b',') && (semicolon || commas_are_decimal(lines.clone()));
        let separator = if semicolon {
            Some(b';')
        } else if rest.contains(&b',') && !decimal_comma {
            Some(b',')
        } else if rest.contains(&b'\t') {
            Some(b'\t')
        } else {
            None
        };
        Self { separator, decimal_comma }
    }

    /// The number that a word is, NaN for one that stands for a missing value, `None` for any other word.
    pub(super) fn number(self, word: &[u8]) -> Option<f64> {
        if let Some(number) = parse(word) {
            return Some(number);
        }
        if self.decimal_comma && word.contains(&b',') {
            let mut copy = [0; LONGEST];
            let copy = copy.get_mut(..word.len())?;
            copy.copy_from_slice(word);
            for byte in copy.iter_mut().filter(|byte| **byte == b',') {
                *byte = b'.';
            }
            return parse(copy);
        }
        means_missing(word).then_some(f64::NAN)
    }
}

fn parse(word: &[u8]) -> Option<f64> {
    str::from_utf8(word).ok()?.parse().ok()
}

/// Words for a missing value, but for those that are numbers to everybody: `NaN`, `inf`.
fn means_missing(word: &[u8]) -> bool {
    const WORDS: [&str; 8] = ["bad", "na", "n/a", "#n/a", "null", "none", "missing", "masked"];
    let unsigned = match word {
        [b'+' | b'-', rest @ ..] => rest,
        _ => word,
    };
    let is_rule = |sign: u8| !word.is_empty() && word.iter().all(|byte| *byte == sign);
    let begins = |start: &str| {
        unsigned
            .get(..start.len())
            .is_some_and(|begin| begin.eq_ignore_ascii_case(start.as_bytes()))
    };
    is_rule(b'*')
        || is_rule(b'-')
        || WORDS
            .iter()
            .any(|missing| word.eq_ignore_ascii_case(missing.as_bytes()))
        // As C on Windows and on Unix write what is no number.
        || ["1.#inf", "1.#ind", "1.#qnan", "1.#snan", "nan("]
            .iter()
            .any(|start| begins(start))
}

/// Whether a line holds numbers and words for missing ones, and nothing else.
///
/// A row of stars or hyphens alone is an ornament as long as there is no number.
pub(super) fn is_row(line: &[u8]) -> bool {
    let dialect = Dialect { separator: None, decimal_comma: false };
    let mut numbers = false;
    for word in line.split(|byte| matches!(byte, b' ' | b'\t' | b';' | b',')) {
        if word.is_empty() {
            continue;
        }
        if dialect.number(word).is_none() {
            return false;
        }
        numbers |= word.iter().any(u8::is_ascii_alphanumeric);
    }
    numbers
}

/// Whether commas are decimal in lines without `;`: if numbers are parted by blanks or tabs, and no comma stands at the end of
/// one, or twice in one.
fn commas_are_decimal(lines: Lines) -> bool {
    let mut parted = false;
    for line in lines.filter(|line| !line.is_comment()) {
        let mut words = 0;
        for word in line.bytes.split(|byte| matches!(byte, b' ' | b'\t')) {
            if word.is_empty() {
                continue;
            }
            let commas = word.iter().filter(|byte| **byte == b',').count();
            if commas > 1 || word.starts_with(b",") || word.ends_with(b",") {
                return false;
            }
            words += 1;
        }
        parted |= words > 1;
    }
    parted
}
