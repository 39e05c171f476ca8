//! Rows of numbers.

use crate::io::fault::Fault;

use super::dialect::{Dialect, is_row};
use super::header::Header;
use crate::io::lines::{Line, Lines};

/// The numbers of a file, row by row; NaN where one is missing.
#[derive(Debug)]
pub(super) struct Table {
    pub(super) columns: usize,
    pub(super) values: Vec<f64>,
}

impl Table {
    pub(super) fn rows(&self) -> usize {
        self.values.len() / self.columns.max(1)
    }
}

/// The header of a file, and the numbers below.
pub(super) fn read(mut lines: Lines) -> Result<(Header, Table), Fault> {
    let mut header = Header::default();
    loop {
        let ahead = lines.clone();
        let line = lines
            .next()
            .ok_or_else(|| fault!("there is no line in it that consists of numbers only"))?;
        if !line.is_comment() && is_row(line.bytes) {
            return Ok((header, body(ahead)?));
        }
        header.add(&line.text());
    }
}

fn body(lines: Lines) -> Result<Table, Fault> {
    let dialect = Dialect::of(&lines);
    let mut table = Table { columns: 0, values: Vec::new() };
    let mut first = 0;
    // Whether every row begins, or ends, with an empty cell: the separator belongs to the margin then.
    let (mut begins_empty, mut ends_empty) = (true, true);
    for line in lines {
        if line.is_comment() {
            ensure!(
                !Header::default().add(&line.text()),
                at(line.offset),
                "line {} begins another map: a text has to hold one only",
                line.number
            );
            continue;
        }
        if is_blank(&line, dialect, table.columns) {
            continue;
        }
        // No number is shorter than a digit and what parts it from the next.
        table
            .values
            .try_reserve(line.bytes.len() / 2 + 1)
            .map_err(|_| std::io::Error::from(std::io::ErrorKind::OutOfMemory))?;
        let before = table.values.len();
        let margins = row(&line, dialect, &mut table.values)?;
        begins_empty &= margins.0;
        ends_empty &= margins.1;
        let columns = table.values.len() - before;
        if table.columns == 0 {
            (table.columns, first) = (columns, line.number);
        }
        ensure!(
            columns == table.columns,
            at(line.offset),
            "line {} has {columns} numbers, but line {first} has {}",
            line.number,
            table.columns
        );
    }
    drop_margins(&mut table, begins_empty, ends_empty);
    Ok(table)
}

/// Appends the numbers of a line. Returns whether its first and its last cell are empty.
fn row(line: &Line, dialect: Dialect, values: &mut Vec<f64>) -> Result<(bool, bool), Fault> {
    let Some(separator) = dialect.separator else {
        cell(line, line.bytes, dialect, values)?;
        return Ok((false, false));
    };
    let (mut begins_empty, mut ends_empty) = (None, false);
    for text in line.bytes.split(|byte| *byte == separator) {
        ends_empty = !cell(line, text, dialect, values)?;
        begins_empty.get_or_insert(ends_empty);
        if ends_empty {
            values.push(f64::NAN);
        }
    }
    Ok((begins_empty == Some(true), ends_empty))
}

/// Appends the numbers of a cell. Returns whether there are any.
fn cell(line: &Line, text: &[u8], dialect: Dialect, values: &mut Vec<f64>) -> Result<bool, Fault> {
    let mut any = false;
    for word in text.split(|byte| matches!(byte, b' ' | b'\t')) {
        if word.is_empty() {
            continue;
        }
        values.push(dialect.number(word).ok_or_else(|| {
            let shown = String::from_utf8_lossy(word.get(..40).unwrap_or(word));
            fault!(at(line.offset), "'{shown}' in line {} is no number", line.number)
        })?);
        any = true;
    }
    Ok(any)
}

/// Whether a line has nothing on it. A row of empty cells between tabs has: as many tabs as the others.
fn is_blank(line: &Line, dialect: Dialect, columns: usize) -> bool {
    if !line.bytes.trim_ascii().is_empty() {
        return false;
    }
    let tabs = line.bytes.iter().filter(|byte| **byte == b'\t').count();
    dialect.separator != Some(b'\t') || tabs == 0 || tabs + 1 != columns
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
}
