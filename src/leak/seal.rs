//! The fluid, and the direction in which it is pressed through.

use crate::Error;
use crate::surface::Axis;

/// A fluid before one edge of the grid, pressed through the gap to the opposite one.
///
/// See the [module](super) for the equation, and for an example.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seal {
    viscosity: f64,
    pressure_drop: f64,
    along: Axis,
}

impl Seal {
    /// A fluid of the viscosity η \[Pa s\] under the pressure drop Δp \[Pa\] from the lower end of an axis to the upper one.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for either.
    pub fn new(viscosity: f64, pressure_drop: f64, along: Axis) -> Result<Self, Error> {
        Ok(Self {
            viscosity: Error::require_positive("viscosity", viscosity)?,
            pressure_drop: Error::require_positive("pressure drop", pressure_drop)?,
            along,
        })
    }

    /// Viscosity \[Pa s\].
    #[must_use]
    pub fn viscosity(&self) -> f64 {
        self.viscosity
    }

    /// Pressure drop \[Pa\].
    #[must_use]
    pub fn pressure_drop(&self) -> f64 {
        self.pressure_drop
    }

    /// Where the fluid is pressed along.
    #[must_use]
    pub fn along(&self) -> Axis {
        self.along
    }

    /// The conductivity g³/12η \[m³/(Pa s)\] of a gap.
    pub(super) fn conductivity(&self, gap: f64) -> Result<f64, Error> {
        // Two factors of the cube beside the viscosity: the cube alone may be too small.
        Error::require_positive(
            "conductivity of the greatest gap",
            gap * gap / 12.0 / self.viscosity * gap,
        )
    }
}
