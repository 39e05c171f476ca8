//! Images of VTK, `.vti`, which ParaView opens.
//!
//! Source: VTK User's Guide, 11th edition, "XML File Formats".

use std::io::Write;
use std::path::Path;

use nalgebra::DMatrix;

use super::whole_file::write_whole;
use crate::{Error, Grid};

/// Writes fields on a grid as an image of VTK, which ParaView opens: one array for each field, on the cells of the
/// grid, in the plane z = 0, lengths in metres.
///
/// An existing file is replaced, once the new one is whole.
///
/// # Errors
///
/// [`Error::GridMismatch`] for a field of another shape, and [`FileError::Io`](crate::FileError::Io) if the file cannot
/// be written.
pub fn write_vti(
    path: impl AsRef<Path>,
    grid: &Grid,
    fields: &[(&str, &DMatrix<f64>)],
) -> Result<(), Error> {
    for (_, field) in fields {
        grid.check_shape(field.shape())?;
    }
    write_whole(path, |output| write(output, grid, fields))
}

pub(super) fn write(
    mut output: impl Write,
    grid: &Grid,
    fields: &[(&str, &DMatrix<f64>)],
) -> std::io::Result<()> {
    let (nx, ny) = grid.shape();
    let extent = format!("0 {nx} 0 {ny} 0 0");
    writeln!(
        output,
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
         <ImageData WholeExtent=\"{extent}\" Origin=\"0 0 0\" Spacing=\"{:e} {:e} 1\">\n\
         <Piece Extent=\"{extent}\">\n<CellData>",
        grid.dx(),
        grid.dy()
    )?;
    // Each array is its length in bytes, and then its numbers, x fast.
    let bytes = 8 * grid.nodes();
    for (place, (name, _)) in fields.iter().enumerate() {
        writeln!(
            output,
            "<DataArray type=\"Float64\" Name=\"{}\" format=\"appended\" offset=\"{}\"/>",
            escaped(name),
            place * (8 + bytes)
        )?;
    }
    write!(output, "</CellData>\n</Piece>\n</ImageData>\n<AppendedData encoding=\"raw\">\n_")?;
    for (_, field) in fields {
        output.write_all(&(bytes as u64).to_le_bytes())?;
        for value in field.iter() {
            output.write_all(&value.to_le_bytes())?;
        }
    }
    write!(output, "\n</AppendedData>\n</VTKFile>\n")?;
    output.flush()
}

/// A name as XML has it.
fn escaped(name: &str) -> String {
    let mut text = String::new();
    for letter in name.chars() {
        match letter {
            '&' => text.push_str("&amp;"),
            '<' => text.push_str("&lt;"),
            '"' => text.push_str("&quot;"),
            letter if letter.is_control() => {}
            letter => text.push(letter),
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What XML gives a meaning to, and what it does not allow.
    #[test]
    fn names_are_written_as_xml_has_them() {
        assert_eq!(escaped("a<b & \"c\"\n\u{7f}µ"), "a&lt;b &amp; &quot;c&quot;µ");
    }

    /// Read back by hand; VTK itself reads it in `studies/files/check_vti.py`.
    #[test]
    fn fields_stand_where_the_header_says() -> Result<(), Box<dyn std::error::Error>> {
        let grid = Grid::new(3, 2, 0.5, 0.25)?;
        let first = DMatrix::from_fn(3, 2, |ix, iy| ix as f64 + 10.0 * iy as f64);
        let second = first.map(|value| -value);
        let mut bytes = Vec::new();
        write(&mut bytes, &grid, &[("a<b", &first), ("c", &second)])?;
        let mark = b"encoding=\"raw\">\n_";
        let marked = bytes.windows(mark.len()).position(|window| window == mark);
        let start = marked.ok_or("no data")? + mark.len();
        let header = std::str::from_utf8(&bytes[..start])?;
        assert!(header.contains("Name=\"a&lt;b\" format=\"appended\" offset=\"0\""));
        assert!(header.contains("Name=\"c\" format=\"appended\" offset=\"56\""));
        assert!(header.contains("Spacing=\"5e-1 2.5e-1 1\""));
        let number =
            |at: usize| -> Result<[u8; 8], _> { bytes[start + at..start + at + 8].try_into() };
        assert_eq!(u64::from_le_bytes(number(0)?), 48);
        for (field, at) in [(&first, 8), (&second, 56 + 8)] {
            for (place, value) in field.iter().enumerate() {
                assert_eq!(f64::from_le_bytes(number(at + 8 * place)?), *value);
            }
        }
        Ok(())
    }
}
