//! The binary form: a header of fixed length, the heights, and anything after them.

use super::{Header, MAGIC, Revision, number, require_none};
use crate::io::bytes::{Bytes, shape};
use crate::io::fault::Fault;
use crate::io::raw::{Channel, decode, positive};

/// Manufacturer, and dates of creation and of the last change.
const NAMES: usize = 10 + 12 + 12;

/// What Olympus writes between header and heights of files that it calls ISO-1.0.
const OLYMPUS: [u8; 8] = [5, 0, 0, 0, 1, 0, 0, 0];

pub(super) fn parse(file: &[u8], revision: Revision) -> Result<Channel, Fault> {
    let mut bytes = Bytes::new(file);
    bytes.seek(MAGIC)?;
    bytes.take(NAMES)?;
    let mut count = || match revision {
        Revision::Iso2 => bytes.u32().map(u64::from),
        Revision::Iso1 | Revision::Bcr => bytes.u16().map(u64::from),
    };
    let counts = (count()?, count()?);
    let spacing = (bytes.f64()?, bytes.f64()?);
    let at = bytes.offset();
    let scale = positive("Zscale", bytes.f64()?, at)?;
    let _resolution = bytes.f64()?;
    let mut code = || {
        let at = bytes.offset();
        bytes.u8().map(|code| (u64::from(code), at))
    };
    let (compression, at) = code()?;
    require_none("Compression", compression, at)?;
    let (data_type, at) = code()?;
    let number = number(data_type, at)?;
    let (check, at) = code()?;
    require_none("CheckType", check, at)?;
    let header = Header { revision, shape: shape(counts.0, counts.1)?, number, spacing, scale };

    let mut note = None;
    let length = header.nodes().saturating_mul(number.size());
    let rest = &file[bytes.offset()..];
    if revision == Revision::Iso1
        && rest.len() == length.saturating_add(OLYMPUS.len())
        && rest.starts_with(&OLYMPUS)
    {
        bytes.take(OLYMPUS.len())?;
        note = Some("8 bytes before the heights, which Olympus adds, are skipped".to_string());
    }
    let data = bytes.elements(header.nodes(), number.size())?;
    let heights = decode(data, number.size(), |value| header.height(number.decode(value)))?;
    Ok(header.channel(heights, note))
}
