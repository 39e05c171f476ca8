//! Positions and running numbers in the first row and the first column of a matrix: they are no heights.
//!
//! A row of heights is never evenly spaced while its neighbours are not. Where the heights themselves are, as on a plane,
//! the first row goes on like the others; if it does not, nothing can be told, and the file is refused.

use super::table::Table;
use crate::io::fault::Fault;

/// Fewest numbers that can be seen to be evenly spaced, and fewest where both a row and a column are.
const FEWEST: usize = 4;
const FEWEST_OF_BOTH: usize = 3;

/// How far a position may be from even spacing, in spacings, among many and among few.
const UNEVEN: f64 = 0.02;
const UNEVEN_OF_FEW: f64 = 1e-3;
const MANY: usize = 8;

/// Evenly spaced numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Run {
    start: f64,
    step: f64,
    count: usize,
}

/// What the first of several lines of numbers is.
#[derive(Debug, Clone, Copy, PartialEq)]
enum First {
    /// One like the others.
    Heights,
    /// Positions.
    Axis(Run),
    /// Something else, and then positions.
    AfterCorner(Run),
}

/// What was found in place of heights.
#[derive(Debug, Default)]
pub(super) struct Axes {
    /// Spacing along x and y, if positions give both.
    pub(super) cell: Option<(f64, f64)>,
    /// What the first row and the first column were taken for.
    pub(super) notes: Vec<String>,
    /// Whether the first row is no row of heights.
    pub(super) is_matrix: bool,
}

/// Takes positions and running numbers away from a table.
pub(super) fn take(table: &mut Table) -> Result<Axes, Fault> {
    let (columns, rows) = (table.columns, table.rows());
    let row = |k: usize| table.values.iter().skip(k * columns).take(columns).copied().collect();
    let column = |k: usize| table.values.iter().skip(k).step_by(columns).copied().collect();
    let (first_row, first_column): (Vec<f64>, Vec<f64>) = (row(0), column(0));
    let along_x = first("row", rows, row)?;
    let along_y = first("column", columns, column)?;
    let after_corner = |line: &[f64], fewest| Run::of(line.get(1..)?, fewest);
    let both = || {
        Some((
            after_corner(&first_row, FEWEST_OF_BOTH)?,
            after_corner(&first_column, FEWEST_OF_BOTH)?,
        ))
    };
    let (x, y) = match (along_x, along_y) {
        (First::Heights, First::Heights) => {
            let corner = |(x, y)| (!goes_on(table)).then_some((Some(x), Some(y)));
            both().and_then(corner).unwrap_or_default()
        }
        (First::Axis(x), First::Heights) => (Some(x), None),
        (First::Heights, First::Axis(y)) => (None, Some(y)),
        // Both have a corner in common, whatever is in it.
        _ => {
            let x = after_corner(&first_row, 1);
            let y = after_corner(&first_column, 1);
            ensure!(
                x.is_some() && y.is_some(),
                "the first {} is evenly spaced but for its first number, as positions are; the first {} is not: which numbers are \
                 heights cannot be told",
                if x.is_some() { "row" } else { "column" },
                if x.is_some() { "column" } else { "row" }
            );
            (x, y)
        }
    };
    let mut axes = Axes { is_matrix: x.is_some(), ..Axes::default() };
    axes.notes.extend(x.map(|run| run.told("row", "x")));
    axes.notes.extend(y.map(|run| run.told("column", "y")));
    let positions = x.zip(y).filter(|(x, y)| !x.counts() && !y.counts());
    axes.cell = positions.map(|(x, y)| (x.step.abs(), y.step.abs()));
    let (skipped_rows, skipped_columns) = (usize::from(x.is_some()), usize::from(y.is_some()));
    let mut place = 0;
    table.values.retain(|_| {
        let keep = place / columns >= skipped_rows && place % columns >= skipped_columns;
        place += 1;
        keep
    });
    table.columns = columns - skipped_columns;
    Ok(axes)
}

