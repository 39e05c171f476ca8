//! A text with a profile: a height in every row, or a position and a height.

use super::header::Header;
use super::names::{self, OfProfile};
use super::table::Table;
use crate::io::bytes::shape;
use crate::io::fault::Fault;
use crate::io::profile::on_even_steps;
use crate::io::raw::Channel;
use crate::number::counted;

/// One row of nodes. A profile has no width: its cells are square until a side along y is given.
pub(super) fn channel(header: &Header, table: Table) -> Result<Channel, Fault> {
    let count = table.rows();
    let shape = shape(count as u64, 1)?;
    let named = names::of_profile(header, &table).unwrap_or_default();
    let OfProfile { units: [of_x, of_z], is_turned } = named;
    let [lateral_unit, height_unit] = header.units([of_x.as_ref(), of_z.as_ref()])?;
    let told = table.told();
    let mut notes = Vec::new();
    let (mut values, positions) = match table.columns {
        2 => {
            let pairs = table.values.chunks_exact(2);
            let place = |pair: &[f64], k: usize| pair.get(k).copied().unwrap_or(f64::NAN);
            let [of_position, of_height] = if is_turned { [1, 0] } else { [0, 1] };
            let positions: Vec<f64> = pairs.clone().map(|pair| place(pair, of_position)).collect();
            (pairs.map(|pair| place(pair, of_height)).collect(), Some(positions))
        }
        _ => (table.values, None),
    };
    header.remove_marks(&mut values, &mut notes);
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
    let of_what = match (cell, is_turned) {
        (None, _) => "a height",
        (Some(_), false) => "a position and a height",
        (Some(_), true) => "a height and a position",
    };
    Ok(Channel {
        height_unit,
        lateral_unit,
        understood: format!(
            "a profile of {}, {of_what} in each row, {told}",
            counted(count, "point")
        ),
        notes,
        ..Channel::in_metres(shape, values, cell)
    })
}
