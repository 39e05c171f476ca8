//! What the README shows is what the program prints, and the commands of all pages run.
#![allow(clippy::unwrap_used)]

mod common;

use std::fs;
use std::path::Path;

use asperity::Grid;
use asperity::io::{read_npy, write_npy, write_x3p};
use common::{Scratch, asperity, data, run, said};
use nalgebra::DMatrix;

/// A line without what differs from run to run and from processor to processor: the time, and the residuals that are
/// rounding.
fn lasting(line: &str) -> &str {
    let rounding =
        ["greatest gap in contact", "least pressure in contact", "sum of pressures less load"];
    if let Some((states, _)) = line.split_once(" states in ") {
        return states;
    }
    rounding.into_iter().find(|name| line.trim_start().starts_with(name)).unwrap_or(line)
}

/// The first command of the README, without arguments, prints the sample below it. If it fails because the program
/// prints something else on purpose, put what it prints into the README: `cargo run --release`.
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
    for name in ["report.html", "contact_map.png"] {
        let wrote = format!("wrote {}", Path::new("out").join(name).display());
        assert!(printed.any(|line| line == wrote), "{wrote}");
    }
}

/// What takes long on a page is done on less here.
const SMALLER: [(&str, &str); 7] = [
    ("--nodes 256", "--nodes 64"),
    ("--nodes 128", "--nodes 64"),
    ("--seeds 1..200", "--seeds 1..4"),
    // A job scheduler puts the number of the task there.
    ("$SLURM_ARRAY_TASK_ID/40", "1/4"),
    // The surface of the page, on fewer nodes.
    (
        "path --periodic love --max-area-fraction 0.6",
        "path --nodes 64 --short-cutoff 312.5e-6 --periodic love --max-area-fraction 0.6",
    ),
    (
        "path --max-area-fraction 0.2 --hardness",
        "path --nodes 64 --max-area-fraction 0.2 --hardness",
    ),
    ("path --material copper", "path --nodes 64 --material copper"),
];

/// The lines of the pages in docs, of the README, and of that of the program which stand between fences and are
/// commands.
fn commands(page: &Path) -> Vec<String> {
    let text = fs::read_to_string(page).unwrap();
    // Every second piece lies between fences; a backslash goes on in the next line.
    let fenced = text.split("\n```").skip(1).step_by(2).map(|piece| piece.replace("\\\n", " "));
    let lines: Vec<String> =
        fenced.flat_map(|piece| piece.lines().map(str::to_string).collect::<Vec<_>>()).collect();
    let commands = lines.iter().map(|line| line.split(" #").next().unwrap_or_default());
    commands
        .filter(|line| {
            line.starts_with("cargo run ")
                || line.starts_with("asperity ") && !line.starts_with("asperity = ")
        })
        .map(str::to_string)
        .collect()
}

/// A folder with the files that the pages speak of. The ball is as large as its page says.
fn with_files(page: &str) -> Scratch {
    let folder = Scratch::new(&format!("commands-{page}")).unwrap();
    fs::create_dir_all(folder.join("tests/data")).unwrap();
    fs::copy(data("selfaffine_128.npy"), folder.join("tests/data/selfaffine_128.npy")).unwrap();
    fs::copy(data("selfaffine_48.npy"), folder.join("rough.npy")).unwrap();
    // A format is known by its content.
    let rough = read_npy(folder.join("rough.npy")).unwrap();
    write_x3p(folder.join("ground.x3p"), &Grid::square(48, 1e-2).unwrap(), &rough).unwrap();
    for name in ["ground.sdf", "shaft.sdf", "bush.sdf"] {
        fs::copy(folder.join("ground.x3p"), folder.join(name)).unwrap();
    }
    let line = |i: u32| {
        let (x, wave) = (f64::from(i), |length: f64| 0.2 * (f64::from(i) / length).sin());
        format!("{}; {}\n", 0.02 * x, wave(1.7) + wave(11.3))
    };
    let profile: String = (0..400).map(line).collect();
    fs::write(folder.join("roller.csv"), format!("x [mm]; z [µm]\n{profile}")).unwrap();
    let (side, radius) =
        if page == "coated_and_thin_bodies" { (160e-6, 5e-3) } else { (4e-3, 50e-3) };
    let ball = DMatrix::from_fn(64, 64, |ix, iy| {
        let [x, y] = [ix, iy].map(|i| side * ((i as f64 + 0.5) / 64.0 - 0.5));
        -(x * x + y * y) / (2.0 * radius)
    });
    write_npy(folder.join("ball.npy"), &ball).unwrap();
    run(&folder.0, "path --nodes 16 --record other.npz --out other").unwrap();
    folder
}

/// Every command that the pages show runs, in the order of its page, but for the first one of the README, which has its
/// own test. Of studies, which `cargo test` does not build, there is the program.
#[test]
fn commands_of_the_pages_run() {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut pages = vec![repository.join("README.md"), repository.join("cli/README.md")];
    let documents = fs::read_dir(repository.join("docs")).unwrap();
    pages.extend(documents.map(|page| page.unwrap().path()));
    pages.retain(|page| page.extension().is_some_and(|end| end == "md"));
    let mut unused: Vec<&str> = SMALLER.iter().map(|(much, _)| *much).collect();
    let mut ran = 0;
    for page in pages {
        let name = page.file_stem().unwrap().to_str().unwrap();
        let mut folder = None;
        for line in commands(&page) {
            if let Some(study) = line.strip_prefix("cargo run --release -p asperity-studies --bin ")
            {
                let study = study.split(' ').next().unwrap();
                let program = repository.join("studies/src/bin").join(study);
                assert!(
                    study == "STUDY" || program.is_dir() || program.with_extension("rs").is_file(),
                    "{line}"
                );
                continue;
            }
            let starts = ["cargo run --release -- ", "asperity "];
            let Some(command) = starts.iter().find_map(|start| line.strip_prefix(start)) else {
                assert_eq!(line, "cargo run --release", "{name}");
                continue;
            };
            let mut command = command.to_string();
            for (much, little) in SMALLER.iter().filter(|(much, _)| line.contains(much)) {
                command = command.replace(much, little);
                unused.retain(|other| other != much);
            }
            let start = std::time::Instant::now();
            run(&folder.get_or_insert_with(|| with_files(name)).0, &command).unwrap();
            println!("{:6.2} s  {name}: {command}", start.elapsed().as_secs_f64());
            ran += 1;
        }
    }
    assert!(ran > 25 && unused.is_empty(), "{ran} {unused:?}");
}
