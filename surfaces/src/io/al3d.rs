//! Alicona, `.al3d`: the depth image.
//!
//! Sources: Gwyddion's `alicona.c`, Bio-Formats' `AliconaReader`, SurfaceTopography's `AL3D.py`; a file of an
//! instrument.
//!
//! A magic string, then tags of 52 bytes (key, value, CR LF), the second of which says how many follow. The depth
//! image lies where a tag says: rows of float32, each padded to a multiple of eight bytes, in metres. A node is
//! missing where it holds `InvalidPixelValue` or NaN. Icon and texture are not read.

use super::bytes::{Bytes, reserved, shape, text_before_zero};
use super::fault::Fault;
use super::number::{Number, parsed};
use super::raw::{Channel, Parsed};

const MAGIC: &[u8] = b"AliconaImaging\0\r\n";

/// Bytes of a tag, and of its key and value.
const TAG: usize = 52;
const KEY: usize = 20;
const VALUE: usize = 30;

/// Of the marker of missing nodes: it is written with as many digits as float32 has, or a few more.
const TOLERANCE: f64 = 2.0 * f32::EPSILON as f64;

pub(super) fn parse(file: &[u8]) -> Parsed {
    let tags = Tags::read(file)?;
    let (nx, ny) = shape(tags.number::<u64>("Cols")?, tags.number::<u64>("Rows")?)?;
    let cell = (tags.number("PixelSizeXMeter")?, tags.number("PixelSizeYMeter")?);
    let offset: u64 = tags.number("DepthImageOffset")?;
    ensure!(offset != 0, "there is no depth image in it: DepthImageOffset is 0");
    let missing = match tags.find("InvalidPixelValue") {
        Some(_) => tags.number("InvalidPixelValue")?,
        None => f64::NAN,
    };

    let mut bytes = Bytes::from(file, usize::try_from(offset).unwrap_or(usize::MAX))?;
    let row = nx * Number::F32.size();
    let stride = row.next_multiple_of(8);
    // The padding of the last row may be absent.
    let data = bytes.take((ny - 1).saturating_mul(stride).saturating_add(row))?;
    let mut values = reserved(nx * ny)?;
    for row in data.chunks(stride).flat_map(|padded| padded.get(..row)) {
        values.extend(row.chunks_exact(Number::F32.size()).map(|value| {
            let value = Number::F32.decode(value.iter().rev());
            let is_missing = (value - missing).abs() <= TOLERANCE * missing.abs();
            if is_missing { f64::NAN } else { value }
        }));
    }
    Ok(vec![Channel::in_metres((nx, ny), values, Some(cell))])
}

/// The tags of a file.
struct Tags<'a>(&'a [u8]);

impl<'a> Tags<'a> {
    fn read(file: &'a [u8]) -> Result<Self, Fault> {
        let mut bytes = Bytes::new(file);
        ensure!(
            bytes.take(MAGIC.len())? == MAGIC,
            at(0),
            "the file does not begin with 'AliconaImaging', a zero and CR LF"
        );
        // The version, and the number of tags after these two.
        let first = Self(bytes.elements(2, TAG)?);
        let count = first.number("TagCount")?;
        let start = bytes.offset();
        let tags = Self(bytes.elements(count, TAG)?);
        for (k, tag) in (1..).zip(tags.0.chunks_exact(TAG)) {
            let end = start + k * TAG - 2;
            ensure!(tag.ends_with(b"\r\n"), at(end), "expected CR LF at the end of tag {k}");
        }
        Ok(tags)
    }

    fn find(&self, key: &str) -> Option<String> {
        self.0
            .chunks_exact(TAG)
            .map(|tag| tag.split_at(KEY))
            .find(|(found, _)| text_before_zero(found) == key)
            .map(|(_, value)| text_before_zero(&value[..VALUE]))
    }

    fn number<T: std::str::FromStr>(&self, key: &str) -> Result<T, Fault> {
        let value = self.find(key).ok_or_else(|| fault!("there is no tag {key}"))?;
        parsed(&format!("tag {key}"), &value, None)
    }
}

#[cfg(test)]
mod tests;
