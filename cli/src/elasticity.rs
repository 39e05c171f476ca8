//! The composite modulus that a command line asks for.

use std::fmt;
use std::str::FromStr;

use asperity::{composite_modulus, plane_strain_modulus};
use asperity_cli::number::quantity;
use asperity_cli::outcome::Failure;
use clap::Args;

use crate::values::positive;

/// How stiff the two bodies are.
#[derive(Debug, Clone, Args)]
pub(crate) struct Elasticity {
    /// Composite modulus E*: 1/E* = (1 - ν₁²)/E₁ + (1 - ν₂²)/E₂
    #[arg(long, value_name = "PA", allow_negative_numbers = true, value_parser = positive)]
    e_star: Option<f64>,

    /// One body, in place of E*: a name (steel, aluminium, copper, brass, titanium, glass, pmma, ptfe, rubber, ...: typical
    /// values), or Young's modulus in Pa and Poisson's ratio: 210e9,0.3 [generated surface: steel]
    #[arg(long, value_name = "NAME|E,NU", conflicts_with = "e_star")]
    material: Option<Material>,

    /// The other body [default: rigid]
    #[arg(long, value_name = "NAME|E,NU", requires = "material")]
    against: Option<Material>,
}

/// The two bodies in words, and their composite modulus.
#[derive(Debug, Clone)]
pub(crate) struct Bodies {
    pub(crate) e_star: f64,
    /// Young's modulus \[Pa\] and Poisson's ratio of each elastic one that is known.
    pub(crate) elastic: Vec<[f64; 2]>,
    words: String,
}

impl Bodies {
    /// Bodies of which only E* is known, and where from.
    pub(crate) fn of_modulus(e_star: f64, source: &str) -> Self {
        Self { e_star, elastic: Vec::new(), words: source.to_string() }
    }
}

impl fmt::Display for Bodies {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: E* {}", self.words, quantity(self.e_star, "Pa", 4))
    }
}

impl Elasticity {
    /// The bodies, `None` if nothing was said of them.
    fn given(&self) -> Result<Option<Bodies>, Failure> {
        let Some(first) = self.material else {
            let alone = |e_star| Bodies::of_modulus(e_star, "composite modulus as given");
            return Ok(self.e_star.map(alone));
        };
        Bodies::between(first, self.against).map(Some)
    }

    /// The bodies that were said, otherwise steel against a rigid body.
    pub(crate) fn or_steel(&self) -> Result<Bodies, Failure> {
        match self.given()? {
            Some(bodies) => Ok(bodies),
            None => {
                let mut steel = Bodies::between(Material::STEEL, None)?;
                steel.words = format!("assumed: {}", steel.words);
                Ok(steel)
            }
        }
    }

    /// A typical hardness \[Pa\] of the softer body that is named, of steel if nothing was said; `None` where none is known.
    pub(crate) fn typical_hardness(&self) -> Option<f64> {
        let named = match (self.e_star, self.material) {
            (None, None) => [Some(Material::STEEL), None],
            _ => [self.material, self.against],
        };
        named.into_iter().flatten().filter_map(|body| body.hardness).reduce(f64::min)
    }

    /// The bodies, without which no measured surface can be pressed.
    pub(crate) fn required(&self) -> Result<Bodies, Failure> {
        self.given()?.ok_or_else(|| {
            Failure::request("how stiff are the bodies? Give --e-star or --material")
        })
    }
}

impl Bodies {
    pub(crate) fn between(first: Material, second: Option<Material>) -> Result<Self, Failure> {
        let (e_star, against) = match second {
            Some(second) => {
                (composite_modulus((first.e, first.nu), (second.e, second.nu)), second.to_string())
            }
            None => (plane_strain_modulus(first.e, first.nu), "rigid".to_string()),
        };
        Ok(Self {
            e_star: e_star.map_err(|error| Failure::new("invalid material", error))?,
            elastic: [Some(first), second]
                .into_iter()
                .flatten()
                .map(|material| [material.e, material.nu])
                .collect(),
            words: format!("{first} against {against}"),
        })
    }
}

/// A body, with its name if it was given by name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Material {
    name: Option<&'static str>,
    /// Young's modulus \[Pa\].
    e: f64,
    /// Poisson's ratio.
    nu: f64,
    /// Typical hardness \[Pa\], as a mean pressure under an indenter.
    hardness: Option<f64>,
}

impl Material {
    const STEEL: Self = Self::named(MATERIALS[0]);

