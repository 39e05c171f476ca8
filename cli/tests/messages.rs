//! Errors say what is wrong in the words of the command line.

mod common;

use std::error::Error;
use std::fs;

use asperity::io::write_npy;
use common::{Scratch, answer, is_refused, output, said, with_surface};
use nalgebra::DMatrix;
use serde_json::Value;

/// What a command that is refused says: the words that are expected, none of those that are not, no name of Rust, and
/// each file once.
#[test]
fn errors_name_options() -> Result<(), Box<dyn Error>> {
    let folder = Scratch::new("messages")?;
    let tilted = DMatrix::from_fn(8, 8, |ix, iy| 1e-7 * (ix as f64 * 0.7 + iy as f64).sin());
    write_npy(folder.join("map.npy"), &tilted)?;
    let holed = tilted.map_with_location(|ix, iy, z| if ix == iy { f64::NAN } else { z });
    write_npy(folder.join("holed.npy"), &holed)?;
    write_npy(
        folder.join("inf.npy"),
        &holed.map(|z| if z.is_nan() { f64::NEG_INFINITY } else { z }),
    )?;
    fs::write(folder.join("map.txt"), "1 2\n3 4\n")?;
    fs::write(folder.join("nan.txt"), "nan nan\nnan nan\n")?;
    fs::write(folder.join("points.xyz"), "0 0 1\n1 0 2\n0 1 3\n1 1 4\n")?;
    for (line, expected, not) in [
        ("path --surface map.npy --material steel", vec!["`--side`"], vec![]),
        (
            "path --surface holed.npy --side 1e-3 --material steel",
            vec!["8 heights are missing", "`--fill`"],
            vec!["NaN"],
        ),
        (
            "path --surface inf.npy --side 1e-3 --material steel",
            vec!["8 heights are infinite, the first -inf at node (0, 0)", "`--fill`"],
            vec!["NaN"],
        ),
        ("info map.txt --layout matrix", vec!["`--height-unit`"], vec![]),
        (
            "info map.txt --height-unit um",
            vec!["can be read in 4 ways", "'y-column', 2 rows of 1 height beside", "`--layout`"],
            vec!["ReadOptions"],
        ),
        ("info points.xyz --height-unit um", vec!["`--lateral-unit` or `--side`"], vec![]),
        (
            "path --surface nan.txt --side 1e-3 --height-unit um --material steel",
            vec!["none of the 2 x 2 heights is finite"],
            vec!["--fill", "fill"],
        ),
        (
            "info nan.txt --side 1e-3 --height-unit um",
            vec!["cannot use nan.txt", "none of the 2 x 2 heights is finite"],
            vec!["fill"],
        ),
        ("info nothing.npy", vec!["cannot read nothing.npy"], vec![]),
        (
            "load --surface map.npy --side 1e-3 --material steel --hardness 1e6 --mean-pressure 2e6",
            vec!["a mean pressure of 2 MPa (2 N)", "their hardness, 1 MPa on average"],
            vec![],
        ),
        (
            "path --surface map.npy --side 1e-3 --material steel --hardness 1e6 --mean-pressure 2e6",
            vec!["a mean pressure of 2 MPa (2 N)", "their hardness, 1 MPa on average"],
            vec![],
        ),
    ] {
        let done = output(&folder.0, line)?;
        is_refused(&done, &expected);
        let told = said(&done);
        assert!(!told.contains("::"), "{told}");
        for word in not {
            assert!(!told.contains(word), "{told}");
        }
        let error = told.split("error: ").nth(1).unwrap_or_default();
        for file in ["map.txt", "points.xyz", "nothing.npy", "nan.txt", "map.npy"] {
            assert!(error.matches(file).count() <= 1, "{told}");
        }
    }
    Ok(())
}

/// What a path leaves out is said of paths and single loads; other commands know their own options.
#[test]
fn what_the_model_leaves_out_is_said_of_paths() -> Result<(), Box<dyn Error>> {
    let folder = Scratch::new("left_out")?;
    for (line, expected, is_left_out) in [
        ("path --nodes 16 --frictions 0.3", "frictionless", true),
        ("load --viscoelastic 0.3", "time plays no part", true),
        ("path --strain-rate 0.3", "time plays no part", true),
        ("path --viscosity 3", "`asperity leak`", true),
        ("--temperature 300", "temperature plays no part", true),
        ("slip r.npz --frictions 0.3", "'--friction'", false),
        ("leak r.npz --viscositys 1e-3", "'--viscosity'", false),
        ("path --generated", "unexpected argument '--generated'", false),
    ] {
        let done = output(&folder.0, line)?;
        let told = said(&done);
        assert_eq!(done.status.code(), Some(2), "{line}: {told}");
        assert!(told.contains(expected), "{line}: {told}");
        assert_eq!(told.contains("The model is linear elastic"), is_left_out, "{line}: {told}");
    }
    Ok(())
}

