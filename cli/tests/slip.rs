//! `asperity slip` on the record of a small path.
#![allow(clippy::float_cmp)]

mod common;

use std::error::Error;
use std::ffi::OsStr;
use std::fs;
use std::path::Path;
use std::process::Output;

use asperity_cli::number::quantity;
use common::{Scratch, answer, asperity, number, numbers, said};

type Done = Result<(), Box<dyn Error>>;

fn run(folder: &Path, line: &str) -> std::io::Result<Output> {
    let words: Vec<&OsStr> = line.split_whitespace().map(OsStr::new).collect();
    asperity(folder, &words).output()
}

/// A folder with the record of a path of rubber.
fn with_record(name: &str) -> Result<Scratch, Box<dyn Error>> {
    let folder = Scratch::new(name)?;
    let line = "path --nodes 48 --max-area-fraction 0.3 --material rubber --record path.npz";
    let done = run(&folder.0, line)?;
    assert!(done.status.success(), "{}", said(&done));
    Ok(folder)
}

/// Its answers hang together, and with its tables; the history of a first loading and a cycle loses a quarter of a
/// cycle and a whole one.
#[test]
fn answers_and_tables_agree() -> Done {
    let folder = with_record("slip")?;
    let folder = &folder.0;
    let rubber = "slip path.npz --friction 0.5 --material rubber";
    let default = answer(folder, rubber)?;
    // The record knows its bodies.
    assert_eq!(answer(folder, "slip path.npz --friction 0.5")?, default);
    let (load, force) = (number(&default, "load"), number(&default, "tangential_load"));
    assert!((force / (0.25 * load) - 1.0).abs() < 1e-12);
    assert!((number(&default, "compliance_ratio") - 1.5).abs() < 1e-15);
    // ν = 1/2 against rigid.
    assert_eq!(number(&default, "dundurs_beta"), 0.0);
    assert_eq!(default["warnings"].as_array().map(Vec::len), Some(0));
    let nodes = number(&default, "stick_nodes") + number(&default, "slipping_nodes");
    // Three tenths of 48 x 48.
    assert_eq!(nodes, 691.0);
    assert!(number(&default, "history_dissipation").is_nan());
    assert!(!folder.join("out/slip.csv").exists(), "an answer for programs writes no files");

    let table = format!(
        "load,tangential_load\n{load},0\n{load},{force}\n{load},-{force}\n{load},{force}\n"
    );
    fs::write(folder.join("cycle.csv"), table)?;
    let line = format!("{rubber} --amplitude {force} --load {load} --history cycle.csv --out seen");
    let sheared = answer(folder, &line)?;
    let lost = number(&sheared, "history_dissipation");
    assert!((lost / (1.25 * number(&default, "dissipation")) - 1.0).abs() < 1e-9, "{lost}");

    let seen = folder.join("seen");
    let loads = numbers(&seen.join("slip.csv"), "tangential_load")?;
    let displacements = numbers(&seen.join("slip.csv"), "displacement")?;
    assert!((loads.last().ok_or("no rows")? / (0.5 * load) - 1.0).abs() < 1e-12);
    let last = displacements.last().ok_or("no rows")?;
    assert!((last / number(&default, "sliding_displacement") - 1.0).abs() < 1e-12);
    assert!(displacements.windows(2).all(|pair| pair[0] < pair[1]));
    let losses = numbers(&seen.join("cycles.csv"), "dissipation")?;
    assert!(losses.len() > 20 && losses.windows(2).all(|pair| pair[0] < pair[1]));
    // Elements bear all that friction does.
    let stiffnesses = numbers(&seen.join("iwan.csv"), "stiffness")?;
    let slips = numbers(&seen.join("iwan.csv"), "slip_displacement")?;
    let sum: f64 = stiffnesses.iter().zip(&slips).map(|(k, slip)| k * slip).sum();
    assert!((sum / number(&default, "sliding_load") - 1.0).abs() < 1e-10);
    assert!(slips.windows(2).all(|pair| pair[0] <= pair[1]));
    // All of them hold before any slip.
    let printed = run(folder, "slip path.npz --friction 0.5 --material rubber")?.stdout;
    let stiffness = quantity(stiffnesses.iter().sum(), "N/m", 4);
    assert!(String::from_utf8(printed)?.contains(&format!("before any slip {stiffness}\n")));
    assert_eq!(numbers(&seen.join("history.csv"), "dissipation")?.last(), Some(&lost));
    for picture in ["slip", "stick_map", "wear_map", "history"] {
        let bytes = fs::read(seen.join(picture).with_extension("png"))?;
        assert!(bytes.starts_with(b"\x89PNG"), "{picture}");
    }
    Ok(())
}

