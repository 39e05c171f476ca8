//! Answers for programs and shells: one JSON object, nothing beside it, and what shells and `man` read.

mod common;

use std::error::Error;
use std::path::Path;

use common::{Scratch, data, only_line, output, run, said};
use serde_json::Value;

type Done = Result<(), Box<dyn Error>>;

/// The only line of stdout, as JSON, of a program that has nothing else to say than warnings.
fn answer(folder: &Path, line: &str) -> Result<Value, Box<dyn Error>> {
    let done = run(folder, line)?;
    let errors = said(&done);
    assert!(errors.lines().all(|line| line.starts_with("warning: ")), "{errors}");
    only_line(done)
}

#[test]
fn every_command_answers_programs() -> Done {
    let folder = Scratch::new("programs")?;
    let folder = &folder.0;
    let path = answer(folder, "path --nodes 32 --max-area-fraction 0.2 --json --record p.npz")?;
    // A fifth of 32 x 32 nodes.
    assert_eq!(
        (&path["states"], &path["ended_by"]),
        (&204.into(), &"the requested contact area".into())
    );
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    assert!(number(&path["load"]) > 0.0 && number(&path["contact_stiffness"]) > 0.0);
    assert!(path["yielded_area_fraction"].is_null());
    assert!(path["warnings"][0].as_str().is_some_and(|text| text.contains("--hardness")));
    let steel =
        answer(folder, "path --nodes 32 --max-area-fraction 0.2 --yield --json --out steel")?;
    assert!(number(&steel["yielded_area_fraction"]) > 0.1 && number(&steel["plastic_work"]) > 0.0);

    let patches = answer(folder, "patches p.npz --json")?;
    assert_eq!(patches["state"]["load"], path["load"]);
    assert!(patches["percolates_x"].is_null() && patches["patches"].as_u64() > Some(0));
    assert_eq!(patches["channel_x"]["node"].as_array().map(Vec::len), Some(2));

    std::fs::copy(data("selfaffine_48.npy"), folder.join("rough.npy"))?;
    let line = "load --surface rough.npy --side 1e-2 --e-star 1 --load 1e-7 --load 2e-7 --json";
    let loads = answer(folder, line)?;
    let states = loads["states"].as_array().map_or(&[][..], Vec::as_slice);
    let found: Vec<f64> = states.iter().map(|state| number(&state["load"])).collect();
    assert_eq!(found, [1e-7, 2e-7]);
    assert!(states.iter().all(|state| number(&state["iterations"]) > 0.0));
    let asked: Vec<_> = states.iter().map(|state| state["at"].as_str()).collect();
    assert_eq!(asked, [Some("100 nN"), Some("200 nN")]);
    let warning = loads["warnings"][1].as_str().unwrap_or_default();
    assert!(warning.starts_with("at 200 nN: the contact is not resolved"), "{loads}");

    let info = answer(folder, "info rough.npy --json")?;
    assert_eq!(info["nx"], 48);

    let done =
        output(folder, "path --nodes 16 --seeds 1..3 --max-area-fraction 0.2 --quiet --out many")?;
    assert!(done.status.success() && done.stdout.is_empty(), "{}", said(&done));
    let gathered = answer(folder, "gather many --loads 5 --json")?;
    assert_eq!(
        (&gathered["paths"], gathered["load"].as_array().map(Vec::len)),
        (&3.into(), Some(5))
    );
    let area = &gathered["columns"]["contact_area_fraction"]["mean"];
    assert!(area[0].as_f64() < area[4].as_f64(), "{gathered}");
    // The files of paths, which take long, and no others.
    let files = ["out/path.csv", "out/load.csv", "out/patches.csv", "many/gather.csv"];
    assert_eq!(files.map(|name| folder.join(name).exists()), [true, false, false, false]);
    run(folder, &format!("{line} --out there"))?;
    assert!(
        folder.join("there/load.csv").is_file() && folder.join("there").read_dir()?.count() == 3
    );
    Ok(())
}

/// Errors, and warnings of the input, are printed all the same.
#[test]
fn quiet_is_quiet() -> Done {
    let folder = Scratch::new("quiet")?;
    for line in ["--quiet path --nodes 32 --max-area-fraction 0.2", "path -q --nodes 16"] {
        let done = output(&folder.0, line)?;
        assert!(done.status.success() && done.stdout.is_empty(), "{}", said(&done));
        let errors = String::from_utf8(done.stderr)?;
        assert!(errors.lines().all(|line| line.starts_with("warning: ")), "{errors}");
        assert!(folder.0.join("out/path.csv").is_file());
    }
    let failed = output(&folder.0, "info -q nothing.sur")?;
    assert_eq!(failed.status.code(), Some(1));
    assert!(String::from_utf8(failed.stderr)?.contains("nothing.sur"));
    Ok(())
}

/// Every format with its endings, to people and to programs.
#[test]
fn formats_are_listed() -> Done {
    let folder = Scratch::new("formats")?;
    let text = String::from_utf8(output(&folder.0, "formats")?.stdout)?;
    assert_eq!(text.lines().count(), 18, "{text}");
    for (name, ending) in [
        ("NumPy", ".npy"),
        ("Digital Surf", ".sur .pro"),
        ("Mountains", ".mnt"),
        ("ISO 5436-2", ".smd .prf"),
        ("Keyence", ".vk4 .vk6 .vk7"),
        ("Nanoscope", ".spm .di .000"),
        ("Igor", ".ibw"),
        ("Nanosurf", ".nid"),
        ("Wyko", ".opd"),
        ("Vision64", ".opdx"),
        ("MetroPro", ".dat"),
        ("Sensofar", ".plu"),
        ("text", ".txt .asc .csv .xyz"),
    ] {
        let line = text.lines().find(|line| line.starts_with(name)).ok_or(name)?;
        assert!(line.ends_with(ending), "{line}");
    }
    let json = answer(&folder.0, "formats --json")?;
    assert_eq!(json["Wyko"][0], "opd");
    Ok(())
}

#[test]
fn shells_and_manuals() -> Done {
    let folder = Scratch::new("shells")?;
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let done = output(&folder.0, &format!("completions {shell}"))?;
        let script = String::from_utf8(done.stdout)?;
        assert!(done.status.success() && script.contains("max-area-fraction"), "{shell}");
    }
    for (line, word) in [("manual", "patches"), ("manual load", "mean\\-pressure")] {
        let done = output(&folder.0, line)?;
        let page = String::from_utf8(done.stdout)?;
        assert!(done.status.success() && page.contains(".TH") && page.contains(word), "{page}");
    }
    assert_eq!(output(&folder.0, "manual nothing")?.status.code(), Some(1));
    let help = String::from_utf8(output(&folder.0, "--help")?.stdout)?;
    assert!(help.contains("130: a path interrupted") && help.contains("--seeds"), "{help}");
    Ok(())
}
