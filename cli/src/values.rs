//! Numbers on the command line, with or without a unit, refused where they make no sense.

use asperity::SurfaceError;
use asperity::io::{LengthUnit, TextLayout};
use asperity::material::HardnessScale;

/// What is measured, and the units in which a command line may give it. A bare number is in SI units.
pub(crate) struct Dimension {
    name: &'static str,
    /// Each unit as [`plain`] leaves it, in SI units; the first one is that of the SI.
    units: &'static [(&'static str, f64)],
}

/// A length: these, and all that a file may have.
pub(crate) const LENGTH: Dimension =
    Dimension { name: "length", units: &[("m", 1.0), ("mm", 1e-3), ("µm", 1e-6), ("nm", 1e-9)] };
/// A pressure, a modulus, a stress.
pub(crate) const PRESSURE: Dimension = Dimension {
    name: "pressure",
    units: &[
        ("Pa", 1.0),
        ("mPa", 1e-3),
        ("kPa", 1e3),
        ("MPa", 1e6),
        ("GPa", 1e9),
        ("N/m2", 1.0),
        ("N/mm2", 1e6),
        ("kN/mm2", 1e9),
        ("mbar", 1e2),
        ("bar", 1e5),
        ("psi", PSI),
        ("ksi", 1e3 * PSI),
    ],
};
/// A force.
pub(crate) const FORCE: Dimension = Dimension {
    name: "force",
    units: &[
        ("N", 1.0),
        ("nN", 1e-9),
        ("µN", 1e-6),
        ("mN", 1e-3),
        ("kN", 1e3),
        ("MN", 1e6),
        ("kgf", KILOGRAM_FORCE),
        ("lbf", POUND_FORCE),
    ],
};
/// A time.
pub(crate) const TIME: Dimension = Dimension {
    name: "time",
    units: &[
        ("s", 1.0),
        ("µs", 1e-6),
        ("ms", 1e-3),
        ("min", 60.0),
        ("h", 3600.0),
        ("d", 86400.0),
        ("years", 31_557_600.0),
        ("year", 31_557_600.0),
        ("y", 31_557_600.0),
    ],
};
/// A work of adhesion.
pub(crate) const SURFACE_ENERGY: Dimension = Dimension {
    name: "work of adhesion",
    units: &[
        ("J/m2", 1.0),
        ("mJ/m2", 1e-3),
        ("µJ/m2", 1e-6),
        ("N/m", 1.0),
        ("mN/m", 1e-3),
        ("erg/cm2", 1e-3),
    ],
};
/// A dynamic viscosity.
pub(crate) const VISCOSITY: Dimension = Dimension {
    name: "viscosity",
    units: &[("Pas", 1.0), ("mPas", 1e-3), ("µPas", 1e-6), ("cP", 1e-3)],
};
/// An electrical resistivity.
pub(crate) const RESISTIVITY: Dimension = Dimension {
    name: "resistivity",
    units: &[("Ohmm", 1.0), ("µOhmm", 1e-6), ("nOhmm", 1e-9), ("µOhmcm", 1e-8)],
};
/// A thermal conductivity.
pub(crate) const CONDUCTIVITY: Dimension = Dimension {
    name: "thermal conductivity",
    units: &[("W/mK", 1.0), ("mW/mK", 1e-3), ("W/m/K", 1.0), ("mW/mmK", 1.0)],
};
/// An angle \[°\].
pub(crate) const ANGLE: Dimension = Dimension {
    name: "angle",
    units: &[("°", 1.0), ("deg", 1.0), ("rad", 180.0 / std::f64::consts::PI)],
};
/// An area.
pub(crate) const AREA: Dimension = Dimension {
    name: "area",
    units: &[("m2", 1.0), ("cm2", 1e-4), ("mm2", 1e-6), ("µm2", 1e-12), ("nm2", 1e-18)],
};
/// A part of a whole.
pub(crate) const SHARE: Dimension = Dimension { name: "fraction", units: &[("%", 1e-2)] };
/// Memory in bytes.
const MEMORY: Dimension = Dimension {
    name: "memory",
    units: &[
        ("B", 1.0),
        ("kB", 1e3),
        ("MB", 1e6),
        ("GB", 1e9),
        ("TB", 1e12),
        ("MiB", 1_048_576.0),
        ("GiB", 1_073_741_824.0),
    ],
};

