//! Processes that are killed and resumed follow the path of one that was left alone.
#![allow(clippy::unwrap_used, missing_docs)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant, SystemTime};

/// A folder that is removed with its test.
struct Scratch(PathBuf);

impl Drop for Scratch {
    fn drop(&mut self) {
        // It may never have been made.
        let _ = fs::remove_dir_all(&self.0);
    }
}

const PATH: [&str; 9] =
    ["path", "--nodes", "64", "--seed", "3", "--max-area-fraction", "0.6", "--updater", "cholesky"];

/// States between two saves of a record.
const SAVE_EVERY: usize = 100;

fn asperity(arguments: &[&str], out: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_asperity"));
    command.args(arguments).arg("--out").arg(out).stdout(Stdio::null()).stderr(Stdio::null());
    command
}

/// The numbers of every line of a file of states.
fn states(file: &Path) -> Vec<Vec<f64>> {
    let text = fs::read_to_string(file).unwrap();
    let lines = text.lines().skip(1);
    // No number for the event.
    let number = |cell: &str| cell.parse().unwrap_or(0.0);
    lines.map(|line| line.split(',').map(number).collect()).collect()
}

/// Waits until something holds, or a process has ended.
fn wait_for(process: &mut Child, holds: impl Fn() -> bool) {
    while !holds() && process.try_wait().unwrap().is_none() {
        std::thread::sleep(Duration::from_micros(200));
    }
}

/// When a file was written, if it is there.
fn written(file: &Path) -> Option<SystemTime> {
    fs::metadata(file).and_then(|data| data.modified()).ok()
}

/// Processes are killed before their first record, and after records that are spread over the path. The environment
/// variable `ASPERITY_KILLS` gives the number of processes; the seed is fixed.
#[test]
fn killed_paths_go_on() {
    let name = format!("asperity-killed-{}", std::process::id());
    let folder = Scratch(std::env::temp_dir().join(name));
    let whole = folder.0.join("whole");
    let start = Instant::now();
    assert!(asperity(&PATH, &whole).status().unwrap().success());
    let time = start.elapsed();
    let expected = states(&whole.join("path.csv"));
    let kills = std::env::var("ASPERITY_KILLS").ok();
    let kills: u32 = kills.map_or(4, |kills| kills.parse().unwrap());
    let mut resumed = 0;
    for kill in 0..kills {
        let out = folder.0.join(format!("killed_{kill}"));
        let record = out.join("record.npz");
        fs::create_dir_all(&out).unwrap();
        let record_name = record.to_str().unwrap();
        let saving = ["--record", record_name, "--save-every", &SAVE_EVERY.to_string()];
        let mut process = asperity(&[&PATH[..], &saving].concat(), &out).spawn().unwrap();
        // The first one as soon as it makes states, the others after so many saves and a part of the way to the next
        // one, on which nothing here depends.
        let share = f64::from(kill) * 0.618_033_988_749_895 % 1.0;
        if kill == 0 {
            wait_for(&mut process, || out.join("path.csv.part").exists());
        }
        let saves = f64::from(kill.min(1)) + share * (expected.len() / SAVE_EVERY) as f64;
        for _ in 0..saves as usize {
            let before = written(&record);
            wait_for(&mut process, || written(&record) != before);
        }
        let between = time.as_secs_f64() * SAVE_EVERY as f64 / expected.len() as f64;
        std::thread::sleep(Duration::from_secs_f64(share * between));
        process.kill().unwrap();
        process.wait().unwrap();
        // A record is whole or not there, and a file of states has its name once it is whole.
        let again = if record.is_file() {
            resumed += 1;
            let go_on = ["path", "--updater", "cholesky", "--resume", record_name];
            asperity(&go_on, &out).status()
        } else {
            asperity(&PATH, &out).status()
        };
        assert!(again.unwrap().success(), "{kill}");
        let found = states(&out.join("path.csv"));
        assert_eq!(found.len(), expected.len(), "{kill}");
        for (found, expected) in found.iter().zip(&expected) {
            // Step and node, and then columns, of which the crate promises ten digits. Mean gaps are small
            // differences of the first one.
            assert_eq!(found[..3], expected[..3], "{kill}");
            for (column, (a, b)) in found.iter().zip(expected).enumerate().skip(3) {
                let scale = if column == 8 { 1e-4 } else { b.abs() };
                assert!((a - b).abs() <= 1e-10 * scale, "{kill}: {a} {b}");
            }
        }
    }
    // All but the first one have waited for a record.
    assert!(resumed + 1 >= kills, "{resumed} of {kills} left a record");
}
