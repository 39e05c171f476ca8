//! Profiles: heights along a line, which become one row of nodes.

use super::fault::Fault;
use super::raw::Channel;
use crate::number::counted;

/// How far positions of even steps may be off, in steps.
const EVEN: f64 = 1e-3;

/// One row of nodes at even steps, in metres. A profile has no width: its cells are square until a side along y is
/// given.
pub(super) fn channel(values: Vec<f64>, step: f64) -> Channel {
    Channel {
        understood: understood(values.len()),
        ..Channel::in_metres((values.len(), 1), values, Some((step, step)))
    }
}

/// How a profile of an instrument was understood.
pub(super) fn understood(points: usize) -> String {
    format!("a profile of {}", counted(points, "point"))
}

/// Whether numbers that are known are not all the same.
pub(super) fn varies(numbers: &[f64]) -> bool {
    let mut known = numbers.iter().filter(|number| number.is_finite());
    let first = known.next();
    known.any(|number| Some(number) != first)
}

/// How far along their line points are, from one to the next; steps back against its direction are negative.
pub(super) fn along(x: &[f64], y: &[f64]) -> Vec<f64> {
    let whole = |places: &[f64]| match (places.first(), places.last()) {
        (Some(first), Some(last)) => last - first,
        _ => 0.0,
    };
    let (whole_x, whole_y) = (whole(x), whole(y));
    let mut place = 0.0;
    let mut before = x.first().copied().zip(y.first().copied());
    let points = x.iter().copied().zip(y.iter().copied());
    points
        .map(|(x, y)| {
            let (dx, dy) =
                before.map_or((0.0, 0.0), |(before_x, before_y)| (x - before_x, y - before_y));
            before = Some((x, y));
            place += (dx * dx + dy * dy).sqrt().copysign(dx * whole_x + dy * whole_y);
            place
        })
        .collect()
}

/// Heights at even steps, and the step: those of the file if its steps are even, otherwise between them on straight
/// lines.
pub(super) fn on_even_steps(
    mut positions: Vec<f64>,
    mut values: Vec<f64>,
    notes: &mut Vec<String>,
) -> Result<(Vec<f64>, f64), Fault> {
    let ends = |positions: &[f64]| match (positions.first(), positions.last()) {
        (Some(first), Some(last)) => (*first, *last),
        _ => (0.0, 0.0),
    };
    let (first, last) = ends(&positions);
    if first > last {
        positions.reverse();
        values.reverse();
    }
    for (k, pair) in (2..).zip(positions.windows(2)) {
        let [before, after] = pair else { continue };
        ensure!(
            before < after,
            "positions of a profile rise or fall from row to row, but row {k} has {after} behind {before}"
        );
    }
    let (first, last) = ends(&positions);
    let step = (last - first) / (positions.len() - 1) as f64;
    ensure!(
        step > 0.0 && step.is_finite(),
        "positions of a profile from {first} to {last} have no steps"
    );
    let off = |(k, position): (usize, &f64)| ((position - first) / step - k as f64).abs();
    let worst = positions.iter().enumerate().map(off).fold(0.0, f64::max);
    if worst <= EVEN {
        return Ok((values, step));
    }
    notes.push(format!(
        "steps of the profile are uneven: positions are up to {worst:.3} steps off even ones, on which heights are interpolated linearly"
    ));
    let mut behind = 0;
    let at = |k: usize| {
        let position = first + k as f64 * step;
        // The interval that has it, from the one before on.
        while behind + 2 < positions.len()
            && positions.get(behind + 1).is_some_and(|next| *next < position)
        {
            behind += 1;
        }
        let point = |k: usize| Some((*positions.get(k)?, *values.get(k)?));
        match (point(behind), point(behind + 1)) {
            // A missing height is no matter of its neighbours.
            (Some((x, z)), _) if position <= x => z,
            (_, Some((next_x, next_z))) if position >= next_x => next_z,
            (Some((x, z)), Some((next_x, next_z))) => {
                z + (position - x) / (next_x - x) * (next_z - z)
            }
            _ => f64::NAN,
        }
    };
    Ok(((0..values.len()).map(at).collect(), step))
}
