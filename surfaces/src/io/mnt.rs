//! Documents of Digital Surf's Mountains, `.mnt`: the surfaces in them.
//!
//! Sources: a document of Mountains 9, whose heights SurfaceTopography and this reader find the same, and what the
//! former says of blocks.
//!
//! A compound document, whose stream `ScopedContents` is a tree of items: a tag, a length, and data or further items.
//! In some places the tag is left out. An object that has axes x and y, numbers, and an axis z is a surface. An axis
//! has a spacing and an offset with their units. Numbers are i32 in blocks of zlib, in any order, each behind its
//! place, its count and its compressed length. The axis z also says the least and the greatest number: what lies beyond
//! is no height.

use std::io::Read;

use flate2::read::ZlibDecoder;

use super::bytes::{Bytes, shape};
use super::compound;
use super::fault::Fault;
use super::number::Number;
use super::raw::{Channel, Parsed};
use crate::number::counted;

pub(super) use super::compound::BEGINS;

const STREAM: &str = "ScopedContents";
/// What an item inherits.
const BASE: u16 = 0xffff;
/// Items within each other that are looked at.
const DEPTH: usize = 24;
/// Bytes that deflate makes of one, at most.
const MAX_EXPANSION: usize = 1032;

pub(super) fn parse(file: &[u8]) -> Parsed {
    let stream = compound::stream(file, STREAM)?.ok_or_else(|| {
        fault!("it is a compound document (OLE), but without the stream '{STREAM}' of Mountains")
    })?;
    let mut channels = Vec::new();
    collect(&stream, DEPTH, &mut channels)?;
    Ok(channels)
}

/// The surfaces among items and within them.
fn collect(data: &[u8], depth: usize, channels: &mut Vec<Channel>) -> Result<(), Fault> {
    if depth == 0 {
        return Ok(());
    }
    let within = match Items::of(data) {
        Some(items) => match Object::of(&items) {
            Some(object) => {
                channels.push(object.channel()?);
                return Ok(());
            }
            None => items.0.into_iter().map(|(_, data)| data).collect(),
        },
        None => parts(data).unwrap_or_default(),
    };
    within.into_iter().try_for_each(|data| collect(data, depth - 1, channels))
}

/// Data behind their length, one after the other; `None` if these are none.
fn parts(data: &[u8]) -> Option<Vec<&[u8]>> {
    let mut bytes = Bytes::new(data);
    let mut parts = Vec::new();
    while bytes.left() > 0 {
        let length = usize::try_from(bytes.u64().ok()?).ok()?;
        parts.push(bytes.take(length).ok()?);
    }
    Some(parts)
}

/// Items beside each other.
struct Items<'a>(Vec<(u16, &'a [u8])>);

impl<'a> Items<'a> {
    /// `None` for data that are no items.
    fn of(data: &'a [u8]) -> Option<Self> {
        let mut bytes = Bytes::new(data);
        let mut items = Vec::new();
        while bytes.left() > 0 {
            let tag = bytes.u16().ok()?;
            let length = usize::try_from(bytes.u64().ok()?).ok()?;
            items.push((tag, bytes.take(length).ok()?));
        }
        (!items.is_empty()).then_some(Self(items))
    }

    fn data(&self, tag: u16) -> Option<&'a [u8]> {
        self.0.iter().find(|(found, _)| *found == tag).map(|(_, data)| *data)
    }

    /// The items within an item.
    fn within(&self, tag: u16) -> Option<Self> {
        Self::of(self.data(tag)?)
    }

    fn u32(&self, tag: u16) -> Option<u32> {
        Some(u32::from_le_bytes(self.data(tag)?.try_into().ok()?))
    }

    fn f64(&self, tag: u16) -> Option<f64> {
        Some(f64::from_le_bytes(self.data(tag)?.try_into().ok()?))
    }

    /// A text, in UTF-16 behind a byte that says so.
    fn text(&self, tag: u16) -> Option<String> {
        let letters = self.data(tag)?.strip_prefix(&[4])?.chunks_exact(2);
        let letters: Vec<u16> =
            letters.map(|pair| u16::from_le_bytes([pair[0], pair[1]])).collect();
        Some(String::from_utf16_lossy(&letters))
    }
}

/// An axis: what its numbers count, and where they begin.
struct Axis {
    spacing: f64,
    unit: String,
    /// In the same unit.
    offset: f64,
}

impl Axis {
    fn of(items: &Items) -> Option<Self> {
        let (spacing, unit) = (items.f64(1)?, items.text(2)?);
        // The offset counts in the unit that people are shown, of so many of the other.
        Some(Self { spacing, unit, offset: items.f64(5)? * items.f64(4)? })
    }
}

