//! `asperity gather`: mean and spread of many paths, at common loads.

mod picture;
mod table;

use std::fs;
use std::path::{Path, PathBuf};

use asperity_cli::number::counted;
use asperity_cli::outcome::{self, Failure, Outcome};
use asperity_cli::panel;
use asperity_cli::{answer, say, speech};
use clap::Args;
use serde_json::{Map, Value, json};

use crate::columns::{self, Column};
use crate::settings::Settings;
use table::Table;

/// Rows of the table on the screen.
const ROWS: usize = 12;

/// More loads than any path has events worth reading.
const MOST_LOADS: usize = 1_000_000;

/// Mean and standard deviation of paths, at common loads: of `asperity path --seeds`, or of several maps of one
/// specimen
///
/// Maps of one specimen are followed with the same options, each with an --out of its own in one folder. Prints a
/// table, and writes gather.csv (for each load the mean and the standard deviation of contact_area_fraction,
/// corrected_contact_area, approach, mean_gap, contact_stiffness and interfacial_stiffness) and gather.png. Unfinished
/// folders are ignored.
#[derive(Debug, Args)]
pub(crate) struct Options {
    /// The folder that holds one folder for each path
    #[arg(value_name = "DIR")]
    directory: PathBuf,

    /// Number of loads, at least 2, evenly spaced on a logarithmic axis
    #[arg(long, value_name = "N", default_value_t = 60)]
    loads: usize,

    /// Print one JSON object instead: paths, load, and mean and std of each column at each load (null where there is
    /// none); files are written only if --out is given
    #[arg(long)]
    json: bool,

    /// Directory for the files, made if it is not there [default: DIR]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Reads all paths, and writes what they have in common.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    if options.json {
        speech::be_quiet();
    }
    if !(2..=MOST_LOADS).contains(&options.loads) {
        return Err(Failure::request(format!(
            "--loads takes at least 2, the first and the last in common, and at most {MOST_LOADS}"
        )));
    }
    let files = paths(&options.directory)?;
    check_alike(&files)?;
    let tables = files.iter().map(|file| Table::read(file));
    let tables: Vec<Table> = tables.collect::<Result<_, _>>()?;
    let Some((first, last)) = common(&tables) else {
        return Err(Failure::request(format!(
            "no two paths in {} have a load in common",
            options.directory.display()
        )));
    };
    let steps = options.loads - 1;
    let ratio = (last / first).powf(1.0 / steps as f64);
    // The last one exactly: the path that ends there has it with its last event.
    let loads = (0..steps).map(|k| (first * ratio.powi(k as i32)).min(last)).chain([last]);
    let rows: Vec<Row> = loads.map(|load| Row::at(load, &tables)).collect();
    print(&rows, tables.len());
    if options.json {
        answer!("{}", object(&rows, tables.len()));
    }
    let beside = (!options.json).then_some(&options.directory);
    let Some(out) = options.out.as_ref().or(beside) else { return Ok(()) };
    outcome::create_folder(out)?;
    panel::register_font()?;
    let mut outcome = Outcome::default();
    outcome.written(write(&rows, &out.join("gather.csv")));
    outcome.written(picture::draw(&rows, tables.len(), &out.join("gather.png")));
    outcome.finish()
}

/// The files `path.csv` of the folders in a folder, in the order of their names.
fn paths(directory: &Path) -> Result<Vec<PathBuf>, Failure> {
    let failed = |error| Failure::new(format!("cannot read {}", directory.display()), error);
    let mut found = Vec::new();
    for entry in fs::read_dir(directory).map_err(failed)? {
        let folder = entry.map_err(failed)?.path();
        let unfinished = folder.extension().is_some_and(|name| name == "unfinished");
        let file = folder.join("path.csv");
        if !unfinished && file.is_file() {
            found.push(file);
        }
    }
    if found.is_empty() {
        return Err(Failure::request(format!(
            "no folder in {} holds a path.csv",
            directory.display()
        )));
    }
    found.sort();
    Ok(found)
}

