//! Files that are cut and files with bytes that somebody overwrote: there is an answer, no panic, and no more memory
//! than the length of the file allows.
//!
//! The environment variable `ASPERITY_CORRUPTIONS` gives the number of corruptions of each file.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{Seek, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use allocation_counter::measure;
use asperity_surfaces::io::{LengthUnit, ReadOptions};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::{Scratch, own};

const CORRUPTIONS: u64 = 300;

/// Bytes of memory for each byte of a file: the file itself, eight for the height that one byte can make, in up to
/// three maps that share their bytes, with a mask of one byte each. A compressed file may take more, but only if what
/// it holds is as long as it says, which is no work of chance.
const BYTES_A_BYTE: u64 = 1 + 3 * (8 + 1);

/// What any file takes, for messages and paths, and what one with compressed parts takes for the tables of an inflater.
const BYTES_ANYWAY: u64 = 1 << 14;
const BYTES_OF_INFLATER: u64 = 1 << 17;

/// All own files, in a fixed order.
fn files() -> Vec<PathBuf> {
    let entries = fs::read_dir(own()).unwrap();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(files.len() >= 26, "{}", files.len());
    files
}

/// A file that takes other bytes again and again. It stays open: on many disks it takes a hundred times as long to
/// empty a file and to write it anew.
struct Target {
    path: Scratch,
    file: File,
}

impl Target {
    fn overwrite(&mut self, bytes: &[u8]) {
        self.file.rewind().unwrap();
        self.file.write_all(bytes).unwrap();
        self.file.set_len(bytes.len() as u64).unwrap();
    }
}

/// Does something with the bytes of each file and another file of the same ending.
fn with_each_file(test: &str, check: impl Fn(&[u8], &mut Target) + Sync) {
    files().par_iter().for_each(|file| {
        let name = file.file_name().unwrap().to_string_lossy();
        let path = Scratch::new(&format!("{test}-{name}"));
        let mut target = Target { file: File::create(&path.0).unwrap(), path };
        check(&fs::read(file).unwrap(), &mut target);
    });
}

/// Reads these bytes to the end: nothing is left that could stop the reader but the bytes.
fn read(bytes: &[u8], target: &mut Target, what: impl Fn() -> String) {
    target.overwrite(bytes);
    let options = ReadOptions::new().height_unit(LengthUnit::METRE).lateral_unit(LengthUnit::METRE);
    let mut panicked = false;
    let memory = measure(|| {
        let outcome = catch_unwind(AssertUnwindSafe(|| match options.read(&target.path.0) {
            Ok(surface) => surface.to_string(),
            Err(error) => error.to_string(),
        }));
        panicked = outcome.is_err();
    });
    let name = target.path.0.display();
    assert!(!panicked, "{name}, {}: the reader panicked", what());
    let inflates = ["sur", "x3p", "vk6"].map(OsStr::new).map(Some);
    let fixed = if inflates.contains(&target.path.0.extension()) {
        BYTES_OF_INFLATER
    } else {
        BYTES_ANYWAY
    };
    let limit = BYTES_A_BYTE * bytes.len() as u64 + fixed;
    assert!(
        memory.bytes_max <= limit,
        "{name}, {}: {} bytes of memory for {} bytes",
        what(),
        memory.bytes_max,
        bytes.len()
    );
}

#[test]
fn files_that_end_anywhere_are_harmless() {
    with_each_file("cut", |whole, target| {
        for end in 0..=whole.len() {
            read(&whole[..end], target, || format!("{end} bytes"));
        }
    });
}

/// Counts of nodes and lengths of blocks, in bytes and in digits, become none, or more than there can be.
#[test]
fn extreme_numbers_anywhere_are_harmless() {
    const NUMBERS: [&[u8]; 6] =
        [b"\0", b"\x7f", b"\xff", b"\xff\xff", b"\xff\xff\xff\xff", b"9999"];
    with_each_file("extreme", |whole, target| {
        for place in 0..whole.len() {
            for number in NUMBERS {
                let mut bytes = whole.to_vec();
                for (byte, extreme) in bytes.iter_mut().skip(place).zip(number) {
                    *byte = *extreme;
                }
                read(&bytes, target, || format!("{number:?} at byte {place}"));
            }
        }
    });
}

#[test]
fn corrupted_files_are_harmless() {
    let corruptions = match std::env::var("ASPERITY_CORRUPTIONS") {
        Ok(number) => number.parse().unwrap(),
        Err(_) => CORRUPTIONS,
    };
    with_each_file("corrupted", |whole, target| {
        for seed in 0..corruptions {
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            let mut bytes = whole.to_vec();
            for _ in 0..random.random_range(1..=8) {
                let place = random.random_range(0..bytes.len());
                bytes[place] = random.random();
            }
            read(&bytes, target, || format!("seed {seed}"));
        }
    });
}

