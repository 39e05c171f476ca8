//! `asperity leak` on the record of a small path, and what `asperity path` writes of its joint.

mod common;

use std::error::Error;
use std::ffi::OsStr;
use std::fs;

use common::{Scratch, asperity, is_refused, numbers, only_line, with_surface};
use serde_json::Value;

fn run(folder: &Scratch, arguments: &[&str]) -> std::io::Result<std::process::Output> {
    let arguments: Vec<&OsStr> = arguments.iter().map(OsStr::new).collect();
    asperity(&folder.0, &arguments).output()
}

const PATH: [&str; 10] = [
    "path",
    "--nodes",
    "32",
    "--periodic",
    "love",
    "--max-area-fraction",
    "0.8",
    "--record",
    "path.npz",
    "--out=path",
];
const LEAK: [&str; 8] =
    ["leak", "path.npz", "--viscosity", "1e-3", "--pressure-drop", "1e5", "--along", "x"];

/// Standard output is one document; its leak rate is that of the load asked for, and the table ends with 0 where the
/// last channel closes.
#[test]
fn leaks_are_printed_and_drawn() -> Result<(), Box<dyn Error>> {
    let folder = Scratch::new("leak")?;
    assert!(run(&folder, &PATH)?.status.success());

    let said = run(&folder, &[&LEAK[..], &["--states", "12", "--out", "seen"]].concat())?;
    assert!(said.status.success());
    let words = String::from_utf8(said.stdout)?;
    assert!(words.contains("the last channel closes at W = "), "{words}");
    let table = fs::read_to_string(folder.join("seen/leak.csv"))?;
    let lines: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(lines.len(), 13);
    assert!(lines.iter().all(|line| line.len() == lines[0].len()));
    let place = |name: &str| lines[0].iter().position(|other| *other == name).ok_or("no column");
    let (load, rate) = (place("load")?, place("leak_rate")?);
    let rates: Result<Vec<f64>, _> = lines[1..].iter().map(|line| line[rate].parse()).collect();
    let rates = rates?;
    assert!(rates.windows(2).all(|pair| pair[0] > pair[1]));
    assert_eq!(rates.last(), Some(&0.0));
    for picture in ["leak", "fluid_pressure_0", "flux_0"] {
        let bytes = fs::read(folder.join("seen").join(picture).with_extension("png"))?;
        assert!(bytes.starts_with(b"\x89PNG"), "{picture}");
    }

    // Each column is what the object calls so.
    let said = run(&folder, &[&LEAK[..], &["--json", "--states", "12", "--out", "json"]].concat())?;
    let document = only_line(said)?;
    let constriction = [
        ("constriction_ix", "/constriction/node/0"),
        ("constriction_iy", "/constriction/node/1"),
        ("constriction_gap", "/constriction/gap"),
        ("constriction_pressure_drop", "/constriction/pressure_drop"),
        ("constriction_dissipation", "/constriction/dissipation"),
    ];
    for (line, state) in lines[1..].iter().zip(document["states"].as_array().ok_or("no states")?) {
        for (name, cell) in lines[0].iter().zip(line) {
            let known = constriction.iter().find(|(column, _)| column == name);
            let there = known.map_or(format!("/{name}"), |(_, there)| (*there).to_string());
            let expected = state.pointer(&there).and_then(Value::as_f64);
            assert_eq!(cell.parse::<f64>().ok(), expected, "{name}");
        }
    }

    // At the loads of the table: the same rates.
    for k in [3, 8, 11] {
        let newtons = lines[1 + k][load];
        let at = ["--load", newtons, "--json", "--states", "0", "--out", "json"];
        let said = run(&folder, &[&LEAK[..], &at].concat())?;
        assert!(said.status.success());
        let document = only_line(said)?;
        assert_eq!(document["leak_rate"].as_f64(), Some(rates[k]));
        assert_eq!(document["load"].as_f64(), Some(newtons.parse()?));
        assert_eq!(document["states"].as_array().map(Vec::len), Some(1));
        assert_eq!(document["constriction"].is_null(), rates[k] == 0.0);
    }
    let said = run(&folder, &[&LEAK[..], &["--json", "--states", "5", "--out", "json"]].concat())?;
    let document = only_line(said)?;
    assert_eq!(document["leak_rate"].as_f64(), Some(0.0));
    assert_eq!(document["states"].as_array().map(Vec::len), Some(5));
    assert_eq!(document["states"][0]["leak_rate"].as_f64(), Some(rates[0]));

    is_refused(
        &run(&folder, &[&LEAK[..], &["--load", "1e9"]].concat())?,
        &["no state at 1 GN", "ends at"],
    );
    is_refused(&run(&folder, &[&LEAK[..], &["--states", "1"]].concat())?, &["--states"]);
    is_refused(&run(&folder, &[&LEAK[..], &["--states", "0"]].concat())?, &["--states"]);
    let bad = ["leak", "path.npz", "--viscosity", "0", "--pressure-drop", "1e5", "--along", "x"];
    assert_eq!(run(&folder, &bad)?.status.code(), Some(2));
    Ok(())
}

