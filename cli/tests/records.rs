//! Records of the program: gone on from, read, and interrupted.

mod common;

use std::error::Error;
use std::ffi::OsStr;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Duration;

use common::{Scratch, asperity, data, is_refused, output, said};

type Done = Result<(), Box<dyn Error>>;

/// What the program prints if all goes well.
fn printed(folder: &Path, line: &str) -> Result<String, Box<dyn Error>> {
    let done = output(folder, line)?;
    assert!(done.status.success(), "{line}: {}", said(&done));
    Ok(String::from_utf8(done.stdout)?)
}

/// The numbers of every line of a file of states.
fn states(file: &Path) -> Result<Vec<Vec<f64>>, Box<dyn Error>> {
    let text = fs::read_to_string(file)?;
    let numbers = |line: &str| {
        let cells = line.split(',');
        // The event is no number, and a periodic half-space has no contact stiffness.
        let cells = cells.enumerate().filter(|(column, cell)| *column != 3 && !cell.is_empty());
        let numbers: Result<Vec<f64>, _> = cells.map(|(_, cell)| cell.parse()).collect();
        Ok(numbers?)
    };
    text.lines().skip(1).map(numbers).collect()
}

/// The 64 x 64 numbers of a field, behind its header.
fn field(file: &Path) -> Result<Vec<f64>, Box<dyn Error>> {
    let bytes = fs::read(file)?;
    let (_, values) = bytes.split_at(bytes.len() - 64 * 64 * 8);
    let values = values.as_chunks().0.iter().copied();
    Ok(values.map(f64::from_le_bytes).collect())
}

/// Step and node are the same, the columns behind them to what the crate promises of them.
fn are_alike(found: &Path, expected: &Path) -> Done {
    let (found, expected) = (states(found)?, states(expected)?);
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(&expected) {
        assert_eq!(found[..3], expected[..3]);
        for (column, (a, b)) in found.iter().zip(expected).enumerate().skip(3) {
            // Mean gaps are small differences of the first one.
            let scale = if column == 7 { 1e-4 } else { b.abs() };
            assert!((a - b).abs() <= 1e-10 * scale, "{column}: {a} {b}");
        }
    }
    Ok(())
}

/// Every byte is the same.
fn are_identical(found: &Path, expected: &Path) -> Done {
    let (found, expected) = (fs::read_to_string(found)?, fs::read_to_string(expected)?);
    for (line, (found, expected)) in found.lines().zip(expected.lines()).enumerate() {
        assert_eq!(found, expected, "line {line}");
    }
    assert_eq!(found.len(), expected.len());
    Ok(())
}

const PATH: &str = "path --nodes 64 --updater cholesky";

/// What a record holds is read from it: the same states, table, fields and picture as of a path that was to end there.
/// The record stays as it is.
#[test]
fn targets_that_lie_behind_are_read_from_the_record() -> Done {
    let folder = Scratch::new("records-behind")?;
    let whole = format!("{PATH} --max-area-fraction 0.3 --record r.npz --out whole");
    printed(&folder.0, &whole)?;
    let record = fs::read(folder.join("r.npz"))?;
    for (k, target) in [
        "--max-load 1",
        "--max-load 12345",
        "--mean-pressure 1e8",
        "--max-approach 1e-4",
        "--min-mean-gap 1e-4",
        "--max-area-fraction 0.0123",
    ]
    .iter()
    .enumerate()
    {
        let (read, fresh) = (format!("read_{k}"), format!("fresh_{k}"));
        let line =
            format!("path --updater cholesky --resume r.npz {target} --fields npy --out {read}");
        let told = printed(&folder.0, &line)?;
        let line = format!("{PATH} {target} --fields npy --out {fresh}");
        let expected = printed(&folder.0, &line)?;
        let end = |text: &str| {
            let line = text.lines().find(|line| line.starts_with("ended by"));
            line.map(str::to_string)
        };
        assert!(end(&told).is_some());
        assert_eq!(end(&told), end(&expected), "{target}");
        let (read, fresh) = (folder.join(&read), folder.join(&fresh));
        are_alike(&read.join("path.csv"), &fresh.join("path.csv"))?;
        for (name, size) in [("pressure.npy", 1e9), ("gap.npy", 1e-4)] {
            let (found, expected) = (field(&read.join(name))?, field(&fresh.join(name))?);
            let pairs = found.iter().zip(&expected);
            let error = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(error <= 1e-9 * size, "{target} {name}: {error:e}");
        }
        assert_eq!(fs::read(folder.join("r.npz"))?, record, "{target}");
    }
    // It would lose what lies beyond.
    let done = output(&folder.0, "path --resume r.npz --max-load 1 --record r.npz")?;
    is_refused(&done, &["r.npz", "another file"]);
    assert_eq!(fs::read(folder.join("r.npz"))?, record);
    printed(&folder.0, "path --resume r.npz --max-load 1 --record short.npz")?;
    assert!(fs::read(folder.join("short.npz"))?.len() < record.len());
    Ok(())
}

