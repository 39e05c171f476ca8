//! The waves that are periodic on a grid.

use crate::Grid;

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
    use crate::Error;

    #[test]
    fn multiplicities_count_every_wave_once() -> Result<(), Error> {
        for nx in 1..9_usize {
            for ny in 1..9_usize {
                let lattice = Lattice::new(&Grid::new(nx, ny, 1.0, 1.0)?, 1.0);
                let (m, n) = (nx as i64, ny as i64);
                let waves = (0..=m).flat_map(|m| (-n..=n).map(move |n| (m, n)));
                let total: f64 = waves.map(|(m, n)| lattice.multiplicity(m, n)).sum();
                assert_eq!(total, (nx * ny - 1) as f64, "{nx} x {ny}");
            }
        }
        Ok(())
    }
}
