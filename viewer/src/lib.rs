//! A loading path as one HTML file that needs no network, no server and no other file: a map of contact at every state
//! under a slider, charts with a cursor that follows it, and what the record says of surface, bodies and exactness.
//!
//! ```
//! use asperity::record::LoadingRecord;
//! use asperity::{Boussinesq, Grid, LoadingSolver, SelfAffine};
//! use asperity_report::{Report, Source};
//!
//! # fn main() -> Result<(), asperity::Error> {
//! let half_space = Boussinesq::new(Grid::square(32, 1.25e-3)?, 115e9)?;
//! let mut path = LoadingSolver::builder(&SelfAffine::zhang2020(1), &half_space).max_load(500.0).build()?;
//! let history = path.run()?;
//! let record = LoadingRecord::new(&path, history)?;
//! let mut report = Report::new();
//! report.add(Source::new("ground steel", &record).computed_by(&mut path))?;
//! let page = report.html();
//! assert!(page.starts_with("<!DOCTYPE html>"));
//! # Ok(())
//! # }
//! ```

mod beside;
mod blob;
mod column;
mod events;
mod facts;
mod fields;
mod page;
mod table;

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use asperity::nalgebra::DMatrix;
use asperity::record::LoadingRecord;
use asperity::{Error, LoadingPath};
use serde_json::{Value, json};

use crate::beside::Folder;

pub use facts::reason;
pub use table::PathTable;

/// Paths that a page can show.
const PATHS: usize = 2;

/// A path for a page.
pub struct Source<'a> {
    name: String,
    record: &'a LoadingRecord,
    path: Option<&'a mut LoadingPath>,
    folders: Vec<Folder>,
    has_fields: bool,
}

impl<'a> Source<'a> {
    /// The path of a record, under a name for people.
    #[must_use]
    pub fn new(name: impl Into<String>, record: &'a LoadingRecord) -> Self {
        Self { name: name.into(), record, path: None, folders: Vec::new(), has_fields: true }
    }

    /// With what computes its fields: the path itself, if it is there. Otherwise the record is replayed.
    #[must_use]
    pub fn computed_by(mut self, path: &'a mut LoadingPath) -> Self {
        self.path = Some(path);
        self
    }

    /// Without pressure, gap and residuals, which take a solution each: of a path that is being followed.
    #[must_use]
    pub fn without_fields(mut self) -> Self {
        self.has_fields = false;
        self
    }

    /// With the tables of slip, creep, leak and unloading that lie beside the file of the record and are not older.
    #[must_use]
    pub fn beside(mut self, file: &Path) -> Self {
        self.folders.push(beside::place_of(file));
        self
    }

    /// With the tables of a folder, whatever their age; once, if the record lies in it too.
    #[must_use]
    pub fn with_folder(mut self, folder: &Path) -> Self {
        self.folders.retain(|other| !beside::is_same(&other.path, folder));
        self.folders.push(Folder { path: folder.to_path_buf(), since: None, is_named: true });
        self
    }

    /// With the tables of a folder that were not written before a moment.
    #[must_use]
    pub fn with_folder_since(mut self, folder: &Path, moment: SystemTime) -> Self {
        let (path, since) = (folder.to_path_buf(), Some(moment));
        self.folders.push(Folder { path, since, is_named: true });
        self
    }
}

/// A page of one path, or of two to compare.
#[derive(Debug, Default)]
pub struct Report {
    command: Option<String>,
    is_in_millimetres: bool,
    records: Vec<Value>,
    /// Files of the tables of the first record.
    tables: Vec<PathBuf>,
    notes: Vec<String>,
}

impl Report {
    /// Without a path.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// With the command that makes the page.
    #[must_use]
    pub fn made_by(mut self, command: impl Into<String>) -> Self {
        self.command = Some(command.into());
        self
    }

    /// At first in mm, N and MPa, and not in SI units with prefixes; its reader may choose others.
    #[must_use]
    pub fn in_millimetres(mut self) -> Self {
        self.is_in_millimetres = true;
        self
    }

