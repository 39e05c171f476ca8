//! What looks wrong is said by every command that sees it, with what to do.

mod common;

use std::error::Error;
use std::path::Path;

use asperity::io::write_npy;
use common::{Scratch, answer, run, said};
use nalgebra::DMatrix;
use serde_json::Value;

type Done = Result<(), Box<dyn Error>>;

/// All that a command prints.
fn words(folder: &Path, line: &str) -> Result<String, Box<dyn Error>> {
    let done = run(folder, line)?;
    Ok(said(&done) + &String::from_utf8(done.stdout)?)
}

/// Whether one of the warnings of an object has these words.
fn warns(object: &Value, words: &str) -> bool {
    let warnings = object["warnings"].as_array().map_or(&[][..], Vec::as_slice);
    warnings.iter().any(|warning| warning.as_str().is_some_and(|text| text.contains(words)))
}

/// A sphere of 10 mm over the middle of 1 mm × 1 mm, on 32 × 32 nodes.
fn with_ball(name: &str) -> Result<Scratch, Box<dyn Error>> {
    let folder = Scratch::new(name)?;
    let x = |k: usize| (k as f64 - 15.5) / 32.0 * 1e-3;
    let ball = DMatrix::from_fn(32, 32, |ix, iy| -(x(ix).powi(2) + x(iy).powi(2)) / 0.02);
    write_npy(folder.join("ball.npy"), &ball)?;
    Ok(folder)
}

const BALL: &str = "--surface ball.npy --side 1e-3";

/// Under 5 N the contact of Hertz has a radius of 1.8 cells, under 2 kN of 13. What a path and single loads say of a
/// state that is asked for is the same, and nobody else hears of it.
#[test]
fn what_is_wrong_with_a_state_in_between_is_said_where_it_is_asked_for() -> Done {
    let folder = with_ball("between")?;
    let folder = &folder.0;
    let few = "at 5 N: the contact is not resolved";
    for (command, says) in
        [("path --at 5N,2kN", true), ("path --max-load 2kN", false), ("load --at 5N,2kN", true)]
    {
        let line = format!("{command} {BALL} --material 210e9,0.3");
        assert_eq!(words(folder, &line)?.contains(few), says, "{command}");
        assert_eq!(words(folder, &format!("{line} --quiet"))?.contains(few), says, "{command}");
        let last = words(folder, &line)?;
        assert!(!last.contains("at 2 kN: the contact is not"), "{last}");
        assert_eq!(last.contains("at 2 kN: the greatest pressure is"), says, "{last}");
        assert!(last.contains("the greatest pressure is"), "{last}");
    }
    let line = format!("path --at 5N,2kN {BALL} --material 210e9,0.3");
    assert!(warns(&answer(folder, &line)?, few));
    Ok(())
}

/// At 8 kN the contact of Hertz has a radius of 0.64 mm, where the surface ends at 0.5 mm; at 2 kN of 0.40 mm.
#[test]
fn peaks_of_the_border_are_said_everywhere() -> Done {
    let folder = with_ball("border")?;
    let folder = &folder.0;
    let border = "is at the border of the grid";
    for (load, is_cut) in [(2000, false), (8000, true)] {
        let path = format!("path {BALL} --material 210e9,0.3 --max-load {load} --record r.npz");
        assert_eq!(warns(&answer(folder, &path)?, border), is_cut, "{load}");
        assert_eq!(words(folder, &path)?.contains(border), is_cut, "{load}");
        // People who want to read nothing but warnings read them.
        assert_eq!(words(folder, &format!("{path} --quiet"))?.contains(border), is_cut, "{load}");
        assert_eq!(words(folder, "patches r.npz")?.contains(border), is_cut, "{load}");
        assert_eq!(warns(&answer(folder, "patches r.npz")?, border), is_cut, "{load}");
        let single = format!("load {BALL} --material 210e9,0.3 --load {load}");
        assert_eq!(words(folder, &single)?.contains(border), is_cut, "{load}");
    }
    // A periodic half-space has no border.
    let periodic = format!("path {BALL} --material 210e9,0.3 --max-load 8000 --periodic love");
    assert!(!words(folder, &periodic)?.contains(border));
    Ok(())
}

/// The area of 12 nodes may be 25 % too large.
#[test]
fn few_nodes_of_one_patch_are_said_everywhere() -> Done {
    let folder = with_ball("few")?;
    let folder = &folder.0;
    let few = "the contact is not resolved";
    for (nodes, is_few) in [(12_u32, true), (200, false)] {
        let share = f64::from(nodes) / 1024.0;
        let path =
            format!("path {BALL} --material steel --max-area-fraction {share} --record r.npz");
        assert_eq!(words(folder, &path)?.contains(few), is_few, "{nodes}");
        let ended = answer(folder, &path)?;
        assert_eq!(warns(&ended, few), is_few, "{nodes}");
        assert_eq!(words(folder, "patches r.npz")?.contains(few), is_few, "{nodes}");
        let load = &ended["load"];
        let single = format!("load {BALL} --material steel --load {load}");
        assert_eq!(words(folder, &single)?.contains(few), is_few, "{nodes}");
    }
    Ok(())
}

