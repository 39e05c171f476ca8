//! What the program says: assumptions, warnings, and figures of the mesh.
#![allow(clippy::float_cmp)]

mod common;

use std::error::Error;
use std::ffi::OsStr;
use std::fs;
use std::path::Path;
use std::process::Output;

use asperity::io::{ReadOptions, read_npy, write_npy};
use asperity::surface::Topography;
use common::{Scratch, answer, asperity, data, is_refused, number, numbers, output, run, said};
use nalgebra::DMatrix;
use serde_json::Value;

type Done = Result<(), Box<dyn Error>>;

fn printed(done: &Output) -> String {
    String::from_utf8_lossy(&done.stdout).into_owned()
}

/// A folder with a surface of 48 × 48 nodes.
fn with_surface(name: &str) -> std::io::Result<Scratch> {
    let folder = Scratch::new(name)?;
    fs::copy(data("selfaffine_48.npy"), folder.join("rough.npy"))?;
    Ok(folder)
}

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

/// A mean pressure is a load, with a unit or without. People read a table of all states, and programs a file and an
/// object.
#[test]
fn loads_are_given_as_mean_pressures_too() -> Done {
    let folder = with_surface("mean-pressure")?;
    let line = "load --surface rough.npy --side 1cm --e-star 1 --load 1e-7 --mean-pressure 1e-3 --at 2mPa,20%";
    let words = printed(&run(&folder.0, line)?);
    let table: Vec<&str> = words.lines().skip_while(|line| !line.contains("mean gap")).collect();
    assert!(table[0].trim_start().starts_with("load  pressure"), "{words}");
    for (row, begin) in table[2..6].iter().zip(["0.1000", "0.1000", "0.2000", ""]) {
        assert!(row.trim_start().starts_with(begin), "{words}");
    }
    let written = std::path::Path::new("out").join("load.csv");
    assert!(words.contains(&format!("wrote {}", written.display())), "{words}");
    let file = folder.0.join(written);
    for (found, expected) in numbers(&file, "load")?.iter().zip([1e-7, 1e-3 * 1e-4, 2e-7]) {
        assert!((found / expected - 1.0).abs() < 1e-12, "{found}");
    }
    let fractions = numbers(&file, "contact_area_fraction")?;
    let areas = numbers(&file, "contact_area")?;
    assert!((fractions[1] * 1e-4 / areas[1] - 1.0).abs() < 1e-12);
    assert!((fractions[3] - 0.2).abs() < 1e-3, "{}", fractions[3]);
    for name in ["100nN", "1mPa", "2mPa", "20%"] {
        let picture = fs::read(folder.join(&format!("out/contact_map_{name}.png")))?;
        assert!(picture.starts_with(b"\x89PNG"));
    }
    let object = answer(&folder.0, line)?;
    let found = object["states"].as_array().ok_or("no states")?;
    for (place, state) in found.iter().enumerate() {
        assert_eq!(state["load"].as_f64(), Some(numbers(&file, "load")?[place]));
        assert!(state["contact_nodes"].is_u64() && state["seconds"].is_f64());
    }
    assert_eq!(found.len(), 4);
    let twice = "load --surface rough.npy --side 1cm --e-star 1 --at 1mPa --mean-pressure 1e-3";
    is_refused(&output(&folder.0, twice)?, &["the state at 1 mPa is asked for twice"]);
    Ok(())
}

