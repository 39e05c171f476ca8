//! Files of an earlier run in the same folder.

use std::fs;
use std::path::{Path, PathBuf};

use asperity_cli::note;
use asperity_cli::outcome::{Failure, Outcome, is_same};

/// What a command writes into a folder.
pub(crate) struct Kind {
    /// What is run.
    name: &'static str,
    /// A file that it always writes.
    always: &'static str,
    /// How the names of files begin that it may write beside that, and may not another time.
    sometimes: &'static [&'static str],
}

pub(crate) const PATH: Kind = Kind {
    name: "path",
    always: "settings.json",
    sometimes: &[
        "conductance.",
        "contact_map",
        "fields.",
        "gap",
        "interface.",
        "interrupted",
        "loading_curve.",
        "plastic_depth",
        "pressure",
        "report.",
        "residual_surface.",
        "unloading.",
    ],
};
/// A path may have written maps of the same names.
pub(crate) const LOAD: Kind = Kind { name: "run", always: "load.csv", sometimes: &["contact_map"] };
pub(crate) const SLIP: Kind = Kind {
    name: "slip",
    always: "slip.csv",
    sometimes: &["history.", "slip.", "stick_map.", "wear_map."],
};
pub(crate) const CREEP: Kind = Kind {
    name: "creep",
    always: "creep.csv",
    sometimes: &["creep.", "creep_cycles.", "leak_over_time.", "touch_times."],
};
pub(crate) const STRESS: Kind =
    Kind { name: "stress", always: "stress.csv", sometimes: &["section_", "stress."] };
pub(crate) const PATCHES: Kind = Kind {
    name: "patches",
    always: "patches.csv",
    sometimes: &["activation.", "distributions.", "merge_tree.", "patches."],
};
pub(crate) const LEAK: Kind =
    Kind { name: "leak", always: "leak.csv", sometimes: &["flux_", "fluid_pressure_", "leak."] };

/// What an earlier run has left in a folder.
pub(crate) struct Earlier {
    name: &'static str,
    files: Vec<PathBuf>,
}

impl Earlier {
    /// What is there before a run begins that reads these files; nothing in a folder in which there was no such run,
    /// and without a folder.
    pub(crate) fn of(kind: &Kind, folder: Option<&Path>, read: &[Option<&Path>]) -> Self {
        let is_of_kind = |file: &PathBuf| {
            let name = file.file_name().and_then(|name| name.to_str());
            name.is_some_and(|name| kind.sometimes.iter().any(|begin| name.starts_with(begin)))
        };
        let folder = folder.filter(|folder| folder.join(kind.always).is_file());
        let entries = folder.and_then(|folder| fs::read_dir(folder).ok());
        let files = entries.into_iter().flatten().filter_map(|entry| Some(entry.ok()?.path()));
        let is_own = |file: &PathBuf| read.iter().flatten().any(|read| is_same(read, file));
        let mut files: Vec<PathBuf> =
            files.filter(|file| is_of_kind(file) && !is_own(file)).collect();
        files.sort();
        Self { name: kind.name, files }
    }

    /// Finishes a run, and says which files were not written again and are not of it.
    ///
    /// # Errors
    ///
    /// Those of [`Outcome::finish`].
    pub(crate) fn finish(self, outcome: Outcome) -> Result<(), Failure> {
        let left = self.files.iter().filter(|file| !outcome.files().contains(file));
        let names: Vec<String> = left.map(|file| file.display().to_string()).collect();
        outcome.finish()?;
        if !names.is_empty() {
            note!("note: of an earlier {}: {}", self.name, names.join(", "));
        }
        Ok(())
    }
}
