//! The composite modulus that a command line asks for.

use std::fmt;

use asperity::kernel::{KernelOrigin, LayeredBody, Layering};
use asperity::record::LoadingRecord;
use asperity::{
    Boundary, Error, Grid, InfluenceKernel, Warning, composite_modulus, plane_strain_modulus,
};
use asperity_cli::half_space::{Periodic, half_space, layered};
use asperity_cli::number::quantity;
use asperity_cli::outcome::Failure;
use clap::Args;

use crate::layers::{BaseArgument, LayerArgument, described};
use crate::material::Material;
use crate::values::PRESSURE;

/// How far E* of bodies may be from that of a path: materials are given with three digits.
const SAME_MODULUS: f64 = 1e-3;

/// How stiff the two bodies are.
#[derive(Debug, Clone, Args)]
pub(crate) struct Elasticity {
    /// Composite modulus E*: 1/E* = (1 - ν₁²)/E₁ + (1 - ν₂²)/E₂
    #[arg(long, value_name = "PA", value_parser = PRESSURE.positive(), help_heading = "Bodies")]
    e_star: Option<f64>,

    /// One body, in place of E*: a name (steel, aluminium, copper, brass, titanium, glass, pmma, ptfe, rubber, ...:
    /// typical values), or Young's modulus and Poisson's ratio: 210GPa,0.3
    #[arg(long, value_name = "NAME|E,NU", conflicts_with = "e_star")]
    material: Option<Material>,

    /// The other body [default: rigid]
    #[arg(long, value_name = "NAME|E,NU", conflicts_with = "e_star")]
    against: Option<Material>,

    /// A layer of one body, in place of --material: Young's modulus, Poisson's ratio and thickness, 450GPa,0.25,5um, or
    /// a name and the thickness, gold,2um; may be given several times, from the surface downwards
    #[arg(long, value_name = "E,NU,H|NAME,H", conflicts_with_all = ["e_star", "material"], requires = "base", help_heading = "Bodies")]
    layer: Vec<LayerArgument>,

    /// What the layers are bonded to: rigid, or an elastic half-space
    #[arg(long, value_name = "rigid|NAME|E,NU", requires = "layer", conflicts_with_all = ["e_star", "material"], help_heading = "Bodies")]
    base: Option<BaseArgument>,
}

/// The two bodies in words, and their composite modulus.
#[derive(Debug, Clone)]
pub(crate) struct Bodies {
    pub(crate) e_star: f64,
    /// Young's modulus \[Pa\] and Poisson's ratio of each elastic one that is known.
    pub(crate) elastic: Vec<[f64; 2]>,
    /// One of them if it has layers; E* is then the one that short waves see.
    pub(crate) layered: Option<LayeredBody>,
    /// A typical hardness \[Pa\] of the softer body that is named; `None` where none is known.
    pub(crate) hardness: Option<f64>,
    words: String,
}

impl Bodies {
    /// Bodies of which only E* is known, and where from.
    pub(crate) fn of_modulus(e_star: f64, source: &str) -> Self {
        Self {
            e_star,
            elastic: Vec::new(),
            layered: None,
            hardness: None,
            words: source.to_string(),
        }
    }

    /// A body with layers.
    fn of_layers(body: LayeredBody) -> Self {
        Self {
            e_star: body.surface_modulus(),
            elastic: Vec::new(),
            hardness: None,
            words: described(&body),
            layered: Some(body),
        }
    }

    /// Those of a record, and how it repeats.
    ///
    /// # Errors
    ///
    /// [`Error::ForeignKernel`] if it is of others.
    pub(crate) fn of_record(record: &LoadingRecord) -> Result<(Option<Periodic>, Self), Error> {
        Self::of_kernel(&record.kernel().origin, record.bodies())
    }

