//! Typical values of materials, and hardness numbers as pressures.

use crate::Error;

/// Typical values of a material at room temperature. Those of an alloy or a polymer vary: for results that matter they
/// are given as numbers.
///
/// ```
/// use asperity::material::Material;
/// use asperity::plane_strain_modulus;
///
/// # fn main() -> Result<(), asperity::Error> {
/// let steel = Material::STEEL;
/// let e_star = plane_strain_modulus(steel.youngs_modulus, steel.poissons_ratio)?;
/// assert_eq!(e_star, 210e9 / (1.0 - 0.3 * 0.3));
/// assert_eq!(Material::named("steel"), Some(&steel));
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Material {
    /// Its name.
    pub name: &'static str,
    /// Young's modulus \[Pa\].
    pub youngs_modulus: f64,
    /// Poisson's ratio.
    pub poissons_ratio: f64,
    /// Hardness \[Pa\], as a mean pressure under an indenter; `None` where none is known.
    pub hardness: Option<f64>,
}

/// A scale of hardness numbers.
///
/// ```
/// use asperity::material::HardnessScale;
///
/// # fn main() -> Result<(), asperity::Error> {
/// let ball = HardnessScale::Brinell.pascals(250.0)?;
/// assert!((ball / 2.545e9 - 1.0).abs() < 1e-3);
/// assert_eq!(HardnessScale::named("HRC"), Some(HardnessScale::RockwellC));
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HardnessScale {
    /// HB, HBW: a ball.
    Brinell,
    /// HV: a pyramid.
    Vickers,
    /// HRC, of steel: by the depth of a cone. As Vickers number it is `(223 HRC + 14500) / (100 − HRC)`, within 1.5 %
    /// of the table of ASTM E140 for carbon and alloy steels between 20 and 68.
    RockwellC,
}

/// Kilograms-force per square millimetre \[Pa\].
const KILOGRAMS_FORCE: f64 = 9.80665e6;
/// The circle of a Brinell indentation over its cap, on which the number counts the force, at the usual width of 0.375
/// diameters of the ball.
const BALL: f64 = 0.9635;
/// The square of a Vickers indentation over its faces, which stand 68° from the axis.
const PYRAMID: f64 = 0.92718;
/// Numbers between which Rockwell's are compared with others.
const ROCKWELL_C: std::ops::RangeInclusive<f64> = 20.0..=68.0;

impl HardnessScale {
    /// The scale of this symbol, in any case.
    #[must_use]
    pub fn named(symbol: &str) -> Option<Self> {
        match symbol.to_ascii_uppercase().as_str() {
            "HB" | "HBW" => Some(Self::Brinell),
            "HV" => Some(Self::Vickers),
            "HRC" => Some(Self::RockwellC),
            _ => None,
        }
    }

    /// The mean pressure under the indenter \[Pa\] of a hardness number.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] if the number is not positive and finite, [`Error::OutOfRange`] for Rockwell's below 20
    /// and above 68, for which there is no comparison.
    pub fn pascals(self, number: f64) -> Result<f64, Error> {
        if !(number > 0.0 && number.is_finite()) {
            return Err(Error::NotPositive { quantity: "hardness", value: number });
        }
        let vickers = |number: f64| number * KILOGRAMS_FORCE / PYRAMID;
        match self {
            Self::Brinell => Ok(number * KILOGRAMS_FORCE / BALL),
            Self::Vickers => Ok(vickers(number)),
            Self::RockwellC if ROCKWELL_C.contains(&number) => {
                Ok(vickers((223.0 * number + 14500.0) / (100.0 - number)))
            }
            Self::RockwellC => Err(Error::OutOfRange {
                quantity: "hardness HRC",
                value: number,
                expected: "between 20 and 68, where it can be compared with HV",
            }),
        }
    }
}

impl Material {
    /// Steel: what the programs take for a body of which nothing is said.
    pub const STEEL: Self = Self::of("steel", 210e9, 0.3, Some(2.5e9));

    /// All that there are.
    pub const ALL: [Self; 21] = [
        Self::STEEL,
        Self::of("stainless-steel", 195e9, 0.29, Some(2.0e9)),
        Self::of("cast-iron", 110e9, 0.26, Some(2.0e9)),
        Self::of("aluminium", 70e9, 0.33, Some(1.0e9)),
        Self::of("copper", 125e9, 0.34, Some(0.9e9)),
        Self::of("brass", 105e9, 0.34, Some(1.3e9)),
        Self::of("bronze", 110e9, 0.34, Some(1.2e9)),
        Self::of("titanium", 115e9, 0.33, Some(3.4e9)),
        Self::of("tungsten-carbide", 620e9, 0.22, Some(16e9)),
        Self::of("gold", 78e9, 0.42, Some(0.5e9)),
        Self::of("silver", 83e9, 0.37, Some(0.6e9)),
        Self::of("alumina", 370e9, 0.22, Some(16e9)),
        Self::of("glass", 70e9, 0.22, Some(5.5e9)),
        Self::of("fused-silica", 72e9, 0.17, Some(9e9)),
        Self::of("pmma", 3e9, 0.37, Some(0.25e9)),
        Self::of("polycarbonate", 2.4e9, 0.37, Some(0.15e9)),
        Self::of("ptfe", 0.5e9, 0.46, Some(0.03e9)),
        Self::of("rubber", 2e6, 0.5, None),
        // Coats. TiN is no name: in any case it is tin, too.
        Self::of("diamond-like-carbon", 200e9, 0.22, Some(20e9)),
        Self::of("titanium-nitride", 450e9, 0.25, Some(22e9)),
        Self::of("chromium-nitride", 300e9, 0.25, Some(18e9)),
    ];

