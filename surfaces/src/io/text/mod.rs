//! Text: rows of numbers, and lists of points.
//!
//! Rows of a matrix are those of an image, and node (ix, iy) is in column ix of row iy: the transpose of an array `[ix,
//! iy]` in `.npy`. Lists have a point x, y, z in each row; they make a map if the points lie on a regular grid, on
//! which some may be absent.
//!
//! Numbers are parted by blanks, tabs, `;` or commas, with a decimal point, or a comma where something else parts them.
//! Empty cells, `NaN`, `BAD`, `***` and the like are missing. Of the header those lines are understood that Gwyddion
//! writes over a matrix or a list, in the languages it speaks, and names of columns with units.
//!
//! One column, or two, in more than three rows are a profile, which becomes one row of nodes, unless a line above them
//! is one that only maps have.
//!
//! A list is known by names of its columns, by the extension `.xyz`, or by its coordinates; positions in the first row
//! and column of a matrix by their even steps. Where numbers can be read in several ways, the user has to say which is
//! meant.

mod arrangement;
mod axes;
mod dialect;
mod header;
mod layout;
mod markers;
mod matrix;
mod names;
mod points;
mod profile;
mod quotes;
mod run;
mod table;
mod words;
mod wyko;
mod zygo;

use std::path::Path;

use self::arrangement::{Found, List};
use self::header::Header;
pub use self::layout::TextLayout;
use self::names::Columns;
use self::table::Table;
use super::fault::Fault;
use super::lines::Lines;
use super::raw::{Channel, Parsed};

/// Whether bytes could be text: no zeros, and hardly any other control characters, in the first 64 KiB.
pub(super) fn looks_like(bytes: &[u8]) -> bool {
    let bytes = without_end_of_file(bytes);
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

/// A text without the byte that ends one on DOS. Blanks before it may be cells.
fn without_end_of_file(mut text: &[u8]) -> &[u8] {
    while let Some(before) = text.trim_ascii_end().strip_suffix(b"\x1a") {
        text = before;
    }
    text
}

pub(super) fn parse(file: &[u8], path: &Path, layout: Option<TextLayout>) -> Parsed {
    let file = without_end_of_file(file);
    ensure!(!is_utf16(file), "it is encoded as UTF-16: save it as UTF-8");
    let mark = "\u{feff}".as_bytes();
    let skipped = if file.starts_with(mark) { mark.len() } else { 0 };
    let (text, commas) = quotes::removed(file);
    let lines = Lines::new(&text, skipped);
    let begins = |with: &[u8]| lines.rest().starts_with(with);
    ensure!(
        !begins(zygo::NOT_READ),
        "it is a 'Zygo ASCII Data File', which is not read: export it as .dat or as a 'Zygo XYZ Data File'"
    );
    if begins(wyko::BEGINS) {
        return laid_out(wyko::parse(lines)?, layout);
    }
    if begins(zygo::BEGINS) {
        return laid_out(zygo::parse(lines)?, layout);
    }
    let (header, table) = table::read(lines)?;
    commas.check(&table)?;
    let is_xyz = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("xyz"));
    let channel = generic(&header, table, is_xyz, layout)?;
    let understood = channel.understood + &header.unread();
    let factor = header.factor.unwrap_or(1.0);
    Ok(vec![Channel { name: header.title, factor, understood, mask: header.mask, ..channel }])
}

/// The maps of a text of known layout, with what is said of another one.
fn laid_out(mut channels: Vec<Channel>, layout: Option<TextLayout>) -> Parsed {
    if let Some(layout) = layout {
        let note = format!(
            "the layout '{layout}' is not used: this kind of text says itself how it is laid out"
        );
        channels.iter_mut().for_each(|channel| channel.notes.push(note.clone()));
    }
    Ok(channels)
}

