//! Disks without room, and folders that are none: an exit code and a message that names the file, and nothing that
//! looks like a whole file and is not.
#![cfg(target_os = "linux")]

mod common;

use std::collections::BTreeMap;
use std::error::Error;
use std::ffi::OsStr;
use std::fs::{self, File};
use std::os::unix::fs::FileTypeExt;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Duration;

use common::{Scratch, asperity, data, is_refused, limited, said};

type Done = Result<(), Box<dyn Error>>;

fn words(line: &str) -> Vec<&OsStr> {
    line.split_whitespace().map(OsStr::new).collect()
}

/// Everything in a folder, by name.
fn files(folder: &Path) -> std::io::Result<BTreeMap<String, Vec<u8>>> {
    let mut files = BTreeMap::new();
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        files.insert(name, fs::read(entry.path())?);
    }
    Ok(files)
}

/// No file may be longer than so many blocks, as if the disk were full then. The oracle is what is written without a
/// limit, byte for byte.
fn whole_or_not_there(name: &str, arguments: &str, inputs: &[&str]) -> Done {
    let folder = Scratch::new(name)?;
    let run = |place: &str, blocks: &str| -> Result<Output, Box<dyn Error>> {
        let place = folder.join(place);
        fs::create_dir_all(&place)?;
        for input in inputs {
            fs::copy(data(input), place.join("input"))?;
        }
        let limit = format!("trap '' XFSZ && ulimit -f {blocks}");
        Ok(limited(&place, &limit, &words(arguments))?)
    };
    let done = run("whole", "unlimited")?;
    assert!(done.status.success(), "{}", said(&done));
    let expected = files(&folder.join("whole/out"))?;
    assert!(expected.len() > 1);
    let longest = expected.values().map(Vec::len).max().unwrap_or_default();
    let (mut failed, mut whole) = (0, 0);
    for power in 0..20 {
        let blocks = (1_usize << power) - 1;
        let place = format!("limited_{blocks}");
        let done = run(&place, &blocks.to_string())?;
        let found = files(&folder.join(&place).join("out"))?;
        let said = said(&done);
        for (name, bytes) in &found {
            if name == "path.csv.part" {
                // Lines that came so far, under a name that says so.
                continue;
            }
            assert!(expected.get(name) == Some(bytes), "{blocks}: {name} {said}");
            whole += 1;
        }
        let missing: Vec<&String> =
            expected.keys().filter(|name| !found.contains_key(*name)).collect();
        if !missing.is_empty() {
            // Of files that belong together the first that does not fit is named.
            let is_named = missing.iter().any(|name| said.contains(*name));
            assert!(is_named, "{blocks}: {missing:?} {said}");
            failed += missing.len();
        }
        assert_eq!(done.status.success(), found.len() == expected.len());
        // In the shortest blocks that a shell counts in.
        if 512 * blocks > longest {
            assert!(done.status.success(), "{blocks}: {said}");
            break;
        }
    }
    assert!(failed > 3 && whole >= expected.len(), "{failed} {whole}");
    Ok(())
}

#[test]
fn files_of_a_path_are_whole_or_not_there() -> Done {
    whole_or_not_there("full-path", "path --nodes 32 --record out/path.npz --fields npy", &[])
}

#[test]
fn pictures_of_a_surface_are_whole_or_not_there() -> Done {
    whole_or_not_there("full-info", "info input", &["surface_files/missing_f64.x3p"])
}

#[test]
fn fields_of_a_load_are_whole_or_not_there() -> Done {
    whole_or_not_there(
        "full-load",
        "load --surface input --side 1e-2 --e-star 1 --load 1e-7 --save out",
        &["selfaffine_48.npy"],
    )
}

#[test]
fn a_record_on_a_full_device() -> Done {
    let folder = Scratch::new("full-device")?;
    let full = Path::new("/dev/full");
    for saving in ["", "--save-every 10"] {
        let line = format!("path --nodes 32 --record /dev/full {saving}");
        let done = asperity(&folder.0, &words(&line)).output()?;
        is_refused(&done, &["cannot write /dev/full"]);
        assert!(fs::metadata(full)?.file_type().is_char_device());
        assert!(!folder.join("path.npz").exists());
    }
    Ok(())
}

#[test]
fn lines_for_programs_on_a_full_device() -> Done {
    let folder = Scratch::new("full-stdout")?;
    fs::copy(data("selfaffine_48.npy"), folder.join("input.npy"))?;
    for line in [
        "load --surface input.npy --side 1e-2 --e-star 1 --load 1e-7",
        "info input.npy --side 1e-2 --json",
        "path --nodes 16",
    ] {
        let mut command: Command = asperity(&folder.0, &words(line));
        let command = command.stdout(File::create("/dev/full")?).stderr(Stdio::piped());
        is_refused(&command.output()?, &["cannot write to stdout"]);
    }
    Ok(())
}

#[test]
fn a_file_in_place_of_a_folder() -> Done {
    let folder = Scratch::new("no-folder")?;
    fs::copy(data("selfaffine_48.npy"), folder.join("input.npy"))?;
    fs::write(folder.join("blocked"), "a file")?;
    for line in ["path --nodes 16 --record path.npz", "path --nodes 16 --seeds 1..2 --out runs"] {
        let done = asperity(&folder.0, &words(line)).output()?;
        assert!(done.status.success(), "{}", said(&done));
    }
    for line in [
        "path --nodes 16 --out blocked",
        "path --nodes 16 --seeds 1..2 --out blocked",
        "path --nodes 16 --record blocked/path.npz",
        "load --surface input.npy --side 1e-2 --e-star 1 --load 1e-7 --save blocked",
        "info input.npy --side 1e-2 --out blocked",
        "patches path.npz --out blocked",
        "gather runs --out blocked",
    ] {
        let done = asperity(&folder.0, &words(line)).output()?;
        is_refused(&done, &["blocked"]);
        assert_eq!(fs::read(folder.join("blocked"))?, b"a file", "{line}");
    }
    Ok(())
}

#[test]
fn a_folder_that_is_removed_while_a_path_is_followed() -> Done {
    let folder = Scratch::new("removed")?;
    let out = folder.join("out");
    let line = "path --nodes 128 --max-area-fraction 0.3 --record out/path.npz --fields vti";
    let mut command = asperity(&folder.0, &words(line));
    let mut process = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn()?;
    while !out.join("path.csv.part").exists() {
        assert!(process.try_wait()?.is_none(), "it has ended too early");
        std::thread::sleep(Duration::from_millis(1));
    }
    fs::remove_dir_all(&out)?;
    assert!(process.try_wait()?.is_none(), "it has ended too early");
    let done = process.wait_with_output()?;
    let names = ["path.csv", "path.npz", "fields.vti", "loading_curve.svg", "contact_map.png"];
    is_refused(&done, &names);
    assert!(!out.exists());
    Ok(())
}
