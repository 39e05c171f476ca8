//! Sensofar, `.plu`: the heights of a confocal microscope or an interferometer.
//!
//! Sources: SurfaceTopography's `PLU.py`, Gwyddion's `sensofar.c`, surfalize's `plu.py`; a file of an instrument.
//!
//! Date and comment, the calibration with the size of a pixel in micrometres, the settings, the numbers of rows and
//! columns, and the heights in micrometres. A node of 1 000 001 is missing. Images may follow, which are not read.

use super::bytes::{Bytes, shape};
use super::number::{Number, positive};
use super::raw::{Channel, Parsed};

/// Places of the size of a pixel, of the kind of the measurement, and of the numbers of rows and columns.
const PIXEL: usize = 404;
const KIND: usize = 428;
const SHAPE: usize = 500;

/// The kind that is a surface, and the names of all, from 0 on.
const SURFACE: u32 = 3;
const KINDS: &str =
    "an image|a profile|several profiles|a surface|coordinates|a thickness|something of its own";

const MISSING: f64 = 1_000_001.0;

/// Whether a file begins with a date as the language C writes it, `Fri Mar 10 16:35:59 2023`, and a zero.
pub(super) fn looks_like(file: &[u8]) -> bool {
    const DATE: &[u8] = b"aaa aaa 00 00:00:00 0000\0";
    file.len() > SHAPE
        && DATE.iter().zip(file).all(|(sign, found)| match sign {
            b'a' => found.is_ascii_alphabetic(),
            b'0' => found.is_ascii_digit() || *found == b' ',
            other => found == other,
        })
}

pub(super) fn parse(file: &[u8]) -> Parsed {
    let kind = Bytes::from(file, KIND)?.u32()?;
    let name = KINDS.split('|').nth(kind as usize).unwrap_or("something unknown");
    ensure!(kind == SURFACE, at(KIND), "it holds {name} (type {kind}), but a surface was expected");
    let mut sizes = Bytes::from(file, PIXEL)?;
    let mut pixel = |name: &str| positive(name, f64::from(sizes.f32()?), PIXEL);
    let cell = (pixel("the size of a pixel along x")?, pixel("the size of a pixel along y")?);
    let mut bytes = Bytes::from(file, SHAPE)?;
    let (rows, columns) = (bytes.u32()?, bytes.u32()?);
    let (nx, ny) = shape(columns, rows)?;
    let height = |value: f64| if value >= MISSING { f64::NAN } else { value };
    let values = Number::F32.decode_all(bytes.elements(nx * ny, 4)?, height)?;
    let unit = || Some("µm".to_string());
    Ok(vec![Channel {
        height_unit: unit(),
        lateral_unit: unit(),
        ..Channel::in_metres((nx, ny), values, Some(cell))
    }])
}
