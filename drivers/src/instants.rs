//! When something happens in a history that comes back to where it was, and what.

use crate::draw::Draw;

/// What is drawn is no less.
const LEAST: f64 = 1e-250;

/// What loads, approaches and times are parts of.
pub(crate) struct Scale {
    pub(crate) load: f64,
    pub(crate) approach: f64,
    pub(crate) time: f64,
}

/// How long a step is.
pub(crate) fn duration(draw: &mut Draw<'_>, unit: f64, last: f64) -> f64 {
    match draw.whole(0, 7) {
        0 | 1 => 0.0,
        2 => last,
        3 => unit * draw.decades(-12.0, -3.0),
        4 if draw.once_in(4) => unit * draw.decades(2.0, 9.0),
        _ => unit * draw.decades(-3.0, 1.0),
    }
}

/// One of these values, one near them, none, or that of a knot; `None` for any other.
pub(crate) fn value(draw: &mut Draw<'_>, values: [f64; 2], knots: &[f64]) -> Option<f64> {
    let [earlier, now] = values;
    let value = match draw.whole(0, 9) {
        0 => earlier,
        1 => now,
        2 => earlier.next_up(),
        3 => earlier.next_down(),
        4 => now * (1.0 - draw.decades(-15.0, -3.0)),
        5 => 0.0,
        6 => *knots.get(draw.whole(0, knots.len().max(1) - 1))?,
        _ => return None,
    };
    // Numbers that have lost their digits are none.
    Some(if value.abs() < LEAST { 0.0 } else { value })
}
