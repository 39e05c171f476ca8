//! Columns of `docs/features_together.md` that are the program's. Ensembles: a path of `--seeds` is the one of its seed
//! alone, in every byte. Reports: the page of a record has the events and scalars of the table of its path. The others:
//! what the page refuses is refused, with its reason, and the rest has a number that is known otherwise.
#![allow(clippy::unwrap_used)]

mod common;

use std::error::Error;
use std::fs;
use std::path::Path;
use std::process::Output;

use asperity::io::{read_npy, write_npy};
use asperity::record::{AdhesiveRecord, LoadingRecord};
use asperity::{Boundary, Boussinesq, Grid, LoadingSolver, SelfAffine};
use asperity_report::PathTable;
use asperity_testing::page::tables;
use asperity_testing::report;
use common::{Scratch, answer, column, numbers, only_line, output, said};
use nalgebra::DMatrix;
use serde_json::Value;

type Done = Result<(), Box<dyn Error>>;

const COLUMN: &str = "ensembles";
/// The row whose loads are on two branches, so that they have no mean.
const ADHESION: &str = "adhesion";
/// The row whose record is one of the library.
const MAP: &str = "hardness per node";

/// Each row of the page: what the program is told, and the files that are compared beside `path.csv`.
const ROWS: [(&str, &str, &[&str]); 16] = [
    ("free", "", &["pressure.npy", "gap.npy"]),
    ("periodic", "--periodic love", &["pressure.npy"]),
    ("periodic x", "--periodic x", &["pressure.npy"]),
    ("periodic y", "--periodic y", &["pressure.npy"]),
    ("non-square cells", "--side 1e-2 --side-y 1.5e-2", &["pressure.npy"]),
    ("full contact", "--periodic love --max-area-fraction 1", &["pressure.npy"]),
    ("hardness", "--hardness 3e9", &["pressure.npy"]),
    (MAP, "--hardness hardness.npy", &[]),
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
const RESIDUAL: &str = "path --surface o/residual_surface.npy --side 1e-2 --material steel \
                        --max-area-fraction 0.25 -q";

/// What the program does. A panic or a signal is no refusal.
fn done(folder: &Path, line: &str) -> Result<Output, Box<dyn Error>> {
    let done = output(folder, line)?;
    assert!([Some(0), Some(1), Some(2)].contains(&done.status.code()), "{line}: {}", said(&done));
    Ok(done)
}

/// Whether the program does what is asked.
fn is_followed(folder: &Path, line: &str) -> Result<bool, Box<dyn Error>> {
    Ok(done(folder, line)?.status.success())
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

/// Paths of `--seeds` are those of single seeds, byte by byte, and what the page refuses is refused with its reason.
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
        // Not for want of the file.
        write_npy(folder.join("hardness.npy"), &map_of_hardness())?;
        let both = format!("{path} --seeds 1..2 --out runs");
        let goes = as_the_page_says(&folder.0, &both, &line[place])?.is_some();
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

/// A hardness for each node, some of which never yield.
fn map_of_hardness() -> DMatrix<f64> {
    DMatrix::from_fn(16, 16, |ix, iy| match (ix + iy) % 3 {
        0 => f64::INFINITY,
        _ => 3e9,
    })
}

/// A path with a hardness of each node: its record, and the table of its states.
fn with_a_map_of_hardness(record: &Path) -> Result<String, Box<dyn Error>> {
    let grid = Grid::square(16, 1e-2 / 16.0)?;
    let kernel = Boussinesq::new(grid, 230e9)?;
    let map = map_of_hardness();
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
/// of its states, which is `o/path.csv` too.
fn record(folder: &Path, name: &str, options: &str) -> Result<String, Box<dyn Error>> {
    let path = command(options);
    let lines = match name {
        MAP => {
            let table = with_a_map_of_hardness(&folder.join("r.npz"))?;
            fs::create_dir_all(folder.join("o"))?;
            fs::write(folder.join("o/path.csv"), &table)?;
            return Ok(table);
        }
        "resumed" => vec![
            format!("{} --record r.npz --out first", path.replace("0.3", "0.1")),
            "path --resume r.npz --max-area-fraction 0.3 --record r.npz --out o -q".to_string(),
        ],
        "after unloading" => {
            vec![format!("{path} --out o"), format!("{RESIDUAL} --record r.npz --out o")]
        }
        _ => vec![format!("{path} --record r.npz --out o")],
    };
    for line in lines {
        assert!(is_followed(folder, &line)?, "{name}: {line}");
    }
    Ok(fs::read_to_string(folder.join("o/path.csv"))?)
}

/// What the program has done, `None` if it has refused. Asserts that it refuses where a cell of the page has the letter
/// of a reason, and with that.
fn as_the_page_says(
    folder: &Path,
    line: &str,
    cell: &str,
) -> Result<Option<Output>, Box<dyn Error>> {
    let done = done(folder, line)?;
    let reason = REASONS.iter().find(|(letter, _)| *letter == cell);
    assert_eq!(done.status.success(), reason.is_none(), "{line}: {}", said(&done));
    assert!(reason.is_some() || cell == "yes", "no words for {cell}");
    if let Some((_, words)) = reason {
        assert!(said(&done).contains(words), "{line}: {}", said(&done));
    }
    Ok(reason.is_none().then_some(done))
}

/// The page of each record has the states of its path.
#[test]
fn reports_are_their_paths() -> Done {
    let table = tables(&page()?, "path");
    let (header, lines) = table.split_first().ok_or("no table")?;
    let place = header.iter().position(|column| column == "report").ok_or("no column")?;
    for ((name, options, _), line) in ROWS.iter().zip(lines) {
        let folder = Scratch::new(&format!("together-report-{}", name.replace(' ', "-")))?;
        let csv = record(&folder.0, name, options)?;
        let report = "report r.npz --out page.html";
        if as_the_page_says(&folder.0, report, &line[place])?.is_some() {
            assert_reports(&fs::read_to_string(folder.join("page.html"))?, &csv, name);
        }
    }
    Ok(())
}

/// What a number of an answer has to be.
enum Is {
    /// The load at the end of the path.
    End,
    /// A tenth of it.
    Tenth,
    /// The mean gap at half of it.
    GapAtHalf,
    /// The mean gap of the first state.
    FirstGap,
    /// So much.
    This(f64),
}

/// Columns of the page in the program, on a record, with the options of the path, or on its surface, and a number of
/// the answer.
const COMMANDS: [(&str, &str, &str, Is); 13] = [
    ("fixed load", "load --surface z.npy BODIES --load HALF", "/states/0/mean_gap", Is::GapAtHalf),
    (
        "sweep",
        "load --surface z.npy BODIES --load TENTH --load HALF",
        "/states/1/mean_gap",
        Is::GapAtHalf,
    ),
    ("fields", "PATH --fields npy", "/load", Is::End),
    ("unload", "PATH --unload", "/load", Is::End),
    ("record", "PATH --record again.npz", "/load", Is::End),
    (
        "resume",
        "path --resume r.npz --max-area-fraction 0.35 --record on.npz",
        "/contact_area_fraction",
        // 89 nodes of 256 are the most that 0.35 of them allow.
        Is::This(89.0 / 256.0),
    ),
    ("patches", "patches r.npz", "/state/load", Is::End),
    (
        "leak",
        "leak r.npz --viscosity 1e-3 --pressure-drop 1e5 --along y --states 4",
        // The end may be sealed, and then it answers for the load that seals.
        "/states/0/mean_gap",
        Is::FirstGap,
    ),
    ("stress", "stress r.npz", "/load", Is::End),
    ("slip", "slip r.npz --friction 0.3 --material steel", "/load", Is::End),
    ("creep", "creep r.npz --prony 1,0.5 --load TENTH --time 1e3", "/load", Is::Tenth),
    ("conductance", "PATH --conductivity 50,237", "/load", Is::End),
    ("FE table", "PATH --fe-table csv --friction 0.3 --compliance-ratio 1.2", "/load", Is::End),
];

/// What the program says for the reasons of the page.
const REASONS: [(&str, &str); 6] = [
    ("a", "residual surface"),
    ("b", "layers"),
    ("c", "leaves the contact"),
    ("d", "'--hardness <PA|HB|HV|HRC>': not a number"),
    ("e", "adhesion"),
    ("f", "goes back through the same states"),
];

/// A column of a table at a load: between events everything but the event is linear in the load.
fn at(table: &Path, name: &str, load: f64) -> Result<f64, Box<dyn Error>> {
    let (loads, values) = (numbers(table, "load")?, numbers(table, name)?);
    let next = loads.iter().position(|other| *other >= load).ok_or("the path ends before")?.max(1);
    let share = (load - loads[next - 1]) / (loads[next] - loads[next - 1]);
    Ok(values[next - 1] + share * (values[next] - values[next - 1]))
}

/// What the files of a column have, beside the answer that was printed.
fn check_files(folder: &Path, column_name: &str, row: &str, end: f64) -> Done {
    let area = if row == "non-square cells" { 1.5e-4 } else { 1e-4 };
    let is_near = |found: f64, what: &str| {
        assert!((found / end - 1.0).abs() < 1e-10, "{row}: {what} {found}, and not {end}");
    };
    match column_name {
        "fields" => {
            let pressure = read_npy(folder.join("o2/pressure.npy"))?;
            is_near(pressure.sum() * area / 256.0, "the pressure makes");
        }
        "unload" if row == ADHESION => {
            let branch = column(&folder.join("o2/path.csv"), "branch")?;
            let places = ["loading", "unloading"].map(|name| branch.iter().position(|b| b == name));
            assert!(places[0] == Some(0) && places[1] > Some(10), "{places:?}");
        }
        "unload" => {
            let loads = numbers(&folder.join("o2/unloading.csv"), "load")?;
            is_near(loads[0], "unloading begins at");
            assert!(
                loads.is_sorted_by(|a, b| a >= b) && loads.last() < Some(&(0.1 * end)),
                "{row}"
            );
        }
        "record" if row == ADHESION => {
            let record = AdhesiveRecord::read_npz(folder.join("again.npz"))?;
            is_near(
                record.states().states().last().ok_or("no state")?.contact.load,
                "the record ends at",
            );
        }
        "record" => {
            let record = LoadingRecord::read_npz(folder.join("again.npz"))?;
            let last = record.history().states().last().ok_or("no state")?;
            is_near(last.contact.load, "the record ends at");
        }
        "FE table" => {
            let pressure = numbers(&folder.join("o2/interface.csv"), "pressure")?;
            let last = pressure.last().ok_or("no row")? * area;
            // The joint is rigid once the contact is full: the table ends with the last state before.
            let loads = numbers(&folder.join("o/path.csv"), "load")?;
            assert!(loads.iter().any(|load| (load / last - 1.0).abs() < 1e-10), "{row}: {last}");
            if !["full contact", "fully plastic"].contains(&row) {
                is_near(last, "the table ends at");
            }
        }
        _ => {}
    }
    Ok(())
}

/// Where nodes leave the contact, its patches are those of the last state alone, and the reason is told.
fn no_patches_are_followed(folder: &Scratch) -> Done {
    let done = done(&folder.0, "patches r.npz --out o2")?;
    let words = String::from_utf8(done.stdout)?;
    let reason = REASONS.iter().find(|(letter, _)| *letter == "c").ok_or("no reason")?;
    assert!(done.status.success() && words.contains(reason.1), "{words}");
    assert!(!folder.join("o2/patches.csv").exists(), "{words}");
    let told = answer(&folder.0, "patches r.npz")?;
    assert!(told["patches"].as_u64() > Some(0) && told.get("percolates_x").is_none(), "{told}");
    Ok(())
}

/// What the page says of a column is what the program does: it refuses with the reason of the page, or its answer and
/// its files have the load of the path, and a mean gap that follows from the table of its states.
#[test]
fn the_program_does_what_the_page_says() -> Done {
    let table = tables(&page()?, "path");
    let (header, lines) = table.split_first().ok_or("no table")?;
    for ((name, options, _), line) in ROWS.iter().zip(lines) {
        let folder = Scratch::new(&format!("together-program-{}", name.replace(' ', "-")))?;
        record(&folder.0, name, options)?;
        let states = folder.join("o/path.csv");
        let end = *numbers(&states, "load")?.last().ok_or("no load")?;
        let own = command(options);
        let path = if *name == "after unloading" { RESIDUAL } else { &own };
        if *name != ADHESION {
            let record = LoadingRecord::read_npz(folder.join("r.npz"))?;
            write_npy(folder.join("z.npy"), record.heights().matrix())?;
        }
        for (column, command, place, is) in &COMMANDS {
            let cell = header.iter().position(|other| other == column).ok_or("no column")?;
            let is_of_record = ["PATH", "BODIES"].iter().all(|word| !command.contains(word));
            if *name == MAP && !is_of_record {
                // The program has no such option, as the letter d says.
                continue;
            }
            let command = command
                .replace("PATH", path)
                .replace("BODIES", &bodies(name, options))
                .replace("TENTH", &(0.1 * end).to_string())
                .replace("HALF", &(0.5 * end).to_string());
            if (*column, line[cell].as_str()) == ("patches", "c") {
                no_patches_are_followed(&folder)?;
                continue;
            }
            // The library knows moduli, and no bodies.
            let of_body = if *name == MAP && *column == "stress" { "--material steel" } else { "" };
            let command = format!("{command} {of_body} --out o2 --json");
            let Some(done) = as_the_page_says(&folder.0, &command, &line[cell])? else {
                continue;
            };
            let told: Value = only_line(done)?;
            let found = told.pointer(place).and_then(Value::as_f64).unwrap_or(f64::NAN);
            // Ten digits are promised; single loads are solved to a tolerance.
            let (expected, tolerance) = match is {
                Is::End => (end, 1e-10),
                Is::Tenth => (0.1 * end, 1e-10),
                Is::GapAtHalf => (at(&states, "mean_gap", 0.5 * end)?, 1e-6),
                Is::FirstGap => (numbers(&states, "mean_gap")?[0], 1e-10),
                Is::This(value) => (*value, 1e-14),
            };
            assert!(
                (found / expected - 1.0).abs() < tolerance,
                "{name}, {column}: {place} is {found}, and not {expected}"
            );
            check_files(&folder.0, column, name, end)?;
        }
    }
    Ok(())
}

/// The options of a row that are those of single loads too.
fn bodies(name: &str, options: &str) -> String {
    // The surface that is left has been loaded elastically.
    let options = if name == "after unloading" { "" } else { options };
    let mut words = Vec::new();
    let mut all = options.split_whitespace();
    while let Some(word) = all.next() {
        match word {
            "--updater" | "--max-area-fraction" | "--mean-pressure" => drop(all.next()),
            _ => words.push(word),
        }
    }
    if !words.contains(&"--side") {
        words.extend(["--side", "1e-2"]);
    }
    if !words.contains(&"--layer") {
        words.extend(["--material", "steel"]);
    }
    words.join(" ")
}