/// A gas of 3 bar into 1 leaks twice as much as a liquid of that viscosity, told as throughput too; a least gap closes
/// the seal earlier.
#[test]
fn gases_leak_and_narrow_gaps_do_not() -> Result<(), Box<dyn Error>> {
    let folder = Scratch::new("gas")?;
    assert!(run(&folder, &PATH)?.status.success());
    let leak = |more: &str| -> Result<(Value, String), Box<dyn Error>> {
        let line = "leak path.npz --viscosity 0.018mPa·s --pressure-drop 2bar --along x --states 6";
        let words: Vec<&str> = line.split(' ').chain(more.split_whitespace()).collect();
        let said = run(&folder, &words)?;
        assert!(said.status.success());
        fs::remove_dir_all(folder.join("out"))?;
        let document = run(&folder, &[&words[..], &["--json"]].concat())?;
        assert!(!folder.join("out").exists(), "an object alone was asked for");
        Ok((only_line(document)?, String::from_utf8(said.stdout)?))
    };
    let rate = |document: &Value| document["states"][0]["leak_rate"].as_f64().ok_or("no rate");
    let (liquid, words) = leak("")?;
    assert!(words.contains("ml/min/m"), "{words}");
    let (gas, words) = leak("--gas-outlet-pressure 1bar")?;
    assert!((rate(&gas)? / rate(&liquid)? / 2.0 - 1.0).abs() < 1e-12);
    assert_eq!(gas["gas_outlet_pressure"].as_f64(), Some(1e5));
    assert!(liquid["gas_outlet_pressure"].is_null());
    assert!(words.contains("mbar l/s") && words.contains("leaves at 100 kPa"), "{words}");
    let step = |document: &Value| document["step"].as_u64().ok_or("no state");
    let (limited, words) = leak("--least-gap 20um")?;
    assert!(step(&limited)? < step(&liquid)?, "{words}");
    assert!(words.contains("through gaps of 20 µm and less"), "{words}");
    Ok(())
}

/// A number as people write it: `1.234 × 10⁻⁵`.
fn spoken(text: &str) -> Result<f64, Box<dyn Error>> {
    let plain = |letter: char| match "⁻⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|other| other == letter)
    {
        Some(place) => "-0123456789".chars().nth(place),
        None => Some(letter),
    };
    Ok(text.replace(" × 10", "e").chars().filter_map(plain).collect::<String>().parse()?)
}

