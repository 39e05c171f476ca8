//! Gwyddion Simple Field, `.gsf`.
//!
//! Source: Gwyddion's user guide, chapter "Gwyddion Simple Field file format".

use std::io::Write;
use std::path::Path;

use nalgebra::DMatrix;

use super::bytes::{Bytes, shape};
use super::number::{Number, parsed};
use super::raw::{Channel, Parsed};
use super::whole_file::write_whole;
use crate::{Error, Grid};

const MAGIC: &str = "Gwyddion Simple Field 1.0\n";

pub(super) fn parse(file: &[u8]) -> Parsed {
    let mut bytes = Bytes::new(file);
    bytes.take(MAGIC.len())?;
    let at = bytes.offset();
    let text = std::str::from_utf8(bytes.until(0)?)
        .map_err(|error| fault!(at(at + error.valid_up_to()), "expected UTF-8"))?;
    // Lines `name = value`.
    let value = |name: &str| {
        let mut lines = text.lines().filter_map(|line| line.split_once('='));
        lines.find(|(key, _)| key.trim() == name).map(|(_, value)| value.trim())
    };
    let count = |name: &str| {
        let value = value(name).ok_or_else(|| fault!(at(at), "expected a line '{name} = '"))?;
        parsed::<u64>(name, value, at)
    };
    let (nx, ny) = shape(count("XRes")?, count("YRes")?)?;
    bytes.seek(bytes.offset().next_multiple_of(4))?;
    let values = Number::F32.decode_all(bytes.elements(nx * ny, 4)?, |value| value)?;
    bytes.end(format_args!("{nx} x {ny} heights"))?;
    let length = |name| value(name).map(|value| parsed::<f64>(name, value, at)).transpose();
    // Sides default to 1 in the format, which is no size of any surface.
    let sides = length("XReal")?.zip(length("YReal")?);
    let cell = sides.map(|(x, y)| (x / nx as f64, y / ny as f64));
    let unit = |name| value(name).filter(|unit| !unit.is_empty()).map(str::to_string);
    Ok(vec![Channel {
        name: value("Title").unwrap_or_default().to_string(),
        height_unit: unit("ZUnits"),
        lateral_unit: unit("XYUnits"),
        ..Channel::in_metres((nx, ny), values, cell)
    }])
}

/// Writes a field on its grid as a Gwyddion Simple Field, which holds seven digits of each value; NaN stays NaN. The
/// unit is that of the values: "m" for heights and gaps, "Pa" for pressures.
///
/// An existing file is replaced, once the new one is whole.
///
/// # Errors
///
/// [`Error::GridMismatch`] if the grid has another shape, [`Error::OutOfRange`] for a unit that does not fit into a
/// line, and [`FileError::Io`](crate::FileError::Io) if the file cannot be written.
pub fn write_gsf(
    path: impl AsRef<Path>,
    grid: &Grid,
    values: &DMatrix<f64>,
    unit: &str,
) -> Result<(), Error> {
    grid.check_shape(values.shape())?;
    let controls = unit.chars().filter(|letter| letter.is_control()).count();
    let quantity = "number of control characters in a unit";
    Error::require(quantity, controls as f64, controls == 0, "0")?;
    write_whole(path, |output| write(output, grid, values, unit))
}

pub(super) fn write(
    mut output: impl Write,
    grid: &Grid,
    values: &DMatrix<f64>,
    unit: &str,
) -> std::io::Result<()> {
    let (nx, ny) = grid.shape();
    let (lx, ly) = grid.sides();
    let header = format!(
        "{MAGIC}XRes = {nx}\nYRes = {ny}\nXReal = {lx:e}\nYReal = {ly:e}\nXYUnits = m\nZUnits = {unit}\n"
    );
    output.write_all(header.as_bytes())?;
    // One to four zeros, so that the numbers begin at a multiple of four.
    output.write_all(&[0; 4][..4 - header.len() % 4])?;
    for value in values.iter() {
        output.write_all(&(*value as f32).to_le_bytes())?;
    }
    output.flush()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::testing::{TestResult, only};

    /// Headers of all lengths modulo four, since data begin at a multiple of four; f32 holds these values exactly.
    #[test]
    fn what_is_written_is_read_back() -> TestResult {
        for (nx, unit) in [(7, "m"), (7, "nm"), (1000, "m"), (7, "rad"), (12, "Pa m"), (7, "")] {
            let grid = Grid::new(nx, 5, 2e-6, 3e-6)?;
            let mut field = DMatrix::from_fn(nx, 5, |ix, iy| 0.25 * ix as f64 - iy as f64);
            field[(3, 2)] = f64::NAN;
            let mut bytes = Vec::new();
            write(&mut bytes, &grid, &field, unit)?;
            let found = only(parse(&bytes))?;
            assert_eq!(found.shape, (nx, 5));
            assert_eq!(found.height_unit.as_deref().unwrap_or_default(), unit);
            for (found, expected) in found.values.iter().zip(field.iter()) {
                assert!(found == expected || (found.is_nan() && expected.is_nan()));
            }
            // Sides are written in the shortest digits that read back as the same number.
            let (lx, ly) = grid.sides();
            assert_eq!(found.cell, Some((lx / nx as f64, ly / 5.0)));
        }
        Ok(())
    }

    #[test]
    fn a_unit_is_one_line() -> Result<(), Error> {
        let grid = Grid::square(2, 1.0)?;
        let written = write_gsf("never.gsf", &grid, &DMatrix::zeros(2, 2), "m\nXRes = 9");
        assert!(matches!(written, Err(Error::OutOfRange { .. })));
        Ok(())
    }
}
