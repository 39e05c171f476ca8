//! The program in an address space hardly larger than its memory budget: what does not fit is refused in words.
#![cfg(target_os = "linux")]

mod common;

use std::error::Error;
use std::ffi::OsStr;
use std::fs::File;
use std::io::Write;
use std::path::Path;
use std::process::Output;

use common::{Scratch, is_refused, limited, said};

type Done = Result<(), Box<dyn Error>>;

/// The program with two threads in an address space of so many megabytes.
fn run(folder: &Path, megabytes: usize, line: &str) -> std::io::Result<Output> {
    let limit = format!("export RAYON_NUM_THREADS=2 && ulimit -v {}", megabytes * 1024);
    let arguments: Vec<&OsStr> = line.split_whitespace().map(OsStr::new).collect();
    limited(folder, &limit, &arguments)
}

/// A file of n × n heights, all 0, that takes no room on the disk.
fn flat(file: &Path, n: u64) -> std::io::Result<()> {
    let mut header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({n}, {n}), }}");
    // The header of the format ends at a multiple of 64 bytes, with a line break.
    let length = (10 + header.len() + 1).next_multiple_of(64) - 10;
    header = format!("{header:<width$}\n", width = length - 1);
    let mut output = File::create(file)?;
    output.write_all(b"\x93NUMPY\x01\x00")?;
    output.write_all(&(length as u16).to_le_bytes())?;
    output.write_all(header.as_bytes())?;
    output.set_len(10 + length as u64 + 8 * n * n)
}

/// What a refusal takes: the program itself and its stacks; 17 MB were measured.
const REFUSAL: usize = 64;
/// What a path takes beside its budget: each thread reserves 64 MB of addresses to allocate from, the one that draws
/// the progress too, and no memory; 223 MB were measured.
const ROOM: usize = 256;

#[test]
fn paths_on_large_grids_are_refused_in_words() -> Done {
    let folder = Scratch::new("space-path")?;
    for (nodes, budget) in [(2048, 100), (16384, 100), (16384, 2000)] {
        for periodic in ["", "--periodic love", "--periodic spectral"] {
            let line = format!("path --nodes {nodes} --memory-budget {budget}e6 {periodic}");
            let done = run(&folder.0, REFUSAL, &line)?;
            let budget = if budget < 1000 {
                format!("the budget is {budget} MB")
            } else {
                format!("the budget is {} GB", budget / 1000)
            };
            is_refused(&done, &[&budget, "the largest square grid that fits"]);
        }
    }
    Ok(())
}

#[test]
fn loads_on_large_grids_are_refused_in_words() -> Done {
    let folder = Scratch::new("space-load")?;
    // 32 MB of heights are read before anything else is known of them, and are held twice while they are; the system's
    // allocator reserves another 64 MB of addresses for each thread that allocates.
    flat(&folder.join("2048.npy"), 2048)?;
    let line = "load --surface 2048.npy --side 1e-3 --e-star 1e9 --load 1 --memory-budget 100e6";
    let done = run(&folder.0, REFUSAL + 192, line)?;
    is_refused(&done, &["the budget is 100 MB", "the largest square grid"]);
    // 2 GB of heights do not even fit.
    flat(&folder.join("16384.npy"), 16384)?;
    for command in ["load --load 1", "path"] {
        let line =
            format!("{command} --surface 16384.npy --side 1e-3 --e-star 1e9 --memory-budget 100e6");
        is_refused(&run(&folder.0, REFUSAL, &line)?, &["16384.npy"]);
    }
    Ok(())
}

/// What fits runs: a single load, a path that gives up its factor on the way, and one that keeps it to where the budget
/// ends, with all states up to there.
#[test]
fn what_fits_the_budget_runs() -> Done {
    let folder = Scratch::new("space-fits")?;
    flat(&folder.join("256.npy"), 256)?;
    for line in [
        "load --surface 256.npy --side 1e-3 --e-star 1e9 --load 1 --memory-budget 64e6",
        "path --nodes 64 --max-area-fraction 0.9 --memory-budget 60e6",
    ] {
        let done = run(&folder.0, ROOM + 64, line)?;
        assert!(done.status.success(), "{}", said(&done));
    }
    let line = "path --nodes 128 --max-area-fraction 0.9 --updater cholesky --memory-budget 60e6";
    is_refused(&run(&folder.0, ROOM + 60, line)?, &["the budget is 60 MB"]);
    let states = std::fs::read_to_string(folder.join("out/path.csv.part"))?;
    // The factor takes 4 bytes for each pair of nodes: some 60 MB hold 3000 nodes, less what the grid takes.
    assert!((1000..4000).contains(&states.lines().count()));
    Ok(())
}

/// Without `--memory-budget` the limit of the address space is known: the error names a budget below it, and nothing is
/// aborted.
#[test]
fn the_default_budget_knows_the_limit() -> Done {
    let folder = Scratch::new("space-default")?;
    for periodic in ["", "--periodic love", "--periodic spectral"] {
        let done = run(&folder.0, 3000, &format!("path --nodes 6000 {periodic}"))?;
        is_refused(&done, &["the budget is 2.2 GB", "the largest square grid that fits"]);
    }
    // 288 MB of heights are read before the memory of the solver is counted.
    flat(&folder.join("6000.npy"), 6000)?;
    let line = "load --surface 6000.npy --side 1e-3 --e-star 1e9 --load 1";
    is_refused(&run(&folder.0, 3000, line)?, &["the budget is 2.2 GB", "the largest square grid"]);
    // What fits below it runs to its end.
    let done = run(&folder.0, 1000, "path --nodes 64 --max-area-fraction 0.9")?;
    assert!(done.status.success(), "{}", said(&done));
    Ok(())
}