/// Rates in words are those of the file and of the object: 1 m³/s is 6 · 10⁷ ml/min, and 1 Pa m³/s is 10 mbar l/s.
/// A surface of 1 cm by 2 cm is 2 cm wide for what flows along x.
#[test]
fn rates_in_words_are_those_of_the_file() -> Result<(), Box<dyn Error>> {
    let folder = with_surface("leak-words")?;
    let printed = |line: &str| -> Result<String, Box<dyn Error>> {
        let done = run(&folder, &line.split_whitespace().collect::<Vec<_>>())?;
        assert!(done.status.success(), "{line}");
        Ok(String::from_utf8(done.stdout)?)
    };
    let surface = "--surface rough.npy --side 1cm --side-y 2cm --material steel";
    printed(&format!("path {surface} --max-area-fraction 0.1 --record path.npz --out path"))?;
    let loads = numbers(&folder.join("path/path.csv"), "load")?;
    let load = 0.3 * loads.last().ok_or("no state")?;
    for (axis, across) in [("x", 0.02), ("y", 0.01)] {
        for gas in ["", "--gas-outlet-pressure 3bar"] {
            let line = format!(
                "leak path.npz --viscosity 0.018mPa·s --pressure-drop 2bar --along {axis} {gas} --load {load:e}"
            );
            let words = printed(&format!("{line} --states 5 --out seen"))?;
            // Four digits.
            let near = |found: f64, expected: f64| {
                assert!((found / expected - 1.0).abs() < 5.001e-4, "{found} {expected}: {words}");
            };
            let file = folder.join("seen/leak.csv");
            let rates = numbers(&file, "leak_rate")?;
            let estimates = numbers(&file, "mean_field_leak_rate")?;
            let mut table = words.lines().skip_while(|line| !line.contains("ml/min/m"));
            let units: Vec<&str> = table.next().ok_or("no units")?.split_whitespace().collect();
            assert_eq!(units[5..9], ["m³/s", "ml/min", "ml/min/m", "m³/s"], "{words}");
            assert_eq!(rates.len(), 5);
            for (rate, estimate) in rates.iter().zip(estimates) {
                let row = table.next().ok_or("no row")?;
                let cells: Vec<&str> = row.split_whitespace().collect();
                assert_eq!(cells.len(), units.len(), "{row}");
                near(cells[5].parse()?, *rate);
                near(cells[6].parse()?, 6e7 * rate);
                near(cells[7].parse()?, 6e7 * rate / across);
                near(cells[8].parse()?, estimate);
            }

            let json = printed(&format!("{line} --states 0 --json --out json"))?;
            let document: Value = serde_json::from_str(&json)?;
            let rate = document["leak_rate"].as_f64().ok_or("no rate")?;
            let told = words.lines().find_map(|line| line.split_once(": leak rate "));
            let told: Vec<&str> = told.ok_or("no leak")?.1.split(", ").collect();
            let mut expected = vec![("", " m³/s", rate), ("", " ml/min", 6e7 * rate)];
            if !gas.is_empty() {
                expected.push(("throughput ", " mbar l/s", 10.0 * 3e5 * rate));
            }
            assert_eq!(told.len(), expected.len(), "{words}");
            for (told, (before, behind, value)) in told.into_iter().zip(expected) {
                let number = told.strip_prefix(before).and_then(|told| told.strip_suffix(behind));
                near(spoken(number.ok_or(told)?)?, value);
            }
        }
    }
    Ok(())
}

/// Columns and files of a joint; on a record as on a path that begins.
#[test]
fn joints_are_tabulated() -> Result<(), Box<dyn Error>> {
    let folder = Scratch::new("joint")?;
    let begun = run(
        &folder,
        &[&PATH[..], &["--resistivity", "1.7e-8,1.7e-8", "--conductivity", "400"]].concat(),
    )?;
    assert!(begun.status.success());
    let told = String::from_utf8(begun.stderr)?;
    assert!(told.contains("--conductivity has the value of one body"), "{told}");
    assert!(!told.contains("--resistivity has"), "{told}");
    let table = fs::read_to_string(folder.join("path/path.csv"))?;
    let lines: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    let names = &lines[0];
    assert_eq!(names[names.len() - 2..], ["electrical_conductance", "thermal_conductance"]);
    let place = names.iter().position(|name| *name == "interfacial_stiffness").ok_or("none")?;
    for line in &lines[1..] {
        let number = |k: usize| line[k].parse::<f64>();
        let (stiffness, electrical) = (number(place)?, number(names.len() - 2)?);
        // Assumed steel.
        let e_star = 210e9 / 0.91;
        let expected = 2.0 * stiffness / (e_star * 3.4e-8);
        assert!((electrical / expected - 1.0).abs() < 1e-12);
        let ratio = electrical / number(names.len() - 1)?;
        assert!((ratio * 3.4e-8 * 400.0 - 1.0).abs() < 1e-12);
    }

    let again = ["path", "--resume", "path.npz", "--out", "again", "--conductivity", "400"];
    for (program, file, words) in [
        ("abaqus", "interface.inp", "*GAP CONDUCTANCE, PRESSURE\n"),
        ("calculix", "interface.inp", "*FRICTION\n2.000000000000e-1, "),
        ("moose", "interface.i", "[slip_limit_of_pressure]"),
        (
            "csv",
            "interface.csv",
            "pressure,overclosure,thermal_conductance,tangential_stiffness,slip_limit\n",
        ),
    ] {
        let more = ["--fe-table", program, "--friction", "0.2", "--compliance-ratio", "1.2"];
        assert!(run(&folder, &[&again[..], &more].concat())?.status.success());
        let text = fs::read_to_string(folder.join("again").join(file))?;
        assert!(text.contains(words), "{text}");
    }
    let more = ["--unresolved-roughness", "1e-8"];
    assert!(run(&folder, &[&again[..], &more].concat())?.status.success());
    let bounds = fs::read_to_string(folder.join("again/conductance.csv"))?;
    assert!(bounds.starts_with(
        "step,load,mean_pressure,thermal_conductance,thermal_conductance_lower,thermal_conductance_upper\n"
    ));
    assert_eq!(bounds.lines().count(), lines.len());

    // A record knows its bodies: (2 - ν)/(2 (1 - ν)) of steel against a rigid one. One of a modulus alone does not.
    let table = ["--fe-table", "csv", "--friction", "0.2"];
    let mut texts = Vec::new();
    for ratio in [&[][..], &["--compliance-ratio", "1.2142857142857142"]] {
        assert!(run(&folder, &[&again[..], &table, ratio].concat())?.status.success());
        texts.push(fs::read_to_string(folder.join("again/interface.csv"))?);
    }
    assert_eq!(texts[0].lines().count(), texts[1].lines().count());
    for (known, given) in texts[0].lines().skip(1).zip(texts[1].lines().skip(1)) {
        for (known, given) in known.split(',').zip(given.split(',')) {
            let (known, given): (f64, f64) = (known.parse()?, given.parse()?);
            // Digits of the table.
            assert!((known - given).abs() <= 1e-11 * given.abs(), "{known} {given}");
        }
    }
    let modulus = ["path", "--nodes", "16", "--e-star", "1e9", "--record", "modulus.npz"];
    assert!(run(&folder, &modulus)?.status.success());
    let again_of_modulus = ["path", "--resume", "modulus.npz", "--out", "modulus"];
    let missing = run(&folder, &[&again_of_modulus[..], &table].concat())?;
    is_refused(&missing, &["--compliance-ratio"]);
    let both =
        run(&folder, &[&again[..], &["--fe-table", "csv", "--resistivity", "1e-8"]].concat())?;
    is_refused(&both, &["not both"]);
    let none = ["path", "--nodes", "16", "--unresolved-roughness", "1e-8", "--out", "none"];
    is_refused(&run(&folder, &none)?, &["--resistivity"]);
    Ok(())
}

