//! What is pressed through the gap, as a command line asks for it.

use asperity::leak::Seal;
use asperity::surface::Axis;
use asperity_cli::outcome::Failure;
use clap::{Args, ValueEnum};

use crate::values::{LENGTH, PRESSURE, VISCOSITY};

/// A fluid, and where it goes.
#[derive(Debug, Clone, Args)]
pub(crate) struct Fluid {
    /// Viscosity of the fluid in Pa s: water 1e-3, air 1.8e-5, oils 1e-2 to 1
    #[arg(long, value_name = "PA_S", allow_negative_numbers = true, value_parser = VISCOSITY.positive())]
    viscosity: f64,

    /// Pressure drop of the fluid from edge to edge
    #[arg(long, value_name = "PA", allow_negative_numbers = true, value_parser = PRESSURE.positive())]
    pub(super) pressure_drop: f64,

    /// The fluid is an ideal gas, which leaves at this absolute pressure: leak rates are volumes there, and its
    /// throughput is told too
    #[arg(long, value_name = "PA", allow_negative_numbers = true, value_parser = PRESSURE.positive())]
    gas_outlet_pressure: Option<f64>,

    /// Gap through which nothing flows any more, and through narrower ones [default: only contact closes]
    #[arg(long, value_name = "METRES", allow_negative_numbers = true, value_parser = LENGTH.positive())]
    least_gap: Option<f64>,

    /// Direction in which the fluid is pressed
    #[arg(long, value_enum)]
    along: Along,
}

/// [`Axis`] on the command line.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Along {
    /// The first index of an array, the columns of an image
    X,
    /// The second index of an array, the rows of an image
    Y,
}

impl From<Along> for Axis {
    fn from(along: Along) -> Self {
        match along {
            Along::X => Self::X,
            Along::Y => Self::Y,
        }
    }
}

impl Fluid {
    pub(crate) fn seal(&self) -> Result<Seal, Failure> {
        let failed = |error| Failure::new("cannot compute a leak", error);
        let mut seal =
            Seal::new(self.viscosity, self.pressure_drop, self.along.into()).map_err(failed)?;
        if let Some(gap) = self.least_gap {
            seal = seal.with_least_gap(gap).map_err(failed)?;
        }
        if let Some(pressure) = self.gas_outlet_pressure {
            seal = seal.with_gas(pressure).map_err(failed)?;
        }
        Ok(seal)
    }
}
