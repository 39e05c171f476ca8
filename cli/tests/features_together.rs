//! The column of ensembles of `docs/features_together.md`: a path of `--seeds` is the one of its seed alone, in every
//! byte.

mod common;

use std::error::Error;
use std::fs;
use std::path::Path;

use asperity_testing::page::tables;
use common::{Scratch, output, said};

type Done = Result<(), Box<dyn Error>>;

const COLUMN: &str = "ensembles";
/// The row whose loads are on two branches, so that they have no mean.
const ADHESION: &str = "adhesion";

/// Each row of the page: what the program is told, and the files that are compared beside `path.csv`.
const ROWS: [(&str, &str, &[&str]); 16] = [
    ("free", "", &["pressure.npy", "gap.npy"]),
    ("periodic", "--periodic love", &["pressure.npy"]),
    ("periodic x", "--periodic x", &["pressure.npy"]),
    ("periodic y", "--periodic y", &["pressure.npy"]),
    ("non-square cells", "--side 1e-2 --side-y 1.5e-2", &["pressure.npy"]),
    ("full contact", "--periodic love --max-area-fraction 1", &["pressure.npy"]),
    ("hardness", "--hardness 3e9", &["pressure.npy"]),
    ("hardness per node", "--hardness hardness.npy", &[]),
    // The program ends it at a load: what all nodes bear is no target.
    ("fully plastic", "--hardness 1e8 --mean-pressure 9.99999e7", &["pressure.npy"]),
    ("after unloading", "--hardness 3e9 --unload", &["unloading.csv", "residual_surface.npy"]),
    ("sheet", "--layer 3e6,0.49,1e-3 --base rigid", &["pressure.npy"]),
    ("soft layer", "--layer gold,1e-4 --base steel", &["pressure.npy"]),
    ("stiff layer", "--layer steel,6e-4 --base 3e9,0.3", &["pressure.npy"]),
    ("without a factor", "--updater iterative", &["pressure.npy"]),
    ("resumed", "--periodic spectral", &["pressure.npy"]),
    (ADHESION, "--work-of-adhesion 1000", &["pressure.npy", "gap.npy"]),
];

/// What the program says if it refuses, `None` if it does what is asked.
fn refused(folder: &Path, line: &str) -> Result<Option<String>, Box<dyn Error>> {
    let done = output(folder, line)?;
    // A panic or a signal is no refusal.
    assert!([Some(0), Some(1), Some(2)].contains(&done.status.code()), "{line}: {}", said(&done));
    Ok((!done.status.success()).then(|| said(&done)))
}

/// Whether the program does what is asked.
fn is_followed(folder: &Path, line: &str) -> Result<bool, Box<dyn Error>> {
    Ok(refused(folder, line)?.is_none())
}

fn page() -> std::io::Result<String> {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/features_together.md");
    fs::read_to_string(page)
}

/// The row of the page in the program, to the end of its path.
fn command(options: &str) -> String {
    let ends = options.contains("--max-") || options.contains("--mean-pressure");
    let end = if ends { "" } else { "--max-area-fraction 0.3" };
    format!("path --nodes 16 {options} {end} -q")
}

#[test]
fn ensembles_are_their_paths() -> Done {
    let table = tables(&page()?, "path");
    let (header, lines) = table.split_first().ok_or("no table")?;
    let place = header.iter().position(|column| column == COLUMN).ok_or("no column")?;
    let rows: Vec<&str> = lines.iter().map(|line| line[0].as_str()).collect();
    assert_eq!(rows, ROWS.map(|(name, ..)| name));
    for ((name, options, files), line) in ROWS.iter().zip(lines) {
        let folder = Scratch::new(&format!("together-{}", name.replace(' ', "-")))?;
        let path = format!("{} --fields npy", command(options));
        if *name == "resumed" {
            // Interrupted behind the first: the same command goes on.
            assert!(is_followed(&folder.0, &format!("{path} --seeds 1..1 --out runs"))?);
        }
        let goes = is_followed(&folder.0, &format!("{path} --seeds 1..2 --out runs"))?;
        // The page gives the letter of a reason for what is refused.
        assert_eq!(goes, line[place] == "yes", "{name}");
        for seed in [1, 2].into_iter().filter(|_| goes) {
            assert!(is_followed(&folder.0, &format!("{path} --seed {seed} --out alone"))?);
            for file in ["path.csv"].iter().chain(*files) {
                let [found, expected] = [format!("runs/seed_{seed}"), "alone".to_string()]
                    .map(|of| fs::read(folder.join(&of).join(file)));
                assert!(found? == expected?, "{name}: {file} of seed {seed}");
            }
        }
        assert!(
            !goes || is_followed(&folder.0, "gather runs -q")? == (*name != ADHESION),
            "{name}"
        );
    }
    Ok(())
}

/// Columns of the page in the program, on a record or with the options of the path.
const COMMANDS: [(&str, &str); 6] = [
    ("leak", "leak r.npz --viscosity 1e-3 --pressure-drop 1e5 --along y --states 4"),
    ("slip", "slip r.npz --friction 0.3 --material steel"),
    ("creep", "creep r.npz --prony 1,0.5 --load LOAD --time 1e3"),
    ("conductance", "PATH --conductivity 50,237"),
    ("FE table", "PATH --fe-table csv --friction 0.3 --compliance-ratio 1.2"),
    ("resume", "path --resume r.npz --max-area-fraction 0.35 --record on.npz"),
];

/// Words of the reasons of the page.
const REASONS: [(&str, &str); 4] =
    [("a", "residual surface"), ("b", "layers"), ("c", "leaves the contact"), ("e", "adhesion")];

#[test]
fn the_program_refuses_what_the_page_says() -> Done {
    let table = tables(&page()?, "path");
    let (header, lines) = table.split_first().ok_or("no table")?;
    for ((name, options, _), line) in ROWS.iter().zip(lines) {
        if *name == "hardness per node" {
            continue;
        }
        let folder = Scratch::new(&format!("together-program-{}", name.replace(' ', "-")))?;
        let path = command(options);
        assert!(is_followed(&folder.0, &format!("{path} --record r.npz --out o"))?, "{name}");
        if *name == "after unloading" {
            let of = "--surface o/residual_surface.npy --side 1e-2 --material steel";
            let again = format!("path {of} --max-area-fraction 0.25 -q --record r.npz");
            assert!(is_followed(&folder.0, &again)?, "{name}");
        }
        let csv = fs::read_to_string(folder.join("out/path.csv"))
            .or_else(|_| fs::read_to_string(folder.join("o/path.csv")))?;
        let last = csv.lines().last().and_then(|line| line.split(',').nth(5));
        let load = 0.1 * last.ok_or("no load")?.parse::<f64>()?;
        for (column, command) in COMMANDS {
            let place = header.iter().position(|other| other == column).ok_or("no column")?;
            let path = if *name == "after unloading" {
                "path --surface o/residual_surface.npy --side 1e-2 --material steel"
            } else {
                &path
            };
            let command = command.replace("PATH", path).replace("LOAD", &load.to_string());
            let found = refused(&folder.0, &format!("{command} --out o2"))?;
            let reason = REASONS.iter().find(|(letter, _)| *letter == line[place]);
            assert_eq!(found.is_some(), reason.is_some(), "{name}, {command}: {found:?}");
            if let (Some(said), Some((_, words))) = (&found, reason) {
                assert!(said.contains(words), "{name}: {said}");
            }
        }
    }
    Ok(())
}
