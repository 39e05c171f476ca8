//! `asperity stress` on the records of small paths.
#![allow(clippy::float_cmp)]

mod common;

use std::error::Error;
use std::f64::consts::{PI, TAU};
use std::fs;
use std::path::Path;

use asperity::io::write_npy;
use asperity::record::LoadingRecord;
use asperity::stress::{Measure, Subsurface};
use common::{Scratch, answer, is_refused, numbers, output, run, said};
use nalgebra::DMatrix;
use serde_json::Value;

type Done = Result<(), Box<dyn Error>>;

/// The measures of the file, in its order.
const NAMES: [&str; 4] = ["von_mises", "tresca", "greatest_shear", "greatest_tension"];

/// A path of a coat of 0.2 mm on steel.
const COAT: &str =
    "path --nodes 16 --layer 400e9,0.25,2e-4 --base steel --record coat.npz --out path -q";

/// Steel against glass: what is printed is what the library finds, for both bodies; tractions on the second are
/// opposite.
#[test]
fn stresses_are_printed_and_drawn() -> Done {
    let folder = Scratch::new("stress")?;
    run(
        &folder.0,
        "path --nodes 32 --material steel --against glass --record path.npz --out path -q",
    )?;
    let record = LoadingRecord::read_npz(folder.join("path.npz"))?;
    let load = 0.5 * record.states().last().ok_or("no state")?.contact.load;
    let line = format!(
        "stress path.npz --load {load:e} --friction 0.2 --angle 30 --yield-stress 1e9 --against-yield-stress 1e15 --volume 1 --out seen"
    );
    let words = String::from_utf8(run(&folder.0, &line)?.stdout)?;
    for said in [
        "body          ν = 0.3",
        "other body    ν = 0.22",
        "yields first at W = ",
        "does not yield on this path",
    ] {
        assert!(words.contains(said), "{said}: {words}");
    }
    for picture in ["stress", "von_mises_map", "shear_map", "section_x", "section_y"] {
        let bytes = fs::read(folder.join("seen").join(picture).with_extension("png"))?;
        assert!(bytes.starts_with(b"\x89PNG"), "{picture}");
    }
    assert!(fs::read(folder.join("seen/stress.vti"))?.starts_with(b"<?xml"));

    let document = answer(&folder.0, &line.replace("--volume 1 --out seen", ""))?;
    let mut path = record.replay()?;
    let state = record.history().at_load(load).ok_or("no state")?;
    let pressure = path.fields_at(&state)?.pressure;
    let table = fs::read_to_string(folder.join("seen/stress.csv"))?;
    for (place, (ratio, coefficient)) in [(0.3, 0.2), (0.22, -0.2)].into_iter().enumerate() {
        let below = Subsurface::of_record(&record, ratio)?;
        let survey = below.sliding(coefficient, 30_f64.to_radians())?.survey(&pressure, None)?;
        let body = &document["bodies"][place];
        for measure in Measure::ALL {
            let expected = survey.greatest(measure);
            let found = &body[measure.name()];
            assert_eq!(found["value"].as_f64(), Some(expected.value));
            assert_eq!(found["depth"].as_f64(), Some(expected.depth));
            assert_eq!(found["node"][0].as_u64(), Some(expected.node.0 as u64));
        }
        let lines = table.lines().filter(|line| line.starts_with(&format!("{},", place + 1)));
        let greatest: Vec<f64> = lines
            .map(|line| line.split(',').nth(3).unwrap_or_default().parse())
            .collect::<Result<_, _>>()?;
        assert_eq!(greatest.len(), survey.depths.len());
        let most = greatest.into_iter().fold(0.0, f64::max);
        assert_eq!(most, survey.greatest(Measure::VonMises).value);
        assert_eq!(body["materials"].as_array().map(Vec::len), Some(1));
        assert_eq!(body["materials"][0]["first_yield"].is_null(), place == 1);
    }
    let first = &document["bodies"][0]["materials"][0]["first_yield"];
    let found = first["von_mises"]["value"].as_f64().ok_or("no stress")?;
    assert!((found / 1e9 - 1.0).abs() < 1e-4 && first["load"].as_f64() < Some(load), "{first}");
    Ok(())
}

/// Depths that are given are all there are, and one of them has no line.
#[test]
fn depths_may_be_given() -> Done {
    let folder = Scratch::new("stress-depths")?;
    run(&folder.0, "path --nodes 16 --e-star 1e11 --record path.npz --out path -q")?;
    let document = answer(&folder.0, "stress path.npz --poisson 0.3 --depth 1e-5 --out seen")?;
    assert_eq!(document["bodies"][0]["depths"], serde_json::json!([1e-5]));
    assert_eq!(document["bodies"][0]["von_mises"]["depth"].as_f64(), Some(1e-5));
    assert!(folder.join("seen/stress.png").exists());
    Ok(())
}

