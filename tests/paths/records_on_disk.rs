//! Records on disk: whole, damaged, foreign and newer ones.

use std::fs;
use std::path::PathBuf;

use crate::problems::{grid, rough};
use asperity::loading::History;
use asperity::record::LoadingRecord;
use asperity::{Boussinesq, Error, FileError, LoadingSolver, PeriodicBoussinesq};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A file that is removed with its test.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let name = format!("asperity-record-{}-{name}.npz", std::process::id());
        Self(std::env::temp_dir().join(name))
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        // It may never have been made.
        let _ = fs::remove_file(&self.0);
    }
}

/// The record of a path, whole or up to a load.
fn record(load: Option<f64>) -> LoadingRecord {
    let kernel = Boussinesq::new(grid(), 1e9).unwrap();
    let surface = rough(&grid(), 7);
    let mut builder = LoadingSolver::builder(&surface, &kernel);
    if let Some(load) = load {
        builder = builder.max_load(load);
    }
    let mut path = builder.build().unwrap();
    let history = path.run().unwrap();
    LoadingRecord::new(&path, history).unwrap()
}

/// Everything that a record is made of.
fn same(a: &LoadingRecord, b: &LoadingRecord) -> bool {
    a.grid() == b.grid()
        && a.heights() == b.heights()
        && a.kernel() == b.kernel()
        && a.settings() == b.settings()
        && a.states() == b.states()
        && a.end() == b.end()
}

#[test]
fn what_is_written_is_read_back() {
    let file = Scratch::new("whole");
    let whole = record(None);
    // Half of the load of the path: it ends at a limit.
    let half = record(Some(0.5 * whole.states()[250].contact.load));
    for record in [whole, half] {
        let gap = record.heights().matrix().map(|height| -height);
        record.write_npz(&file.0, &[("initial_gap", &gap)]).unwrap();
        let first = fs::read(&file.0).unwrap();
        let read = LoadingRecord::read_npz(&file.0).unwrap();
        assert!(same(&read, &record));
        // The same record is the same file, bit for bit.
        read.write_npz(&file.0, &[("initial_gap", &gap)]).unwrap();
        assert_eq!(fs::read(&file.0).unwrap(), first);
        assert_eq!(read.resume().unwrap().targets(), record.settings().targets);
    }
}

/// Bodies are kept whatever the way, and must have the modulus of the path; a record of an earlier version knows none.
#[test]
fn bodies_are_kept() {
    let file = Scratch::new("bodies");
    let two = [(70e9, 0.33), (210e9, 0.3)];
    let e_star = asperity::composite_modulus(two[0], two[1]).unwrap();
    let made = |e_star: f64| {
        let kernel = Boussinesq::new(grid(), e_star).unwrap();
        let mut path = LoadingSolver::builder(&rough(&grid(), 7), &kernel).build().unwrap();
        let history: History = path.by_ref().take(20).collect::<Result<_, _>>().unwrap();
        LoadingRecord::new(&path, history).unwrap()
    };
    let plain = made(e_star);
    assert!(plain.bodies().is_empty());
    let without = serde_json::to_value(&plain).unwrap();
    let record = plain.with_bodies(&two).unwrap();
    record.write_npz(&file.0, &[]).unwrap();
    let read = LoadingRecord::read_npz(&file.0).unwrap();
    assert_eq!(read.bodies(), two);
    let mut text = serde_json::to_value(&record).unwrap();
    assert_eq!(serde_json::from_value::<LoadingRecord>(text.clone()).unwrap().bodies(), two);
    let mut older = without;
    older.as_object_mut().unwrap().remove("bodies").unwrap();
    assert!(serde_json::from_value::<LoadingRecord>(older).unwrap().bodies().is_empty());
    // Others are refused, given or read.
    text["bodies"][0][0] = serde_json::json!(71e9);
    assert!(serde_json::from_value::<LoadingRecord>(text).is_err());
    let one = [(e_star * 0.75, 0.5)];
    assert_eq!(made(e_star).with_bodies(&one).unwrap().bodies(), one);
    for bad in [&[(70e9, 0.33)][..], &[two[0], two[1], two[0]], &[(-1.0, 0.3)], &[(e_star, 0.7)]] {
        assert!(made(e_star).with_bodies(bad).is_err(), "{bad:?}");
    }
}

#[test]
fn a_periodic_path_has_no_contact_stiffness() {
    let file = Scratch::new("periodic");
    let kernel = PeriodicBoussinesq::new(grid(), 1e9).unwrap();
    let mut path = LoadingSolver::new(&rough(&grid(), 7), &kernel).unwrap();
    let history = path.run().unwrap();
    let record = LoadingRecord::new(&path, history).unwrap();
    record.write_npz(&file.0, &[]).unwrap();
    let read = LoadingRecord::read_npz(&file.0).unwrap();
    assert!(same(&read, &record));
    let last = read.states().last().unwrap();
    assert_eq!(last.contact.contact_stiffness, None);
    assert_eq!(last.contact.interfacial_stiffness, Some(f64::INFINITY));
}

