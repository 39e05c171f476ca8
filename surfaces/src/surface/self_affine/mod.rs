//! Randomly rough surfaces with a self-affine power spectrum.

mod amplitude;
mod band;
mod lattice;
mod spectrum;
mod synthesis;

use nalgebra::DMatrix;

pub use self::amplitude::Amplitude;
use self::band::Band;
pub use self::spectrum::Spectrum;
use super::placement::all_finite;
use crate::{Error, Grid, Surface};

/// A randomly rough, isotropic, self-affine surface.
///
/// A sum of the waves that are periodic on the grid, with the amplitudes of the power spectrum
/// C(q) and random phases:
///
/// ```math
/// h(\mathbf{x}) = \sum_{\mathbf{q} \ne 0} B(q) \,
///     e^{i (\mathbf{q} \cdot \mathbf{x} + \varphi(\mathbf{q}))}, \qquad
///    B = 2\pi \sqrt{C(q) / A_0}, \qquad \varphi(-\mathbf{q}) = -\varphi(\mathbf{q})
/// ```
///
/// ```math
/// C(q) = C_0 \begin{cases}
///     q_r^{-2(1+H)} & q < q_r \\
///     q^{-2(1+H)} & q_r \le q \le q_s \\
///     0 & q > q_s \end{cases}
/// ```
///
/// with q_r = 2π/λ_r and q_s = 2π/λ_s: eq. (23) of the paper, with its misprints set right. A long
/// cut-off wavelength λ_l, if there is one, also takes out q < q_l = 2π/λ_l. A wave whose length
/// equals a cut-off is inside, with a relative slack of 10⁻¹² for rounding.
///
/// On a grid of one row or one column C falls with $`q^{-(1+2H)}`$ instead, and $`B = \sqrt{2\pi C / L}`$: a profile,
/// with the spectrum of a cut through a surface of the exponent H.
///
/// The mean height is 0, the heights are in metres, and x is the position of the node,
/// [`Grid::position`]. The surface is periodic with the sides of the grid. Along a direction with
/// a single node it is constant.
///
/// ```
/// use asperity_surfaces::{Error, Grid, Surface, surface::{Amplitude, HeightMap, SelfAffine}};
///
/// # fn main() -> Result<(), Error> {
/// let grid = Grid::square(128, 1e-3)?;
/// let surface = SelfAffine::new(0.8, 5e-4, 4e-5, Amplitude::RmsHeight(1e-6), 42)?;
/// let map = HeightMap::sample(&surface, &grid)?;
/// assert!((map.rms_height() / 1e-6 - 1.0).abs() < 1e-12);
/// println!("rms gradient {}", surface.spectrum(&grid)?.rms_gradient());
/// # Ok(())
/// # }
/// ```
///
/// # Exact moments
///
/// Because only the phases are random, rms height, rms gradient and rms Laplacian are the same for
/// every seed, by Parseval's theorem, and known beforehand: see [`Spectrum`].
///
/// # Reproducibility
///
/// The same parameters, seed and grid give the same heights bit for bit on every platform with
/// IEEE 754 double precision, with or without the feature `rayon`. To that end the phases are
/// defined as follows, sines, cosines and powers come from the crate `libm`, which does not call
/// the platform's library, and the Fourier transform is one that does not adapt to the processor.
/// A test pins the bits; what could still change them is a change of the last bits of `libm`.
///
/// * The wave with wave numbers (m, n), q = 2π (m/Lx, n/Ly), is given a phase if m > 0, or m = 0
///   and n > 0; its conjugate (−m, −n) has the opposite phase. Of the waves of two nodes along x,
///   m = nx/2, those with n ≥ 0 alone, and along y there are none with n = −ny/2: they are the
///   conjugates of others.
/// * The generator is ChaCha8. Bytes 0 to 7 of its key are the seed, little-endian, the other 24
///   are zero; its stream number is m. The wave takes the words 2k and 2k + 1 of that stream as
///   the lower and upper half of an integer u, where k = 2n if n ≥ 0 and k = −2n − 1 otherwise.
/// * The phase is 2π ⌊u/2¹¹⌋ 2⁻⁵³. A wave that is its own conjugate on the grid, which is possible
///   only at two nodes a wavelength, has the phase 0 if that is below π, and π otherwise, at node
///   (0, 0) and not at the corner where q·x = 0.
///
/// So the phase of a wave depends on the seed and its wave numbers only. The same seed and
/// parameters on a finer grid of the same sides give the *same surface* at more points, as long as
/// the short cut-off wavelength is longer than two cells of either grid; to rounding, since
/// transforms of different lengths round differently.
///
/// # Cost
///
/// Two Fourier transforms of the grid's size, about half a second for 2048 × 2048 nodes. A prime
/// factor p in the number of nodes along a side costs p operations a node: prefer sides with small
/// factors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SelfAffine {
    band: Band,
    amplitude: Amplitude,
    seed: u64,
}

