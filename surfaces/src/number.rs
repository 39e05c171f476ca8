//! Numbers for people: powers of ten and SI prefixes.

use std::fmt::Display;

/// A number as m × 10ⁿ with `digits` significant digits.
pub fn scientific(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_string();
    }
    if !value.is_finite() {
        return value.to_string();
    }
    let text = format!("{value:.*e}", digits.saturating_sub(1));
    match text.split_once('e') {
        Some((mantissa, "0")) => mantissa.to_string(),
        Some((mantissa, exponent)) => format!("{mantissa} × 10{}", superscript(exponent)),
        None => text,
    }
}

/// 10ⁿ.
pub fn power_of_ten(exponent: i32) -> String {
    match exponent {
        0 => "1".to_string(),
        1 => "10".to_string(),
        _ => format!("10{}", superscript(&exponent.to_string())),
    }
}

fn superscript(number: &str) -> String {
    number
        .chars()
        .map(|digit| match digit {
            '-' => '⁻',
            '0' => '⁰',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            '4' => '⁴',
            '5' => '⁵',
            '6' => '⁶',
            '7' => '⁷',
            '8' => '⁸',
            '9' => '⁹',
            other => other,
        })
        .collect()
}

/// A quantity with up to `digits` significant digits and an SI prefix, or a power of ten where there is none.
pub fn quantity(value: f64, unit: &str, digits: usize) -> String {
    // Rounded before the prefix is chosen: 999.9996 of something are 1 thousand.
    let rounded = round(value, digits);
    match prefix(rounded).filter(|_| !is_power_of_length(unit)) {
        Some((scale, prefix)) => format!("{} {prefix}{unit}", plain(rounded / scale, digits)),
        None => format!("{} {unit}", short(rounded, digits)),
    }
}

/// Whether a unit is one of area, volume or flow, which takes no prefix: a fm³ would be (fm)³.
pub fn is_power_of_length(unit: &str) -> bool {
    ["m²", "m³", "m⁴"].iter().any(|power| unit.starts_with(power))
}

/// So many things, by the name of one: `1 state`, `2 states`.
pub fn counted(count: impl Display, of_one: &str) -> String {
    let count = count.to_string();
    let ending = match (count.as_str(), of_one.ends_with("ch")) {
        ("1", _) => "",
        (_, true) => "es",
        (_, false) => "s",
    };
    format!("{count} {of_one}{ending}")
}

/// A power of ten, rounded once; subnormal ones as well, and the least number for what is below them.
fn ten_to(power: i32) -> f64 {
    let parsed: f64 = format!("1e{power}").parse().unwrap_or(f64::NAN);
    parsed.max(f64::from_bits(1))
}

/// A number for a command line with so many significant digits, not below the value: what must be enough is rounded up.
pub fn at_least(value: f64, digits: usize) -> String {
    let text = format!("{value:.*e}", digits.saturating_sub(1));
    match text.parse::<f64>() {
        Ok(rounded) if rounded < value => {
            // A unit in the last place more; its own rounding is far below that.
            let unit = ten_to(value.abs().log10().floor() as i32 + 1 - digits as i32);
            format!("{:.*e}", digits.saturating_sub(1), rounded + unit)
        }
        _ => text,
    }
}

/// An area with up to `digits` significant digits, in m² or the square of a shorter length.
pub fn area(value: f64, digits: usize) -> String {
    let (scale, unit) = area_unit(value);
    let rounded = round(value / scale, digits);
    let text = if rounded == 0.0 || (1e-3..1e6).contains(&rounded.abs()) {
        plain(rounded, digits)
    } else {
        short(rounded, digits)
    };
    format!("{text} {unit}")
}

/// A unit that suits areas up to `greatest`, in m², and its name.
pub fn area_unit(greatest: f64) -> (f64, &'static str) {
    const UNITS: [(f64, &str); 4] = [(1.0, "m²"), (1e-6, "mm²"), (1e-12, "µm²"), (1e-18, "nm²")];
    let fits = |(unit, _): &&(f64, &str)| greatest.abs() >= 0.01 * unit;
    match UNITS.iter().find(fits) {
        Some(unit) => *unit,
        None if greatest == 0.0 => UNITS[0],
        None => UNITS[3],
    }
}

/// A number with so many significant digits for a table: as it is written by hand, or with a power of ten far from 1.
pub fn significant(value: f64, digits: usize) -> String {
    let size = value.abs();
    if value == 0.0 || (1e-3..1e6).contains(&size) {
        let rounded = round(value, digits);
        format!("{rounded:.*}", decimals(rounded, digits))
    } else {
        format!("{value:.*e}", digits.saturating_sub(1))
    }
}

fn round(value: f64, digits: usize) -> f64 {
    let text = format!("{value:.*e}", digits.saturating_sub(1));
    text.parse().unwrap_or(value)
}

/// Places after the point that a number with so many digits has.
fn decimals(value: f64, digits: usize) -> usize {
    let place = if value == 0.0 { 0.0 } else { value.abs().log10().floor() };
    (digits as f64 - 1.0 - place).max(0.0) as usize
}

