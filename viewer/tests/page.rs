//! What is in a page is what is in its record.
#![allow(clippy::unwrap_used)]

use std::collections::HashMap;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use asperity::kernel::{Base, Layer, Layered, LayeredBody};
use asperity::loading::History;
use asperity::patches::{Connectivity, ContactEdge, PatchHistory};
use asperity::record::{KernelRecord, LoadingRecord, Settings};
use asperity::surface::HeightMap;
use asperity::{
    Boussinesq, ContactEvent, ContactRule, Error, Grid, InfluenceKernel, LoadingSolver,
    PeriodicBoussinesq, SelfAffine,
};
use asperity_report::{Report, Source};
use asperity_testing::report;
use serde_json::Value;

/// The path of a surface to a part of its area, with a hardness or without.
fn record_of(
    nodes: usize,
    area: f64,
    hardness: Option<f64>,
    periodic: bool,
) -> Result<LoadingRecord, Error> {
    let grid = Grid::square(nodes, 1e-2 / nodes as f64)?;
    let kernel: Box<dyn InfluenceKernel> = match periodic {
        false => Box::new(Boussinesq::new(grid, 115e9)?),
        true => Box::new(PeriodicBoussinesq::new(grid, 115e9)?),
    };
    let surface = SelfAffine::zhang2020(1);
    let mut builder = LoadingSolver::builder(&surface, &*kernel).max_area_fraction(area);
    if let Some(hardness) = hardness {
        builder = builder.hardness(hardness);
    }
    let mut path = builder.build()?;
    let history = path.run()?;
    LoadingRecord::new(&path, history)
}

fn page_of(name: &str, record: &LoadingRecord) -> Result<String, Error> {
    let mut report = Report::new();
    report.add(Source::new(name, record))?;
    Ok(report.html())
}

/// Logarithms are kept in steps of 2e-5, and half a step is how far a number is off.
fn assert_near(found: &[f64], expected: impl Iterator<Item = f64>, what: &str) {
    let expected: Vec<f64> = expected.collect();
    assert_eq!(found.len(), expected.len(), "{what}");
    for (a, b) in found.iter().zip(expected) {
        assert!(*a == b || (a / b - 1.0).abs() <= 1.001e-5, "{what}: {a} and not {b}");
    }
}

#[test]
fn events_and_scalars_are_those_of_the_record() -> Result<(), Error> {
    for (hardness, area, periodic) in
        [(None, 1.0, false), (Some(2e9), 0.3, false), (None, 0.4, true)]
    {
        let record = record_of(32, area, hardness, periodic)?;
        let data = report::data(&page_of("a path", &record)?);
        let events = &data["records"][0]["events"];
        let states = record.states();
        let nodes = states.iter().map(|state| (state.node.0 + 32 * state.node.1) as u32);
        assert_eq!(report::numbers(&events["nodes"]), nodes.collect::<Vec<_>>());
        let kind = |event| match event {
            ContactEvent::Touch => 0,
            ContactEvent::Release => 1,
            ContactEvent::Yield => 3,
            _ => 2,
        };
        let kinds = states.iter().map(|state| kind(state.event));
        assert_eq!(report::numbers(&events["kinds"]), kinds.collect::<Vec<_>>());
        assert_eq!(
            hardness.is_some(),
            states.iter().any(|state| state.event == ContactEvent::Yield)
        );

        let near = |name: &str, value: &dyn Fn(&asperity::ContactState) -> f64| {
            assert_near(
                &report::column(events, name),
                states.iter().map(|state| value(&state.contact)),
                name,
            );
        };
        near("load", &|contact| contact.load);
        near("approach", &|contact| contact.approach);
        near("mean_gap", &|contact| contact.mean_gap);
        near("interfacial_stiffness", &|contact| contact.interfacial_stiffness.unwrap());
        match periodic {
            true => assert!(events["columns"]["contact_stiffness"].is_null()),
            false => near("contact_stiffness", &|contact| contact.contact_stiffness.unwrap()),
        }
        let boundary = record.kernel().boundary;
        let mut edge = ContactEdge::new(record.grid(), boundary);
        let corrected = states.iter().map(|state| {
            edge.follow(state.event, state.node).unwrap();
            edge.corrected_area() / record.grid().nominal_area()
        });
        assert_near(&report::column(events, "corrected"), corrected, "corrected area");
        let contact = record.contact()?;
        let patches: Vec<_> = PatchHistory::new(&contact, boundary, Connectivity::Four).collect();
        let touches = states.iter().scan(0, |touches, state| {
            *touches += usize::from(state.event == ContactEvent::Touch);
            Some(*touches - 1)
        });
        let largest = touches.map(|i| patches[i].largest as f64);
        assert_near(&report::column(events, "largest_patch"), largest, "largest patch");
    }
    Ok(())
}

