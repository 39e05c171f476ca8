//! A text with a point x, y, z in every row.
//!
//! Nodes are found from the coordinates, so that points may come in any order, and need not all be there: scanners
//! leave out what they did not see.

use super::names::Columns;
use super::table::Table;
use crate::Grid;
use crate::io::bytes::{reserved, shape};
use crate::io::fault::Fault;
use crate::io::raw::Channel;
use crate::number::counted;

/// How far a point may be off its node, in spacings: as much as rounding to two digits of a spacing.
const TOLERANCE: f64 = 0.05;

/// What is said of points that are further off than this.
const NOTED: f64 = 1e-3;

/// Coordinates of one column of nodes differ by less than this share of the spacing.
const SAME: f64 = 4.0 * TOLERANCE;

/// Most nodes of a grid for each point in the file, and most columns of it for each that has any point.
const MAX_NODES: usize = 16;
const MAX_COLUMNS: usize = 2;

/// So many points of a grid are points for sure, however large the grid is.
const MANY: usize = 100;

/// What a list gives, be it a profile.
pub(super) struct Map {
    channel: Channel,
    axes: [Axis; 2],
    points: usize,
    /// How many of them are alone neither in their column of the grid nor in their row.
    in_company: usize,
}

impl Map {
    /// The map, if it is one of a surface.
    pub(super) fn channel(self) -> Result<Channel, Fault> {
        for Axis { name, start, nodes, .. } in &self.axes {
            ensure!(*nodes > 1, "all points have {name} = {start}: a profile is no surface");
        }
        Ok(self.channel)
    }

    /// How many nodes it has along x and y.
    pub(super) fn shape(&self) -> (usize, usize) {
        self.channel.shape
    }

    /// Whether its coordinates are those of most of a grid, or of many nodes of one: no other numbers are.
    pub(super) fn is_for_sure(&self) -> bool {
        let (nx, ny) = self.channel.shape;
        let is_most = 2 * self.points > nx * ny || self.points >= MANY;
        nx > 1 && ny > 1 && is_most && 2 * self.in_company > self.points
    }
}

/// The map of which a table gives the points, in the units of its numbers.
pub(super) fn map(columns: &Columns, table: &Table) -> Result<Map, Fault> {
    let count = table.columns;
    ensure!(count >= 3, "a list of points x, y, z has three columns, but there are {count}");
    let (x, y) = (Axis::find("x", table, columns.x)?, Axis::find("y", table, columns.y)?);
    let (nx, ny) = shape(x.nodes, y.nodes)?;
    let count = table.rows();
    ensure!(
        nx * ny <= count.saturating_mul(MAX_NODES),
        "a grid of {nx} x {ny} nodes would be needed for the {count} points of the list: more than \
         {MAX_NODES} nodes a point; they do not lie on a regular grid, or are only a few of it"
    );
    let mut values = reserved(nx * ny)?;
    values.resize(nx * ny, f64::NAN);
    let mut filled = vec![false; nx * ny];
    let mut in_line = [vec![0_usize; nx], vec![0; ny]];
    let mut worst = 0.0_f64;
    for (k, point) in (1..).zip(table.values.chunks_exact(table.columns)) {
        let place = |column: usize| point.get(column).copied().unwrap_or(f64::NAN);
        let (px, py, z) = (place(columns.x), place(columns.y), place(columns.z));
        let (ix, off_x) = x.node(k, px)?;
        let (iy, off_y) = y.node(k, py)?;
        worst = worst.max(off_x).max(off_y);
        let node = ix + nx * iy;
        let (Some(value), Some(filled)) = (values.get_mut(node), filled.get_mut(node)) else {
            continue;
        };
        ensure!(
            !std::mem::replace(filled, true),
            "point {k} at x = {px}, y = {py} is not the first at its node: spacings are {:e} and {:e}",
            x.spacing,
            y.spacing
        );
        *value = z;
        for (line, k) in in_line.iter_mut().zip([ix, iy]) {
            line.get_mut(k).into_iter().for_each(|count| *count += 1);
        }
    }
    let mut notes = Vec::new();
    if worst > NOTED {
        notes.push(format!(
            "points lie up to {worst:.3} of a spacing off the nodes of a regular grid; their heights are taken for \
             those of the nodes"
        ));
    }
    let channel = Channel {
        understood: format!("{}, {}, {}", counted(count, "point"), columns.how, table.told()),
        notes,
        ..Channel::in_metres((nx, ny), values, Some((x.spacing, y.spacing)))
    };
    let [in_column, in_row] = &in_line;
    let is_in_company = |node: &usize| {
        let counts = [in_column.get(node % nx), in_row.get(node / nx)];
        counts.iter().all(|count| count.is_some_and(|count| *count > 1))
    };
    let nodes = filled.iter().enumerate().filter(|(_, filled)| **filled).map(|(node, _)| node);
    let in_company = nodes.filter(is_in_company).count();
    Ok(Map { channel, axes: [x, y], points: count, in_company })
}

