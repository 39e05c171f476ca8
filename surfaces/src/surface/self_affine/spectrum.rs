//! The power spectrum of a self-affine surface, on the waves of a grid.

use std::f64::consts::TAU;

use super::amplitude::Amplitude;
use super::band::Band;
use super::lattice::Lattice;
use crate::{Error, Grid};

/// The power spectrum of a [`SelfAffine`](super::SelfAffine) surface on a grid, normalised to the prescribed
/// amplitude; made by [`SelfAffine::spectrum`](super::SelfAffine::spectrum).
///
/// Wavevectors q = 2π/λ \[rad/m\]. The moments are those of the surface that
/// [`Surface::heights`](crate::Surface::heights) returns on this grid, exact for any seed, because
/// only the phases of the waves are random.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spectrum {
    band: Band,
    /// With which power of the wavevector the density falls.
    exponent: f64,
    /// Mean square height of a wave on the plateau, B² there.
    plateau: f64,
    /// Of the plane of wavevectors, or of their line, what belongs to one wave: (2π)²/A₀ or 2π/L.
    of_wave: f64,
    /// Σ w (q/q_r)^2k C/C(0) over the waves for k = 0, 1, 2.
    sums: [f64; 3],
}

impl Spectrum {
    /// The spectrum of the waves of `grid` in `band`.
    ///
    /// # Errors
    ///
    /// As [`SelfAffine::spectrum`](super::SelfAffine::spectrum).
    pub(super) fn new(band: Band, amplitude: Amplitude, grid: &Grid) -> Result<Self, Error> {
        band.check_resolved(grid)?;
        let lattice = Lattice::new(grid, band.rolloff_wavelength);
        let exponent = band.exponent(grid);
        let mut sums = [0.0; 3];
        for m in 0..=band.limit(grid.nx(), lattice.step_x) {
            let n_limit = band.limit(grid.ny(), lattice.step_y);
            let mut row = [0.0; 3];
            for n in -n_limit..=n_limit {
                let weight = lattice.multiplicity(m, n);
                let t = lattice.wave_number(m, n);
                let share = band.shape(t, exponent);
                if weight == 0.0 || share == 0.0 {
                    continue;
                }
                row[0] += weight * share;
                row[1] += weight * share * t * t;
                row[2] += weight * share * t * t * t * t;
            }
            for (sum, row) in sums.iter_mut().zip(row) {
                *sum += row;
            }
        }
        if sums[0] == 0.0 {
            return Err(Error::NoWaves {
                shortest: band.short_cutoff_wavelength,
                longest: band.long_cutoff_wavelength.unwrap_or(f64::INFINITY),
            });
        }
        let of_map = TAU * TAU / grid.nominal_area();
        let of_wave = grid.length_of_profile().map_or(of_map, |length| TAU / length);
        let plateau = match amplitude {
            Amplitude::RmsHeight(rms) => rms * rms / sums[0],
            Amplitude::RmsGradient(rms) => {
                let height = rms / band.rolloff();
                height * height / sums[1]
            }
            Amplitude::Prefactor(c0) => c0 * libm::pow(band.rolloff(), -exponent) * of_wave,
        };
        Ok(Self {
            band,
            exponent,
            plateau: Error::require_positive("mean square height of a wave", plateau)?,
            of_wave,
            sums,
        })
    }

    /// Power spectral density C(q) at the wavevector q \[rad/m\], in m⁴:
    ///
    /// ```math
    /// C(q) = C_0 \begin{cases}
    ///     0 & q < q_l \\
    ///     q_r^{-2(1+H)} & q_l \le q < q_r \\
    ///     q^{-2(1+H)} & q_r \le q \le q_s \\
    ///     0 & q > q_s \end{cases}
    /// ```
    ///
    /// Eq. (23) of the paper, where the upper limit is misprinted and C₀ is left out. It is the
    /// two-dimensional density: $`S_q^2 = \int C \, \mathrm{d}^2 q`$, on a grid the sum of
    /// `C (2π)²/A₀` over its waves, q = 0 excluded.
    ///
    /// Of a profile, a grid of one row, it is the density in m³ with 1 + 2H in place of 2(1+H):
    /// $`R_q^2 = \int C \, \mathrm{d} q`$, the sum of `C 2π/L` over waves of either sign.
    #[must_use]
    pub fn psd(&self, q: f64) -> f64 {
        let share = self.band.shape(q / self.band.rolloff(), self.exponent);
        self.plateau * share / self.of_wave
    }

    /// The prefactor C₀ \[m^(2 − 2H)\].
    #[must_use]
    pub fn prefactor(&self) -> f64 {
        self.plateau / self.of_wave * libm::pow(self.band.rolloff(), self.exponent)
    }

