//! Long waves and short ones: waviness and roughness.

use std::f64::consts::{LN_2, PI, TAU};

use asperity_fft::Plan;
use nalgebra::DMatrix;
use num_complex::Complex64;

use super::Topography;
use crate::surface::SLACK;
use crate::surface::fourier::Waves;
use crate::{Error, Grid};

/// How a filter of a cut-off wavelength λ_c parts long waves from short ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Filter {
    /// The Gaussian filter of surfaces, ISO 16610-61, for any map: a weighted mean of the heights
    /// around each node.
    ///
    /// ```math
    /// s(x, y) \propto \exp\Bigl(-\pi \frac{x^2 + y^2}{(\alpha \lambda_c)^2}\Bigr), \qquad
    ///    \alpha = \sqrt{\frac{\ln 2}{\pi}}, \qquad |x|, |y| \le \lambda_c
    /// ```
    ///
    /// Half the amplitude of a wave of length λ_c passes, exp(−ln 2 (λ_c/λ)²) of one of length λ.
    /// Beyond λ_c weights are below 7 × 10⁻⁷ of the greatest, and left out. Near the border the weights
    /// of the nodes that exist are normalised to 1 (regression of order zero).
    Gaussian,
    /// Waves of length λ_c and longer pass as they are, shorter ones not at all; for a periodic map.
    Sharp,
}

impl Topography {
    /// The long waves alone: the waviness, at a cut-off wavelength \[m\].
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for a wavelength that is not positive and finite, and
    /// [`Error::HeightNotFinite`] if sums of heights overflow.
    pub fn low_pass(&self, cutoff: f64, filter: Filter) -> Result<Self, Error> {
        Error::require_positive("cut-off wavelength", cutoff)?;
        let mean = self.map.mean_height();
        self.with_heights(match filter {
            Filter::Gaussian => {
                let (dx, dy) = (self.grid.dx(), self.grid.dy());
                let about_mean = self.heights().add_scalar(-mean);
                let half = gaussian_along_x(&about_mean, cutoff / dx).transpose();
                let both = gaussian_along_x(&half, cutoff / dy).transpose();
                both.add_scalar(mean)
            }
            Filter::Sharp => sharp(self.heights(), mean, &self.grid, cutoff),
        })
    }

    /// The short waves alone: the roughness, which is what [`low_pass`](Self::low_pass) leaves out.
    ///
    /// # Errors
    ///
    /// Those of [`low_pass`](Self::low_pass).
    pub fn high_pass(&self, cutoff: f64, filter: Filter) -> Result<Self, Error> {
        let waviness = self.low_pass(cutoff, filter)?;
        self.with_heights(self.heights() - waviness.heights())
    }
}

fn sharp(heights: &DMatrix<f64>, mean: f64, grid: &Grid, cutoff: f64) -> DMatrix<f64> {
    let shortest = TAU / cutoff * (1.0 + SLACK);
    let mut waves = Waves::new(heights, mean, grid);
    waves.multiply(|qx, qy| if libm::hypot(qx, qy) <= shortest { 1.0 } else { 0.0 });
    waves.restore()
}