/// Without another name for it the record grows, and what is printed of the surface is what was printed of it before.
#[test]
fn a_record_grows_with_its_path() -> Done {
    let folder = Scratch::new("records-grow")?;
    let first =
        output(&folder.0, &format!("{PATH} --max-area-fraction 0.1 --record r.npz --out first"))?;
    assert!(first.status.success(), "{}", said(&first));
    let short = fs::read(folder.join("r.npz"))?.len();
    let again = output(&folder.0, "path --updater cholesky --resume r.npz --out again")?;
    let lines = |output: &Output| {
        let said = said(output);
        let lines = said.lines();
        let lines = lines.filter(|line| !line.starts_with("surface") && !line.starts_with("note"));
        // A record knows the composite modulus of its bodies, and not the bodies.
        let lines = lines.map(|line| match line.split_once(": E*") {
            Some((bodies, e_star)) if bodies.starts_with("bodies") => e_star,
            _ => line,
        });
        lines.map(str::to_string).collect::<Vec<_>>()
    };
    // 10 % of the area, although no number of nodes is 10 % of 4096; gradients of the same differences.
    assert_eq!(lines(&again), lines(&first));
    printed(
        &folder.0,
        "path --updater cholesky --resume r.npz --max-area-fraction 0.2 --out more",
    )?;
    assert!(fs::read(folder.join("r.npz"))?.len() > short);
    printed(&folder.0, &format!("{PATH} --max-area-fraction 0.2 --out whole"))?;
    are_alike(&folder.join("more/path.csv"), &folder.join("whole/path.csv"))?;
    // What was read from another record, into another one.
    let long = fs::read(folder.join("r.npz"))?;
    printed(&folder.0, "path --resume r.npz --max-area-fraction 0.25 --record longer.npz")?;
    assert_eq!(fs::read(folder.join("r.npz"))?, long);
    assert!(fs::read(folder.join("longer.npz"))?.len() > long.len());
    Ok(())
}

/// A path that goes on from its record has the file of the path that was not interrupted, byte for byte: with a factor,
/// without one, and where the default gives it up on the way.
#[test]
fn a_path_in_parts_is_the_whole_one() -> Done {
    let folder = Scratch::new("records-parts")?;
    for (k, path) in [
        "--updater cholesky",
        "--updater iterative",
        "--updater iterative --periodic love",
        "--updater iterative --periodic spectral",
        "--memory-budget 6e6",
    ]
    .into_iter()
    .enumerate()
    {
        let (updater, kernel) = path.split_once(" --periodic").unwrap_or((path, ""));
        let kernel = if kernel.is_empty() { "" } else { &path[updater.len()..] };
        let record = format!("r{k}.npz");
        let whole = format!("path --nodes 64 {updater} {kernel} --max-load 300000 --out whole{k}");
        printed(&folder.0, &whole)?;
        let first =
            format!("path --nodes 64 {updater} {kernel} --max-load 20000 --record {record}");
        printed(&folder.0, &first)?;
        for load in [100_000, 200_000, 300_000] {
            let more = format!("path --resume {record} {updater} --max-load {load} --out parts{k}");
            printed(&folder.0, &more)?;
        }
        let files = ["parts", "whole"].map(|name| folder.join(&format!("{name}{k}/path.csv")));
        let lines = fs::read_to_string(&files[1])?.lines().count();
        assert!(lines > 400, "{path}: {lines}");
        are_identical(&files[0], &files[1])?;
    }
    Ok(())
}

