//! Four panels of a contact that is loaded and goes back, with a curve each way.

use asperity_cli::axis::Axis;
use asperity_cli::chart::{BLUE, ORANGE, Series, Style, head_room};
use asperity_cli::half_space::is_of_mean_planes;
use asperity_cli::panel::{Area, Drawn};
use plotters::prelude::*;

use super::job::Job;
use super::sheet;

/// Room at the upper end of an axis.
const ROOM: f64 = 0.06;

/// A quantity of a state: its name, its unit, and what it is.
pub(super) type Quantity<S> = (&'static str, &'static str, fn(&S) -> f64);

/// The states of a way, and its name.
pub(super) type Way<'a, S> = (&'a [S], &'static str);

/// The approach, named as its body has it.
pub(super) fn approach<S>(job: &Job, has_stiffness: bool, of: fn(&S) -> f64) -> Quantity<S> {
    let name = match is_of_mean_planes(job.periodic(), has_stiffness) {
        false => "approach δ",
        true => "approach of the mean planes",
    };
    (name, "m", of)
}

/// Draws the second of each pair of quantities over the first, there and back, with a legend in the first panel.
pub(super) fn panels<DB: DrawingBackend, S>(
    area: &Area<DB>,
    pairs: [(Quantity<S>, Quantity<S>); 4],
    ways: [Way<'_, S>; 2],
) -> Drawn<DB> {
    for (place, (x, y)) in (0_i32..).zip(pairs) {
        let panel = sheet::panel(place);
        let has_legend = place == 0;
        let above = if has_legend { head_room(ways.len()) } else { ROOM };
        let (horizontal, vertical) = (axis(x, ways, ROOM), axis(y, ways, above));
        panel.rule(area, &horizontal, &vertical)?;
        let curves = ways.into_iter().zip([BLUE, ORANGE]);
        let curves = curves.filter(|((states, _), _)| !states.is_empty());
        for ((states, name), colour) in curves.clone() {
            let points = states.iter().map(|state| ((x.2)(state), (y.2)(state)));
            let curve = Series::new(name, colour, Style::Line, points);
            curve.draw(area, &panel, (&horizontal, &vertical))?;
        }
        if has_legend {
            sheet::legend(area, &panel, curves.map(|((_, name), colour)| (colour, name)))?;
        }
        panel.frame(area, &horizontal, &vertical)?;
    }
    area.present()
}

fn axis<S>((name, unit, quantity): Quantity<S>, ways: [Way<'_, S>; 2], room: f64) -> Axis {
    let values = || {
        let states = ways.into_iter().flat_map(|(states, _)| states);
        states.map(quantity).filter(|value| value.is_finite())
    };
    let (low, high) = (values().fold(0.0, f64::min), values().fold(0.0, f64::max));
    // A mean gap that is to be zero may be off by rounding.
    let low = if low < -1e-6 * high { low } else { 0.0 };
    Axis::linear(name, unit, low, high).with_room(if low < 0.0 { 0.05 } else { 0.0 }, room)
}
