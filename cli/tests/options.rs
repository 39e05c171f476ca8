//! Options do what they say: targets, units, what is read of a file, surfaces that are generated or made of two.
#![allow(clippy::float_cmp)]

mod common;

use std::error::Error;
use std::fs;

use asperity::io::{ReadOptions, read_npy, write_npy};
use asperity::surface::Topography;
use common::{
    Scratch, answer, data, is_refused, number, numbers, output, printed, run, said, with_surface,
};
use nalgebra::DMatrix;

type Done = Result<(), Box<dyn Error>>;

/// A decimal comma makes two numbers of one, the first of which has no unit.
#[test]
fn decimal_commas_in_lists_are_refused() -> Done {
    let folder = with_surface("commas")?;
    for line in [
        "load --surface rough.npy --side 1cm --e-star 1 --at 1,5MPa",
        "load --surface rough.npy --side 1cm --e-star 1 --at 5MPa,1,5N",
        "path --surface rough.npy --side 1cm --material steel --at 5,10,50MPa",
        "path --surface rough.npy --side 1cm --material steel --at=1,5MPa --max-load 10N",
    ] {
        let done = output(&folder.0, line)?;
        assert_eq!(done.status.code(), Some(2), "{line}");
        assert!(said(&done).contains("decimal point"), "{line}: {}", said(&done));
    }
    run(&folder.0, "load --surface rough.npy --side 1cm --e-star 1 --at 1e-3,2e-3")?;
    run(&folder.0, "load --surface rough.npy --side 1cm --e-star 1 --at 1mPa,20%,2e-3")?;
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
        let pressure = read_npy(folder.join(&format!("out/pressure_{name}.npy")))?;
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
    // However long the waves are, which may be all of the surface.
    for stretch in ["0.25", "100", "4"] {
        let given = format!("--rms-gradient 0.1 {base} --anisotropy {stretch}");
        let found = heights(&given)?.rms_gradient_spectral();
        assert!((found / 0.1 - 1.0).abs() < 1e-12, "{stretch}: {found}");
        let settings = fs::read_to_string(folder.join("out/settings.json"))?;
        assert!(settings.contains("\"rms_gradient\": 0.1,"), "{settings}");
    }
    let stretched = heights(&format!("--rms-gradient 0.1 {base} --anisotropy 4"))?;
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
    let rough = read_npy(folder.join("rough.npy"))?;
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
    let rough = read_npy(folder.join("rough.npy"))?;
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