/// Of a pound and a kilogram, by definition.
const POUND_FORCE: f64 = 4.448_221_615_260_5;
const KILOGRAM_FORCE: f64 = 9.806_65;
const PSI: f64 = POUND_FORCE / (0.0254 * 0.0254);

impl Dimension {
    /// A number above zero.
    pub(crate) fn positive(&'static self) -> impl Parser {
        |text| checked(self.read(text)?, |value| value > 0.0, "must be positive and finite")
    }

    /// A number that may be zero.
    pub(crate) fn not_negative(&'static self) -> impl Parser {
        |text| checked(self.read(text)?, |value| value >= 0.0, "must be finite and not negative")
    }

    /// A number of any sign.
    pub(crate) fn any(&'static self) -> impl Parser {
        |text| checked(self.read(text)?, |_| true, "must be finite")
    }

    /// In SI units.
    fn read(&self, text: &str) -> Result<f64, String> {
        let (number, unit) = split(text)?;
        let factor = self.factor(unit);
        let factor = factor.ok_or_else(|| format!("'{unit}' is no unit of {}", self.in_words()))?;
        scaled(number, factor)
    }

    /// `length (m, mm, µm, nm)`.
    fn in_words(&self) -> String {
        let units: Vec<&str> = self.units.iter().map(|(name, _)| *name).collect();
        format!("{} ({})", self.name, units.join(", "))
    }

    /// A unit in SI units, `None` if it is none. Case decides between two, as mN and MN, and M is never milli.
    fn factor(&self, unit: &str) -> Option<f64> {
        if unit.is_empty() {
            return Some(1.0);
        }
        if self.name == LENGTH.name {
            let any_case = || unit.to_lowercase().parse().ok().filter(|_| unit != "Mm");
            return unit.parse().ok().or_else(any_case).map(LengthUnit::metres);
        }
        let unit = plain(unit);
        let is_mega = |name: &str| unit.starts_with('M') && name.starts_with('m');
        let found = |is: &dyn Fn(&str) -> bool| {
            let mut found = self.units.iter().filter(|(name, _)| is(name));
            found.next().filter(|_| found.next().is_none())
        };
        found(&|name| name == unit)
            .or_else(|| found(&|name| name.eq_ignore_ascii_case(&unit) && !is_mega(name)))
            .map(|(_, factor)| *factor)
    }
}