/// What is allowed is said of the option itself, before the work.
#[test]
fn values_out_of_bounds_are_refused_at_once() -> Result<(), Box<dyn Error>> {
    let folder = Scratch::new("bounds")?;
    for (line, expected, not) in [
        ("path --hurst 2", "a Hurst exponent must be above 0 and at most 1", "fraction"),
        (
            "path --fe-table csv --fe-error 1",
            "--fe-error <E>': must be above 0 and below 1",
            "because",
        ),
        (
            "path --fe-table csv --fe-error 100%",
            "--fe-error <E>': must be above 0 and below 1",
            "because",
        ),
    ] {
        let done = output(&folder.0, line)?;
        let told = said(&done);
        assert_eq!(done.status.code(), Some(2), "{line}: {told}");
        assert!(told.contains(expected) && !told.contains(not), "{line}: {told}");
    }
    assert!(!folder.join("out").exists());
    let tenth = "path --nodes 16 --fe-table csv --fe-error 1%";
    assert!(output(&folder.0, tenth)?.status.success());
    Ok(())
}

#[test]
fn a_record_without_a_command_gets_a_tip() -> Result<(), Box<dyn Error>> {
    let folder = Scratch::new("record_tip")?;
    fs::write(folder.join("r.npz"), "")?;
    let told = said(&output(&folder.0, "r.npz")?);
    for command in ["report", "patches", "path --resume"] {
        assert!(told.contains(&format!("`asperity {command} r.npz`")), "{told}");
    }
    assert!(!told.contains("info"), "{told}");
    Ok(())
}

/// A negative number is a value, with a unit as well as without.
#[test]
fn negative_values_are_values() -> Result<(), Box<dyn Error>> {
    let folder = Scratch::new("negative")?;
    for (line, expected) in [
        ("path --side -1mm", "invalid value '-1mm' for '--side <METRES>': must be positive"),
        ("path --side -.5", "invalid value '-.5' for '--side <METRES>': must be positive"),
        ("path --side=1 -1", "unexpected argument '-1'"),
        ("path --side --nodes 8", "a value is required for '--side <METRES>'"),
        ("path --unload -1mm", "unexpected value '-1mm' for '--unload'"),
    ] {
        let done = output(&folder.0, line)?;
        assert_eq!(done.status.code(), Some(2), "{line}: {}", said(&done));
        assert!(said(&done).contains(expected), "{line}: {}", said(&done));
    }
    Ok(())
}

/// Counts are integers wherever a program reads them.
#[test]
fn counts_are_integers() -> Result<(), Box<dyn Error>> {
    let folder = with_surface("integers")?;
    let path = "--nodes 32 --periodic love --max-area-fraction 0.3";
    for line in [
        &format!("path {path} --record r.npz"),
        "load --surface rough.npy --side 1e-2 --e-star 1 --load 1e-7",
        "patches r.npz",
        "leak r.npz --viscosity 1e-3 --pressure-drop 1 --along x --states 3",
        "slip r.npz --friction 0.3 --load 1e4 --amplitude 1e3",
        "creep r.npz --prony 0.3,1 --load 1e3 --time 10",
        "info rough.npy --side 1e-2",
    ] {
        let mut found = 0;
        check_counts(&answer(&folder.0, line)?, &mut found);
        assert!(found > 0, "{line} answers no counts");
    }
    Ok(())
}

/// Numbers under names of counts, at any depth.
fn check_counts(value: &Value, found: &mut usize) {
    const COUNTS: [&str; 14] = [
        "contact_nodes",
        "iterations",
        "states",
        "step",
        "nodes",
        "patches",
        "pools",
        "flowing_nodes",
        "stick_nodes",
        "slipping_nodes",
        "nx",
        "ny",
        "missing",
        "moving_nodes",
    ];
    match value {
        Value::Object(members) => {
            for (name, member) in members {
                if let (true, Value::Number(number)) = (COUNTS.contains(&name.as_str()), member) {
                    assert!(number.is_u64(), "{name}: {number}");
                    *found += 1;
                }
                check_counts(member, found);
            }
        }
        Value::Array(members) => members.iter().for_each(|member| check_counts(member, found)),
        _ => (),
    }
}