/// Whether the second row is evenly spaced as the first.
fn goes_on(table: &Table) -> bool {
    let columns = table.columns;
    let row: Vec<f64> = table.values.iter().skip(columns + 1).take(columns - 1).copied().collect();
    Run::with_gaps(&row).is_some()
}

/// What the first of `count` lines is.
fn first(name: &str, count: usize, line: impl Fn(usize) -> Vec<f64>) -> Result<First, Fault> {
    let numbers = line(0);
    // The next lines in which enough was measured to compare them.
    let is_known = |line: &[f64]| line.iter().filter(|z| z.is_finite()).count() >= FEWEST_OF_BOTH;
    let known = (1..count).map(|k| (k, line(k))).filter(|(_, line)| is_known(line));
    let known: Vec<(usize, Vec<f64>)> = known.take(2).collect();
    let [(k, second), rest @ ..] = known.as_slice() else {
        return Ok(First::Heights);
    };
    if let Some(run) = Run::of(&numbers, FEWEST) {
        let Some(next) = Run::with_gaps(second) else {
            return Ok(First::Axis(run));
        };
        // A plane, or a surface of straight lines whose slope changes evenly.
        let after = rest.first().and_then(|(j, third)| Some((*j, Run::with_gaps(third)?)));
        let slope = after.map_or(0.0, |(j, after)| (after.step - next.step) / (j - k) as f64);
        let expected = next.step - slope * *k as f64;
        let scale = run.step.abs().max(next.step.abs());
        ensure!(
            (run.step - expected).abs() <= 0.1 * scale,
            "the first {name}s are evenly spaced, the first in steps of {}, the next of {}: whether the first has positions or \
             heights cannot be told",
            run.step,
            next.step
        );
        return Ok(First::Heights);
    }
    let Some(run) = numbers.get(1..).and_then(|tail| Run::of(tail, FEWEST)) else {
        return Ok(First::Heights);
    };
    let next = second.get(1..).and_then(Run::with_gaps);
    let is_same = next.is_some_and(|next| (next.step - run.step).abs() <= 0.1 * run.step.abs());
    Ok(if is_same { First::Heights } else { First::AfterCorner(run) })
}

impl Run {
    /// At least so many numbers, if they grow, or fall, by even steps.
    fn of(numbers: &[f64], fewest: usize) -> Option<Self> {
        let is_whole = numbers.len() >= fewest && numbers.iter().all(|number| number.is_finite());
        Self::with_gaps(numbers).filter(|_| is_whole)
    }

    /// Numbers that grow, or fall, by even steps, whatever is missing between them.
    fn with_gaps(numbers: &[f64]) -> Option<Self> {
        let known = || numbers.iter().enumerate().filter(|(_, number)| number.is_finite());
        let ((first, start), (last, end)) = (known().next()?, known().next_back()?);
        let step = if last > first { (end - start) / (last - first) as f64 } else { 1.0 };
        let count = numbers.len();
        let allowed = step.abs() * if count < MANY { UNEVEN_OF_FEW } else { UNEVEN };
        let is_even = |(k, number): (usize, &f64)| {
            (number - start - (k - first) as f64 * step).abs() <= allowed
        };
        let is_run = step.is_finite() && step != 0.0 && known().all(is_even);
        is_run.then_some(Self { start: *start, step, count })
    }

    /// Whether it counts from 0 or 1.
    fn counts(self) -> bool {
        self.step == 1.0 && (self.start == 0.0 || self.start == 1.0)
    }

    fn told(self, line: &str, along: &str) -> String {
        let Self { start, step, count } = self;
        let end = start + step * (count - 1) as f64;
        let what = if self.counts() { "running numbers" } else { "positions" };
        format!(
            "the first {line} is evenly spaced from {start} to {end:.6}: {what} along {along}, no heights"
        )
    }
}
