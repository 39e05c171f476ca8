//! What fixes the amplitude of a self-affine surface.

use crate::Error;

/// What fixes the amplitude of a [`SelfAffine`](super::SelfAffine) surface.
///
/// Whichever is given is met exactly on every grid and by every seed, not only on average.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Amplitude {
    /// Root mean square height S_q \[m\].
    RmsHeight(f64),
    /// Root mean square gradient $`\sqrt{\langle |\nabla h|^2 \rangle}`$, two-dimensional, without
    /// unit: the gradient of the sum of waves, not of differences between nodes.
    RmsGradient(f64),
    /// The prefactor C₀ of the power spectrum \[m^(2 − 2H)\].
    Prefactor(f64),
}

impl Amplitude {
    /// The same amplitude, if it is positive and finite.
    pub(super) fn checked(self) -> Result<Self, Error> {
        match self {
            Self::RmsHeight(value) => Error::require_positive("rms height", value),
            Self::RmsGradient(value) => Error::require_positive("rms gradient", value),
            Self::Prefactor(value) => Error::require_positive("prefactor of the spectrum", value),
        }?;
        Ok(self)
    }
}
