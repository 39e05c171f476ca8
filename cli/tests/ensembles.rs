//! Many paths: what is there is skipped only if it is the same, and only paths of one kind are gathered.

mod common;

use std::error::Error;
use std::fs;
use std::time::{Duration, Instant};

use asperity::io::write_npy;
use common::{Scratch, is_refused, numbers, output, said};
use nalgebra::DMatrix;

type Done = Result<(), Box<dyn Error>>;

#[test]
fn seeds_that_are_there_are_skipped_if_they_are_the_same() -> Done {
    let folder = Scratch::new("ensemble-same")?;
    let line = "path --nodes 32 --max-area-fraction 0.1 --seeds 1..2 --out runs";
    assert!(output(&folder.0, line)?.status.success());
    let first = fs::read(folder.join("runs/seed_1/path.csv"))?;
    // The same: one more is followed, two are skipped.
    let more = "path --nodes 32 --max-area-fraction 0.1 --seeds 1..3 --out runs";
    let done = output(&folder.0, more)?;
    let told = String::from_utf8(done.stdout)?;
    assert!(told.contains("1 path to follow, 2 finished"), "{told}");
    for (other, words) in [
        ("--max-area-fraction 0.2", &["targets", "0.2", "0.1"][..]),
        ("--max-area-fraction 0.1 --periodic love", &["half_space", "free", "Love"]),
        ("--max-area-fraction 0.1 --e-star 1e9", &["e_star", "1000000000"]),
        ("--max-area-fraction 0.1 --side 2e-2", &["grid.sides"]),
        (
            "--max-area-fraction 0.1 --short-cutoff 2e-3",
            &["surface.short_cutoff_wavelength is 0.002", "0.0025"],
        ),
        (
            "--max-area-fraction 0.1 --material 70e9,0.33",
            &["bodies", "[[70000000000.0,0.33]]", "[[210000000000.0,0.3]]"],
        ),
        ("--max-area-fraction 0.1 --rule approximate-order", &["rule"]),
        ("--max-area-fraction 0.1 --updater iterative", &["updater"]),
        ("--max-area-fraction 0.1 --hardness 1e9 --unload", &["unload is true", "false"]),
        ("--max-area-fraction 0.1 --nodes 16", &["grid.nodes", "[16,16]", "[32,32]"]),
    ] {
        let nodes = if other.contains("--nodes") { "" } else { "--nodes 32" };
        for dry in ["", "--dry-run"] {
            let line = format!("path {nodes} {other} --seeds 1..4 --out runs {dry}");
            let done = output(&folder.0, &line)?;
            is_refused(&done, words);
            is_refused(&done, &["runs/seed_1", "--out"]);
        }
    }
    assert!(!folder.join("runs/seed_4").exists());
    assert_eq!(fs::read(folder.join("runs/seed_1/path.csv"))?, first);
    // Without settings nobody can tell.
    fs::remove_file(folder.join("runs/seed_2/settings.json"))?;
    is_refused(&output(&folder.0, more)?, &["seed_2", "settings.json"]);
    is_refused(&output(&folder.0, "gather runs")?, &["seed_2", "settings.json"]);
    Ok(())
}

#[test]
fn mixtures_are_not_gathered() -> Done {
    let folder = Scratch::new("ensemble-mixture")?;
    for line in [
        "path --nodes 32 --seeds 1..2 --out runs",
        "path --nodes 32 --seeds 3..3 --periodic love --out others",
    ] {
        assert!(output(&folder.0, line)?.status.success());
    }
    assert!(output(&folder.0, "gather runs")?.status.success());
    fs::remove_file(folder.join("runs/gather.csv"))?;
    fs::rename(folder.join("others/seed_3"), folder.join("runs/seed_3"))?;
    let done = output(&folder.0, "gather runs")?;
    is_refused(&done, &["seed_3", "seed_1", "half_space", "free", "Love"]);
    assert!(!said(&done).contains("surface.seed"), "{}", said(&done));
    assert!(!folder.join("runs/gather.csv").exists());
    Ok(())
}

