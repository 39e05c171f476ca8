//! Devices without room, and folders that are none: an exit code and a message that names the file.
#![cfg(target_os = "linux")]

mod common;

use std::error::Error;
use std::ffi::OsStr;
use std::fs::{self, File};
use std::os::unix::fs::FileTypeExt;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use common::{Scratch, asperity, data, is_refused, said};

type Done = Result<(), Box<dyn Error>>;

fn words(line: &str) -> Vec<&OsStr> {
    line.split_whitespace().map(OsStr::new).collect()
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

/// Whether a process is stopped, so that it does nothing until it is told to go on.
fn is_stopped(process: u32) -> std::io::Result<bool> {
    let stat = fs::read_to_string(format!("/proc/{process}/stat"))?;
    // The name of the program, in parentheses, is before the letter of the state.
    Ok(stat.rsplit(')').next().is_some_and(|rest| rest.trim_start().starts_with('T')))
}

/// The path is told of what cannot be written, at the end, wherever it is when its folder goes.
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
    // It is in the middle, and waits there until the folder is gone.
    let id = process.id();
    let signal = |name: &str| Command::new("kill").args([name, &id.to_string()]).status();
    assert!(signal("-STOP")?.success());
    while !is_stopped(id)? {
        assert!(process.try_wait()?.is_none(), "it has ended too early");
        std::thread::sleep(Duration::from_millis(1));
    }
    assert!(out.join("path.csv.part").exists(), "it has ended too early");
    fs::remove_dir_all(&out)?;
    assert!(signal("-CONT")?.success());
    let done = process.wait_with_output()?;
    let names = ["path.csv", "path.npz", "fields.vti", "loading_curve.svg", "contact_map.png"];
    is_refused(&done, &names);
    assert!(!out.exists());
    Ok(())
}
