//! The form of a text: a header of lines `key = value`, the heights, and a trailer, each ended by a line `*`.
//!
//! Lines end with CR LF, LF or CR; what follows a `;` is a comment. Keys are compared without regard to case.

use super::{Header, MAGIC, Revision, number, require_none};
use crate::io::bytes::{latin1, reserved, shape};
use crate::io::fault::Fault;
use crate::io::lines::Lines;
use crate::io::number::{parsed, positive};
use crate::io::raw::Channel;

pub(super) fn parse(file: &[u8], revision: Revision) -> Result<Channel, Fault> {
    let mut lines = Lines::new(file, MAGIC);
    // What stands behind the name of the format is a comment, or nothing.
    lines.next();
    let fields = Fields(lines.clone());
    let is_end = |line: &[u8]| without_comment(line).trim_ascii() == b"*";
    ensure!(
        lines.any(|line| is_end(line.bytes)),
        at(file.len()),
        "the file ends, but a line '*' after the header was expected"
    );
    if let Some((code, at)) = fields.code("Compression", &[("NULL", 0), ("NONE", 0), ("RLL", 1)])? {
        require_none("Compression", code, at)?;
    }
    let checks = [("NULL", 0), ("NONE", 0), ("UINTTRACE", 1)];
    if let Some((code, at)) = fields.code("CheckType", &checks)? {
        require_none("CheckType", code, at)?;
    }
    let (data_type, at) =
        fields.code("DataType", &DATA_TYPES)?.ok_or_else(|| fields.lacks("DataType"))?;
    let (scale, at_scale) = fields.number("Zscale")?;
    let counts: (u64, u64) = (fields.number("NumPoints")?.0, fields.number("NumProfiles")?.0);
    let header = Header {
        revision,
        shape: shape(counts.0, counts.1)?,
        number: number(data_type, at)?,
        spacing: (fields.number("Xscale")?.0, fields.number("Yscale")?.0),
        scale: positive("Zscale", scale, at_scale)?,
    };
    let (heights, is_ended) = heights(&header, file.len(), lines)?;
    let is_cut = !is_ended && file.last().is_some_and(|end| !end.is_ascii_whitespace());
    let note = "the file ends with its last height, which may be cut short";
    Ok(header.channel(heights, is_cut.then(|| note.to_string())))
}

/// The names that BCR allows in place of codes.
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

/// The heights, and whether a `*` ends them.
fn heights(header: &Header, end: usize, lines: Lines) -> Result<(Vec<f64>, bool), Fault> {
    let (nx, ny) = header.shape;
    let (nodes, left) = (nx * ny, lines.rest().len());
    // A digit for each, and what separates two of them.
    ensure!(
        left >= 2 * nodes - 1,
        at(end - left),
        "{nx} x {ny} heights do not fit into the {left} bytes from here to the end"
    );
    let mut heights = reserved(nodes)?;
    let mut is_ended = false;
    'lines: for line in lines {
        let mut at = line.offset;
        for word in without_comment(line.bytes).split(u8::is_ascii_whitespace) {
            is_ended = word == b"*";
            if is_ended {
                break 'lines;
            }
            if !word.is_empty() {
                let found = || latin1(&word[..word.len().min(40)]);
                ensure!(
                    heights.len() < nodes,
                    at(at),
                    "expected '*' after {nx} x {ny} heights, but found '{}'",
                    found()
                );
                let value = value(word).ok_or_else(|| {
                    fault!(at(at), "expected a height, BAD or '*', but found '{}'", found())
                })?;
                heights.push(header.height(value));
            }
            at += word.len() + 1;
        }
    }
    let found = heights.len();
    ensure!(found == nodes, at(end), "expected {nx} x {ny} heights, but only {found} are there");
    Ok((heights, is_ended))
}

/// A number, or `BAD` for none.
fn value(word: &[u8]) -> Option<f64> {
    let is_bad = word.eq_ignore_ascii_case(b"BAD");
    if is_bad { Some(f64::NAN) } else { std::str::from_utf8(word).ok()?.parse().ok() }
}

fn without_comment(line: &[u8]) -> &[u8] {
    line.split(|byte| *byte == b';').next().unwrap_or_default()
}

/// The header: lines `key = value`, in any order, up to a line `*`.
struct Fields<'a>(Lines<'a>);

impl Fields<'_> {
    /// The value of a key, and where its line is.
    fn find(&self, name: &str) -> Option<(String, usize)> {
        for line in self.0.clone() {
            let text = without_comment(line.bytes).trim_ascii();
            if text == b"*" {
                break;
            }
            let end = text.iter().position(|byte| *byte == b'=' || byte.is_ascii_whitespace());
            let (key, value) = text.split_at(end.unwrap_or(text.len()));
            if key.eq_ignore_ascii_case(name.as_bytes()) {
                let value = latin1(value);
                let value = value.strip_prefix('=').unwrap_or(&value).trim();
                return Some((value.to_string(), line.offset));
            }
        }
        None
    }

    fn lacks(&self, name: &str) -> Fault {
        fault!(at(MAGIC), "the header lacks {name}")
    }

    /// The number that is the value of a key, and where its line is.
    fn number<T: std::str::FromStr>(&self, name: &str) -> Result<(T, usize), Fault> {
        let (value, at) = self.find(name).ok_or_else(|| self.lacks(name))?;
        Ok((parsed(name, &value, at)?, at))
    }

    /// The value of a key that is a code or the name of one, and where its line is.
    fn code(&self, name: &str, names: &[(&str, u64)]) -> Result<Option<(u64, usize)>, Fault> {
        let Some((value, at)) = self.find(name) else {
            return Ok(None);
        };
        let named = names.iter().find(|(name, _)| value.eq_ignore_ascii_case(name));
        let code = named.map_or_else(|| parsed(name, &value, at), |(_, code)| Ok(*code))?;
        Ok(Some((code, at)))
    }
}
