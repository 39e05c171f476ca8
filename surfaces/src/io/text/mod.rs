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

mod dialect;
mod header;
mod matrix;
mod points;
mod table;

use std::path::Path;

use super::lines::Lines;
use super::raw::Parsed;

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
    let (header, table) = table::read(Lines::new(file, skipped))?;
    let is_xyz = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("xyz"));
    let is_matrix = header.has_sides();
    let is_list = header.names_columns || header.lateral_unit.is_some() || is_xyz;
    let channel = if is_matrix {
        matrix::channel(header, table)
    } else if is_list {
        points::channel(header, &table)
    } else if table.columns > 3 || table.rows() <= FEW_ROWS {
        matrix::channel(header, table)
    } else if table.columns == 3 {
        points::channel(header, &table).map_err(|fault| fault.prefixed(UNDECLARED))
    } else {
        bail!(
            "{} rows of {} numbers are a profile; a surface is a matrix of at least four columns, or a list of points \
             x, y, z; lines '# Width: 1 mm' and '# Height: 1 mm' make it a matrix",
            table.rows(),
            table.columns
        )
    };
    channel.map(|channel| vec![channel])
}

/// What is said of three columns with a defect, of which nothing says that they are points.
const UNDECLARED: &str = "three columns are taken for points x, y, z unless lines '# Width: 1 mm' and \
    '# Height: 1 mm' say that they are a matrix: ";

#[cfg(test)]
mod tests;