    /// Those of a kernel, with Young's modulus \[Pa\] and Poisson's ratio of each elastic one that is known.
    pub(crate) fn of_kernel(
        origin: &KernelOrigin,
        elastic: &[(f64, f64)],
    ) -> Result<(Option<Periodic>, Self), Error> {
        let plain = |e_star: &f64| Self {
            elastic: elastic.iter().map(|&(e, nu)| [e, nu]).collect(),
            ..Self::of_modulus(*e_star, &of_record_in_words(elastic))
        };
        let layers = |body: &LayeredBody| Self::of_layers(body.clone());
        let (love, spectral) = (Some(Periodic::Love), Some(Periodic::Spectral));
        match origin {
            KernelOrigin::Boussinesq { e_star } => Ok((None, plain(e_star))),
            KernelOrigin::PeriodicBoussinesq { e_star } => Ok((love, plain(e_star))),
            KernelOrigin::Spectral { e_star } => Ok((spectral, plain(e_star))),
            KernelOrigin::SemiPeriodicBoussinesq { e_star, boundary: Boundary::PeriodicY } => {
                Ok((Some(Periodic::Y), plain(e_star)))
            }
            KernelOrigin::SemiPeriodicBoussinesq { e_star, .. } => {
                Ok((Some(Periodic::X), plain(e_star)))
            }
            KernelOrigin::Layered { body } => Ok((None, layers(body))),
            KernelOrigin::PeriodicLayered { body } => Ok((love, layers(body))),
            KernelOrigin::SpectralLayered { body } => Ok((spectral, layers(body))),
            _ => Err(Error::ForeignKernel),
        }
    }

    /// What looks wrong with them on a grid.
    pub(crate) fn warnings(&self, grid: &Grid) -> impl Iterator<Item = Warning> {
        let layers = self.layered.as_ref().and_then(|body| Warning::of_layers(body, grid));
        Warning::of_modulus(self.e_star).into_iter().chain(layers)
    }

    /// What looks wrong with the greatest pressure of a contact in which nothing yields.
    pub(crate) fn warning_of(&self, pressure: f64) -> Option<Warning> {
        Warning::of_pressure(pressure, self.e_star, self.hardness)
    }

    /// That a path is of others, of which no more is used than some property.
    pub(crate) fn warning_of_path(&self, record: &LoadingRecord, used: &str) -> Option<String> {
        let e_star = record.kernel().origin.composite_modulus()?;
        let is_same = (self.e_star / e_star - 1.0).abs() < SAME_MODULUS;
        (!is_same).then(|| {
            format!(
                "the path has been computed with E* {}, and these bodies have {}: only {used} is used",
                quantity(e_star, "Pa", 4),
                quantity(self.e_star, "Pa", 4)
            )
        })
    }

    /// What they are made of, for what follows from a contact.
    pub(crate) fn layering(&self, boundary: Boundary) -> Layering {
        match &self.layered {
            Some(body) => body.layering(),
            None => match boundary {
                Boundary::PeriodicX | Boundary::PeriodicY => Layering::SemiPeriodicHalfSpace,
                Boundary::Free | Boundary::Periodic => Layering::HalfSpace,
            },
        }
    }

    /// How they answer on a grid.
    ///
    /// # Errors
    ///
    /// Those of the kernels.
    pub(crate) fn kernel(
        &self,
        periodic: Option<Periodic>,
        grid: Grid,
    ) -> Result<Box<dyn InfluenceKernel>, Error> {
        match &self.layered {
            None => half_space(periodic, grid, self.e_star),
            Some(body) => layered(periodic, grid, body),
        }
    }
}

/// What a record says of its bodies.
fn of_record_in_words(elastic: &[(f64, f64)]) -> String {
    let body = |&(e, nu): &(f64, f64)| Material { name: None, e, nu, hardness: None }.to_string();
    match elastic {
        [] => "composite modulus of the record".to_string(),
        [first, rest @ ..] => {
            let second = rest.first().map_or_else(|| "rigid".to_string(), body);
            format!("of the record: {} against {second}", body(first))
        }
    }
}

impl fmt::Display for Bodies {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: E* {}", self.words, quantity(self.e_star, "Pa", 4))?;
        if self.layered.is_some() { write!(f, " of the surface") } else { Ok(()) }
    }
}

