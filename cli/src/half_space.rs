//! The half-space that the command line asks for.

use asperity::kernel::{Layered, LayeredBody, SemiPeriodicBoussinesq};
use asperity::surface::Axis;
use asperity::{Boundary, Boussinesq, Error, Grid, InfluenceKernel, PeriodicBoussinesq, Spectral};
use clap::ValueEnum;

/// The kernel of a half-space that is periodic, in both directions or in one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Periodic {
    /// Uniform pressure on each cell and on all its images
    Love,
    /// 2 / (E* |q|) for the waves of the grid, as in spectral codes
    Spectral,
    /// Uniform pressure on each cell and on its images along x; free along y
    X,
    /// Uniform pressure on each cell and on its images along y; free along x
    Y,
}

impl Periodic {
    /// Its name for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Love => "Love",
            Self::Spectral => "spectral",
            Self::X => "Love along x",
            Self::Y => "Love along y",
        }
    }

    /// What repeats, for people.
    pub fn in_words(self) -> &'static str {
        match self {
            Self::Love => "periodic, Love kernel",
            Self::Spectral => "periodic, spectral kernel",
            Self::X => "periodic along x and free along y, Love kernel",
            Self::Y => "periodic along y and free along x, Love kernel",
        }
    }
}

/// Whether the approach is that of the mean planes: where surface and half-space repeat in both directions, and states
/// have no contact stiffness. Layers on a rigid base have one, and an approach of their own.
pub fn is_of_mean_planes(periodic: Option<Periodic>, has_stiffness: bool) -> bool {
    !has_stiffness && boundary(periodic) == Boundary::Periodic
}

/// What surrounds the nominal area.
pub fn boundary(periodic: Option<Periodic>) -> Boundary {
    match periodic {
        None => Boundary::Free,
        Some(Periodic::Love | Periodic::Spectral) => Boundary::Periodic,
        Some(Periodic::X) => Boundary::PeriodicX,
        Some(Periodic::Y) => Boundary::PeriodicY,
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
        Some(Periodic::X) => Box::new(SemiPeriodicBoussinesq::new(grid, e_star, Axis::X)?),
        Some(Periodic::Y) => Box::new(SemiPeriodicBoussinesq::new(grid, e_star, Axis::Y)?),
    })
}

/// A body with layers, likewise.
pub fn layered(
    periodic: Option<Periodic>,
    grid: Grid,
    body: &LayeredBody,
) -> Result<Box<dyn InfluenceKernel>, Error> {
    let body = body.clone();
    let both = Error::OutOfRange {
        quantity: "number of directions in which layers repeat",
        value: 1.0,
        expected: "both (--periodic love or spectral) or none",
    };
    Ok(Box::new(match periodic {
        Some(Periodic::X | Periodic::Y) => return Err(both),
        None => Layered::free(grid, body)?,
        Some(Periodic::Love) => Layered::periodic(grid, body)?,
        Some(Periodic::Spectral) => Layered::spectral(grid, body)?,
    }))
}
