//! Golden sections.

/// The greatest value of a function that has one maximum in an interval, and its place.
pub fn greatest(f: impl Fn(f64) -> f64, (mut from, mut to): (f64, f64)) -> (f64, f64) {
    let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..60 {
        let (low, high) = (to - ratio * (to - from), from + ratio * (to - from));
        if f(low) > f(high) { to = high } else { from = low }
    }
    let place = 0.5 * (from + to);
    (f(place), place)
}
