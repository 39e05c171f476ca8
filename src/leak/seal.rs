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
    least_gap: f64,
    outlet_pressure: Option<f64>,
}

impl Seal {
    /// A fluid of the viscosity η \[Pa s\] under the pressure drop Δp \[Pa\] from the lower end of an axis to the upper
    /// one.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for either.
    pub fn new(viscosity: f64, pressure_drop: f64, along: Axis) -> Result<Self, Error> {
        Ok(Self {
            viscosity: Error::require_positive("viscosity", viscosity)?,
            pressure_drop: Error::require_positive("pressure drop", pressure_drop)?,
            along,
            least_gap: 0.0,
            outlet_pressure: None,
        })
    }

    /// The same where nothing flows through gaps of this height \[m\] and less, as through those of a few molecules.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for one that is negative or not finite.
    pub fn with_least_gap(self, least_gap: f64) -> Result<Self, Error> {
        let is_one = least_gap >= 0.0 && least_gap.is_finite();
        Error::require("least gap", least_gap, is_one, "finite, and not negative")?;
        Ok(Self { least_gap, ..self })
    }

    /// The same with an ideal gas of one temperature, which leaves at this absolute pressure \[Pa\].
    ///
    /// Its density is in proportion to its pressure, so that `∇·(g³ p ∇p) = 0`, which is the equation of a liquid for
    /// p². Leak rates and fluxes are volumes at the pressure of the outlet, $`1 + \Delta p / 2 p_2`$ times those of a
    /// liquid; times that pressure they are the throughput \[Pa m³/s\], of which 1 is 10 mbar l/s. Gases slip where
    /// gaps are not far above their mean free path (air of 1 bar: 0.07 µm), and leak more.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`].
    pub fn with_gas(self, outlet_pressure: f64) -> Result<Self, Error> {
        let pressure = Error::require_positive("pressure at the outlet", outlet_pressure)?;
        Ok(Self { outlet_pressure: Some(pressure), ..self })
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

    /// The height \[m\] of gaps through which nothing flows any more.
    #[must_use]
    pub fn least_gap(&self) -> f64 {
        self.least_gap
    }

    /// Absolute pressure \[Pa\] at which a gas leaves; `None` for a liquid.
    #[must_use]
    pub fn outlet_pressure(&self) -> Option<f64> {
        self.outlet_pressure
    }

    /// What drives a liquid of the same leak rate \[Pa\]: of a gas $`(p_1^2 - p_2^2) / 2 p_2`$.
    pub(super) fn drive(&self) -> f64 {
        match self.outlet_pressure {
            None => self.pressure_drop,
            Some(outlet) => self.pressure_drop * (1.0 + 0.5 * self.pressure_drop / outlet),
        }
    }

    /// Pressure above that of the outlet \[Pa\] where a liquid has this share of its drop.
    pub(super) fn pressure(&self, share: f64) -> f64 {
        match self.outlet_pressure {
            None => share * self.pressure_drop,
            Some(outlet) => {
                let excess = 2.0 * share * self.drive();
                // √(p₂² + p₂ x) − p₂, without the difference.
                excess * outlet / ((outlet * (outlet + excess)).sqrt() + outlet)
            }
        }
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
