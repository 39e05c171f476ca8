//! The one-dimensional transforms along rows and columns, their lengths and working memory.

use std::sync::Arc;

use asperity_fft::{ComplexToReal, Fft, RealToComplex};
use num_complex::Complex;

use super::real::Real;
use super::size::fast_size;
use crate::parallel::vectorized;
use crate::{Boundary, Grid};

/// What coefficients are at the opposite offset.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Parity {
    /// The same, as reciprocity has it of displacements under pressures: the symbol is real.
    Even,
    /// With the other sign: the symbol is imaginary.
    Odd,
}

/// Plans of all transforms of a grid, zero-padded in directions in which it does not repeat.
#[derive(Clone)]
pub(super) struct Transforms<T: Real> {
    nx: usize,
    ny: usize,
    row_forward: Arc<dyn RealToComplex<T>>,
    row_inverse: Arc<dyn ComplexToReal<T>>,
    column_forward: Arc<dyn Fft<T>>,
    column_inverse: Arc<dyn Fft<T>>,
}

/// Working memory of the transforms, one for each thread.
#[derive(Clone)]
pub(super) struct Workspace<T> {
    /// One padded row.
    row: Vec<T>,
    /// One padded column.
    column: Vec<Complex<T>>,
    /// Its spectrum.
    spectrum: Vec<Complex<T>>,
    /// What the plans ask for.
    fft: Vec<Complex<T>>,
}

impl<T: Real> Transforms<T> {
    pub(super) fn new(grid: &Grid, boundary: Boundary) -> Self {
        let (nx, ny) = grid.shape();
        let [x_repeats, y_repeats] = boundary.repeats();
        // A period is the grid's, however slow a length that is. A real transform of even length is a complex one of
        // half that length.
        let px = if x_repeats { nx } else { 2 * fast_size(nx) };
        let py = if y_repeats { ny } else { fast_size(2 * ny - 1) };
        Self {
            nx,
            ny,
            row_forward: T::real_forward(px),
            row_inverse: T::real_inverse(px),
            column_forward: T::complex_forward(py),
            column_inverse: T::complex_inverse(py),
        }
    }

    /// Lengths of the padded rows and columns.
    pub(super) fn padded(&self) -> (usize, usize) {
        (self.row_forward.len(), self.column_forward.len())
    }

    /// Length of the spectrum of a row, which is the number of columns.
    pub(super) fn columns(&self) -> usize {
        self.row_forward.complex_len()
    }

    pub(super) fn workspace(&self) -> Workspace<T> {
        let (px, py) = self.padded();
        let fft = [
            self.row_forward.get_scratch_len(),
            self.row_inverse.get_scratch_len(),
            self.column_forward.get_outofplace_scratch_len(),
            self.column_inverse.get_outofplace_scratch_len(),
        ];
        Workspace {
            row: vec![T::zero(); px],
            column: vec![T::ZERO; py],
            spectrum: vec![T::ZERO; py],
            fft: vec![T::ZERO; fft.into_iter().max().unwrap_or(0)],
        }
    }

    /// Spectrum of a row of nx values, padded with zeros where there is padding.
    pub(super) fn forward_row<F: Real>(
        &self,
        values: &[F],
        spectrum: &mut [Complex<T>],
        work: &mut Workspace<T>,
    ) {
        if values.iter().all(|value| *value == F::zero()) {
            spectrum.fill(T::ZERO);
            return;
        }
        let (inside, padding) = work.row.split_at_mut(self.nx);
        vectorized(
            #[inline(always)]
            || {
                for (place, &value) in inside.iter_mut().zip(values) {
                    *place = T::rounded(value.widened());
                }
            },
        );
        padding.fill(T::zero());
        self.forward_padded_row(spectrum, work);
    }

    /// Spectrum of one row of a kernel, given its value at an offset along x.
    pub(super) fn forward_kernel_row(
        &self,
        value: impl Fn(isize) -> f64,
        spectrum: &mut [Complex<T>],
        work: &mut Workspace<T>,
    ) {
        work.row.fill(T::zero());
        let (positive, negative) = work.row.split_at_mut(self.nx);
        for (place, di) in positive.iter_mut().zip(0..) {
            *place = T::rounded(value(di));
        }
        for (place, di) in negative.iter_mut().rev().zip(1..self.nx as isize) {
            *place = T::rounded(value(-di));
        }
        self.forward_padded_row(spectrum, work);
    }

