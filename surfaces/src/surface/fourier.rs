//! The waves that a periodic map consists of.

use asperity_fft::Plan;
use nalgebra::DMatrix;
use num_complex::Complex64;

use crate::Grid;
use crate::parallel::for_each_chunk;

/// Lines transformed by one thread at a time.
const LINES: usize = 16;

/// Fourier coefficients of heights about their mean:
///
/// ```math
/// h_{ij} = \bar h + \sum_{\mathbf k \ne 0} \hat h_{\mathbf k}\,
///    e^{2 \pi i (k_x i / n_x + k_y j / n_y)}
/// ```
///
/// The mean is kept apart, so that waves have the rounding errors of the roughness and not of an offset.
#[derive(Debug, Clone)]
pub(super) struct Waves {
    grid: Grid,
    mean: f64,
    /// Element `[(ky, kx)]`, ky = 0 … ny − 1 and kx = 0 … nx/2; the others are conjugates of these.
    coefficients: DMatrix<Complex64>,
}

/// One wave and, if `count` is 2, its conjugate.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wave {
    /// Wave numbers along x and y, from −n/2 to n/2.
    pub(super) k: (i64, i64),
    /// Wavevector 2πk/L \[rad/m\].
    pub(super) q: (f64, f64),
    /// Square of the coefficient \[m²\].
    pub(super) power: f64,
    /// Waves that this one stands for.
    pub(super) count: usize,
}

impl Waves {
    /// The waves of `heights` with their mean `mean` on `grid`, whose shape is that of the heights.
    pub(super) fn new(heights: &DMatrix<f64>, mean: f64, grid: &Grid) -> Self {
        let (nx, ny) = grid.shape();
        let along_x = f64::real_forward(nx);
        let columns = along_x.complex_len();
        let mut rows = DMatrix::<Complex64>::zeros(columns, ny);
        for_each_chunk(rows.as_mut_slice(), columns * LINES, |chunk, spectra| {
            let mut scratch = along_x.make_scratch_vec();
            let mut line = along_x.make_input_vec();
            let sources = heights.as_slice()[chunk * LINES * nx..].chunks_exact(nx);
            for (spectrum, source) in spectra.chunks_exact_mut(columns).zip(sources) {
                for (value, z) in line.iter_mut().zip(source) {
                    *value = z - mean;
                }
                let done = along_x.process_with_scratch(&mut line, spectrum, &mut scratch);
                // Lengths are all it could complain of, and they come from the plan.
                debug_assert!(done.is_ok(), "{done:?}");
            }
        });
        let mut coefficients = rows.transpose();
        let along_y = f64::complex_forward(ny);
        let normalisation = 1.0 / grid.nodes() as f64;
        for_each_chunk(coefficients.as_mut_slice(), ny * LINES, |_, lines| {
            along_y.process(lines);
            for value in lines {
                *value *= normalisation;
            }
        });
        coefficients[(0, 0)] = Complex64::ZERO;
        Self { grid: *grid, mean, coefficients }
    }

    /// The grid of the map.
    pub(super) fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The same waves about a mean of 0.
    pub(super) fn without_mean(mut self) -> Self {
        self.mean = 0.0;
        self
    }

    /// All waves but the mean.
    pub(super) fn iter(&self) -> impl Iterator<Item = Wave> {
        let ny = self.grid.ny();
        let entries = self.coefficients.as_slice().iter().enumerate().skip(1);
        entries.map(move |(entry, value)| {
            let (k, q, count) = self.place(entry % ny, entry / ny);
            Wave { k, q, power: value.norm_sqr(), count }
        })
    }

    /// The same waves, each multiplied by `factor(qx, qy)`, which must be even; the mean stays.
    pub(super) fn multiply(&mut self, factor: impl Fn(f64, f64) -> f64) {
        let ny = self.grid.ny();
        for entry in 1..self.coefficients.len() {
            let (_, (qx, qy), _) = self.place(entry % ny, entry / ny);
            self.coefficients[entry] *= factor(qx, qy);
        }
    }

    /// The waves of the autocorrelation: the mean of all products of heights so far apart.
    pub(super) fn square(&mut self) {
        for value in self.coefficients.as_mut_slice() {
            *value = Complex64::new(value.norm_sqr(), 0.0);
        }
    }

