//! What the page asks for.

use asperity::material::Material;
use asperity::{ContactTarget, Error, composite_modulus, plane_strain_modulus};
use serde::Deserialize;
use serde::de::DeserializeOwned;

use crate::fault::Fault;
use crate::half_space::HalfSpace;

/// A request in JSON.
pub(crate) fn parse<T: DeserializeOwned>(text: &str) -> Result<T, Fault> {
    serde_json::from_str(text)
        .map_err(|error| Fault::new(format!("the page asks for what there is not: {error}")))
}

/// What a file does not say, and how its surface is prepared. Lengths are in metres.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct Reading {
    pub(crate) side: Option<f64>,
    pub(crate) side_y: Option<f64>,
    pub(crate) height_unit: Option<String>,
    pub(crate) lateral_unit: Option<String>,
    pub(crate) channel: Option<String>,
    pub(crate) layout: Option<String>,
    pub(crate) rows_are_y: bool,
    pub(crate) ignore_mask: bool,
    pub(crate) fill: bool,
    pub(crate) level: Level,
    pub(crate) invert: bool,
}

/// A trend that is removed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Level {
    #[default]
    None,
    Plane,
    Quadratic,
}

/// A generated surface; what is not given is that of the program's example.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct Generation {
    pub(crate) nodes: Option<usize>,
    pub(crate) side: Option<f64>,
    pub(crate) seed: Option<u64>,
    pub(crate) hurst: Option<f64>,
    pub(crate) rolloff: Option<f64>,
    pub(crate) short_cutoff: Option<f64>,
    pub(crate) rms_height: Option<f64>,
    pub(crate) rms_gradient: Option<f64>,
}

/// A body: a name, or Young's modulus \[Pa\] and Poisson's ratio.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
pub(crate) enum Body {
    Named(String),
    Given(f64, f64),
}

impl Body {
    fn elastic(&self) -> Result<(f64, f64), Fault> {
        match self {
            Self::Given(youngs_modulus, poissons_ratio) => Ok((*youngs_modulus, *poissons_ratio)),
            Self::Named(name) => {
                let known = Material::named(name);
                let elastic = known.map(|body| (body.youngs_modulus, body.poissons_ratio));
                elastic.ok_or_else(|| Fault::new(format!("there is no material {name}")))
            }
        }
    }
}

/// A path.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct Job {
    /// Composite modulus \[Pa\], in place of bodies.
    pub(crate) e_star: Option<f64>,
    pub(crate) body: Option<Body>,
    /// The other one, rigid if it is not given.
    pub(crate) against: Option<Body>,
    pub(crate) half_space: HalfSpace,
    /// \[Pa\].
    pub(crate) hardness: Option<f64>,
    pub(crate) target: Option<Target>,
}

/// Where a path ends.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Target {
    AreaFraction(f64),
    Load(f64),
    MeanPressure(f64),
    Approach(f64),
    MeanGap(f64),
}

/// Contact area over nominal area at which a path ends if nobody says where, as in the program.
const AREA_FRACTION: f64 = 0.1;

impl Job {
    /// Elastic bodies that are known, and the composite modulus.
    pub(crate) fn bodies(&self) -> Result<(Vec<(f64, f64)>, f64), Fault> {
        if let Some(e_star) = self.e_star {
            return Ok((Vec::new(), e_star));
        }
        let Some(body) = &self.body else {
            return Err(Fault::new("how stiff are the bodies? Choose a material, or give E*"));
        };
        let first = body.elastic()?;
        Ok(match &self.against {
            None => (vec![first], plane_strain_modulus(first.0, first.1)?),
            Some(other) => {
                let other = other.elastic()?;
                (vec![first, other], composite_modulus(first, other)?)
            }
        })
    }

    /// Where it ends, on this nominal area \[m²\].
    pub(crate) fn end(&self, nominal_area: f64) -> Result<ContactTarget, Error> {
        Ok(match self.target.unwrap_or(Target::AreaFraction(AREA_FRACTION)) {
            Target::AreaFraction(fraction) => ContactTarget::AreaFraction(fraction),
            Target::Load(load) => ContactTarget::Load(load),
            Target::MeanPressure(pressure) => ContactTarget::Load(pressure * nominal_area),
            Target::Approach(approach) => ContactTarget::Approach(approach),
            Target::MeanGap(gap) => ContactTarget::MeanGap(gap),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bodies_are_named_or_given() -> Result<(), Fault> {
        let of = |text: &str| parse::<Job>(text)?.bodies();
        let steel = plane_strain_modulus(210e9, 0.3)?;
        assert_eq!(of(r#"{"body": "steel"}"#)?, (vec![(210e9, 0.3)], steel));
        assert_eq!(of(r#"{"body": [210e9, 0.3]}"#)?, (vec![(210e9, 0.3)], steel));
        assert_eq!(of(r#"{"e_star": 1e9}"#)?, (vec![], 1e9));
        let (both, e_star) = of(r#"{"body": "steel", "against": [210e9, 0.3]}"#)?;
        assert_eq!((both.len(), e_star), (2, composite_modulus((210e9, 0.3), (210e9, 0.3))?));
        for refused in ["{}", r#"{"body": "stone"}"#, r#"{"bodies": 1}"#, r#"{"body": [1, 0.7]}"#] {
            assert!(of(refused).is_err(), "{refused}");
        }
        Ok(())
    }

    #[test]
    fn targets_are_those_of_the_library() -> Result<(), Fault> {
        for (text, expected) in [
            ("{}", ContactTarget::AreaFraction(0.1)),
            (r#"{"target": {"area_fraction": 0.2}}"#, ContactTarget::AreaFraction(0.2)),
            (r#"{"target": {"load": 3}}"#, ContactTarget::Load(3.0)),
            (r#"{"target": {"mean_pressure": 2e6}}"#, ContactTarget::Load(1.0)),
            (r#"{"target": {"approach": 1e-6}}"#, ContactTarget::Approach(1e-6)),
            (r#"{"target": {"mean_gap": 1e-6}}"#, ContactTarget::MeanGap(1e-6)),
        ] {
            assert_eq!(parse::<Job>(text)?.end(5e-7)?, expected, "{text}");
        }
        Ok(())
    }
}