/// Every column filtered, with the cut-off wavelength in nodes.
///
/// The sums are convolutions, done by a transform with room enough that the ends do not meet; their
/// weights add up to the same convolution of a column of ones.
fn gaussian_along_x(heights: &DMatrix<f64>, cutoff: f64) -> DMatrix<f64> {
    let nodes = heights.nrows();
    // The cast saturates. A node at the cut-off belongs to the sum, however it is rounded.
    let reach = ((cutoff * (1.0 + SLACK)) as usize).min(nodes - 1);
    let weight = |offset: usize| {
        let x = offset as f64 / cutoff;
        libm::exp(-PI * PI / LN_2 * x * x)
    };
    // Σ of the weights at offsets 1 … m, for every m up to the reach.
    let side: Vec<_> = std::iter::once(0.0)
        .chain((1..=reach).scan(0.0, |sum, offset| {
            *sum += weight(offset);
            Some(*sum)
        }))
        .collect();
    let padded = (nodes + reach).next_power_of_two();
    let (forward, inverse) = (f64::real_forward(padded), f64::real_inverse(padded));
    let mut scratch =
        vec![Complex64::ZERO; forward.get_scratch_len().max(inverse.get_scratch_len())];
    let mut line = vec![0.0; padded];
    let mut spectrum = forward.make_output_vec();

    line[0] = 1.0;
    for offset in 1..=reach {
        line[offset] = weight(offset);
        line[padded - offset] = weight(offset);
    }
    let done = forward.process_with_scratch(&mut line, &mut spectrum, &mut scratch);
    // Lengths are all that transforms could complain of, here and below, and they come from the plans.
    debug_assert!(done.is_ok(), "{done:?}");
    // Weights are even: the transfer function is real.
    let transfer: Vec<_> = spectrum.iter().map(|value| value.re / padded as f64).collect();
    let sum = |i: usize| 1.0 + side[i.min(reach)] + side[(nodes - 1 - i).min(reach)];

    let mut filtered = heights.clone();
    for column in filtered.as_mut_slice().chunks_exact_mut(nodes) {
        let (inside, padding) = line.split_at_mut(nodes);
        inside.copy_from_slice(column);
        padding.fill(0.0);
        let done = forward.process_with_scratch(&mut line, &mut spectrum, &mut scratch);
        debug_assert!(done.is_ok(), "{done:?}");
        for (value, transfer) in spectrum.iter_mut().zip(&transfer) {
            *value *= transfer;
        }
        let done = inverse.process_with_scratch(&mut spectrum, &mut line, &mut scratch);
        debug_assert!(done.is_ok(), "{done:?}");
        for (i, (place, value)) in column.iter_mut().zip(&line).enumerate() {
            *place = value / sum(i);
        }
    }
    filtered
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::fourier::tests::noise;
    use crate::surface::{Amplitude, SelfAffine};

    /// The weighted mean as it is defined, node by node.
    #[test]
    fn gaussian_is_its_sum() -> Result<(), Error> {
        let (nx, ny) = (13, 22);
        let grid = Grid::new(nx, ny, 0.5, 0.3)?;
        let heights = DMatrix::from_fn(nx, ny, |ix, iy| 10.0 + noise(ix + nx * iy));
        let map = Topography::new(grid, heights)?;
        for cutoff in [0.1, 0.5, 1.7, 4.0, 6.5, 100.0] {
            let filtered = map.low_pass(cutoff, Filter::Gaussian)?;
            let alpha = (LN_2 / PI).sqrt();
            for ix in 0..nx {
                for iy in 0..ny {
                    let (mut sum, mut weights) = (0.0, 0.0);
                    for jx in 0..nx {
                        for jy in 0..ny {
                            let x = 0.5 * ix.abs_diff(jx) as f64;
                            let y = 0.3 * iy.abs_diff(jy) as f64;
                            // A node at the cut-off itself belongs to the sum, however it is rounded.
                            if x.max(y) <= cutoff * (1.0 + 1e-12) {
                                let t = (x * x + y * y) / (alpha * cutoff).powi(2);
                                sum += (-PI * t).exp() * map.heights()[(jx, jy)];
                                weights += (-PI * t).exp();
                            }
                        }
                    }
                    let error = (filtered.heights()[(ix, iy)] - sum / weights).abs();
                    // Sums of 286 heights of 10.
                    assert!(error < 1e-13, "{cutoff} {ix} {iy} {error:e}");
                }
            }
        }
        Ok(())
    }

    /// Half of a wave of the cut-off wavelength passes, far from the border.
    #[test]
    fn gaussian_transmits_what_it_promises() -> Result<(), Error> {
        let (n, cutoff) = (400, 40.0);
        for wavelength in [20.0, 40.0, 80.0, 160.0] {
            let wave = DMatrix::from_fn(n, n, |ix, iy| {
                (TAU * (0.6 * ix as f64 + 0.8 * iy as f64) / wavelength).cos()
            });
            let map = Topography::new(Grid::square(n, n as f64)?, wave)?;
            let passed = map.low_pass(cutoff, Filter::Gaussian)?;
            let transmission = 0.5_f64.powf((cutoff / wavelength).powi(2));
            for ix in 100..300 {
                let z = (passed.heights()[(ix, 170)], map.heights()[(ix, 170)]);
                // Weights left out: 7e-7 of the greatest along two sides. Sums of 81 weights in place
                // of the integral are exact to far more digits.
                assert!((z.0 - transmission * z.1).abs() < 2e-6, "{wavelength} {ix}");
            }
        }
        Ok(())
    }

    #[test]
    fn a_sharp_filter_parts_the_waves() -> Result<(), Error> {
        let grid = Grid::new(60, 50, 1.0 / 60.0, 1.2 / 50.0)?;
        let spectrum = Amplitude::Prefactor(1.0);
        let all = SelfAffine::new(0.7, 0.4, 0.1, spectrum, 5)?;
        let long = SelfAffine::new(0.7, 0.4, 0.2, spectrum, 5)?;
        let map = Topography::sample(&all, grid)?;
        let waviness = map.low_pass(0.2, Filter::Sharp)?;
        let unit = map.map().rms_height();
        // The same seed without the waves shorter than 0.2, which itself is one that fits: four transforms.
        let expected = Topography::sample(&long, grid)?;
        assert!((waviness.heights() - expected.heights()).amax() < 1e-13 * unit);
        let roughness = map.high_pass(0.2, Filter::Sharp)?;
        assert!((roughness.heights() + waviness.heights() - map.heights()).amax() < 1e-14 * unit);
        let nothing = roughness.low_pass(0.2, Filter::Sharp)?;
        assert!(nothing.heights().amax() < 1e-13 * unit);
        Ok(())
    }

    #[test]
    fn an_offset_is_waviness() -> Result<(), Error> {
        let grid = Grid::square(16, 1.0)?;
        let map = Topography::new(grid, DMatrix::from_element(16, 16, 7.0))?;
        for filter in [Filter::Gaussian, Filter::Sharp] {
            for cutoff in [f64::MIN_POSITIVE, 1e-3, 0.5, 1e300] {
                assert_eq!(map.low_pass(cutoff, filter)?, map);
            }
            for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
                let refused = map.low_pass(bad, filter);
                assert!(matches!(refused, Err(Error::NotPositive { .. })));
            }
        }
        Ok(())
    }
}
