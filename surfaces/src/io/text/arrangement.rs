//! How the numbers of a text are arranged: what it says, and what its numbers can be.

use super::axes;
use super::header::Header;
use super::layout::TextLayout;
use super::names::{self, Columns};
use super::points;
use super::table::Table;
use crate::io::fault::Fault;
use crate::number::counted;

/// Most columns of a list of points without names: beside x, y and z a normal, a colour and what else was measured.
const MOST_COLUMNS: usize = 12;

/// How many times as many rows as columns a matrix has at most that nothing but its looks says to be one.
const LONGEST: usize = 10;

/// Most rows of a matrix with fewer than three columns that nothing but its looks says to be one.
pub(super) const FEW_ROWS: usize = 3;

/// What a table is.
pub(super) enum Found {
    Matrix(TextLayout),
    Points(List),
    Profile,
}

/// Which columns have the points, and the map that they make.
pub(super) type List = Box<(Columns, points::Map)>;

/// What a table is whose columns have no names, `is_list` if anything else says that it has points.
pub(super) fn of(header: &Header, table: &Table, is_list: bool) -> Result<Found, Fault> {
    let matrices = || axes::plausible(header, table);
    let with_points = || Ok::<_, Fault>([matrices()?, vec![TextLayout::Points]].concat());
    let (columns, rows) = (table.columns, table.rows());
    ensure!(table.values.len() > 1 || header.counts(), "one number is no surface");
    if is_list {
        return points(table).map(Found::Points);
    }
    if header.is_of_matrix() {
        let is_counted = |(nx, ny)| header.counts() && header.has_counts(nx, ny);
        return match looks(table) {
            Looks::Points(list) if is_counted(list.1.shape()) => Ok(Found::Points(list)),
            Looks::Points(_) if !is_counted((columns, rows)) => choose(table, &with_points()?),
            _ => choose(table, &matrices()?),
        };
    }
    if columns <= 2 && rows > FEW_ROWS {
        if let (Some(line), None) = (header.of_map(), names::of_profile(header, table)) {
            bail!(
                "the line '{line}' is one of a map, but {} of {} are taken for a profile: as a map they are read with \
                 `ReadOptions::layout`, as a profile without this line, or below names of their columns",
                counted(rows, "row"),
                counted(columns, "number")
            );
        }
        return Ok(Found::Profile);
    }
    let is_long = (3..=MOST_COLUMNS).contains(&columns) && rows > LONGEST * columns;
    match looks(table) {
        // No heights are coordinates of most of a grid, each once, by chance.
        Looks::Points(list) => Ok(Found::Points(list)),
        Looks::Anything => choose(table, &with_points()?),
        Looks::NoPoints(fault) if columns == 3 || is_long => Err(fault.prefixed(&format!(
            "{} of {columns} numbers are taken for points x, y, z unless lines '# Width: 1 mm' and '# Height: 1 mm' or \
             `ReadOptions::layout` say that they are a matrix: ",
            counted(rows, "row")
        ))),
        Looks::NoPoints(_) => choose(table, &matrices()?),
    }
}

/// The only way to read a table, or a refusal that names them all.
fn choose(table: &Table, layouts: &[TextLayout]) -> Result<Found, Fault> {
    if let [only] = layouts {
        return Ok(Found::Matrix(*only));
    }
    let ways: Vec<String> = layouts.iter().map(|layout| layout.told(table)).collect();
    let or_else = if table.columns <= 2 && table.rows() > FEW_ROWS {
        "; without the lines that say that it is a map, it is a profile"
    } else {
        ""
    };
    Err(fault!(
        "its numbers can be read in {} ways, and the file does not say which is meant: {}; choose one with `ReadOptions::layout`{or_else}",
        ways.len(),
        ways.join("; ")
    ))
}

/// Whether numbers look like points.
enum Looks {
    /// Nothing else looks so.
    Points(List),
    /// They might be.
    Anything,
    NoPoints(Fault),
}

fn looks(table: &Table) -> Looks {
    let mut looks = Looks::NoPoints(fault!("they are no points"));
    for columns in unnamed(table) {
        let behind = table.columns - columns.x;
        if !(3..=MOST_COLUMNS).contains(&behind) {
            continue;
        }
        match points::map(&columns, table) {
            Ok(map) if map.is_for_sure() => return Looks::Points(Box::new((columns, map))),
            Ok(map) => {
                // Three columns in many rows are nothing else, and a profile is refused.
                let fault = map.channel().err();
                let is_refused = table.columns == 3 && table.rows() > FEW_ROWS;
                looks = fault.filter(|_| is_refused).map_or(Looks::Anything, Looks::NoPoints);
            }
            Err(fault) if columns.x == 0 => looks = Looks::NoPoints(fault),
            Err(_) => {}
        }
    }
    looks
}

/// The columns that can be meant without names: the first three, or those behind a running number.
fn unnamed(table: &Table) -> impl Iterator<Item = Columns> {
    let is_counted = table.columns > 3 && table.counts_rows();
    let behind = is_counted.then(|| Columns::behind(1, "behind the column of running numbers"));
    std::iter::once(Columns::behind(0, "in the first three columns")).chain(behind)
}

/// The points of a list without names.
pub(super) fn points(table: &Table) -> Result<List, Fault> {
    let map = |columns: Columns| points::map(&columns, table).map(|map| Box::new((columns, map)));
    let mut found: Vec<Result<List, Fault>> = unnamed(table).map(map).collect();
    ensure!(
        found.len() < 2 || found.iter().any(Result::is_err),
        "the first column counts the rows, but may be x as well: name the columns in a line above them, such as 'n x y z'"
    );
    // Of the first three the reason is told why they are none.
    let place = found.iter().position(Result::is_ok).unwrap_or_default();
    found.swap_remove(place)
}
