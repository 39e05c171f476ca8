//! What the program says: assumptions, warnings, and figures of the mesh.
#![allow(clippy::float_cmp)]

mod common;

use std::error::Error;
use std::ffi::OsStr;
use std::fs;
use std::path::Path;

use common::{
    Scratch, answer, asperity, data, is_refused, number, numbers, output, printed, run, said,
    with_surface,
};
use serde_json::Value;

type Done = Result<(), Box<dyn Error>>;

#[test]
fn both_bodies_are_said_and_assumed_to_be_the_same() -> Done {
    let folder = Scratch::new("bodies")?;
    let steel = "steel (210 GPa, 0.30) against rigid: E* 230.8 GPa";
    let assumed = run(&folder.0, "path --nodes 16 --out assumed")?;
    assert!(said(&assumed).contains(&format!("assumed: {steel}")));
    let named = run(&folder.0, "path --nodes 16 --material steel --out named")?;
    assert!(said(&named).contains(&format!("bodies     {steel}")));
    let table = |name: &str| fs::read(folder.join(name).join("path.csv"));
    assert_eq!(table("assumed")?, table("named")?);
    let both = "path --nodes 16 --material 70e9,0.33 --against rubber --out both";
    assert!(said(&run(&folder.0, both)?).contains("E = 70 GPa, ν = 0.33 against rubber (2 MPa"));
    Ok(())
}

/// Every state has its corrected area: one cell less its four sides at first touch, and what `patches` finds
/// at all others.
#[test]
fn the_area_of_every_state_is_corrected() -> Done {
    let folder = Scratch::new("corrected")?;
    let line = "path --nodes 32 --max-area-fraction 0.3 --record path.npz";
    let words = printed(&run(&folder.0, line)?);
    assert!(words.contains("corrected") && words.contains("mesh: at the last state"), "{words}");
    run(&folder.0, "patches path.npz --out patches")?;
    let file = folder.join("out/path.csv");
    let found = numbers(&file, "corrected_contact_area")?;
    let shares = numbers(&folder.join("patches/patches.csv"), "corrected_area_fraction")?;
    assert_eq!(found.len(), shares.len());
    for (area, share) in found.iter().zip(shares) {
        assert!((area / (1e-4 * share) - 1.0).abs() < 1e-12, "{area} {share}");
    }
    let cell = 1e-4 / (32.0 * 32.0);
    let factor = (std::f64::consts::PI - 1.0 + std::f64::consts::LN_2) / 24.0;
    assert!((found[0] / (cell * (1.0 - 4.0 * factor)) - 1.0).abs() < 1e-12);
    assert!(numbers(&file, "approach_error")?.iter().all(|error| *error >= 0.0));
    Ok(())
}

/// The generated surface is resolved, unless somebody wants its shortest wave shorter.
#[test]
fn what_the_grid_does_not_resolve_is_said() -> Done {
    let folder = Scratch::new("resolved")?;
    let waves = "waves shorter than four cells";
    let resolved = run(&folder.0, "path --nodes 64 --max-area-fraction 0.2")?;
    assert!(!said(&resolved).contains(waves), "{}", said(&resolved));
    assert!(!printed(&resolved).contains("not resolved"), "{}", printed(&resolved));
    let coarse = "path --nodes 64 --max-area-fraction 0.02 --short-cutoff 312.5e-6";
    let coarse = run(&folder.0, coarse)?;
    assert!(said(&coarse).contains(waves), "{}", said(&coarse));
    assert!(printed(&coarse).contains("not resolved"), "{}", printed(&coarse));
    Ok(())
}

