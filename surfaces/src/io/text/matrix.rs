//! A text whose rows are those of the map.

use super::header::Header;
use super::table::Table;
use crate::io::bytes::shape;
use crate::io::fault::Fault;
use crate::io::raw::Channel;

/// Row iy of the text holds the nodes (·, iy).
pub(super) fn channel(header: Header, table: Table) -> Result<Channel, Fault> {
    let (columns, rows) = (table.columns as u64, table.rows() as u64);
    let shape = shape(columns, rows)?;
    let (cell, lateral_unit) = header.cell(shape)?;
    let mut values = table.values;
    header.apply(&mut values);
    Ok(Channel {
        name: header.title,
        height_unit: header.value_unit,
        lateral_unit,
        ..Channel::in_metres(shape, values, cell)
    })
}