/// Many paths are told in one table, and gathered in another; the description and what is the same is said once.
#[test]
fn many_paths_are_told_in_one_table() -> Done {
    let folder = Scratch::new("ensemble-table")?;
    let done =
        output(&folder.0, "path --nodes 32 --max-area-fraction 0.1 --seeds 4..6 --out runs")?;
    let told = String::from_utf8(done.stdout.clone())?;
    let rows = told.lines().skip_while(|line| !line.contains("mean gap")).skip(2).take(3);
    let seeds: Vec<&str> = rows.filter_map(|row| row.split_whitespace().next()).collect();
    assert_eq!(seeds, ["4", "5", "6"], "{told}");
    assert_eq!(told.matches("K_i: interfacial").count(), 1, "{told}");
    assert_eq!(told.matches("the greatest pressure is").count(), 1, "{told}");
    assert!(
        told.contains("warning: seed 4, one of 3 paths like it: the greatest pressure is"),
        "{told}"
    );
    assert_eq!(said(&done).matches("half-space free").count(), 1, "{}", said(&done));
    let gathered = String::from_utf8(output(&folder.0, "gather runs")?.stdout)?;
    assert!(gathered.contains("means of 3 paths at common loads"), "{gathered}");
    let last = || -> Result<String, Box<dyn Error>> {
        let table = fs::read_to_string(folder.join("runs/gather.csv"))?;
        Ok(table.lines().last().unwrap_or_default().to_string())
    };
    let sixty = last()?;
    // The last common load is one, however many there are before it.
    for loads in ["2", "10", "20", "61", "80"] {
        let done = output(&folder.0, &format!("gather runs --loads {loads}"))?;
        assert!(done.status.success());
        assert_eq!(last()?, sixty, "{loads}");
    }
    assert!(output(&folder.0, "gather runs")?.status.success());
    let table = fs::read_to_string(folder.join("runs/gather.csv"))?;
    let last: Vec<f64> = table
        .lines()
        .last()
        .ok_or("no line")?
        .split(',')
        .map(str::parse)
        .collect::<Result<_, _>>()?;
    let shown = gathered.lines().skip_while(|line| !line.contains("mean gap")).skip(2);
    let shown: Vec<&str> = shown.take_while(|line| !line.is_empty()).collect();
    let shown: Vec<f64> = shown
        .last()
        .ok_or("no row")?
        .split_whitespace()
        .map(str::parse)
        .collect::<Result<_, _>>()?;
    // Area and its spread in per cent.
    assert!((shown[1] / (100.0 * last[1]) - 1.0).abs() < 1e-3, "{gathered}");
    assert!((shown[2] / (100.0 * last[2] / last[1]) - 1.0).abs() < 1e-3, "{gathered}");
    Ok(())
}

