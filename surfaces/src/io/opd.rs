//! Wyko's and Veeco's Vision, `.opd`: the heights of an interferometer.
//!
//! Sources: SurfaceTopography's `OPD.py`, Gwyddion's `wykofile.c`, surfalize's `opd.py`; a file of an instrument.
//!
//! A directory of names, types and lengths, then the blocks in its order. Heights lie column after column, each from
//! below. They are in waves of light, floating-point or in integers of `1/Mult`.

use std::collections::HashMap;

use super::bytes::{Bytes, latin1, reserved, shape, shared, text_before_zero};
use super::fault::Fault;
use super::number::{Number, positive};
use super::raw::{Channel, Parsed};

pub(super) const BEGINS: &[u8] = b"\x01\x00Directory\0";

/// Bytes before the directory, and of an entry and a name in it.
const VERSION: usize = 2;
const ENTRY: usize = 24;
const NAME: usize = 16;

/// Blocks that are read, besides those of heights.
const KNOWN: [&str; 5] = ["Mult", "Wavelength", "Pixel_size", "Aspect", "Title"];

/// Blocks of heights.
const HEIGHTS: [&str; 6] = ["RAW_DATA", "RAW DATA", "Raw", "OPD", "SAMPLE_DATA", "SAMPLE DATA"];

/// Integers from here on, and floating-point numbers, stand for missing heights.
const MISSING: [f64; 2] = [32766.0, 1e10];

/// mm in a nanometre.
const NANOMETRE: f64 = 1e-6;

pub(super) fn parse(file: &[u8]) -> Parsed {
    let mut bytes = Bytes::from(file, VERSION)?;
    let (_, _, length) = entry(&mut bytes)?;
    let count = length / ENTRY;
    let mut place = VERSION.saturating_add(length);
    let mut directory = Bytes::new(bytes.elements(count.saturating_sub(1), ENTRY)?);
    let mut blocks: HashMap<String, Block> = HashMap::new();
    let mut heights: Vec<(String, Block)> = Vec::new();
    while directory.left() > 0 {
        let (name, kind, length) = entry(&mut directory)?;
        if HEIGHTS.contains(&name.as_str()) && length > 0 {
            heights.push((name, Block { kind, place, length }));
        } else if KNOWN.contains(&name.as_str()) {
            blocks.insert(name, Block { kind, place, length });
        }
        place = place.saturating_add(length);
    }
    let number = |name: &str| blocks.get(name).map(|block| block.number(file, name)).transpose();
    let wavelength = number("Wavelength")?;
    let pixel = number("Pixel_size")?;
    let aspect = number("Aspect")?.unwrap_or(1.0);
    let title =
        blocks.get("Title").map(|block| Ok::<_, Fault>(shared(&latin1(block.bytes(file)?))));
    let title = title.transpose()?.unwrap_or_default();
    let scale = Scale { wavelength, mult: number("Mult")? };
    heights
        .into_iter()
        .map(|(name, block)| {
            let (shape, values) = scale.image(&block, file)?;
            let channel = Channel {
                name: if title.is_empty() { name } else { format!("{title} ({name})") },
                height_unit: Some(if wavelength.is_some() { "mm" } else { "waves" }.to_string()),
                lateral_unit: Some("mm".to_string()),
                ..Channel::in_metres(shape, values, pixel.map(|pixel| (pixel, pixel * aspect)))
            };
            Ok(channel.turned())
        })
        .collect()
}

/// Name, type and length of the block that an entry announces.
fn entry(bytes: &mut Bytes) -> Result<(String, u16, usize), Fault> {
    let name = text_before_zero(bytes.take(NAME)?);
    let (kind, length, _flags) = (bytes.u16()?, bytes.u32()? as usize, bytes.u16()?);
    Ok((name, kind, length))
}

/// Where a block lies.
struct Block {
    kind: u16,
    place: usize,
    length: usize,
}

impl Block {
    fn bytes<'a>(&self, file: &'a [u8]) -> Result<&'a [u8], Fault> {
        Bytes::from(file, self.place)?.take(self.length)
    }

    /// Its number, which has to be positive.
    fn number(&self, file: &[u8], name: &str) -> Result<f64, Fault> {
        let mut bytes = Bytes::new(self.bytes(file)?);
        let number = match self.kind {
            6 => f64::from(bytes.i16()?),
            7 => f64::from(bytes.f32()?),
            8 => bytes.f64()?,
            12 => f64::from(bytes.i32()?),
            other => bail!(at(self.place), "'{name}' has the type {other}, which is no number"),
        };
        positive(&format!("'{name}'"), number, self.place)
    }
}

/// What a number of an image is worth.
struct Scale {
    /// In nm.
    wavelength: Option<f64>,
    /// Integers in a wave.
    mult: Option<f64>,
}

impl Scale {
    /// Shape and heights of the image in a block: in mm, or in waves.
    fn image(&self, block: &Block, file: &[u8]) -> Result<((usize, usize), Vec<f64>), Fault> {
        let at = block.place;
        let mut bytes = Bytes::new(block.bytes(file)?);
        let (nx, ny) = shape(bytes.u16()?, bytes.u16()?)?;
        let size = bytes.u16()?;
        let (number, missing, parts) = match size {
            2 => (Number::I16, MISSING[0], self.mult.unwrap_or(1.0)),
            4 => (Number::F32, MISSING[1], 1.0),
            _ => bail!(
                at(at + 4),
                "the heights have {size} bytes each, but two or four were expected"
            ),
        };
        let unit = self.wavelength.map_or(1.0, |wavelength| wavelength * NANOMETRE) / parts;
        let data = bytes.elements(nx * ny, number.size())?;
        let mut values = reserved(nx * ny)?;
        for iy in 0..ny {
            let row = data.chunks_exact(number.size()).skip(iy).step_by(ny);
            values.extend(row.map(|bytes| {
                let value = number.decode(bytes.iter().rev());
                if value >= missing { f64::NAN } else { value * unit }
            }));
        }
        Ok(((nx, ny), values))
    }
}
