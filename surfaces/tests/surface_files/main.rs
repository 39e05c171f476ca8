//! Files of heights: our own small ones, real ones beside what other readers say of them, and broken ones.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

mod dialects;
mod hostile;
mod instruments;
mod profiles;
mod refusals;
mod stated;
mod third_party;
mod third_party_archives_and_text;
mod third_party_instruments;
mod truth;

use std::path::{Path, PathBuf};

/// The folder of our own files.
fn own() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data/surface_files")
}

/// A name for a file of one test, which is removed with it.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let name = format!("asperity-{}-{name}", std::process::id());
        Self(std::env::temp_dir().join(name))
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        // It may never have been made.
        let _ = std::fs::remove_file(&self.0);
    }
}
