//! The lines of a text, whatever ends them.

use super::bytes::latin1;

/// The lines of a file from a place on; LF, CR LF and CR end a line.
#[derive(Debug, Clone)]
pub(super) struct Lines<'a> {
    file: &'a [u8],
    at: usize,
    number: usize,
}

/// A line without its end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line<'a> {
    pub(super) bytes: &'a [u8],
    /// Where it begins in the file.
    pub(super) offset: usize,
    /// Its number, from 1.
    pub(super) number: usize,
}

impl<'a> Lines<'a> {
    /// The lines after the first `skipped` bytes.
    pub(super) fn new(file: &'a [u8], skipped: usize) -> Self {
        Self { file, at: skipped, number: 0 }
    }

    /// All bytes that are left.
    pub(super) fn rest(&self) -> &'a [u8] {
        self.file.get(self.at..).unwrap_or_default()
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        let rest = self.rest();
        if rest.is_empty() {
            return None;
        }
        let length =
            rest.iter().position(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(rest.len());
        let (bytes, end) = rest.split_at(length);
        let offset = self.at;
        self.at += length + if end.starts_with(b"\r\n") { 2 } else { 1 };
        self.number += 1;
        Some(Line { bytes, offset, number: self.number })
    }
}

impl Line<'_> {
    /// Whether the line is a remark.
    pub(super) fn is_comment(&self) -> bool {
        let line = self.bytes.trim_ascii_start();
        matches!(line, [b'#' | b'%', ..]) && !begins_with_error(line)
    }

    /// The line as text: UTF-8, or what older programs write.
    pub(super) fn text(&self) -> String {
        std::str::from_utf8(self.bytes).map_or_else(|_| latin1(self.bytes), str::to_string)
    }
}

/// Whether the first word of a line is what a spreadsheet writes in place of a number: `#N/A`, `#NV`, `#DIV/0!`,
/// `#NAME?`, or `####` in a column that is too narrow.
fn begins_with_error(line: &[u8]) -> bool {
    let is_end = |byte: &u8| matches!(byte, b' ' | b'\t' | b';' | b',');
    let (word, rest) = line.split_at(line.iter().position(is_end).unwrap_or(line.len()));
    let begins =
        |start: &[u8]| word.get(..3).is_some_and(|begin| begin.eq_ignore_ascii_case(start));
    let is_rule = word.iter().all(|byte| *byte == b'#');
    begins(b"#N/")
        || begins(b"#NV") && word.len() == 3
        || word.starts_with(b"#") && word.ends_with(b"!")
        || word.starts_with(b"#") && word.ends_with(b"?")
        // A row of them alone, or before words, is an ornament.
        || word.len() > 1 && is_rule && matches!(rest, [b'\t' | b';' | b',', ..])
}