/// A dimension, and what is made of its values.
type Kind<T> = (&'static Dimension, fn(f64) -> T);

/// A number above zero of any of these dimensions; without a unit, of the first.
pub(crate) fn any_of<T>(text: &str, kinds: &[Kind<T>]) -> Result<T, String> {
    let (_, unit) = split(text)?;
    let found = kinds.iter().find(|(dimension, _)| dimension.factor(unit).is_some());
    let (dimension, made) = found.ok_or_else(|| {
        let names: Vec<_> = kinds.iter().map(|(dimension, _)| dimension.in_words()).collect();
        format!("'{unit}' is no unit of {}", names.join(" or "))
    })?;
    dimension.positive()(text).map(made)
}

/// A function that clap reads a value with.
pub(crate) trait Parser:
    Fn(&str) -> Result<f64, String> + Clone + Send + Sync + 'static
{
}

impl<F: Fn(&str) -> Result<f64, String> + Clone + Send + Sync + 'static> Parser for F {}

fn checked(value: f64, is: fn(f64) -> bool, otherwise: &str) -> Result<f64, String> {
    if value.is_finite() && is(value) { Ok(value) } else { Err(otherwise.to_string()) }
}

/// The number that a text begins with, and what is left.
fn split(text: &str) -> Result<(&str, &str), String> {
    let text = text.trim();
    let ends = text.char_indices().map(|(at, _)| at).chain([text.len()]);
    let end = ends.rev().find(|end| text[..*end].trim_end().parse::<f64>().is_ok());
    let (number, unit) = text.split_at(end.ok_or("not a number")?);
    if unit.starts_with(',') {
        return Err(format!("'{text}' has a comma: write a decimal point"));
    }
    Ok((number.trim_end(), unit.trim_start()))
}

/// A unit without what it may be written with: `Pa·s` and `Pa s` are `Pas`, `N/mm^2` is `N/mm2`, `uN` is `µN`.
fn plain(unit: &str) -> String {
    let mut plain = String::new();
    for (k, c) in unit.chars().filter(|c| !" ·*()_^".contains(*c)).enumerate() {
        match c {
            'u' | '\u{3bc}' if k == 0 => plain.push('µ'),
            'Ω' | '\u{2126}' => plain.push_str("Ohm"),
            '²' => plain.push('2'),
            _ => plain.push(c),
        }
    }
    plain
}

/// A number in a unit. A power of ten moves the point and does not round: 1.024 mm are the number that is written
/// 1.024e-3.
fn scaled(number: &str, unit: f64) -> Result<f64, String> {
    let not_a_number = |_| "not a number".to_string();
    let power = unit.log10().round() as i32;
    if 10_f64.powi(power) != unit {
        return number.parse().map(|value: f64| value * unit).map_err(|_| not_a_number(()));
    }
    let (digits, exponent) = number.split_once(['e', 'E']).unwrap_or((number, "0"));
    let exponent: i32 = exponent.parse().map_err(|_| not_a_number(()))?;
    format!("{digits}e{}", exponent.saturating_add(power)).parse().map_err(|_| not_a_number(()))
}

/// A hardness \[Pa\], as a pressure or as a number of Brinell, Vickers or Rockwell. Numbers of the test are passed
/// over: 700HV10.
pub(crate) fn hardness(text: &str) -> Result<f64, String> {
    let (number, unit) = split(text)?;
    let symbol = unit.trim_end_matches(|c: char| c.is_ascii_digit() || "./ ".contains(c));
    match HardnessScale::named(symbol) {
        Some(scale) => scale.pascals(scaled(number, 1.0)?).map_err(|error| error.to_string()),
        None if PRESSURE.factor(unit).is_none() => {
            Err(format!("'{unit}' is no unit of {} or hardness (HB, HV, HRC)", PRESSURE.in_words()))
        }
        None => PRESSURE.positive()(text),
    }
}

/// A number without a unit, above zero.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    checked(number(text)?, |value| value > 0.0, "must be positive and finite")
}

/// A Poisson's ratio.
pub(crate) fn poisson(text: &str) -> Result<f64, String> {
    let is = |value| value > -1.0 && value <= 0.5;
    checked(number(text)?, is, "a Poisson's ratio must be above -1 and at most 1/2")
}

/// A number of bytes.
pub(crate) fn bytes(text: &str) -> Result<usize, String> {
    // Beyond all there are it is the greatest.
    MEMORY.positive()(text).map(|bytes| bytes as usize)
}

/// A part of an area.
pub(crate) fn fraction(text: &str) -> Result<f64, String> {
    let is = |value| value > 0.0 && value <= 1.0;
    checked(SHARE.read(text)?, is, "a fraction must be above 0 and at most 1 (10% is 0.1)")
}

/// A part that is not all.
pub(crate) fn part(text: &str) -> Result<f64, String> {
    let is = |value| value > 0.0 && value < 1.0;
    checked(SHARE.read(text)?, is, "must be above 0 and below 1 (1% is 0.01)")
}

/// A Hurst exponent.
pub(crate) fn hurst(text: &str) -> Result<f64, String> {
    let is = |value| value > 0.0 && value <= 1.0;
    checked(number(text)?, is, "a Hurst exponent must be above 0 and at most 1")
}

pub(crate) fn number(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_| "not a number".to_string())
}

/// How the numbers of a text are arranged.
pub(crate) fn layout(text: &str) -> Result<TextLayout, SurfaceError> {
    text.parse()
}

