//! `asperity patches` on the record of a small path to full contact.

use std::error::Error;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};

/// A folder of this test alone.
fn folder() -> Result<PathBuf, Box<dyn Error>> {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("patches");
    if folder.exists() {
        fs::remove_dir_all(&folder)?;
    }
    fs::create_dir_all(&folder)?;
    Ok(folder)
}

fn asperity(folder: &PathBuf, arguments: &[&str]) -> std::io::Result<Output> {
    let mut program = Command::new(env!("CARGO_BIN_EXE_asperity"));
    program.current_dir(folder).args(arguments).output()
}

/// In full contact of a periodic surface there is one patch of all nodes without an edge, so that nothing is to be
/// corrected, and at first touch there is one of one node.
#[test]
fn a_path_to_full_contact_ends_in_one_patch() -> Result<(), Box<dyn Error>> {
    let folder = folder()?;
    let made = asperity(
        &folder,
        &[
            "path",
            "--nodes",
            "16",
            "--periodic",
            "love",
            "--max-area-fraction",
            "1",
            "--record",
            "path.npz",
        ],
    )?;
    assert!(made.status.success());
    let done =
        asperity(&folder, &["patches", "path.npz", "--out", "seen", "--at-area-fraction", "0.3"])?;
    assert!(done.status.success());
    let said = String::from_utf8(done.stdout)?;
    for passage in ["percolates along x", "percolates along y", "seals along x", "seals along y"] {
        let line = said.lines().find(|line| line.starts_with(passage));
        assert!(line.is_some_and(|line| line.contains("from state")), "{said}");
    }

    let seen = folder.join("seen");
    let table = fs::read_to_string(seen.join("patches.csv"))?;
    let lines: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(lines.len(), 1 + 16 * 16);
    let [names, first, .., last] = &lines[..] else {
        return Err("no states".into());
    };
    let column = |line: &[&str], name: &str| -> Result<String, Box<dyn Error>> {
        let place = names.iter().position(|other| *other == name).ok_or("no column")?;
        Ok(line.get(place).ok_or("no cell")?.to_string())
    };
    assert_eq!(column(first, "patches")?, "1");
    assert_eq!(column(first, "event")?, "birth");
    assert_eq!(column(last, "patches")?, "1");
    assert_eq!(column(last, "largest_patch")?, "256");
    assert_eq!(column(last, "perimeter")?.parse::<f64>()?, 0.0);
    assert_eq!(column(last, "corrected_area_fraction")?.parse::<f64>()?, 1.0);

    for picture in ["patches", "activation", "merge_tree", "distributions"] {
        let bytes = fs::read(seen.join(picture).with_extension("png"))?;
        assert!(bytes.starts_with(b"\x89PNG"), "{picture}");
    }

    let beyond = asperity(&folder, &["patches", "path.npz", "--at-area-fraction", "0.001"])?;
    assert!(!beyond.status.success());
    Ok(())
}
