//! The inputs that fuzzing has found (`fuzz/corpus`, a line of hexadecimal digits for each), through the drivers.
//!
//! A file that is missing or empty is a failure, and so is one that belongs to no driver.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use asperity_drivers::{DRIVERS, Violation, case, from_hex};

fn of_repository(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name)
}

fn failed(path: &Path) -> impl Fn(io::Error) -> Violation {
    move |error| Violation::new(format!("{}: {error}", path.display()))
}

/// What is in a folder, in the order of names.
fn entries(folder: &str) -> Result<Vec<PathBuf>, Violation> {
    let folder = of_repository(folder);
    let read = || -> io::Result<Vec<PathBuf>> {
        fs::read_dir(&folder)?.map(|entry| entry.map(|entry| entry.path())).collect()
    };
    let mut entries = read().map_err(failed(&folder))?;
    entries.sort();
    Ok(entries)
}

/// Names and bytes of the inputs of a target.
fn inputs(target: &str) -> Result<Vec<(String, Vec<u8>)>, Violation> {
    let file = of_repository(&format!("fuzz/corpus/{target}.hex"));
    let text = fs::read_to_string(&file).map_err(failed(&file))?;
    let lines = text.lines().map(|line| Ok((line.to_string(), from_hex(line)?)));
    let mut inputs = lines.collect::<Result<Vec<_>, Violation>>()?;
    if target == "parsers" {
        // Files of every format: two zero bytes say that the rest is a file, read with default options.
        for folder in ["tests/data/surface_files", "tests/data/text_files"] {
            for file in entries(folder)? {
                let bytes = fs::read(&file).map_err(failed(&file))?;
                inputs.push((file.display().to_string(), [vec![0, 0], bytes].concat()));
            }
        }
    }
    Ok(inputs)
}

/// Every input of a target.
fn replay(target: &str) -> Result<(), Violation> {
    let Some((_, driver)) = DRIVERS.iter().find(|(name, _)| *name == target) else {
        return Err(Violation::new(format!("there is no driver '{target}'")));
    };
    let inputs = inputs(target)?;
    let mut checked = 0;
    for (name, bytes) in &inputs {
        let tally = case(*driver, bytes)
            .map_err(|violation| Violation::new(format!("{target} {name}: {violation}")))?;
        checked += tally.checked;
    }
    println!("{target}: {} inputs, {checked} answers compared", inputs.len());
    if checked == 0 {
        return Err(Violation::new(format!("no answer to {target} was compared")));
    }
    Ok(())
}

#[test]
fn adhesion() -> Result<(), Violation> {
    replay("adhesion")
}

#[test]
fn creep() -> Result<(), Violation> {
    replay("creep")
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
fn slip() -> Result<(), Violation> {
    replay("slip")
}

#[test]
fn every_file_has_a_driver() -> Result<(), Violation> {
    let files = entries("fuzz/corpus")?.into_iter().filter(|path| path.is_file());
    let files: Vec<PathBuf> = files.collect();
    let names = files.iter().filter_map(|file| file.file_stem()?.to_str());
    assert!(names.eq(DRIVERS.map(|(name, _)| name)), "{files:?}");
    Ok(())
}

#[test]
fn yielding() -> Result<(), Violation> {
    replay("yielding")
}
