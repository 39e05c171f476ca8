//! Numbers on the command line, refused where they make no sense.

/// A length or a modulus.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    let value = number(text)?;
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err("must be positive and finite".to_string())
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

fn number(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| "not a number".to_string())
}

/// A unit of length.
pub(crate) fn unit(text: &str) -> Result<asperity::io::LengthUnit, asperity::SurfaceError> {
    text.parse()
}
