//! NumPy's `.npy` files.

mod header;

use std::fs::File;
use std::io::{BufReader, BufWriter, ErrorKind, Read, Write};
use std::path::Path;

use nalgebra::DMatrix;
use npyz::WriterBuilder;

use self::header::Header;
use crate::{Error, Grid};

/// Reads a two-dimensional array of `float64` or `float32` from a NumPy `.npy` file.
///
/// Element `[ix, iy]` of the array is element `[(ix, iy)]` of the matrix, whichever order (C or
/// Fortran) and byte order it has in the file. Values are not looked at: NaN stays NaN.
///
/// The size that the file claims is checked against its real length before any memory is
/// allocated for it.
///
/// # Errors
///
/// [`Error::Io`] if the file cannot be read, or memory for it cannot be had; [`Error::EmptyGrid`]
/// for an array without elements; [`Error::GridTooLarge`] beyond [`Grid::MAX_SIDE`] a side;
/// [`Error::BadNpy`] for another type of elements or number of dimensions, a malformed header, and
/// a file that is shorter or longer than its header says.
pub fn read_npy(path: impl AsRef<Path>) -> Result<DMatrix<f64>, Error> {
    let file = File::open(path)?;
    let length = file.metadata()?.len();
    read(BufReader::new(file), length)
}

/// Writes a matrix to a NumPy `.npy` file, as `float64`, little-endian, in C order.
///
/// Element `[(ix, iy)]` of the matrix is element `[ix, iy]` of the array `numpy.load` returns. An
/// existing file is overwritten.
///
/// # Errors
///
/// [`Error::Io`] if the file cannot be written.
pub fn write_npy(path: impl AsRef<Path>, matrix: &DMatrix<f64>) -> Result<(), Error> {
    let file = BufWriter::new(File::create(path)?);
    Ok(write(file, matrix)?)
}

fn read(mut input: impl Read, length: u64) -> Result<DMatrix<f64>, Error> {
    let Header {
        shape: (nx, ny),
        fortran_order,
        element,
        bytes: header_bytes,
    } = Header::read(&mut input, length)?;
    if nx == 0 || ny == 0 {
        return Err(Error::EmptyGrid { nx, ny });
    }
    if nx > Grid::MAX_SIDE || ny > Grid::MAX_SIDE {
        return Err(Error::GridTooLarge {
            nx,
            ny,
            max_side: Grid::MAX_SIDE,
        });
    }
    let expected = header_bytes + (nx * ny) as u64 * element.size() as u64;
    if length != expected {
        return Err(bad(format!(
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
    let descr = "<f8".parse().map_err(std::io::Error::other)?;
    let mut writer = npyz::WriteOptions::<f64>::new()
        .dtype(npyz::DType::new_scalar(descr))
        .shape(&[matrix.nrows() as u64, matrix.ncols() as u64])
        .writer(&mut output)
        .begin_nd()?;
    for row in matrix.row_iter() {
        writer.extend(row.iter().copied())?;
    }
    writer.finish()?;
    output.flush()
}

fn bad(reason: impl Into<String>) -> Error {
    Error::BadNpy {
        reason: reason.into(),
    }
}

#[cfg(test)]
mod tests;