#[test]
fn only_metals_are_said_to_yield_like_metals() -> Done {
    let folder = with_ball("metals")?;
    let folder = &folder.0;
    for (material, load, expected) in [
        // By the typical hardness of a name, by that of metals or polymers for numbers, and rubber not at all.
        ("steel", 2000, Some("times the typical hardness of the material, 2.5 GPa")),
        ("210e9,0.3", 2000, Some("metals yield at some 0.01 to 0.03 of E*")),
        ("3e9,0.37", 200, Some("polymers yield at some 0.05 of E*")),
        ("rubber", 1, None),
        ("2e6,0.5", 1, None),
    ] {
        let line = format!("path {BALL} --material {material} --max-load {load}");
        let told = words(folder, &line)?;
        assert_eq!(told.contains("the greatest pressure is"), expected.is_some(), "{told}");
        assert!(expected.is_none_or(|text| told.contains(text)), "{told}");
        assert!(!told.contains("metals") || material == "210e9,0.3", "{told}");
    }
    // A coat has the name of its material too, and what it is pressed against.
    for (body, expected) in [
        ("--layer glass,1e-4 --base steel", "times the typical hardness of the material, 5.5 GPa"),
        ("--layer glass,1e-4 --base steel --against copper", "material, 900 MPa"),
        (
            "--layer 70e9,0.22,1e-4 --base steel",
            "metals yield at some 0.01 to 0.03 of E*, glass and",
        ),
    ] {
        for (command, load) in [("path", "--max-load 8000"), ("load", "--load 8000")] {
            let told = words(folder, &format!("{command} {BALL} {body} {load}"))?;
            assert!(told.contains(expected), "{command} {body}: {told}");
        }
    }
    Ok(())
}

#[test]
fn coats_thinner_than_a_cell_are_said_everywhere() -> Done {
    let folder = with_ball("thin")?;
    let folder = &folder.0;
    let wide = "wider than the coat is thick";
    // Cells of 31.25 µm.
    for (thickness, is_thin) in [("20e-6", true), ("50e-6", false)] {
        let body = format!("{BALL} --layer 3e6,0.4,{thickness} --base rigid");
        let path = format!("path {body} --max-area-fraction 0.1 --record {thickness}.npz");
        assert_eq!(words(folder, &path)?.contains(wide), is_thin, "{thickness}");
        let patches = format!("patches {thickness}.npz");
        assert_eq!(words(folder, &patches)?.contains(wide), is_thin, "{thickness}");
        let load = words(folder, &format!("load {body} --load 1e-3"))?;
        assert_eq!(load.contains(wide), is_thin, "{thickness}");
    }
    Ok(())
}

/// On a flat surface all nodes touch at once, before there is a load.
#[test]
fn contact_without_a_load_is_said() -> Done {
    let folder = Scratch::new("flat")?;
    write_npy(folder.join("flat.npy"), &DMatrix::zeros(16, 16))?;
    let line = "path --surface flat.npy --side 1e-3 --material steel --max-area-fraction 0.1";
    let told = words(&folder.0, line)?;
    assert!(told.contains("25 nodes touch at the same height"), "{told}");
    assert!(told.contains("`--max-load`"), "{told}");
    assert!(warns(&answer(&folder.0, line)?, "touch at the same height"));
    // The path of a flat surface ends there whatever is asked for, and a single load does not.
    let all = "path --surface flat.npy --side 1e-3 --material steel --max-load 10";
    let told = words(&folder.0, all)?;
    assert!(told.contains("`asperity load`") && !told.contains("check the units"), "{told}");
    let one = words(&folder.0, "load --surface flat.npy --side 1e-3 --material steel --load 10")?;
    assert!(one.contains("greatest") && !one.contains("touch at the same height"), "{one}");
    Ok(())
}

/// The fluid would open a contact that is pressed together less than fifty times as much as it.
#[test]
fn fluids_that_open_the_gap_are_said() -> Done {
    let folder = Scratch::new("drop")?;
    let folder = &folder.0;
    run(folder, "path --nodes 32 --periodic love --max-area-fraction 0.2 --record r.npz")?;
    let leak = "leak r.npz --viscosity 1e-3 --along x --pressure-drop";
    let open = "the fluid would open the gap";
    let states = format!("{leak} 1e3");
    assert!(!words(folder, &states)?.contains(open));
    assert_eq!(answer(folder, &states)?["warnings"], serde_json::json!([]));
    let states = format!("{leak} 1e9");
    assert!(words(folder, &states)?.contains(open));
    assert!(warns(&answer(folder, &states)?, "`--pressure-drop`"));
    // 2.5 N on 1 cm² are 25 kPa.
    for (drop, is_large) in [("1e7", true), ("1e3", true), ("400", false)] {
        let one = format!("{leak} {drop} --load 2.5 --states 0");
        assert_eq!(words(folder, &one)?.contains(open), is_large, "{drop}");
    }
    Ok(())
}

/// Most of a surface that is filled was never measured.
#[test]
fn surfaces_that_are_mostly_filled_are_said() -> Done {
    let folder = Scratch::new("filled")?;
    let folder = &folder.0;
    for (name, height) in [("nan.npy", f64::NAN), ("inf.npy", f64::NEG_INFINITY)] {
        let punch = DMatrix::from_fn(10, 10, |ix, iy| {
            if (3..7).contains(&ix) && (3..7).contains(&iy) { 0.0 } else { height }
        });
        write_npy(folder.join(name), &punch)?;
        let made_up = "84 of 100 heights were missing";
        let seen = words(folder, &format!("info {name} --side 1e-3"))?;
        assert!(seen.contains(made_up), "{seen}");
        let line = format!("load --surface {name} --side 1e-3 --material steel --load 1 --fill");
        let told = words(folder, &line)?;
        assert!(told.contains(made_up), "{told}");
        let infinite = "84 heights are infinite, the first -inf at node (0, 0)";
        assert_eq!(told.contains(infinite), name == "inf.npy", "{told}");
    }
    Ok(())
}
