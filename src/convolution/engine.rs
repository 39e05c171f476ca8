//! Fast convolution in one precision.

use std::sync::Arc;

use num_complex::Complex;

use super::real::Real;
use super::transforms::{Parity, Transforms, Workspace};
use super::transpose::{blocks, gather, interleave, pitch};
use super::tuning::{BLOCK, PARALLEL_NODES, PARTS};
use crate::kernel::KernelTable;
use crate::parallel::{for_each_block, for_each_chunk, inside};
use crate::{Boundary, Error, Grid, KernelError};

/// Error of the Fourier transform of a kernel, relative to the greatest value: a few units in the last place.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// A convolution whose transforms are done in the precision of T; fields may be of another one, F.
///
/// Copies share the filter, and have spectra of their own.
#[derive(Clone)]
pub(crate) struct Engine<T: Real> {
    filter: Arc<Filter<T>>,
    pub(super) spectra: Spectra<T>,
}

/// The plans and the spectrum, the same for all fields.
struct Filter<T: Real> {
    grid: Grid,
    boundary: Boundary,
    transforms: Transforms<T>,
    parity: Parity,
    /// Real symbol, or i times an imaginary one, py values for each of the px / 2 + 1 columns, which are stored one by
    /// one.
    symbol: Vec<T>,
}

/// Coefficients by offset (di, dj), or parts of a symbol by wave (kx, ky).
pub(crate) type Table<'a, I> = &'a (dyn Fn(I, I) -> f64 + Sync);

/// Working memory.
#[derive(Clone)]
pub(super) struct Spectra<T> {
    /// Spectra of the ny rows, in interleaved blocks.
    rows: Vec<Complex<T>>,
    /// The px / 2 + 1 columns of ny numbers each, in interleaved blocks.
    columns: Vec<Complex<T>>,
    pub(super) scratch: Vec<Scratch<T>>,
}

/// The working memory of a thread.
#[derive(Clone)]
pub(super) struct Scratch<T> {
    /// A block of rows or of columns, not interleaved.
    lines: Vec<Complex<T>>,
    work: Workspace<T>,
}

/// Parts into which the work on a grid is divided: so few that their working memory is no more than a padded field, which
/// matters on strips.
fn parts<T: Real>(grid: &Grid, transforms: &Transforms<T>) -> usize {
    let (px, py) = transforms.padded();
    match cfg!(feature = "rayon") && grid.nodes() >= PARALLEL_NODES {
        true => (px * py / Scratch::lines(transforms)).clamp(1, PARTS),
        false => 1,
    }
}

impl Engine<f64> {
    /// Prepares the convolution with tabulated influence coefficients.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] if the coefficients are so large that their sum overflows.
    pub(super) fn from_table(table: &KernelTable) -> Result<Self, Error> {
        // Inside the grid there is always a coefficient.
        let coefficient = |di, dj| table.coefficient(di, dj).unwrap_or(0.0);
        let mut engine = Self::blank((table.grid(), table.boundary()));
        engine.set(Parity::Even, Some(&coefficient), None)?;
        Ok(engine)
    }

    /// Prepares a convolution of which nothing comes until its symbol is [`set`](Self::set).
    pub(super) fn blank((grid, boundary): (Grid, Boundary)) -> Self {
        let transforms = Transforms::<f64>::new(&grid, boundary);
        let spectra = Spectra::new(&grid, &transforms);
        let symbol = vec![0.0; transforms.columns() * transforms.padded().1];
        let parity = Parity::Even;
        Self::of(Filter { grid, boundary, transforms, parity, symbol }, spectra)
    }

    /// Takes another symbol: the transform of coefficients at offsets with 0 ≤ dj < ny, and |di| < nx, or 0 ≤ di < nx
    /// where x repeats, and what `waves` gives for 0 ≤ kx ≤ px / 2 and 0 ≤ ky < py, which is added to it, or to its
    /// imaginary part.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] if the coefficients are so large that their sum overflows.
    pub(super) fn set(
        &mut self,
        parity: Parity,
        coefficient: Option<Table<'_, isize>>,
        waves: Option<Table<'_, usize>>,
    ) -> Result<(), Error> {
        let Filter { grid, boundary, ref transforms, .. } = *self.filter;
        let transforms = transforms.clone();
        let (px, py) = transforms.padded();
        let mut symbol = match coefficient {
            None => vec![0.0; transforms.columns() * py],
            Some(coefficient) => {
                self.spectra.fill_rows(&transforms, grid.ny(), |dj, spectrum, work| {
                    let row = |di| coefficient(di, dj as isize);
                    transforms.forward_kernel_row(row, spectrum, work);
                });
                self.spectra.symbol(&transforms, grid.ny(), parity)
            }
        };
        if let Some(waves) = waves {
            let normalisation = 1.0 / (px as f64 * py as f64);
            for_each_chunk(&mut symbol, py, |kx, column| {
                for (ky, value) in column.iter_mut().enumerate() {
                    *value += waves(kx, ky) * normalisation;
                }
            });
        }
        if let Some(&value) = symbol.iter().find(|value| !value.is_finite()) {
            return Err(Error::OutOfRange {
                quantity: "the sum of the influence coefficients",
                value,
                expected: "finite",
            });
        }
        self.filter = Arc::new(Filter { grid, boundary, transforms, parity, symbol });
        Ok(())
    }

