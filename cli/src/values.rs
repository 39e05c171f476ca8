//! Numbers on the command line, refused where they make no sense.

use asperity::material::{BRINELL, VICKERS};

/// A length or a modulus.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    let value = number(text)?;
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err("must be positive and finite".to_string())
    }
}

/// A length or a coefficient that may be zero.
pub(crate) fn not_negative(text: &str) -> Result<f64, String> {
    let value = number(text)?;
    if value >= 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err("must be finite and not negative".to_string())
    }
}

/// A Poisson's ratio.
pub(crate) fn poisson(text: &str) -> Result<f64, String> {
    let value = number(text)?;
    if value > -1.0 && value <= 0.5 {
        Ok(value)
    } else {
        Err("a Poisson's ratio must be above -1 and at most 1/2".to_string())
    }
}

/// A number of bytes, which may be given as `2e9`.
pub(crate) fn bytes(text: &str) -> Result<usize, String> {
    // Beyond all there are it is the greatest.
    positive(text).map(|bytes| bytes as usize)
}

/// A part of an area.
pub(crate) fn fraction(text: &str) -> Result<f64, String> {
    let value = number(text)?;
    if value > 0.0 && value <= 1.0 {
        Ok(value)
    } else {
        Err("a fraction must be above 0 and at most 1 (10 % is 0.1)".to_string())
    }
}

/// A hardness \[Pa\], as a pressure or as a Brinell or Vickers number.
pub(crate) fn hardness(text: &str) -> Result<f64, String> {
    let scaled = |number: &str, pascals: f64| positive(number.trim()).map(|value| value * pascals);
    if let Some(number) = text.strip_suffix("HB") {
        scaled(number, BRINELL)
    } else if let Some(number) = text.strip_suffix("HV") {
        scaled(number, VICKERS)
    } else {
        positive(text)
    }
}

pub(crate) fn number(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| "not a number".to_string())
}

/// How the numbers of a text are arranged.
pub(crate) fn layout(text: &str) -> Result<asperity::io::TextLayout, asperity::SurfaceError> {
    text.parse()
}

/// A unit of length.
pub(crate) fn unit(text: &str) -> Result<asperity::io::LengthUnit, asperity::SurfaceError> {
    text.parse()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ball that has sunk in 0.375 of its diameter wide: the cap has the area `2 (1 − √(1 − x²)) / x²` times its circle.
    #[test]
    fn hardness_is_a_pressure() {
        let x: f64 = 0.375;
        let cap = 2.0 * (1.0 - (1.0 - x * x).sqrt()) / (x * x);
        for (text, pascals) in [
            ("2.5e9", 2.5e9),
            ("250HB", 250.0 * 9.80665e6 * cap),
            ("250 HV", 250.0 * 9.80665e6 / 68_f64.to_radians().sin()),
        ] {
            let found = hardness(text).unwrap_or_default();
            assert!((found / pascals - 1.0).abs() < 1e-3, "{text}: {found:e} {pascals:e}");
        }
        for text in ["", "HB", "0", "-1HV", "60HRC", "NaN", "infHB"] {
            assert!(hardness(text).is_err(), "{text}");
        }
    }
}
