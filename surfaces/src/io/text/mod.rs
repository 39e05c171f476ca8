//! Text: rows of numbers, and lists of points.
//!
//! Rows of a matrix are those of an image, and node (ix, iy) is in column ix of row iy: the transpose of an array `[ix, iy]`
//! in `.npy`. Lists have a point x, y, z in each row; they make a map if the points lie on a regular grid, on
//! which some may be absent.
//!
//! Numbers are parted by blanks, tabs, `;` or commas, with a decimal point, or a comma where something else parts them.
//! Empty cells, `NaN`, `BAD`, `***` and the like are missing. Of the header those lines are understood that Gwyddion writes
//! over a matrix or a list, in the languages it speaks, and names of columns with units.
//!
//! A list is told from a matrix of three columns by the header, by the extension `.xyz`, or by its coordinates.

mod axes;
mod dialect;
mod header;
mod markers;
mod matrix;
mod names;
mod points;
mod quotes;
mod table;
mod words;
mod wyko;
mod zygo;

use std::path::Path;

use self::axes::Axes;
use self::header::Header;
use self::names::Columns;
use self::table::Table;
use super::fault::Fault;
use super::lines::Lines;
use super::raw::{Channel, Parsed};

/// Most rows of a matrix with fewer than four columns that nothing but its looks says to be one.
const FEW_ROWS: usize = 3;

/// Whether bytes could be text: no zeros, and hardly any other control characters, in the first 64 KiB.
pub(super) fn looks_like(bytes: &[u8]) -> bool {
    let begin = bytes.get(..1 << 16).unwrap_or(bytes);
    if is_utf16(begin) {
        return true;
    }
    let controls =
        begin.iter().filter(|byte| byte.is_ascii_control() && !byte.is_ascii_whitespace()).count();
    !begin.contains(&0) && controls * 100 <= begin.len()
}

fn is_utf16(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff")
}

pub(super) fn parse(file: &[u8], path: &Path) -> Parsed {
    ensure!(!is_utf16(file), "it is encoded as UTF-16: save it as UTF-8");
    let mark = "\u{feff}".as_bytes();
    let skipped = if file.starts_with(mark) { mark.len() } else { 0 };
    let text = quotes::removed(file);
    let lines = Lines::new(&text, skipped);
    if lines.rest().starts_with(wyko::BEGINS) {
        return wyko::parse(lines);
    }
    if lines.rest().starts_with(zygo::BEGINS) {
        return zygo::parse(lines);
    }
    let (header, table) = table::read(lines)?;
    let is_xyz = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("xyz"));
    let channel = generic(&header, table, is_xyz)?;
    let understood = channel.understood + &header.unread();
    Ok(vec![Channel { name: header.title, understood, ..channel }])
}

/// The map in a table: a list of points if anything says so, otherwise a matrix.
fn generic(header: &Header, mut table: Table, is_xyz: bool) -> Result<Channel, Fault> {
    let names = header.names.as_deref();
    if let Some(columns) = names.map(|names| Columns::named(names, &table)).transpose()?.flatten() {
        return list(header, &columns, &table);
    }
    ensure!(
        !header.ends_with_names,
        "the line '{}' above the numbers names columns, but not the {} that there are",
        names.unwrap_or_default(),
        table.columns
    );
    let is_matrix = header.has_sides();
    let mut axes = Axes::default();
    if table.columns > 3 || is_matrix {
        axes = axes::take(&mut table)?;
    }
    if is_matrix || axes.is_matrix {
        return matrix::channel(header, axes, table);
    }
    let first = Columns::first("in the first three columns");
    let with_axes = |channel: Channel| Channel {
        notes: axes.notes.iter().cloned().chain(channel.notes).collect(),
        ..channel
    };
    if header.lateral_unit.is_some() || is_xyz {
        return list(header, &first, &table).map(with_axes);
    }
    if table.columns == 3 && table.rows() > FEW_ROWS {
        let found = list(header, &first, &table).map(with_axes);
        return found.map_err(|fault| fault.prefixed(UNDECLARED));
    }
    // No heights are coordinates of a grid, each once, by chance.
    if (4..=MOST_COLUMNS).contains(&table.columns) && table.rows() > table.columns {
        let found = list(header, &first, &table).ok();
        if let Some(found) = found.filter(|found| found.values.len() == table.rows()) {
            return Ok(with_axes(found));
        }
    }
    ensure!(
        table.columns > 3 || table.rows() <= FEW_ROWS,
        "{} rows of {} numbers are a profile; a surface is a matrix of at least four columns, or a list of points \
         x, y, z; lines '# Width: 1 mm' and '# Height: 1 mm' make it a matrix",
        table.rows(),
        table.columns
    );
    matrix::channel(header, axes, table)
}

/// The map of a list of points.
fn list(header: &Header, columns: &Columns, table: &Table) -> Result<Channel, Fault> {
    let mut channel = points::channel(columns, table)?;
    let [x, y, z] = &columns.units;
    for (of, name, head) in [("heights", z, &header.value_unit), ("x", x, &header.lateral_unit)] {
        if let (Some(name), Some(head)) = (name, head) {
            ensure!(
                name == head,
                "of {of}, the name of the column says '{name}', but the header '{head}'"
            );
        }
    }
    channel.height_unit = z.clone().or_else(|| header.value_unit.clone());
    channel.lateral_unit = header.lateral_unit.clone();
    if x.is_some() || y.is_some() {
        // Coordinates in two units have none in common, unless both are lengths.
        let ratio = header::ratio(y.as_ref(), x.as_ref());
        channel.cell = channel.cell.map(|(dx, dy)| (dx, dy * ratio.unwrap_or(1.0)));
        channel.lateral_unit = x.clone().filter(|_| ratio.is_some());
    }
    if table.columns > 3 {
        let [x, y, z] = [columns.x, columns.y, columns.z].map(|column| column + 1);
        channel
            .notes
            .push(format!("of {} columns {x}, {y} and {z} are read, as x, y, z", table.columns));
    }
    header.apply(&mut channel.values, &mut channel.notes);
    Ok(channel)
}

/// Most columns of a list of points without a name.
const MOST_COLUMNS: usize = 8;

/// What is said of three columns with a defect, of which nothing says that they are points.
const UNDECLARED: &str = "three columns are taken for points x, y, z unless lines '# Width: 1 mm' and \
    '# Height: 1 mm' say that they are a matrix: ";

#[cfg(test)]
mod tests;