/// Where the body repeats along one side it is the interfacial stiffness that counts, in every file and behind a record
/// too.
#[test]
fn joints_of_rows_conduct_by_the_interface() -> Result<(), Box<dyn Error>> {
    let folder = Scratch::new("joint-row")?;
    let path =
        "path --nodes 32 --max-area-fraction 0.3 --conductivity 50 --unresolved-roughness 1e-9 -q";
    for axis in ["x", "y"] {
        let begun = format!("{path} --periodic {axis} --record {axis}.npz --out begun");
        let again = format!(
            "path --resume {axis}.npz --conductivity 50 --unresolved-roughness 1e-9 --fe-table csv --out again -q"
        );
        for line in [&begun, &again] {
            let words: Vec<&str> = line.split_whitespace().collect();
            assert!(run(&folder, &words)?.status.success(), "{line}");
        }
        let column = |file: &str, name: &str| -> Result<Vec<f64>, Box<dyn Error>> {
            let text = fs::read_to_string(folder.join(file))?;
            let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
            let names = lines.next().ok_or("empty")?;
            let place = names.iter().position(|other| *other == name).ok_or("no column")?;
            lines.map(|line| Ok(line[place].parse()?)).collect()
        };
        for folder in ["begun", "again"] {
            let table = format!("{folder}/path.csv");
            let stiffness = column(&table, "interfacial_stiffness")?;
            let expected =
                stiffness.iter().map(|stiffness| 2.0 * stiffness / (210e9 / 0.91 * 0.02));
            let bounds = format!("{folder}/conductance.csv");
            let [found, same, lower, upper] = [
                column(&table, "thermal_conductance")?,
                column(&bounds, "thermal_conductance")?,
                column(&bounds, "thermal_conductance_lower")?,
                column(&bounds, "thermal_conductance_upper")?,
            ];
            for (k, expected) in expected.enumerate() {
                assert!(
                    (found[k] / expected - 1.0).abs() < 1e-12,
                    "{axis}: {} {expected}",
                    found[k]
                );
                assert_eq!(found[k], same[k]);
                assert!(lower[k] <= found[k] && found[k] <= upper[k]);
            }
        }
        let last = column("again/interface.csv", "thermal_conductance")?.last().copied();
        let whole = column("again/path.csv", "thermal_conductance")?.last().copied();
        let area = whole.ok_or("none")? / last.ok_or("none")?;
        // Of the surface of the example, to the digits of the table.
        assert!((area / 1e-4 - 1.0).abs() < 1e-9, "{area}");
    }
    Ok(())
}

