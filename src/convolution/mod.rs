//! Displacement from pressure: an influence kernel over the whole grid.
//!
//! $$u_i = \sum_j C(\mathbf i - \mathbf j)\\, p_j$$
//!
//! is a convolution, which [`Convolution`] does by fast Fourier transform in a time that hardly
//! grows faster than the number of nodes, and [`direct_sum`] term by term as it stands here.
//!
//! What lies outside the grid is the kernel's [`Boundary`](crate::Boundary):
//!
//! * With a free boundary the fields are padded with zeros (Hockney's method) to px ≥ 2 nx − 1 by
//!   py ≥ 2 ny − 1 nodes, so that the transform's own periodicity never reaches the grid, and to
//!   lengths for which transforms are fast.
//! * With a periodic boundary that periodicity is the field's, and nothing is padded: px = nx and
//!   py = ny, and on a grid of 512 × 512 nodes a quarter of the time. Lengths with large prime
//!   factors are transformed as they are, which is exact but slow: ten times as slow on 509 × 509
//!   nodes. The mean displacement is that of the kernel's gauge.
//!
//! Reciprocity, C(−d) = C(d), makes the symbol (the transform of C) real, whether or not C has mirror
//! symmetry.
//!
//! # Order of the fields
//!
//! Fields are slices of one value for each node, at `ix + nx * iy`, or nalgebra's `DMatrix` with nx
//! rows and ny columns, whose storage is the same.
//!
//! # Accuracy
//!
//! The error is that of rounding in the transforms, which grows with the logarithm of the number
//! of nodes: about $10^{-15} \max |u|$. It is the same everywhere: small displacements far
//! from the load have the absolute error of the large ones.
//!
//! # References
//!
//! R. W. Hockney, Methods in Computational Physics 9 (1970) 135; S. Liu, Q. Wang and G. Liu,
//! Wear 243 (2000) 101, for contact problems.

mod direct;
mod size;
#[cfg(test)]
mod tests;
mod transforms;
mod transpose;

use std::fmt;

use nalgebra::DMatrix;
use num_complex::Complex;

pub use direct::direct_sum;

use crate::kernel::KernelTable;
use crate::parallel::{for_each_block, inside};
use crate::{Error, Grid, InfluenceKernel};
use transforms::{Transforms, Workspace};
use transpose::{BLOCK, blocks, gather, interleave, pitch};

/// Parts into which the blocks of a large grid are divided, each with its own working memory.
///
/// It does not depend on the number of threads: they take parts as they become free.
const PARTS: usize = 32;

/// Nodes from which threads are worth waking.
const PARALLEL_NODES: usize = 64 * 64;

/// Displacement from pressure on a whole grid, by fast Fourier transform.
///
/// All memory is allocated when it is made, so convolutions should be kept and used again. With
/// the feature `rayon` the threads of the current pool share the work; results are the same bit
/// for bit with any number of threads, and without the feature.
///
/// ```
/// use asperity::convolution::Convolution;
/// use asperity::{Boundary, Error, Grid, InfluenceKernel};
/// use nalgebra::DMatrix;
///
/// /// A bed of independent springs: displacement in proportion to a node's own pressure.
/// struct Winkler(Grid);
///
/// impl InfluenceKernel for Winkler {
///     fn grid(&self) -> Grid {
///         self.0
///     }
///     fn boundary(&self) -> Boundary {
///         Boundary::Free
///     }
///     fn coefficient(&self, di: isize, dj: isize) -> f64 {
///         if (di, dj) == (0, 0) { 2.0 } else { 0.0 }
///     }
/// }
///
/// let grid = Grid::square(8, 1.0)?;
/// let pressure = DMatrix::from_fn(8, 8, |ix, iy| (ix + iy) as f64);
/// let displacement = Convolution::new(&Winkler(grid))?.convolve(&pressure)?;
/// assert!((displacement - 2.0 * pressure).amax() < 1e-12);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone)]
pub struct Convolution {
    grid: Grid,
    transforms: Transforms,
    /// Real symbol, py values for each of the px / 2 + 1 columns, which are stored one by one.
    symbol: Vec<f64>,
    /// Spectra of the ny rows, in interleaved blocks.
    rows: Vec<Complex<f64>>,
    /// The px / 2 + 1 columns of ny numbers each, in interleaved blocks.
    columns: Vec<Complex<f64>>,
    scratch: Vec<Scratch>,
}

/// What a thread needs for itself.
#[derive(Clone)]
struct Scratch {
    /// A block of rows or of columns, not interleaved.
    lines: Vec<Complex<f64>>,
    work: Workspace,
}

