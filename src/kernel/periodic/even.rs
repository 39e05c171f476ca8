//! Functions on a periodic grid that are even along x and along y, and their Fourier transform.

use asperity_fft::Plan;
use num_complex::Complex;

/// The values at 0 ≤ i ≤ nx / 2, 0 ≤ j ≤ ny / 2 of a function f(±i, ±j), periodic on nx × ny nodes.
///
/// Its Fourier transform is real and even too, so that either can be kept like this.
#[derive(Debug, Clone)]
pub(in crate::kernel) struct Even {
    nx: usize,
    ny: usize,
    /// i fastest.
    values: Vec<f64>,
}

impl Even {
    /// Calls `value(i, j)` for each pair of 0 ≤ i ≤ nx / 2 and 0 ≤ j ≤ ny / 2.
    pub(in crate::kernel) fn from_fn(
        (nx, ny): (usize, usize),
        mut value: impl FnMut(usize, usize) -> f64,
    ) -> Self {
        let mut values = Vec::with_capacity((nx / 2 + 1) * (ny / 2 + 1));
        for j in 0..=ny / 2 {
            values.extend((0..=nx / 2).map(|i| value(i, j)));
        }
        Self { nx, ny, values }
    }

    pub(in crate::kernel) fn map(&self, function: impl FnMut(f64) -> f64) -> Self {
        Self { values: self.values.iter().copied().map(function).collect(), ..*self }
    }

    /// The value at any place, on the grid or in one of its periods.
    pub(in crate::kernel) fn at(&self, i: isize, j: isize) -> f64 {
        let (i, j) = (fold(i, self.nx), fold(j, self.ny));
        self.values[i + j * (self.nx / 2 + 1)]
    }

    /// All values, of which the first is that at (0, 0).
    pub(in crate::kernel) fn values(&self) -> &[f64] {
        &self.values
    }

    /// $`\frac1M \sum_{\mathbf k} f(\mathbf k) \, e^{2 \pi i (k_1 i / n_x + k_2 j / n_y)}`$.
    pub(in crate::kernel) fn inverse_transform(&self) -> Self {
        let lines = |values: &[f64], n: usize| {
            let (fft, half) = (f64::complex_inverse(n), n / 2 + 1);
            let mut line = vec![Complex::default(); n];
            let mut scratch = vec![Complex::default(); fft.get_inplace_scratch_len()];
            let count = values.len() / half;
            let mut transposed = vec![0.0; values.len()];
            for (j, values) in values.chunks_exact(half).enumerate() {
                for (i, place) in line.iter_mut().enumerate() {
                    *place = Complex::new(values[i.min(n - i)], 0.0);
                }
                fft.process_with_scratch(&mut line, &mut scratch);
                for (i, value) in line[..half].iter().enumerate() {
                    transposed[i * count + j] = value.re / n as f64;
                }
            }
            transposed
        };
        let along_x = lines(&self.values, self.nx);
        Self { values: lines(&along_x, self.ny), ..*self }
    }
}

/// The place between 0 and n / 2 with the same value.
fn fold(i: isize, n: usize) -> usize {
    let i = i.unsigned_abs() % n;
    i.min(n - i)
}

/// cos 2πj/n, with the argument reduced exactly to an eighth of a turn.
pub(super) fn cosine_of_turn(j: usize, n: usize) -> f64 {
    use std::f64::consts::FRAC_PI_2;

    let j = j % n;
    // m / n is the angle in right angles, and its cosine ±cos of one between 0 and 1.
    let m = 4 * j.min(n - j);
    let (sign, m) = if m > n { (-1.0, 2 * n - m) } else { (1.0, m) };
    sign * if 2 * m > n {
        libm::sin(FRAC_PI_2 * ((n - m) as f64 / n as f64))
    } else {
        libm::cos(FRAC_PI_2 * (m as f64 / n as f64))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_transform_is_the_sum_of_cosines() {
        for shape in [(1, 1), (1, 6), (7, 1), (2, 3), (8, 6), (9, 7), (5, 12)] {
            let (nx, ny) = shape;
            let spectrum = Even::from_fn(shape, |i, j| (1.0 + i as f64 + 0.3 * j as f64).recip());
            let found = spectrum.inverse_transform();
            for (x, y) in [(0, 0), (1, 0), (-3, 2), (5, -11)] {
                let mut sum = 0.0;
                for ky in 0..ny as isize {
                    for kx in 0..nx as isize {
                        let phase = cosine_of_turn((kx * x).rem_euclid(nx as isize) as usize, nx)
                            * cosine_of_turn((ky * y).rem_euclid(ny as isize) as usize, ny);
                        sum += spectrum.at(kx, ky) * phase;
                    }
                }
                let expected = sum / (nx * ny) as f64;
                // Means of at most 63 numbers below 1, each rounded a few times.
                assert!(
                    (found.at(x, y) - expected).abs() < 1e-15,
                    "{nx} x {ny} at ({x}, {y}): {} instead of {expected}",
                    found.at(x, y)
                );
            }
        }
    }

    #[test]
    fn cosines_of_fractions_of_a_turn() {
        let exact =
            [(0, 5, 1.0), (1, 4, 0.0), (3, 4, 0.0), (1, 2, -1.0), (1, 3, -0.5), (5, 6, 0.5)];
        for (j, n, cosine) in exact {
            // One rounding of the argument and one of the result.
            assert!((cosine_of_turn(j, n) - cosine).abs() <= f64::EPSILON);
        }
        // Right angles have no rounding at all.
        for n in [4, 12, 100] {
            let right = [0, 1, 2, 3].map(|quarters| cosine_of_turn(quarters * n / 4, n));
            assert_eq!(right, [1.0, 0.0, -1.0, 0.0], "{n}");
        }
        for j in 0..17 {
            let cosine = (std::f64::consts::TAU * j as f64 / 17.0).cos();
            // The argument here is rounded by up to 4 × 2⁻⁵³.
            assert!((cosine_of_turn(j + 34, 17) - cosine).abs() < 1e-15);
        }
    }
}
