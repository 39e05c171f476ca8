//! Digital Surf, `.sur` and `.pro`, plain and compressed.
//!
//! Sources: the readers of surfalize, SurfaceTopography, RosettaSciIO and Gwyddion (`surffile.c`), which agree on the
//! layout; two files of instruments.
//!
//! A header of 512 bytes, a comment and a private zone, then integers of 16 or 32 bits. The height of a node is its
//! value times the spacing along z, plus the offset along z, both in the unit of that spacing; these readers differ in
//! the offset, which changes no difference of heights. A node is missing if the header says that there are such nodes
//! and its value lies two below the least height.
//!
//! Compressed heights are zlib streams. Deflate makes at most 1032 bytes of one: a stream that claims more is not
//! read, so the memory for a file is bounded by its length, if by a larger multiple than in other formats.
//!
//! A profile is a study of one line, which has lengths along x and z alone.
//!
//! A surface with colours, with intensities or with both has them in further objects behind it, which are not read.

use std::borrow::Cow;
use std::io::Read;

use flate2::read::ZlibDecoder;

use super::bytes::{Bytes, shape, text_before_zero};
use super::fault::Fault;
use super::number::{Number, positive};
use super::profile;
use super::raw::{Channel, Parsed};
use super::unit::LengthUnit;

/// Bytes of the header.
const HEADER: usize = 512;

/// Bytes that deflate makes of one, at most: 258 of two bits.
const MAX_EXPANSION: u64 = 1032;

pub(super) const BEGINS: &[&[u8]] = &[b"DIGITAL SURF", b"DSCOMPRESSED"];

/// Types of studies.
const PROFILE: u16 = 1;
const SURFACE: u16 = 2;

/// Types of studies whose first object is a surface, and other objects images of it.
const WITH_IMAGES: [u16; 3] = [11, 13, 16];

pub(super) fn parse(file: &[u8]) -> Parsed {
    let mut bytes = Bytes::new(file);
    let compressed = bytes.take(HEADER)?.starts_with(b"DSCOMPRESSED");
    let header = Header::read(file)?;
    bytes.take(header.comments)?;
    let (nx, ny) = header.shape;
    let length = (nx * ny).saturating_mul(header.number.size());
    let data = if compressed {
        Cow::Owned(inflate(&mut bytes, length)?)
    } else {
        Cow::Borrowed(bytes.take(length)?)
    };
    let mut notes = Vec::new();
    if header.has_images {
        notes.push("the colours or intensities behind the heights are not read".to_string());
    } else {
        bytes.end(format_args!("{nx} x {ny} heights"))?;
    }
    let values = header.number.decode_all(&data, |value| header.height(value))?;
    let (map, lateral_unit) = if header.is_profile {
        (profile::channel(values, header.spacing.0), header.units.0)
    } else {
        let (cell, unit) = header.cell();
        (Channel::in_metres((nx, ny), values, Some(cell)), unit)
    };
    Ok(vec![Channel { name: header.name, height_unit: header.units.2, lateral_unit, notes, ..map }])
}

/// What the header says of the heights.
#[derive(Debug)]
struct Header {
    /// Name of the z axis.
    name: String,
    shape: (usize, usize),
    is_profile: bool,
    /// Whether images follow the heights.
    has_images: bool,
    number: Number,
    /// Bytes between header and heights.
    comments: usize,
    /// Value of a missing node.
    missing: Option<f64>,
    /// Spacing along x, y and z.
    spacing: (f64, f64, f64),
    offset: f64,
    /// Units of the spacings.
    units: (Option<String>, Option<String>, Option<String>),
}

