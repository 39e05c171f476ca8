//! Layers on a base, as a command line asks for them.

use std::str::FromStr;

use asperity::kernel::{Base, Layer, LayeredBody};
use asperity_cli::number::quantity;

use crate::material::Material;
use crate::values::LENGTH;

/// A layer: `210GPa,0.3,20um` or `gold,2e-6`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LayerArgument {
    pub(crate) material: Material,
    thickness: f64,
}

impl LayerArgument {
    pub(crate) fn layer(&self) -> Layer {
        let (youngs_modulus, poissons_ratio) = self.material.elastic();
        Layer { youngs_modulus, poissons_ratio, thickness: self.thickness }
    }
}

impl FromStr for LayerArgument {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = "neither 'E,NU,H' nor 'NAME,H', with the thickness H in metres";
        let (material, thickness) = text.rsplit_once(',').ok_or(expected)?;
        let material = material.parse().map_err(|error| format!("{expected}: {error}"))?;
        let thickness =
            LENGTH.positive()(thickness).map_err(|error| format!("thickness: {error}"))?;
        Ok(Self { material, thickness })
    }
}

/// What they are bonded to: `rigid`, or a material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BaseArgument(pub(crate) Base);

impl FromStr for BaseArgument {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text.eq_ignore_ascii_case("rigid") {
            return Ok(Self(Base::Rigid));
        }
        let material =
            text.parse::<Material>().map_err(|error| format!("not 'rigid', and {error}"))?;
        let (youngs_modulus, poissons_ratio) = material.elastic();
        Ok(Self(Base::HalfSpace { youngs_modulus, poissons_ratio }))
    }
}

/// `5 µm of E = 450 GPa, ν = 0.25 on E = 210 GPa, ν = 0.30 against rigid`.
pub(crate) fn described(body: &LayeredBody) -> String {
    let elastic = |youngs_modulus: f64, poissons_ratio: f64| {
        format!("E = {}, ν = {poissons_ratio:.2}", quantity(youngs_modulus, "Pa", 4))
    };
    let layers = body.layers().iter().map(|layer| {
        format!(
            "{} of {}",
            quantity(layer.thickness, "m", 4),
            elastic(layer.youngs_modulus, layer.poissons_ratio)
        )
    });
    let layers: Vec<String> = layers.collect();
    let base = match body.base() {
        Base::Rigid => "a rigid base".to_string(),
        Base::HalfSpace { youngs_modulus, poissons_ratio } => {
            elastic(youngs_modulus, poissons_ratio)
        }
    };
    let against = body.counterpart().map_or_else(
        || "rigid".to_string(),
        |e_star| format!("E* = {}", quantity(e_star, "Pa", 4)),
    );
    format!("{} on {base} against {against}", layers.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_are_named_or_given_in_numbers() {
        let layer = |text: &str| text.parse::<LayerArgument>().map(|found| found.layer());
        let expected = Layer { youngs_modulus: 210e9, poissons_ratio: 0.3, thickness: 20e-6 };
        assert_eq!(layer("210e9,0.3,20e-6"), Ok(expected));
        assert_eq!(layer("Steel, 20 µm"), Ok(expected));
        assert_eq!(layer("210GPa,0.3,0.02mm"), Ok(expected));
        for bad in [
            "",
            "steel",
            "210e9,0.3",
            "stone,1e-6",
            "210e9,0.3,thick",
            "1,2,3,4",
            "steel,0",
            "steel,1Pa",
        ] {
            assert!(layer(bad).is_err(), "{bad}");
        }
        let base = |text: &str| text.parse::<BaseArgument>().map(|found| found.0);
        assert_eq!(base("Rigid"), Ok(Base::Rigid));
        assert_eq!(
            base("steel"),
            Ok(Base::HalfSpace { youngs_modulus: 210e9, poissons_ratio: 0.3 })
        );
        assert!(base("soft").is_err());
    }

    #[test]
    fn bodies_are_said_in_words() -> Result<(), asperity::Error> {
        let coat = Layer { youngs_modulus: 450e9, poissons_ratio: 0.25, thickness: 5e-6 };
        let steel = Base::HalfSpace { youngs_modulus: 210e9, poissons_ratio: 0.3 };
        let body = LayeredBody::new(&[coat, Layer { thickness: 1e-3, ..coat }], steel)?;
        assert_eq!(
            described(&body),
            "5 µm of E = 450 GPa, ν = 0.25, 1 mm of E = 450 GPa, ν = 0.25 on E = 210 GPa, ν = 0.30 against rigid"
        );
        let body = LayeredBody::new(&[coat], Base::Rigid)?.against(1e9)?;
        assert!(described(&body).ends_with("on a rigid base against E* = 1 GPa"));
        Ok(())
    }
}