getters!(SelfAffine {
    /// The prescribed amplitude.
    amplitude: Amplitude,
    /// Seed of the random phases.
    seed: u64,
});

impl SelfAffine {
    /// A surface with Hurst exponent `hurst` = H, roll-off wavelength `rolloff_wavelength` = λ_r
    /// \[m\] and short cut-off wavelength `short_cutoff_wavelength` = λ_s \[m\].
    ///
    /// For a spectrum without roll-off choose λ_r as long as the side of the grid.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] unless 0 < H ≤ 1 and λ_s ≤ λ_r; [`Error::NotPositive`] for a
    /// wavelength or amplitude that is not positive and finite. Whether a grid can carry the
    /// surface turns out when it is put on one: see [`SelfAffine::spectrum`].
    pub fn new(
        hurst: f64,
        rolloff_wavelength: f64,
        short_cutoff_wavelength: f64,
        amplitude: Amplitude,
        seed: u64,
    ) -> Result<Self, Error> {
        let is_exponent = hurst > 0.0 && hurst <= 1.0;
        Error::require("Hurst exponent", hurst, is_exponent, "above 0 and at most 1")?;
        Error::require_positive("roll-off wavelength", rolloff_wavelength)?;
        Error::require_positive("short cut-off wavelength", short_cutoff_wavelength)?;
        Error::require(
            "short cut-off wavelength",
            short_cutoff_wavelength,
            short_cutoff_wavelength <= rolloff_wavelength,
            "at most the roll-off wavelength",
        )?;
        let long_cutoff_wavelength = None;
        let band =
            Band { hurst, rolloff_wavelength, short_cutoff_wavelength, long_cutoff_wavelength };
        Ok(Self { band, amplitude: amplitude.checked()?, seed })
    }

    /// Leaves out all waves longer than `long_cutoff_wavelength` = λ_l \[m\].
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`], and [`Error::OutOfRange`] unless λ_l ≥ λ_r.
    pub fn with_long_cutoff_wavelength(
        mut self,
        long_cutoff_wavelength: f64,
    ) -> Result<Self, Error> {
        Error::require_positive("long cut-off wavelength", long_cutoff_wavelength)?;
        Error::require(
            "long cut-off wavelength",
            long_cutoff_wavelength,
            long_cutoff_wavelength >= self.band.rolloff_wavelength,
            "at least the roll-off wavelength",
        )?;
        self.band.long_cutoff_wavelength = Some(long_cutoff_wavelength);
        Ok(self)
    }

    /// The surface of the paper's Table 1: S_q = 50 µm, H = 0.8, λ_r = 2.5 mm, λ_s = 78.125 µm,
    /// meant for a square of 10 mm, where λ_s is two cells of a 256 × 256 grid.
    ///
    /// Its rms gradient is 0.331, not the 0.112 printed in the paper, which does not follow from
    /// the table and eq. (23).
    #[must_use]
    pub fn zhang2020(seed: u64) -> Self {
        Self {
            band: Band {
                hurst: 0.8,
                rolloff_wavelength: 2.5e-3,
                short_cutoff_wavelength: 7.8125e-5,
                long_cutoff_wavelength: None,
            },
            amplitude: Amplitude::RmsHeight(50e-6),
            seed,
        }
    }

    /// Hurst exponent H.
    #[must_use]
    pub fn hurst(&self) -> f64 {
        self.band.hurst
    }

    /// Roll-off wavelength λ_r \[m\].
    #[must_use]
    pub fn rolloff_wavelength(&self) -> f64 {
        self.band.rolloff_wavelength
    }

    /// Short cut-off wavelength λ_s \[m\].
    #[must_use]
    pub fn short_cutoff_wavelength(&self) -> f64 {
        self.band.short_cutoff_wavelength
    }

    /// Long cut-off wavelength λ_l \[m\], if there is one.
    #[must_use]
    pub fn long_cutoff_wavelength(&self) -> Option<f64> {
        self.band.long_cutoff_wavelength
    }

    /// The power spectrum on a grid, with the moments of the surface there.
    ///
    /// # Errors
    ///
    /// [`Error::CutoffBelowGrid`] if λ_s is shorter than two cells along x or y (of a direction
    /// with more than one node), [`Error::NoWaves`] if no wave of the grid lies between the
    /// cut-offs, and [`Error::NotPositive`] if the amplitude leaves the range of numbers.
    pub fn spectrum(&self, grid: &Grid) -> Result<Spectrum, Error> {
        Spectrum::new(self.band, self.amplitude, grid)
    }
}

impl Surface for SelfAffine {
    /// The heights \[m\], with mean 0.
    ///
    /// # Errors
    ///
    /// Those of [`SelfAffine::spectrum`].
    fn heights(&self, grid: &Grid) -> Result<DMatrix<f64>, Error> {
        let spectrum = self.spectrum(grid)?;
        all_finite(synthesis::heights(&spectrum, self.seed, grid))
    }
}

#[cfg(test)]
mod tests;