/// Means and standard deviations of three paths at each load: areas and stiffnesses change at events alone, approach and
/// mean gap are straight between two.
#[test]
fn gathered_columns_are_those_of_the_paths() -> Done {
    let folder = Scratch::new("ensemble-columns")?;
    let paths = "path --nodes 24 --max-area-fraction 0.2 --seeds 4..6 --out runs";
    assert!(output(&folder.0, paths)?.status.success());
    assert!(output(&folder.0, "gather runs --loads 7")?.status.success());
    let gathered = folder.join("runs/gather.csv");
    let mut runs: Vec<_> = fs::read_dir(folder.join("runs"))?.collect::<Result<_, _>>()?;
    runs.retain(|entry| entry.path().is_dir());
    let runs: Vec<_> = runs.iter().map(|run| run.path().join("path.csv")).collect();
    let names = fs::read_to_string(&gathered)?;
    let names = names.lines().next().map_or(0, |names| names.split(',').count());
    let at = numbers(&gathered, "load")?;
    assert_eq!((runs.len(), at.len(), names), (3, 7, 13));
    let loads: Vec<_> = runs.iter().map(|run| numbers(run, "load")).collect::<Result<_, _>>()?;
    for (name, is_straight) in [
        ("contact_area_fraction", false),
        ("corrected_contact_area", false),
        ("approach", true),
        ("mean_gap", true),
        ("contact_stiffness", false),
        ("interfacial_stiffness", false),
    ] {
        let columns: Vec<_> =
            runs.iter().map(|run| numbers(run, name)).collect::<Result<_, _>>()?;
        let [means, spreads] =
            ["mean", "std"].map(|what| numbers(&gathered, &format!("{name}_{what}")));
        for ((load, found_mean), found_spread) in at.iter().zip(means?).zip(spreads?) {
            let values = loads.iter().zip(&columns).map(|(loads, values)| {
                let last = loads.iter().rposition(|other| other <= load).unwrap_or(0);
                match loads.get(last + 1).filter(|_| is_straight) {
                    None => values[last],
                    Some(next) => {
                        let slope = (values[last + 1] - values[last]) / (next - loads[last]);
                        values[last] + slope * (load - loads[last])
                    }
                }
            });
            let [a, b, c] = values.collect::<Vec<_>>()[..] else { return Err("three".into()) };
            let mean = (a + b + c) / 3.0;
            // Half the sum of squares, by differences of pairs.
            let spread = (((a - b).powi(2) + (b - c).powi(2) + (c - a).powi(2)) / 6.0).sqrt();
            assert!((found_mean / mean - 1.0).abs() < 1e-12, "{name} at {load}: {found_mean:e}");
            assert!((found_spread - spread).abs() < 1e-12 * mean.abs(), "{name} at {load}");
        }
    }
    Ok(())
}

/// Lines for programs name their seeds; what is the same of all is said once.
#[test]
fn lines_of_many_paths_name_their_seeds() -> Done {
    let folder = Scratch::new("ensemble-lines")?;
    for (k, options) in
        ["--max-area-fraction 0.1", "--work-of-adhesion 0.05 --max-load 10"].into_iter().enumerate()
    {
        let line = format!("path --nodes 16 --short-cutoff 1.25mm {options} --json --out runs_{k}");
        let done = output(&folder.0, &format!("{line} --seeds 4..6"))?;
        assert!(done.status.success(), "{}", said(&done));
        let lines = String::from_utf8(done.stdout.clone())?;
        let objects = lines.lines().map(serde_json::from_str::<serde_json::Value>);
        let objects = objects.collect::<Result<Vec<_>, _>>()?;
        let seeds: Vec<_> = objects.iter().map(|object| object["seed"].as_u64()).collect();
        assert_eq!(seeds, [Some(4), Some(5), Some(6)]);
        assert_eq!(said(&done).matches("waves shorter than").count(), 1, "{}", said(&done));
        let alone = output(&folder.0, &format!("{line}_alone --seed 4"))?;
        assert!(!String::from_utf8(alone.stdout)?.contains("\"seed\""));
    }
    Ok(())
}

/// Maps of one specimen make a mean as seeds do, if all else is the same.
#[test]
fn measured_maps_of_one_specimen_are_gathered() -> Done {
    let folder = Scratch::new("ensemble-maps")?;
    for (name, shift) in [("1", 0), ("2", 5)] {
        let height = |ix: usize, iy: usize| 1e-7 * (1.7 * (7 * ix + 13 * iy + shift) as f64).sin();
        let map = DMatrix::from_fn(16, 16, height);
        write_npy(folder.join(&format!("{name}.npy")), &map)?;
        let line = format!(
            "path --surface {name}.npy --side 1mm --material steel --at 5MPa --out maps/{name}"
        );
        assert!(output(&folder.0, &line)?.status.success());
    }
    let told = String::from_utf8(output(&folder.0, "gather maps")?.stdout)?;
    assert!(told.contains("means of 2 paths"), "{told}");
    let other = "path --surface 1.npy --side 2mm --material steel --at 5MPa --out maps/3";
    assert!(output(&folder.0, other)?.status.success());
    is_refused(&output(&folder.0, "gather maps")?, &["grid.sides"]);
    Ok(())
}

