//! `asperity report`: a path as one page, for a browser.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use asperity::LoadingPath;
use asperity::record::LoadingRecord;
use asperity_cli::note;
use asperity_cli::outcome::{self, Failure, Outcome};
use asperity_cli::units::{self, Units};
use asperity_report::{Report, Source};
use clap::Args;

use crate::shell;

/// A recorded path as one page for a browser: the contact at every state under a slider, charts, tables, and what made
/// it
///
/// The page is one file that needs no network and no other file: open it by a double click, or mail it. It has the
/// order of all events, all scalars, pressure and gap at 24 states, the surface, the bodies, warnings and residuals.
/// Tables that `asperity slip`, creep, leak and `path --unload` have written in the folder of the record are shown too,
/// unless they are older than it. Two records are compared.
#[derive(Debug, Args)]
pub(crate) struct Options {
    /// Files that `asperity path --record` has written: one, or two to compare
    #[arg(value_name = "FILE.npz", required = true, num_args = 1..=2)]
    records: Vec<PathBuf>,

    /// Folder of other tables of the first record: slip.csv, creep.csv, leak.csv, unloading.csv; may be given several
    /// times
    #[arg(long, value_name = "DIR")]
    with: Vec<PathBuf>,

    /// The page
    #[arg(long, value_name = "FILE.html", default_value = "report.html")]
    out: PathBuf,
}

/// Whether there is a file that is no page of HTML; an empty one is a place for it.
fn is_something_else(file: &Path) -> bool {
    let mut begin = Vec::new();
    let read = File::open(file).and_then(|file| file.take(1024).read_to_end(&mut begin));
    let begin = String::from_utf8_lossy(&begin).trim_start().to_ascii_lowercase();
    file.is_file() && (read.is_err() || !begin.is_empty() && !begin.starts_with("<!doctype html"))
}

/// Reads the records and writes the page.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    outcome::check_place(&options.out)?;
    if let Some(record) = options.records.iter().find(|file| outcome::is_same(&options.out, file)) {
        return Err(Failure::request(format!(
            "--out would replace the record {}: name another file",
            record.display()
        )));
    }
    if is_something_else(&options.out) {
        return Err(Failure::request(format!(
            "{} is no page, and would be lost: name another file with --out, or remove it",
            options.out.display()
        )));
    }
    if let Some(folder) = options.with.iter().find(|folder| !folder.is_dir()) {
        return Err(Failure::request(format!("there is no folder {}", folder.display())));
    }
    let mut report = empty();
    let mut folders = options.with.iter();
    for file in &options.records {
        let name = file.display().to_string();
        let failed = |error| Failure::new(format!("cannot show {name}"), error);
        let record = LoadingRecord::read_npz(file).map_err(failed)?;
        let source = Source::new(&name, &record).beside(file);
        // All of them belong to the first record.
        let source = folders.by_ref().fold(source, |source, folder| source.with_folder(folder));
        report.add(source).map_err(failed)?;
    }
    for note in report.notes() {
        note!("note: {note}");
    }
    let mut outcome = Outcome::default();
    outcome.written(outcome::write(&options.out, report.html()));
    outcome.finish()
}

/// A page of this command without a path, in the units that it was asked for.
fn empty() -> Report {
    let report = Report::new().made_by(shell::command());
    match units::chosen() {
        Units::Si => report,
        Units::Millimetres => report.in_millimetres(),
    }
}

/// The page of a path that has just been followed, with the tables that were written since it began.
pub(crate) fn of_path(
    name: &str,
    record: &LoadingRecord,
    fields: &mut LoadingPath,
    (folder, since): (&Path, SystemTime),
) -> Result<PathBuf, Failure> {
    let file = folder.join("report.html");
    let mut report = empty();
    let source = Source::new(name, record).computed_by(fields).with_folder_since(folder, since);
    report.add(source).map_err(|error| Failure::new("cannot make the report", error))?;
    outcome::write(&file, report.html())
}
