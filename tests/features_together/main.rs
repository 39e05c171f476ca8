//! Every pair of features is right by an independent solution, or refused: the table of `docs/features_together.md`,
//! entry by entry.
//!
//! A column of that page is a test here, which goes through all rows. What the page says of the pair is what the test
//! expects: `yes` is an answer that is right, and a letter the reason of a refusal. Columns of the program and of
//! Python have their tests in `cli/tests/features_together.rs` and `python/tests/test_features_together.py`.
#![cfg(feature = "io")]
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

mod dense;
mod followed;
mod kept;
mod rows;
mod solved;
mod sticking;
mod stressed;

use std::path::Path;

use asperity::kernel::Layering;
use asperity::{
    AdhesionError, BedError, Boundary, ContactEvent, Error, FixedLoadSolver, KernelError,
    LoadingSolver,
};
use asperity_testing::page::tables;

use rows::{Pressed, Row};

/// A column: `Ok` if its answer is right, the error if there is none, and a panic if it is wrong.
type Check = fn(&mut Pressed<'_>) -> Result<(), Error>;

const COLUMNS: [(&str, Check); 13] = [
    ("fixed load", solved::fixed_load),
    ("sweep", solved::sweep),
    ("fields", solved::fields),
    ("unload", solved::unload),
    ("record", kept::record),
    ("resume", kept::resume),
    ("patches", followed::patches),
    ("leak", followed::leak),
    ("stress", stressed::stress),
    ("slip", followed::slip),
    ("creep", followed::creep),
    ("conductance", followed::conductance),
    ("FE table", followed::table),
];

/// Columns of the program and of Python, and where their tests are.
const ELSEWHERE: [(&str, &str); 4] = [
    ("ensembles", "cli/tests/features_together.rs"),
    ("report", "cli/tests/features_together.rs"),
    ("Python", "python/tests/test_features_together.py"),
    ("pickles", "python/tests/test_features_together.py"),
];

fn page() -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(root.join("docs/features_together.md")).unwrap()
}

/// The letter of the page for a refusal.
fn reason(error: &Error) -> &'static str {
    match error {
        Error::Bed(BedError::NotElasticGrowth { happens: "yields", .. }) => "a",
        Error::NotHomogeneous { .. } => "b",
        Error::Adhesion(AdhesionError::Record { .. }) => "e",
        Error::Bed(BedError::NotElasticGrowth { .. }) | Error::NodeLeaves { .. } => "c",
        other => panic!("{other}"),
    }
}

/// One column of the page, on all rows.
fn column(name: &str) {
    let check = COLUMNS.iter().find(|(column, _)| *column == name).unwrap().1;
    let table = tables(&page(), "path");
    let place = table[0].iter().position(|column| column == name).unwrap();
    for row in rows::all().iter().chain(rows::both()) {
        let cell = |part: &str| {
            let cell = table.iter().find(|line| line[0] == part).unwrap()[place].as_str();
            // The program has nothing to unload there. Here the way back is looked at all the same.
            if cell == "f" { "yes" } else { cell }
        };
        let cells: Vec<&str> = row.name.split(", ").map(cell).collect();
        let found = match check(&mut row.press()) {
            Ok(()) => "yes",
            Err(error) => reason(&error),
        };
        // What one of several kinds of path refuses, all together do.
        let refused: Vec<&str> = cells.into_iter().filter(|cell| *cell != "yes").collect();
        let is_expected =
            if refused.is_empty() { found == "yes" } else { refused.contains(&found) };
        assert!(is_expected, "{} x {name}: {found}, and the page has {refused:?}", row.name);
    }
    let line = table.iter().find(|line| line[0] == sticking::NAME).unwrap();
    let found = sticking::column(name).map_or_else(|error| reason(&error), |()| "yes");
    assert_eq!(found, line[place], "{} x {name}", sticking::NAME);
}

#[test]
fn fixed_load() {
    column("fixed load");
}

#[test]
fn sweep() {
    column("sweep");
}

#[test]
fn fields() {
    column("fields");
}

#[test]
fn unload() {
    column("unload");
}

#[test]
fn record() {
    column("record");
}

#[test]
fn resume() {
    column("resume");
}

#[test]
fn patches() {
    column("patches");
}

#[test]
fn leak() {
    column("leak");
}

#[test]
fn stress() {
    column("stress");
}

#[test]
fn slip() {
    column("slip");
}

#[test]
fn creep() {
    column("creep");
}

#[test]
fn conductance() {
    column("conductance");
}

#[test]
fn fe_table() {
    column("FE table");
}

