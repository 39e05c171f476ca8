//! The form of a text: a header of lines `key = value`, the heights, and a trailer, each ended by a line `*`.
//!
//! Lines end with CR LF, LF or CR; what follows a `;` is a comment. Keys are compared without regard to case.

use super::{Header, MAGIC, Revision, number, require_none};
use crate::io::bytes::{latin1, reserved, shape};
use crate::io::fault::Fault;
use crate::io::raw::{Channel, positive};

pub(super) fn parse(file: &[u8], revision: Revision) -> Result<Channel, Fault> {
    let mut text = Text { bytes: file, at: MAGIC };
    // What stands behind the name of the format is a comment, or nothing.
    text.line();
    let fields = Fields(text.clone());
    skip_fields(&mut text)?;

    if let Some((code, at)) = fields.code("Compression", &COMPRESSIONS)? {
        require_none("Compression", code, at)?;
    }
    if let Some((code, at)) = fields.code("CheckType", &CHECK_TYPES)? {
        require_none("CheckType", code, at)?;
    }
    let (data_type, at) =
        fields.code("DataType", &DATA_TYPES)?.ok_or_else(|| fields.missing("DataType"))?;
    let (scale, at_scale) = fields.number("Zscale")?;
    let header = Header {
        revision,
        shape: shape(fields.number("NumPoints")?.0, fields.number("NumProfiles")?.0)?,
        number: number(data_type, at)?,
        spacing: (fields.number("Xscale")?.0, fields.number("Yscale")?.0),
        scale: positive("Zscale", scale, at_scale)?,
    };
    let (heights, note) = heights(&header, &mut text)?;
    Ok(header.channel(heights, note))
}

/// The names that BCR allows in place of codes.
const COMPRESSIONS: [(&str, u64); 3] = [("NULL", 0), ("NONE", 0), ("RLL", 1)];
const CHECK_TYPES: [(&str, u64); 3] = [("NULL", 0), ("NONE", 0), ("UINTTRACE", 1)];
const DATA_TYPES: [(&str, u64); 8] = [
    ("UCHAR", 0),
    ("UINTEGER", 1),
    ("ULONGINT", 2),
    ("FLOAT", 3),
    ("CHAR", 4),
    ("INTEGER", 5),
    ("LONGINT", 6),
    ("DOUBLE", 7),
];

/// Goes behind the line `*` that ends the header.
fn skip_fields(text: &mut Text) -> Result<(), Fault> {
    while let Some((_, line)) = text.line() {
        if line == b"*" {
            return Ok(());
        }
    }
    Err(Fault::at(text.at, "the file ends, but a line '*' after the header was expected"))
}

/// The heights, and what is to be told of their end.
fn heights(header: &Header, text: &mut Text) -> Result<(Vec<f64>, Option<String>), Fault> {
    let (nx, ny) = header.shape;
    let nodes = header.nodes();
    let start = text.at;
    // A digit for each, and what separates two of them.
    if text.left() < 2 * nodes - 1 {
        return Err(Fault::at(
            start,
            format!(
                "{nx} x {ny} heights do not fit into the {} bytes from here to the end",
                text.left()
            ),
        ));
    }
    let mut heights = reserved(nodes)?;
    let mut ended = false;
    while let Some((at, word)) = text.word() {
        if word == b"*" {
            ended = true;
            break;
        }
        if heights.len() == nodes {
            return Err(Fault::at(
                at,
                format!("expected '*' after {nx} x {ny} heights, but found '{}'", shown(word)),
            ));
        }
        heights.push(header.height(value(word, at)?));
    }
    if heights.len() < nodes {
        return Err(Fault::at(
            text.at,
            format!("expected {nx} x {ny} heights, but only {} are there", heights.len()),
        ));
    }
    let cut = !ended && text.bytes.last().is_some_and(|end| !end.is_ascii_whitespace());
    let note =
        cut.then(|| "the file ends with its last height, which may be cut short".to_string());
    Ok((heights, note))
}