/// A path that breaks off for want of memory leaves its record, all files and the fields of its last state.
#[test]
fn a_small_budget_loses_nothing() -> Done {
    let folder = Scratch::new("records-budget")?;
    for (line, budget) in [("path --nodes 128 --periodic love", "5e6"), ("path --nodes 96", "5e6")]
    {
        let line = format!(
            "{line} --max-area-fraction 0.4 --memory-budget {budget} --record out/r.npz --fields npy"
        );
        let done = output(&folder.0, &line)?;
        is_refused(&done, &["the budget is 5 MB"]);
        assert!(!said(&done).contains("values, but found"), "{}", said(&done));
        let out = folder.join("out");
        for name in [
            "r.npz",
            "path.csv.part",
            "settings.json",
            "pressure.npy",
            "gap.npy",
            "contact_map.png",
            "loading_curve.svg",
        ] {
            assert!(out.join(name).is_file(), "{name}");
        }
        let told = String::from_utf8(done.stdout)?;
        assert!(told.contains("ended by: the memory budget") && !told.contains("NaN"), "{told}");
        let states = fs::read_to_string(out.join("path.csv.part"))?.lines().count() - 1;
        assert!(states > 100 && told.contains(&format!("{states} states in")), "{told}");
        fs::remove_dir_all(out)?;
    }
    Ok(())
}

/// Waits until a path has begun, sends it a signal, and waits for its end.
#[cfg(unix)]
fn signalled(folder: &Path, line: &str, signals: &[&str]) -> Result<Output, Box<dyn Error>> {
    let begins = |folder: &Path| {
        fs::metadata(folder.join("path.csv.part")).is_ok_and(|file| file.len() > 10_000)
    };
    signalled_once(folder, line, begins, signals)
}

/// The same, once its folder is as asked.
#[cfg(unix)]
fn signalled_once(
    folder: &Path,
    line: &str,
    begins: impl Fn(&Path) -> bool,
    signals: &[&str],
) -> Result<Output, Box<dyn Error>> {
    let words: Vec<&OsStr> = line.split_whitespace().map(OsStr::new).collect();
    let mut process =
        asperity(folder, &words).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()?;
    // Of many paths, each has a folder of its own.
    let out = folder.join("out");
    let begun = || {
        let mut folders = fs::read_dir(&out).into_iter().flatten().flatten();
        begins(&out) || folders.any(|entry| begins(&entry.path()))
    };
    while !begun() {
        assert!(process.try_wait()?.is_none(), "it has ended too early");
        std::thread::sleep(Duration::from_millis(5));
    }
    for signal in signals {
        let sent = Command::new("kill").arg(signal).arg(process.id().to_string()).status()?;
        assert!(sent.success());
    }
    Ok(process.wait_with_output()?)
}

