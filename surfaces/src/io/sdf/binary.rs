//! The binary form: a header of fixed length, the heights, and anything after them.

use super::{Header, MAGIC, Revision, number, require_none};
use crate::io::bytes::{Bytes, shape};
use crate::io::fault::Fault;
use crate::io::number::positive;
use crate::io::raw::Channel;

/// Manufacturer, and dates of creation and of the last change.
const NAMES: usize = 10 + 12 + 12;

/// What Olympus writes between header and heights of files that it calls ISO-1.0.
const OLYMPUS: [u8; 8] = [5, 0, 0, 0, 1, 0, 0, 0];

pub(super) fn parse(file: &[u8], revision: Revision) -> Result<Channel, Fault> {
    let mut bytes = Bytes::from(file, MAGIC)?;
    bytes.take(NAMES)?;
    let mut count = || match revision {
        Revision::Iso2 => bytes.u32(),
        Revision::Iso1 | Revision::Bcr => bytes.u16().map(u32::from),
    };
    let counts = (count()?, count()?);
    let spacing = (bytes.f64()?, bytes.f64()?);
    let at = bytes.offset();
    let scale = positive("Zscale", bytes.f64()?, at)?;
    let _resolution = bytes.f64()?;
    let at = bytes.offset();
    let [compression, data_type, check] = bytes.array()?;
    require_none("Compression", compression.into(), at)?;
    let number = number(data_type.into(), at + 1)?;
    require_none("CheckType", check.into(), at + 2)?;
    let (nx, ny) = shape(counts.0, counts.1)?;
    let header = Header { revision, shape: (nx, ny), number, spacing, scale };

    let mut note = None;
    let length = (nx * ny).saturating_mul(number.size());
    let longer = bytes.left() == length.saturating_add(OLYMPUS.len());
    if revision == Revision::Iso1 && longer && file[bytes.offset()..].starts_with(&OLYMPUS) {
        bytes.take(OLYMPUS.len())?;
        note = Some("8 bytes before the heights, which Olympus adds, are skipped".to_string());
    }
    let heights = number.decode_all(bytes.take(length)?, |value| header.height(value))?;
    Ok(header.channel(heights, note))
}
