//! ISO 25178-72 (before: ISO 5436-2), `.x3p`.
//!
//! A zip archive with a description, `main.xml`, the heights in a member of their own, `bindata/data.bin`, and
//! checksums. Archives packed by hand hold all of it in a folder. Points that were not measured are NaN, or, where
//! heights are integers, marked in `bindata/valid.bin`, one bit for each point, the least significant first.
//!
//! A profile, of feature type PRF, is one line; its points may have positions of their own, which stand before the
//! height of each. In the order of openGPS, x, y and z, an axis of even steps takes no number. A line that is not along
//! x is as long as from point to point.
//!
//! The description and the data have to agree to the byte: a matrix whose sizes were wrong by one would be a sheared
//! surface. Checksums that do not match are common in files that circulate, and only noted.
//!
//! Source: ISO 25178-72:2017; names and namespace of opengps.eu.

mod archive;
mod record;
mod write;

use std::borrow::Cow;
use std::ops::Range;

use self::archive::{Archive, md5_of};
use self::record::{Link, Points, Record, Stored};
use super::fault::Fault;
use super::profile;
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
    let (heights, x, y) = match &record.points {
        Points::Listed(points) => {
            let along = |axis: Stored, k: usize| -> Vec<f64> {
                points.iter().map(|point| axis.metres(point[k])).collect()
            };
            (along(record.z, 2), record.x.map(|x| along(x, 0)), record.y.map(|y| along(y, 1)))
        }
        Points::Linked(data, valid) => {
            let (nx, ny) = record.shape;
            let size = |axis: Option<Stored>| axis.map_or(0, |axis| axis.number.size());
            let [before, between] = [record.x, record.y].map(size);
            let each = before + between + record.z.number.size();
            let bytes = linked(&mut archive, data, (nx * ny).saturating_mul(each), &mut notes)?;
            let column = |axis: Stored, begins: usize| {
                let bytes = column(&bytes, each, begins..begins + axis.number.size());
                axis.number.decode_all(&bytes, |number| axis.metres(number))
            };
            let mut heights = column(record.z, before + between)?;
            let x = record.x.map(|x| column(x, 0)).transpose()?;
            let y = record.y.map(|y| column(y, before)).transpose()?;
            if let Some(valid) = valid {
                let bits = linked(&mut archive, valid, heights.len().div_ceil(8), &mut notes)?;
                drop_invalid(&bits, &mut heights);
            }
            (heights, x, y)
        }
    };
    if record.rotated {
        notes.push("the axes of the file are rotated, which is not applied".to_string());
    }
    let positions = match y.filter(|y| profile::varies(y)) {
        None => x,
        Some(y) => {
            let even = || (0..y.len()).map(|k| k as f64 * record.cell.0).collect::<Vec<f64>>();
            Some(profile::along(&x.unwrap_or_else(even), &y))
        }
    };
    let map = match positions {
        Some(positions) => {
            let (heights, step) = profile::on_even_steps(positions, heights, &mut notes)?;
            profile::channel(heights, step)
        }
        None if record.is_profile => profile::channel(heights, record.cell.0),
        None => Channel::in_metres(record.shape, heights, Some(record.cell)),
    };
    Ok(vec![Channel { notes, ..map }])
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

/// Some bytes of each point, where each takes as many.
fn column(bytes: &[u8], each: usize, of_point: Range<usize>) -> Cow<'_, [u8]> {
    if of_point.len() == each {
        return Cow::Borrowed(bytes);
    }
    let points = bytes.chunks_exact(each);
    Cow::Owned(points.flat_map(|point| &point[of_point.clone()]).copied().collect())
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
