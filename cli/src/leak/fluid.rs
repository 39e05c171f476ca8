//! What is pressed through the gap, as a command line asks for it.

use asperity::leak::Seal;
use asperity::surface::Axis;
use asperity_cli::outcome::Failure;
use clap::builder::ArgPredicate;
use clap::{Arg, ArgMatches, Args, Command, FromArgMatches, ValueEnum};

use crate::values::{LENGTH, PRESSURE, VISCOSITY};

/// A fluid, and where it goes.
#[derive(Debug, Clone, Args)]
pub(crate) struct Fluid {
    /// Viscosity of the fluid in Pa s: water 1e-3, air 1.8e-5, oils 1e-2 to 1
    #[arg(long, value_name = "PA_S", value_parser = VISCOSITY.positive())]
    viscosity: f64,

    /// Pressure drop of the fluid from edge to edge
    #[arg(long, value_name = "PA", value_parser = PRESSURE.positive())]
    pub(super) pressure_drop: f64,

    /// The fluid is an ideal gas, which leaves at this absolute pressure: leak rates are volumes there, and the
    /// throughput is printed
    #[arg(long, value_name = "PA", value_parser = PRESSURE.positive())]
    gas_outlet_pressure: Option<f64>,

    /// Gap at and below which nothing flows [default: only contact closes]
    #[arg(long, value_name = "METRES", value_parser = LENGTH.positive())]
    least_gap: Option<f64>,

    /// Direction in which the fluid is pressed
    #[arg(long, value_enum)]
    along: Along,
}

/// [`Axis`] on the command line.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Along {
    /// From the first column of an image to the last, along the first index of an array
    X,
    /// From the first row of an image to the last, along the second index of an array
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

/// A fluid if there is to be one: its options are needed together.
#[derive(Debug, Clone)]
pub(crate) struct PerhapsFluid(pub(crate) Option<Fluid>);

impl Args for PerhapsFluid {
    fn augment_args(command: Command) -> Command {
        let beside_viscosity = |arg: Arg| arg.required(false).requires("viscosity");
        let needed = ["pressure_drop", "along"];
        let command = Fluid::augment_args(command).mut_arg("viscosity", |arg| {
            arg.required(false).requires_ifs(needed.map(|name| (ArgPredicate::IsPresent, name)))
        });
        let others = needed.into_iter().chain(["gas_outlet_pressure", "least_gap"]);
        others.fold(command, |command, name| command.mut_arg(name, beside_viscosity))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for PerhapsFluid {
    fn from_arg_matches(given: &ArgMatches) -> Result<Self, clap::Error> {
        let is_given = given.contains_id("viscosity");
        Ok(Self(is_given.then(|| Fluid::from_arg_matches(given)).transpose()?))
    }

    fn update_from_arg_matches(&mut self, given: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(given)?;
        Ok(())
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
