//! Paths on which cells yield, and the way back.

mod common;

use std::error::Error;
use std::fs;
use std::path::Path;

use asperity::number::quantity;
use common::{Scratch, answer, column, is_refused, number, numbers, output, said};

type Done = Result<(), Box<dyn Error>>;

fn finished(folder: &Path, line: &str) -> Result<String, Box<dyn Error>> {
    let done = output(folder, line)?;
    assert!(done.status.success(), "{line}: {}", said(&done));
    Ok(said(&done) + &String::from_utf8_lossy(&done.stdout))
}

/// A load under which all cells in contact have yielded, half of them: the state of the path, which ends where that
/// load is reached.
#[test]
fn loads_of_plateaus_are_those_of_the_path() -> Done {
    let folder = Scratch::new("hardness_plateau")?;
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/hardness/plateaus_16.npy");
    let of = format!("--surface {file} --side 1e-3 --e-star 100e9 --hardness 8e6");
    for periodic in ["", "--periodic love"] {
        finished(&folder.0, &format!("path {of} {periodic} --mean-pressure 4e6"))?;
        finished(&folder.0, &format!("load {of} {periodic} --mean-pressure 4e6 --out load"))?;
        let [path, load] = ["out/path.csv", "load/load.csv"].map(|name| folder.join(name));
        for name in ["approach", "load", "mean_gap", "contact_area", "yielded_area_fraction"] {
            let (path, load) = (numbers(&path, name)?, numbers(&load, name)?);
            let (path, load) = (path[path.len() - 1], load[0]);
            assert!((load / path - 1.0).abs() < 1e-10, "{name}: {load} {path}");
        }
    }
    Ok(())
}

/// The contact conducts as where unloading begins, in path.csv and in the table; the files of a record that goes on
/// have the same columns.
#[test]
fn what_yields_conducts_as_well() -> Done {
    let folder = Scratch::new("hardness_conducts")?;
    let joint = "--conductivity 50,50 --fe-table csv --friction 0.2 --compliance-ratio 1.2";
    let line = format!(
        "path --nodes 32 --mean-pressure 5e8 --hardness 2e9 --unload --record path.npz {joint}"
    );
    finished(&folder.0, &line)?;
    let found = numbers(&folder.join("out/path.csv"), "thermal_conductance")?;
    assert!(found.windows(2).all(|pair| pair[0] > 0.0 && pair[0] <= pair[1]));
    // Steel against a rigid body.
    let e_star = 210e9 / (1.0 - 0.3 * 0.3);
    let last = |file: &str, name: &str| -> Result<f64, Box<dyn Error>> {
        Ok(*numbers(&folder.join(file), name)?.last().ok_or("no line")?)
    };
    let first = |name: &str| -> Result<f64, Box<dyn Error>> {
        Ok(numbers(&folder.join("out/unloading.csv"), name)?[0])
    };
    // Two factors of condition numbers of 10³.
    let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-10;
    let e_star_times_rho = e_star * 0.04;
    let expected = 2.0 * first("contact_stiffness")? / e_star_times_rho;
    assert!(near(found[found.len() - 1], expected), "{} {expected}", found[found.len() - 1]);
    for picture in ["conductance.png", "unloading.svg", "loading_curve.svg"] {
        assert!(folder.join("out").join(picture).exists(), "{picture}");
    }
    let interfacial = first("interfacial_stiffness")? / 1e-4;
    let table = "out/interface.csv";
    assert!(near(last(table, "thermal_conductance")?, 2.0 * interfacial / e_star_times_rho));
    assert!(near(last(table, "tangential_stiffness")?, interfacial / 1.2));
    let again = format!("path --resume path.npz {joint} --unload --out again");
    finished(&folder.0, &format!("{again} --charts svg"))?;
    let picture = |name: &str| fs::read(folder.join("again").join(name));
    assert!(picture("conductance.svg")?.starts_with(b"<svg width=\"560\" height=\"440\" "));
    assert!(picture("conductance.png").is_err());
    finished(&folder.0, &format!("{again} --charts png"))?;
    for name in ["conductance.png", "unloading.png", "loading_curve.png"] {
        assert!(picture(name)?.starts_with(b"\x89PNG"), "{name}");
    }
    let pdf = output(&folder.0, &format!("{again} --charts pdf"))?;
    assert!(said(&pdf).contains("PDF is not written") && pdf.status.code() == Some(2));
    for file in ["path.csv", "interface.csv"] {
        let [a, b] = ["out", "again"].map(|name| fs::read(folder.join(&format!("{name}/{file}"))));
        assert_eq!(a?, b?, "{file}");
    }
    let line = "path --nodes 32 --hardness 2e9 --conductivity 50 --unresolved-roughness 1e-8";
    is_refused(&output(&folder.0, line)?, &["residual_surface.npy"]);
    Ok(())
}