/// The levels of a field, as the page finds them again.
fn levels(left: &[u8], is_in: &[bool], nx: usize) -> Vec<u8> {
    let mut levels: Vec<u8> = Vec::new();
    for node in 0..left.len() {
        let at = |back: usize, is: bool| {
            let place = node.checked_sub(back).filter(|place| is && is_in[*place] == is_in[node]);
            place.map(|place| i32::from(levels[place]))
        };
        let has_left = node % nx > 0;
        let expected = match (at(1, has_left), at(nx, true), at(nx + 1, has_left)) {
            (Some(a), Some(b), Some(c)) => (a + b - c).clamp(a.min(b), a.max(b)),
            (Some(a), Some(b), None) => (a + b) / 2,
            (a, b, _) => a.or(b).unwrap_or(0),
        };
        levels.push(left[node].wrapping_add(expected as u8));
    }
    levels
}

/// Pressure and gap are within half a level of those of their states: of a replay, and of the path itself.
#[test]
fn fields_are_those_of_their_states() -> Result<(), Error> {
    let record = record_of(32, 0.4, Some(2e10), false)?;
    let data = report::data(&page_of("a path", &record)?);
    let fields = &data["records"][0]["fields"];
    let most = fields["levels"].as_f64().unwrap();
    let left = report::bytes(&fields["data"]);
    let states = fields["states"].as_array().unwrap();
    assert!(states.len() > 12, "{}", states.len());
    let mut replay = record.replay()?;
    for (state, left) in states.iter().zip(left.chunks(32 * 32)) {
        let place = state["event"].as_u64().unwrap() as usize;
        let fields = replay.fields_at(&record.states()[place])?;
        let (pressure, gap) = (fields.pressure, fields.gap);
        let is_in: Vec<bool> = fields.contact_map.iter().copied().collect();
        let (greatest, widest) =
            (state["pressure"].as_f64().unwrap(), state["gap"].as_f64().unwrap());
        assert_eq!((greatest, widest), (pressure.max(), gap.max()));
        for (node, level) in levels(left, &is_in, 32).into_iter().enumerate() {
            let part = match is_in[node] {
                // At first touch there is no pressure yet.
                true if greatest == 0.0 => 0.0,
                true => (pressure[node] / greatest).sqrt(),
                false => (gap[node] / widest).max(0.0).sqrt(),
            };
            // Half a level, and that of the parts of 65535 before.
            let error = (f64::from(level) / most - part).abs();
            assert!(error <= 0.5 / most + 1.0 / 65535.0, "node {node} at state {place}: {error}");
        }
    }
    Ok(())
}

/// Heights of no correlation, of which nothing is smooth: the page is as small as is promised.
#[test]
fn the_page_of_a_rough_surface_is_small() -> Result<(), Error> {
    let grid = Grid::square(96, 1e-4)?;
    let mut seed = 1_u64;
    let heights = asperity::nalgebra::DMatrix::from_fn(96, 96, |_, _| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 40) as f64 * 1e-13
    });
    let surface = HeightMap::new(heights)?;
    let kernel = Boussinesq::new(grid, 1e9)?;
    let mut path = LoadingSolver::builder(&surface, &kernel).max_area_fraction(0.3).build()?;
    let history = path.run()?;
    let record = LoadingRecord::new(&path, history)?;
    let page = page_of("noise", &record)?;
    let fields = &report::data(&page)["records"][0]["fields"];
    assert!(fields["data"].as_str().unwrap().len() <= 250_000);
    assert!(page.len() < 600_000, "{}", page.len());
    Ok(())
}

/// Names, commands and settings are words, whatever they are.
#[test]
fn no_text_becomes_a_tag() -> Result<(), Error> {
    let record = record_of(16, 0.1, None, false)?;
    let hostile = "</script><script>alert(1)</script><!--<script>@@style@@ @@data@@";
    let plain = page_of("plain", &record)?;
    let mut report = Report::new().made_by(hostile);
    report.add(Source::new(hostile, &record))?;
    let page = report.html();
    let tags = |page: &str| {
        page.matches("<script").count()
            + page.matches("</script").count()
            + page.matches("<!--").count()
    };
    assert_eq!(tags(&page), tags(&plain));
    let data = report::data(&page);
    assert_eq!(
        (data["records"][0]["name"].as_str(), data["command"].as_str()),
        (Some(hostile), Some(hostile))
    );
    // Whatever the page did, nothing could be fetched.
    assert!(plain.contains("content=\"default-src 'none';"));
    Ok(())
}