    /// Root mean square height S_q \[m\].
    #[must_use]
    pub fn rms_height(&self) -> f64 {
        (self.plateau * self.sums[0]).sqrt()
    }

    /// Root mean square gradient $`\sqrt{\langle |\nabla h|^2 \rangle}`$, two-dimensional, without
    /// unit.
    #[must_use]
    pub fn rms_gradient(&self) -> f64 {
        (self.plateau * self.sums[1]).sqrt() * self.band.rolloff()
    }

    /// Root mean square Laplacian $`\sqrt{\langle (\nabla^2 h)^2 \rangle}`$ \[1/m\], twice the root
    /// mean square of the mean curvature.
    #[must_use]
    pub fn rms_laplacian(&self) -> f64 {
        (self.plateau * self.sums[2]).sqrt() * self.band.rolloff() * self.band.rolloff()
    }

    /// Nayak's parameter, the breadth of the spectrum:
    ///
    /// ```math
    /// \alpha = \frac{m_0 m_4}{m_2^2} = \frac{3}{2}
    ///     \frac{\langle h^2 \rangle \langle (\nabla^2 h)^2 \rangle}{\langle |\nabla h|^2 \rangle^2}
    /// ```
    ///
    /// with the profile moments m₀ = ⟨h²⟩, m₂ = ½⟨|∇h|²⟩, m₄ = ⅜⟨(∇²h)²⟩ of an isotropic surface.
    #[must_use]
    pub fn nayak_parameter(&self) -> f64 {
        1.5 * self.sums[0] * (self.sums[2] / self.sums[1]) / self.sums[1]
    }

    /// The band of wavevectors.
    pub(super) fn band(&self) -> &Band {
        &self.band
    }

    /// Amplitude \[m\] of a wave at t = q/q_r, 0 outside the band.
    pub(super) fn amplitude(&self, t: f64) -> f64 {
        self.plateau.sqrt() * self.band.shape(t, self.exponent).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::SelfAffine;

    #[test]
    fn density_is_that_of_eq_23() -> Result<(), Error> {
        let surface = SelfAffine::new(0.7, 2e-3, 1e-4, Amplitude::Prefactor(3e-5), 1)?
            .with_long_cutoff_wavelength(5e-3)?;
        let spectrum = surface.spectrum(&Grid::with_sides(300, 240, 1e-2, 8e-3)?)?;
        let (ql, qr, qs) = (TAU / 5e-3, TAU / 2e-3, TAU / 1e-4);
        // Powers with a handful of rounding errors, exponent 3.4.
        let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-14, "{a} {b}");
        close(spectrum.prefactor(), 3e-5);
        for q in [ql, 1.5 * ql, 0.999 * qr] {
            close(spectrum.psd(q), 3e-5 * qr.powf(-3.4));
        }
        for q in [1.001 * qr, 5.0 * qr, qs] {
            close(spectrum.psd(q), 3e-5 * q.powf(-3.4));
        }
        for q in [0.0, 0.999 * ql, 1.001 * qs, f64::INFINITY, f64::NAN] {
            assert_eq!(spectrum.psd(q), 0.0);
        }
        Ok(())
    }

    #[test]
    fn moments_approach_the_integrals() -> Result<(), Error> {
        // Many waves in the band, so that sums over waves are close to integrals over q.
        let surface = SelfAffine::new(0.5, 0.05, 0.01, Amplitude::RmsHeight(1.0), 0)?;
        let spectrum = surface.spectrum(&Grid::square(512, 1.0)?)?;
        let c0 = spectrum.prefactor();
        let (qr, qs) = (TAU / 0.05, TAU / 0.01);
        // 2π ∫ q^(2k+1) C dq with C = C0 qr^-3 below the roll-off and C0 q^-3 above.
        let m0 = TAU * c0 * (0.5 / qr + (1.0 / qr - 1.0 / qs));
        let m2 = TAU * c0 * (0.25 * qr + (qs - qr));
        let m4 = TAU * c0 * (qr.powi(3) / 6.0 + (qs.powi(3) - qr.powi(3)) / 3.0);
        // Waves on a circle of radius 100 against its area: about 1e-3, most at the outer edge.
        assert!((spectrum.rms_height().powi(2) / m0 - 1.0).abs() < 3e-3);
        assert!((spectrum.rms_gradient().powi(2) / m2 - 1.0).abs() < 3e-3);
        assert!((spectrum.rms_laplacian().powi(2) / m4 - 1.0).abs() < 3e-3);
        let nayak = m0 * (3.0 / 8.0 * m4) / (m2 / 2.0).powi(2);
        assert!((spectrum.nayak_parameter() / nayak - 1.0).abs() < 1e-2);
        Ok(())
    }
}
