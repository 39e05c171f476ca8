//! `asperity patches` on the record of a small path to full contact.

mod common;

use std::error::Error;
use std::fs;
use std::process::{Command, Output};

use asperity::record::LoadingRecord;
use common::{Scratch, answer, column, number, numbers, run};

fn asperity(folder: &Scratch, arguments: &[&str]) -> std::io::Result<Output> {
    let mut program = Command::new(env!("CARGO_BIN_EXE_asperity"));
    program.current_dir(&folder.0).args(arguments).output()
}

/// In full contact of a periodic surface there is one patch of all nodes without an edge, so that nothing is to be
/// corrected, and at first touch there is one of one node.
#[test]
fn a_path_to_full_contact_ends_in_one_patch() -> Result<(), Box<dyn Error>> {
    let folder = Scratch::new("patches")?;
    let made = asperity(
        &folder,
        &[
            "path",
            "--nodes",
            "16",
            "--periodic",
            "love",
            "--max-area-fraction",
            "1",
            "--record",
            "path.npz",
        ],
    )?;
    assert!(made.status.success());
    let done =
        asperity(&folder, &["patches", "path.npz", "--out", "seen", "--at-area-fraction", "0.3"])?;
    assert!(done.status.success());
    let said = String::from_utf8(done.stdout)?;
    for passage in ["percolates along x", "percolates along y", "seals along x", "seals along y"] {
        let line = said.lines().find(|line| line.starts_with(passage));
        assert!(line.is_some_and(|line| line.contains("from state")), "{said}");
    }

    let seen = folder.join("seen");
    let table = fs::read_to_string(seen.join("patches.csv"))?;
    let lines: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(lines.len(), 1 + 16 * 16);
    let [names, first, .., last] = &lines[..] else {
        return Err("no states".into());
    };
    let column = |line: &[&str], name: &str| -> Result<String, Box<dyn Error>> {
        let place = names.iter().position(|other| *other == name).ok_or("no column")?;
        Ok(line.get(place).ok_or("no cell")?.to_string())
    };
    assert_eq!(column(first, "patches")?, "1");
    assert_eq!(column(first, "event")?, "birth");
    assert_eq!(column(last, "patches")?, "1");
    assert_eq!(column(last, "largest_patch")?, "256");
    assert_eq!(column(last, "perimeter")?.parse::<f64>()?, 0.0);
    assert_eq!(column(last, "corrected_area_fraction")?.parse::<f64>()?, 1.0);

    for picture in ["patches", "activation", "merge_tree", "distributions"] {
        let bytes = fs::read(seen.join(picture).with_extension("png"))?;
        assert!(bytes.starts_with(b"\x89PNG"), "{picture}");
    }

    let beyond = asperity(&folder, &["patches", "path.npz", "--at-area-fraction", "0.001"])?;
    assert!(!beyond.status.success());
    Ok(())
}

/// Charts are of the format that is asked for; Persson's theory is elastic, and drawn beside no contact that yields.
#[test]
fn charts_of_contacts_that_yield_have_no_elastic_theory() -> Result<(), Box<dyn Error>> {
    let folder = Scratch::new("patches_yield")?;
    for (record, hardness, is_elastic) in
        [("elastic.npz", "", true), ("plastic.npz", "--hardness 1e9", false)]
    {
        let path = "path --nodes 16 --periodic love --mean-pressure 1e8 -q";
        run(&folder.0, &format!("{path} {hardness} --record {record}"))?;
        run(&folder.0, &format!("patches {record} --charts svg --out seen"))?;
        let chart = |name: &str| fs::read_to_string(folder.join("seen").join(name));
        assert_eq!(chart("distributions.svg")?.contains("Persson"), is_elastic);
        assert!(chart("merge_tree.svg")?.contains("first node"));
        assert!(!folder.join("seen/merge_tree.png").exists());
    }
    Ok(())
}

/// A path that has only touched has an answer for programs too. What is advised names the record as a shell reads it.
#[test]
fn a_path_without_load_is_told() -> Result<(), Box<dyn Error>> {
    let folder = Scratch::new("patches_touch")?;
    let name = "it's one.npz";
    let path = ["path", "--nodes", "16", "--max-area-fraction", "0.004", "--record", name];
    assert!(asperity(&folder, &path)?.status.success());
    let done = asperity(&folder, &["patches", name, "--json"])?;
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let object: serde_json::Value = serde_json::from_slice(&done.stdout)?;
    assert_eq!((&object["states"], &object["patches"]), (&1.into(), &1.into()), "{object}");
    assert_eq!(object["state"]["load"], 0.0);
    assert!(!folder.join("out/patches.csv").exists(), "an object alone was asked for");
    assert!(object["seals_x"].is_null() && object["channel_x"].is_object(), "{object}");
    let said = String::from_utf8(asperity(&folder, &["patches", name])?.stdout)?;
    assert!(said.contains("no node has touched under load"), "{said}");
    assert!(said.contains(r"--resume 'it'\''s one.npz' --record 'it'\''s one.npz'"), "{said}");
    assert!(said.contains("1 patch; the largest has 1 node, "), "{said}");
    assert!(said.contains("carries nothing yet") && said.contains("the widest channel"), "{said}");
    Ok(())
}

