//! The hardness that a command line asks for.

use std::fmt;

use asperity_cli::number::quantity;
use asperity_cli::outcome::Failure;
use clap::Args;

use crate::elasticity::Bodies;
use crate::values;

/// How much pressure the bodies bear.
#[derive(Debug, Clone, Args)]
pub(crate) struct Hardness {
    /// Greatest pressure: cells yield there, and the surface stays deformed. A pressure, or a number of Brinell,
    /// Vickers or (of steel, 20 to 68) Rockwell: 2.5GPa, 250HB, 250HV, 60HRC [default: nothing yields]
    #[arg(long, value_name = "PA|HB|HV|HRC", value_parser = values::hardness)]
    hardness: Option<f64>,

    /// Cells yield at a typical hardness of the --material, of the softer one of two: --hardness without a number
    #[arg(long = "yield", conflicts_with = "hardness", help_heading = "Bodies")]
    typical: bool,
}

/// A hardness and where it comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct GreatestPressure {
    pub(crate) pascals: f64,
    pub(crate) source: &'static str,
}

impl fmt::Display for GreatestPressure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", quantity(self.pascals, "Pa", 4), self.source)
    }
}

impl Hardness {
    /// The hardness of bodies, if there is to be one.
    pub(crate) fn of(&self, bodies: &Bodies) -> Result<Option<GreatestPressure>, Failure> {
        if let Some(pascals) = self.hardness {
            return Ok(Some(GreatestPressure { pascals, source: "" }));
        }
        if !self.typical {
            return Ok(None);
        }
        match bodies.hardness {
            Some(pascals) => {
                let source = ", typical of the material (--hardness for another)";
                Ok(Some(GreatestPressure { pascals, source }))
            }
            None => Err(Failure::request(
                "no typical hardness is known of these bodies: give --hardness, or a --material by its name",
            )),
        }
    }
}