    /// What was left out, and why; the page says it too.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Adds a path, the first or the second. Tables that are found for both are shown once. Where its fields cannot be
    /// computed, as on a kernel that is not of the crate, the page has none and says why.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a third path, and for a record without a state; those of [`LoadingRecord::contact`].
    pub fn add(&mut self, source: Source<'_>) -> Result<(), Error> {
        let Source { name, record, path, folders, has_fields } = source;
        let grid = record.grid();
        if self.records.len() == PATHS {
            return Err(Error::OutOfRange {
                quantity: "number of paths of the page",
                value: PATHS as f64 + 1.0,
                expected: "1 or 2",
            });
        }
        if record.states().is_empty() {
            return Err(Error::OutOfRange {
                quantity: "number of states of the record",
                value: 0.0,
                expected: "at least 1",
            });
        }
        let (mut notes, mut settings) = (Vec::new(), None);
        let (mut files, mut panels, mut shown) = (Vec::new(), Vec::new(), Vec::new());
        for folder in folders {
            let found = beside::of(&folder);
            notes.extend(found.notes);
            for (file, panel) in found.panels {
                match self.tables.iter().position(|other| beside::is_same(other, &file)) {
                    Some(place) => shown.push(place),
                    None => {
                        files.push(file);
                        panels.push(panel);
                    }
                }
            }
            settings = settings.or(found.settings.map(|all| beside::flat(&all)));
        }
        let events = events::of(record)?;
        let heights = fields::heights(record.heights().matrix());
        let texts =
            [&events, &heights].into_iter().chain(&panels).map(|part| part.to_string().len());
        let taken = page::letters() + texts.sum::<usize>();
        let computed = match path {
            _ if !has_fields => Ok(Computed::nothing()),
            Some(path) => Computed::by(path, record, taken),
            None => record.replay().and_then(|mut replay| Computed::by(&mut replay, record, taken)),
        };
        let computed = computed.unwrap_or_else(|error| {
            notes.push(format!("pressure, gap and residuals are missing: {error}"));
            Computed::nothing()
        });
        let (nx, ny) = grid.shape();
        let (lx, ly) = grid.sides();
        self.notes.extend(notes.iter().cloned());
        for place in shown {
            self.records[0]["panels"][place]["both"] = true.into();
        }
        self.tables.extend(files);
        self.records.push(json!({
            "name": name,
            "nx": nx,
            "ny": ny,
            "lx": lx,
            "ly": ly,
            "nominal_area": grid.nominal_area(),
            "facts": facts::of(record)?,
            "settings": settings,
            "warnings": facts::warnings(record, computed.pressure.as_ref())?,
            "notes": notes,
            "certificate": computed.certificate,
            "events": events,
            "heights": heights,
            "fields": computed.fields,
            "panels": panels,
        }));
        Ok(())
    }

    /// The page.
    #[must_use]
    pub fn html(&self) -> String {
        page::of(&self.data())
    }

    /// What the page shows, as its scripts read it.
    #[must_use]
    pub fn data(&self) -> Value {
        let millimetres = || json!({"length": "mm", "force": "N", "pressure": "MPa"});
        let units = self.is_in_millimetres.then(millimetres);
        json!({
            "format": 1,
            "program": concat!("asperity ", env!("CARGO_PKG_VERSION")),
            "command": self.command,
            "units": units,
            "records": self.records,
        })
    }
}

/// What takes solutions.
struct Computed {
    fields: Value,
    certificate: Vec<Value>,
    /// Of the last state \[Pa\].
    pressure: Option<DMatrix<f64>>,
}

impl Computed {
    fn nothing() -> Self {
        Self { fields: Value::Null, certificate: Vec::new(), pressure: None }
    }

    fn by(path: &mut LoadingPath, record: &LoadingRecord, taken: usize) -> Result<Self, Error> {
        let (found, pressure) = fields::of(&record.grid(), record.history(), taken, path)?;
        let certificate = match record.states().last() {
            Some(last) => facts::certificate(&path.certificate_at(last)?, last),
            None => Vec::new(),
        };
        Ok(Self { fields: found, certificate, pressure })
    }
}

/// Compiles the code of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