    const fn of(
        name: &'static str,
        youngs_modulus: f64,
        poissons_ratio: f64,
        hardness: Option<f64>,
    ) -> Self {
        Self { name, youngs_modulus, poissons_ratio, hardness }
    }

    /// The material of this name, in any case, with spaces for hyphens; aluminum is aluminium, DLC diamond-like
    /// carbon, and CrN chromium nitride.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Self> {
        const ALL: &[Material] = &Material::ALL;
        let name = name.trim().to_lowercase().replace(' ', "-");
        let name = match &*name {
            "aluminum" => "aluminium",
            "dlc" => "diamond-like-carbon",
            "crn" => "chromium-nitride",
            name => name,
        };
        ALL.iter().find(|material| material.name == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Error, plane_strain_modulus};

    /// Each has a modulus, a name of its own, and a hardness below its modulus.
    #[test]
    fn every_material_is_one() -> Result<(), Error> {
        for (k, material) in Material::ALL.iter().enumerate() {
            let e_star = plane_strain_modulus(material.youngs_modulus, material.poissons_ratio)?;
            assert!(material.hardness.is_none_or(|h| h > 0.0 && h < 0.15 * e_star), "{material:?}");
            assert_eq!(Material::named(material.name), Some(material));
            assert!(Material::ALL[..k].iter().all(|other| other.name != material.name));
        }
        assert_eq!(["stone", "tin", "TiN"].map(Material::named), [None; 3]);
        for (name, known) in [
            ("Steel", "steel"),
            ("PTFE", "ptfe"),
            (" Stainless Steel", "stainless-steel"),
            ("Aluminum", "aluminium"),
            ("DLC", "diamond-like-carbon"),
            ("CrN", "chromium-nitride"),
            ("Titanium nitride", "titanium-nitride"),
        ] {
            assert_eq!(Material::named(name).map(|material| material.name), Some(known));
        }
        Ok(())
    }

    /// A ball that has sunk in 0.375 of its diameter wide: the cap has the area `2 (1 − √(1 − x²)) / x²` times its
    /// circle. Rockwell numbers beside Vickers numbers from ASTM E140, Table 1, within 1.5 %.
    #[test]
    fn hardness_is_a_pressure() -> Result<(), Error> {
        let x: f64 = 0.375;
        let cap = 2.0 * (1.0 - (1.0 - x * x).sqrt()) / (x * x);
        let close = |found: f64, expected: f64, tolerance: f64| {
            assert!((found / expected - 1.0).abs() < tolerance, "{found:e} {expected:e}");
        };
        close(HardnessScale::Brinell.pascals(250.0)?, 250.0 * 9.80665e6 * cap, 1e-3);
        let pyramid = 68_f64.to_radians().sin();
        close(HardnessScale::Vickers.pascals(250.0)?, 250.0 * 9.80665e6 / pyramid, 1e-3);
        for (rockwell, vickers) in [
            (20.0, 238.0),
            (30.0, 302.0),
            (40.0, 392.0),
            (45.0, 446.0),
            (50.0, 513.0),
            (55.0, 595.0),
            (60.0, 697.0),
            (65.0, 832.0),
            (68.0, 940.0),
        ] {
            let found = HardnessScale::RockwellC.pascals(rockwell)?;
            close(found, HardnessScale::Vickers.pascals(vickers)?, 0.015);
        }
        for bad in [19.9, 68.1, f64::NAN] {
            assert!(HardnessScale::RockwellC.pascals(bad).is_err(), "{bad}");
        }
        for bad in [0.0, -1.0, f64::INFINITY] {
            assert!(HardnessScale::Vickers.pascals(bad).is_err(), "{bad}");
        }
        let named = ["hbw", "HB", "hv", "HRC", "Mohs"].map(HardnessScale::named);
        let (ball, pyramid) = (Some(HardnessScale::Brinell), Some(HardnessScale::Vickers));
        assert_eq!(named, [ball, ball, pyramid, Some(HardnessScale::RockwellC), None]);
        Ok(())
    }
}
