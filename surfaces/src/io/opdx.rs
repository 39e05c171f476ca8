//! Bruker's Vision64 and Dektak, `.opdx`: the maps and profiles of a profilometer.
//!
//! Sources: SurfaceTopography's `OPDx.py`, Gwyddion's `dektakvca.c`; a file of an instrument, which holds a profile.
//!
//! A tree of named items: a length and a name, a byte for the type, and what that asks for. Maps are containers in
//! `2D_Data`, each with its numbers (`Matrix`, float32), their scale (`DataScale`), and points and extents (from the
//! first node to the last) of two dimensions, the first of which is y. Profiles are those in `1D_Data`: heights
//! (`Array`), their scale, and positions (`PositionArray`).

use super::bytes::{Bytes, latin1, shape};
use super::fault::Fault;
use super::number::Number;
use super::profile;
use super::raw::{Channel, Parsed};
use super::unit::LengthUnit;

pub(super) const BEGINS: &[u8] = b"VCA DATA\x01\x00\x00\x55";

/// Numbers from here on stand for missing heights.
const MISSING: f64 = 1e30;

pub(super) fn parse(file: &[u8]) -> Parsed {
    let mut channels = Vec::new();
    for item in Items::new(Bytes::from(file, BEGINS.len())?) {
        match item? {
            (b"2D_Data", Item::Container(maps)) => take(&mut channels, maps, map_in)?,
            (b"1D_Data", Item::Container(profiles)) => take(&mut channels, profiles, profile_in)?,
            _ => {}
        }
    }
    Ok(channels)
}

/// What the containers among these items hold.
fn take(channels: &mut Vec<Channel>, items: Bytes, read: Reader) -> Result<(), Fault> {
    for item in Items::new(items) {
        if let (name, Item::Container(items)) = item? {
            channels.extend(read(latin1(name), items)?);
        }
    }
    Ok(())
}

type Reader = fn(String, Bytes) -> Result<Option<Channel>, Fault>;

/// The profile in a container, if there is one.
fn profile_in(name: String, items: Bytes) -> Result<Option<Channel>, Fault> {
    let (mut heights, mut positions) = (None, None);
    let (mut scale, mut unit_of_x, mut stated) = (None, None, None);
    for item in Items::new(items) {
        match item? {
            (b"Array", Item::Array(found)) => heights = Some(found),
            (b"PositionArray", Item::Array(found)) => positions = Some(found),
            (b"DataScale", Item::Quantity(value, unit)) => scale = Some((value, unit)),
            (b"Extent", Item::Quantity(_, unit)) => unit_of_x = Some(unit),
            (b"NumPoints", Item::Number(count)) => stated = Some(count),
            _ => {}
        }
    }
    let (Some(heights), Some(positions)) = (heights, positions) else {
        return Ok(None);
    };
    let (count, places) = (heights.count(), positions.count());
    let stated = stated.unwrap_or(count as f64);
    ensure!(
        count == places && stated == count as f64,
        "a profile states {stated} points, but has {count} heights and {places} positions"
    );
    shape(count, 1)?;
    let (factor, unit) = scale.unwrap_or((1.0, String::new()));
    let mut notes = Vec::new();
    let heights = heights.values(|value| height(value, factor))?;
    let (heights, step) =
        profile::on_even_steps(positions.values(|position| position)?, heights, &mut notes)?;
    Ok(Some(Channel {
        name,
        height_unit: Some(unit).filter(|unit| !unit.is_empty()),
        lateral_unit: unit_of_x,
        notes,
        ..profile::channel(heights, step)
    }))
}

/// A height, NaN where its number stands for none.
fn height(value: f64, factor: f64) -> f64 {
    if value >= MISSING { f64::NAN } else { value * factor }
}

/// The map in a container, if there is one.
fn map_in(name: String, items: Bytes) -> Result<Option<Channel>, Fault> {
    let (mut matrix, mut scale) = (None, None);
    let (mut extents, mut points) = ([None, None], [None, None]);
    for item in Items::new(items) {
        match item? {
            (b"Matrix", Item::Matrix(found)) => matrix = Some(found),
            (b"DataScale", Item::Quantity(value, unit)) => scale = Some((value, unit)),
            (b"Dimension1Extent", Item::Quantity(value, unit)) => extents[1] = Some((value, unit)),
            (b"Dimension2Extent", Item::Quantity(value, unit)) => extents[0] = Some((value, unit)),
            (b"Dimension1Points", Item::Number(count)) => points[1] = Some(count),
            (b"Dimension2Points", Item::Number(count)) => points[0] = Some(count),
            _ => {}
        }
    }
    let Some(Matrix { shape: (nx, ny), data }) = matrix else {
        return Ok(None);
    };
    for (name, stated, found) in [("x", points[0], nx), ("y", points[1], ny)] {
        if let Some(stated) = stated {
            ensure!(
                stated == found as f64,
                "there are {found} points along {name}, but {stated} are stated"
            );
        }
    }
    let (factor, unit) = scale.unwrap_or((1.0, String::new()));
    let (cell, lateral_unit) = match extents {
        [Some((lx, x)), Some((ly, y))] => {
            let metres = |unit: &str| LengthUnit::in_file(unit).map(LengthUnit::metres);
            let ratio =
                if x == y { Some(1.0) } else { metres(&y).zip(metres(&x)).map(|(y, x)| y / x) };
            let ratio = ratio.ok_or_else(|| fault!("x is in '{x}', but y in '{y}'"))?;
            let cell = |extent: f64, n: usize| extent / n.saturating_sub(1).max(1) as f64;
            (Some((cell(lx, nx), cell(ly * ratio, ny))), Some(x))
        }
        _ => (None, None),
    };
    Ok(Some(Channel {
        name,
        height_unit: Some(unit).filter(|unit| !unit.is_empty()),
        lateral_unit,
        ..Channel::in_metres(
            (nx, ny),
            Number::F32.decode_all(data, |value| height(value, factor))?,
            cell,
        )
    }))
}