/// The map in a table: as the user says, as the names of its columns do, or as its numbers do.
fn generic(
    header: &Header,
    mut table: Table,
    is_xyz: bool,
    layout: Option<TextLayout>,
) -> Result<Channel, Fault> {
    ensure!(
        layout.is_some() || table.margins.is_none() || table.rows() > arrangement::FEW_ROWS,
        "every line ({} in all) begins or ends with an empty cell: whether that is a node without a height cannot be told from so few; \
         without such cells, or with `ReadOptions::layout`, it is read",
        table.rows()
    );
    if layout.is_none_or(|layout| layout == TextLayout::Points) {
        let names = header.names.as_deref();
        if let Some(columns) =
            names.map(|names| Columns::named(names, &table)).transpose()?.flatten()
        {
            table.drop_empty_end();
            let map = points::map(&columns, &table)?;
            return list(header, Box::new((columns, map)), &table);
        }
        ensure!(
            !header.ends_with_names || names::of_profile(header, &table).is_some(),
            "the line '{}' above the numbers names columns, but not one of the {} that there are as x, one as y and one \
             as the height",
            header::shown(names.unwrap_or_default()),
            table.columns
        );
    }
    if names::of_profile(header, &table).is_some() {
        table.drop_empty_end();
    }
    // Of commas a layout says nothing.
    ensure!(
        !table.dialect.has_one_comma || table.columns != 2,
        "each line has one comma: two numbers, or one with a decimal comma; part columns by ';', or write decimal points"
    );
    if let Some(doubt) = table.dialect.doubt {
        bail!("{doubt}; part columns by ';', or write decimal points");
    }
    let is_list = is_xyz || header.lateral_unit.is_some();
    let is_asked = layout.is_some();
    let found = match layout {
        None => arrangement::of(header, &table, is_list)?,
        Some(TextLayout::Points) => Found::Points(arrangement::points(&table)?),
        Some(matrix) => Found::Matrix(matrix),
    };
    let layout = match found {
        Found::Points(points) => return list(header, points, &table),
        Found::Profile => return profile::channel(header, table),
        Found::Matrix(layout) => layout,
    };
    let mut axes = axes::take(&mut table, layout)?;
    // What the user has said need not be noticed, but may be told.
    let told = if is_asked { std::mem::take(&mut axes.notes) } else { Vec::new() };
    let channel = matrix::channel(header, axes, table)?;
    let understood = std::iter::once(channel.understood.clone()).chain(told).collect::<Vec<_>>();
    Ok(Channel { understood: understood.join("; "), ..channel })
}

/// The map of a list of points.
fn list(header: &Header, list: List, table: &Table) -> Result<Channel, Fault> {
    ensure!(
        header.mask.is_none(),
        "the header says that a mask follows, as it does a matrix alone"
    );
    let (columns, map) = *list;
    let mut channel = map.channel()?;
    let [x, y, z] = columns.units.each_ref().map(Option::as_ref);
    let [of_x, of_y] = header.side_units();
    // The unit of y in a line of its own is another than that of x.
    let [x, y] = if of_x == of_y { [x, y] } else { [x.or(of_x), y.or(of_y)] };
    [channel.lateral_unit, channel.height_unit] = header.units([x, z])?;
    if x.is_some() || y.is_some() {
        // Coordinates in two units have none in common, unless both are lengths.
        let ratio = header::ratio(y, x);
        channel.cell = channel.cell.map(|(dx, dy)| (dx, dy * ratio.unwrap_or(1.0)));
        channel.lateral_unit = channel.lateral_unit.filter(|_| ratio.is_some());
    }
    if table.columns > 3 {
        let [x, y, z] = [columns.x, columns.y, columns.z].map(|column| column + 1);
        channel
            .notes
            .push(format!("of {} columns {x}, {y} and {z} are read, as x, y, z", table.columns));
    }
    header.remove_marks(&mut channel.values, &mut channel.notes);
    Ok(channel)
}

#[cfg(test)]
mod tests;