impl Elasticity {
    /// The bodies, `None` if nothing was said of them.
    fn given(&self) -> Result<Option<Bodies>, Failure> {
        if let Some(BaseArgument(base)) = self.base {
            let layers: Vec<_> = self.layer.iter().map(LayerArgument::layer).collect();
            let other = self.against.map(|other| plane_strain_modulus(other.e, other.nu));
            let body =
                LayeredBody::new(&layers, base).and_then(|body| match other.transpose()? {
                    Some(e_star) => body.against(e_star),
                    None => Ok(body),
                });
            let body = body.map_err(|error| Failure::new("invalid layers", error))?;
            // What bears the pressure: the uppermost layer, and what it is pressed against.
            let bear =
                self.layer.first().map(|layer| layer.material).into_iter().chain(self.against);
            let hardness = bear.filter_map(|material| material.hardness).reduce(f64::min);
            return Ok(Some(Bodies { hardness, ..Bodies::of_layers(body) }));
        }
        if self.against.is_some() && self.material.is_none() {
            return Err(Failure::request("--against needs --material, or --layer and --base"));
        }
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

    /// The bodies, without which no measured surface can be pressed.
    pub(crate) fn required(&self) -> Result<Bodies, Failure> {
        self.given()?.ok_or_else(|| {
            Failure::request(
                "how stiff are the bodies? Give --e-star or --material, or --layer and --base",
            )
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
        let both = || [Some(first), second].into_iter().flatten();
        Ok(Self {
            e_star: e_star.map_err(|error| Failure::new("invalid material", error))?,
            elastic: both().map(|material| [material.e, material.nu]).collect(),
            layered: None,
            hardness: both().filter_map(|material| material.hardness).reduce(f64::min),
            words: format!("{first} against {against}"),
        })
    }
}

#[cfg(test)]
mod tests {
    use asperity::material::Material as Known;

    use super::*;

    fn nothing() -> Elasticity {
        Elasticity { e_star: None, material: None, against: None, layer: Vec::new(), base: None }
    }

    /// Layers against a rigid body and an elastic one; other bodies have none.
    #[test]
    fn layers_make_a_body() -> Result<(), String> {
        let elasticity = |against: Option<&str>| -> Result<Elasticity, String> {
            Ok(Elasticity {
                layer: vec!["3e6,0.5,1e-3".parse()?],
                base: Some("rigid".parse()?),
                against: against.map(str::parse).transpose()?,
                ..nothing()
            })
        };
        let bodies = elasticity(None)?.required().map_err(|_| "refused")?;
        assert_eq!(
            bodies.to_string(),
            "1 mm of E = 3 MPa, ν = 0.50 on a rigid base against rigid: E* 4 MPa of the surface"
        );
        assert!(bodies.hardness.is_none());
        let pair = elasticity(Some("3e6,0.5"))?.required().map_err(|_| "refused")?;
        assert_eq!(pair.e_star, 2e6);
        let alone = Elasticity { against: Some("steel".parse()?), ..nothing() };
        assert!(alone.or_steel().is_err());
        let refused = Elasticity { layer: vec!["1,0.6,1e-3".parse()?], ..elasticity(None)? };
        assert!(refused.required().is_err());
        Ok(())
    }

    fn modulus(material: &str, against: Option<&str>) -> Result<Option<f64>, String> {
        let elasticity = Elasticity {
            e_star: None,
            material: Some(material.parse()?),
            against: against.map(str::parse).transpose()?,
            ..nothing()
        };
        let bodies = elasticity.given().map_err(|_| "refused".to_string())?;
        Ok(bodies.map(|bodies| bodies.e_star))
    }

    #[test]
    fn bodies_are_named_or_given_in_numbers() {
        assert_eq!(modulus("steel", None), modulus("210e9,0.3", None));
        assert_eq!(modulus("Steel", None), modulus("210 GPa, 0.3", None));
        assert_eq!(modulus("Aluminum", None), modulus("aluminium", None));
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
                ..nothing()
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
        let only = |e_star| Elasticity { e_star, ..nothing() };
        let assumed = nothing().or_steel().map_err(|_| "refused")?;
        assert_eq!(assumed.to_string(), format!("assumed: {steel}"));
        assert!(nothing().required().is_err());
        let given = only(Some(115e9)).or_steel().map_err(|_| "refused")?;
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
        for Known { name, .. } in Known::ALL {
            assert!(matches!(modulus(name, Some("steel")), Ok(Some(_))), "{name}");
        }
    }
}
