//! Numbers as the page writes them.

use asperity_studies::spread::Spread;

/// A signed number with so many decimals.
pub(crate) fn signed(value: f64, decimals: usize) -> String {
    format!("{value:.decimals$}").replace('-', "−")
}

/// A fraction in per cent.
pub(crate) fn percent(value: f64, decimals: usize) -> String {
    signed(100.0 * value, decimals)
}

/// A number as m × 10ⁿ.
pub(crate) fn scientific(value: f64, digits: usize) -> String {
    asperity_cli::number::scientific(value, digits).replace('-', "−")
}

/// A spread in other units.
pub(crate) fn scaled(spread: Spread, factor: f64) -> Spread {
    Spread { mean: spread.mean * factor, deviation: spread.deviation * factor.abs() }
}

/// A range of areas.
pub(crate) fn areas(range: Option<(f64, f64)>) -> String {
    range
        .map_or("none".to_string(), |(from, to)| format!("{:.1}–{:.0} %", 100.0 * from, 100.0 * to))
}

/// Names with commas and a last "and".
pub(crate) fn list(names: &[String]) -> String {
    match names {
        [] => "none".to_string(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}
