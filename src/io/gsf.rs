//! Gwyddion Simple Field, `.gsf`.
//!
//! Source: Gwyddion's user guide, chapter "Gwyddion Simple Field file format".

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use nalgebra::DMatrix;

use super::bytes::{Bytes, shape};
use super::fault::Fault;
use super::raw::{Channel, Parsed, decode};
use crate::{Error, Grid};

const MAGIC: &str = "Gwyddion Simple Field 1.0\n";

pub(super) fn parse(file: &[u8]) -> Parsed {
    let mut bytes = Bytes::new(file);
    bytes.take(MAGIC.len())?;
    let at = bytes.offset();
    let text = std::str::from_utf8(bytes.until(0)?)
        .map_err(|error| Fault::at(at + error.valid_up_to(), "expected UTF-8"))?;
    let header = Header { text, at };
    let (nx, ny) = shape(header.count("XRes")?, header.count("YRes")?)?;
    let data = bytes.offset().next_multiple_of(4);
    bytes.seek(data)?;
    let values = decode(bytes.elements(nx * ny, 4)?, 4, |b| {
        b.try_into()
            .map_or(f64::NAN, |b| f64::from(f32::from_le_bytes(b)))
    })?;
    if bytes.left() > 0 {
        return Err(Fault::at(
            bytes.offset(),
            format!(
                "{nx} x {ny} heights end here, but {} bytes follow",
                bytes.left()
            ),
        ));
    }
    // Sides default to 1 in the format, which is no size of any surface.
    let side = |name| header.length(name);
    let cell = match (side("XReal")?, side("YReal")?) {
        (Some(x), Some(y)) => Some((x / nx as f64, y / ny as f64)),
        _ => None,
    };
    let unit = |name| {
        header
            .value(name)
            .filter(|unit| !unit.is_empty())
            .map(str::to_string)
    };
    Ok(vec![Channel {
        name: header.value("Title").unwrap_or_default().to_string(),
        shape: (nx, ny),
        values,
        height_unit: unit("ZUnits"),
        cell,
        lateral_unit: unit("XYUnits"),
        mask: None,
        notes: Vec::new(),
    }])
}

/// The lines `name = value` of the header.
struct Header<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Header<'a> {
    fn value(&self, name: &str) -> Option<&'a str> {
        self.text
            .lines()
            .filter_map(|line| line.split_once('='))
            .find(|(key, _)| key.trim() == name)
            .map(|(_, value)| value.trim())
    }

    fn count(&self, name: &str) -> Result<u64, Fault> {
        let value = self
            .value(name)
            .ok_or_else(|| Fault::at(self.at, format!("expected a line '{name} = '")))?;
        value.parse().map_err(|_| {
            Fault::at(
                self.at,
                format!("{name} is '{value}', but a number of nodes was expected"),
            )
        })
    }

    fn length(&self, name: &str) -> Result<Option<f64>, Fault> {
        let parse = |value: &str| {
            value.parse().map_err(|_| {
                Fault::at(
                    self.at,
                    format!("{name} is '{value}', but a length was expected"),
                )
            })
        };
        self.value(name).map(parse).transpose()
    }
}

/// Writes heights \[m\] on their grid as a Gwyddion Simple Field, which holds seven digits of each; NaN stays NaN.
///
/// An existing file is overwritten.
///
/// # Errors
///
/// [`Error::GridMismatch`] if the grid has another shape, and [`FileError::Io`](crate::FileError::Io) if the file cannot be written.
pub fn write_gsf(path: impl AsRef<Path>, grid: &Grid, heights: &DMatrix<f64>) -> Result<(), Error> {
    grid.check_shape(heights.shape())?;
    let path = path.as_ref();
    File::create(path)
        .and_then(|file| write(BufWriter::new(file), grid, heights))
        .map_err(|error| Fault::Io(error).in_file(path, "Gwyddion Simple Field"))
}

fn write(mut output: impl Write, grid: &Grid, heights: &DMatrix<f64>) -> std::io::Result<()> {
    let (nx, ny) = grid.shape();
    let (lx, ly) = grid.sides();
    let header = format!(
        "{MAGIC}XRes = {nx}\nYRes = {ny}\nXReal = {lx:e}\nYReal = {ly:e}\nXYUnits = m\nZUnits = m\n"
    );
    output.write_all(header.as_bytes())?;
    // One to four zeros, so that the numbers begin at a multiple of four.
    output.write_all(&[0; 4][..4 - header.len() % 4])?;
    for height in heights.iter() {
        output.write_all(&(*height as f32).to_le_bytes())?;
    }
    output.flush()
}
