//! A text with a profile: a height in every row, or a position and a height.

use super::header::Header;
use super::names;
use super::table::Table;
use crate::io::bytes::shape;
use crate::io::fault::Fault;
use crate::io::raw::Channel;
use crate::number::counted;

/// How far positions of even steps may be off, in steps.
const EVEN: f64 = 1e-3;

/// One row of nodes. A profile has no width: its cells are square until a side along y is given.
pub(super) fn channel(header: &Header, table: Table) -> Result<Channel, Fault> {
    let count = table.rows();
    let shape = shape(count as u64, 1)?;
    let [of_x, of_z] = names::of_profile(header, &table).unwrap_or_default();
    let told = table.told();
    let mut notes = Vec::new();
    let (mut values, positions) = match table.columns {
        2 => {
            let pairs = table.values.chunks_exact(2);
            let place = |pair: &[f64], k: usize| pair.get(k).copied().unwrap_or(f64::NAN);
            let positions: Vec<f64> = pairs.clone().map(|pair| place(pair, 0)).collect();
            (pairs.map(|pair| place(pair, 1)).collect(), Some(positions))
        }
        _ => (table.values, None),
    };
    header.apply(&mut values, &mut notes);
    let of_map = header.of_map();
    notes.extend(of_map.map(|line| {
        format!("'{line}' is a line of maps, but names say that the columns are a profile")
    }));
    let mut cell = None;
    if let Some(positions) = positions {
        let step;
        (values, step) = on_even_steps(positions, values, &mut notes)?;
        cell = Some((step, step));
    }
    let of_what = if cell.is_some() { "a position and a height" } else { "a height" };
    Ok(Channel {
        height_unit: of_z.or_else(|| header.value_unit.clone()),
        lateral_unit: of_x
            .or_else(|| header.lateral_unit.clone())
            .or_else(|| header.side_unit.clone()),
        understood: format!(
            "a profile of {}, {of_what} in each row, {told}",
            counted(count, "point")
        ),
        notes,
        ..Channel::in_metres(shape, values, cell)
    })
}

/// Heights at even steps, and the step: those of the file if its steps are even, otherwise between them on straight
/// lines.
fn on_even_steps(
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
