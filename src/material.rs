//! Typical values of materials, and hardness numbers as pressures.

/// Typical values of a material at room temperature. Those of an alloy or a polymer vary: for results that matter they are
/// given as numbers.
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

/// Mean pressure \[Pa\] under a ball per Brinell number: kilograms-force per square millimetre of the surface of the
/// indentation, of which 0.964 lies in the plane at its usual width of 0.375 diameters.
pub const BRINELL: f64 = 9.80665e6 / 0.9635;

/// The same per Vickers number: under a pyramid, whose faces stand 68° from its axis.
pub const VICKERS: f64 = 9.80665e6 / 0.92718;

impl Material {
    /// Steel, which stands for metals where nothing is said.
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
        // Coats: diamond-like carbon, titanium nitride, chromium nitride.
        Self::of("dlc", 200e9, 0.22, Some(20e9)),
        Self::of("tin", 450e9, 0.25, Some(22e9)),
        Self::of("crn", 300e9, 0.25, Some(18e9)),
    ];

    const fn of(
        name: &'static str,
        youngs_modulus: f64,
        poissons_ratio: f64,
        hardness: Option<f64>,
    ) -> Self {
        Self { name, youngs_modulus, poissons_ratio, hardness }
    }

    /// The material of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Self> {
        const ALL: &[Material] = &Material::ALL;
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
        assert_eq!(Material::named("stone"), None);
        Ok(())
    }
}
