//! Cosine waves, whose periodic contact has been solved by Westergaard and by Johnson, Greenwood
//! and Higginson.

use nalgebra::DMatrix;

use super::placement::{Axis, Placement};
use super::shapes::placed;
use super::turns;
use crate::{Error, Grid, Surface};

/// A one-dimensional wave.
///
/// ```math
/// z = D \cos \frac{2\pi x}{\lambda}
/// ```
///
/// along x, or the same along y; the distance is measured from a crest, which runs through the
/// centre of the grid unless moved by [`centered_at`](Self::centered_at). Westergaard's contact,
/// eq. (21) of the paper, where the amplitude is called Δ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wave {
    amplitude: f64,
    wavelength: f64,
    direction: Axis,
    placement: Placement,
}

getters!(Wave {
    /// Amplitude D \[m\].
    amplitude: f64,
    /// Wavelength λ \[m\].
    wavelength: f64,
    /// Direction along which the heights vary.
    direction: Axis,
});

impl Wave {
    /// A wave of amplitude `amplitude` = D \[m\], half its peak-to-valley height, and wavelength
    /// `wavelength` = λ \[m\] whose heights vary along `direction`.
    ///
    /// Nothing ties the wavelength to the grid: for a periodic half-space choose one that fits
    /// into the side a whole number of times.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for a parameter that is not positive and finite.
    pub fn new(amplitude: f64, wavelength: f64, direction: Axis) -> Result<Self, Error> {
        let amplitude = Error::require_positive("amplitude", amplitude)?;
        let wavelength = Error::require_positive("wavelength", wavelength)?;
        Ok(Self { amplitude, wavelength, direction, placement: Placement::default() })
    }
}

placed!(Wave, "a point of a crest", |this, x, y| {
    this.amplitude * turns::cos(this.direction.of((x, y)) / this.wavelength)
});

/// A two-dimensional wave.
///
/// ```math
/// z = D \cos \frac{2\pi x}{\lambda_x} \cos \frac{2\pi y}{\lambda_y}
/// ```
///
/// with x and y measured from a peak, which is in the centre of the grid unless moved by
/// [`centered_at`](Self::centered_at). There are two peaks a cell of λ_x × λ_y. With equal
/// wavelengths, the contact of Johnson, Greenwood and Higginson, whose limits are `asperity::reference::DoubleWave`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BiWave {
    amplitude: f64,
    wavelength_x: f64,
    wavelength_y: f64,
    placement: Placement,
}

getters!(BiWave {
    /// Amplitude D \[m\].
    amplitude: f64,
});

impl BiWave {
    /// A wave of amplitude `amplitude` = D \[m\], half its peak-to-valley height, and wavelengths
    /// `wavelength_x` and `wavelength_y` \[m\].
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for a parameter that is not positive and finite.
    pub fn new(amplitude: f64, wavelength_x: f64, wavelength_y: f64) -> Result<Self, Error> {
        let amplitude = Error::require_positive("amplitude", amplitude)?;
        let wavelength_x = Error::require_positive("wavelength along x", wavelength_x)?;
        let wavelength_y = Error::require_positive("wavelength along y", wavelength_y)?;
        Ok(Self { amplitude, wavelength_x, wavelength_y, placement: Placement::default() })
    }

    /// Wavelengths λ_x and λ_y \[m\].
    #[must_use]
    pub fn wavelengths(&self) -> (f64, f64) {
        (self.wavelength_x, self.wavelength_y)
    }
}

placed!(BiWave, "a peak", |this, x, y| {
    this.amplitude * (turns::cos(x / this.wavelength_x) * turns::cos(y / this.wavelength_y))
});

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::shapes::tests::assert_mirrored;
    use std::f64::consts::TAU;

    #[test]
    fn waves_follow_their_equations() -> Result<(), Error> {
        let grid = Grid::with_sides(40, 30, 1e-2, 2e-2)?;
        let (cx, cy) = (1.3e-3, -2e-3);
        let (d, lx, ly) = (3e-6, 2.7e-3, 5.1e-3);
        let along_x = Wave::new(d, lx, Axis::X)?.centered_at(cx, cy)?.heights(&grid)?;
        let along_y = Wave::new(d, ly, Axis::Y)?.centered_at(cx, cy)?.heights(&grid)?;
        let both = BiWave::new(d, lx, ly)?.centered_at(cx, cy)?.heights(&grid)?;
        for ix in 0..40 {
            for iy in 0..30 {
                let (x, y) = grid.position(ix, iy);
                let wave_x = (TAU * (x - cx) / lx).cos();
                let wave_y = (TAU * (y - cy) / ly).cos();
                // Angles up to 30 rounded a few times each: some 1e-14 of the amplitude.
                let close = |z: f64, expected: f64| assert!((z - expected).abs() < 3e-14 * d);
                close(along_x[(ix, iy)], d * wave_x);
                close(along_y[(ix, iy)], d * wave_y);
                close(both[(ix, iy)], d * wave_x * wave_y);
            }
        }
        Ok(())
    }

    #[test]
    fn waves_are_symmetric_bit_for_bit() -> Result<(), Error> {
        for n in [1, 2, 31, 64] {
            let grid = Grid::square(n, 1.1e-2)?;
            let heights = BiWave::new(1e-6, 1.1e-2 / 3.0, 1.1e-2 / 3.0)?.heights(&grid)?;
            assert_eq!(heights, heights.transpose());
            let profile = Wave::new(1e-6, 1.1e-2, Axis::X)?.heights(&grid)?;
            assert_mirrored(&heights);
            assert_mirrored(&profile);
            let same = |ix, iy| profile[(ix, iy)].to_bits() == profile[(ix, 0)].to_bits();
            assert!((0..n * n).all(|node| same(node % n, node / n)));
        }
        Ok(())
    }

    /// Parameters are kept, each under its own name.
    #[test]
    fn waves_say_what_they_were_made_of() -> Result<(), Error> {
        let wave = Wave::new(2e-6, 3e-3, Axis::Y)?;
        assert_eq!((wave.amplitude(), wave.wavelength()), (2e-6, 3e-3));
        assert_eq!(wave.direction(), Axis::Y);
        let both = BiWave::new(2e-6, 3e-3, 5e-3)?;
        assert_eq!((both.amplitude(), both.wavelengths()), (2e-6, (3e-3, 5e-3)));
        Ok(())
    }

    #[test]
    fn bad_parameters_are_refused() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            for error in [
                Wave::new(bad, 1.0, Axis::X).err(),
                Wave::new(1.0, bad, Axis::Y).err(),
                BiWave::new(bad, 1.0, 1.0).err(),
                BiWave::new(1.0, bad, 1.0).err(),
                BiWave::new(1.0, 1.0, bad).err(),
            ] {
                assert!(matches!(error, Some(Error::NotPositive { .. })));
            }
        }
    }
}
