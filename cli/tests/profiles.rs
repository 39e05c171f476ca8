//! Profiles: line contacts, and their roughness.

mod common;

use std::error::Error;
use std::f64::consts::{PI, TAU};
use std::fs;
use std::path::Path;

use asperity::io::write_npy;
use asperity::nalgebra::DMatrix;
use common::{Scratch, answer, is_refused, output, run, said};

type Done = Result<(), Box<dyn Error>>;

/// Writes a profile of 1 mm as positions [mm] and heights [µm].
fn write(file: &Path, nodes: usize, height: impl Fn(f64) -> f64) -> std::io::Result<()> {
    let line = |k: usize| {
        let x = k as f64 * 1e-3 / nodes as f64;
        format!("{:e};{:e}\n", 1e3 * x, 1e6 * height(x))
    };
    let lines: String = (0..nodes).map(line).collect();
    fs::write(file, format!("# x [mm]; z [µm]\n{lines}"))
}

/// Hertz: half width `√(4 W R / π E*)` under a load W per width, greatest pressure `2 W / π a`. On 512 cells of a
/// millimetre edges are off by one cell, and the greatest pressure by a per cent.
#[test]
fn a_cylinder_is_a_line_contact() -> Done {
    let folder = Scratch::new("profile-hertz")?;
    let (nodes, radius, e_star) = (512, 5e-3, 1e9);
    write(&folder.join("roller.csv"), nodes, |x| -(x - 0.5e-3).powi(2) / (2.0 * radius))?;
    let of = "--surface roller.csv --e-star 1GPa --periodic y --at 20kPa,100kPa,400kPa";
    for (command, states) in [("path", "at"), ("load", "states")] {
        let found = answer(&folder.0, &format!("{command} {of}"))?;
        for (state, pressure) in
            found[states].as_array().ok_or("no states")?.iter().zip([20e3, 100e3, 400e3])
        {
            let number = |name: &str| state[name].as_f64().ok_or("no number");
            let load = pressure * 1e-3;
            let half = (4.0 * load * radius / (PI * e_star)).sqrt();
            let width = number("contact_area_fraction")? * 1e-3;
            assert!(
                (width - 2.0 * half).abs() < 1.5e-3 / nodes as f64,
                "{command}: {width} {half}"
            );
            let greatest = number("max_pressure")? / (2.0 * load / (PI * half));
            assert!((greatest - 1.0).abs() < 0.015, "{command}: {greatest}");
        }
    }
    let words = String::from_utf8(run(&folder.0, &format!("path {of}"))?.stdout)?;
    let rows: Vec<&str> = words.lines().skip_while(|line| !line.contains("per width")).collect();
    // 400 kPa on 1 mm.
    assert!(rows[4].split_whitespace().nth(1) == Some("400.0"), "{words}");
    let free = "path --surface roller.csv --e-star 1GPa --at 20kPa";
    is_refused(&output(&folder.0, free)?, &["has to repeat across: give --periodic y"]);
    Ok(())
}

/// Westergaard: under `p̄ = p* sin²(π a / λ)` the contact is 2a wide, `p* = π E* A / λ`.
#[test]
fn a_wave_is_westergaards() -> Done {
    let folder = Scratch::new("profile-westergaard")?;
    let (nodes, amplitude) = (256, 1e-6);
    write(&folder.join("wave.csv"), nodes, |x| amplitude * (TAU * x / 1e-3).cos())?;
    let full = PI * 1e9 * amplitude / 1e-3;
    for share in [0.1, 0.3, 0.7] {
        let at = share * full;
        let line = format!("path --surface wave.csv --e-star 1GPa --periodic love --at {at:e}");
        let width = answer(&folder.0, &line)?["at"][0]["contact_area_fraction"].as_f64();
        let expected = 2.0 / PI * share.sqrt().asin();
        let width = width.ok_or("no width")?;
        assert!((width - expected).abs() < 1.5 / f64::from(nodes as u32), "{width} {expected}");
    }
    Ok(())
}

/// A sine of 40 waves: Ra = 2 A / π, Rq = A / √2, RSm = λ; and what a map is not asked for.
#[test]
fn the_roughness_of_a_profile_is_told() -> Done {
    let folder = Scratch::new("profile-roughness")?;
    let amplitude = 0.5e-6;
    write(&folder.join("sine.csv"), 4000, |x| amplitude * (TAU * x / 25e-6).sin())?;
    for (cutoff, letter) in [("", "P"), ("--cutoff 0.25mm", "R")] {
        let line = format!("info sine.csv {cutoff}");
        let profile = &answer(&folder.0, &line)?["profile"];
        // The line that is taken off a sine of 40 waves has 3 / 20 π of its amplitude at the ends; means have its square.
        let of_ends = if letter == "P" { 0.05 } else { 1e-3 };
        for (name, expected, error) in [
            ("ra", 2.0 / PI * amplitude, 1e-3),
            ("rq", amplitude / 2_f64.sqrt(), 1e-3),
            ("rt", 2.0 * amplitude, of_ends),
            ("rsm", 25e-6, 1e-3),
        ] {
            let found = profile[name].as_f64().ok_or("no number")?;
            assert!((found / expected - 1.0).abs() < error, "{name}: {found} {expected}");
        }
        let words = String::from_utf8(run(&folder.0, &line)?.stdout)?;
        assert!(words.contains(&format!("{letter}a 31")) && words.contains("ISO 21920"), "{words}");
    }
    // The same along y is no map either.
    let column = DMatrix::from_fn(1, 4000, |_, iy| amplitude * (TAU * iy as f64 / 100.0).sin());
    write_npy(folder.join("column.npy"), &column)?;
    let of_x = answer(&folder.0, "info sine.csv --cutoff 0.25mm")?;
    let of_y = answer(&folder.0, "info column.npy --side 1mm --cutoff 0.25mm")?;
    assert!(of_y["texture"].is_null());
    for name in ["ra", "rz", "rsm", "evaluation_length"] {
        let [found, expected] = [&of_y, &of_x].map(|told| told["profile"][name].as_f64());
        let ratio = found.ok_or("no number")? / expected.ok_or("no number")?;
        // Positions and heights of the text are rounded by its units.
        assert!((ratio - 1.0).abs() < 1e-9, "{name}: {found:?} {expected:?}");
    }
    assert!(
        said(&output(&folder.0, "info sine.csv --cutoff 0.6mm")?)
            .contains("at most half the profile")
    );
    fs::copy(common::data("selfaffine_48.npy"), folder.join("map.npy"))?;
    is_refused(
        &output(&folder.0, "info map.npy --side 1cm --cutoff 1mm")?,
        &["--cutoff is for a profile"],
    );
    Ok(())
}