/// A record is replaced by a path of its own surface and bodies, and not by that of others.
#[test]
fn a_record_of_another_surface_is_kept() -> Done {
    let folder = Scratch::new("records-kept")?;
    let path = "path --nodes 16 --record path.npz --max-area-fraction";
    printed(&folder.0, &format!("{path} 0.1"))?;
    printed(&folder.0, &format!("{path} 0.3"))?;
    let before = fs::read(folder.join("path.npz"))?;
    for other in ["--seed 2", "--side 5mm", "--nodes 32"] {
        let line = format!("{path} 0.1 {other}").replace("--nodes 16 ", "");
        let line = if other.contains("nodes") { line } else { format!("{line} --nodes 16") };
        is_refused(&output(&folder.0, &line)?, &["path.npz", "another surface", "--record"]);
    }
    printed(&folder.0, "path --nodes 16 --seed 2 --record other.npz --max-area-fraction 0.1")?;
    let onto = "path --resume other.npz --record path.npz --max-area-fraction 0.2";
    is_refused(&output(&folder.0, onto)?, &["path.npz", "another surface"]);
    let others = [
        ("--material glass", "other bodies"),
        ("--layer gold,2um --base steel", "other bodies"),
        ("--periodic love", "another half-space"),
        ("--hardness 2GPa", "another hardness"),
        ("--work-of-adhesion 0.05", "another adhesion"),
    ];
    for (other, what) in others {
        let refused = output(&folder.0, &format!("{path} 0.1 {other}"))?;
        is_refused(&refused, &["path.npz", what, "--record"]);
    }
    assert_eq!(fs::read(folder.join("path.npz"))?, before);
    // One that is the same replaces it.
    for same in ["--hardness 2GPa", "--layer gold,2um --base steel", "--periodic love"] {
        fs::remove_file(folder.join("path.npz"))?;
        printed(&folder.0, &format!("{path} 0.1 {same}"))?;
        printed(&folder.0, &format!("{path} 0.2 {same}"))?;
    }
    Ok(())
}

/// A file that is no record is not replaced by one; an empty one is a place for it.
#[test]
fn other_files_are_not_replaced() -> Done {
    let folder = Scratch::new("records-other")?;
    let mine = folder.join("mine.npz");
    fs::copy(data("selfaffine_48.npy"), &mine)?;
    let before = fs::read(&mine)?;
    let line = "path --nodes 16 --record mine.npz";
    is_refused(&output(&folder.0, line)?, &["mine.npz", "no record"]);
    assert_eq!(fs::read(&mine)?, before);
    fs::write(&mine, "")?;
    printed(&folder.0, line)?;
    for name in ["mine.npz", "other.npy"] {
        if name == "other.npy" {
            fs::copy(data("selfaffine_48.npy"), folder.join(name))?;
        }
        fs::copy(&mine, folder.join("kept.npz"))?;
        let before = fs::read(folder.join(name))?;
        is_refused(
            &output(&folder.0, &format!("report kept.npz --out {name}"))?,
            &[name, "no page"],
        );
        assert_eq!(fs::read(folder.join(name))?, before);
    }
    printed(&folder.0, "report kept.npz --out page.html")?;
    printed(&folder.0, "report kept.npz --out page.html")?;
    Ok(())
}

/// What a table of slip or creep had beside it and does not have any more is said to be of an earlier run.
#[test]
fn tables_of_an_earlier_run_are_named() -> Done {
    let folder = Scratch::new("records-earlier-tables")?;
    printed(&folder.0, "path --nodes 32 --record r.npz")?;
    fs::write(folder.join("out/slip.csv"), "")?;
    for (before, told) in [(true, false), (false, true)] {
        if before {
            fs::remove_file(folder.join("out/slip.csv"))?;
            fs::write(folder.join("out/history.csv"), "")?;
        }
        let done = output(&folder.0, "slip r.npz --friction 0.5")?;
        let said = said(&done);
        assert!(done.status.success(), "{said}");
        assert_eq!(said.contains("note: of an earlier slip: out/history.csv"), told, "{said}");
    }
    fs::remove_file(folder.join("out/history.csv"))?;
    // Charts in the other format, and records by such names.
    fs::rename(folder.join("r.npz"), folder.join("out/slip.npz"))?;
    let done = output(&folder.0, "slip out/slip.npz --friction 0.5 --charts svg")?;
    let said = said(&done);
    assert!(said.lines().any(|line| line.ends_with("of an earlier slip: out/slip.png")), "{said}");
    Ok(())
}

/// Files that a path does not write again are said to be of an earlier one.
#[test]
fn files_of_an_earlier_path_are_named() -> Done {
    let folder = Scratch::new("records-earlier")?;
    let told = printed(&folder.0, "path --nodes 32 --fields npy --at 1MPa")?;
    assert!(!told.contains("earlier"), "{told}");
    fs::write(folder.join("out/interrupted.npz"), "")?;
    let done = output(&folder.0, "path --nodes 32 --at 2MPa")?;
    let told = said(&done);
    let left = "note: of an earlier path: out/contact_map_1MPa.png, out/gap.npy, out/gap_1MPa.npy, out/interrupted.npz, \
                out/pressure.npy, out/pressure_1MPa.npy";
    assert!(done.status.success() && told.contains(left), "{told}");
    Ok(())
}

