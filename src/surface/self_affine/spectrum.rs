//! The power spectrum of a self-affine surface, on the waves of a grid.

use std::f64::consts::TAU;

use super::self_affine::{Amplitude, SelfAffine};
use crate::{Error, Grid};

/// Relative slack of the cut-offs, so that a wave of the grid whose wavelength is the cut-off is
/// inside the band however its wave number was rounded. No two waves of a grid are this close.
const SLACK: f64 = 1e-12;

/// The power spectrum of a [`SelfAffine`] surface on a grid, normalised to the prescribed
/// amplitude; made by [`SelfAffine::spectrum`].
///
/// Wavevectors q = 2π/λ \[rad/m\]. The moments are those of the surface that
/// [`Surface::heights`](crate::Surface::heights) returns on this grid, exact for any seed, because
/// only the phases of the waves are random.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spectrum {
    band: Band,
    /// Mean square height of a wave on the plateau, B² there.
    plateau: f64,
    /// Nominal area of the grid.
    area: f64,
    /// Σ w (q/q_r)^2k C/C(0) over the waves for k = 0, 1, 2.
    sums: [f64; 3],
}

impl Spectrum {
    pub(super) fn new(surface: &SelfAffine, grid: &Grid) -> Result<Self, Error> {
        let band = Band::new(surface);
        band.check_resolved(grid)?;
        let lattice = Lattice::new(grid, surface.rolloff_wavelength());
        let mut sums = [0.0; 3];
        for m in 0..=band.limit(grid.nx(), lattice.step_x) {
            let n_limit = band.limit(grid.ny(), lattice.step_y);
            let mut row = [0.0; 3];
            for n in -n_limit..=n_limit {
                let weight = lattice.multiplicity(m, n);
                let t = lattice.wave_number(m, n);
                let share = band.shape(t);
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
                shortest: surface.short_cutoff_wavelength(),
                longest: surface.long_cutoff_wavelength().unwrap_or(f64::INFINITY),
            });
        }
        let area = grid.nominal_area();
        let plateau = match surface.amplitude() {
            Amplitude::RmsHeight(rms) => rms * rms / sums[0],
            Amplitude::RmsGradient(rms) => {
                let height = rms / band.rolloff;
                height * height / sums[1]
            }
            Amplitude::Prefactor(c0) => {
                c0 * libm::pow(band.rolloff, -2.0 * (1.0 + band.hurst)) * (TAU * TAU / area)
            }
        };
        Ok(Self {
            band,
            plateau: Error::require_positive("mean square height of a wave", plateau)?,
            area,
            sums,
        })
    }

    /// Power spectral density C(q) at the wavevector q \[rad/m\], in m⁴:
    ///
    /// $$ C(q) = C_0 \begin{cases}
    ///     0 & q < q_l \\\\
    ///     q_r^{-2(1+H)} & q_l \le q < q_r \\\\
    ///     q^{-2(1+H)} & q_r \le q \le q_s \\\\
    ///     0 & q > q_s \end{cases} $$
    ///
    /// Eq. (23) of the paper, where the upper limit is misprinted and C₀ is left out. It is the
    /// two-dimensional density: $ S_q^2 = \int C \\, \mathrm{d}^2 q $, on a grid the sum of
    /// $ C \\, (2\pi)^2/A_0 $ over its waves, q = 0 excluded.
    #[must_use]
    pub fn psd(&self, q: f64) -> f64 {
        self.plateau * self.band.shape(q / self.band.rolloff) * (self.area / (TAU * TAU))
    }

    /// The prefactor C₀ \[m^(2 − 2H)\].
    #[must_use]
    pub fn prefactor(&self) -> f64 {
        let plateau = self.plateau * (self.area / (TAU * TAU));
        plateau * libm::pow(self.band.rolloff, 2.0 * (1.0 + self.band.hurst))
    }

    /// Root mean square height S_q \[m\].
    #[must_use]
    pub fn rms_height(&self) -> f64 {
        (self.plateau * self.sums[0]).sqrt()
    }

    /// Root mean square gradient $\sqrt{\langle |\nabla h|^2 \rangle}$, two-dimensional, without
    /// unit.
    #[must_use]
    pub fn rms_gradient(&self) -> f64 {
        (self.plateau * self.sums[1]).sqrt() * self.band.rolloff
    }

    /// Root mean square Laplacian $\sqrt{\langle (\nabla^2 h)^2 \rangle}$ \[1/m\], twice the root
    /// mean square of the mean curvature.
    #[must_use]
    pub fn rms_laplacian(&self) -> f64 {
        (self.plateau * self.sums[2]).sqrt() * self.band.rolloff * self.band.rolloff
    }

    /// Nayak's parameter, the breadth of the spectrum:
    ///
    /// $$ \alpha = \frac{m_0 m_4}{m_2^2} = \frac{3}{2}
    ///     \frac{\langle h^2 \rangle \langle (\nabla^2 h)^2 \rangle}{\langle |\nabla h|^2 \rangle^2} $$
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

    /// Amplitude of a wave on the plateau \[m\].
    pub(super) fn plateau_amplitude(&self) -> f64 {
        self.plateau.sqrt()
    }
}