    /// The same convolution in single precision, its symbol divided by `unit` and rounded once.
    pub(super) fn to_single(&self, unit: f64) -> Engine<f32> {
        let Filter { grid, boundary, parity, ref symbol, .. } = *self.filter;
        let transforms = Transforms::new(&grid, boundary);
        let spectra = Spectra::new(&grid, &transforms);
        let symbol = symbol.iter().map(|value| (value / unit) as f32).collect();
        Engine::of(Filter { grid, boundary, transforms, parity, symbol }, spectra)
    }

    /// The same convolution with another answer to uniform pressure: none.
    pub(super) fn without_mean(self) -> Self {
        let filter = &*self.filter;
        let mut symbol = filter.symbol.clone();
        symbol[0] = 0.0;
        let filter = Filter { transforms: filter.transforms.clone(), symbol, ..*filter };
        Self::of(filter, self.spectra)
    }

    /// `Ok` if the symbol of a periodic kernel is positive, the first `skipped` waves left out.
    ///
    /// # Errors
    ///
    /// [`KernelError::SymbolNotPositive`].
    pub(super) fn check_symbol(&self, skipped: usize) -> Result<(), Error> {
        let Filter { grid, symbol, .. } = &*self.filter;
        let nodes = grid.nodes() as f64;
        let rounding = ROUNDING * self.greatest_symbol() / nodes;
        let mut waves = symbol.iter().enumerate().skip(skipped);
        match waves.find(|(_, value)| **value <= rounding) {
            None => Ok(()),
            Some((place, value)) => Err(Error::Kernel(KernelError::SymbolNotPositive {
                q: grid.wave_vector(place / grid.ny(), place % grid.ny()),
                value: value * nodes,
            })),
        }
    }

    /// Greatest absolute value of the symbol, without its normalisation.
    pub(super) fn greatest_symbol(&self) -> f64 {
        let values = self.filter.symbol.iter().map(|value| value.abs());
        let (px, py) = self.padded();
        values.fold(0.0, f64::max) * (px as f64 * py as f64)
    }

    /// Least value of the symbol, without its normalisation.
    pub(super) fn least_symbol(&self) -> f64 {
        let (px, py) = self.padded();
        let least = self.filter.symbol.iter().copied();
        least.fold(f64::INFINITY, f64::min) * (px as f64 * py as f64)
    }

    /// Root of the sum of squares of the symbol over all waves, as it is stored: divided by their number.
    pub(super) fn norm_of_symbol(&self) -> f64 {
        let (px, py) = self.padded();
        let columns = self.filter.symbol.chunks_exact(py).enumerate();
        let squares = columns.map(|(wave, values)| {
            // A wave that is not its own conjugate stands for two.
            let waves = if (2 * wave).is_multiple_of(px) { 1.0 } else { 2.0 };
            waves * values.iter().map(|value| value * value).sum::<f64>()
        });
        squares.sum::<f64>().sqrt()
    }
}

impl<T: Real> Engine<T> {
    fn of(filter: Filter<T>, spectra: Spectra<T>) -> Self {
        Self { filter: Arc::new(filter), spectra }
    }

    /// The grid of the fields.
    pub(crate) fn grid(&self) -> Grid {
        self.filter.grid
    }

    /// Lengths of the transforms.
    pub(super) fn padded(&self) -> (usize, usize) {
        self.filter.transforms.padded()
    }

    /// Bytes held: symbol, spectra and working memory, but not the plans.
    pub(crate) fn bytes(&self) -> usize {
        Self::bytes_with(&self.filter.grid, &self.filter.transforms)
    }

    /// The same before there is an engine.
    pub(super) fn bytes_on(grid: &Grid, boundary: Boundary) -> usize {
        Self::bytes_with(grid, &Transforms::new(grid, boundary))
    }

    fn bytes_with(grid: &Grid, transforms: &Transforms<T>) -> usize {
        let (columns, rows, padded) = (transforms.columns(), grid.ny(), transforms.padded().1);
        let lines = Scratch::lines(transforms) * size_of::<Complex<T>>();
        let scratch = lines + transforms.workspace().bytes();
        let spectra = BLOCK * (blocks(rows) * columns + blocks(columns) * rows);
        columns * padded * size_of::<T>()
            + spectra * size_of::<Complex<T>>()
            + parts(grid, transforms) * scratch
    }

