//! Rows of numbers.

use crate::io::fault::Fault;

use super::dialect::{Cells, Dialect, is_row};
use super::header::{Header, shown};
use super::run::{Run, UNEVEN};
use crate::io::lines::{Line, Lines};
use crate::number::counted;

/// The numbers of a file, row by row; NaN where one is missing.
#[derive(Debug)]
pub(super) struct Table {
    pub(super) columns: usize,
    pub(super) values: Vec<f64>,
    pub(super) dialect: Dialect,
    /// The line after the first empty one between rows, unless there is one between any two.
    pub(super) second_block: Option<usize>,
    /// Which empty cells, at the beginning or at the end of all lines, were left out.
    pub(super) margins: Option<&'static str>,
}

impl Table {
    /// Points x, y, z.
    pub(super) fn of_points(values: Vec<f64>) -> Self {
        Self { columns: 3, values, dialect: Dialect::BLANKS, second_block: None, margins: None }
    }

    /// The numbers in the next lines, and in no others.
    pub(super) fn of_lines(lines: Lines, count: usize) -> Result<Self, Fault> {
        let mut table = Self::read(lines, Some(count), None)?;
        table.second_block = None;
        Ok(table)
    }

    pub(super) fn rows(&self) -> usize {
        self.values.len() / self.columns.max(1)
    }

    /// Takes away rows at the end in which all cells are empty, as spreadsheets write them below points.
    pub(super) fn drop_empty_end(&mut self) {
        let rows = self.values.rchunks_exact(self.columns.max(1));
        let empty = rows.take_while(|row| row.iter().all(|cell| cell.is_nan())).count();
        if empty < self.rows() {
            self.values.truncate(self.values.len() - empty * self.columns);
        }
    }

    /// How the text is written.
    pub(super) fn told(&self) -> String {
        let margins = if self.margins.is_some() {
            "; empty cells at the beginning or the end of all lines are no nodes"
        } else {
            ""
        };
        self.dialect.told() + margins
    }

    /// Whether the first column counts the rows.
    pub(super) fn counts_rows(&self) -> bool {
        let mut numbers = self.values.iter().step_by(self.columns.max(1));
        let Some(start) = numbers.next().filter(|start| matches!(**start, 0.0 | 1.0)) else {
            return false;
        };
        (1..).zip(numbers).all(|(k, number)| *number == start + f64::from(k))
    }

