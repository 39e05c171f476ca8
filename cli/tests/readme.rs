//! What the README shows is what the program prints.
#![allow(clippy::unwrap_used)]

mod common;

use std::fs;
use std::path::Path;

use common::{Scratch, asperity, said};

/// A line without what differs from run to run and from processor to processor: the time, and the residuals that are rounding.
fn lasting(line: &str) -> &str {
    let rounding =
        ["greatest gap in contact", "least pressure in contact", "sum of pressures less load"];
    if let Some((states, _)) = line.split_once(" states in ") {
        return states;
    }
    rounding.into_iter().find(|name| line.trim_start().starts_with(name)).unwrap_or(line)
}

/// The first command of the README, without arguments, prints the sample below it. If it fails because the program prints something
/// else on purpose, put what it prints into the README: `cargo run --release`.
#[test]
fn the_first_command_prints_the_sample() {
    let readme = Path::new(env!("CARGO_MANIFEST_DIR")).join("../README.md");
    let readme = fs::read_to_string(readme).unwrap();
    let sample = readme.split("```text\n").find(|block| block.starts_with("surface ")).unwrap();
    let sample = sample.split("```").next().unwrap();
    let folder = Scratch::new("readme").unwrap();
    let output = asperity(&folder.0, &[]).output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    // What it computes, and what came of it.
    let printed = said(&output) + &String::from_utf8(output.stdout).unwrap();
    let mut printed = printed.lines();
    for line in sample.lines() {
        assert_eq!(printed.next().map(lasting), Some(lasting(line)));
    }
    // Then come the names of what it wrote.
    assert!(printed.any(|line| line == "wrote out/report.html"));
    assert!(printed.any(|line| line == "wrote out/contact_map.png"));
}

/// Every command that the pages show is one that the program takes: with `--help` at its end it prints its help.
#[test]
fn commands_of_the_pages_are_taken() {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut pages = vec![repository.join("README.md"), repository.join("cli/README.md")];
    let documents = fs::read_dir(repository.join("docs")).unwrap();
    pages.extend(documents.map(|page| page.unwrap().path()).filter(|page| page.is_file()));
    let folder = Scratch::new("commands").unwrap();
    let mut commands = 0;
    for page in pages.iter().filter(|page| page.extension().is_some_and(|end| end == "md")) {
        let text = fs::read_to_string(page).unwrap();
        // Every second piece lies between fences.
        for line in text.split("\n```").skip(1).step_by(2).flat_map(str::lines) {
            let starts = ["cargo run --release -- ", "asperity "];
            let command = starts.iter().find_map(|start| line.strip_prefix(start));
            let command = command.filter(|command| !command.starts_with("= "));
            let Some(command) = command.and_then(|command| command.split('#').next()) else {
                continue;
            };
            // A job scheduler puts the number of the task there.
            let command = command.replace("$SLURM_ARRAY_TASK_ID", "1");
            let words = command.split_whitespace().chain(["--help"]);
            let words: Vec<&std::ffi::OsStr> = words.map(std::ffi::OsStr::new).collect();
            let output = asperity(&folder.0, &words).output().unwrap();
            assert!(output.status.success(), "{}: {line}: {}", page.display(), said(&output));
            commands += 1;
        }
    }
    assert!(commands > 20, "{commands}");
}
