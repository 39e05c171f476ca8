//! `asperity report`, and `path --report`.
#![allow(clippy::unwrap_used)]

mod common;

use std::ffi::OsStr;
use std::fs;
use std::path::Path;

use asperity::io::read_npy;
use asperity_testing::report;
use common::{Scratch, answer, asperity, column, is_refused, numbers, said};
use serde_json::{Value, json};

fn run(folder: &Scratch, line: &str) -> std::process::Output {
    let words: Vec<&OsStr> = line.split(' ').map(OsStr::new).collect();
    asperity(&folder.0, &words).output().unwrap()
}

fn done(folder: &Scratch, line: &str) -> String {
    let output = run(folder, line);
    assert!(output.status.success(), "{}", said(&output));
    String::from_utf8_lossy(&output.stdout).into_owned() + &said(&output)
}

/// The data of a page.
fn data(folder: &Scratch, name: &str) -> Value {
    report::data(&fs::read_to_string(folder.join(name)).unwrap())
}

/// The path writes its page, with what it wrote itself beside it, and the record the same one.
#[test]
fn a_path_and_its_record_have_one_page() {
    let folder = Scratch::new("report").unwrap();
    fs::create_dir(folder.join("out")).unwrap();
    fs::write(folder.join("out/leak.csv"), "load,leak_rate\n1,1\n").unwrap();
    // Of another path, long ago.
    let long_ago = std::time::SystemTime::UNIX_EPOCH;
    fs::File::options()
        .write(true)
        .open(folder.join("out/leak.csv"))
        .unwrap()
        .set_modified(long_ago)
        .unwrap();
    let path =
        "path --nodes 32 --max-area-fraction 0.2 --yield --unload --report --record out/path.npz";
    let printed = done(&folder, path);
    let wrote: Vec<&str> = printed.lines().filter(|line| line.starts_with("wrote")).collect();
    let written = Path::new("out").join("report.html");
    assert_eq!(wrote[0], format!("wrote {}", written.display()));
    let live = data(&folder, "out/report.html");
    assert_eq!(live["command"], format!("asperity {path}"));
    let live = &live["records"][0];
    let files = |record: &Value| -> Vec<String> {
        let panels = record["panels"].as_array().unwrap();
        panels.iter().map(|panel| panel["file"].as_str().unwrap().to_string()).collect()
    };
    assert_eq!(files(live), ["unloading.csv"]);
    assert_eq!(live["settings"]["surface.seed"], 1);

    let printed = done(&folder, "report out/path.npz --out page.html");
    assert!(
        printed.contains("note: leak.csv is left out: it is older than the record"),
        "{printed}"
    );
    let page = data(&folder, "page.html");
    assert_eq!(page["records"][0]["events"], live["events"]);
    assert_eq!(page["records"][0]["facts"], live["facts"]);
    assert_eq!(files(&page["records"][0]), ["unloading.csv"]);
    done(&folder, "report out/path.npz --with out --out page.html");
    let page = data(&folder, "page.html");
    assert!(page["units"].is_null());
    assert!(files(&page["records"][0]).contains(&"leak.csv".to_string()));
    assert_eq!(page["records"][0]["panels"][0]["folder"], "out");

    done(&folder, "path --nodes 24 --record other.npz --out other");
    done(&folder, "report out/path.npz other.npz --out two.html");
    let two = data(&folder, "two.html");
    let names: Vec<_> =
        two["records"].as_array().unwrap().iter().map(|record| record["name"].clone()).collect();
    assert_eq!(names, ["out/path.npz", "other.npz"]);

    // Tables of a folder of two records are there once, and `--units` is what the page begins with.
    fs::rename(folder.join("other.npz"), folder.join("out/other.npz")).unwrap();
    for table in ["unloading.csv", "leak.csv"] {
        let file = fs::File::options().write(true).open(folder.join("out").join(table)).unwrap();
        file.set_modified(std::time::SystemTime::now()).unwrap();
    }
    done(&folder, "report out/path.npz out/other.npz --units mm-N-MPa --out two.html");
    let two = data(&folder, "two.html");
    assert_eq!(two["units"], json!({"length": "mm", "force": "N", "pressure": "MPa"}));
    let [path, other] = [0, 1].map(|number| &two["records"][number]);
    assert_eq!(files(path), ["unloading.csv", "leak.csv"]);
    assert!(path["panels"].as_array().unwrap().iter().all(|panel| panel["both"] == true));
    assert!(files(other).is_empty());
}

