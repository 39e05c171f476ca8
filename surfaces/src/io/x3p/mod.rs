//! ISO 25178-72 (before: ISO 5436-2), `.x3p`.
//!
//! A zip archive with a description, `main.xml`, the heights in a member of their own, `bindata/data.bin`, and checksums.
//! Archives packed by hand hold all of it in a folder. Points that were not measured are NaN, or, where heights are
//! integers, marked in `bindata/valid.bin`, one bit for each point, the least significant first.
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
use super::raw::{Channel, Parsed, decode};

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
        Points::Listed(values) => {
            let scale = scale(&record);
            values.iter().map(|value| scale(*value)).collect()
        }
        Points::Linked(data, valid) => {
            let mut values = linked(&mut archive, &record, data, &mut notes)?;
            if let Some(valid) = valid {
                drop_invalid(&mut archive, valid, &mut values, &mut notes)?;
            }
            values
        }
    };
    if record.rotated {
        notes.push("the axes of the file are rotated, which is not applied".to_string());
    }
    Ok(vec![Channel { notes, ..Channel::in_metres(record.shape, values, Some(record.cell)) }])
}

/// Metres for a stored number.
fn scale(record: &Record) -> impl Fn(f64) -> f64 {
    let (increment, offset) = (record.increment, record.offset);
    move |value| {
        // Without an offset nothing is added: -0 would become 0.
        if offset == 0.0 { value * increment } else { value * increment + offset }
    }
}

/// The heights in a member of the archive.
fn linked(
    archive: &mut Archive,
    record: &Record,
    link: &Link,
    notes: &mut Vec<String>,
) -> Result<Vec<f64>, Fault> {
    let (nx, ny) = record.shape;
    let size = record.number.size();
    let bytes = archive.data(&link.path, (nx * ny).saturating_mul(size))?;
    compare(&link.path, &bytes, link.md5.as_deref(), notes);
    let scale = scale(record);
    decode(&bytes, size, |bytes| scale(record.number.decode(bytes)))
}

/// Takes away the heights of points that are marked as not valid.
fn drop_invalid(
    archive: &mut Archive,
    link: &Link,
    values: &mut [f64],
    notes: &mut Vec<String>,
) -> Result<(), Fault> {
    let bits = archive.data(&link.path, values.len().div_ceil(8))?;
    compare(&link.path, &bits, link.md5.as_deref(), notes);
    for (eight, byte) in values.chunks_mut(8).zip(bits) {
        for (bit, value) in eight.iter_mut().enumerate() {
            if byte >> bit & 1 == 0 {
                *value = f64::NAN;
            }
        }
    }
    Ok(())
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
