//! A body on the command line.

use std::fmt;
use std::str::FromStr;

use asperity::material::Material as Known;
use asperity_cli::number::quantity;

use crate::values::{PRESSURE, number};

/// A body, with its name if it was given by name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Material {
    pub(crate) name: Option<&'static str>,
    /// Young's modulus \[Pa\].
    pub(crate) e: f64,
    /// Poisson's ratio.
    pub(crate) nu: f64,
    /// Typical hardness \[Pa\], as a mean pressure under an indenter.
    pub(crate) hardness: Option<f64>,
}

impl Material {
    pub(crate) const STEEL: Self = Self::named(&Known::STEEL);

    /// Young's modulus \[Pa\] and Poisson's ratio.
    pub(crate) fn elastic(&self) -> (f64, f64) {
        (self.e, self.nu)
    }

    const fn named(known: &Known) -> Self {
        Self {
            name: Some(known.name),
            e: known.youngs_modulus,
            nu: known.poissons_ratio,
            hardness: known.hardness,
        }
    }
}

/// `steel (210 GPa, 0.30)`.
impl fmt::Display for Material {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let e = quantity(self.e, "Pa", 4);
        match self.name {
            Some(name) => write!(f, "{name} ({e}, {:.2})", self.nu),
            None => write!(f, "E = {e}, ν = {:.2}", self.nu),
        }
    }
}

impl FromStr for Material {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Some(known) = Known::named(text) {
            return Ok(Self::named(known));
        }
        if text.eq_ignore_ascii_case("rigid") {
            return Err("a rigid body has no modulus: without --against the other body is rigid"
                .to_string());
        }
        let Some((e, nu)) = text.split_once(',') else {
            let names: Vec<&str> = Known::ALL.iter().map(|known| known.name).collect();
            return Err(format!("neither 'E,NU' nor one of {}", names.join(", ")));
        };
        let e = PRESSURE.positive()(e).map_err(|error| format!("Young's modulus: {error}"))?;
        let nu = number(nu).map_err(|error| format!("Poisson's ratio: {error}"))?;
        Ok(Self { name: None, e, nu, hardness: None })
    }
}