/// The shape of the spectrum, in wavevectors t = q/q_r.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Band {
    hurst: f64,
    /// q_r \[rad/m\].
    rolloff: f64,
    /// Least and greatest t, with their slack.
    least: f64,
    greatest: f64,
    short_cutoff_wavelength: f64,
}

impl Band {
    fn new(surface: &SelfAffine) -> Self {
        let rolloff = surface.rolloff_wavelength();
        Self {
            hurst: surface.hurst(),
            rolloff: TAU / rolloff,
            least: surface
                .long_cutoff_wavelength()
                .map_or(0.0, |long| rolloff / long * (1.0 - SLACK)),
            greatest: rolloff / surface.short_cutoff_wavelength() * (1.0 + SLACK),
            short_cutoff_wavelength: surface.short_cutoff_wavelength(),
        }
    }

    /// `Ok` if a wave of the shortest wavelength has two nodes in each direction.
    fn check_resolved(&self, grid: &Grid) -> Result<(), Error> {
        let cell = match grid.shape() {
            (1, 1) => return Ok(()),
            (_, 1) => grid.dx(),
            (1, _) => grid.dy(),
            _ => grid.dx().max(grid.dy()),
        };
        if self.short_cutoff_wavelength * (1.0 + SLACK) < 2.0 * cell {
            return Err(Error::CutoffBelowGrid {
                wavelength: self.short_cutoff_wavelength,
                shortest: 2.0 * cell,
            });
        }
        Ok(())
    }

    /// C(q)/C(0) at t = q/q_r: 1 below the roll-off, t^(−2(1+H)) above, 0 outside the band.
    pub(super) fn shape(&self, t: f64) -> f64 {
        if !(self.least..=self.greatest).contains(&t) {
            0.0
        } else if t <= 1.0 {
            1.0
        } else {
            libm::pow(t, -2.0 * (1.0 + self.hurst))
        }
    }

    /// Greatest wave number that can be in the band along a direction of `nodes` nodes whose
    /// first wave has t = `step`.
    pub(super) fn limit(&self, nodes: usize, step: f64) -> i64 {
        // One more than the quotient, whose rounding may go either way. The cast saturates.
        let in_band = (self.greatest / step) as i64;
        in_band.saturating_add(1).min(nodes as i64 / 2)
    }
}

/// The waves of a grid, exp i q·x with q = 2π (m/Lx, n/Ly): |m| ≤ nx/2, |n| ≤ ny/2.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lattice {
    nx: i64,
    ny: i64,
    /// q/q_r of the waves (1, 0) and (0, 1).
    pub(super) step_x: f64,
    pub(super) step_y: f64,
}

impl Lattice {
    pub(super) fn new(grid: &Grid, rolloff_wavelength: f64) -> Self {
        let (lx, ly) = grid.sides();
        Self {
            nx: grid.nx() as i64,
            ny: grid.ny() as i64,
            step_x: rolloff_wavelength / lx,
            step_y: rolloff_wavelength / ly,
        }
    }

    /// q/q_r of the wave (m, n).
    pub(super) fn wave_number(&self, m: i64, n: i64) -> f64 {
        let (x, y) = (m as f64 * self.step_x, n as f64 * self.step_y);
        (x * x + y * y).sqrt()
    }

    /// Number of waves the wave (m, n), m ≥ 0, stands for: 2 with its conjugate (−m, −n), 1 if
    /// that is the same wave on this grid, 0 if the wave is the conjugate of another with m ≥ 0,
    /// does not exist on this grid, or is q = 0.
    pub(super) fn multiplicity(&self, m: i64, n: i64) -> f64 {
        let own_m = m == 0 || 2 * m == self.nx;
        let own_n = n == 0 || 2 * n == self.ny;
        if (m, n) == (0, 0) || 2 * m > self.nx || 2 * n > self.ny || 2 * n <= -self.ny {
            0.0
        } else if !own_m {
            2.0
        } else if own_n {
            1.0
        } else if n > 0 {
            2.0
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multiplicities_count_every_wave_once() -> Result<(), Error> {
        for nx in 1..9_usize {
            for ny in 1..9_usize {
                let lattice = Lattice::new(&Grid::new(nx, ny, 1.0, 1.0)?, 1.0);
                let mut total = 0.0;
                for m in 0..=nx as i64 {
                    for n in -(ny as i64)..=ny as i64 {
                        total += lattice.multiplicity(m, n);
                    }
                }
                assert_eq!(total, (nx * ny - 1) as f64, "{nx} x {ny}");
            }
        }
        Ok(())
    }

    #[test]
    fn density_is_that_of_eq_23() -> Result<(), Error> {
        let surface = SelfAffine::new(0.7, 2e-3, 1e-4, Amplitude::Prefactor(3e-5), 1)?
            .with_long_cutoff_wavelength(5e-3)?;
        let spectrum = surface.spectrum(&Grid::with_sides(300, 240, 1e-2, 8e-3)?)?;
        let (ql, qr, qs) = (TAU / 5e-3, TAU / 2e-3, TAU / 1e-4);
        // Powers with a handful of roundings, exponent 3.4.
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