    /// Refuses a line right above the rows that is one of them but for a word.
    ///
    /// A word before evenly spaced numbers is the corner of a row of positions.
    fn check_above(&self, line: &Line) -> Result<(), Fault> {
        let cells: Vec<&[u8]> = match self.dialect.separator {
            Some(sign) => line.bytes.split(|byte| *byte == sign).map(<[u8]>::trim_ascii).collect(),
            None => {
                line.bytes.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).collect()
            }
        };
        let numbers: Vec<f64> = cells.iter().filter_map(|cell| self.dialect.number(cell)).collect();
        let is_word = |cell: &[u8]| !cell.is_empty() && self.dialect.number(cell).is_none();
        let Some(place) = cells.iter().position(|cell| is_word(cell)) else {
            return Ok(());
        };
        let is_corner =
            place == 0 && numbers.len() + 1 == cells.len() && Run::of(&numbers, UNEVEN).is_some();
        let is_row = cells.len() == self.columns && 2 * numbers.len() > cells.len();
        ensure!(
            is_corner || !is_row,
            at(line.offset),
            "{}, but {} of its {} cells are, as in the lines below",
            no_number(line, cells[place]),
            numbers.len(),
            cells.len()
        );
        Ok(())
    }

    fn read(lines: Lines, most: Option<usize>, stated: Option<usize>) -> Result<Self, Fault> {
        let dialect = Dialect::of(&lines);
        let mut table =
            Self { columns: 0, values: Vec::new(), dialect, second_block: None, margins: None };
        let (mut first, mut leading_of_first) = (0, 0);
        // Whether every row begins, or ends, with an empty cell: the separator belongs to the margin then.
        let (mut begins_empty, mut ends_empty) = (true, true);
        // An empty line behind every row is no sign of a second map.
        let (mut is_parted, mut has_neighbours) = (true, false);
        for line in lines {
            if most.is_some_and(|most| table.columns > 0 && table.rows() >= most) {
                break;
            }
            if line.is_comment() {
                ensure!(
                    !Header::default().add(&line.text())?,
                    at(line.offset),
                    "line {} begins another map: a text has to hold one only",
                    line.number
                );
                continue;
            }
            if is_blank(&line, dialect, table.columns) {
                is_parted = true;
                continue;
            }
            // No number is shorter than a digit and what parts it from the next.
            table
                .values
                .try_reserve(line.bytes.len() / 2 + 1)
                .map_err(|_| std::io::Error::from(std::io::ErrorKind::OutOfMemory))?;
            let before = table.values.len();
            let (leading, ends) = row(&line, dialect, &mut table.values)?;
            let mut columns = table.values.len() - before;
            // Blanks before a line, be they tabs, are no cells if other lines do without; any other sign makes cells.
            let may_be_blanks = dialect.separator == Some(b'\t') && table.columns > 0;
            if may_be_blanks && columns > table.columns && columns - leading <= table.columns {
                table.values.drain(before..before + columns - table.columns);
                columns = table.columns;
            } else if may_be_blanks && before == table.columns && columns < before {
                let excess = before - columns;
                if leading_of_first >= excess {
                    table.values.drain(..excess);
                    table.columns = columns;
                }
            }
            begins_empty &= leading > 0;
            ends_empty &= ends;
            if table.columns == 0 {
                (table.columns, first) = (columns, line.number);
                leading_of_first = leading;
            } else if is_parted {
                table.second_block.get_or_insert(line.number);
            } else {
                has_neighbours = true;
            }
            is_parted = false;
            ensure!(
                columns == table.columns,
                at(line.offset),
                "line {} has {}, but line {first} has {}",
                line.number,
                counted(columns, "number"),
                table.columns
            );
        }
        if stated != Some(table.columns) {
            drop_margins(&mut table, begins_empty, ends_empty);
        }
        table.second_block = table.second_block.filter(|_| has_neighbours);
        Ok(table)
    }
}

/// The header of a file, and the numbers below.
pub(super) fn read(mut lines: Lines) -> Result<(Header, Table), Fault> {
    let mut header = Header::default();
    // Lines right above the numbers that may belong to them.
    let mut above: Vec<(Lines, Line)> = Vec::new();
    // The line before, unless it says anything that is known.
    let mut unknown: Option<Line> = None;
    loop {
        let ahead = lines.clone();
        let line = lines
            .next()
            .ok_or_else(|| fault!("there is no line in it that consists of numbers only"))?;
        if !line.is_comment() && is_row(line.bytes) {
            let cells = Cells::of(line.bytes);
            let belongs = |(_, above): &&(Lines, Line)| cells.are_all_missing_in(above.bytes);
            let count = above.iter().rev().take_while(belongs).count();
            let rows = above.split_off(above.len() - count);
            for (_, line) in above {
                header.add(&line.text())?;
            }
            let first = rows.into_iter().next().map_or(ahead, |(lines, _)| lines);
            let mut table = Table::read(first, None, header.stated_columns())?;
            if header.take_mask(table.columns, &mut table.values)? {
                // An empty line before the mask parts no maps.
                table.second_block = None;
            }
            if let Some(line) = unknown {
                table.check_above(&line)?;
            }
            if let Some(number) = header.doubtful.as_ref().filter(|_| !table.dialect.decimal_comma)
            {
                bail!(
                    "the header has '{number}', whose comma parts thousands or is a decimal one, while the numbers \
                     below have no decimal commas: write it with a point, or without the comma"
                );
            }
            return Ok((header, table));
        }
        let is_empty = |byte: &u8| !byte.is_ascii_alphanumeric();
        if line.bytes.iter().all(is_empty) && above.len() < MOST_ABOVE {
            above.push((ahead, line));
            unknown = None;
            continue;
        }
        for (_, line) in above.drain(..) {
            header.add(&line.text())?;
        }
        let is_known = header.add(&line.text())?;
        unknown = Some(line).filter(|line| !is_known && !line.is_comment());
    }
}