/// Events of both kinds; the way back begins at the last state, and its surface is one to be read again: pressed by the
/// same load it is in contact with as many nodes.
#[test]
fn cells_yield_and_the_way_back_is_elastic() -> Done {
    let folder = Scratch::new("hardness")?;
    let words = finished(
        &folder.0,
        "path --nodes 48 --max-area-fraction 0.2 --hardness 250HV --unload --record path.npz --fields npy",
    )?;
    assert!(words.contains("hardness   2.644 GPa") && words.contains("unloading:"), "{words}");
    assert!(!words.contains("metals yield at"), "{words}");
    let (path, back) = (folder.join("out/path.csv"), folder.join("out/unloading.csv"));
    let events = column(&path, "event")?;
    let count = |kind: &str| events.iter().filter(|event| *event == kind).count();
    assert_eq!((count("touch"), count("touch") + count("yield")), (460, events.len()));
    assert!(count("yield") > 400, "{}", count("yield"));
    let yielded = numbers(&path, "yielded_area_fraction")?;
    let last = *yielded.last().ok_or("no state")?;
    assert!((last - count("yield") as f64 / 2304.0).abs() < 1e-15);
    for name in ["load", "approach", "mean_gap"] {
        let (to, from) = (numbers(&path, name)?, numbers(&back, name)?);
        let (to, from) = (to[to.len() - 1], from[0]);
        assert!((from / to - 1.0).abs() < 1e-9, "{name}: {from} {to}");
    }
    assert_eq!(numbers(&back, "load")?.last(), Some(&0.0));
    assert!(folder.join("out/plastic_depth.npy").exists());

    let load = numbers(&path, "load")?;
    let load = load[load.len() - 1];
    for file in ["residual_surface.npy", "residual_surface.x3p"] {
        let sides = if file.ends_with("npy") { "--side 1e-2" } else { "" };
        let line = format!(
            "load --surface out/{file} {sides} --material steel --load {load:e} --out again"
        );
        finished(&folder.0, &line)?;
        let nodes = numbers(&folder.join("again/load.csv"), "contact_nodes")?;
        // Nodes that have yielded carry all the same there, but those that touch at this very load.
        assert!((nodes[0] - 460.0).abs() <= 2.0, "{nodes:?}");
    }

    // The record goes on with its hardness, and has patches.
    let words = finished(&folder.0, "path --resume path.npz --max-area-fraction 0.3 --out more")?;
    assert!(words.contains("hardness   2.644 GPa, of the record"), "{words}");
    let more = column(&folder.join("more/path.csv"), "event")?;
    assert_eq!(more[..events.len()], events);
    finished(&folder.0, "patches path.npz --out patches")?;
    let told = column(&folder.join("patches/patches.csv"), "event")?;
    assert_eq!(told.len(), more.len());
    assert_eq!(told[1] == "yield", more[1] == "yield");
    Ok(())
}

/// A typical value only if it is asked for, and with it the value.
#[test]
fn a_typical_hardness_is_said() -> Done {
    let folder = Scratch::new("yield")?;
    let line = "path --nodes 32 --max-area-fraction 0.02";
    let words = finished(&folder.0, &format!("{line} --yield"))?;
    assert!(words.contains("hardness   2.5 GPa, typical of the material"), "{words}");
    let words = finished(&folder.0, &format!("{line} --material steel --against copper --yield"))?;
    assert!(words.contains("hardness   900 MPa, typical"), "{words}");
    let words = finished(&folder.0, line)?;
    assert!(!words.contains("hardness   "), "{words}");
    assert!(words.contains("`--hardness`"), "{words}");
    for (line, word) in [
        ("path --nodes 32 --e-star 1e11 --yield", "typical hardness"),
        ("path --nodes 32 --material rubber --yield", "typical hardness"),
        ("path --nodes 32 --unload", "--hardness"),
        ("path --nodes 32 --hardness 1e9 --mean-pressure 1e9", "all nodes yield"),
    ] {
        is_refused(&output(&folder.0, line)?, &[word]);
    }
    for line in ["path --hardness 70HRC", "path --hardness 0", "path --hardness 1e9 --yield"] {
        assert_eq!(output(&folder.0, line)?.status.code(), Some(2), "{line}");
    }
    Ok(())
}

/// Single loads: the same area as the path has there.
#[test]
fn single_loads_have_a_hardness_too() -> Done {
    let folder = Scratch::new("hard-load")?;
    finished(&folder.0, "path --nodes 48 --max-load 1000 --yield --record path.npz --fields npy")?;
    fs::copy(common::data("selfaffine_48.npy"), folder.join("rough.npy"))?;
    let surface = "--surface rough.npy --side 1e-2 --e-star 1 --hardness 0.032";
    finished(&folder.0, &format!("path {surface} --max-load 5e-8 --out path"))?;
    let words = finished(&folder.0, &format!("load {surface} --load 5e-8 --out load"))?;
    assert!(words.contains("nodes yielded"), "{words}");
    for name in ["contact_area_fraction", "yielded_area_fraction"] {
        let path = numbers(&folder.join("path/path.csv"), name)?;
        let load = numbers(&folder.join("load/load.csv"), name)?;
        assert_eq!(path.last(), load.first(), "{name}");
    }
    Ok(())
}

