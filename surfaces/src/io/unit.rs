//! Units of length, as files and people write them.

use std::fmt;
use std::str::FromStr;

use crate::{Error, FileError};

/// A unit of length.
///
/// ```
/// use asperity_surfaces::io::LengthUnit;
///
/// # fn main() -> Result<(), asperity_surfaces::Error> {
/// let unit: LengthUnit = "µm".parse()?;
/// assert_eq!(unit.metres(), 1e-6);
/// assert!("V".parse::<LengthUnit>().is_err());
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LengthUnit {
    symbol: &'static str,
    metres: f64,
}

/// How each unit is written, beginning with its symbol, and its length \[m\]. µ is U+00B5 or U+03BC.
const UNITS: [(&[&str], f64); 9] = [
    (&["m", "metre", "meter", "metres", "meters"], 1.0),
    (&["cm"], 1e-2),
    (&["mm", "millimetre", "millimeter", "millimetres", "millimeters"], 1e-3),
    (
        &[
            "µm",
            "\u{3bc}m",
            "um",
            "micron",
            "microns",
            "micrometre",
            "micrometer",
            "micrometres",
            "micrometers",
        ],
        1e-6,
    ),
    (&["nm", "nanometre", "nanometer", "nanometres", "nanometers"], 1e-9),
    (&["pm"], 1e-12),
    (&["fm"], 1e-15),
    (&["Å", "\u{212b}", "A", "Angstrom", "angstrom"], 1e-10),
    (&["in", "inch", "inches"], 0.0254),
];

impl LengthUnit {
    /// The metre.
    pub const METRE: Self = Self { symbol: "m", metres: 1.0 };

    /// The unit that a file writes so, `None` if it is no length: A may be Å to a person, but is the ampere in a file.
    pub(super) fn in_file(text: &str) -> Option<Self> {
        text.parse().ok().filter(|_| text.trim() != "A")
    }

    /// Its length \[m\].
    #[must_use]
    pub fn metres(self) -> f64 {
        self.metres
    }

    /// How it is written.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        self.symbol
    }
}

/// A unit as a file gives it, behind what its numbers are multiplied by.
pub(super) fn with_factor(factor: f64, unit: &str) -> String {
    if factor == 1.0 { unit.to_string() } else { format!("{factor:?} {unit}") }
}

impl FromStr for LengthUnit {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        UNITS
            .iter()
            .find(|(names, _)| names.contains(&text.trim()))
            .map(|(names, metres)| Self { symbol: names[0], metres: *metres })
            .ok_or_else(|| Error::File(FileError::NoLength { unit: text.to_string() }))
    }
}

impl fmt::Display for LengthUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.symbol)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every spelling is read, and written by its symbol; the lengths are those of the SI and of the inch.
    #[test]
    fn units_are_written_by_their_symbol() -> Result<(), Error> {
        let known = [
            ("meters", "m", 1.0),
            (" cm ", "cm", 1e-2),
            ("mm", "mm", 1e-3),
            ("micrometer", "µm", 1e-6),
            ("\u{3bc}m", "µm", 1e-6),
            ("nm", "nm", 1e-9),
            ("pm", "pm", 1e-12),
            ("fm", "fm", 1e-15),
            ("Angstrom", "Å", 1e-10),
            ("inch", "in", 25.4e-3),
        ];
        for (text, symbol, metres) in known {
            let unit: LengthUnit = text.parse()?;
            assert_eq!(unit.to_string(), symbol);
            assert_eq!((unit.symbol(), unit.metres()), (symbol, metres));
        }
        assert!(matches!(
            "V".parse::<LengthUnit>(),
            Err(Error::File(FileError::NoLength { unit })) if unit == "V"
        ));
        Ok(())
    }
}
