//! A table of what is done over a history: a line of names, then a line of numbers for each moment.

use std::path::Path;

use asperity_cli::number::counted;
use asperity_cli::outcome::Failure;

use crate::values::Dimension;

/// The columns by their names.
#[derive(Debug)]
pub(crate) struct HistoryTable {
    header: String,
    /// Each name, and the unit that it gives its numbers.
    columns: Vec<(String, String)>,
    /// Each line by its number.
    rows: Vec<(usize, Vec<String>)>,
}

impl HistoryTable {
    /// Takes what is needed out of the table in a file. Errors name the file.
    pub(crate) fn read<T>(
        file: &Path,
        take: impl FnOnce(&Self) -> Result<T, String>,
    ) -> Result<T, Failure> {
        let text = std::fs::read_to_string(file)
            .map_err(|error| Failure::new(format!("cannot read {}", file.display()), error))?;
        Self::parse(&text)
            .and_then(|table| take(&table))
            .map_err(|wrong| Failure::request(format!("cannot use {}: {wrong}", file.display())))
    }

    /// Cells end at semicolons, tabs or commas, whichever of these the first line has first; where they do not end at
    /// commas, a comma is a decimal point.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let is_remark = |line: &str| line.is_empty() || line.starts_with('#');
        let mut lines = (1..).zip(text.lines()).filter(|(_, line)| !is_remark(line.trim()));
        let (_, header) = lines.next().ok_or("it is empty")?;
        let between = [';', '\t'].into_iter().find(|c| header.contains(*c)).unwrap_or(',');
        let columns: Vec<_> = header.split(between).map(name_and_unit).collect();
        let rows = lines.map(|(number, line)| {
            let cells = line.split(between).map(|cell| match between {
                ',' => bare(cell).to_string(),
                _ => bare(cell).replace(',', "."),
            });
            let cells: Vec<String> = cells.collect();
            if cells.len() != columns.len() {
                let (found, expected) = (counted(cells.len(), "cell"), columns.len());
                return Err(format!(
                    "line {number}, `{line}`, has {found}, and the first line {expected}"
                ));
            }
            Ok((number, cells))
        });
        let rows = rows.collect::<Result<_, String>>()?;
        Ok(Self { header: header.to_string(), columns, rows })
    }

    pub(crate) fn has(&self, name: &str) -> bool {
        self.columns.iter().any(|(other, _)| other == name)
    }

    /// The first line.
    pub(crate) fn header(&self) -> &str {
        &self.header
    }

    /// The numbers of the lines.
    pub(crate) fn lines(&self) -> impl Iterator<Item = usize> {
        self.rows.iter().map(|(number, _)| *number)
    }

    /// A column in SI units.
    pub(crate) fn column(&self, name: &str, kind: &'static Dimension) -> Result<Vec<f64>, String> {
        let mut places = (0..).zip(&self.columns).filter(|(_, (other, _))| other == name);
        let (place, unit) = match (places.next(), places.next()) {
            (Some((place, (_, unit))), None) => (place, unit),
            (found, _) => {
                let columns = if found.is_some() { "several columns" } else { "no column" };
                let header = &self.header;
                return Err(format!("its first line names {columns} `{name}`: it is `{header}`"));
            }
        };
        let number = |(line, cells): &(usize, Vec<String>)| {
            let cell: &str = &cells[place];
            // A number has its own unit or that of the column.
            let has_none = cell.parse::<f64>().is_ok();
            let given = if has_none { format!("{cell} {unit}") } else { cell.to_string() };
            kind.any()(&given)
                .map_err(|wrong| format!("`{cell}` in line {line} is no {name}: {wrong}"))
        };
        self.rows.iter().map(number).collect()
    }
}

/// A cell without blanks and quotes around it.
fn bare(cell: &str) -> &str {
    cell.trim().trim_matches('"').trim()
}

/// `Load [kN]` is the load in kN.
fn name_and_unit(cell: &str) -> (String, String) {
    let cell = bare(cell);
    let (name, unit) = cell.split_once(['[', '(']).unwrap_or((cell, ""));
    let unit = unit.trim().trim_end_matches([']', ')']);
    (name.trim().to_lowercase(), unit.to_string())
}

#[cfg(test)]
mod tests {
    use super::HistoryTable;
    use crate::values::{FORCE, TIME};

    #[test]
    fn tables_are_read_as_programs_write_them() -> Result<(), String> {
        for text in [
            "time,load\n0,0\n\n60,2e2\n",
            "\u{feff}# made by hand\nLoad [kN];t;Time (min)\r\n0;;0\r\n\r\n0,2;x;1\r\n",
            "\n\ntime\tload\n0\t0 N\n1 min\t0.2kN",
            "time,load,note\n 0, 0,\n# a pause\n60 s,200,end",
            "\ttime [min]\tload\n0\t0 s\t0\n1\t60 s\t200\n",
            "time\tload\tnote\n0\t0\tstart\n60\t200\t\n",
            "\"time\";\"load [mN]\"\n\"0\";\"0\"\n\"60\";\"0,2 kN\"",
        ] {
            let table = HistoryTable::parse(text)?;
            assert_eq!(table.column("time", &TIME), Ok(vec![0.0, 60.0]), "{text}");
            assert_eq!(table.column("load", &FORCE), Ok(vec![0.0, 200.0]), "{text}");
            assert!(table.has("load") && !table.has("kN"), "{text}");
        }
        let table = HistoryTable::parse("\ntime,load\n0,0\n\n60,2e2\n")?;
        assert_eq!(table.lines().collect::<Vec<_>>(), [3, 5]);
        assert_eq!(table.header(), "time,load");
        Ok(())
    }

    #[test]
    fn what_is_wrong_is_told_by_line_and_cell() {
        for (text, words) in [
            ("", "empty"),
            ("# nothing\n", "empty"),
            ("1,2\n3,4\n", "no column `load`: it is `1,2`"),
            ("load,Load [N],t\n1,2,3", "several columns `load`"),
            ("load,time\n1\n", "line 2, `1`, has 1 cell,"),
            ("load,time\n1,2\n1,2,3\n", "line 3, `1,2,3`, has 3 cells"),
            ("load,time\nnan,1\n", "`nan` in line 2"),
            ("load,time\n,1\n", "`` in line 2 is no load: not a number"),
            ("load,time\n5mm,1\n", "'mm' is no unit of force"),
            ("load [mm],time\n5,1\n", "'mm' is no unit of force"),
            ("load [N],time\n5 m,1\n", "'m' is no unit of force"),
        ] {
            let read = HistoryTable::parse(text).and_then(|table| table.column("load", &FORCE));
            assert!(read.as_ref().is_err_and(|wrong| wrong.contains(words)), "{text}: {read:?}");
        }
    }
}