impl Header {
    fn read(file: &[u8]) -> Result<Self, Fault> {
        let field = |offset| Bytes::from(file, offset);
        let count = |offset| field(offset)?.u16();
        let length = |offset| field(offset)?.f32().map(f64::from);
        let text = |offset| Ok::<_, Fault>(text_before_zero(field(offset)?.take(16)?));
        let unit = |offset| Ok::<_, Fault>(Some(text(offset)?).filter(|text| !text.is_empty()));
        ensure!(
            count(12)? != 257,
            at(12),
            "the format is 257, big-endian, but only files in little-endian order are read"
        );
        let (nx, ny) = (field(108)?.u32()?, field(112)?.u32()?);
        let kind = count(18)?;
        require_heights(kind)?;
        let has_images = WITH_IMAGES.contains(&kind);
        let objects = count(14)?;
        ensure!(
            objects <= 1 || has_images,
            at(14),
            "there are {objects} objects in the file, but only files with one are read"
        );
        let number = match count(98)? {
            16 => Number::I16,
            32 => Number::I32,
            bits => bail!(at(98), "the heights have {bits} bits each, but 16 or 32 were expected"),
        };
        let nodes = u64::from(field(116)?.u32()?);
        ensure!(
            nodes == u64::from(nx) * u64::from(ny),
            at(116),
            "there are {nodes} points in the file, but {nx} x {ny} in a map"
        );
        let special_points = count(86)? == 1;
        let least = f64::from(field(100)?.i32()?);
        let offset = length(474)?;
        ensure!(
            offset.is_finite(),
            at(474),
            "the offset of the heights is {offset}, which is not finite"
        );
        let step = positive("the spacing along z", length(128)?, 128)?;
        Ok(Self {
            name: text(164)?,
            shape: shape(nx, ny)?,
            // Gwyddion calls the maps that it writes profiles.
            is_profile: kind == PROFILE && ny == 1,
            has_images,
            number,
            comments: usize::from(count(334)?) + usize::from(count(336)?),
            missing: special_points.then_some(least - 2.0),
            spacing: (length(120)?, length(124)?, step),
            offset,
            units: (unit(180)?, unit(196)?, unit(212)?),
        })
    }

    fn height(&self, value: f64) -> f64 {
        if self.missing == Some(value) { f64::NAN } else { value * self.spacing.2 + self.offset }
    }

    /// The cell and its unit: metres where x and y have two units.
    fn cell(&self) -> ((f64, f64), Option<String>) {
        let (dx, dy, _) = self.spacing;
        let (x, y, _) = &self.units;
        if x == y {
            return ((dx, dy), x.clone());
        }
        let length = |unit: &Option<String>| LengthUnit::in_file(unit.as_ref()?);
        match (length(x), length(y)) {
            (Some(x), Some(y)) => {
                let metre = LengthUnit::METRE.symbol().to_string();
                ((dx * x.metres(), dy * y.metres()), Some(metre))
            }
            // The unit that is no length is the one to be told.
            (Some(_), None) => ((dx, dy), y.clone()),
            (None, _) => ((dx, dy), x.clone()),
        }
    }
}

/// The types of studies that the format knows, from 0 on.
const TYPES: &str = "something unknown|a profile|a surface|a binary image|a series of profiles|a series of surfaces|\
    a meridian disc|a profile with layers|a surface with layers|a parallel disc|an intensity image|\
    a surface with intensities|a colour image|a surface with colours|a force curve|a series of force curves|\
    a surface with colours and intensities|a parametric profile|a series of colour images|something unknown|\
    a spectrum|a map of spectra";

fn require_heights(kind: u16) -> Result<(), Fault> {
    if [PROFILE, SURFACE].contains(&kind) || WITH_IMAGES.contains(&kind) {
        return Ok(());
    }
    let name = TYPES.split('|').nth(kind.into()).unwrap_or("something unknown");
    bail!(
        at(18),
        "it holds {name} (type {kind}), but a surface (type 2) or a profile (type 1) was expected"
    )
}

/// The heights of a compressed file: a number of streams, the length of each before and after compression, and the
/// streams.
fn inflate(bytes: &mut Bytes, length: usize) -> Result<Vec<u8>, Fault> {
    let at = bytes.offset();
    let streams = bytes.u32()? as usize;
    let mut directory = Bytes::new(bytes.elements(streams, 8)?);
    let mut lengths = Vec::new();
    while directory.left() > 0 {
        lengths.push((u64::from(directory.u32()?), directory.u32()?));
    }
    let claimed: u64 = lengths.iter().map(|(length, _)| length).sum();
    ensure!(
        claimed == length as u64,
        at(at),
        "{streams} compressed streams hold {claimed} bytes, but the heights take {length}"
    );
    let mut data = Vec::new();
    for (length, compressed) in lengths {
        let at = bytes.offset();
        let stream = bytes.take(compressed as usize)?;
        ensure!(
            length <= MAX_EXPANSION * u64::from(compressed),
            at(at),
            "no {compressed} compressed bytes can hold {length}, as these claim"
        );
        // Nothing is reserved for what is only claimed, and one byte more than that shows a stream that is too long.
        let found = ZlibDecoder::new(stream).take(length + 1).read_to_end(&mut data);
        let found =
            found.map_err(|error| fault!(at(at), "the compressed heights are damaged: {error}"))?;
        let more = if found as u64 > length { "more" } else { "less" };
        ensure!(
            found as u64 == length,
            at(at),
            "this compressed stream holds {more} than the {length} bytes that it claims"
        );
    }
    Ok(data)
}

#[cfg(test)]
mod tests;