impl Convolution {
    /// Prepares the convolution with `kernel` on its grid, with zero padding unless its boundary is
    /// periodic.
    ///
    /// # Errors
    ///
    /// Those of [`KernelTable::new`] and [`Convolution::from_table`].
    pub fn new<K: InfluenceKernel + ?Sized>(kernel: &K) -> Result<Self, Error> {
        Self::from_table(&KernelTable::new(kernel)?)
    }

    /// Prepares the convolution with tabulated influence coefficients.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] if the coefficients are so large that their sum overflows.
    pub fn from_table(table: &KernelTable) -> Result<Self, Error> {
        let grid = table.grid();
        let transforms = Transforms::new(&grid, table.boundary());
        let (columns, rows) = (transforms.columns(), grid.ny());
        let parts = if cfg!(feature = "rayon") && grid.nodes() >= PARALLEL_NODES {
            PARTS
        } else {
            1
        };
        let scratch = Scratch {
            lines: vec![Complex::default(); BLOCK * pitch(columns.max(rows))],
            work: transforms.workspace(),
        };
        let mut convolution = Self {
            grid,
            symbol: vec![0.0; columns * transforms.padded().1],
            rows: vec![Complex::default(); blocks(rows) * BLOCK * columns],
            columns: vec![Complex::default(); blocks(columns) * BLOCK * rows],
            scratch: vec![scratch; parts],
            transforms,
        };
        convolution.fill_rows(|transforms, dj, spectrum, work| {
            // Inside the grid there is always a coefficient.
            let coefficient = |di| table.coefficient(di, dj as isize).unwrap_or(0.0);
            transforms.forward_kernel_row(coefficient, spectrum, work);
        });
        convolution.fill_symbol();
        match convolution.symbol.iter().find(|value| !value.is_finite()) {
            Some(&value) => Err(Error::OutOfRange {
                quantity: "the sum of the influence coefficients",
                value,
                expected: "finite",
            }),
            None => Ok(convolution),
        }
    }

    /// The grid of the fields.
    #[must_use]
    pub fn grid(&self) -> Grid {
        self.grid
    }

    /// Bytes held: symbol, spectra and working memory, but not the plans.
    #[must_use]
    pub fn memory(&self) -> usize {
        let scratch = self
            .scratch
            .iter()
            .map(|scratch| size_of_val(&scratch.lines[..]) + scratch.work.memory());
        size_of_val(&self.symbol[..])
            + size_of_val(&self.rows[..])
            + size_of_val(&self.columns[..])
            + scratch.sum::<usize>()
    }

