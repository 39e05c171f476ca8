//! Positions and running numbers in the first row and the first column of a matrix: they are no heights.
//!
//! Positions are evenly spaced. A row of measured heights never is while its neighbours are not. Where there are few
//! numbers, or the heights are those of a plane, several ways of reading are left.

use super::header::Header;
use super::layout::TextLayout;
use super::run::{Run, UNEVEN};
use super::table::Table;
use crate::io::fault::Fault;

/// Fewest numbers that cannot be evenly spaced by chance, and fewest where both a row and a column are.
const FEWEST: usize = 4;
const FEWEST_OF_BOTH: usize = 3;

/// How far a position may be from even spacing, in spacings, if few numbers are to be positions for sure.
const UNEVEN_OF_FEW: f64 = 1e-3;
const MANY: usize = 8;

/// What rounding leaves of a difference that is zero, relative to the numbers.
const ROUNDING: f64 = 1e-9;

/// What was found in place of heights.
#[derive(Debug, Default)]
pub(super) struct Axes {
    /// Spacing along x and y, if positions give both.
    pub(super) cell: Option<(f64, f64)>,
    /// Steps of what is along x, and along y.
    pub(super) steps: [Option<f64>; 2],
    /// What the first row and the first column were taken for.
    pub(super) notes: Vec<String>,
}

/// Takes positions and running numbers away from a table.
pub(super) fn take(table: &mut Table, layout: TextLayout) -> Result<Axes, Fault> {
    let (along_x, along_y) = layout.positions();
    let corner = usize::from(along_x && along_y);
    let columns = table.columns;
    let run = |numbers: Vec<f64>, line: &str| {
        let run = numbers.get(corner..).and_then(|numbers| Run::of(numbers, UNEVEN));
        run.ok_or_else(|| {
            fault!("the first {line} is not evenly spaced, as positions on a grid are")
        })
    };
    let x = along_x.then(|| run(row(table, 0), "row")).transpose()?;
    let y = along_y.then(|| run(column(table, 0), "column")).transpose()?;
    let mut axes = Axes::default();
    axes.notes.extend(x.map(|run| run.told("row", "x")));
    axes.notes.extend(y.map(|run| run.told("column", "y")));
    let positions = x.zip(y).filter(|(x, y)| !x.counts() && !y.counts());
    axes.cell = positions.map(|(x, y)| (x.step.abs(), y.step.abs()));
    axes.steps = [x, y].map(|run| run.map(|run| run.step.abs()));
    let (skipped_rows, skipped_columns) = (usize::from(along_x), usize::from(along_y));
    let mut place = 0;
    table.values.retain(|_| {
        let keep = place / columns >= skipped_rows && place % columns >= skipped_columns;
        place += 1;
        keep
    });
    table.columns = columns - skipped_columns;
    Ok(axes)
}

/// The ways in which a table can be a matrix: at least one.
pub(super) fn plausible(header: &Header, table: &Table) -> Result<Vec<TextLayout>, Fault> {
    use TextLayout::{Axes, ColumnOfY, Matrix, RowOfX};
    let (columns, rows) = (table.columns, table.rows());
    let x = Side::of(
        rows,
        |k| row(table, k),
        |run, n| header.may_be_axis(n, true, run.step),
        header.has_sides(),
    );
    let y = Side::of(
        columns,
        |k| column(table, k),
        |run, n| header.may_be_axis(n, false, run.step),
        header.has_sides(),
    );
    let both = x.few_tail && y.few_tail;
    let ways = [
        // Layout, whether it is possible, and whether something evenly spaced would be heights.
        (Matrix, true, x.sure || x.sure_tail || y.sure || y.sure_tail || both),
        (RowOfX, x.whole && rows > 1, y.sure_tail || x.goes_on),
        (ColumnOfY, y.whole && columns > 1, x.sure_tail || y.goes_on),
        (Axes, x.tail && y.tail && rows > 1 && columns > 1, x.goes_on || y.goes_on),
    ];
    let fits = |layout: TextLayout| {
        let (along_x, along_y) = layout.positions();
        header.has_counts(columns - usize::from(along_y), rows - usize::from(along_x))
    };
    let possible = || ways.into_iter().filter(|(_, possible, _)| *possible);
    let stated: Vec<TextLayout> =
        possible().map(|way| way.0).filter(|layout| header.counts() && fits(*layout)).collect();
    if let [only] = stated.as_slice() {
        return Ok(vec![*only]);
    }
    let mut found: Vec<TextLayout> =
        possible().filter(|(.., strange)| !strange).map(|way| way.0).collect();
    if !stated.is_empty() {
        found.retain(|layout| stated.contains(layout));
    }
    ensure!(
        !found.is_empty(),
        "the first {} is evenly spaced but for its first number, as positions are; the first {} is not: which numbers are \
         heights cannot be told; choose with `ReadOptions::layout`",
        if x.sure_tail { "row" } else { "column" },
        if x.sure_tail { "column" } else { "row" }
    );
    Ok(found)
}

