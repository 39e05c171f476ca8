//! The half-space that the command line asks for.

use asperity::{
    Boundary, Boussinesq, ContactGrowth, Error, Grid, InfluenceKernel, PeriodicBoussinesq, Spectral,
};
use clap::ValueEnum;

/// The kernel of a periodic half-space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Periodic {
    /// Uniform pressure on each cell and on all its images
    Love,
    /// 2 / (E* |q|) for the waves of the grid, as in spectral codes
    Spectral,
}

impl Periodic {
    /// Its name for people.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Love => "Love",
            Self::Spectral => "spectral",
        }
    }
}

/// A free or a periodic half-space.
pub(crate) enum HalfSpace {
    Free(Boussinesq),
    Love(PeriodicBoussinesq),
    Spectral(Spectral),
}

impl HalfSpace {
    /// A half-space of composite modulus `e_star`: free unless it is to be periodic.
    pub(crate) fn new(periodic: Option<Periodic>, grid: Grid, e_star: f64) -> Result<Self, Error> {
        Ok(match periodic {
            None => Self::Free(Boussinesq::new(grid, e_star)?),
            Some(Periodic::Love) => Self::Love(PeriodicBoussinesq::new(grid, e_star)?),
            Some(Periodic::Spectral) => Self::Spectral(Spectral::new(grid, e_star)?),
        })
    }

    fn kernel(&self) -> &dyn InfluenceKernel {
        match self {
            Self::Free(kernel) => kernel,
            Self::Love(kernel) => kernel,
            Self::Spectral(kernel) => kernel,
        }
    }
}

impl InfluenceKernel for HalfSpace {
    fn grid(&self) -> Grid {
        self.kernel().grid()
    }

    fn boundary(&self) -> Boundary {
        self.kernel().boundary()
    }

    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        self.kernel().coefficient(di, dj)
    }

    fn contact_growth(&self) -> ContactGrowth {
        self.kernel().contact_growth()
    }
}