/// A hardness asks for contact that is known to grow: the one pair of rows that there is not.
#[test]
fn a_hardness_on_a_stiff_layer_is_refused() {
    let row = rows::all().iter().find(|row| row.name == "stiff layer").unwrap();
    let path = LoadingSolver::builder(&row.surface, &*row.kernel).hardness(1e9).build();
    let single = FixedLoadSolver::builder(&row.surface, &*row.kernel).hardness(1e9).build();
    for refused in [path.err(), single.err()] {
        assert!(matches!(refused, Some(Error::Kernel(KernelError::GrowthUnknown))), "{refused:?}");
    }
    assert!(page().contains("GrowthUnknown"));
}

/// What a path on a stiff layer has before its first release.
#[test]
fn patches_are_followed_up_to_the_first_release() {
    let row = rows::all().iter().find(|row| row.name == "stiff layer").unwrap();
    let Pressed { history, .. } = row.press();
    let mut states = history.states().iter();
    let before = states.position(|state| state.event == ContactEvent::Release).unwrap();
    assert!(before > 10, "{before}");
    let (path, history) = row.follow(before);
    followed::patches(&mut Pressed { row, path, history }).unwrap();
}

/// A row has what its name says, part for part, so that its entries test it.
#[test]
fn rows_are_what_they_are_called() {
    for row in rows::all().iter().chain(rows::both()) {
        let Pressed { history, .. } = row.press();
        let states = history.states();
        let last = states.last().unwrap().contact;
        let count = |event| states.iter().filter(|state| state.event == event).count();
        let yielded = last.plastic.map_or(0, |plastic| plastic.yielded_nodes);
        let (name, grid) = (row.name, row.kernel.grid());
        let parts: Vec<&str> = name.split(", ").collect();
        let is = |named: &[&str]| parts.iter().any(|part| named.contains(part));
        let yields = is(&["hardness", "hardness per node", "fully plastic"]);
        assert_eq!(yielded > grid.nodes() / 10, yields, "{name}: {yielded}");
        assert_eq!(row.hardness.is_some(), yields, "{name}");
        assert!(yielded < last.contact_nodes || is(&["fully plastic"]), "{name}: {yielded}");
        assert_eq!(yielded == grid.nodes(), is(&["fully plastic"]), "{name}");
        let differs = |map: &nalgebra::DMatrix<f64>| map.min() < map.max();
        let is_map = row.hardness.as_ref().is_some_and(differs);
        assert_eq!(is_map, is(&["hardness per node"]), "{name}");
        let is_full = is(&["full contact", "fully plastic"]);
        assert_eq!(last.contact_nodes == grid.nodes(), is_full, "{name}");
        assert_eq!(count(ContactEvent::Release) > 0, is(&["stiff layer"]), "{name}");
        let is_estimated = states.iter().any(|state| state.approach_error > 0.0);
        assert_eq!(is_estimated, is(&["without a factor"]), "{name}");
        assert_eq!(row.resumed, is(&["resumed"]), "{name}");
        assert_eq!(grid.dx() != grid.dy(), is(&["non-square cells"]), "{name}");
        let is_unworn = rows::all()[..6].iter().any(|first| first.surface == row.surface);
        assert_eq!(!is_unworn, is(&["after unloading"]), "{name}");
        let expected = if is(&["sheet"]) {
            Layering::OneMaterial
        } else if is(&["soft layer", "stiff layer"]) {
            Layering::Several
        } else if is(&["periodic x", "periodic y"]) {
            Layering::SemiPeriodicHalfSpace
        } else {
            Layering::HalfSpace
        };
        assert_eq!(history.layering(), expected, "{name}");
        let expected = if is(&["periodic x"]) {
            Boundary::PeriodicX
        } else if is(&["periodic y"]) {
            Boundary::PeriodicY
        } else if is(&["periodic"]) || is(&["full contact"]) && !is(&["free"]) {
            // Full contact is on a periodic half-space unless said.
            Boundary::Periodic
        } else {
            Boundary::Free
        };
        assert_eq!(row.kernel.boundary(), expected, "{name}");
    }
}

/// The page has the rows and columns that are tested, and no other; every letter has its reason below the table.
#[test]
fn the_page_has_all_entries() {
    let page = page();
    let table = tables(&page, "path");
    let (header, lines) = table.split_first().unwrap();
    let columns = COLUMNS.iter().map(|(name, _)| *name);
    let columns: Vec<&str> = columns.chain(ELSEWHERE.map(|(name, _)| name)).collect();
    assert_eq!(header[1..], columns);
    let rows: Vec<&str> = lines.iter().map(|line| line[0].as_str()).collect();
    let names = rows::all().iter().map(|row: &Row| row.name);
    assert_eq!(rows, names.chain([sticking::NAME]).collect::<Vec<_>>());
    for cell in lines.iter().flat_map(|line| &line[1..]) {
        let reason = format!("\n* **{cell}**: ");
        assert!(cell == "yes" || page.contains(&reason), "no reason for {cell}");
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (name, file) in ELSEWHERE {
        let text = std::fs::read_to_string(root.join(file)).unwrap();
        assert!(text.contains(&format!("\"{name}\"")), "{file} does not test {name}");
    }
}
