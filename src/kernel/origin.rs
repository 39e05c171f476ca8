//! The parameters of a kernel.

/// The parameters of a kernel besides its grid: enough to make one of this crate again, in another process.
#[derive(Debug, Clone, Copy, PartialEq)]
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
    /// [`Spectral`](super::Spectral).
    Spectral {
        /// Composite modulus \[Pa\].
        e_star: f64,
    },
    /// A kernel that is not of this crate, or a table of coefficients.
    Other,
}