/// Most lines without numbers that are taken for rows of missing heights above the others: more nodes than there are in
/// a grid.
const MOST_ABOVE: usize = crate::Grid::MAX_SIDE;

/// Appends the numbers of a line. Returns how many empty cells are before the first number, and whether the last is
/// empty.
fn row(line: &Line, dialect: Dialect, values: &mut Vec<f64>) -> Result<(usize, bool), Fault> {
    let Some(separator) = dialect.separator else {
        cell(line, line.bytes, dialect, values)?;
        return Ok((0, false));
    };
    let (mut leading, mut only_empty, mut ends_empty) = (0, true, false);
    for text in line.bytes.split(|byte| *byte == separator) {
        let before = values.len();
        ends_empty = !cell(line, text, dialect, values)?;
        ensure!(
            values.len() <= before + 1,
            at(line.offset),
            "line {} has {} in one cell, '{}': part all numbers by one sign, and write none with a blank in it",
            line.number,
            counted(values.len() - before, "number"),
            shown(&String::from_utf8_lossy(text.trim_ascii()))
        );
        only_empty &= ends_empty;
        leading += usize::from(only_empty);
        if ends_empty {
            values.push(f64::NAN);
        }
    }
    Ok((leading, ends_empty))
}

/// Appends the numbers of a cell. Returns whether there are any.
fn cell(line: &Line, text: &[u8], dialect: Dialect, values: &mut Vec<f64>) -> Result<bool, Fault> {
    let mut any = false;
    for word in text.split(|byte| matches!(byte, b' ' | b'\t')) {
        if word.is_empty() {
            continue;
        }
        ensure!(
            !dialect.is_foreign(word),
            at(line.offset),
            "line {} has a decimal point, but numbers in other lines have a decimal comma",
            line.number
        );
        let number = dialect.number(word);
        values.push(number.ok_or_else(|| fault!(at(line.offset), "{}", no_number(line, word)))?);
        any = true;
    }
    Ok(any)
}

/// What is said of a word that is no number.
fn no_number(line: &Line, word: &[u8]) -> String {
    format!("'{}' in line {} is no number", shown(&String::from_utf8_lossy(word)), line.number)
}

/// Whether a line has nothing on it. A row of empty cells between tabs has: as many tabs as the others.
fn is_blank(line: &Line, dialect: Dialect, columns: usize) -> bool {
    if !line.bytes.trim_ascii().is_empty() {
        return false;
    }
    let tabs = line.bytes.iter().filter(|byte| **byte == b'\t').count();
    dialect.separator != Some(b'\t') || tabs == 0 || columns > 0 && tabs + 1 != columns
}

/// Takes away the first and the last column if no row has anything in them.
fn drop_margins(table: &mut Table, first: bool, last: bool) {
    let columns = table.columns;
    let kept = columns.saturating_sub(usize::from(first) + usize::from(last));
    if kept == columns || kept == 0 {
        return;
    }
    let mut column = 0;
    table.values.retain(|_| {
        let keep = !(first && column == 0 || last && column + 1 == columns);
        column = (column + 1) % columns;
        keep
    });
    table.columns = kept;
    table.margins = Some(match (first, last) {
        (true, true) => "empty columns at the left and at the right are",
        (true, false) => "an empty column at the left is",
        _ => "an empty column at the right is",
    });
}