    /// Young's modulus \[Pa\] and Poisson's ratio.
    pub(crate) fn elastic(&self) -> (f64, f64) {
        (self.e, self.nu)
    }

    const fn named((name, e, nu, hardness): (&'static str, f64, f64, Option<f64>)) -> Self {
        Self { name: Some(name), e, nu, hardness }
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

/// Typical values at room temperature: Young's modulus, Poisson's ratio, hardness. Those of an alloy or a polymer vary: for results that matter they are given
/// as numbers.
const MATERIALS: [(&str, f64, f64, Option<f64>); 18] = [
    ("steel", 210e9, 0.3, Some(2.5e9)),
    ("stainless-steel", 195e9, 0.29, Some(2.0e9)),
    ("cast-iron", 110e9, 0.26, Some(2.0e9)),
    ("aluminium", 70e9, 0.33, Some(1.0e9)),
    ("copper", 125e9, 0.34, Some(0.9e9)),
    ("brass", 105e9, 0.34, Some(1.3e9)),
    ("bronze", 110e9, 0.34, Some(1.2e9)),
    ("titanium", 115e9, 0.33, Some(3.4e9)),
    ("tungsten-carbide", 620e9, 0.22, Some(16e9)),
    ("gold", 78e9, 0.42, Some(0.5e9)),
    ("silver", 83e9, 0.37, Some(0.6e9)),
    ("alumina", 370e9, 0.22, Some(16e9)),
    ("glass", 70e9, 0.22, Some(5.5e9)),
    ("fused-silica", 72e9, 0.17, Some(9e9)),
    ("pmma", 3e9, 0.37, Some(0.25e9)),
    ("polycarbonate", 2.4e9, 0.37, Some(0.15e9)),
    ("ptfe", 0.5e9, 0.46, Some(0.03e9)),
    ("rubber", 2e6, 0.5, None),
];

impl FromStr for Material {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Some(named) = MATERIALS.iter().find(|(name, ..)| *name == text) {
            return Ok(Self::named(*named));
        }
        let number = |text: &str| text.trim().parse::<f64>().ok();
        match text.split_once(',').map(|(e, nu)| (number(e), number(nu))) {
            Some((Some(e), Some(nu))) => Ok(Self { name: None, e, nu, hardness: None }),
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
        let bodies = elasticity.given().map_err(|_| "refused".to_string())?;
        Ok(bodies.map(|bodies| bodies.e_star))
    }

    #[test]
    fn bodies_are_named_or_given_in_numbers() {
        assert_eq!(modulus("steel", None), modulus("210e9,0.3", None));
        assert_eq!(modulus("steel", None), Ok(Some(210e9 / (1.0 - 0.3 * 0.3))));
        assert_eq!(modulus("glass", Some("pmma")), modulus("3e9, 0.37", Some("70e9, 0.22")));
    }

    /// One body alone presses against a rigid one, whether it was named or assumed.
    #[test]
    fn both_bodies_are_said() -> Result<(), String> {
        let said = |material: &str, against: Option<&str>| -> Result<String, String> {
            let elasticity = Elasticity {
                e_star: None,
                material: Some(material.parse()?),
                against: against.map(str::parse).transpose()?,
            };
            let bodies = elasticity.required().map_err(|_| "refused")?;
            Ok(bodies.to_string())
        };
        let steel = "steel (210 GPa, 0.30) against rigid: E* 230.8 GPa";
        assert_eq!(said("steel", None)?, steel);
        assert_eq!(
            said("70e9,0.33", Some("rubber"))?,
            "E = 70 GPa, ν = 0.33 against rubber (2 MPa, 0.50): E* 2.667 MPa"
        );
        let nothing = |e_star| Elasticity { e_star, material: None, against: None };
        let assumed = nothing(None).or_steel().map_err(|_| "refused")?;
        assert_eq!(assumed.to_string(), format!("assumed: {steel}"));
        assert!(nothing(None).required().is_err());
        let given = nothing(Some(115e9)).or_steel().map_err(|_| "refused")?;
        assert_eq!(given.to_string(), "composite modulus as given: E* 115 GPa");
        Ok(())
    }

    #[test]
    fn what_is_no_material_is_refused() {
        for text in ["", "stone", "210e9", "210e9;0.3", "a,b", "210e9,0.7", "-1,0.3"] {
            assert!(modulus(text, None).is_err(), "{text}");
        }
    }

    #[test]
    fn every_named_material_exists() {
        for (name, ..) in MATERIALS {
            assert!(matches!(modulus(name, Some("steel")), Ok(Some(_))), "{name}");
        }
    }
}