/// The first Ctrl-C keeps the path, and says how to go on.
#[cfg(unix)]
#[test]
fn interrupted_paths_go_on() -> Done {
    let folder = Scratch::new("records-interrupted")?;
    const LONG: &str = "path --nodes 128 --max-area-fraction 0.3 --updater cholesky";
    printed(&folder.0, &format!("{LONG} --out whole"))?;
    // Without a name it goes beside a record of another surface.
    let other = folder.join("out/interrupted.npz");
    for (options, record) in [("--record kept.npz", "kept.npz"), ("", "out/interrupted_2.npz")] {
        fs::create_dir_all(folder.join("out"))?;
        printed(&folder.0, "path --nodes 16 --record out/interrupted.npz --out other")?;
        let before = fs::read(&other)?;
        let done = signalled(&folder.0, &format!("{LONG} {options}"), &["-INT"])?;
        let said = said(&done);
        assert_eq!(done.status.code(), Some(130), "{said}");
        let states = fs::read_to_string(folder.join("out/path.csv.part"))?.lines().count() - 1;
        assert!(states < 4915, "it was at its end");
        // `gather` takes no path that has not ended.
        assert!(!folder.join("out/path.csv").exists());
        let told = format!(
            "{states} states in {record}; continue with `asperity path --resume {record} --max-area-fraction 0.3 --updater cholesky`"
        );
        assert!(said.contains(&told), "{said}");
        let again = format!("path --resume {record} --max-area-fraction 0.3 --updater cholesky");
        printed(&folder.0, &again)?;
        are_identical(&folder.join("out/path.csv"), &folder.join("whole/path.csv"))?;
        assert_eq!(fs::read(&other)?, before);
        fs::remove_dir_all(folder.join("out"))?;
    }
    // All options come again, and do what they would have done.
    let options = "--max-load 1e6 --fields npy --save-every 200 --conductivity 50,40 --gap-conductivity 0.026 \
                   --fe-table csv --friction 0.2 --unload --hardness 2e10 --record with.npz --memory-budget 1e9 --units mm-N-MPa --charts png";
    let given = "--nodes 128 --seed 1 --material steel --against glass --max-area-fraction 0.3";
    let done = signalled(&folder.0, &format!("path {given} {options}"), &["-INT"])?;
    let told = said(&done);
    assert_eq!(done.status.code(), Some(130), "{told}");
    let again = told.split('`').nth(1).ok_or(told.clone())?;
    for option in options
        .split(" --")
        .filter(|option| !option.contains("hardness") && !option.contains("record"))
    {
        assert!(again.contains(option), "{option} is not in {again}");
    }
    assert!(again.starts_with("asperity path --resume with.npz --max-"), "{again}");
    printed(&folder.0, again.strip_prefix("asperity ").ok_or("no program")?)?;
    printed(&folder.0, &format!("path {given} {options} --out whole"))?;
    for file in ["interface.csv", "unloading.csv", "pressure.npy"] {
        assert!(folder.join("out").join(file).is_file(), "{file}");
    }
    let headers = ["out/path.csv", "whole/path.csv"].map(|file| {
        fs::read_to_string(folder.join(file)).map(|text| text.lines().next().map(str::to_string))
    });
    let [resumed, whole] = headers;
    assert_eq!(resumed?, whole?);
    // What a batch system sends does the same.
    let done = signalled(&folder.0, LONG, &["-TERM"])?;
    assert_eq!(done.status.code(), Some(130), "{}", said(&done));
    assert!(other.is_file());
    // Of many paths the one that is interrupted leaves nothing, and nothing is said of it.
    let soft =
        "path --nodes 64 --side 100um --rolloff 50um --short-cutoff 25um --sq 2um --e-star 1MPa";
    let sticks = "--work-of-adhesion 50mJ/m² --max-area-fraction 0.5";
    for line in [LONG.to_string(), format!("{soft} {sticks}")] {
        fs::remove_dir_all(folder.join("out"))?;
        let done = signalled(&folder.0, &format!("{line} --seeds 1..2"), &["-INT"])?;
        let told = said(&done) + &String::from_utf8_lossy(&done.stdout);
        assert_eq!(done.status.code(), Some(130), "{told}");
        assert!(told.contains("interrupted at seed 1") && !told.contains("unfinished"), "{told}");
        assert_eq!(fs::read_dir(folder.join("out"))?.count(), 0);
    }
    Ok(())
}