/// A load behind the only event: the patch that carries it is described, though no node has touched under load.
#[test]
fn a_load_on_the_first_node_is_described() -> Result<(), Box<dyn Error>> {
    let folder = Scratch::new("patches_one")?;
    let path = ["path", "--nodes", "16", "--max-load", "1uN", "--record", "one.npz"];
    assert!(asperity(&folder, &path)?.status.success());
    let said = String::from_utf8(asperity(&folder, &["patches", "one.npz"])?.stdout)?;
    assert!(said.contains("no loads of activation to draw"), "{said}");
    assert!(said.contains("carries 1 µN (100.00 %)"), "{said}");
    assert!(folder.join("out/distributions.png").is_file());
    Ok(())
}

/// Nodes a side, of which node (ix, iy) is ix + SIDE iy.
const SIDE: usize = 16;

/// The nodes that share a side of their cells with one; the grid may be joined along x and along y.
fn neighbours(node: usize, [along_x, along_y]: [bool; 2]) -> Vec<usize> {
    let (ix, iy) = (node % SIDE, node / SIDE);
    let beside = |place: usize, joined: bool| {
        let before = place.checked_sub(1).or(joined.then_some(SIDE - 1));
        let after = Some(place + 1).filter(|place| *place < SIDE).or(joined.then_some(0));
        before.into_iter().chain(after)
    };
    let of_row = beside(ix, along_x).map(|ix| ix + SIDE * iy);
    let of_column = beside(iy, along_y).map(|iy| ix + SIDE * iy);
    of_row.chain(of_column).collect()
}

/// The patches of a map, each found by going from neighbour to neighbour.
fn patches_of(map: &[bool], joined: [bool; 2]) -> Vec<Vec<usize>> {
    let mut seen = vec![false; map.len()];
    let mut found = Vec::new();
    for (start, is_there) in map.iter().enumerate() {
        if !is_there || std::mem::replace(&mut seen[start], true) {
            continue;
        }
        let (mut patch, mut next) = (vec![start], 0);
        while let Some(&node) = patch.get(next) {
            next += 1;
            for other in neighbours(node, joined) {
                if map[other] && !std::mem::replace(&mut seen[other], true) {
                    patch.push(other);
                }
            }
        }
        found.push(patch);
    }
    found
}

/// Whether a patch of a map leads from end to end along x (0) or y (1); only the border across may be joined.
fn leads(map: &[bool], axis: usize, is_joined: bool) -> bool {
    let joined = [is_joined && axis == 1, is_joined && axis == 0];
    let place = |node: &usize| if axis == 0 { node % SIDE } else { node / SIDE };
    let is_at = |patch: &[usize], end: usize| patch.iter().any(|node| place(node) == end);
    patches_of(map, joined).iter().any(|patch| is_at(patch, 0) && is_at(patch, SIDE - 1))
}

