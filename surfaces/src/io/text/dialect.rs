//! How a text writes numbers: what stands between them, what a comma means, and what stands for none.

use std::str;

use crate::io::lines::{Line, Lines};

/// What is between the cells of a row, and within numbers.
///
/// Blanks always part numbers. In addition there is one sign that makes cells, which may be empty: `;` if there is one,
/// otherwise a comma that is no decimal comma, otherwise a tab, unless blanks part numbers as well.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Dialect {
    pub(super) separator: Option<u8>,
    pub(super) decimal_comma: bool,
    /// Whether every line is digits, a comma, digits: a decimal comma would look the same.
    pub(super) has_one_comma: bool,
    /// Why commas between numbers could be decimal, if anything says so.
    pub(super) doubt: Option<&'static str>,
}

/// The longest number that is read: a double in full takes 1079 digits, but nobody writes them.
const LONGEST: usize = 128;

impl Dialect {
    /// Numbers with decimal points between blanks.
    pub(super) const BLANKS: Self =
        Self { separator: None, decimal_comma: false, has_one_comma: false, doubt: None };

    /// The dialect of the lines of numbers in a file.
    pub(super) fn of(lines: &Lines) -> Self {
        let rows = || lines.clone().filter(|line| !line.is_comment());
        let has = |sign: u8| rows().any(|line| line.bytes.contains(&sign));
        let (semicolon, comma) = (has(b';'), has(b','));
        let decimal_comma = comma && (semicolon || commas_are_decimal(rows()));
        let separator = if semicolon {
            Some(b';')
        } else if comma && !decimal_comma {
            Some(b',')
        } else if rows().any(|line| line.bytes.trim_ascii().contains(&b'\t'))
            && !rows().any(|line| is_parted_by_blanks(line.bytes))
        {
            Some(b'\t')
        } else {
            None
        };
        let has_one_comma = separator == Some(b',')
            && rows()
                .map(|line| line.bytes)
                .filter(|line| !line.trim_ascii().is_empty())
                .all(is_one_comma);
        let doubt = if separator != Some(b',') || has(b'.') {
            None
        } else if rows().any(|line| line.bytes.split(|byte| *byte == b',').any(begins_with_zero)) {
            Some("numbers parted by commas begin with zeros, as what follows a decimal comma does")
        } else if commas_are_of_two_kinds(rows()) {
            Some("blanks follow some commas, but others stand within numbers, as decimal commas do")
        } else {
            None
        };
        Self { separator, decimal_comma, has_one_comma, doubt }
    }

    /// How a text is written.
    pub(super) fn told(self) -> String {
        let parted = match self.separator {
            Some(b';') => "semicolons",
            Some(b',') => "commas",
            Some(_) => "tabs",
            None => "blanks",
        };
        format!(
            "parted by {parted}{}",
            if self.decimal_comma { ", with decimal commas" } else { "" }
        )
    }

    /// Whether this number has another decimal sign than others in the file: then one of the two parts thousands.
    pub(super) fn is_foreign(self, word: &[u8]) -> bool {
        self.decimal_comma && word.contains(&b'.') && parse(word).is_some()
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

/// A number with a decimal point; a minus may be the sign of typesetters.
fn parse(word: &[u8]) -> Option<f64> {
    let word = str::from_utf8(word).ok()?;
    match word.strip_prefix('\u{2212}') {
        Some(digits)
            if digits.starts_with(|first: char| first.is_ascii_digit() || first == '.') =>
        {
            digits.parse().ok().map(|number: f64| -number)
        }
        _ => word.parse().ok(),
    }
}

/// Words for a missing value, but for those that are numbers to everybody: `NaN`, `inf`.
fn means_missing(word: &[u8]) -> bool {
    const WORDS: [&str; 9] =
        ["bad", "na", "n/a", "#n/a", "#nv", "null", "none", "missing", "masked"];
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
    let dialect = Dialect::BLANKS;
    let mut numbers = false;
    for word in line.split(|byte| PARTS.contains(byte)) {
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

/// What parts words.
const PARTS: &[u8] = b" \t;,";

/// How many cells a line has, by each sign that may part them, and by blanks.
pub(super) struct Cells {
    signs: [usize; 3],
    words: usize,
}

impl Cells {
    pub(super) fn of(line: &[u8]) -> Self {
        let count = |sign: u8| line.iter().filter(|byte| **byte == sign).count();
        let words = line.split(|byte| PARTS.contains(byte)).filter(|word| !word.is_empty());
        Self { signs: [count(b';'), count(b','), count(b'\t')], words: words.count() }
    }

    /// Whether a line above has empty cells and stars or hyphens only, and as many: then all heights in it are missing.
    pub(super) fn are_all_missing_in(&self, line: &[u8]) -> bool {
        let above = Self::of(line);
        let is_same = |(above, below): (usize, usize)| above > 0 && above == below;
        let only = |mark: u8| line.iter().all(|byte| *byte == mark || PARTS.contains(byte));
        let has_cells = above.signs.into_iter().zip(self.signs).any(is_same);
        // Hyphens between blanks underline names.
        only(b'*') && (has_cells || is_same((above.words, self.words))) || only(b'-') && has_cells
    }
}

/// Whether a line, or a word, has one comma, between two digits.
fn is_one_comma(line: &[u8]) -> bool {
    let mut parts = line.split(|byte| *byte == b',');
    let (Some(before), Some(after), None) = (parts.next(), parts.next(), parts.next()) else {
        return false;
    };
    before.last().is_some_and(u8::is_ascii_digit) && after.first().is_some_and(u8::is_ascii_digit)
}

/// Whether a cell has digits behind a first zero.
fn begins_with_zero(cell: &[u8]) -> bool {
    matches!(cell.trim_ascii(), [b'0', digit, ..] if digit.is_ascii_digit())
}

/// Whether a line has several words without a tab between any of them.
fn is_parted_by_blanks(line: &[u8]) -> bool {
    let line = line.trim_ascii();
    line.contains(&b' ') && !line.contains(&b'\t')
}

/// Whether some commas end words, and others stand between digits, one in each word at most.
fn commas_are_of_two_kinds<'a>(rows: impl Iterator<Item = Line<'a>>) -> bool {
    let (mut ends, mut inside) = (false, false);
    for line in rows {
        for word in line.bytes.split(|byte| matches!(byte, b' ' | b'\t')) {
            let whole = word.strip_suffix(b",").unwrap_or(word);
            ends |= whole.len() < word.len();
            if whole.contains(&b',') {
                if !is_one_comma(whole) {
                    return false;
                }
                inside = true;
            }
        }
    }
    ends && inside
}

/// Whether commas are decimal in lines without `;`: if numbers are parted by blanks or tabs, and no comma stands at the
/// end of one, or twice in one.
fn commas_are_decimal<'a>(rows: impl Iterator<Item = Line<'a>>) -> bool {
    let mut parted = false;
    for line in rows {
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
