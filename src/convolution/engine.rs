//! Fast convolution in one precision.

use num_complex::Complex;

use super::real::Real;
use super::transforms::{Transforms, Workspace};
use super::transpose::{BLOCK, blocks, gather, interleave, pitch};
use crate::kernel::KernelTable;
use crate::parallel::{for_each_block, inside};
use crate::{Boundary, Error, Grid};

/// Parts into which the blocks of a large grid are divided, each with its own working memory.
///
/// It does not depend on the number of threads: they take parts as they become free.
const PARTS: usize = 32;

/// Nodes from which threads are worth waking.
pub(super) const PARALLEL_NODES: usize = 64 * 64;

/// A convolution whose transforms are done in the precision of T; fields are always double.
#[derive(Clone)]
pub(crate) struct Engine<T: Real> {
    grid: Grid,
    boundary: Boundary,
    transforms: Transforms<T>,
    /// Real symbol, py values for each of the px / 2 + 1 columns, which are stored one by one.
    symbol: Vec<T>,
    /// Spectra of the ny rows, in interleaved blocks.
    rows: Vec<Complex<T>>,
    /// The px / 2 + 1 columns of ny numbers each, in interleaved blocks.
    columns: Vec<Complex<T>>,
    pub(super) scratch: Vec<Scratch<T>>,
}

/// What a thread needs for itself.
#[derive(Clone)]
pub(super) struct Scratch<T> {
    /// A block of rows or of columns, not interleaved.
    lines: Vec<Complex<T>>,
    work: Workspace<T>,
}

impl Engine<f64> {
    /// Prepares the convolution with tabulated influence coefficients.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] if the coefficients are so large that their sum overflows.
    pub(super) fn from_table(table: &KernelTable) -> Result<Self, Error> {
        let grid = table.grid();
        let mut convolution = Self::empty(grid, table.boundary());
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

    /// The same convolution in single precision, its symbol divided by `unit` and rounded once.
    pub(super) fn to_single(&self, unit: f64) -> Engine<f32> {
        let mut engine = Engine::empty(self.grid, self.boundary);
        for (value, &symbol) in engine.symbol.iter_mut().zip(&self.symbol) {
            *value = (symbol / unit) as f32;
        }
        engine
    }

    /// Replaces the symbol by its inverse, both without their normalisation.
    #[cfg(test)]
    pub(super) fn invert_symbol(&mut self) {
        let (px, py) = self.padded();
        let points = px as f64 * py as f64;
        for value in &mut self.symbol {
            *value = 1.0 / (*value * points * points);
        }
    }

    /// Greatest absolute value of the symbol, without its normalisation.
    pub(super) fn greatest_symbol(&self) -> f64 {
        let values = self.symbol.iter().map(|value| value.abs());
        let (px, py) = self.padded();
        values.fold(0.0, f64::max) * (px as f64 * py as f64)
    }
}

impl<T: Real> Engine<T> {
    fn empty(grid: Grid, boundary: Boundary) -> Self {
        let transforms = Transforms::new(&grid, boundary);
        let (columns, rows) = (transforms.columns(), grid.ny());
        let parts = if cfg!(feature = "rayon") && grid.nodes() >= PARALLEL_NODES {
            PARTS
        } else {
            1
        };
        let scratch = Scratch {
            lines: vec![T::ZERO; BLOCK * pitch(columns.max(rows))],
            work: transforms.workspace(),
        };
        Self {
            grid,
            boundary,
            symbol: vec![T::zero(); columns * transforms.padded().1],
            rows: vec![T::ZERO; blocks(rows) * BLOCK * columns],
            columns: vec![T::ZERO; blocks(columns) * BLOCK * rows],
            scratch: vec![scratch; parts],
            transforms,
        }
    }

    /// The grid of the fields.
    pub(crate) fn grid(&self) -> Grid {
        self.grid
    }

    /// Lengths of the transforms.
    pub(super) fn padded(&self) -> (usize, usize) {
        self.transforms.padded()
    }

    /// Bytes held: symbol, spectra and working memory, but not the plans.
    pub(crate) fn memory(&self) -> usize {
        let scratch = self
            .scratch
            .iter()
            .map(|scratch| size_of_val(&scratch.lines[..]) + scratch.work.memory());
        size_of_val(&self.symbol[..])
            + size_of_val(&self.rows[..])
            + size_of_val(&self.columns[..])
            + scratch.sum::<usize>()
    }

    /// Writes the displacement under `pressure`, multiplied by the second factor, into
    /// `displacement`; the first factor brings pressures into the range of T.
    ///
    /// # Errors
    ///
    /// [`Error::LengthMismatch`] unless both slices have one value for each node.
    pub(crate) fn apply(
        &mut self,
        pressure: &[f64],
        factors: [f64; 2],
        displacement: &mut [f64],
    ) -> Result<(), Error> {
        self.check_length(pressure)?;
        self.check_length(displacement)?;
        if self.scratch.len() > 1 {
            inside(|| self.filter(pressure, factors, displacement));
        } else {
            self.filter(pressure, factors, displacement);
        }
        Ok(())
    }

    fn filter(&mut self, pressure: &[f64], factors: [f64; 2], displacement: &mut [f64]) {
        let nx = self.grid.nx();
        self.fill_rows(|transforms, iy, spectrum, work| {
            transforms.forward_row(&pressure[iy * nx..][..nx], factors[0], spectrum, work);
        });
        self.filter_columns();
        self.restore_rows(factors[1], displacement);
    }

    pub(super) fn check_length(&self, field: &[f64]) -> Result<(), Error> {
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
        F: Fn(&Transforms<T>, usize, &mut [Complex<T>], &mut Workspace<T>) + Send + Sync,
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
    fn restore_rows(&mut self, factor: f64, displacement: &mut [f64]) {
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
                    transforms.inverse_row(spectrum, factor, values, &mut scratch.work);
                }
            },
        );
    }
}
