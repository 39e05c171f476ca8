//! Whatever ends a command, a disk without room or SIGKILL: a file that has its name is whole.
#![cfg(target_os = "linux")]

mod common;

use std::collections::BTreeMap;
use std::error::Error;
use std::ffi::OsStr;
use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

use common::{Scratch, asperity, data, limited, run, said};

type Done = Result<(), Box<dyn Error>>;

/// Every command that writes files, in a folder beside what it reads.
const COMMANDS: [&str; 12] = [
    "path --nodes 32 --max-area-fraction 0.1 --record path.npz --fields npy --report --at 10MPa --out .",
    "path --nodes 24 --max-area-fraction 0.1 --yield --unload --fields vti --record path.npz --out .",
    "path --nodes 24 --max-area-fraction 0.05 --work-of-adhesion 1e4 --unload --record path.npz --out .",
    "path --nodes 16 --max-area-fraction 0.2 --seeds 1..3 --out runs",
    "load --surface ../rough.npy --side 1e-2 --e-star 1 --load 1e-7 --save .",
    "info ../holed.x3p --out .",
    "patches ../path.npz --out .",
    "slip ../path.npz --friction 0.3 --material steel --out .",
    "stress ../path.npz --material steel --volume 3 --out .",
    "leak ../path.npz --viscosity 1mPas --pressure-drop 1bar --along x --states 2 --out .",
    "creep ../path.npz --prony 1,1 --load 1kN --time 10 --fields npy --out .",
    "gather ../runs --out .",
];

/// What the commands read.
fn inputs(folder: &Path) -> Done {
    fs::copy(data("selfaffine_48.npy"), folder.join("rough.npy"))?;
    fs::copy(data("surface_files/missing_f64.x3p"), folder.join("holed.x3p"))?;
    run(folder, "path --nodes 24 --max-area-fraction 0.3 --record path.npz --out path -q")?;
    run(folder, "path --nodes 16 --max-area-fraction 0.2 --seeds 1..2 --out runs -q")?;
    Ok(())
}

fn words(line: &str) -> Vec<&OsStr> {
    line.split_whitespace().map(OsStr::new).collect()
}

/// Everything in a folder and the folders in it by name, but what says by its name that it is not whole.
fn files(folder: &Path) -> std::io::Result<BTreeMap<String, Vec<u8>>> {
    let mut files = BTreeMap::new();
    for entry in fs::read_dir(folder)? {
        let place = entry?.path();
        let name = place.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if name.ends_with(".part") || name.ends_with(".unfinished") {
            continue;
        }
        if place.is_dir() {
            let inner = self::files(&place)?.into_iter();
            files.extend(inner.map(|(inner, bytes)| (format!("{name}/{inner}"), bytes)));
        } else {
            files.insert(name, fs::read(place)?);
        }
    }
    Ok(files)
}

/// A folder for one run.
fn place(folder: &Scratch, name: &str) -> std::io::Result<std::path::PathBuf> {
    let place = folder.join(name);
    fs::create_dir_all(&place)?;
    Ok(place)
}

/// No file may be longer than so many blocks, as if the disk were full then. The oracle is what is written without a
/// limit, byte for byte.
#[test]
fn on_a_disk_without_room() -> Done {
    let folder = Scratch::new("full")?;
    inputs(&folder.0)?;
    for (count, line) in COMMANDS.iter().enumerate() {
        let whole = place(&folder, &format!("whole_{count}"))?;
        run(&whole, line)?;
        let expected = files(&whole)?;
        assert!(!expected.is_empty(), "{line}");
        let longest = expected.values().map(Vec::len).max().unwrap_or_default();
        let mut failed = 0;
        for power in 0..20 {
            let blocks = (1_usize << power) - 1;
            let place = place(&folder, &format!("limited_{count}_{blocks}"))?;
            let limit = format!("trap '' XFSZ && ulimit -f {blocks}");
            let done = limited(&place, &limit, &words(line))?;
            let found = files(&place)?;
            let said = said(&done);
            // A path whose table finds no room breaks off there, and the other files are of its states so far.
            let breaks_off = place.join("path.csv.part").exists();
            for (name, bytes) in &found {
                let is_whole = match expected.get(name) {
                    Some(expected) => expected == bytes || breaks_off,
                    None => false,
                };
                assert!(is_whole, "{line}, {blocks}: {name} {said}");
            }
            let missing: Vec<&String> =
                expected.keys().filter(|name| !found.contains_key(*name)).collect();
            assert_eq!(done.status.success(), missing.is_empty(), "{line}, {blocks}: {missing:?}");
            // Of files that belong together the first that does not fit is named.
            let is_named = |name: &&String| {
                said.contains(Path::new(name).file_name().and_then(OsStr::to_str).unwrap_or(name))
            };
            let is_told = missing.is_empty() || missing.iter().any(is_named);
            assert!(is_told, "{line}, {blocks}: {missing:?} {said}");
            failed += missing.len();
            // In the shortest blocks that a shell counts in.
            if 512 * blocks > longest {
                assert!(done.status.success(), "{line}, {blocks}: {said}");
                break;
            }
        }
        assert!(failed > 0, "{line}");
    }
    Ok(())
}

/// The environment variable `ASPERITY_KILLS` gives how often each command is killed.
#[test]
fn after_a_kill() -> Done {
    let folder = Scratch::new("kill")?;
    inputs(&folder.0)?;
    let kills: u32 = std::env::var("ASPERITY_KILLS").map_or(Ok(4), |kills| kills.parse())?;
    for (count, line) in COMMANDS.iter().enumerate() {
        let whole = place(&folder, &format!("whole_{count}"))?;
        let start = Instant::now();
        run(&whole, line)?;
        let time = start.elapsed();
        let expected = files(&whole)?;
        for kill in 0..kills {
            let place = place(&folder, &format!("killed_{count}_{kill}"))?;
            let mut command = asperity(&place, &words(line));
            let mut process = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn()?;
            // Moments spread over the whole run.
            let share = f64::from(kill + 1) * 0.618_033_988_749_895 % 1.0;
            std::thread::sleep(Duration::from_secs_f64(share * time.as_secs_f64()));
            process.kill()?;
            process.wait()?;
            let mut found = files(&place)?;
            // A record is written once more with the fields of its last state: see `killed.rs`.
            found.remove("path.npz");
            for (name, bytes) in found {
                assert!(expected.get(&name) == Some(&bytes), "{line}, {kill}: {name}");
            }
        }
    }
    Ok(())
}

/// Two runs do not write into one folder at once: the second one is refused, and the first one's table is whole.
#[test]
fn a_folder_is_of_one_run() -> Done {
    let folder = Scratch::new("one-run")?;
    fs::create_dir(folder.join("out"))?;
    let part = folder.join("out/path.csv.part");
    let other = fs::File::create(&part)?;
    other.lock()?;
    let line = "path --nodes 12 --max-area-fraction 0.1";
    let done = asperity(&folder.0, &words(line)).output()?;
    assert_eq!(done.status.code(), Some(1), "{}", said(&done));
    assert!(said(&done).contains("give another --out"), "{}", said(&done));
    drop(other);
    run(&folder.0, line)?;
    assert!(folder.join("out/path.csv").exists() && !part.exists());
    Ok(())
}
