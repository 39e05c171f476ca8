//! ISO 25178-71, `.sdf`, versions 1.0 and 2.0, and its ancestor BCR, all of them as text and binary.
//!
//! Sources: ISO 25178-71; Stout et al., report EUR 15178 EN (1993), for BCR; the readers `sdfio` 2.0 and Gwyddion's
//! `sdfile.c` where these two are silent.
//!
//! Spacings and heights are in metres: the height of a node is its value times `Zscale`. A node is missing where its
//! value is the least of its type (ISO) or the greatest (BCR, and all unsigned types), NaN, or, of a floating-point
//! type, so large that it can only be a marker. The types of numbers are those of both families in each of them:
//! instruments do not keep to the standard there.
//!
//! A profile is a map of one line; instruments write 0 or anything else for its spacing along y, which is not used.
//!
//! What follows the heights, a trailer, may be anything and is not read.

mod ascii;
mod binary;

use super::bytes::Bytes;
use super::fault::Fault;
use super::number::Number;
use super::profile;
use super::raw::{Channel, Parsed};

/// Bytes of `bISO-1.0` and the like.
const MAGIC: usize = 8;

/// How files begin, `a` for text and `b` for binary.
pub(super) const BEGINS: &[&[u8]] = &[
    b"aISO-1.0",
    b"bISO-1.0",
    b"aISO-2.0",
    b"bISO-2.0",
    b"aBCR-",
    b"bBCR-",
    b"ABCR-",
    b"BBCR-",
    b"aBCR -",
    b"aNPL-",
];

pub(super) fn parse(file: &[u8]) -> Parsed {
    let magic: [u8; MAGIC] = Bytes::new(file).array()?;
    let revision = match &magic[1..] {
        b"ISO-1.0" => Revision::Iso1,
        b"ISO-2.0" => Revision::Iso2,
        // The National Physical Laboratory calls its profiles NPL.
        [b'B', b'C', b'R', b'-' | b' ', ..] | [b'N', b'P', b'L', b'-', ..] => Revision::Bcr,
        _ => bail!(at(1), "the file is neither of ISO-1.0, nor of ISO-2.0, nor of BCR"),
    };
    let is_text = magic[0].eq_ignore_ascii_case(&b'a');
    let parse = if is_text { ascii::parse } else { binary::parse };
    Ok(vec![parse(file, revision)?])
}

/// What the format has been through.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Revision {
    Bcr,
    Iso1,
    Iso2,
}

/// What the header says of the heights.
#[derive(Debug, Clone, Copy)]
struct Header {
    revision: Revision,
    /// Nodes along x (`NumPoints`) and y (`NumProfiles`).
    shape: (usize, usize),
    /// Type of the values.
    number: Number,
    /// `Xscale` and `Yscale` \[m\].
    spacing: (f64, f64),
    /// Metres for a value of 1.
    scale: f64,
}

impl Header {
    /// The height of a node \[m\], NaN if its value says that it is missing.
    fn height(&self, value: f64) -> f64 {
        let missing = match self.number {
            // The limits that BCR names; they are a little inside those of the types.
            Number::F32 => value.abs() >= 3.4e38,
            Number::F64 => value.abs() >= 1.7e308,
            _ => value == self.marker(),
        };
        if missing { f64::NAN } else { value * self.scale }
    }

    /// The integer that marks a missing node.
    fn marker(&self) -> f64 {
        let bcr = self.revision == Revision::Bcr;
        match self.number {
            Number::U8 => f64::from(u8::MAX),
            Number::U16 => f64::from(u16::MAX),
            Number::U32 => f64::from(u32::MAX),
            Number::I8 => f64::from(if bcr { i8::MAX } else { i8::MIN }),
            Number::I16 => f64::from(if bcr { i16::MAX } else { i16::MIN }),
            Number::I32 => f64::from(if bcr { i32::MAX } else { i32::MIN }),
            Number::F32 | Number::F64 | Number::I64 | Number::U64 => f64::NAN,
        }
    }

    /// The map of these heights.
    fn channel(&self, heights: Vec<f64>, note: Option<String>) -> Channel {
        let mut channel = match self.shape.1 {
            1 => profile::channel(heights, self.spacing.0),
            _ => Channel::in_metres(self.shape, heights, Some(self.spacing)),
        };
        channel.notes.extend(note);
        channel.notes.extend(self.least_in_bcr(&channel.values));
        channel
    }

    /// Some writers of BCR mark missing nodes as ISO does: the report of BCR says otherwise, so this is only told.
    fn least_in_bcr(&self, heights: &[f64]) -> Option<String> {
        let least = match (self.revision, self.number) {
            (Revision::Bcr, Number::I16) => f64::from(i16::MIN),
            (Revision::Bcr, Number::I32) => f64::from(i32::MIN),
            _ => return None,
        };
        let lowest = self.height(least);
        let count = heights.iter().filter(|height| **height == lowest).count();
        (count > 0).then(|| {
            let (holds, are) = match count {
                1 => ("1 node holds".to_string(), "it is taken as a height"),
                _ => (format!("{count} nodes hold"), "they are taken as heights"),
            };
            format!(
                "{holds} {least}, the marker of missing nodes in ISO files; in this BCR file the marker is {}, and {are}",
                self.marker()
            )
        })
    }
}

/// The type of numbers that a code names, BCR's types and ISO's alike.
fn number(code: u64, at: usize) -> Result<Number, Fault> {
    Ok(match code {
        0 => Number::U8,
        1 => Number::U16,
        2 => Number::U32,
        3 => Number::F32,
        4 => Number::I8,
        5 => Number::I16,
        6 => Number::I32,
        7 => Number::F64,
        _ => bail!(at(at), "DataType is {code}, but it has to be 0 to 7"),
    })
}

/// Compressed heights, and check sums among them, are in no file that anybody has shown.
fn require_none(name: &str, code: u64, at: usize) -> Result<(), Fault> {
    ensure!(code == 0, at(at), "{name} is {code}, but only files without it (0) are read");
    Ok(())
}

#[cfg(test)]
mod tests;