/// Rows, maps and fields of the states that are asked for, all of one path that ends at the last of them, and no row
/// but theirs.
#[test]
fn states_are_asked_for() -> Done {
    let folder = Scratch::new("at")?;
    let path = "path --nodes 32 --fields npy --at";
    let words = printed(&run(&folder.0, &format!("{path} 5MPa,2kN,50MPa"))?);
    let rows = words.lines().skip_while(|line| !line.contains("mean gap")).skip(2);
    let rows: Vec<&str> = rows.take_while(|line| !line.is_empty()).collect();
    assert_eq!(rows.len(), 3, "{words}");
    let found = answer(&folder.0, &format!("{path} 5MPa,2kN,50MPa"))?;
    let (states, end) = (&found["at"], &found["load"]);
    for (place, (name, load)) in
        [("5MPa", 500.0), ("2kN", 2000.0), ("50MPa", 5000.0)].into_iter().enumerate()
    {
        let state = &states[place];
        assert_eq!(state["load"].as_f64(), Some(load), "{state}");
        for file in [format!("contact_map_{name}.png"), format!("gap_{name}.npy")] {
            assert!(folder.join("out").join(&file).exists(), "{file}");
        }
        let pressure = asperity::io::read_npy(folder.join(&format!("out/pressure_{name}.npy")))?;
        let sum = pressure.sum() * 1e-4 / 1024.0;
        assert!((sum / load - 1.0).abs() < 1e-12, "{sum}");
        assert_eq!(Some(pressure.max()), state["max_pressure"].as_f64());
    }
    assert_eq!(end.as_f64(), Some(5000.0));
    // Areas too, with an end of the path that lies beyond them.
    let found = answer(&folder.0, &format!("{path} 10%,5MPa --max-area-fraction 20%"))?;
    assert_eq!(found["at"][0]["contact_area_fraction"].as_f64(), Some(102.0 / 1024.0));
    assert_eq!(found["at"][1]["load"].as_f64(), Some(500.0));
    is_refused(&output(&folder.0, &format!("{path} 10%,5MPa"))?, &["say where the path ends"]);
    let beyond = format!("{path} 5MPa,50GPa --max-area-fraction 20% --out beyond");
    is_refused(&output(&folder.0, &beyond)?, &["the path has no state at 50 GPa: it ends at "]);
    assert!(folder.join("beyond/contact_map_5MPa.png").exists());
    // What is known before is said before.
    for (at, end, words) in [
        ("5MPa,500MPa", "--mean-pressure 50MPa", "--at 500 MPa is beyond --mean-pressure 50 MPa"),
        ("5N", "--max-load 4N", "--at 5 N is beyond --max-load 4 N"),
        ("10%,30%", "--max-area-fraction 0.2", "--at 30 % is beyond --max-area-fraction 20 %"),
    ] {
        is_refused(&output(&folder.0, &format!("{path} {at} {end} --out none"))?, &[words]);
        assert!(!folder.join("none").exists());
    }
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

/// Units in options are those of the SI by other names, and tables may be in millimetres.
#[test]
fn units_are_understood_and_chosen() -> Done {
    let folder = Scratch::new("units")?;
    let path = "path --nodes 16 --out";
    run(
        &folder.0,
        &format!("{path} si --side 2e-2 --material 70e9,0.33 --hardness 2.5e9 --mean-pressure 5e6"),
    )?;
    run(
        &folder.0,
        &format!(
            "{path} mm --side 20mm --material 70GPa,0.33 --hardness 2.5GPa --mean-pressure 5MPa"
        ),
    )?;
    let table = |name: &str| fs::read(folder.join(name).join("path.csv"));
    assert_eq!(table("si")?, table("mm")?);
    let line = format!("{path} units --mean-pressure 5MPa --fe-table csv");
    run(&folder.0, &line)?;
    let file = folder.join("units/interface.csv");
    let (pressure, overclosure) = (numbers(&file, "pressure")?, numbers(&file, "overclosure")?);
    let words = printed(&run(&folder.0, &format!("{line} --units mm-n-mpa"))?);
    let header: Vec<&str> = words
        .lines()
        .skip_while(|line| !line.contains("mean gap"))
        .nth(1)
        .map(|line| line.split_whitespace().collect())
        .unwrap_or_default();
    assert_eq!(header, ["N", "MPa", "MPa", "mm²", "%", "%", "mm", "mm", "N/mm", "N/mm"]);
    // Its names tell the units.
    for (name, values, unit) in
        [("pressure [MPa]", pressure, 1e-6), ("overclosure [mm]", overclosure, 1e3)]
    {
        for (found, value) in numbers(&file, name)?.iter().zip(values) {
            assert!((found - unit * value).abs() <= 1e-12 * found, "{name}: {found} {value}");
        }
    }
    let hint = said(&run(&folder.0, "path --nodes 16 --hardness 2.5 --at 1mPa")?);
    assert!(hint.contains("If it was given in GPa, it is 2.5 GPa"), "{hint}");
    Ok(())
}

/// `--channel` chooses among the maps of a file, `--ignore-mask` takes what a mask marks, and `--lateral-unit` is that
/// of positions: each beside the file, or the answer, that it has to come to.
#[test]
fn a_map_a_mask_and_a_unit_are_chosen() -> Done {
    let folder = Scratch::new("chosen")?;
    for file in ["plain_i16.spm", "masked.gwy", "plain.gsf", "missing.xyz"] {
        fs::copy(data(&format!("surface_files/{file}")), folder.join(file))?;
    }
    let info = |line: &str| answer(&folder.0, &format!("info {line}"));
    // By itself it takes the only map that is a length, in nanometres.
    let heights = info("plain_i16.spm")?;
    assert_eq!(heights["title"], "Height Sensor");
    let phase = info("plain_i16.spm --channel Phase --height-unit nm")?;
    let read = ReadOptions::new().channel("Phase").height_unit("nm".parse()?);
    let expected = read.read(folder.join("plain_i16.spm"))?.heights;
    assert_eq!(phase["title"], "Phase");
    assert_eq!((number(&phase, "min"), number(&phase, "max")), (expected.min(), expected.max()));
    assert!(number(&phase, "max") != number(&heights, "max"), "{phase}");
    is_refused(&output(&folder.0, "info plain_i16.spm --channel Height")?, &["Phase"]);
    // The file without a mask has the same surface, and nothing is missing there.
    let (masked, ignored) = (info("masked.gwy")?, info("masked.gwy --ignore-mask")?);
    let plain = info("plain.gsf")?;
    assert_eq!((&masked["missing"], &ignored["missing"]), (&2.into(), &0.into()));
    for name in ["min", "max", "mean", "sq", "sa", "rms_gradient"] {
        let (found, expected) = (number(&ignored, name), number(&plain, name));
        // The heights of one of them have four bytes.
        assert!((found / expected - 1.0).abs() < 1e-5, "{name}: {found} {expected}");
        assert!(name == "min" || number(&masked, name) != found, "{name} of {masked}");
    }
    // Heights do not change with it.
    let [mm, um] = ["mm", "um"].map(|unit| {
        let of_positions = format!("--lateral-unit {unit}");
        info(&format!("missing.xyz --height-unit nm {of_positions}"))
    });
    let (mm, um) = (mm?, um?);
    for (name, times) in [("side_x", 1e3), ("side_y", 1e3), ("sq", 1.0), ("rms_gradient", 1e-3)] {
        let (found, expected) = (number(&mm, name), times * number(&um, name));
        assert!((found / expected - 1.0).abs() < 1e-12, "{name}: {found} {expected}");
    }
    Ok(())
}

/// Gaps of a single load are those of the path to it, which has no tolerance, to `--tolerance` times the approach.
#[test]
fn a_tighter_tolerance_is_nearer() -> Done {
    let folder = with_surface("tolerance")?;
    let of = "--surface rough.npy --side 1e-2 --e-star 1";
    let path = answer(&folder.0, &format!("path {of} --max-load 3.41e-7 --fields npy --out path"))?;
    let (exact, approach) = (read_npy(folder.join("path/gap.npy"))?, number(&path, "approach"));
    let mut before = f64::INFINITY;
    for tolerance in [1e-2, 1e-4, 1e-6, 1e-8, 1e-10] {
        let line = format!("load {of} --load 3.41e-7 --tolerance {tolerance} --save fields");
        let done = answer(&folder.0, &line)?;
        assert!(done["states"][0]["iterations"].as_u64() > Some(0), "{done}");
        let off = (read_npy(folder.join("fields/gap_341nN.npy"))? - &exact).amax() / approach;
        assert!(off <= tolerance && off < 0.1 * before, "{tolerance}: {off}, before {before}");
        before = off;
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

/// The roughness that is asked for is that of the surface, isotropic or not.
#[test]
fn generated_surfaces_have_the_roughness_that_is_asked_for() -> Done {
    let folder = Scratch::new("roughness")?;
    let heights = |options: &str| -> Result<Topography, Box<dyn Error>> {
        let line =
            format!("path --nodes 64 --side 1mm --max-area-fraction 1% {options} --record r.npz");
        run(&folder.0, &line)?;
        let record = asperity::record::LoadingRecord::read_npz(folder.join("r.npz"))?;
        fs::remove_file(folder.join("r.npz"))?;
        Ok(Topography::new(record.grid(), record.heights().matrix().clone())?)
    };
    let base = "--hurst 0.9 --rolloff 0.25mm";
    let surface = heights(&format!("--sq 1um {base}"))?;
    assert!((surface.map().rms_height() / 1e-6 - 1.0).abs() < 1e-12);
    // The gradient is that of the waves, not of differences.
    let surface = heights(&format!("--rms-gradient 0.1 {base} --short-cutoff 62.5um"))?;
    assert!((surface.rms_gradient_spectral() / 0.1 - 1.0).abs() < 1e-12);
    let along = |surface: &Topography, (x, y): (f64, f64)| -> f64 {
        let (heights, grid) = (surface.map().matrix(), surface.grid());
        let (nx, ny) = grid.shape();
        let square = |ix: usize, iy: usize| {
            let dx = (heights[((ix + 1) % nx, iy)] - heights[(ix, iy)]) / grid.dx();
            let dy = (heights[(ix, (iy + 1) % ny)] - heights[(ix, iy)]) / grid.dy();
            (x * dx).powi(2) + (y * dy).powi(2)
        };
        (0..nx * ny).map(|k| square(k % nx, k / nx)).sum()
    };
    let stretched = heights(&format!("--rms-gradient 0.1 {base} --anisotropy 4"))?;
    assert!((stretched.rms_gradient_spectral() / 0.1 - 1.0).abs() < 0.05);
    let ratio = (along(&stretched, (0.0, 1.0)) / along(&stretched, (1.0, 0.0))).sqrt();
    assert!((ratio / 4.0 - 1.0).abs() < 0.2, "{ratio}");
    assert!(
        said(&run(&folder.0, "path --nodes 32 --sq 1um --max-area-fraction 1%")?)
            .contains("generated: self-affine")
    );
    for refused in ["--sq 1um --rms-gradient 0.1", "--surface r.npy --sq 1um", "--hurst 1.5"] {
        assert_eq!(
            output(&folder.0, &format!("path {refused}"))?.status.code(),
            Some(2),
            "{refused}"
        );
    }
    Ok(())
}

/// Two rough bodies are one with the sum of both, of which the second is turned over.
#[test]
fn two_rough_surfaces_face_each_other() -> Done {
    let folder = with_surface("facing")?;
    let rough = asperity::io::read_npy(folder.join("rough.npy"))?;
    let other = DMatrix::from_fn(48, 48, |ix, iy| 1e-6 * ((ix * ix + 7 * iy) % 13) as f64);
    write_npy(folder.join("other.npy"), &other)?;
    let sum = |map: &dyn Fn(usize, usize) -> (usize, usize)| {
        DMatrix::from_fn(48, 48, |ix, iy| rough[(ix, iy)] + other[map(ix, iy)])
    };
    write_npy(folder.join("turned_over.npy"), &sum(&|ix, iy| (47 - ix, iy)))?;
    write_npy(folder.join("turned.npy"), &sum(&|ix, iy| (ix, 47 - iy)))?;
    let body = "--side 1cm --material steel --max-area-fraction 5% --out";
    let table = |surfaces: &str, out: &str| -> Result<Vec<u8>, Box<dyn Error>> {
        run(&folder.0, &format!("path --surface {surfaces} {body} {out}"))?;
        Ok(fs::read(folder.join(out).join("path.csv"))?)
    };
    let both = "rough.npy --against-surface other.npy";
    assert_eq!(table(both, "a")?, table("turned_over.npy", "b")?);
    assert_eq!(table(&format!("{both} --against-turned"), "c")?, table("turned.npy", "d")?);
    // Moved by 5 nodes along x and by -2 along y, and by whole periods more.
    let turned = |ix: usize, iy: usize| ((47 + 5 + 48 - ix) % 48, (iy + 2) % 48);
    write_npy(folder.join("moved.npy"), &sum(&turned))?;
    let both = format!("{both} --periodic love");
    let moved = table("moved.npy --periodic love", "e")?;
    for (shift, out) in [("5,-2", "f"), ("-43,46", "g"), ("53,94", "h")] {
        assert_eq!(table(&format!("{both} --against-shift {shift}"), out)?, moved);
    }
    assert_eq!(table(&format!("{both} --against-shift -48,96"), "i")?, table(&both, "k")?);
    let free = "path --surface rough.npy --against-surface other.npy --against-shift 1,0 --side 1cm --material steel";
    is_refused(&output(&folder.0, free)?, &["--against-shift", "repeat", "--periodic"]);
    let words = free.replace("1,0", "1mm,0");
    assert_eq!(output(&folder.0, &words)?.status.code(), Some(2));
    write_npy(folder.join("small.npy"), &other.resize(24, 24, 0.0))?;
    let small = "path --surface rough.npy --against-surface small.npy --side 1cm --material steel";
    is_refused(&output(&folder.0, small)?, &["two rough surfaces need one grid", "24 x 24 nodes"]);
    Ok(())
}

/// An array that is an image gives what its transposed one does.
#[test]
fn arrays_may_be_images() -> Done {
    let folder = with_surface("image")?;
    let rough = asperity::io::read_npy(folder.join("rough.npy"))?;
    write_npy(folder.join("image.npy"), &rough.rows(0, 32).transpose())?;
    write_npy(folder.join("array.npy"), &rough.rows(0, 32).into_owned())?;
    let line = "--side 1cm --material steel --max-area-fraction 5% --out";
    let words = said(&run(&folder.0, &format!("path --surface array.npy {line} a"))?);
    assert!(words.contains("`--rows-are-y` takes an image"), "{words}");
    let words = said(&run(&folder.0, &format!("path --surface image.npy --rows-are-y {line} b"))?);
    assert!(!words.contains("--rows-are-y"), "{words}");
    let table = |name: &str| fs::read(folder.join(name).join("path.csv"));
    assert_eq!(table("a")?, table("b")?);
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
