//! NumPy's `.npy` files.

mod header;

use std::io::{Read, Write};
use std::path::Path;

use nalgebra::DMatrix;

pub(super) use self::header::header_of;
use self::header::{Element, Header};
use super::bytes::{Bytes, read_all, read_file, reserved, shape};
use super::fault::Fault;
#[cfg(feature = "io")]
use super::raw::{Channel, Parsed};
use super::whole_file::write_whole;
use crate::Error;

/// Reads a two-dimensional array of `float64`, `float32` or integers from a NumPy `.npy` file.
///
/// Element `[ix, iy]` of the array is element `[(ix, iy)]` of the matrix, whichever order (C or
/// Fortran) and byte order it has in the file: x is the first index, so an image `[row, column]`
/// must be transposed. NaN stays NaN.
///
/// The size that the file claims is checked against its real length before any memory is
/// allocated for it.
///
/// # Errors
///
/// [`FileError::Io`](crate::FileError::Io) if the file cannot be read, or there is not enough memory for it;
/// [`Error::EmptyGrid`] for an array without elements; [`Error::GridTooLarge`] beyond
/// [`Grid::MAX_SIDE`](crate::Grid::MAX_SIDE) a side; [`FileError::BadFile`](crate::FileError::BadFile) for another type
/// of elements or number of dimensions, a malformed header, a file that is shorter or longer than its header says, and
/// anything that is not a regular file (a directory, a pipe), which is not opened.
pub fn read_npy(path: impl AsRef<Path>) -> Result<DMatrix<f64>, Error> {
    let path = path.as_ref();
    whole(read_file(path), path)
}

/// Reads an array as [`read_npy`] does, from all bytes of a source. `name` is what errors call it.
///
/// # Errors
///
/// As [`read_npy`].
pub fn read_npy_from(source: impl Read, name: impl AsRef<Path>) -> Result<DMatrix<f64>, Error> {
    whole(read_all(source), name.as_ref())
}

/// The array in all bytes of a file.
fn whole(read: Result<Vec<u8>, Fault>, path: &Path) -> Result<DMatrix<f64>, Error> {
    read.and_then(|bytes| matrix(&bytes)).map_err(|fault| fault.in_file(path, NAME))
}

/// Writes a matrix to a NumPy `.npy` file, as `float64`, little-endian, in C order.
///
/// Element `[(ix, iy)]` of the matrix is element `[ix, iy]` of the array that `numpy.load` returns.
/// The file is what `numpy.save` would write, version 1.0 of the format; an existing one is
/// replaced, once the new one is whole.
///
/// # Errors
///
/// [`FileError::Io`](crate::FileError::Io) if the file cannot be written.
pub fn write_npy(path: impl AsRef<Path>, matrix: &DMatrix<f64>) -> Result<(), Error> {
    write_whole(path, |output| write(output, matrix))
}

/// What errors call the format.
const NAME: &str = "NumPy";

/// The map in a file, in metres, without a size.
#[cfg(feature = "io")]
pub(super) fn parse(file: &[u8]) -> Parsed {
    let matrix = matrix(file)?;
    Ok(vec![Channel::in_metres(matrix.shape(), matrix.data.into(), None)])
}

/// An array of two dimensions.
pub(super) fn matrix(file: &[u8]) -> Result<DMatrix<f64>, Fault> {
    let mut input = Bytes::new(file);
    let (header, [nx, ny]) = Header::of_dimensions(&mut input)?;
    let (nx, ny) = shape(nx, ny)?;
    let element = Element::from_descr(&header.descr)?;
    let elements = rest(input, nx * ny, element.number.size())?;
    let mut values = reserved(nx * ny)?;
    values.resize(nx * ny, 0.0);
    // The file holds runs of the faster index; (slow, fast) is (ix, iy) in C order.
    let run = if header.fortran_order { nx } else { ny };
    for (k, bytes) in elements.chunks_exact(element.number.size()).enumerate() {
        let (slow, fast) = (k / run, k % run);
        let node = if header.fortran_order { k } else { slow + nx * fast };
        values[node] = element.decode(bytes);
    }
    Ok(DMatrix::from_vec(nx, ny, values))
}

/// An array of one dimension.
#[cfg(feature = "io")]
pub(super) fn vector(file: &[u8]) -> Result<Vec<f64>, Fault> {
    let mut input = Bytes::new(file);
    let (header, [length]) = Header::of_dimensions(&mut input)?;
    let element = Element::from_descr(&header.descr)?;
    let elements = rest(input, length, element.number.size())?;
    let mut values = reserved(length)?;
    values.extend(elements.chunks_exact(element.number.size()).map(|bytes| element.decode(bytes)));
    Ok(values)
}

/// An array without dimensions that holds a text.
#[cfg(feature = "io")]
pub(super) fn text(file: &[u8]) -> Result<String, Fault> {
    let mut input = Bytes::new(file);
    let (Header { descr, .. }, []) = Header::of_dimensions(&mut input)?;
    let length = descr.strip_prefix("<U").and_then(|length| length.parse().ok());
    let length = length.ok_or_else(|| fault!("the element is of type '{descr}', not a text"))?;
    let mut letters = Bytes::new(rest(input, length, 4)?);
    (0..length)
        .map(|_| {
            let code = letters.u32()?;
            char::from_u32(code).ok_or_else(|| fault!("{code:#x} is no letter"))
        })
        .collect()
}

/// All bytes that are left: so many elements.
fn rest<'a>(mut input: Bytes<'a>, count: usize, size: usize) -> Result<&'a [u8], Fault> {
    let elements = input.elements(count, size)?;
    input.end(format_args!("{count} elements"))?;
    Ok(elements)
}

pub(super) fn write(mut output: impl Write, matrix: &DMatrix<f64>) -> std::io::Result<()> {
    let (nx, ny) = matrix.shape();
    output.write_all(&header_of("<f8", &[nx, ny]))?;
    for row in matrix.row_iter() {
        for value in row.iter() {
            output.write_all(&value.to_le_bytes())?;
        }
    }
    output.flush()
}

#[cfg(test)]
mod tests;