#[test]
fn a_record_without_states_has_no_page() -> Result<(), Error> {
    let grid = Grid::square(8, 1.25e-3)?;
    let heights = HeightMap::new(asperity::nalgebra::DMatrix::from_element(8, 8, 0.0))?;
    let kernel = KernelRecord {
        origin: asperity::kernel::KernelOrigin::Other,
        boundary: asperity::Boundary::Free,
        coefficients: Vec::new(),
    };
    let settings =
        Settings { rule: ContactRule::FirstContact, targets: Vec::new(), hardness: None };
    let record =
        LoadingRecord::from_parts(grid, heights, kernel, settings, History::default(), None)?;
    assert!(matches!(page_of("nothing", &record), Err(Error::OutOfRange { .. })));
    Ok(())
}

/// The page compares two paths, and shows no third.
#[test]
fn a_page_has_room_for_two_paths() -> Result<(), Error> {
    let record = record_of(16, 0.1, None, false)?;
    let mut report = Report::new();
    report.add(Source::new("a", &record))?;
    report.add(Source::new("b", &record))?;
    let third = report.add(Source::new("c", &record)).unwrap_err();
    assert_eq!(third.to_string(), "number of paths of the page must be 1 or 2, but is 3");
    assert_eq!(report.data()["records"].as_array().unwrap().len(), 2);
    Ok(())
}

/// The page says of a coated body what the program says.
#[test]
fn cells_wider_than_a_coat_are_warned_of() -> Result<(), Error> {
    let grid = Grid::square(16, 1e-2 / 16.0)?;
    let surface = SelfAffine::zhang2020(1);
    for (thickness, expected) in [(1e-5, true), (1e-3, false)] {
        let coat = Layer { youngs_modulus: 2e9, poissons_ratio: 0.4, thickness };
        let body = LayeredBody::new(
            &[coat],
            Base::HalfSpace { youngs_modulus: 210e9, poissons_ratio: 0.3 },
        )?;
        let kernel = Layered::free(grid, body)?;
        let mut path = LoadingSolver::builder(&surface, &kernel).max_area_fraction(0.1).build()?;
        let history = path.run()?;
        let record = LoadingRecord::new(&path, history)?;
        let data = report::data(&page_of("coated", &record)?);
        let warnings = data["records"][0]["warnings"].to_string();
        assert_eq!(warnings.contains("wider than the coat is thick"), expected, "{warnings}");
    }
    Ok(())
}

/// A page names no function of the library.
#[test]
fn a_tilted_surface_is_told_without_rust() -> Result<(), Error> {
    let kernel = Boussinesq::new(Grid::square(16, 1e-4)?, 115e9)?;
    let tilted = HeightMap::new(asperity::nalgebra::DMatrix::from_fn(16, 16, |ix, iy| {
        1e-6 * ix as f64 + 1e-8 * ((ix * iy) as f64).sin()
    }))?;
    let mut path = LoadingSolver::builder(&tilted, &kernel).max_area_fraction(0.1).build()?;
    let history = path.run()?;
    let record = LoadingRecord::new(&path, history)?;
    let data = report::data(&page_of("tilted", &record)?);
    let warnings = data["records"][0]["warnings"].to_string();
    assert!(warnings.contains("level it unless the tilt is meant"), "{warnings}");
    assert!(!warnings.contains('`'), "{warnings}");
    Ok(())
}

/// On a kernel that cannot be made again there are no fields, and the page says why.
#[test]
fn without_a_kernel_there_are_no_fields() -> Result<(), Error> {
    let record = record_of(16, 0.2, None, false)?;
    let kernel =
        KernelRecord { origin: asperity::kernel::KernelOrigin::Other, ..record.kernel().clone() };
    let foreign = LoadingRecord::from_parts(
        record.grid(),
        record.heights().clone(),
        kernel,
        record.settings().clone(),
        record.history().clone(),
        record.end(),
    )?;
    let mut report = Report::new();
    report.add(Source::new("foreign", &foreign))?;
    let notes = report.notes();
    assert_eq!(notes.len(), 1, "{notes:?}");
    assert!(notes[0].starts_with("pressure, gap and residuals are missing: "), "{notes:?}");
    assert!(report::data(&report.html())["records"][0]["fields"].is_null());
    Ok(())
}