    /// The mean and the sum of the waves at the nodes.
    pub(super) fn restore(self) -> DMatrix<f64> {
        let Self { grid, mean, mut coefficients } = self;
        let (nx, ny) = grid.shape();
        let along_y = f64::complex_inverse(ny);
        for_each_chunk(coefficients.as_mut_slice(), ny * LINES, |_, lines| {
            along_y.process(lines);
        });
        let mut rows = coefficients.transpose();
        drop(coefficients);
        let along_x = f64::real_inverse(nx);
        let columns = along_x.complex_len();
        // Real up to rounding since the heights are; the transform insists on exactly.
        for row in rows.as_mut_slice().chunks_exact_mut(columns) {
            row[0].im = 0.0;
            if nx.is_multiple_of(2) {
                row[columns - 1].im = 0.0;
            }
        }
        let mut heights = DMatrix::zeros(nx, ny);
        for_each_chunk(heights.as_mut_slice(), nx * LINES, |chunk, lines| {
            let mut scratch = along_x.make_scratch_vec();
            let mut spectrum = along_x.make_input_vec();
            let spectra = rows.as_slice()[chunk * LINES * columns..].chunks_exact(columns);
            for (line, source) in lines.chunks_exact_mut(nx).zip(spectra) {
                spectrum.copy_from_slice(source);
                let done = along_x.process_with_scratch(&mut spectrum, line, &mut scratch);
                // Those imaginary parts and lengths are all it could complain of.
                debug_assert!(done.is_ok(), "{done:?}");
                for z in line {
                    *z += mean;
                }
            }
        });
        heights
    }

    /// Wave numbers, wavevector and number of waves of the coefficient `[(row, column)]`.
    fn place(&self, row: usize, column: usize) -> ((i64, i64), (f64, f64), usize) {
        let (nx, ny) = self.grid.shape();
        let ky = if 2 * row > ny { row as i64 - ny as i64 } else { row as i64 };
        let own = column == 0 || 2 * column == nx;
        let q = self.grid.wave_vector(column, row);
        ((column as i64, ky), q, if own { 1 } else { 2 })
    }
}

#[cfg(test)]
pub(super) mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::Error;

    /// Numbers between 0 and 1 that look random: the fractional parts of multiples of the golden ratio.
    pub(in crate::surface) fn noise(node: usize) -> f64 {
        (node as f64 * 0.618_033_988_749_894_9).fract()
    }

    /// Parseval, the number of waves, and the way back, on grids of any parity.
    #[test]
    fn waves_add_up_to_the_heights() -> Result<(), Error> {
        for (nx, ny) in [(1, 1), (1, 8), (8, 1), (2, 2), (7, 9), (12, 35), (35, 12), (40, 34)] {
            let grid = Grid::new(nx, ny, 0.5, 2.0)?;
            let heights = DMatrix::from_fn(nx, ny, |ix, iy| 1e6 + noise(ix + nx * iy));
            let mean = heights.mean();
            let waves = Waves::new(&heights, mean, &grid);
            let count: usize = waves.iter().map(|wave| wave.count).sum();
            assert_eq!(count, nx * ny - 1);
            let power: f64 = waves.iter().map(|w| w.count as f64 * w.power).sum();
            let square = heights.map(|z| (z - mean).powi(2)).mean();
            // The mean is rounded to 1e-10, which the waves do not see; sums of 1360 squares below 1.
            assert!((power - square).abs() < 1e-12, "{nx} x {ny}");
            assert!((waves.restore() - heights).amax() < 1e-9);
        }
        Ok(())
    }

    #[test]
    fn a_wave_has_its_own_wavevector() -> Result<(), Error> {
        let (nx, ny) = (10, 9);
        let grid = Grid::new(nx, ny, 0.5, 2.0)?;
        for (kx, ky) in [(1, 0), (0, 2), (3, -4), (5, 1), (4, 4)] {
            let heights = DMatrix::from_fn(nx, ny, |ix, iy| {
                let turns =
                    (kx * ix as i64) as f64 / nx as f64 + (ky * iy as i64) as f64 / ny as f64;
                (TAU * turns).cos()
            });
            let mut waves = Waves::new(&heights, 0.0, &grid);
            for wave in waves.iter() {
                // Both of a pair are met where kx is 0 or n/2.
                let own = wave.k == (kx, ky) || (kx % 5 == 0 && wave.k == (kx, -ky));
                // ½ of the amplitude in either; rounding of angles up to 40.
                let expected = if own { 0.25 } else { 0.0 };
                assert!((wave.power - expected).abs() < 1e-14, "{wave:?}");
            }
            // Derivatives along x and y of a plane wave: −q² h.
            let (qx, qy) = (TAU * kx as f64 / 5.0, TAU * ky as f64 / 18.0);
            waves.multiply(|qx, qy| -(qx * qx + qy * qy));
            let laplacian = heights * -(qx * qx + qy * qy);
            assert!((waves.restore() - laplacian).amax() < 1e-12);
        }
        Ok(())
    }
}