#[test]
fn units_that_were_mistaken_are_said_in_every_command() -> Done {
    let folder = with_surface("mistaken")?;
    let all = |options: &str| -> Result<Vec<String>, Box<dyn Error>> {
        let path = format!("path --surface rough.npy {options} --max-area-fraction 0.01");
        let load = format!("load --surface rough.npy {options} --load 1e-9");
        [path, load].iter().map(|line| Ok(said(&run(&folder.0, line)?))).collect()
    };
    for words in all("--side 1e-2 --material 210,0.3")? {
        assert!(words.contains("is softer than rubber"), "{words}");
        assert!(words.contains("it is 230.8 GPa"), "{words}");
        assert!(words.contains("E = 210 Pa, ν = 0.30 against rigid"), "{words}");
    }
    let tiny = "--side 1e-2 --height-unit nm";
    for words in all(&format!("{tiny} --material steel"))? {
        assert!(words.contains("less than a tenth of an atom"), "{words}");
    }
    let seen = run(&folder.0, &format!("info rough.npy {tiny}"))?;
    assert!(printed(&seen).contains("less than a tenth of an atom"));
    let of_no_size = run(&folder.0, "info rough.npy --height-unit nm")?;
    assert!(printed(&of_no_size).contains("less than a tenth of an atom"));
    let seen = run(&folder.0, &format!("info rough.npy {tiny} --json"))?;
    assert!(printed(&seen).contains(r#""warnings":["#) && printed(&seen).contains("an atom"));
    Ok(())
}

#[test]
fn pressures_that_nothing_bears_are_said() -> Done {
    let folder = with_surface("pressures")?;
    let line = "load --surface rough.npy --side 1e-2 --material steel --load 1e99";
    let done = run(&folder.0, line)?;
    let words = printed(&done);
    assert!(words.contains("the greatest pressure is"), "{words}");
    assert!(said(&done).contains("the contact is full"), "{}", said(&done));
    run(&folder.0, "path --nodes 64 --record path.npz")?;
    let words = printed(&run(&folder.0, "patches path.npz --out seen")?);
    assert!(words.contains("warning: the greatest pressure is"), "{words}");
    Ok(())
}

#[test]
fn assumed_units_and_sides_are_said() -> Done {
    let folder = with_surface("assumed")?;
    let metres = "its heights are assumed to be in m";
    let square = "cells are assumed to be square: the side along y is 10 mm";
    let words = printed(&run(&folder.0, "info rough.npy --side 1e-2")?);
    assert!(words.contains(metres) && words.contains(square), "{words}");
    let load = "load --surface rough.npy --side 1e-2 --e-star 1 --load 1e-7";
    let words = said(&run(&folder.0, load)?);
    assert!(words.contains(metres) && words.contains(square), "{words}");
    let known = "info rough.npy --side 1e-2 --side-y 1e-2 --height-unit m";
    let words = printed(&run(&folder.0, known)?);
    assert!(!words.contains("assumed"), "{words}");
    Ok(())
}

/// What repeats on an elastic base has the approach of the mean planes and no K; on a rigid base that gives way it has
/// both a distant point and a K.
#[test]
fn the_legend_explains_the_columns() -> Done {
    let folder = Scratch::new("legend")?;
    for (body, has_k) in [
        ("", true),
        ("--periodic love", false),
        ("--periodic x", true),
        ("--layer gold,1e-4 --base steel --periodic love", false),
        ("--layer 3e6,0.4,1e-3 --base rigid --periodic love", true),
        ("--layer 3e6,0.5,1e-3 --base rigid --periodic love", false),
    ] {
        let words = printed(&run(&folder.0, &format!("path --nodes 16 {body}"))?);
        let header = words.lines().find(|line| line.contains("mean gap")).ok_or("no table")?;
        assert_eq!(header.split_whitespace().any(|name| name == "K"), has_k, "{body}: {words}");
        assert_eq!(words.contains("K: contact stiffness"), has_k, "{body}: {words}");
        assert_eq!(words.contains("approach: of the mean planes"), !has_k, "{body}: {words}");
    }
    Ok(())
}

/// The greatest measures of stress on the screen, which choose their own units, are those of the rows of a file, to
/// four digits.
fn greatest_are_those_of_the_rows(words: &str, file: &Path) -> Done {
    let unit = |name: &str| match name.trim_end_matches(',') {
        "GPa" => Ok(1e9),
        "MPa" => Ok(1e6),
        "µm" => Ok(1e-6),
        "mm" => Ok(1e-3),
        other => Err(format!("no unit: {other}")),
    };
    for (label, name) in [
        ("von Mises", "von_mises"),
        ("Tresca", "tresca"),
        ("greatest shear", "greatest_shear"),
        ("greatest tension", "greatest_tension"),
    ] {
        let line = words.lines().find_map(|line| line.trim_start().strip_prefix(label));
        let (value, rest) = line.ok_or(label)?.split_once(" at a depth of ").ok_or("no depth")?;
        let (depth, node) = rest.split_once(" below node ").ok_or("no node")?;
        let number = |text: &str| -> Result<f64, Box<dyn Error>> {
            let (number, name) = text.trim().split_once(' ').ok_or("no unit")?;
            Ok(number.parse::<f64>()? * unit(name)?)
        };
        let values = numbers(file, name)?;
        let greatest = values.iter().copied().fold(f64::MIN, f64::max);
        let row = values.iter().position(|value| *value == greatest).ok_or("no row")?;
        let at = |name: &str| numbers(file, name).map(|column| column[row]);
        for (found, expected) in [(number(value)?, greatest), (number(depth)?, at("depth")?)] {
            assert!((found / expected - 1.0).abs() < 5.001e-4, "{label}: {expected} {words}");
        }
        let [ix, iy] = [at(&format!("{name}_ix"))?, at(&format!("{name}_iy"))?];
        assert_eq!(node, format!("({ix}, {iy})"), "{label}");
    }
    Ok(())
}

/// Files are in SI units whatever is chosen, and the rows on the screen are theirs in mm, N and MPa, to four digits.
#[test]
fn rows_in_millimetres_are_those_of_the_files() -> Done {
    let folder = with_surface("millimetres")?;
    let surface = "--surface rough.npy --side 1cm --material steel";
    let path = format!("path {surface} --mean-pressure 50MPa --record path.npz");
    let load = format!("load {surface} --at 20MPa,50MPa");
    let stress = "stress path.npz --depth 0.1mm --depth 0.3mm".to_string();
    for (line, file) in [(path, "path.csv"), (load, "load.csv"), (stress, "stress.csv")] {
        run(&folder.0, &format!("{line} --out si"))?;
        let words = printed(&run(&folder.0, &format!("{line} --units mm-N-MPa --out mm"))?);
        let [si, mm] = ["si", "mm"].map(|name| folder.join(name).join(file));
        assert_eq!(fs::read(&si)?, fs::read(mm)?, "{file}");
        if file == "stress.csv" {
            greatest_are_those_of_the_rows(&words, &si)?;
            continue;
        }
        let mut table = words.lines().skip_while(|line| !line.contains("mean gap")).skip(1);
        let units: Vec<&str> = table.next().ok_or("no units")?.split_whitespace().collect();
        assert_eq!(units, ["N", "MPa", "MPa", "mm²", "%", "%", "mm", "mm", "N/mm", "N/mm"]);
        let rows: Vec<&str> = table.take_while(|line| !line.trim().is_empty()).collect();
        // On 100 mm².
        let columns = [
            (0, "load", 1.0),
            (1, "load", 1e-2),
            (2, "max_pressure", 1e-6),
            (3, "contact_area", 1e6),
            (4, "contact_area", 1e6),
            (5, "corrected_contact_area", 1e6),
            (6, "approach", 1e3),
            (7, "mean_gap", 1e3),
            (8, "contact_stiffness", 1e-3),
            (9, "interfacial_stiffness", 1e-3),
        ];
        for (place, name, unit) in columns {
            // There is no greatest pressure in path.csv.
            if name == "max_pressure" && file == "path.csv" {
                continue;
            }
            // Of a path the table has some of the states, and the last.
            let values = numbers(&si, name)?;
            let shown = if file == "path.csv" { 1 } else { values.len() };
            assert!(rows.len() >= shown && values.len() >= shown, "{words}");
            for (row, value) in rows.iter().rev().zip(values.iter().rev()).take(shown) {
                let cell = row.split_whitespace().nth(place).ok_or("no cell")?;
                let found: f64 = cell.parse()?;
                let expected = unit * value;
                assert!((found / expected - 1.0).abs() < 5.001e-4, "{name}: {expected} {row}");
            }
        }
    }
    Ok(())
}

/// Per nominal area, for one load as on the path to it, with what yields too.
#[test]
fn conductances_are_told_of_every_state() -> Done {
    let folder = with_surface("conducts")?;
    for hardness in ["", "--hardness 2.5GPa"] {
        let of = format!(
            "--surface rough.npy --side 1cm --material steel {hardness} --conductivity 50,50 --at 50MPa"
        );
        let conductance =
            |value: &Value| value["thermal_conductance"].as_f64().ok_or("no conductance");
        let load = answer(&folder.0, &format!("load {of}"))?;
        let (one, path) =
            (conductance(&load["states"][0])?, answer(&folder.0, &format!("path {of}"))?);
        let on_path = conductance(&path["at"][0])?;
        // The tolerance of the single load.
        assert!((one / on_path - 1.0).abs() < 1e-6, "{one} {on_path}");
        assert_eq!(conductance(&path)?, on_path);
        for command in ["load", "path"] {
            let words = printed(&run(&folder.0, &format!("{command} {of} --units mm-N-MPa"))?);
            let row = words
                .lines()
                .skip_while(|line| !line.contains("mW/(mm² K)"))
                .nth(1)
                .ok_or("no row")?;
            let shown: f64 = row.split_whitespace().last().ok_or("no cell")?.parse()?;
            // 1 mW/(mm² K) on 100 mm² is 0.1 W/K.
            assert!((shown / (10.0 * one) - 1.0).abs() < 1e-3, "{shown} {one}");
        }
    }
    Ok(())
}

/// A file or an option where a command is expected.
#[test]
fn a_command_line_without_a_command_gets_a_tip() -> Done {
    let folder = with_surface("tips")?;
    for (line, tip) in [
        ("rough.npy", "`asperity info rough.npy`"),
        ("--out there", "`asperity path --out ...`"),
        ("path --mean-pressure 5mm", "'mm' is no unit of pressure (Pa, "),
        ("path --hardness 70HRC", "between 20 and 68"),
    ] {
        let done = output(&folder.0, line)?;
        assert_eq!(done.status.code(), Some(2));
        assert!(said(&done).contains(tip), "{}", said(&done));
    }
    Ok(())
}

/// The library names its functions, and the program its options beside them.
#[test]
fn advice_names_an_option() -> Done {
    let folder = with_surface("advice")?;
    fs::copy(data("surface_files/missing_f64.x3p"), folder.join("holes.x3p"))?;
    fs::write(
        folder.join("tilted.txt"),
        "0 1001 2000 3001\n1 1000 2001 3000\n0 1001 2000 3001\n1 1000 2001 3000\n",
    )?;
    let refused = |line: &str, words: &[&str]| -> Done {
        let arguments: Vec<&OsStr> = line.split(' ').map(OsStr::new).collect();
        is_refused(&asperity(&folder.0, &arguments).output()?, words);
        Ok(())
    };
    let load = "--e-star 1 --load 1e-7";
    refused(
        &format!("load --surface holes.x3p {load}"),
        &["2 heights are missing", "can be filled by `--fill`"],
    )?;
    refused(
        &format!("load --surface tilted.txt --layout matrix {load}"),
        &["the heights have no unit", "give it with `--height-unit`"],
    )?;
    refused(
        &format!("load --surface tilted.txt --layout matrix --height-unit nm {load}"),
        &["give it with `--side`"],
    )?;
    let tilted = "info tilted.txt --layout matrix --height-unit nm --side 1e-3";
    let words = printed(&run(&folder.0, tilted)?);
    let advice = "level it (`--level plane`) unless the tilt is meant";
    assert!(words.contains(advice), "{words}");
    Ok(())
}

/// What a text was taken for is said, to people and to programs.
#[test]
fn info_says_how_a_text_was_understood() -> Done {
    let folder = with_surface("understood")?;
    fs::copy(data("text_files/index_column.csv"), folder.join("list.csv"))?;
    let words = printed(&run(&folder.0, "info list.csv")?);
    assert!(
        words.contains("understood    108 points, columns x [um], y [um], z [um] by name"),
        "{words}"
    );
    let words = printed(&run(&folder.0, "info list.csv --json")?);
    assert!(words.contains("\"understood\":\"108 points, columns"), "{words}");
    Ok(())
}

#[test]
fn info_prepares_the_surface_as_it_is_told() -> Done {
    let folder = with_surface("prepared")?;
    fs::copy(data("surface_files/missing_f64.x3p"), folder.join("holes.x3p"))?;
    let number = |line: &str, name: &str| -> Result<f64, Box<dyn Error>> {
        let text = printed(&run(&folder.0, line)?);
        let after = text.split(&format!("\"{name}\":")).nth(1).ok_or("no such figure")?;
        Ok(after.split([',', '}']).next().ok_or("no number")?.parse()?)
    };
    let rough = "info rough.npy --side 1e-2 --json";
    let (min, max) = (number(rough, "min")?, number(rough, "max")?);
    let inverted = format!("{rough} --invert");
    assert_eq!((number(&inverted, "min")?, number(&inverted, "max")?), (-max, -min));
    let (sq, level) = (number(rough, "sq")?, format!("{rough} --level quadratic"));
    assert!(number(&level, "sq")? < sq);
    let (sa, sz) = (number(rough, "sa")?, number(rough, "sz")?);
    assert!(sa < sq && sq < sz && (sz / (max - min) - 1.0).abs() < 1e-12);
    // Holes: one population, of which nothing contradicts anything.
    let words = printed(&run(&folder.0, "info holes.x3p")?);
    assert!(words.contains("of all nodes, the 2 missing ones filled"), "{words}");
    let holes = "info holes.x3p --json";
    for name in ["min", "max", "sq", "sa", "sz", "rms_gradient"] {
        assert_eq!(number(holes, name)?, number(&format!("{holes} --fill"), name)?);
    }
    Ok(())
}

/// A plane that is taken off takes nothing else with it, whichever nodes are missing: these are filled afterwards.
#[test]
fn holes_are_filled_behind_the_level() -> Done {
    let folder = Scratch::new("level-then-fill")?;
    let write = |name: &str, slope: f64| {
        let height = |ix: usize, iy: usize| match ix < 3 || (ix + iy) % 11 == 5 {
            true => f64::NAN,
            false => ((7 * ix + 3 * iy * iy) % 13) as f64 + slope * ix as f64,
        };
        let rows = (0..16).map(|iy| {
            let row: Vec<String> = (0..24).map(|ix| height(ix, iy).to_string()).collect();
            row.join(";")
        });
        fs::write(folder.0.join(name), rows.collect::<Vec<_>>().join("\n"))
    };
    write("flat.csv", 0.0)?;
    write("tilted.csv", 40.0)?;
    let reading = "--height-unit um --side 1mm";
    // Heights rise to 920 µm by the tilt, and are rounded to 1e-16 of that; 1e-10 of the range is what filling leaves.
    let close = |a: f64, b: f64| (a - b).abs() <= 1e-8 * b.abs();
    let load = |name: &str| {
        answer(
            &folder.0,
            &format!("load --surface {name} {reading} --fill --level plane --e-star 1e9 --load 1"),
        )
    };
    let [flat, tilted] = [load("flat.csv")?, load("tilted.csv")?];
    for name in ["approach", "mean_gap", "contact_area"] {
        let [found, expected] = [&tilted, &flat].map(|load| number(&load["states"][0], name));
        assert!(close(found, expected), "{name}: {found} {expected}");
    }
    let info = |name: &str| answer(&folder.0, &format!("info {name} {reading}"));
    let [flat, tilted] = [info("flat.csv")?, info("tilted.csv")?];
    for name in ["ssk", "sku", "sdr", "sal", "sk", "spk", "svk"] {
        let [found, expected] = [&tilted, &flat].map(|info| number(&info["texture"], name));
        assert!(close(found, expected), "{name}: {found} {expected}");
    }
    Ok(())
}

#[test]
fn patches_say_what_to_run_and_where_a_leak_passes() -> Done {
    let folder = Scratch::new("channels")?;
    run(&folder.0, "path --nodes 32 --periodic love --max-area-fraction 0.1 --record p.npz")?;
    let words = printed(&run(&folder.0, "patches p.npz")?);
    assert!(words.contains("seals along x            not on this path"), "{words}");
    assert!(words.contains("the widest channel along x is narrowest at node"), "{words}");
    let command = words.split("asperity path ").nth(1).ok_or("no command")?;
    let command = command.split(", and then").next().ok_or("no end")?;
    run(&folder.0, &format!("path {command}"))?;
    let words = printed(&run(&folder.0, "patches p.npz")?);
    assert!(words.contains("seals along x            from state"), "{words}");
    assert!(words.contains("no channel along x: the contact seals"), "{words}");
    // `stress`, `leak` and `slip` call it so.
    let [at, as_elsewhere] = ["--at-load", "--load"]
        .map(|option| run(&folder.0, &format!("patches p.npz --json {option} 100kN")));
    assert_eq!(printed(&at?), printed(&as_elsewhere?));
    Ok(())
}