    /// Writes the displacement under `pressure` into `displacement`.
    ///
    /// # Errors
    ///
    /// [`Error::LengthMismatch`] unless both slices have one value for each node.
    pub(crate) fn apply<F: Real>(
        &mut self,
        pressure: &[F],
        displacement: &mut [F],
    ) -> Result<(), Error> {
        self.check_length(pressure)?;
        self.check_length(displacement)?;
        let Self { filter, spectra } = self;
        if spectra.scratch.len() > 1 {
            inside(|| filter.apply(spectra, pressure, displacement));
        } else {
            filter.apply(spectra, pressure, displacement);
        }
        Ok(())
    }

    pub(super) fn check_length<F>(&self, field: &[F]) -> Result<(), Error> {
        let expected = self.filter.grid.nodes();
        if field.len() == expected {
            Ok(())
        } else {
            Err(Error::LengthMismatch { expected, found: field.len() })
        }
    }
}

impl<T: Real> Filter<T> {
    fn apply<F: Real>(&self, spectra: &mut Spectra<T>, pressure: &[F], displacement: &mut [F]) {
        let (transforms, (nx, ny)) = (&self.transforms, self.grid.shape());
        spectra.fill_rows(transforms, ny, |iy, spectrum, work| {
            transforms.forward_row(&pressure[iy * nx..][..nx], spectrum, work);
        });
        spectra.filter_columns(transforms, ny, (&self.symbol, self.parity));
        spectra.restore_rows(transforms, (nx, ny), displacement);
    }
}

impl<T: Real> Scratch<T> {
    /// Length of a block of rows, or of padded columns.
    fn lines(transforms: &Transforms<T>) -> usize {
        BLOCK * pitch(transforms.columns().max(transforms.padded().1))
    }
}

impl<T: Real> Spectra<T> {
    fn new(grid: &Grid, transforms: &Transforms<T>) -> Self {
        let (columns, rows) = (transforms.columns(), grid.ny());
        let scratch = Scratch {
            lines: vec![T::ZERO; Scratch::lines(transforms)],
            work: transforms.workspace(),
        };
        Self {
            rows: vec![T::ZERO; blocks(rows) * BLOCK * columns],
            columns: vec![T::ZERO; blocks(columns) * BLOCK * rows],
            scratch: vec![scratch; parts(grid, transforms)],
        }
    }

    /// Fills `rows`: `transform(iy, spectrum, work)` gives the spectrum of row iy.
    fn fill_rows<F>(&mut self, transforms: &Transforms<T>, ny: usize, transform: F)
    where
        F: Fn(usize, &mut [Complex<T>], &mut Workspace<T>) + Send + Sync,
    {
        let columns = transforms.columns();
        let pitch = pitch(columns);
        for_each_block(
            &mut self.rows,
            BLOCK * columns,
            &mut self.scratch,
            |block, rows, scratch| {
                let lines = &mut scratch.lines[..BLOCK * pitch];
                let iys = block * BLOCK..ny;
                for (spectrum, iy) in lines.chunks_mut(pitch).zip(iys) {
                    transform(iy, &mut spectrum[..columns], &mut scratch.work);
                }
                interleave(lines, pitch, rows);
            },
        );
    }

    /// The symbol from `rows`, filled with the spectra of kernel rows dj = 0, 1, …, ny − 1.
    fn symbol(&mut self, transforms: &Transforms<T>, ny: usize, parity: Parity) -> Vec<T> {
        let (columns, py) = (transforms.columns(), transforms.padded().1);
        let pitch = pitch(ny);
        let rows = &self.rows;
        let mut symbol = vec![T::zero(); columns * py];
        for_each_block(&mut symbol, BLOCK * py, &mut self.scratch, |block, symbol, scratch| {
            let lines = &mut scratch.lines[..BLOCK * pitch];
            gather(rows, columns, block, lines, pitch);
            let entries = lines.chunks(pitch);
            for (symbol, entries) in symbol.chunks_mut(py).zip(entries) {
                transforms.symbol_column((&entries[..ny], parity), symbol, &mut scratch.work);
            }
        });
        symbol
    }

    /// From `rows` to `columns`, multiplied by the symbol.
    fn filter_columns(
        &mut self,
        transforms: &Transforms<T>,
        ny: usize,
        (symbol, parity): (&[T], Parity),
    ) {
        let (columns, py) = (transforms.columns(), transforms.padded().1);
        let pitch = pitch(py);
        let rows = &self.rows;
        for_each_block(
            &mut self.columns,
            BLOCK * ny,
            &mut self.scratch,
            |block, target, scratch| {
                let lines = &mut scratch.lines[..BLOCK * pitch];
                gather(rows, columns, block, lines, pitch);
                let symbol = symbol[block * BLOCK * py..].chunks_exact(py);
                for (column, symbol) in lines.chunks_mut(pitch).zip(symbol) {
                    transforms.filter_column(
                        &mut column[..py],
                        (symbol, parity),
                        &mut scratch.work,
                    );
                }
                interleave(lines, pitch, target);
            },
        );
    }

    /// From `columns` to displacement.
    fn restore_rows<F: Real>(
        &mut self,
        transforms: &Transforms<T>,
        (nx, ny): (usize, usize),
        displacement: &mut [F],
    ) {
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

#[cfg(test)]
mod tests;