/// The object is what a walk from neighbour to neighbour finds in the order of contact of path.csv: patches, channels,
/// the states at which the first of them lead from end to end, and what the largest patch carries of the pressure.
#[test]
fn the_object_is_what_a_walk_finds() -> Result<(), Box<dyn Error>> {
    let folder = Scratch::new("patches-walk")?;
    for (file, boundary, is_joined) in
        [("free.npz", "", false), ("periodic.npz", "--periodic love", true)]
    {
        let line = format!("path --nodes 16 {boundary} --e-star 1e11 --max-area-fraction 0.7 -q");
        run(&folder.0, &format!("{line} --record {file} --out path"))?;
        let line = format!("patches {file} --at-area-fraction 0.35 --out seen");
        let object = answer(&folder.0, &line)?;

        let table = folder.join("path/path.csv");
        let loads = numbers(&table, "load")?;
        assert_eq!(number(&object, "states"), loads.len() as f64);
        let (ix, iy) = (numbers(&table, "ix")?, numbers(&table, "iy")?);
        let events = column(&table, "event")?;
        let touches: Vec<usize> = (0..events.len()).filter(|k| events[*k] == "touch").collect();
        let mut maps = Vec::new();
        let mut map = vec![false; SIDE * SIDE];
        for &row in &touches {
            map[ix[row] as usize + SIDE * iy[row] as usize] = true;
            maps.push(map.clone());
        }
        let open = |map: &[bool]| map.iter().map(|is_there| !is_there).collect::<Vec<_>>();
        for (axis, name) in ["x", "y"].into_iter().enumerate() {
            let percolates = maps.iter().position(|map| leads(map, axis, is_joined));
            let seals = maps.iter().position(|map| !leads(&open(map), axis, is_joined));
            for (what, expected) in [("percolates", percolates), ("seals", seals)] {
                let found = &object[format!("{what}_{name}")];
                let row = expected.map(|place| touches[place]);
                // Steps count from 1.
                let step = row.map(|row| row as u64 + 1);
                assert_eq!(found["step"].as_u64(), step, "{boundary}: {what} along {name}");
                if let Some(row) = row {
                    assert!((number(found, "load") / loads[row] - 1.0).abs() < 1e-14, "{found}");
                }
            }
            assert_eq!(object.get(format!("patch_winds_{name}")).is_some(), is_joined);
        }
        assert!(object["percolates_x"].is_object() || object["percolates_y"].is_object());

        // 0.35 of 256 nodes.
        let (state, map) = (&object["state"], &maps[88]);
        assert_eq!(state["step"].as_u64(), Some(touches[88] as u64 + 1));
        assert_eq!(number(state, "contact_area_fraction"), 89.0 / 256.0);
        let load = loads[touches[88]];
        assert!((number(state, "load") / load - 1.0).abs() < 1e-14);
        // On 1 cm².
        assert!((number(state, "mean_pressure") / (1e4 * load) - 1.0).abs() < 1e-12);
        let gap = numbers(&table, "mean_gap")?[touches[88]];
        assert!((number(state, "mean_gap") / gap - 1.0).abs() < 1e-14);

        let found = patches_of(map, [is_joined; 2]);
        let most = found.iter().map(Vec::len).max().ok_or("no patch")?;
        let largest = &object["largest_patch"];
        assert_eq!(number(&object, "patches"), found.len() as f64);
        assert_eq!(number(largest, "nodes"), most as f64);
        let patches = folder.join("seen/patches.csv");
        assert_eq!(numbers(&patches, "patches")?[touches[88]], found.len() as f64);
        assert_eq!(numbers(&patches, "largest_patch")?[touches[88]], most as f64);
        let cell = 1e-4 / 256.0;
        let area = most as f64 * cell;
        assert!((number(largest, "area") / area - 1.0).abs() < 1e-12, "{largest}");

        let record = LoadingRecord::read_npz(folder.join(file))?;
        let state = record.history().at_area_fraction(0.35).ok_or("no state")?;
        let fields = record.replay()?.fields_at(&state)?;
        // Of several patches of that size any may be the one.
        let carried = number(largest, "load");
        let mut sums = found.iter().filter(|patch| patch.len() == most).map(|patch| {
            patch.iter().map(|node| cell * fields.pressure.as_slice()[*node]).sum::<f64>()
        });
        assert!(sums.any(|sum| (carried / sum - 1.0).abs() < 1e-12), "{largest}");
        assert!((number(largest, "mean_pressure") * area / carried - 1.0).abs() < 1e-12);

        // Gaps as wide as the narrowest one lead through, and wider ones alone do not.
        for (axis, name) in ["x", "y"].into_iter().enumerate() {
            let channel = &object[format!("channel_{name}")];
            let wide = |least: f64| -> Vec<bool> {
                let gaps = fields.gap.as_slice().iter().zip(map);
                gaps.map(|(gap, is_there)| !is_there && *gap >= least).collect()
            };
            assert_eq!(channel.is_null(), !leads(&open(map), axis, is_joined));
            if !channel.is_null() {
                let gap = number(channel, "gap");
                assert!(leads(&wide(gap * (1.0 - 1e-9)), axis, is_joined), "{channel}");
                assert!(!leads(&wide(gap * (1.0 + 1e-9)), axis, is_joined), "{channel}");
                let [ix, iy] = [0_usize, 1].map(|k| channel["node"][k].as_u64());
                let (ix, iy) = (ix.ok_or("no node")? as usize, iy.ok_or("no node")? as usize);
                assert!((fields.gap[(ix, iy)] / gap - 1.0).abs() < 1e-12, "{channel}");
            }
        }
    }
    Ok(())
}
