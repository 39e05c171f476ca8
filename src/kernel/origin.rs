//! What a kernel was made from.

use super::{Boussinesq, InfluenceKernel, PeriodicBoussinesq, Spectral};
use crate::{Error, Grid};

/// What a kernel was made from, besides its grid: enough to make one of this crate again, in another process.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum KernelOrigin {
    /// [`Boussinesq`].
    Boussinesq {
        /// Composite modulus \[Pa\].
        e_star: f64,
    },
    /// [`PeriodicBoussinesq`].
    PeriodicBoussinesq {
        /// Composite modulus \[Pa\].
        e_star: f64,
    },
    /// [`Spectral`].
    Spectral {
        /// Composite modulus \[Pa\].
        e_star: f64,
    },
    /// A kernel that is not of this crate, or a table of coefficients.
    Other,
}

impl KernelOrigin {
    /// The kernel on a grid, `None` if it is not of this crate.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for the modulus.
    pub fn kernel(self, grid: Grid) -> Result<Option<Box<dyn InfluenceKernel>>, Error> {
        Ok(match self {
            Self::Boussinesq { e_star } => Some(Box::new(Boussinesq::new(grid, e_star)?)),
            Self::PeriodicBoussinesq { e_star } => {
                Some(Box::new(PeriodicBoussinesq::new(grid, e_star)?))
            }
            Self::Spectral { e_star } => Some(Box::new(Spectral::new(grid, e_star)?)),
            Self::Other => None,
        })
    }
}
