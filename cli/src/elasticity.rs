//! The composite modulus that a command line asks for.

use std::str::FromStr;

use asperity::{composite_modulus, plane_strain_modulus};
use asperity_cli::outcome::Failure;
use clap::Args;

use crate::values::positive;

/// How stiff the two bodies are.
#[derive(Debug, Clone, Args)]
pub(crate) struct Elasticity {
    /// Composite modulus E*: 1/E* = (1 - ν₁²)/E₁ + (1 - ν₂²)/E₂
    #[arg(long, value_name = "PA", allow_negative_numbers = true, value_parser = positive)]
    e_star: Option<f64>,

    /// In place of E*, one body: a name (steel, aluminium, copper, brass, titanium, glass, pmma, ptfe, rubber, ...: typical
    /// values), or Young's modulus in Pa and Poisson's ratio: 210e9,0.3
    #[arg(long, value_name = "NAME|E,NU", conflicts_with = "e_star")]
    material: Option<Material>,

    /// The other body [default: rigid]
    #[arg(long, value_name = "NAME|E,NU", requires = "material")]
    against: Option<Material>,
}

impl Elasticity {
    /// E*, `None` if nothing was said of it.
    pub(crate) fn e_star(&self) -> Result<Option<f64>, Failure> {
        let Some(Material(first)) = self.material else {
            return Ok(self.e_star);
        };
        match self.against {
            Some(Material(second)) => composite_modulus(first, second),
            None => plane_strain_modulus(first.0, first.1),
        }
        .map(Some)
        .map_err(|error| Failure::new("no such material", error))
    }

    /// Young's modulus \[Pa\] and Poisson's ratio of each body that was given.
    pub(crate) fn bodies(&self) -> Vec<[f64; 2]> {
        let given = [self.material, self.against].into_iter().flatten();
        given.map(|Material((e, nu))| [e, nu]).collect()
    }

    /// E*, without which no measured surface can be pressed.
    pub(crate) fn required(&self) -> Result<f64, Failure> {
        self.e_star()?.ok_or_else(|| {
            Failure::request("how stiff are the bodies? Give --e-star or --material")
        })
    }
}

/// Young's modulus \[Pa\] and Poisson's ratio.
#[derive(Debug, Clone, Copy)]
struct Material((f64, f64));

/// Typical values at room temperature. Those of an alloy or a polymer vary: for results that matter they are given
/// as numbers.
const MATERIALS: [(&str, f64, f64); 18] = [
    ("steel", 210e9, 0.3),
    ("stainless-steel", 195e9, 0.29),
    ("cast-iron", 110e9, 0.26),
    ("aluminium", 70e9, 0.33),
    ("copper", 125e9, 0.34),
    ("brass", 105e9, 0.34),
    ("bronze", 110e9, 0.34),
    ("titanium", 115e9, 0.33),
    ("tungsten-carbide", 620e9, 0.22),
    ("gold", 78e9, 0.42),
    ("silver", 83e9, 0.37),
    ("alumina", 370e9, 0.22),
    ("glass", 70e9, 0.22),
    ("fused-silica", 72e9, 0.17),
    ("pmma", 3e9, 0.37),
    ("polycarbonate", 2.4e9, 0.37),
    ("ptfe", 0.5e9, 0.46),
    ("rubber", 2e6, 0.5),
];

impl FromStr for Material {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Some((_, e, nu)) = MATERIALS.iter().find(|(name, ..)| *name == text) {
            return Ok(Self((*e, *nu)));
        }
        let number = |text: &str| text.trim().parse::<f64>().ok();
        match text.split_once(',').map(|(e, nu)| (number(e), number(nu))) {
            Some((Some(e), Some(nu))) => Ok(Self((e, nu))),
            _ => {
                let names: Vec<&str> = MATERIALS.iter().map(|(name, ..)| *name).collect();
                Err(format!("neither 'E,NU' nor one of {}", names.join(", ")))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn modulus(material: &str, against: Option<&str>) -> Result<Option<f64>, String> {
        let elasticity = Elasticity {
            e_star: None,
            material: Some(material.parse()?),
            against: against.map(str::parse).transpose()?,
        };
        elasticity.e_star().map_err(|_| "refused".to_string())
    }

    #[test]
    fn bodies_are_named_or_given_in_numbers() {
        assert_eq!(modulus("steel", None), modulus("210e9,0.3", None));
        assert_eq!(modulus("steel", None), Ok(Some(210e9 / (1.0 - 0.3 * 0.3))));
        assert_eq!(
            modulus("glass", Some("pmma")),
            modulus("3e9, 0.37", Some("70e9, 0.22"))
        );
    }

    #[test]
    fn what_is_no_material_is_refused() {
        for text in [
            "",
            "stone",
            "210e9",
            "210e9;0.3",
            "a,b",
            "210e9,0.7",
            "-1,0.3",
        ] {
            assert!(modulus(text, None).is_err(), "{text}");
        }
    }

    #[test]
    fn every_named_material_exists() {
        for (name, ..) in MATERIALS {
            assert!(
                matches!(modulus(name, Some("steel")), Ok(Some(_))),
                "{name}"
            );
        }
    }
}
