//! Windows, which make a map that is not periodic fit for a Fourier transform.

use nalgebra::DMatrix;

use super::Topography;
use crate::Error;
use crate::surface::turns;

/// A weight that falls to zero at the border of a map.
///
/// Each is a product w(x) w(y) of the same weight along both sides; with t = (i + ½)/n, the place
/// of node i on its side:
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Window {
    /// Hann's: $`w = \frac12 (1 - \cos 2 \pi t)`$.
    Hann,
    /// Tukey's: half a Hann window of half the given fraction of the side at either end, and 1
    /// between. 0 is no window, 1 is Hann's.
    Tukey(f64),
}

impl Window {
    /// `Ok` if it is one.
    fn checked(self) -> Result<Self, Error> {
        if let Self::Tukey(fraction) = self {
            let is_one = (0.0..=1.0).contains(&fraction);
            let quantity = "tapered fraction of a Tukey window";
            Error::require(quantity, fraction, is_one, "between 0 and 1")?;
        }
        Ok(self)
    }

    /// The weights of a side of so many nodes, the mean of whose squares is 1.
    fn weights(self, nodes: usize) -> Vec<f64> {
        let tapered = match self {
            Self::Hann => 1.0,
            Self::Tukey(fraction) => fraction,
        };
        let weight = |i: usize| {
            let from_end = (i.min(nodes - 1 - i) as f64 + 0.5) / nodes as f64;
            if from_end < 0.5 * tapered {
                0.5 * (1.0 - turns::cos(from_end / tapered))
            } else {
                1.0
            }
        };
        let weights: Vec<f64> = (0..nodes).map(weight).collect();
        let squares: f64 = weights.iter().map(|weight| weight * weight).sum();
        let normal = (nodes as f64 / squares).sqrt();
        weights.into_iter().map(|weight| normal * weight).collect()
    }
}

impl Topography {
    /// The heights above their mean, multiplied by a window:
    ///
    /// ```math
    /// h_{ij} \to (h_{ij} - \bar h)\, w_i\, w_j, \qquad \langle w_i^2 \rangle = \langle w_j^2 \rangle = 1
    /// ```
    ///
    /// What makes a spectrum of a map that is not periodic free of the jumps at its border.
    /// Normalised by the mean square of the weights, it keeps the mean square height of a surface
    /// that is rough alike everywhere, and with it the level of its power spectrum. Level the map
    /// before. The window adds a slope of its own, of the order of S_q over the tapered length, and
    /// smears the spectrum over neighbouring waves.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a tapered fraction that is not between 0 and 1, and
    /// [`Error::HeightNotFinite`] if differences of heights overflow.
    pub fn window(&self, window: Window) -> Result<Self, Error> {
        let window = window.checked()?;
        let (nx, ny) = self.grid.shape();
        let (x, y) = (window.weights(nx), window.weights(ny));
        let mean = self.map.mean_height();
        let heights = self.heights();
        self.with_heights(DMatrix::from_fn(nx, ny, |ix, iy| {
            (heights[(ix, iy)] - mean) * (x[ix] * y[iy])
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Grid;

    #[test]
    fn weights_follow_their_equations() {
        use std::f64::consts::PI;
        for nodes in [1_usize, 2, 3, 16, 37] {
            for (window, tapered) in [
                (Window::Hann, 1.0),
                (Window::Tukey(1.0), 1.0),
                (Window::Tukey(0.4), 0.4),
                (Window::Tukey(0.0), 0.0),
            ] {
                let weights = window.weights(nodes);
                let squares: f64 = weights.iter().map(|w| w * w).sum();
                // Rounding of 37 squares.
                assert!((squares / nodes as f64 - 1.0).abs() < 1e-14);
                let expected = |i: usize| {
                    let t = (i as f64 + 0.5) / nodes as f64;
                    let end = t.min(1.0 - t);
                    if 2.0 * end < tapered { (PI * end / tapered).sin().powi(2) } else { 1.0 }
                };
                let middle = nodes / 2;
                for (i, weight) in weights.iter().enumerate() {
                    assert_eq!(weight.to_bits(), weights[nodes - 1 - i].to_bits());
                    // A normalisation apart; a few rounding errors.
                    let relative = weight / weights[middle];
                    assert!((relative - expected(i) / expected(middle)).abs() < 1e-13);
                }
            }
        }
    }

    /// The mean square of a wave under Hann's window: that of the wave but for the parts that the
    /// window shifts it by, which are waves again and have none.
    #[test]
    fn the_mean_square_stays() -> Result<(), Error> {
        let grid = Grid::square(64, 1.0)?;
        let wave = DMatrix::from_fn(64, 64, |ix, iy| {
            3.0 + turns::cos((5.0 * ix as f64 + 7.0 * iy as f64) / 64.0)
        });
        let map = Topography::new(grid, wave)?;
        let windowed = map.window(Window::Hann)?;
        let square = windowed.heights().norm_squared() / 4096.0;
        // Exact but for rounding: the shifts by one and two waves meet no other.
        assert!((square - 0.5).abs() < 1e-13, "{square}");
        let level = map.window(Window::Tukey(0.0))?;
        // Rounding of the mean, 3.
        assert!((level.heights() - map.heights().add_scalar(-3.0)).amax() < 1e-14);
        Ok(())
    }

    #[test]
    fn fractions_that_are_none() -> Result<(), Error> {
        let map = Topography::new(Grid::square(2, 1.0)?, DMatrix::zeros(2, 2))?;
        for bad in [-0.1, 1.1, f64::NAN, f64::INFINITY] {
            let refused = map.window(Window::Tukey(bad));
            assert!(matches!(refused, Err(Error::OutOfRange { .. })));
        }
        Ok(())
    }
}