/// Before the first state too, what a batch system sends ends the program as Ctrl-C does.
#[cfg(unix)]
#[test]
fn signals_before_the_first_state_have_the_same_code() -> Done {
    let folder = Scratch::new("records-signals")?;
    for signal in ["-INT", "-TERM"] {
        let line = "path --nodes 1024 --max-area-fraction 0.1 --updater iterative";
        let begins = |folder: &Path| folder.is_dir();
        let done = signalled_once(&folder.0, line, begins, &[signal])?;
        assert_eq!(done.status.code(), Some(130), "{signal}: {}", said(&done));
        fs::remove_dir_all(folder.join("out"))?;
    }
    Ok(())
}

/// What cannot be done is said at once, and nothing is ignored.
#[test]
fn what_cannot_be_done_is_said_before_the_work() -> Done {
    let folder = Scratch::new("records-refused")?;
    printed(&folder.0, "path --nodes 32 --record r.npz --out first")?;
    let record = fs::read(folder.join("r.npz"))?;
    fs::write(folder.join("cut.npz"), &record[..record.len() / 2])?;
    fs::write(folder.join("text.npz"), "no archive")?;
    let measured = fs::read(common::data("surface_files/missing_f64.x3p"))?;
    fs::write(folder.join("cut.x3p"), &measured[..measured.len() / 2])?;
    fs::create_dir(folder.join("folder"))?;
    for name in ["input.npy", "gap_1N.npy", "path.csv", "conductance.csv", "load.csv"] {
        fs::copy(common::data("selfaffine_48.npy"), folder.join(name))?;
    }
    for (line, words) in [
        (
            "path --surface input.npy --side 1e-2 --e-star 1 --record input.npy",
            &["--record would replace the surface"][..],
        ),
        ("path --nodes 32 --record nowhere/r.npz", &["nowhere/r.npz"]),
        ("path --surface path.csv --side 1 --e-star 1 --out .", &["path.csv would be replaced"]),
        (
            "path --surface conductance.csv --side 1 --e-star 1 --out .",
            &["conductance.csv would be replaced"],
        ),
        (
            "path --surface gap_1N.npy --side 1 --e-star 1 --at 1N --fields npy --out .",
            &["gap_1N.npy would be replaced"],
        ),
        ("load --surface load.csv --side 1 --e-star 1 --load 1 --out .", &["load.csv would be"]),
        (
            "load --surface gap_1N.npy --side 1 --e-star 1 --at 1N --save .",
            &["gap_1N.npy would be replaced"],
        ),
        ("report r.npz --out r.npz", &["--out would replace the record r.npz"]),
        ("gather . --loads 1", &["--loads takes at least 2"]),
        ("gather . --loads 18446744073709551615", &["at most 1000000"]),
        ("path --nodes 32 --record folder", &["folder"]),
        ("path --nodes 32 --record out/path.csv", &["ends with .npz"]),
        ("path --nodes 32 --fill", &["--fill", "generated"]),
        ("path --nodes 32 --level plane", &["--level"]),
        ("path --resume cut.npz", &["cut.npz", "no complete zip archive", "cut off"]),
        ("path --resume text.npz", &["text.npz", "no complete zip archive"]),
        ("patches cut.npz", &["cut.npz", "cut off"]),
        ("info cut.x3p", &["cut.x3p", "cut off"]),
        (
            "path --nodes 32768 --memory-budget 1e9",
            &["216.5 GB", "the budget is 1 GB", "the largest square grid that fits"],
        ),
        ("path --nodes 100000", &["the largest square grid that fits"]),
    ] {
        let done = output(&folder.0, line)?;
        is_refused(&done, words);
        assert!(!said(&done).contains("EOCD"), "{}", said(&done));
        assert!(!folder.join("out/path.csv").exists(), "{line}");
    }
    for (line, word) in [
        ("path --resume r.npz --seed 2", "--seed"),
        ("path --resume r.npz --height-unit nm", "--height-unit"),
        ("path --resume r.npz --channel Height", "--channel"),
        ("path --resume r.npz --fill", "--fill"),
        ("path --resume r.npz --short-cutoff 1e-3", "--short-cutoff"),
        ("path --resume r.npz --seeds 1..2", "--seeds"),
        ("path --resume r.npz --periodic love", "--periodic"),
        ("path --nodes 32 --save-every 10", "--record"),
        // What needs another option is not passed over where that one is excluded.
        ("path --nodes 12 --against-surface other.npy", "--against-surface"),
        ("path --hurst 0.5 --against-surface other.npy --against-turned", "--against-surface"),
        ("path --seeds 1..2 --against-surface other.npy", "--against-surface"),
        ("path --seed 1 --task 1/2", "--task"),
        ("path --material steel --base rigid", "--base"),
        ("slip r.npz --friction 0.2 --compliance-ratio 1.2 --against steel", "--against"),
        ("stress r.npz --poisson 0.3 --against steel", "--against"),
        ("creep r.npz --prony 1,0.3 --approach 1um --cycle-amplitude 1N", "--cycle-amplitude"),
        ("path --friction 0.3", "--fe-table"),
        ("load --friction 0.3", "frictionless"),
        ("info --hardness 1e9", "unexpected argument '--hardness'"),
    ] {
        let done = output(&folder.0, line)?;
        assert_eq!(done.status.code(), Some(2), "{line}");
        assert!(said(&done).contains(word), "{}", said(&done));
    }
    // The largest grid that is told is one that fits to full contact, and one with a tenth more nodes a side is not.
    let done = output(&folder.0, "path --nodes 4000 --memory-budget 10e6")?;
    let text = said(&done);
    let told = text.split(" at any load has ").nth(1);
    let side = told.and_then(|rest| rest.split(' ').next());
    let side: usize = side.ok_or("no side")?.parse()?;
    assert!(side > 64, "{side}");
    let line = |side: usize| {
        format!("path --nodes {side} --memory-budget 10e6 --max-area-fraction 1 --out largest")
    };
    assert!(output(&folder.0, &line(side))?.status.success(), "{side}");
    let larger = output(&folder.0, &line(side + side / 10))?;
    is_refused(&larger, &["the budget is 10 MB"]);
    Ok(())
}