    /// Displacement \[m\] of every node under `pressure` \[Pa\].
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`] if `pressure` does not have nx rows and ny columns, and
    /// [`Error::FieldNotFinite`].
    pub fn convolve(&mut self, pressure: &DMatrix<f64>) -> Result<DMatrix<f64>, Error> {
        check_field(&self.grid, "pressure", pressure)?;
        let mut displacement = DMatrix::zeros(self.grid.nx(), self.grid.ny());
        self.apply(pressure.as_slice(), displacement.as_mut_slice())?;
        Ok(displacement)
    }

    /// Writes the displacement \[m\] under `pressure` \[Pa\] into `displacement`.
    ///
    /// Nothing is allocated. Rows without pressure cost no transform. A pressure that is not finite
    /// spoils the displacement everywhere: see [`Convolution::convolve`].
    ///
    /// # Errors
    ///
    /// [`Error::LengthMismatch`] unless both slices have one value for each node.
    pub fn apply(&mut self, pressure: &[f64], displacement: &mut [f64]) -> Result<(), Error> {
        self.check_length(pressure)?;
        self.check_length(displacement)?;
        if self.scratch.len() > 1 {
            inside(|| self.filter(pressure, displacement));
        } else {
            self.filter(pressure, displacement);
        }
        Ok(())
    }

    fn filter(&mut self, pressure: &[f64], displacement: &mut [f64]) {
        let nx = self.grid.nx();
        self.fill_rows(|transforms, iy, spectrum, work| {
            transforms.forward_row(&pressure[iy * nx..][..nx], spectrum, work);
        });
        self.filter_columns();
        self.restore_rows(displacement);
    }

    /// Writes the displacements \[m\] under two `pressures` \[Pa\] into `displacements`.
    ///
    /// The fields follow one another. Packed as real and imaginary parts of one complex field they
    /// would need the same column transforms and twice the memory for spectra; from the times of
    /// the row transforms the gain would be 4 % on a grid of 512 × 512 nodes.
    ///
    /// # Errors
    ///
    /// [`Error::LengthMismatch`] unless all slices have one value for each node; then nothing is
    /// written.
    pub fn apply_two(
        &mut self,
        pressures: [&[f64]; 2],
        displacements: [&mut [f64]; 2],
    ) -> Result<(), Error> {
        for pressure in pressures {
            self.check_length(pressure)?;
        }
        for displacement in &displacements {
            self.check_length(displacement)?;
        }
        for (pressure, displacement) in pressures.into_iter().zip(displacements) {
            self.apply(pressure, displacement)?;
        }
        Ok(())
    }

    fn check_length(&self, field: &[f64]) -> Result<(), Error> {
        if field.len() == self.grid.nodes() {
            Ok(())
        } else {
            Err(Error::LengthMismatch {
                expected: self.grid.nodes(),
                found: field.len(),
            })
        }
    }

    /// Fills `rows`: `transform(iy, spectrum, work)` gives the spectrum of row iy.
    fn fill_rows<F>(&mut self, transform: F)
    where
        F: Fn(&Transforms, usize, &mut [Complex<f64>], &mut Workspace) + Send + Sync,
    {
        let transforms = &self.transforms;
        let (ny, columns) = (self.grid.ny(), transforms.columns());
        let pitch = pitch(columns);
        for_each_block(
            &mut self.rows,
            BLOCK * columns,
            &mut self.scratch,
            |block, rows, scratch| {
                let lines = &mut scratch.lines[..BLOCK * pitch];
                let iys = block * BLOCK..ny;
                for (spectrum, iy) in lines.chunks_mut(pitch).zip(iys) {
                    transform(transforms, iy, &mut spectrum[..columns], &mut scratch.work);
                }
                interleave(lines, pitch, rows);
            },
        );
    }

    /// From `rows`, filled with the spectra of kernel rows dj = 0, 1, …, ny − 1, to the symbol.
    fn fill_symbol(&mut self) {
        let transforms = &self.transforms;
        let (ny, py) = (self.grid.ny(), transforms.padded().1);
        let pitch = pitch(ny);
        let (rows, columns) = (&self.rows, transforms.columns());
        for_each_block(
            &mut self.symbol,
            BLOCK * py,
            &mut self.scratch,
            |block, symbol, scratch| {
                let lines = &mut scratch.lines[..BLOCK * pitch];
                gather(rows, columns, block, lines, pitch);
                let entries = lines.chunks(pitch);
                for (symbol, entries) in symbol.chunks_mut(py).zip(entries) {
                    transforms.symbol_column(&entries[..ny], symbol, &mut scratch.work);
                }
            },
        );
    }

    /// From `rows` to `columns`, multiplied by the symbol.
    fn filter_columns(&mut self) {
        let transforms = &self.transforms;
        let (ny, py) = (self.grid.ny(), transforms.padded().1);
        let pitch = pitch(ny);
        let (rows, columns) = (&self.rows, transforms.columns());
        let symbol = &self.symbol;
        for_each_block(
            &mut self.columns,
            BLOCK * ny,
            &mut self.scratch,
            |block, target, scratch| {
                let lines = &mut scratch.lines[..BLOCK * pitch];
                gather(rows, columns, block, lines, pitch);
                let symbol = symbol[block * BLOCK * py..].chunks_exact(py);
                for (entries, symbol) in lines.chunks_mut(pitch).zip(symbol) {
                    transforms.filter_column(&mut entries[..ny], symbol, &mut scratch.work);
                }
                interleave(lines, pitch, target);
            },
        );
    }

    /// From `columns` to displacement.
    fn restore_rows(&mut self, displacement: &mut [f64]) {
        let transforms = &self.transforms;
        let (nx, ny) = self.grid.shape();
        let pitch = pitch(transforms.columns());
        let columns = &self.columns;
        for_each_block(
            displacement,
            BLOCK * nx,
            &mut self.scratch,
            |block, displacement, scratch| {
                let lines = &mut scratch.lines[..BLOCK * pitch];
                gather(columns, ny, block, lines, pitch);
                let spectra = lines.chunks_mut(pitch);
                for (values, spectrum) in displacement.chunks_mut(nx).zip(spectra) {
                    let spectrum = &mut spectrum[..transforms.columns()];
                    transforms.inverse_row(spectrum, values, &mut scratch.work);
                }
            },
        );
    }
}

impl fmt::Debug for Convolution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Convolution")
            .field("grid", &self.grid)
            .field("padded", &self.transforms.padded())
            .finish_non_exhaustive()
    }
}

/// `Ok` if the field has the shape of the grid and is finite.
fn check_field(grid: &Grid, field: &'static str, values: &DMatrix<f64>) -> Result<(), Error> {
    grid.check_shape(values.shape())?;
    match values.iter().position(|value| !value.is_finite()) {
        Some(node) => {
            let (ix, iy) = grid.coordinates(node);
            Err(Error::FieldNotFinite {
                field,
                ix,
                iy,
                value: values[node],
            })
        }
        None => Ok(()),
    }
}