/// Sections and the volume of a layer on a rigid base end at the base: in steps of its thickness, 29 µm, the last depth
/// would be beyond it by rounding.
#[test]
fn layers_end_at_a_rigid_base() -> Done {
    let folder = Scratch::new("stress-rigid-base")?;
    let line =
        "path --nodes 16 --side 160um --layer 3e6,0.4,29um --base rigid --max-area-fraction 0.3";
    run(&folder.0, &format!("{line} --record path.npz --out path -q"))?;
    run(&folder.0, "stress path.npz --volume 40 --out seen")?;
    assert!(folder.join("seen/stress.vti").exists() && folder.join("seen/section_x.png").exists());
    Ok(())
}

/// The measures of a tensor (xx, yy, zz, yz, xz, xy) in the order of the file; principal stresses by the angle of Lode.
fn measures([xx, yy, zz, yz, xz, xy]: [f64; 6]) -> [f64; 4] {
    let mean = (xx + yy + zz) / 3.0;
    let (a, b, c) = (xx - mean, yy - mean, zz - mean);
    let second = 0.5 * (a * a + b * b + c * c) + yz * yz + xz * xz + xy * xy;
    let third = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz);
    let radius = 2.0 * (second / 3.0).sqrt();
    let angle = (4.0 * third / radius.powi(3)).clamp(-1.0, 1.0).acos() / 3.0;
    let greatest = mean + radius * angle.cos();
    let least = mean + radius * (angle + TAU / 3.0).cos();
    [(3.0 * second).sqrt(), greatest - least, 0.5 * (greatest - least), greatest]
}

/// At each depth every measure is the greatest of those of the tensors there, and that of the node beside it.
fn columns_are_of(
    below: &Subsurface,
    pressure: &DMatrix<f64>,
    depths: [f64; 3],
    file: &Path,
) -> Done {
    assert_eq!(numbers(file, "body")?, [1.0; 3]);
    assert_eq!(numbers(file, "depth")?, depths);
    for (row, depth) in depths.into_iter().enumerate() {
        let field = below.at_depth(pressure, depth)?;
        let at = |ix: usize, iy: usize| measures(field.components().map(|part| part[(ix, iy)]));
        let all: Vec<[f64; 4]> = (0..256).map(|k| at(k % 16, k / 16)).collect();
        let greatest = |k: usize| all.iter().map(|own| own[k]).fold(f64::NEG_INFINITY, f64::max);
        let cell = |column: &str| numbers(file, column).map(|cells| cells[row]);
        for (k, name) in NAMES.into_iter().enumerate() {
            let value = cell(name)?;
            let (ix, iy) = (cell(&format!("{name}_ix"))?, cell(&format!("{name}_iy"))?);
            // Where two principal stresses are equal the angle has half of the digits.
            let near = |other: f64| (value - other).abs() < 1e-7 * greatest(0);
            let there = at(ix as usize, iy as usize)[k];
            assert!(near(greatest(k)), "{name} at {depth}: {value} {}", greatest(k));
            assert!(near(there), "{name} at {depth}: {value} {there}");
        }
        // A product with 1/2 is exact.
        assert_eq!(cell("greatest_shear")?, 0.5 * cell("tresca")?);
    }
    Ok(())
}

#[test]
fn columns_are_the_greatest_of_the_tensors() -> Done {
    let folder = Scratch::new("stress-columns")?;
    run(&folder.0, "path --nodes 16 --e-star 1e11 --record path.npz --out path -q")?;
    let record = LoadingRecord::read_npz(folder.join("path.npz"))?;
    let load = 0.5 * record.states().last().ok_or("no state")?.contact.load;
    // Not in the order of their depths.
    let line = format!(
        "stress path.npz --poisson 0.3 --load {load:e} --friction 0.2 --angle 30 --depth 2e-3 --depth 0 --depth 3e-4"
    );
    let seen = output(&folder.0, &format!("{line} --out seen"))?;
    // These depths say nothing of the grid.
    assert!(seen.status.success() && !said(&seen).contains("two cells"), "{}", said(&seen));
    let file = folder.join("seen/stress.csv");
    for found in numbers(&file, "load")? {
        assert!((found / load - 1.0).abs() < 1e-14, "{found} {load}");
    }
    let state = record.history().at_load(load).ok_or("no state")?;
    let mut path = record.replay()?;
    let pressure = path.fields_at(&state)?.pressure;
    let below = Subsurface::of_record(&record, 0.3)?.sliding(0.2, 30_f64.to_radians())?;
    columns_are_of(&below, &pressure, [0.0, 3e-4, 2e-3], &file)
}