/// Random corruptions, and truncations: an error, or the record itself where nothing that is read was hit. The
/// checksums of the archive see to that. The environment variable `ASPERITY_CORRUPTIONS` gives their number.
#[test]
fn damaged_records_are_refused() {
    let file = Scratch::new("damaged");
    let record = record(Some(20.0 * record(None).states()[20].contact.load));
    record.write_npz(&file.0, &[]).unwrap();
    let bytes = fs::read(&file.0).unwrap();
    let read = |bytes: &[u8]| {
        fs::write(&file.0, bytes).unwrap();
        LoadingRecord::read_npz(&file.0)
    };
    for length in (0..bytes.len()).step_by(97) {
        assert!(read(&bytes[..length]).is_err(), "{length} bytes");
    }
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let cases = std::env::var("ASPERITY_CORRUPTIONS").ok();
    let cases = cases.map_or(500, |cases| cases.parse().unwrap());
    for case in 0..cases {
        let mut damaged = bytes.clone();
        for _ in 0..random.random_range(1..=4) {
            let at = random.random_range(0..damaged.len());
            damaged[at] = random.random();
        }
        if let Ok(read) = read(&damaged) {
            assert!(same(&read, &record), "case {case}");
        }
    }
}

#[test]
fn foreign_and_newer_files_are_refused() {
    let file = Scratch::new("foreign");
    let bad = |file: &Scratch| LoadingRecord::read_npz(&file.0).unwrap_err().to_string();
    assert!(matches!(LoadingRecord::read_npz(&file.0), Err(Error::File(FileError::Io { .. }))));
    fs::write(&file.0, b"step,ix,iy").unwrap();
    assert!(bad(&file).contains("no readable asperity record"), "{}", bad(&file));
    // The version stands in the text of the parameters, which no compression hides, as UTF-32.
    record(None).write_npz(&file.0, &[]).unwrap();
    let bytes = fs::read(&file.0).unwrap();
    let wide = |text: &str| -> Vec<u8> {
        text.chars().flat_map(|letter| u32::from(letter).to_le_bytes()).collect()
    };
    let (old, new) = (wide("\"version\":1"), wide("\"version\":9"));
    let at = bytes.windows(old.len()).position(|window| window == old).unwrap();
    let mut newer = bytes;
    newer[at..at + new.len()].copy_from_slice(&new);
    fs::write(&file.0, newer).unwrap();
    // The checksum is that of the old text.
    assert!(matches!(
        LoadingRecord::read_npz(&file.0),
        Err(Error::File(FileError::BadFile { .. }))
    ));
}

/// A pipe into which nobody writes: opening it would never return.
#[cfg(unix)]
#[test]
fn a_pipe_is_refused() {
    let pipe = Scratch::new("pipe");
    let made = std::process::Command::new("mkfifo").arg(&pipe.0).status();
    // Without the program there is nothing to try.
    if made.is_ok_and(|status| status.success()) {
        let error = LoadingRecord::read_npz(&pipe.0).map(drop).unwrap_err();
        assert!(
            matches!(&error, Error::File(FileError::BadFile { path, reason, .. }) if *path == pipe.0 && reason.contains("regular")),
            "{error}"
        );
    }
}

#[test]
fn a_record_is_data() {
    let record = record(None);
    let text = serde_json::to_string(&record).unwrap();
    let read: LoadingRecord = serde_json::from_str(&text).unwrap();
    assert!(same(&read, &record));
    // A state that no path has is refused here as well.
    let twice = text.replacen("\"step\":2,", "\"step\":3,", 1);
    assert_ne!(twice, text);
    assert!(serde_json::from_str::<LoadingRecord>(&twice).is_err());
    // And heights of another number of nodes than 18 × 15.
    let mut fewer: serde_json::Value = serde_json::from_str(&text).unwrap();
    fewer["heights"].as_array_mut().unwrap().pop();
    let refused = serde_json::from_value::<LoadingRecord>(fewer).unwrap_err();
    let refused = refused.to_string();
    assert!(refused.contains("270") && refused.contains("269"), "{refused}");
}

/// Where nothing can be written nothing is left behind.
#[test]
fn an_unwritable_place_is_an_error() {
    let folder = std::env::temp_dir().join(format!("asperity-no-folder-{}", std::process::id()));
    let written = record(None).write_npz(folder.join("a.npz"), &[]);
    assert!(matches!(written, Err(Error::File(FileError::Io { .. }))));
    assert!(!folder.exists());
}
