//! Processes that are killed and resumed follow the path of one that was left alone.
#![allow(clippy::unwrap_used, missing_docs)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

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

/// The environment variable `ASPERITY_KILLS` gives the number of processes; the seed is fixed.
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
        let saving = ["--record", record_name, "--save-every", "100"];
        let mut process = asperity(&[&PATH[..], &saving].concat(), &out).spawn().unwrap();
        // Moments spread over the whole run.
        let share = f64::from(kill + 1) * 0.618_033_988_749_895 % 1.0;
        std::thread::sleep(Duration::from_secs_f64(share * time.as_secs_f64()));
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
    assert!(resumed > 0, "no process lived long enough to write its record");
}
