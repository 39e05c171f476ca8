//! ISO 25178-72 (before: ISO 5436-2), `.x3p`.
//!
//! A zip archive with a description, `main.xml`, the heights in a member of their own, `bindata/data.bin`, and
//! checksums. Archives packed by hand hold all of it in a folder. Points that were not measured are NaN, or, where
//! heights are integers, marked in `bindata/valid.bin`, one bit for each point, the least significant first.
//!
//! The description and the data have to agree to the byte: a matrix whose sizes were wrong by one would be a sheared
//! surface. Checksums that do not match are common in files that circulate, and only noted.
//!
//! Source: ISO 25178-72:2017; names and namespace of opengps.eu.

mod archive;
mod record;
mod write;

use self::archive::{Archive, md5_of};
use self::record::{Link, Points, Record};
use super::fault::Fault;
use super::raw::{Channel, Parsed};

#[cfg(test)]
pub(super) use self::write::write;
pub use self::write::write_x3p;

pub(super) fn parse(file: &[u8]) -> Parsed {
    let mut archive = Archive::open(file)?;
    let description = archive.description()?;
    let record = Record::read(&description, file.len())?;
    let mut notes = Vec::new();
    let link = match record.checksum.as_str() {
        "" => write::CHECKSUM,
        link => link,
    };
    let checksum = archive.checksum(link);
    compare(archive::DESCRIPTION, &description, checksum.as_deref(), &mut notes);
    drop(description);
    let values = match &record.points {
        Points::Listed(values) => values.iter().map(|value| record.height(*value)).collect(),
        Points::Linked(data, valid) => {
            let (nx, ny) = record.shape;
            let length = (nx * ny).saturating_mul(record.number.size());
            let bytes = linked(&mut archive, data, length, &mut notes)?;
            let mut values = record.number.decode_all(&bytes, |value| record.height(value))?;
            if let Some(valid) = valid {
                let bits = linked(&mut archive, valid, values.len().div_ceil(8), &mut notes)?;
                drop_invalid(&bits, &mut values);
            }
            values
        }
    };
    if record.rotated {
        notes.push("the axes of the file are rotated, which is not applied".to_string());
    }
    Ok(vec![Channel { notes, ..Channel::in_metres(record.shape, values, Some(record.cell)) }])
}

/// The bytes of a member of the archive.
fn linked(
    archive: &mut Archive,
    link: &Link,
    length: usize,
    notes: &mut Vec<String>,
) -> Result<Vec<u8>, Fault> {
    let bytes = archive.data(&link.path, length)?;
    compare(&link.path, &bytes, link.md5.as_deref(), notes);
    Ok(bytes)
}

/// Takes away the heights of points whose bit is not set.
fn drop_invalid(bits: &[u8], values: &mut [f64]) {
    for (place, value) in values.iter_mut().enumerate() {
        if bits[place / 8] >> (place % 8) & 1 == 0 {
            *value = f64::NAN;
        }
    }
}

/// Notes a checksum that does not match; one that is none says nothing.
fn compare(name: &str, bytes: &[u8], md5: Option<&str>, notes: &mut Vec<String>) {
    let Some(expected) = md5.map(str::trim).filter(|md5| md5.len() == 32) else {
        return;
    };
    let found = md5_of(bytes);
    if !found.eq_ignore_ascii_case(expected) {
        notes.push(format!("the checksum of '{name}' is {found}, but the file says {expected}"));
    }
}

#[cfg(test)]
mod tests;