/// Headers that agree with themselves, and with nothing that follows: 2^28 nodes or more in a few hundred bytes.
#[test]
fn consistent_lies_cost_no_memory() {
    const SIDE: [u8; 4] = 32768_u32.to_le_bytes();
    const HALF: [u8; 4] = 16384_u32.to_le_bytes();
    const NODES: [u8; 4] = (1_u32 << 30).to_le_bytes();
    // Nodes of the compressed file take two bytes each.
    const DATA: [u8; 4] = (1_u32 << 31).to_le_bytes();
    type Lie = (&'static str, &'static [(usize, &'static [u8])]);
    const LIES: [Lie; 9] = [
        ("missing_iso2_f8.sdf", &[(42, &SIDE), (46, &SIDE)]),
        ("missing_i16.sur", &[(108, &SIDE), (112, &SIDE), (116, &NODES)]),
        (
            "missing_i32_compressed.sur",
            &[(98, &[16, 0]), (108, &SIDE), (112, &SIDE), (116, &NODES), (516, &DATA)],
        ),
        ("missing_f32.al3d", &[(141, b"32768"), (193, b"32768")]),
        ("missing_u32.vk4", &[(388, &HALF), (392, &HALF), (404, &NODES)]),
        ("missing_f32.plu", &[(500, &SIDE), (504, &SIDE)]),
        ("missing_i16.opd", &[(244, &[0, 0x80]), (246, &[0, 0x80])]),
        ("missing_f32.opdx", &[(78, &SIDE), (82, &SIDE)]),
        // Most significant byte first: 2^28 heights of four bytes.
        ("missing_i32.dat", &[(68, &[0x40, 0, 0x40, 0, 0x40, 0, 0, 0])]),
    ];
    let told = AtomicUsize::new(0);
    with_each_file("lie", |whole, target| {
        let name = target.path.0.to_string_lossy().into_owned();
        for (_, lie) in LIES.iter().filter(|(file, _)| name.ends_with(file)) {
            told.fetch_add(1, Ordering::Relaxed);
            let mut bytes = whole.to_vec();
            for (place, number) in *lie {
                bytes[*place..place + number.len()].copy_from_slice(number);
            }
            read(&bytes, target, || "a lie".to_string());
            let refused = ReadOptions::new().read(&target.path.0).unwrap_err();
            // It has come as far as the data.
            let reason = refused.to_string();
            assert!(
                reason.contains("more bytes") || reason.contains("compressed bytes can hold"),
                "{reason}"
            );
        }
    });
    assert_eq!(told.into_inner(), LIES.len(), "a file has another name");
}

/// A text that a file has once, and that each of its maps of one node would have.
#[test]
fn a_long_text_is_not_taken_once_for_each_map() {
    const MAPS: usize = 1000;
    // A map of these files is some 30 bytes, and has a name of up to 260, which is copied to tell it from the others
    // and once more for the message.
    const BYTES_A_MAP: u64 = 3000;
    let text = "x".repeat(30_000);
    for (name, file) in [("long.opd", opd(&text, MAPS)), ("long.nid", nid(&text, MAPS))] {
        let mut told = String::new();
        let memory = measure(|| {
            told = match ReadOptions::new().read_bytes(&file, name) {
                Ok(surface) => surface.to_string(),
                Err(error) => error.to_string(),
            };
        });
        assert!(told.contains("[1000]"), "{name}: {}", &told[..200]);
        let limit = BYTES_A_MAP * MAPS as u64 + 10 * file.len() as u64;
        assert!(memory.bytes_max <= limit, "{name}: {} bytes", memory.bytes_max);
    }
}

/// A long section that each of many maps asks for its keys.
#[test]
fn a_long_section_is_not_searched_once_for_each_map() {
    let lines: String = (0..5000).map(|k| format!("\nk{k}=x")).collect();
    let file = nid(&format!("x{lines}"), 4096);
    let start = std::time::Instant::now();
    let told = ReadOptions::new().read_bytes(&file, "long.nid").unwrap_err().to_string();
    let seconds = start.elapsed().as_secs_f64();
    assert!(told.contains("[4096]"), "{}", &told[..200]);
    assert!(seconds < 5.0, "{seconds} s for {} bytes", file.len());
}

/// Maps of one node under one title.
fn opd(title: &str, maps: usize) -> Vec<u8> {
    let entry = |name: &str, length: usize| {
        let mut entry = name.as_bytes().to_vec();
        entry.resize(16, 0);
        entry.extend(1_u16.to_le_bytes());
        entry.extend((length as u32).to_le_bytes());
        entry.extend(0_u16.to_le_bytes());
        entry
    };
    let map = [1, 0, 1, 0, 2, 0, 7, 0];
    let mut file = vec![1, 0];
    file.extend(entry("Directory", 24 * (maps + 2)));
    file.extend(entry("Title", title.len()));
    file.extend(entry("RAW_DATA", map.len()).repeat(maps));
    file.extend(title.as_bytes());
    file.extend(map.repeat(maps));
    file
}

/// Maps of one node that one section describes.
fn nid(frame: &str, maps: usize) -> Vec<u8> {
    let groups = maps.div_ceil(64);
    let mut file = format!("[DataSet]\nGroupCount={groups}\n");
    for group in 0..groups {
        let count = (maps - 64 * group).min(64);
        file += &format!("Gr{group}-Count={count}\n");
        for channel in 0..count {
            file += &format!("Gr{group}-Ch{channel}=A\n");
        }
    }
    file += "[A]\nPoints=1\nLines=1\nSaveMode=Binary\nSaveBits=8\nSaveSign=Signed\nSaveOrder=Intel\n\
             Dim0Range=1\nDim1Range=1\nDim2Range=1\nDim2Min=0\nDim2Name=Height\n";
    file += &format!("Dim0Unit={frame}\nDim1Unit={frame}\nDim2Unit={frame}\nFrame={frame}\n#!");
    let mut file = file.into_bytes();
    file.extend(vec![1; maps]);
    file
}
