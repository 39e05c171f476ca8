//! Conduction through a contact, as a command line asks for it.

use asperity::contact::ContactState;
use asperity::joint::{Carrier, Conduction};
use asperity::kernel::Layering;
use asperity_cli::note;
use asperity_cli::outcome::Failure;
use clap::Args;

use crate::values::{CONDUCTIVITY, LENGTH, RESISTIVITY};

/// What the bodies and the gap conduct.
#[derive(Debug, Clone, Args)]
pub(crate) struct Conduct {
    /// Add the electrical conductance of the contact to tables and files: resistivities of both bodies, or of one if
    /// the other conducts perfectly
    #[arg(long, value_name = "OHM_M", value_delimiter = ',', value_parser = RESISTIVITY.positive(), help_heading = "Joint")]
    resistivity: Vec<f64>,

    /// Add the thermal conductance of the contact to tables and files: thermal conductivities of both bodies in W/(m
    /// K), or of one if the other conducts perfectly
    #[arg(long, value_name = "W_M_K", value_delimiter = ',', value_parser = CONDUCTIVITY.positive(), help_heading = "Joint")]
    conductivity: Vec<f64>,

    /// Thermal conductivity in W/(m K) of what fills the gap, in parallel to the contact: air 0.026
    #[arg(long, value_name = "W_M_K", value_parser = CONDUCTIVITY.positive(), requires = "conductivity", help_heading = "Joint")]
    gap_conductivity: Option<f64>,

    /// Temperature jump distance of a gas in the gap, the sum of both surfaces: air about 3.7e-7 [default: 0]
    #[arg(long, value_name = "METRES", value_parser = LENGTH.positive(), requires = "gap_conductivity", help_heading = "Joint")]
    jump_distance: Option<f64>,
}

/// A conductance with the name of its column.
pub(crate) type Named = (&'static str, Conduction);

impl Conduct {
    /// What is given, by option.
    fn given(&self) -> [(&'static str, &[f64]); 2] {
        [("--resistivity", &self.resistivity), ("--conductivity", &self.conductivity)]
    }

    /// Says what a single value means: half of the resistance of two equal bodies.
    pub(crate) fn tell(&self) {
        for (option, _) in self.given().iter().filter(|(_, values)| values.len() == 1) {
            note!("note: {option} has the value of one body; the other conducts perfectly");
        }
    }

    /// What is to be conducted between bodies of a composite modulus.
    pub(crate) fn conductions(&self, e_star: f64) -> Result<Vec<Named>, Failure> {
        let failed = |error| Failure::new("cannot compute a conductance", error);
        let mut all = Vec::new();
        for (option, values) in self.given() {
            if values.len() > 2 {
                return Err(Failure::request(format!(
                    "{option} takes the values of one body or of two"
                )));
            }
        }
        if !self.resistivity.is_empty() {
            let sum = self.resistivity.iter().sum();
            let current = Conduction::electrical(e_star, sum).map_err(failed)?;
            all.push((current.carrier().column(), current));
        }
        if !self.conductivity.is_empty() {
            let sum = self.conductivity.iter().map(|conductivity| 1.0 / conductivity).sum();
            let mut heat = Conduction::thermal(e_star, sum).map_err(failed)?;
            if let Some(gap) = self.gap_conductivity {
                heat = heat.with_gap(gap, self.jump_distance.unwrap_or(0.0)).map_err(failed)?;
            }
            all.push((heat.carrier().column(), heat));
        }
        Ok(all)
    }
}

/// The conductances of a contact, NaN where there is none: in full contact without an end, and between two events at
/// which nodes have yielded.
pub(crate) fn conductances(
    conductions: &[Named],
    contact: &ContactState,
    body: Layering,
) -> Vec<(Carrier, f64)> {
    let of = |(_, conduction): &Named| {
        let found = conduction.of(contact, body).ok().flatten();
        (conduction.carrier(), found.unwrap_or(f64::NAN))
    };
    conductions.iter().map(of).collect()
}
