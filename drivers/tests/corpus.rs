//! The inputs that fuzzing has found (`fuzz/corpus`), through the drivers.
//!
//! A folder that is missing or empty is a failure, and so is one that belongs to no driver.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use asperity_drivers::{DRIVERS, Violation, case};

/// What is in a folder of the corpus, in the order of names.
fn entries(folder: &str) -> Result<Vec<PathBuf>, Violation> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus").join(folder);
    let read = || -> io::Result<Vec<PathBuf>> {
        fs::read_dir(&folder)?.map(|entry| entry.map(|entry| entry.path())).collect()
    };
    let failed = |error: io::Error| Violation::new(format!("{}: {error}", folder.display()));
    let mut entries = read().map_err(failed)?;
    entries.sort();
    if entries.is_empty() {
        return Err(Violation::new(format!("{} is empty", folder.display())));
    }
    Ok(entries)
}

/// Every input of a target.
fn replay(target: &str) -> Result<(), Violation> {
    let Some((_, driver)) = DRIVERS.iter().find(|(name, _)| *name == target) else {
        return Err(Violation::new(format!("there is no driver '{target}'")));
    };
    let files = entries(target)?;
    let mut checked = 0;
    for file in &files {
        let failed = |what: String| Violation::new(format!("{}: {what}", file.display()));
        let bytes = fs::read(file).map_err(|error| failed(error.to_string()))?;
        let tally = case(*driver, &bytes).map_err(|violation| failed(violation.to_string()))?;
        checked += tally.checked;
    }
    println!("{target}: {} inputs, {checked} answers compared", files.len());
    if checked == 0 {
        return Err(Violation::new(format!("no answer to {target} was compared")));
    }
    Ok(())
}

#[test]
fn fixed_loads() -> Result<(), Violation> {
    replay("fixed_loads")
}

#[test]
fn large_contacts() -> Result<(), Violation> {
    replay("large_contacts")
}

#[test]
fn large_loads() -> Result<(), Violation> {
    replay("large_loads")
}

#[test]
fn parsers() -> Result<(), Violation> {
    replay("parsers")
}

#[test]
fn paths() -> Result<(), Violation> {
    replay("paths")
}

#[test]
fn records() -> Result<(), Violation> {
    replay("records")
}

#[test]
fn every_folder_has_a_driver() -> Result<(), Violation> {
    let folders = entries("")?;
    let names = folders.iter().filter_map(|folder| folder.file_name()?.to_str());
    assert!(names.eq(DRIVERS.map(|(name, _)| name)), "{folders:?}");
    Ok(())
}

#[test]
fn yielding() -> Result<(), Violation> {
    replay("yielding")
}