/// The value of a fact, which has this unit.
fn fact<'a>(facts: &'a Value, name: &str, unit: &str) -> &'a Value {
    let mut facts = facts.as_array().unwrap().iter();
    let found = facts.find(|fact| fact["name"] == name).unwrap();
    assert_eq!(found["unit"], unit, "{name}");
    &found["value"]
}

/// Whether a number is the expected one, to this part of it; infinity is itself.
fn is_near(found: f64, expected: f64, error: f64) -> bool {
    found == expected || (found - expected).abs() <= error * expected.abs()
}

/// Bodies and target are those of the command, and states those of the table, node by node: numbers of the page are off
/// by half of 2e-5, the step of their logarithms.
#[test]
fn a_page_has_the_numbers_of_the_table() {
    let folder = Scratch::new("report-table").unwrap();
    done(&folder, "path --nodes 16 --max-area-fraction 0.2 --report");
    let page = data(&folder, "out/report.html");
    let record = &page["records"][0];
    assert!(is_near(record["nominal_area"].as_f64().unwrap(), 1e-4, 1e-12));
    let facts = &record["facts"];
    for (name, unit, expected) in [
        ("composite modulus E*", "Pa", 210e9 / (1.0 - 0.3 * 0.3)),
        ("body 1: Young's modulus", "Pa", 210e9),
        ("body 1: Poisson's ratio", "", 0.3),
        ("target: contact area", "1", 0.2),
        // The generator scales its surface to this.
        ("rms height Sq", "m", 50e-6),
    ] {
        let found = fact(facts, name, unit).as_f64().unwrap();
        assert!(is_near(found, expected, 1e-12), "{name}: {found}");
    }
    for (name, side) in [("sides", 1e-2), ("cells", 1e-2 / 16.0)] {
        let found = fact(facts, name, "m").as_array().unwrap();
        let is_side = |found: &Value| is_near(found.as_f64().unwrap(), side, 1e-12);
        assert!(found.len() == 2 && found.iter().all(is_side), "{name}: {found:?}");
    }
    for (name, words) in [
        ("grid", "16 × 16 nodes"),
        ("half-space", "free"),
        ("body 2", "rigid"),
        ("ended by", "the requested contact area"),
    ] {
        assert_eq!(fact(facts, name, ""), words);
    }

    let table = folder.join("out/path.csv");
    let numbers = |name: &str| numbers(&table, name).unwrap();
    let events = &record["events"];
    let nodes = numbers("ix").into_iter().zip(numbers("iy"));
    let nodes: Vec<u32> = nodes.map(|(ix, iy)| (ix + 16.0 * iy) as u32).collect();
    assert_eq!(report::numbers(&events["nodes"]), nodes);
    let kinds = report::numbers(&events["kinds"]);
    let touches = column(&table, "event").unwrap().into_iter().map(|event| event == "touch");
    assert!(touches.eq(kinds.into_iter().map(|kind| kind == 0)));
    for (name, named, unit) in [
        ("load", "load", 1.0),
        ("approach", "approach", 1.0),
        ("mean_gap", "mean_gap", 1.0),
        ("contact_stiffness", "contact_stiffness", 1.0),
        ("interfacial_stiffness", "interfacial_stiffness", 1.0),
        ("corrected", "corrected_contact_area", 1e-4),
    ] {
        let (found, expected) = (report::column(events, name), numbers(named));
        assert_eq!(found.len(), expected.len(), "{name}");
        for (found, expected) in found.into_iter().zip(expected) {
            assert!(is_near(found, expected / unit, 1.001e-5), "{name}: {found} {expected}");
        }
    }
    let certificate = fact(&record["certificate"], "estimated error of the approach", "m");
    assert_eq!(certificate.as_f64(), numbers("approach_error").last().copied());
}

