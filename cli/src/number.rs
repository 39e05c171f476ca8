//! Numbers for people: powers of ten and SI prefixes.

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

/// A quantity with up to `digits` significant digits and an SI prefix.
pub fn quantity(value: f64, unit: &str, digits: usize) -> String {
    let (scale, unit) = prefixed(unit, value);
    let scaled = value / scale;
    let whole = scaled.abs().max(1.0).log10().floor() as usize + 1;
    let text = format!("{scaled:.*}", digits.saturating_sub(whole));
    let short = match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => &text,
    };
    format!("{short} {unit}")
}

/// The power of ten of the SI prefix that suits numbers up to `greatest`, and the unit with it: a
/// prefix from femto to peta, or a power of ten beyond those.
pub(crate) fn prefixed(unit: &str, greatest: f64) -> (f64, String) {
    const PREFIXES: [&str; 11] = ["f", "p", "n", "µ", "m", "", "k", "M", "G", "T", "P"];
    if greatest == 0.0 || !greatest.is_finite() {
        return (1.0, unit.to_string());
    }
    let thousands = ((greatest.abs().log10() + 1e-9) / 3.0).floor() as i32;
    let scale = 10_f64.powi(3 * thousands);
    let prefix = usize::try_from(thousands + 5)
        .ok()
        .and_then(|index| PREFIXES.get(index));
    match prefix {
        Some(prefix) => (scale, format!("{prefix}{unit}")),
        None => (scale, format!("{} {unit}", power_of_ten(3 * thousands))),
    }
}