/// A folder that is removed with its test.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> std::io::Result<Self> {
        let name = format!("asperity-report-{name}-{}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        fs::create_dir_all(&folder)?;
        Ok(Self(folder))
    }

    /// Writes a file of an age in seconds.
    fn write(&self, name: &str, text: &str, age: u64) -> std::io::Result<()> {
        let file = self.0.join(name);
        fs::write(&file, text)?;
        let written = SystemTime::now() - Duration::from_secs(age);
        File::options().write(true).open(&file)?.set_modified(written)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Tables beside a record are shown if they are not older; what is left out is named.
#[test]
fn tables_beside_the_record_are_shown() -> Result<(), Box<dyn std::error::Error>> {
    let folder = Scratch::new("beside")?;
    let write = |name: &str, text: &str, age: u64| folder.write(name, text, age);
    write("path.npz", "", 100)?;
    write("leak.csv", "load,leak_rate,imbalance\n1,2e-3,0\n2,1e-3,0\n3,,0\n", 50)?;
    write("creep.csv", "time,load\n0,1\n", 200)?;
    write("slip.csv", "displacement,tangential_load\n1\n", 10)?;
    // Of the loads of a joint, and not of what it does.
    write("history.csv", "time,load\n0,0\n1,1\n", 10)?;
    let settings = r#"{"surface": {"file": "a.npy", "seed": 12345678901234567891}, "e_star": 1.5}"#;
    write("settings.json", settings, 300)?;
    let record = record_of(16, 0.1, None, false)?;
    let shown = |source: &dyn Fn(Source<'_>) -> Source<'_>| -> Result<(Value, Vec<String>), Error> {
        let mut report = Report::new();
        report.add(source(Source::new("a", &record)))?;
        Ok((report::data(&report.html())["records"][0].clone(), report.notes().to_vec()))
    };
    let files = |record: &Value| -> Vec<String> {
        let panels = record["panels"].as_array().unwrap();
        panels.iter().map(|panel| panel["file"].as_str().unwrap().to_string()).collect()
    };
    let record_file = folder.0.join("path.npz");
    let (beside, notes) = shown(&|source| source.beside(&record_file))?;
    assert_eq!(files(&beside), ["leak.csv"]);
    let columns: HashMap<_, _> = beside["panels"][0]["columns"]
        .as_array()
        .unwrap()
        .iter()
        .map(|column| (column["name"].as_str().unwrap(), column["values"].to_string()))
        .collect();
    assert_eq!(
        columns,
        HashMap::from([
            ("load", "[1.0,2.0,3.0]".into()),
            ("leak_rate", "[0.002,0.001,null]".into())
        ])
    );
    assert_eq!(beside["settings"]["surface.file"], "a.npy");
    // A script would read the number as another one.
    assert_eq!(beside["settings"]["surface.seed"], "12345678901234567891");
    assert_eq!(beside["settings"]["e_star"], 1.5);
    assert_eq!(
        notes,
        [
            "slip.csv is left out: line 2 has 1 columns and not 2",
            "creep.csv is left out: it is older than the record",
            "history.csv is left out: it has no column displacement"
        ]
    );
    let (all, _) = shown(&|source| source.with_folder(Path::new(&folder.0)))?;
    assert_eq!(files(&all), ["creep.csv", "leak.csv"]);
    let (both, _) = shown(&|source| source.beside(&record_file).with_folder(&folder.0.join(".")))?;
    assert_eq!(files(&both), files(&all));

    // The page tells where tables lie that are not beside the record, as their folder was given.
    let given = folder.0.join(".");
    assert_eq!(both["panels"][0]["folder"].as_str(), given.to_str());
    assert!(beside["panels"][0]["folder"].is_null());
    // Creep is drawn over the logarithm of time, as in its picture, and a leak over the load.
    assert_eq!(both["panels"][0]["log"], true);
    assert_eq!(both["panels"][1]["log"], false);
    Ok(())
}

/// Two records of one folder have its tables together, but for those that one of them is not older than.
#[test]
fn tables_beside_two_records_are_shown_once() -> Result<(), Box<dyn std::error::Error>> {
    let folder = Scratch::new("two")?;
    folder.write("a.npz", "", 100)?;
    folder.write("leak.csv", "load,leak_rate\n1,2e-3\n2,1e-3\n", 70)?;
    folder.write("b.npz", "", 50)?;
    folder.write("slip.csv", "displacement,tangential_load\n0,0\n1,1\n", 10)?;
    let record = record_of(16, 0.1, None, false)?;
    let mut report = Report::new();
    report.add(Source::new("a", &record).beside(&folder.0.join("a.npz")))?;
    report.add(Source::new("b", &record).beside(&folder.0.join("./b.npz")))?;
    let panels = |number: usize| -> Vec<(String, bool)> {
        let data = report.data();
        let panels = data["records"][number]["panels"].as_array().unwrap().clone();
        let about = |panel: &Value| (panel["file"].as_str().unwrap().into(), panel["both"] == true);
        panels.iter().map(about).collect()
    };
    assert_eq!(panels(0), [("slip.csv".to_string(), true), ("leak.csv".to_string(), false)]);
    assert_eq!(panels(1), []);
    assert_eq!(report.notes(), ["leak.csv is left out: it is older than the record"]);
    Ok(())
}

/// The page begins in the units that were asked for.
#[test]
fn a_page_has_the_units_of_its_reader() {
    assert!(Report::new().data()["units"].is_null());
    let units = &Report::new().in_millimetres().data()["units"];
    assert_eq!(*units, serde_json::json!({"length": "mm", "force": "N", "pressure": "MPa"}));
}
