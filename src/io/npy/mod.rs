//! NumPy's `.npy` files.

mod fault;
mod header;

use std::fs::{self, File};
use std::io::{BufReader, BufWriter, ErrorKind, Read, Write};
use std::path::Path;

use nalgebra::DMatrix;

use self::fault::Fault;
use self::header::Header;
use crate::{Error, Grid};

/// Reads a two-dimensional array of `float64` or `float32` from a NumPy `.npy` file.
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
/// [`Error::Io`] if the file cannot be read, or there is not enough memory for it;
/// [`Error::EmptyGrid`] for an array without elements; [`Error::GridTooLarge`] beyond
/// [`Grid::MAX_SIDE`] a side; [`Error::BadNpy`] for another type of elements or number of dimensions,
/// a malformed header, a file that is shorter or longer than its header says, and anything that is
/// not a regular file (a directory, a pipe), which is not opened.
pub fn read_npy(path: impl AsRef<Path>) -> Result<DMatrix<f64>, Error> {
    let path = path.as_ref();
    read_file(path).map_err(|fault| fault.in_file(path))
}

/// Writes a matrix to a NumPy `.npy` file, as `float64`, little-endian, in C order.
///
/// Element `[(ix, iy)]` of the matrix is element `[ix, iy]` of the array that `numpy.load` returns.
/// The file is what `numpy.save` would write, version 1.0 of the format; an existing one is
/// overwritten.
///
/// # Errors
///
/// [`Error::Io`] if the file cannot be written.
pub fn write_npy(path: impl AsRef<Path>, matrix: &DMatrix<f64>) -> Result<(), Error> {
    let path = path.as_ref();
    File::create(path)
        .and_then(|file| write(BufWriter::new(file), matrix))
        .map_err(|error| Fault::Io(error).in_file(path))
}

fn read_file(path: &Path) -> Result<DMatrix<f64>, Fault> {
    // Opening a pipe would wait for somebody to write into it.
    if !fs::metadata(path)?.is_file() {
        return Err(Fault::malformed("it is not a regular file"));
    }
    let file = File::open(path)?;
    let length = file.metadata()?.len();
    read(BufReader::new(file), length)
}

fn read(mut input: impl Read, length: u64) -> Result<DMatrix<f64>, Fault> {
    let Header {
        shape: (nx, ny),
        fortran_order,
        element,
        bytes: header_bytes,
    } = Header::read(&mut input, length)?;
    if nx == 0 || ny == 0 {
        return Err(Fault::Shape(Error::EmptyGrid { nx, ny }));
    }
    if nx > Grid::MAX_SIDE || ny > Grid::MAX_SIDE {
        return Err(Fault::Shape(Error::GridTooLarge {
            nx,
            ny,
            max_side: Grid::MAX_SIDE,
        }));
    }
    let expected = header_bytes + (nx * ny) as u64 * element.size() as u64;
    if length != expected {
        return Err(Fault::malformed(format!(
            "{nx} x {ny} elements of {} bytes make a file of {expected} bytes, \
             but this one has {length}",
            element.size()
        )));
    }
    let mut values = Vec::new();
    values
        .try_reserve_exact(nx * ny)
        .map_err(|_| std::io::Error::from(ErrorKind::OutOfMemory))?;
    values.resize(nx * ny, 0.0);
    // The file holds runs of the faster index; (slow, fast) is (ix, iy) in C order.
    let (runs, run) = if fortran_order { (ny, nx) } else { (nx, ny) };
    let mut bytes = vec![0; run * element.size()];
    for slow in 0..runs {
        input.read_exact(&mut bytes)?;
        for (fast, value) in bytes.chunks_exact(element.size()).enumerate() {
            let node = if fortran_order {
                fast + nx * slow
            } else {
                slow + nx * fast
            };
            values[node] = element.decode(value);
        }
    }
    Ok(DMatrix::from_vec(nx, ny, values))
}

fn write(mut output: impl Write, matrix: &DMatrix<f64>) -> std::io::Result<()> {
    output.write_all(&header::of_doubles(matrix.shape()))?;
    for row in matrix.row_iter() {
        for value in row.iter() {
            output.write_all(&value.to_le_bytes())?;
        }
    }
    output.flush()
}

#[cfg(test)]
mod tests;