/// Numbers of a map.
struct Matrix<'a> {
    shape: (usize, usize),
    data: &'a [u8],
}

/// Numbers of a profile.
struct Array<'a> {
    number: Number,
    data: &'a [u8],
}

impl<'a> Array<'a> {
    /// Numbers behind the code of their type and the length of each, `None` if they are no floating-point numbers.
    fn read(content: &'a [u8]) -> Option<Self> {
        let (number, data) = match content {
            [0x0c, 4, 0, 0, 0, data @ ..] => (Number::F32, data),
            [0x0d, 8, 0, 0, 0, data @ ..] => (Number::F64, data),
            _ => return None,
        };
        Some(Self { number, data })
    }

    fn count(&self) -> usize {
        self.data.len() / self.number.size()
    }

    fn values(&self, map: impl Fn(f64) -> f64) -> Result<Vec<f64>, Fault> {
        self.number.decode_all(self.data, map)
    }
}

/// What a name stands for.
enum Item<'a> {
    Number(f64),
    Quantity(f64, String),
    Container(Bytes<'a>),
    Matrix(Matrix<'a>),
    Array(Array<'a>),
    /// Something that neither map nor profile needs.
    Other,
}

/// The items in some bytes.
struct Items<'a>(Option<Bytes<'a>>);

impl<'a> Items<'a> {
    fn new(bytes: Bytes<'a>) -> Self {
        Self(Some(bytes))
    }
}

impl<'a> Iterator for Items<'a> {
    type Item = Result<(&'a [u8], Item<'a>), Fault>;

    fn next(&mut self) -> Option<Self::Item> {
        let mut bytes = self.0.take()?;
        let item = read(&mut bytes).transpose()?;
        if item.is_ok() {
            self.0 = Some(bytes);
        }
        Some(item)
    }
}

/// The next item, `None` at the end.
fn read<'a>(bytes: &mut Bytes<'a>) -> Result<Option<(&'a [u8], Item<'a>)>, Fault> {
    if bytes.left() == 0 {
        return Ok(None);
    }
    let name = text(bytes)?;
    let at = bytes.offset();
    let item = match bytes.u8()? {
        // A matrix, with a name of its own or without.
        kind @ (0x00 | 0x45) => {
            text(bytes)?;
            if kind == 0x00 {
                bytes.u32()?;
                text(bytes)?;
            }
            let mut content = Bytes::new(content(bytes)?);
            let (rows, columns) = (content.u32()?, content.u32()?);
            let (nx, ny) = shape(columns, rows)?;
            Item::Matrix(Matrix { shape: (nx, ny), data: content.elements(nx * ny, 4)? })
        }
        0x01 => Item::Number(f64::from(bytes.u8()?)),
        0x04 => Item::Number(f64::from(bytes.i16()?)),
        0x05 => Item::Number(f64::from(bytes.u16()?)),
        0x06 => Item::Number(f64::from(bytes.i32()?)),
        0x07 => Item::Number(f64::from(bytes.u32()?)),
        0x0a => Item::Number(bytes.i64()? as f64),
        0x0b => Item::Number(bytes.u64()? as f64),
        0x0c => Item::Number(f64::from(bytes.f32()?)),
        0x0d => Item::Number(bytes.f64()?),
        // A text, and a unit.
        0x12 | 0x18 => {
            content(bytes)?;
            Item::Other
        }
        0x13 => {
            let mut content = Bytes::new(content(bytes)?);
            let value = content.f64()?;
            text(&mut content)?;
            let symbol = text(&mut content)?;
            Item::Quantity(
                value,
                std::str::from_utf8(symbol).map_or_else(|_| latin1(symbol), str::to_string),
            )
        }
        0x15 => {
            bytes.take(9)?;
            Item::Other
        }
        0x40 => {
            text(bytes)?;
            Array::read(content(bytes)?).map_or(Item::Other, Item::Array)
        }
        // A type, a list, positions: each with the name of its type.
        0x0e | 0x42 | 0x7c => {
            text(bytes)?;
            content(bytes)?;
            Item::Other
        }
        0x46 | 0x47 | 0x7d => Item::Container(Bytes::new(content(bytes)?)),
        0x7f => return Ok(None),
        other => bail!(at(at), "an item has the type {other:#04x}, which is not known"),
    };
    Ok(Some((name, item)))
}

/// Bytes behind their number.
fn text<'a>(bytes: &mut Bytes<'a>) -> Result<&'a [u8], Fault> {
    let length = bytes.u32()? as usize;
    bytes.take(length)
}

/// Bytes behind their number, whose own length stands before it.
fn content<'a>(bytes: &mut Bytes<'a>) -> Result<&'a [u8], Fault> {
    let at = bytes.offset();
    let length = match bytes.u8()? {
        1 => usize::from(bytes.u8()?),
        2 => usize::from(bytes.u16()?),
        4 => bytes.u32()? as usize,
        other => bail!(at(at), "a length has {other} bytes, but 1, 2 or 4 were expected"),
    };
    bytes.take(length)
}