/// A number with up to so many significant digits, without zeros behind the point.
pub fn plain(value: f64, digits: usize) -> String {
    let text = format!("{value:.*}", decimals(value, digits));
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_string(),
        false => text,
    }
}

/// As m × 10ⁿ without zeros at the end of m.
fn short(value: f64, digits: usize) -> String {
    let text = scientific(value, digits);
    match text.split_once(" × ") {
        Some((m, power)) if m.contains('.') => {
            let m = m.trim_end_matches('0').trim_end_matches('.');
            format!("{m} × {power}")
        }
        _ => text,
    }
}

/// The scale and the name of the prefix, from femto to peta, that suits a number.
fn prefix(value: f64) -> Option<(f64, &'static str)> {
    const PREFIXES: [&str; 11] = ["f", "p", "n", "µ", "m", "", "k", "M", "G", "T", "P"];
    if value == 0.0 {
        return Some((1.0, ""));
    }
    let thousands = thousands(value)?;
    let place = usize::try_from(thousands + 5).ok()?;
    Some((ten_to(3 * thousands), PREFIXES.get(place)?))
}

/// How many times a number has the factor 1000, `None` if it has no end.
fn thousands(value: f64) -> Option<i32> {
    let size = value.abs().log10();
    size.is_finite().then(|| ((size + 1e-9) / 3.0).floor() as i32)
}

/// The power of ten of the SI prefix that suits numbers up to `greatest`, and the unit with it: a
/// prefix from femto to peta, or a power of ten beyond those.
pub fn prefixed(unit: &str, greatest: f64) -> (f64, String) {
    if let Some((scale, prefix)) = prefix(greatest) {
        return (scale, format!("{prefix}{unit}"));
    }
    match thousands(greatest) {
        Some(thousands) => {
            let power = power_of_ten(3 * thousands);
            (ten_to(3 * thousands), format!("{power} {unit}"))
        }
        None => (1.0, unit.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_are_written_as_an_engineer_would() {
        for (value, text) in [
            (0.0, "0 Pa"),
            (115.384_615e9, "115.4 GPa"),
            (-2.5e-3, "-2.5 mPa"),
            (999.96e3, "1 MPa"),
            (1e99, "1 × 10⁹⁹ Pa"),
            (-4.9438e-15, "-4.944 fPa"),
            (-4.9438e-16, "-4.944 × 10⁻¹⁶ Pa"),
            (f64::INFINITY, "inf Pa"),
            (f64::NAN, "NaN Pa"),
        ] {
            assert_eq!(quantity(value, "Pa", 4), text);
        }
        // A prefix would be raised to the same power.
        assert_eq!(quantity(4.2281e-15, "m³", 4), "4.228 × 10⁻¹⁵ m³");
        assert_eq!(quantity(2e3, "m³/s", 4), "2 × 10³ m³/s");
    }

    #[test]
    fn one_is_no_plural() {
        let told = [0_u64, 1, 2].map(|count| [counted(count, "state"), counted(count, "patch")]);
        assert_eq!(
            told,
            [["0 states", "0 patches"], ["1 state", "1 patch"], ["2 states", "2 patches"]]
        );
    }

    #[test]
    fn what_must_be_enough_is_rounded_up() {
        for (value, text) in [
            (10.0 / 3.0, "3.3334e0"),
            (3.500_000_000_000_000_4, "3.5001e0"),
            (3.5, "3.5000e0"),
            (9.999_96, "1.0000e1"),
            (9.999_91, "1.0000e1"),
            (1.234_51e-9, "1.2346e-9"),
            (0.0, "0.0000e0"),
            (f64::INFINITY, "inf"),
        ] {
            let told = at_least(value, 5);
            assert_eq!(told, text);
            assert!(told.parse().is_ok_and(|told: f64| told >= value), "{value}");
        }
        let mut value = 1e-20;
        while value < 1e20 {
            for digits in 1..8 {
                let told = at_least(value, digits);
                let told: f64 = told.parse().unwrap_or(f64::NAN);
                let unit = ten_to(1 - digits as i32);
                assert!(told >= value && told <= value * (1.0 + unit), "{value} {told}");
            }
            value *= 1.037;
        }
    }

    #[test]
    fn areas_have_squares_of_lengths() {
        for (value, text) in [
            (0.0, "0 m²"),
            (1.0, "1 m²"),
            (1e-4, "100 mm²"),
            (3.2e-6, "3.2 mm²"),
            (4.340_277e-8, "0.0434 mm²"),
            (2.5e-10, "250 µm²"),
            (4e-20, "0.04 nm²"),
            (1e-30, "1 × 10⁻¹² nm²"),
            (1e12, "1 × 10¹² m²"),
        ] {
            assert_eq!(area(value, 4), text);
        }
    }

    #[test]
    fn numbers_of_tables_have_their_digits() {
        for (value, text) in [
            (0.0, "0.000"),
            (12.345_6, "12.35"),
            (9999.6, "10000"),
            (0.012_345_6, "0.01235"),
            (1.5e-7, "1.500e-7"),
            (-3e9, "-3.000e9"),
        ] {
            assert_eq!(significant(value, 4), text);
        }
    }
}