/// However many seeds there are, those that are there are counted at once.
#[test]
fn all_seeds_there_are_can_be_asked_for() -> Done {
    let folder = Scratch::new("ensemble-all")?;
    let line = "path --nodes 32 --seeds 0..18446744073709551615 --dry-run --out runs";
    let start = Instant::now();
    let done = output(&folder.0, line)?;
    assert!(done.status.success(), "{}", said(&done));
    assert!(start.elapsed() < Duration::from_secs(20));
    let told = String::from_utf8(done.stdout)?;
    assert!(told.contains("18446744073709551616 paths to follow, 0 finished"), "{told}");
    for (task, count) in [
        ("--seeds 1..1000000000000 --task 3/7", "142857142857 paths"),
        ("--seeds 1..10 --task 0/3", "4 paths"),
        ("--seeds 1..10 --task 1/3", "3 paths"),
        ("--seeds 1..2 --task 5/7", "0 paths"),
        ("--seeds 18446744073709551615..18446744073709551615 --task 1/2", "0 paths"),
    ] {
        let done = output(&folder.0, &format!("path --nodes 32 {task} --dry-run --out runs"))?;
        let told = String::from_utf8(done.stdout)?;
        assert!(told.starts_with(count), "{task}: {told}");
    }
    Ok(())
}

/// The file says all that determines a path: of a generated surface, of one from a file, and of a record.
#[test]
fn settings_lie_beside_every_path() -> Done {
    let folder = Scratch::new("ensemble-settings")?;
    fs::copy(common::data("selfaffine_48.npy"), folder.join("input.npy"))?;
    for (line, words) in [
        (
            "path --nodes 32 --seed 7 --short-cutoff 2e-3 --periodic spectral --max-load 3 --record r.npz",
            &[
                "\"seed\": 7",
                "\"hurst\": 0.8",
                "\"half_space\": \"periodic, spectral kernel\"",
                "\"Load\": 3.0",
                "\"rule\": \"FirstContact\"",
                "\"updater\": \"auto\"",
                "\"e_star\": 230769230769.2",
                "\"short_cutoff_wavelength\": 0.002\n",
                "\"program\": \"asperity ",
            ][..],
        ),
        (
            "path --surface input.npy --side 1e-2 --material steel --against glass --level plane --max-load 1e-3",
            &[
                "\"file\": \"input.npy\"",
                "\"heights_md5\": \"",
                "\"level\": \"plane\"",
                "\"free\"",
                "0.22",
            ],
        ),
        (
            "path --resume r.npz --max-load 4",
            &["\"record\": \"r.npz\"", "\"heights_md5\": \"", "spectral", "\"Load\": 4.0"],
        ),
    ] {
        let done = output(&folder.0, line)?;
        assert!(done.status.success(), "{line}: {}", said(&done));
        let text = fs::read_to_string(folder.join("out/settings.json"))?;
        for word in words {
            assert!(text.contains(word), "{word} is not in {text}");
        }
    }
    Ok(())
}

