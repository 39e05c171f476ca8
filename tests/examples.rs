//! Examples print what their documentation says: the last block of text in it is the output, to the last digit.
//!
//! The programs are those that `cargo test --release` has built beside this test; `cargo test --release --test
//! examples` builds none, and needs `cargo build --release --examples` before it. Without optimisation they would take
//! minutes.
#![cfg(all(feature = "io", feature = "rayon"))]
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The sources of all examples.
fn examples() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut sources: Vec<_> =
        files.filter(|file| file.extension().is_some_and(|ending| ending == "rs")).collect();
    sources.sort();
    sources
}

/// The last block of text in the documentation of a program; the command that runs it stands in the one before.
fn promised(source: &str, name: &str) -> String {
    let lines = source.lines().map_while(|line| line.strip_prefix("//!"));
    let lines: Vec<&str> = lines.map(|line| line.strip_prefix(' ').unwrap_or(line)).collect();
    let mut blocks = Vec::new();
    let mut rest = lines.iter();
    while rest.any(|line| *line == "```text") {
        let block = rest.by_ref().take_while(|line| **line != "```");
        blocks.push(block.copied().collect::<Vec<_>>().join("\n"));
    }
    let [.., command, output] = &blocks[..] else {
        panic!(
            "{name}: its documentation has no block of text for its command, and one for its output"
        );
    };
    assert_eq!(*command, format!("cargo run --release --example {name}"));
    assert!(!output.is_empty(), "{name}");
    output.clone()
}

/// The program of an example, beside this one.
fn program(name: &str) -> PathBuf {
    let test = std::env::current_exe().unwrap();
    let folder = test.ancestors().nth(2).unwrap().join("examples");
    folder.join(format!("{name}{}", std::env::consts::EXE_SUFFIX))
}

#[test]
#[cfg_attr(
    debug_assertions,
    ignore = "examples are compared where they are fast: in a release build"
)]
fn examples_print_what_they_promise() {
    let sources = examples();
    // So that an empty folder is no success: as many as there are, or more.
    assert!(sources.len() >= 17, "{} examples", sources.len());
    let mut different = Vec::new();
    for source in &sources {
        let name = source.file_stem().unwrap().to_str().unwrap();
        let promised = promised(&fs::read_to_string(source).unwrap(), name);
        let program = program(name);
        assert!(
            program.is_file(),
            "{} is not there: `cargo test --release` builds it, and so does `cargo build --release --examples`",
            program.display()
        );
        let run = Command::new(&program).current_dir(env!("CARGO_MANIFEST_DIR")).output().unwrap();
        let said = String::from_utf8_lossy(&run.stderr);
        assert!(run.status.success(), "{name}: {said}");
        assert!(said.is_empty(), "{name} complains: {said}");
        let printed = String::from_utf8(run.stdout).unwrap();
        // Editors strip spaces at the ends of lines.
        let printed: Vec<&str> = printed.trim_end().lines().map(str::trim_end).collect();
        let promised: Vec<&str> = promised.trim_end().lines().map(str::trim_end).collect();
        if printed != promised {
            println!("{name} prints\n{}\n\nand not\n{}\n", printed.join("\n"), promised.join("\n"));
            different.push(name.to_string());
        }
    }
    assert!(different.is_empty(), "their documentation says something else: {different:?}");
}
