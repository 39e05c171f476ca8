//! The column of ensembles of `docs/features_together.md`: a path of `--seeds` is the one of its seed alone, in every byte.

mod common;

use std::error::Error;
use std::ffi::OsStr;
use std::fs;
use std::path::Path;

use asperity_testing::page::tables;
use common::{Scratch, asperity, said};

type Done = Result<(), Box<dyn Error>>;

const COLUMN: &str = "ensembles";

/// Each row of the page: what the program is told, and the files that are compared beside `path.csv`.
const ROWS: [(&str, &str, &[&str]); 15] = [
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
];

/// Whether the program follows a path.
fn is_followed(folder: &Path, line: &str) -> Result<bool, Box<dyn Error>> {
    let words: Vec<&OsStr> = line.split_whitespace().map(OsStr::new).collect();
    let done = asperity(folder, &words).output()?;
    // A panic or a signal is no refusal.
    assert!([Some(0), Some(1), Some(2)].contains(&done.status.code()), "{line}: {}", said(&done));
    Ok(done.status.success())
}

#[test]
fn ensembles_are_their_paths() -> Done {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/features_together.md");
    let table = tables(&fs::read_to_string(page)?, "path");
    let (header, lines) = table.split_first().ok_or("no table")?;
    let place = header.iter().position(|column| column == COLUMN).ok_or("no column")?;
    let rows: Vec<&str> = lines.iter().map(|line| line[0].as_str()).collect();
    assert_eq!(rows, ROWS.map(|(name, ..)| name));
    for ((name, options, files), line) in ROWS.iter().zip(lines) {
        let folder = Scratch::new(&format!("together-{}", name.replace(' ', "-")))?;
        let ends = options.contains("--max-") || options.contains("--mean-pressure");
        let end = if ends { "" } else { "--max-area-fraction 0.3" };
        let path = format!("path --nodes 16 {options} {end} --fields npy -q");
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
        assert!(!goes || is_followed(&folder.0, "gather runs -q")?, "{name}");
    }
    Ok(())
}
