//! Warnings: input and results that are allowed and look wrong.

use std::fmt;

use crate::surface::{self, Topography};

/// Something that a person should look at: most often a unit that was mistaken. Nothing is refused because of it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// Something about a surface.
    Surface(surface::Warning),
    /// Contact of patches that the grid does not resolve.
    SmallPatches {
        /// Number of patches.
        patches: usize,
        /// Nodes in contact.
        contact_nodes: usize,
    },
    /// A composite modulus that no two bodies have.
    Modulus {
        /// Composite modulus \[Pa\].
        e_star: f64,
    },
    /// A pressure that metals do not bear elastically.
    HighPressure {
        /// The greatest pressure \[Pa\].
        pressure: f64,
        /// Composite modulus \[Pa\].
        e_star: f64,
    },
}

/// Nodes that patches have on average, if they are resolved.
const PATCH: f64 = 10.0;
/// Pressure over composite modulus: metals yield at a hardness of some 0.01 to 0.03, and glass at 0.1.
const HIGH: f64 = 0.02;
/// Moduli of solids lie between that of soft rubber and that of diamond \[Pa\].
const SOLIDS: std::ops::RangeInclusive<f64> = 1e6..=2e12;

impl Warning {
    /// Warnings about a surface.
    #[must_use]
    pub fn of_surface(surface: &Topography) -> Vec<Self> {
        let warnings = surface::Warning::of_surface(surface);
        warnings.into_iter().map(Self::Surface).collect()
    }

    /// Warnings about the patches of a contact.
    #[must_use]
    pub fn of_patches(patches: usize, contact_nodes: usize) -> Option<Self> {
        ((contact_nodes as f64) < PATCH * patches as f64)
            .then_some(Self::SmallPatches { patches, contact_nodes })
    }

    /// Warnings about a composite modulus.
    #[must_use]
    pub fn of_modulus(e_star: f64) -> Option<Self> {
        (!SOLIDS.contains(&e_star)).then_some(Self::Modulus { e_star })
    }

    /// Warnings about the greatest pressure of a contact.
    #[must_use]
    pub fn of_pressure(pressure: f64, e_star: f64) -> Option<Self> {
        (pressure > HIGH * e_star).then_some(Self::HighPressure { pressure, e_star })
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Surface(warning) => warning.fmt(f),
            Self::SmallPatches { patches, contact_nodes } => write!(
                f,
                "patches of contact have {:.1} nodes on average. Those of fewer than some ten nodes are not resolved: \
                 contact area and greatest pressure depend on the mesh",
                contact_nodes as f64 / patches as f64
            ),
            Self::Modulus { e_star } if e_star > *SOLIDS.end() => write!(
                f,
                "E* = {} is above that of diamond: is the modulus in Pa?",
                pascals(e_star)
            ),
            Self::Modulus { e_star } => {
                write!(f, "E* = {} is softer than rubber", pascals(e_star))?;
                let units = [(1e9, "GPa"), (1e6, "MPa")];
                let fits = |(factor, _): &&(f64, &str)| SOLIDS.contains(&(e_star * factor));
                match units.iter().find(fits) {
                    Some((factor, unit)) => write!(
                        f,
                        ": if the modulus was given in {unit}, it is {}",
                        pascals(factor * e_star)
                    ),
                    None => write!(f, ": is the modulus in Pa?"),
                }
            }
            Self::HighPressure { pressure, e_star } => write!(
                f,
                "the greatest pressure is {}, {} of E* = {}. The model is elastic; \
                 metals yield at some 0.01 to 0.03 of E*",
                pascals(pressure),
                // Nobody reads a hundred digits.
                match pressure / e_star {
                    ratio if ratio < 1e3 => format!("{ratio:.3}"),
                    ratio => format!("{ratio:.1e}"),
                },
                pascals(e_star)
            ),
        }
    }
}

/// A pressure in the unit in which it is read easily.
fn pascals(value: f64) -> String {
    let units = [(1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa"), (1.0, "Pa")];
    let fits = |(unit, _): &&(f64, &str)| (1.0..1e3).contains(&(value / unit));
    match units.iter().find(fits) {
        Some((unit, name)) => {
            let number = value / unit;
            // Four digits.
            let decimals = if number < 10.0 {
                3
            } else if number < 100.0 {
                2
            } else {
                1
            };
            format!("{number:.decimals$} {name}")
        }
        None => format!("{value:.3e} Pa"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Text that has room for so many bytes.
    struct Room(usize);

    impl fmt::Write for Room {
        fn write_str(&mut self, text: &str) -> fmt::Result {
            self.0 = self.0.checked_sub(text.len()).ok_or(fmt::Error)?;
            Ok(())
        }
    }

    /// Wherever its text ends too early, a warning that does not fit says so.
    #[test]
    fn a_warning_that_does_not_fit_is_an_error() {
        use fmt::Write;
        let (pressure, e_star) = (60.0, 115.0);
        for warning in [
            Warning::Surface(surface::Warning::Smooth { rms_height: 1e-13 }),
            Warning::SmallPatches { patches: 3, contact_nodes: 7 },
            Warning::Modulus { e_star },
            Warning::Modulus { e_star: 1e-9 },
            Warning::Modulus { e_star: 1e13 },
            Warning::HighPressure { pressure, e_star },
        ] {
            let length = warning.to_string().len();
            for room in 0..length {
                assert!(write!(Room(room), "{warning}").is_err(), "{room} of {length}");
            }
            assert!(write!(Room(length), "{warning}").is_ok());
        }
    }

    #[test]
    fn pressures_that_metals_do_not_bear_are_noticed() {
        assert_eq!(Warning::of_pressure(2e9, 115e9), None);
        let high = Warning::of_pressure(2.5e9, 115e9).map(|warning| warning.to_string());
        assert!(high.is_some_and(|text| text.contains("2.500 GPa, 0.022 of E*")));
    }

    #[test]
    fn moduli_in_other_units_are_noticed() {
        for e_star in [2.3e6, 115e9, 1.2e12] {
            assert_eq!(Warning::of_modulus(e_star), None);
        }
        for (e_star, said) in [
            (230.8, "in GPa, it is 230.8 GPa"),
            (230_769.0, "in MPa, it is 230.8 GPa"),
            (1e-9, "is the modulus in Pa?"),
            (2.3e13, "above that of diamond"),
        ] {
            let found = Warning::of_modulus(e_star).map(|warning| warning.to_string());
            assert!(found.as_ref().is_some_and(|text| text.contains(said)), "{found:?}");
        }
    }

    #[test]
    fn patches_of_few_nodes_are_noticed() {
        assert_eq!(Warning::of_patches(0, 0), None);
        assert_eq!(Warning::of_patches(3, 30), None);
        let few = Warning::of_patches(3, 29).map(|warning| warning.to_string());
        assert!(few.is_some_and(|text| text.contains("have 9.7 nodes on average")));
    }
}
