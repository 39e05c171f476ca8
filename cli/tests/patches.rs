//! `asperity patches` on the record of a small path to full contact.

use std::error::Error;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};

/// A folder of one test alone.
fn folder(name: &str) -> Result<PathBuf, Box<dyn Error>> {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
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
    let folder = folder("patches")?;
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

/// A path that has only touched has an answer for programs too. What is advised names the record as a shell reads it.
#[test]
fn a_path_without_load_is_told() -> Result<(), Box<dyn Error>> {
    let folder = folder("patches_touch")?;
    let name = "it's one.npz";
    let path = ["path", "--nodes", "16", "--max-area-fraction", "0.004", "--record", name];
    assert!(asperity(&folder, &path)?.status.success());
    let done = asperity(&folder, &["patches", name, "--json"])?;
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let object: serde_json::Value = serde_json::from_slice(&done.stdout)?;
    assert_eq!((&object["states"], &object["patches"]), (&1.into(), &1.into()), "{object}");
    assert_eq!(object["state"]["load"], 0.0);
    assert!(object["seals_x"].is_null() && object["channel_x"].is_object(), "{object}");
    let said = String::from_utf8(asperity(&folder, &["patches", name])?.stdout)?;
    assert!(said.contains("no node has touched under load"), "{said}");
    assert!(said.contains(r"--resume 'it'\''s one.npz' --record 'it'\''s one.npz'"), "{said}");
    Ok(())
}
