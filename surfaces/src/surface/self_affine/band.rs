//! Which waves a self-affine surface has, and how their power falls with the wavevector.

use std::f64::consts::TAU;

use crate::surface::SLACK;
use crate::{Error, Grid};

/// The band of wavevectors and the shape of the spectrum in it, in terms of t = q/q_r.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Band {
    /// Hurst exponent H.
    pub(super) hurst: f64,
    /// λ_r \[m\].
    pub(super) rolloff_wavelength: f64,
    /// λ_s \[m\].
    pub(super) short_cutoff_wavelength: f64,
    /// λ_l \[m\].
    pub(super) long_cutoff_wavelength: Option<f64>,
}

impl Band {
    /// q_r \[rad/m\].
    pub(super) fn rolloff(&self) -> f64 {
        TAU / self.rolloff_wavelength
    }

    /// The least t, with its slack.
    fn least(&self) -> f64 {
        self.long_cutoff_wavelength
            .map_or(0.0, |long| self.rolloff_wavelength / long * (1.0 - SLACK))
    }

    /// The greatest t, with its slack.
    fn greatest(&self) -> f64 {
        self.rolloff_wavelength / self.short_cutoff_wavelength * (1.0 + SLACK)
    }

    /// `Ok` if a wave of the shortest wavelength has two nodes in each direction.
    pub(super) fn check_resolved(&self, grid: &Grid) -> Result<(), Error> {
        let wavelength = self.short_cutoff_wavelength;
        let shortest = 2.0 * grid.of_directions((grid.dx(), grid.dy()), f64::max);
        if grid.nodes() > 1 && wavelength * (1.0 + SLACK) < shortest {
            return Err(Error::CutoffBelowGrid { wavelength, shortest });
        }
        Ok(())
    }

    /// C(q)/C(0) at t = q/q_r: 1 below the roll-off, t^(−`exponent`) above, 0 outside the band.
    pub(super) fn shape(&self, t: f64, exponent: f64) -> f64 {
        if !(self.least()..=self.greatest()).contains(&t) {
            0.0
        } else if t <= 1.0 {
            1.0
        } else {
            libm::pow(t, -exponent)
        }
    }

    /// With which power of the wavevector the density falls on a grid: 2(1 + H), and 1 + 2H for profiles.
    pub(super) fn exponent(&self, grid: &Grid) -> f64 {
        let is_profile = grid.length_of_profile().is_some();
        if is_profile { 1.0 + 2.0 * self.hurst } else { 2.0 * (1.0 + self.hurst) }
    }

    /// Greatest wave number that can be in the band along a direction of `nodes` nodes whose
    /// first wave has t = `step`.
    pub(super) fn limit(&self, nodes: usize, step: f64) -> i64 {
        // One more than the quotient, whose rounding may go either way. The cast saturates.
        let in_band = (self.greatest() / step) as i64;
        in_band.saturating_add(1).min(nodes as i64 / 2)
    }
}