/// A dry run of any path prints what it takes, as JSON too, and no file comes or changes. Nodes are those of the path.
/// Times and memory are compared with what was measured on two idle cores: within a factor of 3, and of 1.6.
#[test]
fn a_dry_run_estimates_and_writes_nothing() -> Done {
    let folder = Scratch::new("ensemble-dry")?;
    let surface = common::data("selfaffine_128.npy");
    let surface = format!("--surface {} --side 1e-2 --material steel", surface.display());
    // Nodes leave it again.
    let coat = "--layer steel,6e-4 --base 3e9,0.3";
    assert!(output(&folder.0, "path --nodes 32 --record r.npz")?.status.success());
    // Files as they are, and their number.
    let written = || -> std::io::Result<(Vec<Vec<u8>>, usize)> {
        let files = ["r.npz", "out/path.csv", "out/settings.json", "out/contact_map.png"];
        let files = files.map(|name| fs::read(folder.join(name)));
        Ok((files.into_iter().collect::<Result<_, _>>()?, fs::read_dir(&folder.0)?.count()))
    };
    let before = written()?;
    for (line, nodes, seconds, megabytes) in [
        ("--nodes 64 --max-area-fraction 1", 4096, 0.31, 105.0),
        ("--nodes 128", 1638, 0.10, 49.0),
        ("--nodes 128 --max-area-fraction 0.4", 6554, 1.23, 168.0),
        ("--nodes 256", 6554, 1.24, 211.0),
        ("--nodes 128 --periodic love --max-area-fraction 1", 16384, 5.5, 174.0),
        ("--nodes 128 --updater iterative", 1638, 0.83, 53.0),
        ("--nodes 128 --updater iterative --periodic love", 1638, 1.22, 46.0),
        ("--nodes 512 --max-area-fraction 0.01 --updater iterative", 2621, 3.08, 223.0),
        ("--nodes 512 --max-area-fraction 0.01", 2621, 0.36, 145.0),
        ("--nodes 128 --updater cholesky --max-area-fraction 0.4", 6554, 0.94, 233.0),
        ("--nodes 128 --hardness 2.5e9", 1638, 0.16, 40.0),
        ("--nodes 64 --hardness 2.5e9 --max-area-fraction 1", 4096, 0.16, 30.0),
        ("--nodes 128 --hardness 2e10 --max-area-fraction 0.3", 4915, 1.06, 64.0),
        ("--nodes 128 --mean-pressure 1e9", 951, 0.06, 42.0),
        ("--nodes 128 --max-area-fraction 0.4 --hardness 2.5e9 --unload", 6554, 1.58, 193.0),
        (&format!("{surface} --mean-pressure 2e9"), 1533, 0.09, 50.0),
        (&format!("{surface} --max-approach 1e-4"), 539, 0.05, 39.0),
        ("--resume r.npz --max-area-fraction 1", 1024, 0.06, 34.0),
        (
            &format!("--nodes 128 {coat} --max-area-fraction 0.1 --updater cholesky"),
            1638,
            3.1,
            55.0,
        ),
        (&format!("--nodes 256 {coat} --max-area-fraction 0.03"), 1966, 1.2, 77.0),
    ] {
        let done = output(&folder.0, &format!("path {line} --dry-run --json --out out"))?;
        assert!(done.status.success(), "{line}: {}", said(&done));
        let object: serde_json::Value = serde_json::from_slice(&done.stdout)?;
        let number = |name: &str| object[name].as_f64().ok_or_else(|| format!("{line}: no {name}"));
        assert_eq!(number("contact_nodes")?, f64::from(nodes), "{line}");
        let times = number("seconds")? / seconds;
        assert!((1.0 / 3.0..3.0).contains(&times), "{line}: {times} of the time");
        let memory = number("bytes")? / 1e6 / megabytes;
        assert!((0.6..1.6).contains(&memory), "{line}: {memory} of the memory");
        assert!(written()? == before, "{line} has written");
    }
    let done = output(&folder.0, "path --nodes 32 --dry-run")?;
    let told = String::from_utf8(done.stdout)?;
    assert!(
        told.starts_with("about 102 nodes in contact, ") && told.ends_with("of memory\n"),
        "{told}"
    );
    // What the path would refuse is refused.
    is_refused(&output(&folder.0, "path --nodes 32 --dry-run --unload")?, &["--hardness"]);
    assert!(written()? == before);
    Ok(())
}