/// A number, or `BAD` for none.
fn value(word: &[u8], at: usize) -> Result<f64, Fault> {
    if word.eq_ignore_ascii_case(b"BAD") {
        return Ok(f64::NAN);
    }
    std::str::from_utf8(word).ok().and_then(|word| word.parse().ok()).ok_or_else(|| {
        Fault::at(at, format!("expected a height, BAD or '*', but found '{}'", shown(word)))
    })
}

/// The header: lines `key = value`, in any order.
struct Fields<'a>(Text<'a>);

impl<'a> Fields<'a> {
    /// The value of a key, and where its line is.
    fn find(&self, name: &str) -> Option<(usize, &'a [u8])> {
        let mut text = self.0.clone();
        while let Some((at, line)) = text.line().filter(|(_, line)| *line != b"*") {
            let end = line
                .iter()
                .position(|byte| *byte == b'=' || byte.is_ascii_whitespace())
                .unwrap_or(line.len());
            let (key, value) = line.split_at(end);
            if key.eq_ignore_ascii_case(name.as_bytes()) {
                let value = value.trim_ascii_start();
                return Some((at, value.strip_prefix(b"=").unwrap_or(value).trim_ascii()));
            }
        }
        None
    }

    fn missing(&self, name: &str) -> Fault {
        Fault::at(self.0.at, format!("the header lacks {name}"))
    }

    /// The number that is the value of a key, and where its line is.
    fn number<T: std::str::FromStr>(&self, name: &str) -> Result<(T, usize), Fault> {
        let (at, value) = self.find(name).ok_or_else(|| self.missing(name))?;
        let number = parsed(value).ok_or_else(|| not_a_number(name, value, at))?;
        Ok((number, at))
    }

    /// The value of a key that is a code or the name of one, and where its line is.
    fn code(&self, name: &str, names: &[(&str, u64)]) -> Result<Option<(u64, usize)>, Fault> {
        let Some((at, value)) = self.find(name) else {
            return Ok(None);
        };
        names
            .iter()
            .find(|(name, _)| value.eq_ignore_ascii_case(name.as_bytes()))
            .map(|(_, code)| *code)
            .or_else(|| parsed(value))
            .map(|code| Some((code, at)))
            .ok_or_else(|| not_a_number(name, value, at))
    }
}

fn parsed<T: std::str::FromStr>(value: &[u8]) -> Option<T> {
    std::str::from_utf8(value).ok()?.parse().ok()
}

fn not_a_number(name: &str, value: &[u8], at: usize) -> Fault {
    Fault::at(at, format!("{name} is '{}', but a number was expected", shown(value)))
}

/// The beginning of a text, for an error.
fn shown(text: &[u8]) -> String {
    latin1(&text[..text.len().min(40)])
}

/// A place in the file.
#[derive(Debug, Clone)]
struct Text<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Text<'a> {
    fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// Bytes from here to the first of which this is true, or to the end.
    fn until(&mut self, end: impl Fn(u8) -> bool) -> &'a [u8] {
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(|byte| end(*byte)).unwrap_or(rest.len());
        self.at += length;
        &rest[..length]
    }

    /// The rest of this line without blanks around it and comments, and where it begins; none at the end of the file.
    fn line(&mut self) -> Option<(usize, &'a [u8])> {
        if self.left() == 0 {
            return None;
        }
        let at = self.at;
        let line = self.until(ends_line);
        // CR LF makes a line without anything, which is no harm.
        self.at = self.bytes.len().min(self.at + 1);
        let comment = line.iter().position(|byte| *byte == b';');
        Some((at, line[..comment.unwrap_or(line.len())].trim_ascii()))
    }

    /// The next word that is in no comment, and where it begins.
    fn word(&mut self) -> Option<(usize, &'a [u8])> {
        loop {
            self.until(|byte| !byte.is_ascii_whitespace());
            let at = self.at;
            let word = self.until(|byte| byte.is_ascii_whitespace() || byte == b';');
            if !word.is_empty() {
                return Some((at, word));
            }
            if self.left() == 0 {
                return None;
            }
            self.until(ends_line);
        }
    }
}

fn ends_line(byte: u8) -> bool {
    byte == b'\n' || byte == b'\r'
}