/// What the answer leaves out is said beside it.
#[test]
fn coupling_few_nodes_and_other_bodies_are_warned_of() -> Done {
    let folder = with_record("slip_warnings")?;
    let folder = &folder.0;
    let steel = run(folder, "slip path.npz --friction 0.3 --material steel")?;
    let words = said(&steel);
    assert!(words.contains("β is 0.286") && words.contains("first loading"), "{words}");
    assert!(words.contains("only their ratio of compliances"), "{words}");
    let alike =
        said(&run(folder, "slip path.npz --friction 0.3 --material steel --against steel")?);
    assert!(!alike.contains("β is"), "{alike}");
    let small = run(folder, "slip path.npz --friction 0.3 --material rubber --amplitude 1e-3")?;
    assert!(said(&small).contains("that of the grid"), "{}", said(&small));
    Ok(())
}

#[test]
fn what_cannot_be_sheared_is_refused() -> Done {
    let folder = with_record("slip_refusals")?;
    let folder = &folder.0;
    let refused = |line: &str, words: &[&str]| -> Done {
        let done = run(folder, line)?;
        let told = said(&done);
        assert!(!done.status.success(), "{line}");
        assert!(words.iter().all(|word| told.contains(word)), "{line}: {told}");
        Ok(())
    };
    run(folder, "path --nodes 32 --max-area-fraction 0.2 --e-star 1e9 --record modulus.npz")?;
    refused("slip modulus.npz --friction 0.3", &["--compliance-ratio", "--material"])?;
    refused("slip path.npz --friction 0 --material rubber", &["positive"])?;
    refused(
        "slip path.npz --friction 0.3 --material rubber --load 1e9",
        &["the path ends at the load"],
    )?;
    refused(
        "slip path.npz --friction 0.3 --material rubber --amplitude 1e9",
        &["the joint slides"],
    )?;
    refused("slip none.npz --friction 0.3 --material rubber", &["cannot read none.npz"])?;
    fs::write(folder.join("bad.csv"), "load,tangential_load\n1,0\n1,x\n")?;
    refused("slip path.npz --friction 0.3 --material rubber --history bad.csv", &["line 3"])?;
    fs::write(folder.join("sliding.csv"), "load;tangential_load [mN]\n1;0\n1 N;400,5\n")?;
    let line = "slip path.npz --friction 0.3 --material rubber --history sliding.csv";
    // The load of the line, and not one on the way there.
    refused(line, &["line 3 of sliding.csv", "the joint slides", "0.4005"])?;
    run(folder, "path --nodes 32 --max-area-fraction 0.2 --yield --record steel.npz")?;
    refused(
        "slip steel.npz --friction 0.3 --material steel",
        &["yields", "elastic contact that grows"],
    )
}

/// A history is not replaced by the table of what it does.
#[test]
fn a_history_stays() -> Done {
    let folder = Scratch::new("slip_history")?;
    let record = run(&folder.0, "path --nodes 16 --material rubber --record path.npz")?;
    assert!(record.status.success(), "{}", said(&record));
    let table = "load,tangential_load\n1e-3,0\n1e-3,1e-5\n";
    for name in ["history.csv", "slip.csv"] {
        fs::write(folder.join(name), table)?;
        let line = format!("slip path.npz --friction 0.5 --history {name}");
        for out in ["--out .", "--out . --json"] {
            let done = run(&folder.0, &format!("{line} {out}"))?;
            assert_eq!(done.status.code(), Some(1), "{}", said(&done));
            assert!(said(&done).contains(&format!("{name} would be replaced")), "{}", said(&done));
        }
        let other = run(&folder.0, &line)?;
        assert!(other.status.success(), "{}", said(&other));
        assert_eq!(fs::read_to_string(folder.join(name))?, table);
    }
    Ok(())
}
