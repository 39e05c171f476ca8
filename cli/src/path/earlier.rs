//! Files of an earlier path in the same folder.

use std::fs;
use std::path::{Path, PathBuf};

use asperity_cli::outcome::is_same;

/// How the names of files begin that a path may write beside its table, and may not another time.
const NAMES: [&str; 12] = [
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
];

/// What an earlier path has left in a folder.
pub(super) struct Earlier(Vec<PathBuf>);

impl Earlier {
    /// What is there before a path begins that goes on from a record, or from none; nothing in a folder without the
    /// settings of a path.
    pub(super) fn of(folder: &Path, resumed: Option<&Path>) -> Self {
        let is_of_path = |file: &PathBuf| {
            let name = file.file_name().and_then(|name| name.to_str());
            name.is_some_and(|name| NAMES.iter().any(|begin| name.starts_with(begin)))
        };
        let entries = fs::read_dir(folder).ok().filter(|_| folder.join("settings.json").is_file());
        let files = entries.into_iter().flatten().filter_map(|entry| Some(entry.ok()?.path()));
        let is_own = |file: &PathBuf| resumed.is_some_and(|record| is_same(record, file));
        let mut files: Vec<PathBuf> =
            files.filter(|file| is_of_path(file) && !is_own(file)).collect();
        files.sort();
        Self(files)
    }

    /// That those of them which were not written again are not of this path.
    pub(super) fn told(&self, written: &[PathBuf]) -> Option<String> {
        let left = self.0.iter().filter(|file| !written.contains(file));
        let names: Vec<String> = left.map(|file| file.display().to_string()).collect();
        (!names.is_empty()).then(|| format!("of an earlier path: {}", names.join(", ")))
    }
}
