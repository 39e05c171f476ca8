//! A quantity at every event.

use serde_json::{Value, json};

use crate::blob::differences;

/// Numbers are kept as whole multiples of this in their logarithm: half of it is how far they are off, relatively. A
/// page prints five digits.
const STEP: f64 = 2e-5;
/// The same for a quantity with negative values, relative to the greatest.
const PART: f64 = 1e-7;
/// What stands for zero, for infinity, and for no number.
const ZERO: i32 = i32::MAX;
const INFINITE: i32 = i32::MAX - 1;
const NOTHING: i32 = i32::MAX - 2;

/// A quantity in SI units.
pub(crate) fn quantity(unit: &str, values: &[f64]) -> Value {
    let least = values.iter().copied().fold(0.0, f64::min);
    let (scale, step) = match least < 0.0 {
        false => ("logarithmic", STEP),
        true => ("linear", PART * values.iter().map(|value| value.abs()).fold(0.0, f64::max)),
    };
    let code = |&value: &f64| match value {
        value if value.is_nan() => NOTHING,
        value if value.is_infinite() => INFINITE,
        0.0 => ZERO,
        value if least < 0.0 => (value / step).round() as i32,
        value => (value.ln() / step).round() as i32,
    };
    let codes: Vec<i32> = values.iter().map(code).collect();
    json!({"unit": unit, "scale": scale, "step": step, "values": differences(&codes)})
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
