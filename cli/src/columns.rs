//! Columns of numbers, each in the unit that suits it.

use asperity_cli::number::significant;
use asperity_cli::{say, units};

/// Significant digits.
const DIGITS: usize = 4;
/// Characters between two columns.
const BETWEEN: usize = 2;

/// A quantity of every row, in one unit.
pub(crate) struct Column {
    name: &'static str,
    unit: String,
    cells: Vec<String>,
}

impl Column {
    /// In the [unit](units::of) that suits the greatest value.
    pub(crate) fn new(
        name: &'static str,
        unit: &str,
        values: impl Iterator<Item = f64> + Clone,
    ) -> Self {
        Self::made(name, units::of(unit, greatest(values.clone())), values)
    }

    /// In a unit of its own.
    pub(crate) fn scaled(
        name: &'static str,
        (unit, scale): (&str, f64),
        values: impl Iterator<Item = f64>,
    ) -> Self {
        Self::made(name, (scale, unit.to_string()), values)
    }

    /// Whole numbers.
    pub(crate) fn counts(name: &'static str, counts: &[u64]) -> Self {
        let cells = counts.iter().map(ToString::to_string).collect();
        Self { name, unit: String::new(), cells }
    }

    /// Words.
    pub(crate) fn words<'a>(name: &'static str, words: impl Iterator<Item = &'a str>) -> Self {
        Self { name, unit: String::new(), cells: words.map(str::to_string).collect() }
    }

    /// A fraction.
    pub(crate) fn percent(name: &'static str, values: impl Iterator<Item = f64>) -> Self {
        Self::scaled(name, ("%", 0.01), values)
    }

    fn made(
        name: &'static str,
        (scale, unit): (f64, String),
        values: impl Iterator<Item = f64>,
    ) -> Self {
        let cell = |value: f64| match value.is_nan() {
            true => "-".to_string(),
            false => significant(value / scale, DIGITS),
        };
        Self { name, unit, cells: values.map(cell).collect() }
    }

    pub(crate) fn name(&self) -> &str {
        self.name
    }

    fn width(&self) -> usize {
        let texts = self.cells.iter().map(String::as_str);
        let widths = texts.chain([self.name, &self.unit]);
        widths.map(|text| text.chars().count()).max().unwrap_or(0)
    }
}

fn greatest(values: impl Iterator<Item = f64>) -> f64 {
    let finite = values.filter(|value| value.is_finite());
    finite.map(f64::abs).fold(0.0, f64::max)
}

/// Prints columns under their names and units.
pub(crate) fn print(columns: &[Column]) {
    let line = |cell: &dyn Fn(&Column) -> Option<&str>| {
        let cells = columns.iter().map(|column| {
            let width = column.width() + BETWEEN;
            format!("{:>width$}", cell(column).unwrap_or_default())
        });
        say!("{}", cells.collect::<String>());
    };
    line(&|column| Some(column.name));
    line(&|column| Some(&column.unit));
    for row in 0..columns.first().map_or(0, |column| column.cells.len()) {
        line(&|column| column.cells.get(row).map(String::as_str));
    }
}