/// One record of a periodic half-space whose last channel from end to end closes later than the last one around the
/// grid: `leak`, `patches` with and without corners, and `creep` say the same.
#[test]
fn all_commands_seal_at_one_state() -> Result<(), Box<dyn Error>> {
    let folder = Scratch::new("seals")?;
    let made = [
        "path",
        "--nodes",
        "64",
        "--seed",
        "3",
        "--periodic",
        "love",
        "--max-area-fraction",
        "0.6",
        "--record",
        "path.npz",
        "--out=path",
    ];
    assert!(run(&folder, &made)?.status.success());
    let answer = |arguments: &[&str]| -> Result<Value, Box<dyn Error>> {
        let done = run(&folder, arguments)?;
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        only_line(done)
    };
    for axis in ["x", "y"] {
        let leak = answer(&[
            "leak",
            "path.npz",
            "--viscosity=1e-3",
            "--pressure-drop=1",
            "--along",
            axis,
            "--states=3",
            "--json",
        ])?;
        assert_eq!(leak["leak_rate"].as_f64(), Some(0.0));
        let (load, step) = (leak["load"].as_f64().ok_or("no load")?, &leak["step"]);
        for corners in [&["--corners"][..], &[]] {
            let patches = answer(&[&["patches", "path.npz", "--json"], corners].concat())?;
            assert_eq!(&patches[format!("seals_{axis}")]["step"], step);
            let around = &patches[format!("no_channel_winds_{axis}")]["step"];
            assert!(around.as_u64() <= step.as_u64() && !around.is_null());
            if axis == "x" {
                assert_ne!(around, step, "both questions are the same on this surface");
            }
            let at = format!("{:e}", load);
            let before = ["patches", "path.npz", "--json", "--at-load", &at];
            assert!(answer(&before)?[format!("channel_{axis}")].is_null());
            // A load that is put on at once seals at once from there on, and not before.
            for (factor, at_once) in [(1.0 + 1e-9, true), (1.0 - 1e-9, false)] {
                let held = format!("{:e}", factor * load);
                let creep = [
                    "creep",
                    "path.npz",
                    "--prony",
                    "1,0.01",
                    "--time=10",
                    "--json",
                    "--load",
                    &held,
                ];
                let sealed = &answer(&[&creep[..], corners].concat())?[format!("seals_{axis}")];
                assert_eq!(sealed.as_f64() == Some(0.0), at_once, "{sealed}");
            }
        }
    }
    Ok(())
}

/// Conductance, tangential stiffness, slip and creep hold on half-spaces alone, and say so; pressure over overclosure
/// is what the path says.
#[test]
fn joints_of_layers_are_refused() -> Result<(), Box<dyn Error>> {
    let folder = Scratch::new("joints-of-layers")?;
    let line = "path --nodes 32 --max-area-fraction 0.1 --layer gold,1e-3 --base steel";
    let path: Vec<&str> = line.split(' ').collect();
    for (options, word) in [
        (&["--conductivity", "50"][..], "conductance"),
        (&["--resistivity", "1e-7"], "conductance"),
        (&["--fe-table", "csv", "--friction", "0.2", "--compliance-ratio", "1.2"], "tangential"),
        // And before it is asked for what would be missing.
        (&["--fe-table", "csv", "--friction", "0.2"], "tangential"),
    ] {
        let refused = run(&folder, &[&path[..], options].concat())?;
        is_refused(&refused, &[word, "layers", "not computed here"]);
        assert!(!folder.join("out").exists(), "refused before any work");
    }
    let done = run(&folder, &[&path[..], &["--fe-table", "csv", "--record", "p.npz"]].concat())?;
    assert!(done.status.success());
    let table = fs::read_to_string(folder.join("out/interface.csv"))?;
    assert!(table.starts_with("pressure,overclosure\n"), "{table}");
    let slip = ["slip", "p.npz", "--friction", "0.3", "--material", "steel"];
    is_refused(&run(&folder, &slip)?, &["slip", "layers", "not computed here"]);
    is_refused(&run(&folder, &slip[..4])?, &["slip", "layers", "not computed here"]);
    let creep = ["creep", "p.npz", "--prony", "1,0.5", "--time", "10", "--load", "1"];
    is_refused(&run(&folder, &creep)?, &["creep", "layers", "one for each material"]);
    Ok(())
}
