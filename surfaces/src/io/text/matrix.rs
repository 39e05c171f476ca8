//! A text whose rows are those of the map.

use super::axes::Axes;
use super::header::{self, Header};
use super::table::Table;
use crate::io::bytes::shape;
use crate::io::fault::Fault;
use crate::io::raw::Channel;
use crate::number::counted;

/// Row iy of the text holds the nodes (·, iy).
pub(super) fn channel(header: &Header, axes: Axes, table: Table) -> Result<Channel, Fault> {
    let (columns, rows) = (table.columns as u64, table.rows() as u64);
    let shape = shape(columns, rows)?;
    if let Some(line) = table.second_block {
        bail!(
            "line {line} follows an empty line: the lines before it and from it on may be two maps; a text has to hold one only, \
             without empty lines in it"
        );
    }
    header.check_shape(shape)?;
    let mut notes = axes.notes;
    let (mut cell, mut lateral_unit) = header.cell(shape)?;
    match &mut cell {
        Some(cell) => notes.extend(header.fit_to_steps(cell, shape, axes.steps)),
        None => {
            let [of_x, of_y] = header.side_units();
            let ratio = header::ratio(of_y, of_x);
            cell = axes.cell.map(|(dx, dy)| (dx, dy * ratio.unwrap_or(1.0)));
            lateral_unit = of_x.filter(|_| ratio.is_some()).cloned();
        }
    }
    let mut note_of_side = table.margins.filter(|_| columns > 1).map(|margins| {
        format!(
            "the side along x is that of the {columns} columns that are read: {margins} not counted, unless NaN is \
             written there"
        )
    });
    if header.has_sides() {
        notes.extend(note_of_side.take());
    }
    let told = table.told();
    let mut values = table.values;
    notes.extend(header.lone_side());
    header.remove_marks(&mut values, &mut notes);
    Ok(Channel {
        height_unit: header.value_unit.clone(),
        lateral_unit,
        understood: format!("{} of {}, {told}", counted(rows, "row"), counted(columns, "height")),
        note_of_side,
        notes,
        ..Channel::in_metres(shape, values, cell)
    })
}
