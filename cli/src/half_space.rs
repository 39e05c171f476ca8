//! The half-space that the command line asks for.

use asperity::{
    Boundary, Boussinesq, ContactGrowth, Error, Grid, InfluenceKernel, PeriodicBoussinesq, Spectral,
};
use clap::ValueEnum;

/// The kernel of a periodic half-space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Periodic {
    /// Uniform pressure on each cell and on all its images
    Love,
    /// 2 / (E* |q|) for the waves of the grid, as in spectral codes
    Spectral,
}

impl Periodic {
    /// Its name for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Love => "Love",
            Self::Spectral => "spectral",
        }
    }
}

/// A free or a periodic half-space.
pub struct HalfSpace(Box<dyn InfluenceKernel>);

impl HalfSpace {
    /// A half-space of composite modulus `e_star`: free unless it is to be periodic.
    pub fn new(periodic: Option<Periodic>, grid: Grid, e_star: f64) -> Result<Self, Error> {
        Ok(Self(match periodic {
            None => Box::new(Boussinesq::new(grid, e_star)?),
            Some(Periodic::Love) => Box::new(PeriodicBoussinesq::new(grid, e_star)?),
            Some(Periodic::Spectral) => Box::new(Spectral::new(grid, e_star)?),
        }))
    }
}

impl InfluenceKernel for HalfSpace {
    fn grid(&self) -> Grid {
        self.0.grid()
    }

    fn boundary(&self) -> Boundary {
        self.0.boundary()
    }

    fn coefficient(&self, di: isize, dj: isize) -> f64 {
        self.0.coefficient(di, dj)
    }

    fn contact_growth(&self) -> ContactGrowth {
        self.0.contact_growth()
    }
}