/// Hardness and load are those of the command, and residuals what fields and object of the last state say: the page has
/// them from a solution of its own, whose pressures and gaps are the same to rounding.
#[test]
fn a_page_has_the_residuals_of_the_last_state() {
    let folder = Scratch::new("report-residuals").unwrap();
    let line = "path --nodes 16 --periodic love --e-star 5e9 --mean-pressure 2e7 --fields npy";
    let object = |line: &str| answer(&folder.0, line).unwrap();
    // Half of what is pressed hardest without a hardness is one that some nodes reach.
    let hardness = 0.5 * object(line)["max_pressure"].as_f64().unwrap();
    let last = object(&format!("{line} --hardness {hardness:e} --report"));
    let page = data(&folder, "out/report.html");
    let record = &page["records"][0];
    let facts = &record["facts"];
    for (name, unit, expected) in [
        ("composite modulus E*", "Pa", 5e9),
        ("hardness", "Pa", hardness),
        ("target: load", "N", 2e7 * 1e-4),
    ] {
        let found = fact(facts, name, unit).as_f64().unwrap();
        assert!(is_near(found, expected, 1e-12), "{name}: {found}");
    }
    assert_eq!(fact(facts, "half-space", ""), "periodic");
    assert_eq!(fact(facts, "ended by", ""), &last["ended_by"]);
    assert!(facts.as_array().unwrap().iter().all(|fact| fact["name"] != "body 2"));

    let residual = |name: &str, unit: &str| fact(&record["certificate"], name, unit).as_f64();
    let number = |name: &str| last[name].as_f64().unwrap();
    let mean = number("load") / number("contact_area");
    let field = |name: &str| read_npy(folder.join("out").join(name)).unwrap();
    let (pressure, gap) = (field("pressure.npy"), field("gap.npy"));
    let excess = residual("pressure beyond the hardness, over it", "").unwrap();
    assert!((excess - (pressure.max() / hardness - 1.0)).abs() < 1e-9, "{excess}");
    let sum = pressure.sum() * 1e-4 / 256.0 - number("load");
    let error = residual("sum of pressures less load", "N").unwrap();
    assert!((error - sum).abs() < 1e-9 * number("load"), "{error} {sum}");
    // Nodes out of contact have a gap and no pressure.
    let open = pressure.iter().zip(&gap).filter(|(pressure, _)| **pressure == 0.0);
    let least = open.map(|(_, gap)| *gap).fold(f64::INFINITY, f64::min);
    let found = residual("least gap out of contact", "m").unwrap();
    assert!((found - least).abs() < 1e-9 * number("approach").abs().max(50e-6), "{found} {least}");
    let found = residual("least pressure in contact", "Pa").unwrap();
    let pressed = pressure.iter().copied().filter(|pressure| *pressure != 0.0);
    let least = pressed.fold(f64::INFINITY, f64::min);
    assert!((found - least).abs() < 1e-9 * mean, "{found} {least}");

    let fields = record["fields"]["states"].as_array().unwrap();
    let found = fields.last().unwrap()["pressure"].as_f64().unwrap();
    assert!(is_near(found, number("max_pressure"), 1e-9), "{found}");
    let volumes = report::column(&record["events"], "plastic_volume");
    assert!(number("plastic_volume") > 0.0);
    assert!(is_near(*volumes.last().unwrap(), number("plastic_volume"), 1.001e-5), "{volumes:?}");
}

/// What is no record, and what cannot be written, is said before anything is.
#[test]
fn what_cannot_be_shown_is_refused() {
    let folder = Scratch::new("report-refused").unwrap();
    done(&folder, "path --nodes 16 --record path.npz");
    let whole = fs::read(folder.join("path.npz")).unwrap();
    fs::write(folder.join("cut.npz"), &whole[..whole.len() / 2]).unwrap();
    fs::write(folder.join("text.npz"), "<script>alert(1)</script>").unwrap();
    for file in ["cut.npz", "text.npz", "missing.npz"] {
        is_refused(&run(&folder, &format!("report {file}")), &["cannot show", file]);
        is_refused(&run(&folder, &format!("report path.npz {file}")), &["cannot show", file]);
    }
    assert!(!folder.join("report.html").exists());
    is_refused(&run(&folder, "report path.npz --with nowhere"), &["there is no folder nowhere"]);
    is_refused(&run(&folder, "report path.npz --out nowhere/page.html"), &["cannot write"]);
}