/// Layers are said, in the settings and in the record, and a path on them goes on.
#[test]
fn a_path_on_layers_goes_on() -> Done {
    let folder = Scratch::new("records-layers")?;
    let coat = "1 mm of E = 20 GPa, ν = 0.30, 500 µm of E = 125 GPa, ν = 0.34 on E = 210 GPa, ν = 0.30 against rigid";
    for (name, periodic) in
        [("free", ""), ("love", "--periodic love"), ("waves", "--periodic spectral")]
    {
        let line =
            format!("{PATH} --layer 20e9,0.3,1e-3 --layer copper,5e-4 --base steel {periodic}");
        let first =
            format!("{line} --max-area-fraction 0.1 --record {name}.npz --out {name}_first");
        let first = output(&folder.0, &first)?;
        assert!(said(&first).contains(&format!("bodies     {coat}")), "{}", said(&first));
        let settings = fs::read_to_string(folder.join(&format!("{name}_first/settings.json")))?;
        assert!(settings.contains("20000000000.0"), "{settings}");
        let more = format!(
            "path --updater cholesky --resume {name}.npz --max-area-fraction 0.2 --out {name}_more"
        );
        assert!(said(&output(&folder.0, &more)?).contains(coat));
        printed(&folder.0, &format!("{line} --max-area-fraction 0.2 --out {name}_whole"))?;
        are_alike(
            &folder.join(&format!("{name}_more/path.csv")),
            &folder.join(&format!("{name}_whole/path.csv")),
        )?;
    }
    printed(&folder.0, "patches free.npz --out patches")?;
    Ok(())
}