    fn forward_padded_row(&self, spectrum: &mut [Complex<T>], work: &mut Workspace<T>) {
        let done = self.row_forward.process_with_scratch(&mut work.row, spectrum, &mut work.fft);
        // Lengths are all it could complain of, and they come from the plan.
        debug_assert!(done.is_ok(), "{done:?}");
    }

    /// The nx values of a row, given its spectrum, which is destroyed.
    pub(super) fn inverse_row<F: Real>(
        &self,
        spectrum: &mut [Complex<T>],
        values: &mut [F],
        work: &mut Workspace<T>,
    ) {
        // Real up to rounding since the row is real; the transform insists on exactly. An odd
        // length has no Nyquist frequency at the end.
        spectrum[0].im = T::zero();
        if work.row.len().is_multiple_of(2) {
            spectrum[self.columns() - 1].im = T::zero();
        }
        let done = self.row_inverse.process_with_scratch(spectrum, &mut work.row, &mut work.fft);
        // Those imaginary parts and lengths are all it could complain of.
        debug_assert!(done.is_ok(), "{done:?}");
        vectorized(
            #[inline(always)]
            || {
                for (value, place) in values.iter_mut().zip(&work.row) {
                    *value = F::rounded(place.widened());
                }
            },
        );
    }

    /// Multiplies the spectrum of a column, whose first ny entries are given and the rest is padding, by `symbol`.
    pub(super) fn filter_column(
        &self,
        column: &mut [Complex<T>],
        (symbol, parity): (&[T], Parity),
        work: &mut Workspace<T>,
    ) {
        column[self.ny..].fill(T::ZERO);
        self.column_forward.process_outofplace_with_scratch(
            column,
            &mut work.spectrum,
            &mut work.fft,
        );
        vectorized(
            #[inline(always)]
            || {
                let values = work.spectrum.iter_mut().zip(symbol);
                match parity {
                    Parity::Even => values.for_each(|(value, &factor)| *value = *value * factor),
                    Parity::Odd => values.for_each(|(value, &factor)| {
                        *value = Complex::new(-value.im * factor, value.re * factor);
                    }),
                }
            },
        );
        self.column_inverse.process_outofplace_with_scratch(
            &mut work.spectrum,
            column,
            &mut work.fft,
        );
    }

    /// One column of the symbol, given the spectra of kernel rows dj = 0, 1, …, ny − 1 there.
    ///
    /// Reciprocity, C(−di, −dj) = C(di, dj), makes the spectrum of row −dj the conjugate of that of row dj, and the
    /// symbol real; with the other sign, minus that, and the symbol imaginary. Without padding row −dj is row ny − dj,
    /// which is there already. The symbol includes the 1 / (px py) of the inverse transforms.
    pub(super) fn symbol_column(
        &self,
        (entries, parity): (&[Complex<T>], Parity),
        symbol: &mut [T],
        work: &mut Workspace<T>,
    ) {
        let (inside, padding) = work.column.split_at_mut(self.ny);
        inside.copy_from_slice(entries);
        padding.fill(T::ZERO);
        let opposites = padding.iter_mut().rev().zip(&entries[1..]);
        match parity {
            Parity::Even => {
                inside[0].im = T::zero();
                opposites.for_each(|(opposite, entry)| *opposite = entry.conj());
            }
            Parity::Odd => {
                inside[0].re = T::zero();
                opposites.for_each(|(opposite, entry)| *opposite = -entry.conj());
            }
        }
        self.column_forward.process_outofplace_with_scratch(
            &mut work.column,
            &mut work.spectrum,
            &mut work.fft,
        );
        let (px, py) = self.padded();
        let normalisation = T::rounded(1.0 / (px as f64 * py as f64));
        for (value, spectrum) in symbol.iter_mut().zip(&work.spectrum) {
            let part = match parity {
                Parity::Even => spectrum.re,
                Parity::Odd => spectrum.im,
            };
            *value = part * normalisation;
        }
    }
}

impl<T> Workspace<T> {
    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.row[..])
            + size_of_val(&self.column[..])
            + size_of_val(&self.spectrum[..])
            + size_of_val(&self.fft[..])
    }
}
