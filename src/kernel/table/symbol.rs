//! Influence coefficients from a symbol: the inverse Fourier transform on the waves of a grid.

use asperity_fft::Plan;
use num_complex::Complex64;

use crate::kernel::MeanDisplacement;
use crate::kernel::gauge::least;
use crate::{Error, Grid, KernelError};

/// Relative difference within which Ĉ(q) and Ĉ(−q) count as the same: a formula whose terms are
/// evaluated in another order, or with functions that are good to some ten digits.
const SAME: f64 = 1e-10;

/// A symbol Ĉ(q) \[m/Pa\] on the waves of a grid.
pub(super) struct Symbol {
    shape: (usize, usize),
    values: Vec<f64>,
    /// How the mean displacement is to be taken: one that is zero, of an incompressible layer, like one that is
    /// arbitrary.
    pub(super) mean: MeanDisplacement,
}

impl Symbol {
    /// # Errors
    ///
    /// As [`KernelTable::from_symbol`](super::KernelTable::from_symbol).
    pub(super) fn new(
        grid: &Grid,
        mean: MeanDisplacement,
        symbol: impl FnMut(f64, f64) -> f64,
    ) -> Result<Self, Error> {
        let values = on_the_waves(grid, mean, symbol)?;
        let mean = if values[0] == 0.0 { MeanDisplacement::Arbitrary } else { mean };
        Ok(Self { shape: grid.shape(), values, mean })
    }

    /// The coefficients C(r) \[m/Pa\] of one period, x fastest.
    pub(super) fn coefficients(&self) -> Vec<f64> {
        transformed(self.shape, &self.values)
    }

    /// The least gauge in which the matrix is an inverse M-matrix, if there is one: see [`least`].
    pub(super) fn least_gauge(&self) -> Option<f64> {
        let reciprocal = |value: &f64| if *value == 0.0 { 0.0 } else { 1.0 / value };
        let inverse: Vec<f64> = self.values.iter().map(reciprocal).collect();
        least(inverse.len(), &transformed(self.shape, &inverse))
    }
}

/// The inverse Fourier transform of what is even, x fastest.
fn transformed((nx, ny): (usize, usize), values: &[f64]) -> Vec<f64> {
    let mut waves: Vec<_> = values.iter().copied().map(Complex64::from).collect();
    f64::complex_inverse(nx).process(&mut waves);
    let along_y = f64::complex_inverse(ny);
    let mut column = vec![Complex64::ZERO; ny];
    let mut result = vec![0.0; nx * ny];
    for ix in 0..nx {
        for (iy, value) in column.iter_mut().enumerate() {
            *value = waves[ix + nx * iy];
        }
        along_y.process(&mut column);
        for (iy, value) in column.iter().enumerate() {
            result[ix + nx * iy] = value.re / (nx * ny) as f64;
        }
    }
    // Even to the last bit, as reciprocity has it.
    let half = |place: usize| {
        let (ix, iy) = (place % nx, place / nx);
        let opposite = (nx - ix) % nx + nx * ((ny - iy) % ny);
        0.5 * (result[place] + result[opposite])
    };
    (0..nx * ny).map(half).collect()
}

/// The symbol at all waves of the grid, in the order of a Fourier transform, even under q → −q.
fn on_the_waves(
    grid: &Grid,
    mean: MeanDisplacement,
    mut symbol: impl FnMut(f64, f64) -> f64,
) -> Result<Vec<f64>, Error> {
    let (nx, ny) = grid.shape();
    let mut value_at = |qx: f64, qy: f64| {
        let value = symbol(qx, qy);
        let is_mean_of_nothing = value == 0.0 && (qx, qy) == (0.0, 0.0);
        if (value > 0.0 && value.is_finite()) || is_mean_of_nothing {
            Ok(value)
        } else {
            Err(Error::Kernel(KernelError::SymbolNotPositive { q: (qx, qy), value }))
        }
    };
    let mut values = Vec::with_capacity(nx * ny);
    for ky in 0..ny {
        for kx in 0..nx {
            let (qx, qy) = grid.wave_vector(kx, ky);
            if (kx, ky) == (0, 0) {
                values.push(match mean {
                    MeanDisplacement::Arbitrary => 0.0,
                    MeanDisplacement::Physical => value_at(0.0, 0.0)?,
                });
                continue;
            }
            let (value, opposite) = (value_at(qx, qy)?, value_at(-qx, -qy)?);
            if (value - opposite).abs() > SAME * value.max(opposite) {
                return Err(Error::Kernel(KernelError::SymbolNotEven {
                    q: (qx, qy),
                    value,
                    opposite,
                }));
            }
            let mut shares = vec![value, opposite];
            // On the grid a wave with two nodes a wavelength along x runs both ways along x at once,
            // and likewise along y.
            if 2 * kx == nx || 2 * ky == ny {
                shares.extend([value_at(-qx, qy)?, value_at(qx, -qy)?]);
            }
            values.push(shares.iter().sum::<f64>() / shares.len() as f64);
        }
    }
    Ok(values)
}
