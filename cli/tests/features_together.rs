//! Columns of `docs/features_together.md` that are the program's. Ensembles: a path of `--seeds` is the one of its seed
//! alone, in every byte. Reports: the page of a record has the events and scalars of the table of its path.
#![allow(clippy::unwrap_used)]

mod common;

use std::error::Error;
use std::fs;
use std::path::Path;

use asperity::record::LoadingRecord;
use asperity::{Boundary, Boussinesq, Grid, LoadingSolver, SelfAffine};
use asperity_report::PathTable;
use asperity_testing::page::tables;
use asperity_testing::report;
use common::{Scratch, output, said};
use nalgebra::DMatrix;

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

/// The elastic path of what a yielded one in the folder `o` leaves.
const RESIDUAL: &str = "path --surface o/residual_surface.npy --side 1e-2 --material steel";

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

/// Asserts that the page of a path has the events and scalars of its table.
fn assert_reports(html: &str, csv: &str, row: &str) {
    let data = report::data(html);
    let events = &data["records"][0]["events"];
    let mut lines = csv.lines();
    let header: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let states: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    let cells = |name: &str| {
        let place = header.iter().position(|other| *other == name).unwrap();
        states.iter().map(move |cells| cells[place])
    };
    let whole = |name| cells(name).map(|cell| cell.parse::<u32>().unwrap());
    let width = data["records"][0]["nx"].as_u64().unwrap() as u32;
    let nodes = whole("ix").zip(whole("iy")).map(|(ix, iy)| ix + width * iy);
    assert_eq!(report::numbers(&events["nodes"]), nodes.collect::<Vec<_>>(), "{row}");
    let kinds = report::numbers(&events["kinds"]);
    let kinds = kinds.iter().map(|kind| ["touch", "release", "limit", "yield"][*kind as usize]);
    assert!(kinds.eq(cells("event")), "{row}");
    for name in ["load", "approach", "mean_gap", "contact_stiffness", "interfacial_stiffness"] {
        if events["columns"][name].is_null() {
            assert!(cells(name).all(str::is_empty), "{row}: {name}");
            continue;
        }
        let found = report::column(events, name);
        assert_eq!(found.len(), states.len(), "{row}: {name}");
        for (found, cell) in found.into_iter().zip(cells(name)) {
            let expected = cell.parse().unwrap_or(f64::NAN);
            // Numbers are kept in steps of 2e-5 of their logarithm.
            let is_near = found == expected || (found / expected - 1.0).abs() <= 1.001e-5;
            assert!(is_near || found.is_nan() && cell.is_empty(), "{row}: {name} {found} {cell}");
        }
    }
}

/// A path with a hardness of each node, some of which never yield: its record, and the table of its states.
fn with_a_map_of_hardness(record: &Path) -> Result<String, Box<dyn Error>> {
    let grid = Grid::square(16, 1e-2 / 16.0)?;
    let kernel = Boussinesq::new(grid, 230e9)?;
    let map = DMatrix::from_fn(16, 16, |ix, iy| match (ix + iy) % 3 {
        0 => f64::INFINITY,
        _ => 3e9,
    });
    let surface = SelfAffine::zhang2020(1);
    let builder = LoadingSolver::builder(&surface, &kernel).hardness_map(&map);
    let mut path = builder.max_area_fraction(0.3).build()?;
    let history = path.run()?;
    let mut table = PathTable::new(grid, Boundary::Free);
    let lines = history.states().iter().map(|state| table.line(state));
    let lines: Vec<String> = lines.collect::<Result<_, _>>()?;
    LoadingRecord::new(&path, history)?.write_npz(record, &[])?;
    Ok(format!("{}\n{}\n", PathTable::HEADER, lines.join("\n")))
}

/// Records the path of a row as `r.npz`, the elastic one of what is left for the row after unloading. Returns the table
/// of its states.
fn record(folder: &Path, name: &str, options: &str) -> Result<String, Box<dyn Error>> {
    let path = command(options);
    let lines = match name {
        "hardness per node" => return with_a_map_of_hardness(&folder.join("r.npz")),
        "resumed" => vec![
            format!("{} --record r.npz --out first", path.replace("0.3", "0.1")),
            "path --resume r.npz --max-area-fraction 0.3 --record r.npz --out o -q".to_string(),
        ],
        "after unloading" => {
            let residual = format!("{RESIDUAL} --max-area-fraction 0.25 -q --record r.npz");
            vec![format!("{path} --out o"), format!("{residual} --out o")]
        }
        _ => vec![format!("{path} --record r.npz --out o")],
    };
    for line in lines {
        assert!(is_followed(folder, &line)?, "{name}: {line}");
    }
    Ok(fs::read_to_string(folder.join("o/path.csv"))?)
}

/// Whether the program does what is asked. Asserts that it refuses it where a cell of the page has the letter of a
/// reason, and with that.
fn is_as_the_page_says(folder: &Path, line: &str, cell: &str) -> Result<bool, Box<dyn Error>> {
    let found = refused(folder, line)?;
    let reason = REASONS.iter().find(|(letter, _)| *letter == cell);
    assert_eq!(found.is_some(), reason.is_some(), "{line}: {found:?}");
    if let (Some(said), Some((_, words))) = (&found, reason) {
        assert!(said.contains(words), "{line}: {said}");
    }
    Ok(found.is_none())
}

#[test]
fn reports_are_their_paths() -> Done {
    let table = tables(&page()?, "path");
    let (header, lines) = table.split_first().ok_or("no table")?;
    let place = header.iter().position(|column| column == "report").ok_or("no column")?;
    for ((name, options, _), line) in ROWS.iter().zip(lines) {
        let folder = Scratch::new(&format!("together-report-{}", name.replace(' ', "-")))?;
        let csv = record(&folder.0, name, options)?;
        if is_as_the_page_says(&folder.0, "report r.npz --out page.html", &line[place])? {
            assert_reports(&fs::read_to_string(folder.join("page.html"))?, &csv, name);
        }
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
        let csv = record(&folder.0, name, options)?;
        let last = csv.lines().last().and_then(|line| line.split(',').nth(5));
        let load = 0.1 * last.ok_or("no load")?.parse::<f64>()?;
        let own = command(options);
        let path = if *name == "after unloading" { RESIDUAL } else { &own };
        for (column, command) in COMMANDS {
            let place = header.iter().position(|other| other == column).ok_or("no column")?;
            let command = command.replace("PATH", path).replace("LOAD", &load.to_string());
            is_as_the_page_says(&folder.0, &format!("{command} --out o2"), &line[place])?;
        }
    }
    Ok(())
}
