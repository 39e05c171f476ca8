//! `asperity report`, and `path --report`.
#![allow(clippy::unwrap_used)]

mod common;

use std::ffi::OsStr;
use std::fs;

use asperity_testing::report;
use common::{Scratch, asperity, is_refused, said};
use serde_json::Value;

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
    assert_eq!(wrote[0], "wrote out/report.html");
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
    assert!(files(&data(&folder, "page.html")["records"][0]).contains(&"leak.csv".to_string()));

    done(&folder, "path --nodes 24 --record other.npz --out other");
    done(&folder, "report out/path.npz other.npz --out two.html");
    let two = data(&folder, "two.html");
    let names: Vec<_> =
        two["records"].as_array().unwrap().iter().map(|record| record["name"].clone()).collect();
    assert_eq!(names, ["out/path.npz", "other.npz"]);
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