/// Two depths in the coat and one in the steel below it.
#[test]
fn columns_of_a_coat_are_the_greatest_of_the_tensors() -> Done {
    let folder = Scratch::new("stress-coat-columns")?;
    run(&folder.0, COAT)?;
    run(&folder.0, "stress coat.npz --depth 0 --depth 1e-4 --depth 1e-3 --out seen")?;
    let record = LoadingRecord::read_npz(folder.join("coat.npz"))?;
    let state = *record.states().last().ok_or("no state")?;
    let pressure = record.replay()?.fields_at(&state)?.pressure;
    let below = Subsurface::of_record(&record, 0.0)?;
    columns_are_of(&below, &pressure, [0.0, 1e-4, 1e-3], &folder.join("seen/stress.csv"))
}

/// A coat of steel on steel is steel.
#[test]
fn a_coat_of_the_same_material_is_none() -> Done {
    let folder = Scratch::new("stress-coat-none")?;
    for (name, body) in
        [("coated", "--layer 210e9,0.3,2e-4 --base 210e9,0.3"), ("plain", "--material 210e9,0.3")]
    {
        let line = format!("path --nodes 16 --seed 3 {body} --record {name}.npz --out path -q");
        run(&folder.0, &line)?;
        let line = format!("stress {name}.npz --depth 1e-4 --depth 3e-4 --depth 1e-3 --out {name}");
        run(&folder.0, &line)?;
    }
    let [coated, plain] = ["coated", "plain"].map(|name| folder.join(name).join("stress.csv"));
    for column in ["load"].iter().chain(&NAMES) {
        let found = numbers(&coated, column)?;
        for (found, expected) in found.into_iter().zip(numbers(&plain, column)?) {
            // Sums over waves and over cells, to rounding.
            assert!((found / expected - 1.0).abs() < 1e-10, "{column}: {found} {expected}");
        }
    }
    Ok(())
}

/// One cell that carries all the load: below its middle two principal stresses are equal, and all are those of Love's
/// square of half side a under a uniform pressure p, of which 2(1 + ν) p times the solid angle over 2π is the sum.
#[test]
fn stresses_below_one_cell_are_loves() -> Done {
    let folder = Scratch::new("stress-cell")?;
    let mut heights = DMatrix::<f64>::zeros(16, 16);
    heights[(7, 4)] = 1e-5;
    write_npy(folder.join("peak.npy"), &heights)?;
    // Of 1 mm a cell; the plane around the peak touches at 1 kN or so.
    let path = "path --surface peak.npy --side 16mm --e-star 1e11 --max-load 2 --record path.npz";
    run(&folder.0, &format!("{path} --out path -q"))?;
    let line = "stress path.npz --poisson 0.3 --depth 0.5mm --depth 1mm --depth 2mm --out seen";
    run(&folder.0, line)?;
    let file = folder.join("seen/stress.csv");
    let (p, a) = (2e6, 0.5e-3_f64);
    for (row, z) in [0.5e-3_f64, 1e-3, 2e-3].into_iter().enumerate() {
        let far = (2.0 * a * a + z * z).sqrt();
        let corner = (a * a / (z * far)).atan();
        let down = 2.0 * p / PI * (corner + 2.0 * a * a * z / (far * (a * a + z * z)));
        let sum = 1.3 * p * 4.0 * corner / PI;
        let across = 0.5 * (sum - down);
        for (name, expected) in [
            ("von_mises", down - across),
            ("tresca", down - across),
            ("greatest_shear", 0.5 * (down - across)),
        ] {
            let found = numbers(&file, name)?[row];
            // Sums of eight logarithms and arcs each, and a transform, to rounding.
            assert!((found / expected - 1.0).abs() < 1e-10, "{name}: {found} {expected}");
            for (side, node) in [("ix", 7.0), ("iy", 4.0)] {
                assert_eq!(numbers(&file, &format!("{name}_{side}"))?[row], node, "{name}");
            }
        }
        // Tension is no less than that across the axis.
        assert!(numbers(&file, "greatest_tension")?[row] >= -across - 1e-10 * p);
    }
    Ok(())
}

