//! A quantity at every event.

use serde_json::{Value, json};

use crate::blob::differences;

/// Numbers are kept as whole multiples of this in their logarithm: half of it is how far they are off, relatively. A
/// page prints five digits.
const STEP: f64 = 2e-5;
/// What stands for zero, for infinity, and for no number.
const ZERO: i32 = i32::MAX;
const INFINITE: i32 = i32::MAX - 1;
const NOTHING: i32 = i32::MAX - 2;

/// A quantity in SI units. Where some of its values are negative, logarithms of magnitudes are counted from the least
/// one, as 1, with the sign of the value.
pub(crate) fn quantity(unit: &str, values: &[f64]) -> Value {
    let is_signed = values.iter().any(|value| *value < 0.0);
    let sizes = values.iter().map(|value| value.abs()).filter(|size| size.is_normal());
    let least = if is_signed { sizes.fold(f64::MAX, f64::min).ln() } else { 0.0 };
    let steps = |size: f64| ((size.ln() - least) / STEP).round() as i32;
    let code = |&value: &f64| match value {
        value if value.is_nan() => NOTHING,
        value if value.is_infinite() => INFINITE,
        0.0 => ZERO,
        value if is_signed => (1 + steps(value.abs()).max(0)) * value.signum() as i32,
        value => steps(value),
    };
    let codes: Vec<i32> = values.iter().map(code).collect();
    let scale = if is_signed { "signed" } else { "logarithmic" };
    json!({
        "unit": unit,
        "scale": scale,
        "step": STEP,
        "least": least,
        "values": differences(&codes),
    })
}

/// A quantity that not every path has: nothing if no event has it.
pub(crate) fn optional(unit: &str, values: &[Option<f64>]) -> Option<Value> {
    let has = values.iter().any(Option::is_some);
    let values: Vec<f64> = values.iter().map(|value| value.unwrap_or(f64::NAN)).collect();
    has.then(|| quantity(unit, &values))
}

/// A number of things.
pub(crate) fn count(values: &[usize]) -> Value {
    let values: Vec<i32> = values.iter().map(|&value| value as i32).collect();
    json!({"unit": "", "scale": "whole", "step": 1, "values": differences(&values)})
}