/// A surface.
struct Object<'a> {
    name: String,
    axes: [(Axis, u32); 2],
    z: Axis,
    /// The least and the greatest number.
    range: (i32, i32),
    count: u32,
    blocks: &'a [u8],
}

impl<'a> Object<'a> {
    /// `None` for items of anything else.
    fn of(items: &Items<'a>) -> Option<Self> {
        let plane = items.within(BASE)?;
        let axis = |tag| {
            let counted = plane.within(tag)?.within(BASE)?;
            Some((Axis::of(&counted.within(BASE)?)?, counted.u32(1)?))
        };
        let numbers = items.within(1)?.within(2)?;
        let z = items.within(2)?;
        let bound = |tag| Some(z.u32(tag)? as i32);
        let name = plane.within(BASE).and_then(|base| base.within(BASE)?.text(1));
        Some(Self {
            name: name.unwrap_or_default(),
            axes: [axis(1)?, axis(2)?],
            range: (bound(1)?, bound(2)?),
            z: Axis::of(&z.within(BASE)?)?,
            count: numbers.u32(1)?,
            blocks: numbers.data(2)?,
        })
    }

    fn channel(self) -> Result<Channel, Fault> {
        let [(x, nx), (y, ny)] = self.axes;
        let (nx, ny) = shape(nx, ny)?;
        let count = self.count as usize;
        ensure!(
            count == nx * ny,
            "the surface '{}' has {count} points, but {nx} x {ny} in a map",
            self.name
        );
        ensure!(
            x.unit == y.unit,
            "the surface '{}' has x in '{}', but y in '{}'",
            self.name,
            x.unit,
            y.unit
        );
        let (least, greatest) = (f64::from(self.range.0), f64::from(self.range.1));
        let Axis { spacing, unit, offset } = self.z;
        ensure!(
            spacing.is_finite() && spacing != 0.0 && offset.is_finite(),
            "the heights of '{}' count {spacing} and begin at {offset}",
            self.name
        );
        let data = inflate(self.blocks, count)?;
        let height = |number: f64| match (least..=greatest).contains(&number) {
            true => number * spacing + offset,
            false => f64::NAN,
        };
        let values = Number::I32.decode_all(&data, height)?;
        let missing = values.iter().filter(|value| value.is_nan()).count();
        let note = (missing > 0).then(|| {
            format!(
                "{} beyond the numbers {least} to {greatest} that the file says to be heights, and taken as missing",
                match missing {
                    1 => "1 node is".to_string(),
                    _ => format!("{} are", counted(missing, "node")),
                }
            )
        });
        Ok(Channel {
            name: self.name,
            height_unit: Some(unit),
            lateral_unit: Some(x.unit),
            notes: note.into_iter().collect(),
            ..Channel::in_metres((nx, ny), values, Some((x.spacing, y.spacing)))
        })
    }
}

/// The numbers of blocks, in the order of their places.
fn inflate(blocks: &[u8], count: usize) -> Result<Vec<u8>, Fault> {
    let mut bytes = Bytes::new(blocks);
    let length = bytes.u64()?;
    ensure!(length == 4 * count as u64, "{count} heights take {length} bytes, as the file says");
    let mut found = Vec::new();
    while bytes.left() > 0 {
        let (place, numbers, length) = (bytes.u64()?, bytes.u32()? as usize, bytes.u32()? as usize);
        let block = bytes.take(length)?;
        ensure!(
            numbers.saturating_mul(4) <= MAX_EXPANSION.saturating_mul(length),
            "no {length} compressed bytes can hold {numbers} heights, as a block claims"
        );
        found.push((place, numbers, block));
    }
    found.sort_by_key(|(place, ..)| *place);
    let mut data: Vec<u8> = Vec::new();
    for (place, numbers, block) in found {
        ensure!(
            place == data.len() as u64 / 4 && (data.len() / 4).saturating_add(numbers) <= count,
            "a block of {numbers} heights is at {place}, but {} of {count} are before it",
            data.len() / 4
        );
        // One byte more than that shows a block that is too long.
        let wanted = numbers.saturating_mul(4);
        let read = ZlibDecoder::new(block).take(wanted as u64 + 1).read_to_end(&mut data);
        let read = read.map_err(|error| fault!("the compressed heights are damaged: {error}"))?;
        ensure!(read == wanted, "a block of {numbers} heights holds {read} bytes");
    }
    let found = data.len() / 4;
    ensure!(found == count, "there are {found} of {count} heights");
    Ok(data)
}
