//! The parameters of a kernel.

use super::{Boundary, LayeredBody};

/// The parameters of a kernel besides its grid: enough to make one of this crate again, in another process.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum KernelOrigin {
    /// [`Boussinesq`](super::Boussinesq).
    Boussinesq {
        /// Composite modulus \[Pa\].
        e_star: f64,
    },
    /// [`PeriodicBoussinesq`](super::PeriodicBoussinesq).
    PeriodicBoussinesq {
        /// Composite modulus \[Pa\].
        e_star: f64,
    },
    /// [`SemiPeriodicBoussinesq`](super::SemiPeriodicBoussinesq).
    SemiPeriodicBoussinesq {
        /// Composite modulus \[Pa\].
        e_star: f64,
        /// The direction in which it repeats: [`Boundary::PeriodicX`] or [`Boundary::PeriodicY`].
        boundary: Boundary,
    },
    /// [`Spectral`](super::Spectral).
    Spectral {
        /// Composite modulus \[Pa\].
        e_star: f64,
    },
    /// [`Layered::free`](super::Layered::free).
    Layered {
        /// The body.
        body: LayeredBody,
    },
    /// [`Layered::periodic`](super::Layered::periodic).
    PeriodicLayered {
        /// The body.
        body: LayeredBody,
    },
    /// [`Layered::spectral`](super::Layered::spectral).
    SpectralLayered {
        /// The body.
        body: LayeredBody,
    },
    /// A kernel that is not of this crate, or a table of coefficients.
    Other,
}

impl KernelOrigin {
    /// The surroundings of the grid that the kernel has: `None` of one that is not of this crate.
    #[must_use]
    pub fn boundary(&self) -> Option<Boundary> {
        match *self {
            Self::Boussinesq { .. } | Self::Layered { .. } => Some(Boundary::Free),
            Self::PeriodicBoussinesq { .. }
            | Self::Spectral { .. }
            | Self::PeriodicLayered { .. }
            | Self::SpectralLayered { .. } => Some(Boundary::Periodic),
            Self::SemiPeriodicBoussinesq { boundary, .. } => Some(boundary),
            Self::Other => None,
        }
    }

    /// E\* \[Pa\]: `None` of layers, which have none, and of kernels that are not of this crate.
    #[must_use]
    pub fn composite_modulus(&self) -> Option<f64> {
        match *self {
            Self::Boussinesq { e_star }
            | Self::PeriodicBoussinesq { e_star }
            | Self::SemiPeriodicBoussinesq { e_star, .. }
            | Self::Spectral { e_star } => Some(e_star),
            Self::Layered { .. }
            | Self::PeriodicLayered { .. }
            | Self::SpectralLayered { .. }
            | Self::Other => None,
        }
    }
}