/// What yields under single loads is what yields on the path to each of them, though the greatest is solved for first;
/// the volume is that of the plastic depths, and each cubic metre of it costs the hardness in joules.
#[test]
fn plastic_columns_of_loads_are_those_of_the_path() -> Done {
    let folder = Scratch::new("hardness_columns")?;
    fs::copy(common::data("selfaffine_48.npy"), folder.join("rough.npy"))?;
    let hardness = 0.032;
    let surface = format!("--surface rough.npy --side 1e-2 --e-star 1 --hardness {hardness}");
    let path = format!("path {surface} --max-load 5e-8 --at 20nN,40nN --fields npy");
    let path = answer(&folder.0, &path)?;
    let words = finished(
        &folder.0,
        &format!("load {surface} --load 5e-8 --load 2e-8 --load 4e-8 --out load"),
    )?;
    let table = folder.join("load/load.csv");
    let expected = [&path, &path["at"][0], &path["at"][1]];
    for (row, expected) in expected.into_iter().enumerate() {
        // Gaps of single loads are right to 1e-8 of the approach, which is less than 1e-4 of the plastic depths.
        for name in [
            "load",
            "approach",
            "mean_gap",
            "yielded_area_fraction",
            "plastic_volume",
            "plastic_work",
            "energy",
        ] {
            let (found, expected) = (numbers(&table, name)?[row], number(expected, name));
            assert!((found / expected - 1.0).abs() < 1e-4, "{name}: {found} {expected}");
        }
        let greatest = numbers(&table, "max_pressure")?[row];
        assert!((greatest / hardness - 1.0).abs() < 1e-9, "{greatest}");
        let volume = numbers(&table, "plastic_volume")?[row];
        let share = numbers(&table, "yielded_area_fraction")?[row];
        let said = format!(
            "{} nodes yielded, plastic volume {}, energy lost {}",
            (2304.0 * share).round(),
            quantity(volume, "m³", 4),
            quantity(hardness * volume, "J", 4)
        );
        assert!(words.contains(&said), "{said}: {words}");
        let work = hardness * number(expected, "plastic_volume");
        assert!((number(expected, "plastic_work") / work - 1.0).abs() < 1e-12, "{expected}");
    }
    let depths = asperity::io::read_npy(folder.join("out/plastic_depth.npy"))?;
    let volume = depths.sum() * 1e-4 / 2304.0;
    assert!((number(&path, "plastic_volume") / volume - 1.0).abs() < 1e-9, "{volume} {path}");
    // Nothing of it where nothing yields.
    finished(&folder.0, "load --surface rough.npy --side 1e-2 --e-star 1 --load 2e-8 --out hard")?;
    for name in ["yielded_area_fraction", "plastic_volume", "plastic_work"] {
        assert_eq!(numbers(&folder.join("hard/load.csv"), name)?, [0.0], "{name}");
    }
    Ok(())
}

/// Surfaces of which all is in contact before the load is that of the path: unloading begins at the last state all the
/// same.
#[test]
fn unloading_begins_at_the_last_state() -> Done {
    let folder = Scratch::new("hardness_unloading_from_full_contact")?;
    for line in [
        "--mean-pressure 4e8 --hardness 5e8",
        "--periodic love --mean-pressure 4.999e8 --hardness 5e8",
        "--mean-pressure 4.9999e8 --hardness 5e8",
    ] {
        finished(&folder.0, &format!("path --nodes 16 {line} --unload"))?;
        let [path, back] = ["path.csv", "unloading.csv"].map(|name| folder.join("out").join(name));
        for name in ["load", "approach", "contact_area"] {
            let (path, back) = (numbers(&path, name)?, numbers(&back, name)?);
            let (path, back) = (path[path.len() - 1], back[0]);
            // Two solutions of a condition number of 10³.
            assert!((back / path - 1.0).abs() < 1e-10, "{line}, {name}: {back} {path}");
        }
        let load = numbers(&back, "load")?;
        assert!(load.windows(2).all(|pair| pair[0] >= pair[1]), "{line}");
    }
    Ok(())
}

/// A path of one node goes back without a load; the surface that is left is not replaced by the next one.
#[test]
fn the_surface_that_is_left_is_kept() -> Done {
    let folder = Scratch::new("hardness_left")?;
    let yields = "--hardness 1GPa --unload";
    finished(&folder.0, &format!("path --nodes 16 {yields} --max-area-fraction 0.004 --out one"))?;
    assert_eq!(numbers(&folder.join("one/unloading.csv"), "load")?, [0.0]);
    for updater in ["iterative", "cholesky"] {
        finished(&folder.0, &format!("path --nodes 16 {yields} --updater {updater}"))?;
    }
    let left = fs::read(folder.join("out/residual_surface.npy"))?;
    let again = format!("--surface out/residual_surface.npy --side 1e-2 --material steel {yields}");
    let done = output(&folder.0, &format!("path {again}"))?;
    is_refused(&done, &["out/residual_surface.npy would be replaced", "--out"]);
    assert!(fs::read(folder.join("out/residual_surface.npy"))? == left);
    finished(&folder.0, &format!("path {again} --out again"))?;
    Ok(())
}
