//! `gather.png`: means with one standard deviation to either side.

use std::path::{Path, PathBuf};

use asperity_cli::axis::Axis;
use asperity_cli::chart::{self, BLUE, Chart, Corner, ORANGE, Series, Style};
use asperity_cli::number::counted;
use asperity_cli::outcome::Failure;

use super::{Row, table};

/// What stands beside each column: its name, and its unit.
const NAMES: [(&str, &str); table::COLUMNS.len()] = [
    ("contact area / nominal area", ""),
    ("corrected contact area", "m²"),
    ("approach", "m"),
    ("mean gap", "m"),
    ("contact stiffness", "N/m"),
    ("interfacial stiffness", "N/m"),
];

pub(super) fn draw(rows: &[Row], paths: usize, name: &Path) -> Result<PathBuf, Failure> {
    let charts: Vec<Chart> =
        (0..table::COLUMNS.len()).filter_map(|column| chart(rows, column, paths)).collect();
    chart::draw(&charts, 2, name)
}

/// `None` for a column without numbers.
fn chart(rows: &[Row], column: usize, paths: usize) -> Option<Chart> {
    let points = |value: &dyn Fn(f64, f64) -> f64| -> Vec<(f64, f64)> {
        let values = rows.iter().map(|row| {
            let (mean, spread) = row.columns[column];
            (row.load, value(mean, spread))
        });
        values.filter(|(_, y)| *y > 0.0 && y.is_finite()).collect()
    };
    let [mean, above, below] = [
        points(&|mean, _| mean),
        points(&|mean, spread| mean + spread),
        points(&|mean, spread| mean - spread),
    ];
    let least = below.iter().chain(&mean).map(|(_, y)| *y).reduce(f64::min)?;
    let greatest = above.iter().map(|(_, y)| *y).reduce(f64::max)?;
    let (title, unit) = NAMES[column];
    let y = match (title, unit) {
        (_, "") => Axis::plain_logarithmic(title, least, greatest),
        ("mean gap", _) => Axis::linear(title, unit, 0.0, greatest),
        _ => Axis::logarithmic(title, unit, least, greatest),
    };
    Some(Chart {
        title: title.to_string(),
        x: Axis::logarithmic("load", "N", rows.first()?.load, rows.last()?.load),
        y: y.with_room(0.04, 0.06),
        series: vec![
            Series::new(format!("mean of {}", counted(paths, "path")), BLUE, Style::Line, mean),
            Series::new("one standard deviation", ORANGE, Style::Dashed, above),
            Series::new("", ORANGE, Style::Dashed, below),
        ],
        legend: Corner::BottomRight,
    })
}