/// A coat has its own ratio, and its interface two sides.
#[test]
fn coats_have_stresses() -> Done {
    let folder = Scratch::new("stress-coat")?;
    run(&folder.0, COAT)?;
    let document = answer(&folder.0, "stress coat.npz --out seen")?;
    let body = &document["bodies"][0];
    assert_eq!(body["poissons_ratio"].as_f64(), Some(0.25));
    let depths = body["depths"].as_array().ok_or("no depths")?;
    for depth in [2e-4, 2e-4_f64.next_up()] {
        assert!(depths.iter().any(|other| other.as_f64() == Some(depth)), "{depths:?}");
    }
    assert!(folder.join("seen/section_x.png").exists());
    // The greatest stress of each material, which is that of the body in one of the two.
    let materials = body["materials"].as_array().ok_or("no materials")?;
    let [coat_depth, base_depth] = [0, 1].map(|k| materials[k]["tresca"]["depth"].as_f64());
    assert!(coat_depth <= Some(2e-4) && base_depth > Some(2e-4), "{materials:?}");
    let stress = |of: &Value| of["von_mises"]["value"].as_f64();
    let most = materials.iter().filter_map(stress).fold(0.0, f64::max);
    assert_eq!((materials.len(), stress(body)), (2, Some(most)));
    assert!(materials[0]["yield_stress"].is_null());
    let document = answer(&folder.0, "stress coat.npz --depth 1e-4")?;
    let materials = &document["bodies"][0]["materials"];
    assert!(materials[0]["von_mises"]["value"].is_f64() && materials[1]["von_mises"].is_null());

    // Of each material the load that the library finds; one yield stress is that of both.
    let record = LoadingRecord::read_npz(folder.join("coat.npz"))?;
    let below = Subsurface::of_record(&record, 0.0)?;
    let mut path = record.replay()?;
    for (words, strengths) in [("2GPa,5e8", [2e9, 5e8]), ("1e9", [1e9; 2])] {
        let document = answer(&folder.0, &format!("stress coat.npz --yield-stress {words}"))?;
        let materials = document["bodies"][0]["materials"].as_array().ok_or("no materials")?;
        let found = below.first_yields(&mut path, record.history(), &strengths)?;
        assert_eq!(materials.len(), 2);
        for ((told, first), strength) in materials.iter().zip(found).zip(strengths) {
            assert_eq!(told["yield_stress"].as_f64(), Some(strength));
            let load = first.map(|first| first.state.contact.load);
            assert!(load.is_some(), "{told}");
            assert_eq!(told["first_yield"]["load"].as_f64(), load);
        }
    }
    let words = run(&folder.0, "stress coat.npz --yield-stress 2e9,1e15")?.stdout;
    let words = String::from_utf8(words)?;
    for said in [
        "layer 1 yields first at W = ",
        "base does not yield on this path",
        "    in layer 1      ",
        "    in base         ",
    ] {
        assert!(words.contains(said), "{said}: {words}");
    }
    Ok(())
}

/// Of the material Poisson's ratio alone is used, which is said if the path is of other bodies.
#[test]
fn other_bodies_are_warned_of() -> Done {
    let folder = Scratch::new("stress-other")?;
    run(&folder.0, "path --nodes 16 --material steel --record path.npz --out path -q")?;
    let warnings = |bodies: &str| -> Result<Vec<Value>, Box<dyn Error>> {
        let found = answer(&folder.0, &format!("stress path.npz {bodies}"))?;
        Ok(found["warnings"].as_array().ok_or("no warnings")?.clone())
    };
    let is_of_others = |warning: &Value| {
        let words = warning.as_str().unwrap_or_default();
        words.contains("E* 230.8 GPa") && words.contains("only Poisson's ratio is used")
    };
    for (bodies, expected) in [
        ("", false),
        ("--poisson 0.4", false),
        ("--material steel", false),
        ("--material rubber", true),
        ("--material steel --against glass", true),
    ] {
        assert_eq!(warnings(bodies)?.iter().any(is_of_others), expected, "{bodies}");
    }
    Ok(())
}

#[test]
fn what_has_no_answer_is_refused() -> Done {
    let folder = Scratch::new("stress-refused")?;
    run(&folder.0, "path --nodes 16 --e-star 1e11 --record path.npz --out path -q")?;
    let coat =
        "path --nodes 16 --layer 400e9,0.25,1e-5 --base steel --record coat.npz --out path -q";
    run(&folder.0, coat)?;
    for (line, words) in [
        ("stress coat.npz --against-yield-stress 1e9", &["second body", "layers"][..]),
        ("stress path.npz", &["--poisson", "--material"]),
        ("stress path.npz --poisson 0.3 --load 1e9", &["the path has no state at"]),
        ("stress path.npz --poisson 0.3 --against-yield-stress 1e9", &["--against-yield-stress"]),
        ("stress coat.npz --friction 0.1", &["layers"]),
        ("stress coat.npz --poisson 0.3", &["--poisson"]),
        (
            "stress coat.npz --yield-stress 1e9,2e9,3e9",
            &["--yield-stress", "has 2, and 3 are given"],
        ),
    ] {
        is_refused(&output(&folder.0, line)?, words);
    }
    for line in [
        "--poisson 0.6",
        "--poisson 0.3 --depth -1",
        "--poisson 0.3 --friction -1",
        "--poisson 0.3 --volume 0",
        "--poisson 0.3 --volume 100000000",
    ] {
        let refused = output(&folder.0, &format!("stress path.npz {line}"))?;
        assert_eq!(refused.status.code(), Some(2), "{line}");
    }
    Ok(())
}