/// Surfaces that repeat along one side: said, kept, gone on with, taken apart and leaked through.
#[test]
fn a_path_that_repeats_along_one_side_goes_on() -> Done {
    let folder = Scratch::new("records-one-side")?;
    let told = |output: &std::process::Output| {
        String::from_utf8_lossy(&output.stdout).into_owned() + &said(output)
    };
    for (along, across) in [("x", "y"), ("y", "x")] {
        let said_of = format!("periodic along {along} and free along {across}, Love kernel");
        let line = format!("{PATH} --periodic {along}");
        let first =
            format!("{line} --max-area-fraction 0.1 --record {along}.npz --out {along}_first");
        let first = output(&folder.0, &first)?;
        assert!(told(&first).contains(&format!("half-space {said_of}")), "{}", told(&first));
        let settings = fs::read_to_string(folder.join(&format!("{along}_first/settings.json")))?;
        assert!(settings.contains(&said_of), "{settings}");
        let more = format!(
            "path --updater cholesky --resume {along}.npz --max-area-fraction 0.2 --out {along}_more"
        );
        assert!(told(&output(&folder.0, &more)?).contains(&said_of));
        printed(&folder.0, &format!("{line} --max-area-fraction 0.2 --out {along}_whole"))?;
        are_alike(
            &folder.join(&format!("{along}_more/path.csv")),
            &folder.join(&format!("{along}_whole/path.csv")),
        )?;
        let patches = output(&folder.0, &format!("patches {along}.npz --out {along}_patches"))?;
        let boundary = format!("along {along} periodic boundary");
        assert!(
            patches.status.success() && told(&patches).contains(&boundary),
            "{}",
            told(&patches)
        );
        for (flow, sides) in [(along, "sides closed"), (across, "sides joined")] {
            let leak = format!(
                "leak {along}.npz --viscosity 1e-3 --pressure-drop 1e5 --along {flow} --states 3 --out {along}_{flow}"
            );
            let leak = output(&folder.0, &leak)?;
            assert!(leak.status.success() && told(&leak).contains(sides), "{}", told(&leak));
        }
    }
    let both = output(&folder.0, &format!("{PATH} --layer steel,1e-6 --base rigid --periodic x"))?;
    is_refused(&both, &["layers repeat", "love"]);
    Ok(())
}

/// Layers that there are not, in words.
#[test]
fn bad_layers_are_refused() -> Done {
    let folder = Scratch::new("records-bad-layers")?;
    for (line, words) in [
        ("--layer 1e9,0.3,0 --base rigid", "thickness"),
        ("--layer 1e9,0.3,-1e-6 --base rigid", "thickness"),
        ("--layer 1e9,0.3,nan --base rigid", "thickness"),
        ("--layer 1e9,0.6,1e-6 --base rigid", "Poisson"),
        ("--layer 0,0.3,1e-6 --base rigid", "Young"),
        ("--layer 1e9,0.3,1e-6 --base 0,0.3", "Young"),
        ("--layer 1e9,0.3,1e-6", "--base"),
        ("--base rigid", "--layer"),
        ("--layer 1e9,0.3 --base rigid", "E,NU,H"),
        ("--layer 1e9,0.3,1e-6 --base soft", "rigid"),
        ("--layer 1e9,0.3,1e-6 --base rigid --e-star 1e9", "--e-star"),
        ("--against steel", "--against"),
    ] {
        let done = output(&folder.0, &format!("path --nodes 16 {line}"))?;
        // What is wrong with a number is an error, and what is wrong with the arguments one of the command line.
        assert!(matches!(done.status.code(), Some(1 | 2)), "{line}: {}", said(&done));
        assert!(said(&done).contains(words), "{line}: {}", said(&done));
    }
    Ok(())
}
