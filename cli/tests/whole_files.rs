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

use asperity::io::read_npy;
use asperity::record::{AdhesiveRecord, LoadingRecord};
use common::{Scratch, asperity, data, limited, numbers, run, said};

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
    "leak ../path.npz --viscosity 1mPas --pressure-drop 1bar --along x --states 3 --out .",
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

/// The loads of a record, which can be read.
fn loads(record: &Path) -> Result<Vec<f64>, Box<dyn Error>> {
    let read = LoadingRecord::read_npz(record);
    Ok(match read {
        Ok(record) => record.states().iter().map(|state| state.contact.load).collect(),
        Err(_) => {
            let record = AdhesiveRecord::read_npz(record)?;
            record.states().states().iter().map(|state| state.contact.load).collect()
        }
    })
}

/// The last state of a path that broke off in a folder, by the table of the whole one: the one of this load, which is
/// not before the last that the table so far has.
fn last_state(place: &Path, whole: &Path, load: f64) -> Result<usize, Box<dyn Error>> {
    let part = fs::read(place.join("path.csv.part"))?;
    let lines = part.iter().filter(|byte| **byte == b'\n').count();
    let loads = numbers(&whole.join("path.csv"), "load")?;
    // Sums over the nodes are right to rounding, and so are events that are found again.
    let is_there = |other: &f64| (other / load - 1.0).abs() < 1e-10;
    let found = loads.iter().rposition(is_there).ok_or_else(|| format!("no state at {load}"))?;
    assert!(found + 2 >= lines, "{found} is before the end of {lines} lines");
    Ok(found)
}

/// Asserts that a file of a path that broke off is whole, and of its states so far.
fn is_of_the_states_so_far(place: &Path, whole: &Path, name: &str) -> Done {
    let bytes = fs::read(place.join(name))?;
    let starts = |begin: &[u8], end: &[u8]| {
        let is_whole = bytes.starts_with(begin) && bytes.trim_ascii_end().ends_with(end);
        assert!(is_whole, "{name} is not whole");
    };
    let table = whole.join("path.csv");
    match Path::new(name).extension().and_then(OsStr::to_str).unwrap_or_default() {
        "json" => assert_eq!(bytes, fs::read(whole.join(name))?, "{name}"),
        "png" => starts(b"\x89PNG", b"IEND\xaeB`\x82"),
        "svg" => starts(b"<svg", b"</svg>"),
        "html" => starts(b"<!", b"</html>"),
        "vti" => starts(b"<?xml", b"</VTKFile>"),
        // The last record of an archive without a comment has 22 bytes.
        "x3p" => assert!(bytes.len() > 22 && bytes[bytes.len() - 22..].starts_with(b"PK\x05\x06")),
        "npz" => {
            let (found, expected) = (loads(&place.join(name))?, loads(&whole.join(name))?);
            assert!(found.len() > 1 && expected.starts_with(&found), "{name}: {found:?}");
        }
        "npy" => {
            let (found, before) = (read_npy(place.join(name))?, read_npy(whole.join(name))?);
            // Those of single states have other names, and are the same.
            assert!(["pressure.npy", "gap.npy", "residual_surface.npy"].contains(&name), "{name}");
            assert_eq!(found.shape(), before.shape(), "{name}");
            assert!(found.iter().all(|value| value.is_finite()), "{name}");
            if name == "pressure.npy" {
                let cell = 1e-4 / found.len() as f64;
                let last = last_state(place, whole, found.sum() * cell)?;
                let nodes = found.iter().filter(|pressure| **pressure > 0.0).count();
                let share = numbers(&table, "contact_area_fraction")?[last];
                // What has just touched bears nothing yet.
                let expected = share * found.len() as f64;
                assert!((nodes as f64 - expected).abs() <= 1.0, "{name}: {nodes} {expected}");
                let gap = read_npy(place.join("gap.npy"))?.mean();
                let expected = numbers(&table, "mean_gap")?[last];
                assert!((gap / expected - 1.0).abs() < 1e-10, "gap.npy: {gap} {expected}");
            }
        }
        "csv" => {
            // The way back, from the last state.
            assert_eq!(name, "unloading.csv");
            let back = numbers(&place.join(name), "load")?;
            assert!(back.is_sorted_by(|a, b| a >= b), "{back:?}");
            let last = last_state(place, whole, back[0])?;
            let found = numbers(&place.join(name), "approach")?[0];
            let expected = numbers(&table, "approach")?[last];
            assert!((found / expected - 1.0).abs() < 1e-10, "{name}: {found} {expected}");
        }
        _ => return Err(format!("{name} is not known").into()),
    }
    Ok(())
}

/// No file may be longer than so many blocks, as if the disk were full then. The oracle is what is written without a
/// limit, byte for byte. A path whose table finds no room breaks off there, and its files are of its states so far.
#[test]
fn on_a_disk_without_room() -> Done {
    let folder = Scratch::new("full")?;
    inputs(&folder.0)?;
    let mut of_states_so_far = 0;
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
            let part = place.join("path.csv.part");
            let breaks_off = part.exists();
            if breaks_off {
                let so_far = fs::read(&part)?;
                assert!(expected["path.csv"].starts_with(&so_far), "{line}, {blocks}");
            }
            for (name, bytes) in &found {
                let expected = expected.get(name);
                assert!(expected.is_some(), "{line}, {blocks}: {name} {said}");
                if expected != Some(bytes) {
                    assert!(breaks_off, "{line}, {blocks}: {name} {said}");
                    is_of_the_states_so_far(&place, &whole, name)
                        .map_err(|error| format!("{line}, {blocks}: {name}: {error}"))?;
                    of_states_so_far += 1;
                }
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
    assert!(of_states_so_far > 0, "no path broke off with other files than its table");
    Ok(())
}

/// Whenever a command is killed, what has its name by then is what it writes if it is left alone. The environment
/// variable `ASPERITY_KILLS` gives how often each command is killed.
#[test]
fn after_a_kill() -> Done {
    let folder = Scratch::new("kill")?;
    inputs(&folder.0)?;
    let kills: u32 = std::env::var("ASPERITY_KILLS").map_or(Ok(4), |kills| kills.parse())?;
    let mut found_files = 0;
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
            found_files += found.len();
            // A record is written once more with the fields of its last state: see `killed.rs`.
            if found.remove("path.npz").is_some() {
                let [found, expected] =
                    [&place, &whole].map(|place| loads(&place.join("path.npz")));
                assert!(expected?.starts_with(&found?), "{line}, {kill}: path.npz");
            }
            for (name, bytes) in found {
                assert!(expected.get(&name) == Some(&bytes), "{line}, {kill}: {name}");
            }
        }
    }
    assert!(found_files > 0 || kills == 0, "every command was killed before its first file");
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