fn row(table: &Table, k: usize) -> Vec<f64> {
    table.values.iter().skip(k * table.columns).take(table.columns).copied().collect()
}

fn column(table: &Table, k: usize) -> Vec<f64> {
    table.values.iter().skip(k).step_by(table.columns).copied().collect()
}

/// What the first row, or the first column, can be: all of it, or what is behind the corner.
#[derive(Debug, Clone, Copy, Default)]
struct Side {
    /// Whether it can be positions.
    whole: bool,
    tail: bool,
    /// Whether it is nothing else by chance.
    sure: bool,
    sure_tail: bool,
    /// The same of what is behind the corner, if it is so of the other side.
    few_tail: bool,
    /// Whether it goes on like the lines next to it, which are those of a surface that is curved across them.
    goes_on: bool,
}

impl Side {
    /// Of `count` lines of numbers; `may_be` says whether the header leaves it open that a run is one of positions.
    fn of(
        count: usize,
        line: impl Fn(usize) -> Vec<f64>,
        may_be: impl Fn(Run, usize) -> bool,
        has_sides: bool,
    ) -> Self {
        let first = line(0);
        let tail = first.get(1..).unwrap_or_default();
        // Of short lines it has to be the next, whatever is known of it.
        let fewest = if tail.len() < MANY { 0 } else { FEWEST_OF_BOTH };
        let is_known = |line: &Vec<f64>| line.iter().filter(|z| z.is_finite()).count() >= fewest;
        let behind = |k: usize| line(k).get(1..).map(<[f64]>::to_vec).unwrap_or_default();
        let next = (1..count).map(behind).find(is_known);
        // Nothing to compare with shows nothing.
        let is_apart = next.is_some_and(|next| !is_straight(&next));
        let run = |numbers: &[f64]| Run::of(numbers, UNEVEN);
        let is_sure = |numbers: &[f64], fewest| {
            let allowed = if numbers.len() < MANY { UNEVEN_OF_FEW } else { UNEVEN };
            is_apart && numbers.len() >= fewest && Run::of(numbers, allowed).is_some()
        };
        let (sure, sure_tail) = (is_sure(&first, FEWEST), is_sure(tail, FEWEST));
        let possible = |numbers: &[f64], sure: bool| {
            run(numbers).is_some_and(|run| sure || may_be(run, numbers.len()))
        };
        let few_tail = is_sure(tail, FEWEST_OF_BOTH);
        // Steps as the header gives them, and running numbers, are no coincidence.
        let is_stated = has_sides || [&first, tail].into_iter().filter_map(run).any(Run::counts);
        Self {
            whole: possible(&first, sure),
            tail: possible(tail, few_tail),
            sure,
            sure_tail,
            few_tail,
            goes_on: !sure
                && !is_stated
                && goes_on([0, 1, 2, 3].map(|k| if k < count { line(k) } else { Vec::new() })),
        }
    }
}

/// Whether four lines are those of a surface of second degree across them, and of none of first degree.
fn goes_on(lines: [Vec<f64>; 4]) -> bool {
    let [a, b, c, d] = &lines;
    let finite = lines.iter().flatten().filter(|z| z.is_finite());
    let rounding = ROUNDING * finite.fold(0.0_f64, |most, z| most.max(z.abs()));
    let across = a.iter().zip(b).zip(c).zip(d);
    let differences = across.map(|(((a, b), c), d)| (a - 3.0 * b + 3.0 * c - d, b - 2.0 * c + d));
    let known: Vec<(f64, f64)> = differences.filter(|(third, _)| third.is_finite()).collect();
    known.len() >= FEWEST_OF_BOTH
        && known.iter().all(|(third, second)| third.abs() <= rounding && second.abs() > rounding)
}

/// Whether numbers are evenly spaced, or all the same.
fn is_straight(numbers: &[f64]) -> bool {
    let mut known = numbers.iter().filter(|number| number.is_finite());
    let first = known.next();
    known.all(|number| Some(number) == first) || Run::with_gaps(numbers, UNEVEN).is_some()
}