/// Evenly spaced coordinates.
#[derive(Debug)]
struct Axis {
    name: &'static str,
    start: f64,
    spacing: f64,
    nodes: usize,
}

impl Axis {
    /// The nodes on which a column of coordinates lies.
    fn find(name: &'static str, table: &Table, column: usize) -> Result<Self, Fault> {
        let mut sorted = reserved(table.rows())?;
        for (k, point) in (1..).zip(table.values.chunks_exact(table.columns)) {
            let coordinate = point.get(column).copied().unwrap_or(f64::NAN);
            ensure!(coordinate.is_finite(), "point {k} has no {name}");
            sorted.push(coordinate);
        }
        sorted.sort_unstable_by(f64::total_cmp);
        let (start, end) = match (sorted.first(), sorted.last()) {
            (Some(start), Some(end)) => (*start, *end),
            _ => (0.0, 0.0),
        };
        let extent = end - start;
        if extent == 0.0 {
            return Ok(Self { name, start, spacing: 1.0, nodes: 1 });
        }
        let count = sorted.len();
        let Gaps { least, columns, intervals } = Gaps::find(sorted, extent).ok_or_else(|| {
            fault!(
                "the {count} points lie on no regular grid: {name} has values from {start} to {end} that are less than \
                 {:e} apart, as on more than {} nodes",
                extent / Grid::MAX_SIDE as f64,
                Grid::MAX_SIDE
            )
        })?;
        // More than a grid can have are refused with its shape.
        let nodes = intervals as usize + 1;
        ensure!(
            nodes <= columns.saturating_mul(MAX_COLUMNS),
            "{name} is not evenly spaced: it has {columns} different values from {start} to {end}, some of them \
             {least:e} apart, which would make {nodes} columns"
        );
        // That of all nodes together hardly feels how the last of them is rounded.
        Ok(Self { name, start, spacing: extent / intervals, nodes })
    }

    /// The node at which point `k` lies, and how far off it is, in spacings.
    fn node(&self, k: usize, coordinate: f64) -> Result<(usize, f64), Fault> {
        let Self { name, start, spacing, .. } = self;
        let place = (coordinate - start) / spacing;
        let off = (place - place.round()).abs();
        ensure!(
            off <= TOLERANCE,
            "{name} is not evenly spaced: point {k} at {name} = {coordinate} is {off:.3} of the spacing {spacing:e} off \
             its node, and {TOLERANCE} is allowed"
        );
        Ok((place.round() as usize, off))
    }
}

/// What lies between coordinates that are not the same but for rounding.
struct Gaps {
    /// The smallest distance.
    least: f64,
    /// How many such coordinates there are.
    columns: usize,
    /// Spacings from the first to the last.
    intervals: f64,
}

impl Gaps {
    /// `None` if the smallest distance is too small for a grid.
    fn find(mut sorted: Vec<f64>, extent: f64) -> Option<Self> {
        let mut last = sorted.first().copied()?;
        for coordinate in &mut sorted {
            (*coordinate, last) = (*coordinate - last, *coordinate);
        }
        let mut gaps = sorted;
        gaps.sort_unstable_by(f64::total_cmp);
        // Rounded to the number of nodes, hence the half.
        let too_small = extent / (Grid::MAX_SIDE as f64 - 0.5);
        let same = gaps.windows(2).position(|pair| match pair {
            [below, gap] => *gap > too_small && *below <= SAME * *gap,
            _ => false,
        })?;
        let gaps = gaps.get(same + 1..)?;
        let least = *gaps.first()?;
        // Each gap is rounded for itself, in the mean spacing of the smaller ones: the smallest is the one that
        // coordinates with few digits make too small by most.
        let (mut sum, mut intervals) = (0.0, 0.0);
        for gap in gaps {
            intervals += if sum > 0.0 { (gap / (sum / intervals)).round() } else { 1.0 };
            sum += gap;
        }
        Some(Self { least, columns: gaps.len() + 1, intervals })
    }
}