/// A unit of length.
pub(crate) fn unit(text: &str) -> Result<LengthUnit, SurfaceError> {
    text.parse()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each unit by itself, as it is written by hand, and exactly: the numbers are those that Rust reads.
    #[test]
    fn numbers_may_have_units() {
        let cases: [(&'static Dimension, &[(&str, f64)]); 9] = [
            (
                &LENGTH,
                &[
                    ("1.024e-3", 1.024e-3),
                    ("1.024mm", 1.024e-3),
                    ("0.3 um", 0.3e-6),
                    ("0.3\u{3bc}m", 0.3e-6),
                    ("3 micrometer", 3e-6),
                    ("1in", 0.0254),
                    ("7e3 nm", 7e-6),
                ],
            ),
            (
                &PRESSURE,
                &[
                    ("5e6", 5e6),
                    ("5MPa", 5e6),
                    ("5 mPa", 5e-3),
                    ("2.3GPA", 2.3e9),
                    ("1 N/mm²", 1e6),
                    ("1bar", 1e5),
                    ("1psi", 6_894.757_293_168_361),
                ],
            ),
            (&FORCE, &[("1.5kN", 1500.0), ("3 mN", 3e-3), ("3MN", 3e6), ("2uN", 2e-6)]),
            (&TIME, &[("2h", 7200.0), ("90 min", 5400.0), ("0.1s", 0.1), ("5ms", 5e-3)]),
            (
                &VISCOSITY,
                &[
                    ("1e-3", 1e-3),
                    ("1 mPa·s", 1e-3),
                    ("1 mPa s", 1e-3),
                    ("0.1Pa*s", 0.1),
                    ("18uPa·s", 18e-6),
                ],
            ),
            (&RESISTIVITY, &[("1.7 uOhm cm", 1.7e-8), ("17nΩ·m", 17e-9)]),
            (&CONDUCTIVITY, &[("50 W/(m K)", 50.0), ("26mW/mK", 0.026)]),
            (&ANGLE, &[("30", 30.0), ("30°", 30.0), ("3.141592653589793rad", 180.0)]),
            (&SHARE, &[("0.1", 0.1), ("10%", 0.1), ("12.5 %", 0.125)]),
        ];
        for (dimension, texts) in cases {
            for (text, value) in texts {
                assert_eq!(dimension.positive()(text), Ok(*value), "{text}");
            }
        }
        assert_eq!(bytes("2GB"), Ok(2_000_000_000));
        assert_eq!(bytes("1e30"), Ok(usize::MAX));
    }

    /// What is no number, no unit of this kind, or not decided by its case.
    #[test]
    fn other_units_are_refused() {
        let refused: [(&'static Dimension, &[&str]); 8] = [
            (
                &PRESSURE,
                &[
                    "", "MPa", "1Mbar", "5mm", "5mpa", "5 Pa s", "0Pa", "-1MPa", "nan", "infPa",
                    "1e999",
                ],
            ),
            (&LENGTH, &["5MPa", "1A/m", "1,5mm", "--1", "1e-3e", "µm", "24 Mm"]),
            (&FORCE, &["5mn", "5Pa"]),
            (&TIME, &["1Ms"]),
            (&SURFACE_ENERGY, &["1 MJ/m2", "1MN/m"]),
            (&VISCOSITY, &["1 MPa s"]),
            (&CONDUCTIVITY, &["1MW/(m K)"]),
            (&AREA, &["1Mm2"]),
        ];
        for (dimension, texts) in refused {
            for text in texts {
                assert!(dimension.positive()(text).is_err(), "{text}");
            }
        }
        assert_eq!(PRESSURE.not_negative()("0"), Ok(0.0));
        assert_eq!(ANGLE.any()("-45°"), Ok(-45.0));
        assert!(ANGLE.any()("inf").is_err());
        for (text, words) in [("5mm", "'mm' is no unit of pressure (Pa, "), ("x", "not a number")] {
            let error = PRESSURE.positive()(text).err().unwrap_or_default();
            assert!(error.contains(words), "{error}");
        }
    }

    #[test]
    fn hardness_is_a_pressure_or_a_number() {
        let number =
            |scale: HardnessScale, number| scale.pascals(number).map_err(|e| e.to_string());
        for (text, pascals) in [
            ("2.5e9", Ok(2.5e9)),
            ("2.5GPa", Ok(2.5e9)),
            ("250hb", number(HardnessScale::Brinell, 250.0)),
            ("250 HBW 10/3000", number(HardnessScale::Brinell, 250.0)),
            ("700HV10", number(HardnessScale::Vickers, 700.0)),
            ("60HRC", number(HardnessScale::RockwellC, 60.0)),
        ] {
            assert_eq!(hardness(text), pascals, "{text}");
        }
        for text in ["", "HB", "0", "-1HV", "70HRC", "NaN", "infHB", "60HRB"] {
            assert!(hardness(text).is_err(), "{text}");
        }
        for unit in ["HR", "GpA x"] {
            assert!(
                hardness(&format!("62{unit}")).is_err_and(|told| told.contains("HRC")),
                "{unit}"
            );
        }
    }

    /// One quantity in two units, by the definitions of these: equal to the last bit, as both are rounded once.
    #[test]
    fn units_have_their_definitions() {
        let cases: [(&'static Dimension, &[[&str; 2]]); 9] = [
            (&LENGTH, &[["1in", "25.4mm"], ["1e6 nm", "1mm"]]),
            (
                &PRESSURE,
                &[
                    ["1ksi", "1000psi"],
                    ["1kN/mm²", "1GPa"],
                    ["1bar", "1000 mbar"],
                    ["10bar", "1 N/mm2"],
                ],
            ),
            (&FORCE, &[["1kgf", "9.80665N"], ["1lbf", "4.4482216152605N"]]),
            (&TIME, &[["1d", "24h"], ["1 year", "365.25 d"], ["1000ms", "1s"]]),
            (&SURFACE_ENERGY, &[["1 erg/cm²", "1mJ/m²"], ["1mN/m", "1000µJ/m2"]]),
            (&VISCOSITY, &[["1cP", "1mPa·s"], ["1000 cP", "1 Pa s"]]),
            (&RESISTIVITY, &[["1µΩ cm", "10nΩ m"]]),
            (&CONDUCTIVITY, &[["1 W/(m K)", "1mW/(mm K)"]]),
            (&AREA, &[["1cm²", "100mm²"], ["1mm2", "1e6 µm2"], ["1 um²", "1e6nm²"]]),
        ];
        for (dimension, pairs) in cases {
            for [one, other] in pairs {
                let found = dimension.positive()(one);
                assert!(found.is_ok(), "{one}: {found:?}");
                assert_eq!(found, dimension.positive()(other), "{one} and {other}");
            }
        }
        for (text, number) in [("1GiB", 1 << 30), ("1.5kB", 1500), ("1gb", 1_000_000_000)] {
            assert_eq!(bytes(text), Ok(number), "{text}");
        }
    }

    /// The ends of what is allowed, and what lies beyond them.
    #[test]
    fn parts_and_ratios_have_bounds() {
        type Reader = fn(&str) -> Result<f64, String>;
        type Case = (Reader, &'static [(&'static str, f64)], &'static [&'static str]);
        let cases: [Case; 5] = [
            (
                part,
                &[("0.01", 0.01), ("1%", 0.01), ("99.9 %", 0.999)],
                &["0", "1", "100%", "2", "-0.1", "nan", "inf", "1mm", ""],
            ),
            (hurst, &[("0.8", 0.8), ("1", 1.0)], &["0", "1.000001", "-0.5", "nan", "80%", ""]),
            (
                fraction,
                &[("1", 1.0), ("100%", 1.0), ("0.5 %", 5e-3), ("1e-300", 1e-300)],
                &["0", "0%", "-0.1", "1.000001", "100.1%", "nan", "inf", "10mm", "%", ""],
            ),
            (
                poisson,
                &[("0.5", 0.5), ("0", 0.0), ("-0.999", -0.999)],
                &["-1", "0.500001", "nan", "inf", "0.3%", ""],
            ),
            (positive, &[(" 1e-300 ", 1e-300)], &["0", "-1", "nan", "inf", "1Pa"]),
        ];
        for (read, allowed, refused) in cases {
            for (text, value) in allowed {
                assert_eq!(read(text), Ok(*value), "{text}");
            }
            for text in refused {
                assert!(read(text).is_err(), "{text}");
            }
        }
    }
}
