//! The half-space that the command line asks for.

use asperity::kernel::{Layered, LayeredBody};
use asperity::{Boundary, Boussinesq, Error, Grid, InfluenceKernel, PeriodicBoussinesq, Spectral};
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

/// What surrounds the nominal area.
pub fn boundary(periodic: Option<Periodic>) -> Boundary {
    match periodic {
        None => Boundary::Free,
        Some(_) => Boundary::Periodic,
    }
}

/// A half-space of composite modulus `e_star`: free unless it is to be periodic.
pub fn half_space(
    periodic: Option<Periodic>,
    grid: Grid,
    e_star: f64,
) -> Result<Box<dyn InfluenceKernel>, Error> {
    Ok(match periodic {
        None => Box::new(Boussinesq::new(grid, e_star)?),
        Some(Periodic::Love) => Box::new(PeriodicBoussinesq::new(grid, e_star)?),
        Some(Periodic::Spectral) => Box::new(Spectral::new(grid, e_star)?),
    })
}

/// A body with layers, likewise.
pub fn layered(
    periodic: Option<Periodic>,
    grid: Grid,
    body: &LayeredBody,
) -> Result<Box<dyn InfluenceKernel>, Error> {
    let body = body.clone();
    Ok(Box::new(match periodic {
        None => Layered::free(grid, body)?,
        Some(Periodic::Love) => Layered::periodic(grid, body)?,
        Some(Periodic::Spectral) => Layered::spectral(grid, body)?,
    }))
}