/// `Ok` if all paths are of one kind: of the same settings but for the seed.
fn check_alike(files: &[PathBuf]) -> Result<(), Failure> {
    let mut first: Option<(String, Settings)> = None;
    for folder in files.iter().filter_map(|file| file.parent()) {
        let settings = Settings::read(folder)?;
        if settings.has("adhesion") {
            return Err(Failure::request(format!(
                "{} holds a path with adhesion: it comes to a load on two branches, and `gather` takes means of contact that only \
                 grows; `asperity path --seeds` prints the pull-off force of each surface",
                folder.display()
            )));
        }
        let name = folder.display().to_string();
        match &first {
            None => first = Some((name, settings)),
            Some((other, others)) => settings.check_same(&name, (other, others), true)?,
        }
    }
    Ok(())
}

/// The least and the greatest load that all paths have.
fn common(tables: &[Table]) -> Option<(f64, f64)> {
    let ends = tables.iter().map(Table::loads).collect::<Option<Vec<_>>>()?;
    let first = ends.iter().map(|(first, _)| *first).fold(0.0, f64::max);
    let last = ends.iter().map(|(_, last)| *last).fold(f64::INFINITY, f64::min);
    (first > 0.0 && first < last).then_some((first, last))
}

/// Mean and standard deviation of every column at a load; without a stiffness, NaN.
struct Row {
    load: f64,
    columns: Vec<(f64, f64)>,
}

impl Row {
    fn at(load: f64, tables: &[Table]) -> Self {
        let states: Vec<Vec<f64>> = tables.iter().map(|table| table.at(load)).collect();
        let count = states.len() as f64;
        let column = |k: usize| {
            let values = states.iter().map(|state| state[k]);
            let mean = values.clone().sum::<f64>() / count;
            let spread = values.map(|value| (value - mean).powi(2)).sum::<f64>();
            // Of a sample.
            (mean, (spread / (count - 1.0).max(1.0)).sqrt())
        };
        Self { load, columns: (0..table::COLUMNS.len()).map(column).collect() }
    }
}

/// Some of the loads for people.
fn print(rows: &[Row], paths: usize) {
    say!("means of {} at common loads; ±: standard deviation over mean", counted(paths, "path"));
    say!();
    let some =
        (0..rows.len()).filter(|k| (rows.len() - 1 - k).is_multiple_of(rows.len().div_ceil(ROWS)));
    let rows: Vec<&Row> = some.map(|k| &rows[k]).collect();
    let mut columns = vec![Column::new("load", "N", rows.iter().map(|row| row.load))];
    let shown = [
        ("area", ""),
        ("corrected", "m²"),
        ("approach", "m"),
        ("mean gap", "m"),
        ("K", "N/m"),
        ("K_i", "N/m"),
    ];
    for (k, (name, unit)) in shown.into_iter().enumerate() {
        let means = rows.iter().map(|row| row.columns[k].0);
        if means.clone().all(f64::is_nan) {
            continue;
        }
        columns.push(match unit {
            "" => Column::percent(name, means),
            _ => Column::new(name, unit, means),
        });
        columns
            .push(Column::percent("±", rows.iter().map(|row| row.columns[k].1 / row.columns[k].0)));
    }
    columns::print(&columns);
}

/// For programs.
fn object(rows: &[Row], paths: usize) -> Value {
    let column = |k: usize| {
        let mean: Vec<f64> = rows.iter().map(|row| row.columns[k].0).collect();
        let spread: Vec<f64> = rows.iter().map(|row| row.columns[k].1).collect();
        json!({ "mean": mean, "std": spread })
    };
    let columns = table::COLUMNS.iter().enumerate();
    let columns: Map<_, _> =
        columns.map(|(k, (name, _))| ((*name).to_string(), column(k))).collect();
    let loads: Vec<f64> = rows.iter().map(|row| row.load).collect();
    json!({ "paths": paths, "load": loads, "columns": columns })
}

/// One line for each load.
fn write(rows: &[Row], name: &Path) -> Result<PathBuf, Failure> {
    let names = table::COLUMNS.iter();
    let names = names.map(|(name, _)| format!(",{name}_mean,{name}_std"));
    let mut text = format!("load{}\n", names.collect::<String>());
    for row in rows {
        let columns = row.columns.iter();
        let columns = columns.map(|(mean, spread)| format!(",{mean:e},{spread:e}"));
        text += &format!("{:e}{}\n", row.load, columns.collect::<String>());
    }
    outcome::write(name, text)
}
