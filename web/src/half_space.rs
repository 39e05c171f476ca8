//! The half-space that the page asks for.

use asperity::surface::Axis;
use asperity::{
    Boundary, Boussinesq, Error, Grid, InfluenceKernel, PeriodicBoussinesq, SemiPeriodicBoussinesq,
    Spectral,
};
use serde::Deserialize;

/// What surrounds the nominal area.
#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum HalfSpace {
    /// Nothing presses on it.
    #[default]
    Free,
    /// Images along x and y; uniform pressure on each cell.
    Love,
    /// Images along x and y; 2 / (E* |q|) for the waves of the grid.
    Spectral,
    /// Images along x.
    X,
    /// Images along y.
    Y,
}

impl HalfSpace {
    pub(crate) fn boundary(self) -> Boundary {
        match self {
            Self::Free => Boundary::Free,
            Self::Love | Self::Spectral => Boundary::Periodic,
            Self::X => Boundary::PeriodicX,
            Self::Y => Boundary::PeriodicY,
        }
    }

    pub(crate) fn kernel(self, grid: Grid, e_star: f64) -> Result<Box<dyn InfluenceKernel>, Error> {
        Ok(match self {
            Self::Free => Box::new(Boussinesq::new(grid, e_star)?),
            Self::Love => Box::new(PeriodicBoussinesq::new(grid, e_star)?),
            Self::Spectral => Box::new(Spectral::new(grid, e_star)?),
            Self::X => Box::new(SemiPeriodicBoussinesq::new(grid, e_star, Axis::X)?),
            Self::Y => Box::new(SemiPeriodicBoussinesq::new(grid, e_star, Axis::Y)?),
        })
    }
}
