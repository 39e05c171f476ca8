//! Paths of surfaces that stick.

mod common;

use std::error::Error;
use std::fs;
use std::path::Path;

use asperity::ContactTarget;
use asperity::adhesion::{AdhesiveEvent, AdhesiveState, Direction};
use asperity::record::AdhesiveRecord;
use common::{Scratch, answer, is_refused, number, output, printed, run, said};
use nalgebra::DMatrix;
use serde_json::Value;

type Done = Result<(), Box<dyn Error>>;

/// A soft surface of 0.1 mm.
const SOFT: &str =
    "path --nodes 32 --side 100um --rolloff 50um --short-cutoff 25um --sq 2um --e-star 1MPa";
const STICKS: &str = "--work-of-adhesion 50mJ/m²";

/// The cells of a file by column.
struct Table(Vec<Vec<String>>);

impl Table {
    fn read(file: &Path) -> std::io::Result<Self> {
        let text = fs::read_to_string(file)?;
        Ok(Self(text.lines().map(|l| l.split(',').map(str::to_string).collect()).collect()))
    }

    fn words(&self, name: &str) -> Result<Vec<&str>, Box<dyn Error>> {
        let place = self.0[0].iter().position(|other| other == name);
        let place = place.ok_or_else(|| format!("no column {name}"))?;
        Ok(self.0[1..].iter().map(|line| line[place].as_str()).collect())
    }

    fn numbers(&self, name: &str) -> Result<Vec<f64>, Box<dyn Error>> {
        Ok(self.words(name)?.iter().map(|word| word.parse()).collect::<Result<_, _>>()?)
    }
}

/// What a loop costs is told of the last one, of a record that has two; and the pull of unloading begins where it does.
#[test]
fn the_last_loop_counts() -> Done {
    let folder = Scratch::new("adhesion_loops")?;
    let record = |name: &str| AdhesiveRecord::read_npz(folder.join(name));
    let line = format!("{SOFT} {STICKS} --mean-pressure 100 --unload --record first.npz");
    let first = answer(&folder.0, &line)?;
    run(&folder.0, "path --resume first.npz --mean-pressure 50 --record on.npz --out on")?;
    let turned = record("first.npz")?.states().states().len();
    let line = "path --resume on.npz --mean-pressure 50 --unload --record both.npz --out both";
    let second = answer(&folder.0, line)?;
    let both = record("both.npz")?;
    let states = both.states().states();
    let (before, loop_of) = (states[turned - 1], &states[turned..]);
    let lost = states[states.len() - 1].dissipated - before.dissipated;
    assert!((number(&second, "loop_energy") - lost).abs() <= 1e-15 * lost);
    // No jump lies between the two loads: sums of energies differ by rounding alone.
    assert!((lost / number(&first, "loop_energy") - 1.0).abs() < 1e-12, "{lost:e}");
    let jumps = loop_of.iter().filter(|state| state.event == AdhesiveEvent::JumpEnd).count();
    assert_eq!(second["jumps"], jumps);
    // Pressed on no further than to where nothing but pull is left.
    let line =
        format!("{SOFT} {STICKS} --max-approach=-0.5um --unload --record short.npz --out short");
    let short = answer(&folder.0, &line)?;
    let short_record = record("short.npz")?;
    let mut states = short_record.states().states().iter();
    let pressed = states.rfind(|state| state.direction == Direction::Loading);
    let pressed = pressed.ok_or("no loading")?;
    assert!(pressed.contact.load < 0.0);
    assert!(number(&short, "pull_off") >= -pressed.contact.load);
    Ok(())
}

/// A row of the file holds the numbers of the record, of which the library's tests say that they are right; the answer
/// for programs is read off them.
#[test]
fn files_have_both_branches() -> Done {
    let folder = Scratch::new("adhesion_both")?;
    let line = format!("{SOFT} {STICKS} --mean-pressure 100 --unload --record both.npz");
    let object = answer(&folder.0, &line)?;
    let table = Table::read(&folder.join("out/path.csv"))?;
    let record = AdhesiveRecord::read_npz(folder.join("both.npz"))?;
    let states = record.states().states();
    type Column = (&'static str, fn(&AdhesiveState) -> f64);
    let columns: [Column; 14] = [
        ("step", |s| s.step as f64),
        ("ix", |s| s.node.0 as f64),
        ("iy", |s| s.node.1 as f64),
        ("approach", |s| s.contact.approach),
        ("load", |s| s.contact.load),
        ("contact_area", |s| s.contact.contact_area),
        ("contact_area_fraction", |s| s.contact.contact_area_fraction),
        ("mean_gap", |s| s.contact.mean_gap),
        ("soft_nodes", |s| s.soft_nodes as f64),
        ("cohesive_nodes", |s| s.cohesive_nodes as f64),
        ("elastic_energy", |s| s.contact.energy),
        ("adhesive_energy", |s| s.adhesive_energy),
        ("dissipated", |s| s.dissipated),
        ("work", |s| s.work),
    ];
    for (name, get) in columns {
        let expected: Vec<f64> = states.iter().map(get).collect();
        assert!(table.numbers(name)? == expected, "{name}");
    }
    let branches = table.words("branch")?;
    let unloading = branches.iter().position(|branch| *branch == "unloading");
    let unloading = unloading.ok_or("no unloading")?;
    assert!(branches[unloading..].iter().all(|branch| *branch == "unloading"));
    assert_eq!(states[unloading].direction, Direction::Unloading);
    let pull = |states: &[AdhesiveState]| {
        -states.iter().map(|state| state.contact.load).fold(0.0, f64::min)
    };
    let [on, off] = [pull(&states[..unloading]), pull(&states[unloading..])];
    assert!(0.0 < on && on < off);
    assert_eq!([number(&object, "pull_in"), number(&object, "pull_off")], [on, off]);
    // To the very load, and all the way back.
    let (pressed, last) = (&states[unloading - 1], &states[states.len() - 1]);
    // 100 Pa on 0.1 mm × 0.1 mm.
    assert!((number(&object, "load") / 1e-6 - 1.0).abs() < 1e-15);
    assert_eq!(pressed.event, AdhesiveEvent::Limit);
    assert_eq!((last.contact.load, last.contact.contact_nodes, last.soft_nodes), (0.0, 0, 0));
    assert_eq!(number(&object, "loop_energy"), last.dissipated);
    let jumps = states.iter().filter(|state| state.event == AdhesiveEvent::JumpEnd).count();
    assert!(jumps > 0 && object["jumps"] == jumps);
    for name in ["loading_curve.svg", "contact_map.png", "settings.json"] {
        assert!(folder.join("out").join(name).is_file(), "{name}");
    }
    // The record goes on: pressed on again, the state of before.
    let mut path = record.path()?;
    path.load_to(asperity::ContactTarget::Load(pressed.contact.load))?;
    let again = path.run()?;
    let again = again.states().last().ok_or("no state")?;
    assert_eq!(again.contact.contact_nodes, pressed.contact.contact_nodes);
    // Both are at the end of a branch whose loads and approaches are exact to 1e-9 of the greatest.
    assert!((again.contact.approach / pressed.contact.approach - 1.0).abs() < 1e-9);
    // Without --unload there is no branch of it.
    let line = format!("{SOFT} {STICKS} --mean-pressure 100 --out on");
    let only = answer(&folder.0, &line)?;
    assert!(only["pull_off"].is_null() && only["loop_energy"].is_null());
    assert_eq!(number(&only, "pull_in"), on);
    Ok(())
}

/// The scalars of the object are those of the line of its state, at the end of loading and at a load on the way; the
/// approaches of the greatest pulls are those of the least loads, and energies are conserved.
#[test]
fn scalars_are_those_of_the_table() -> Done {
    let folder = Scratch::new("adhesion_scalars")?;
    let line = format!("{SOFT} {STICKS} --mean-pressure 100 --at 40 --unload --fields npy");
    let object = answer(&folder.0, &line)?;
    let table = Table::read(&folder.join("out/path.csv"))?;
    let (steps, branches) = (table.numbers("step")?, table.words("branch")?);
    assert_eq!(number(&object, "states"), steps.len() as f64);
    let on = branches.iter().filter(|branch| **branch == "loading").count();
    assert_eq!(number(&object, "step"), steps[on - 1]);
    for state in [&object, &object["at"][0]] {
        let row = steps.iter().position(|step| *step == number(state, "step")).ok_or("no line")?;
        for (name, column) in [
            ("load", "load"),
            ("contact_area", "contact_area"),
            ("contact_area_fraction", "contact_area_fraction"),
            ("approach", "approach"),
            ("mean_gap", "mean_gap"),
            ("contact_stiffness", "contact_stiffness"),
            ("interfacial_stiffness", "interfacial_stiffness"),
            ("soft_nodes", "soft_nodes"),
            ("cohesive_nodes", "cohesive_nodes"),
            ("energy", "elastic_energy"),
            ("adhesive_energy", "adhesive_energy"),
            ("dissipated", "dissipated"),
            ("work", "work"),
        ] {
            let expected: f64 = table.words(column)?[row].parse()?;
            let found = number(state, name);
            // What is read of decimals is right to the last digit but one.
            let is_near = (found - expected).abs() <= 1e-15 * expected.abs();
            assert!(is_near, "{name}: {expected} {state}");
        }
        // On 0.1 mm × 0.1 mm of 1024 cells.
        let pressure = number(state, "load") / 1e-8;
        assert!((number(state, "mean_pressure") / pressure - 1.0).abs() < 1e-12, "{state}");
        let nodes = 1024.0 * number(state, "contact_area_fraction");
        assert_eq!(number(state, "contact_nodes"), nodes.round());
        let [elastic, adhesive, lost, work] =
            ["energy", "adhesive_energy", "dissipated", "work"].map(|name| number(state, name));
        assert!(adhesive < 0.0 && lost >= 0.0, "{state}");
        let left = elastic + adhesive + lost - work;
        // Sums over all states, of parts that are greater than the work.
        assert!(left.abs() < 1e-7 * (elastic - adhesive), "{left} {state}");
    }
    let pressure = asperity::io::read_npy(folder.join("out/pressure.npy"))?;
    assert!((number(&object, "max_pressure") / pressure.max() - 1.0).abs() < 1e-12);
    let (loads, approaches) = (table.numbers("load")?, table.numbers("approach")?);
    for (name, rows) in [("pull_in", 0..on), ("pull_off", on..steps.len())] {
        let least = rows.min_by(|a, b| loads[*a].total_cmp(&loads[*b])).ok_or("no line")?;
        let found = number(&object, &format!("{name}_approach"));
        assert!((found - approaches[least]).abs() <= 1e-15 * found.abs(), "{name}: {object}");
        assert!((number(&object, name) + loads[least]).abs() <= 1e-15 * loads[least].abs());
    }
    Ok(())
}

/// The law on square cells of side s, whose compliance is 4 asinh(1) s/(π E*): a triangle has w under it, and Maugis'
/// law a slope of half of the stiffness of a cell about the gap w/σ.
#[test]
fn laws_are_told() -> Done {
    let folder = Scratch::new("adhesion_laws")?;
    let compliance = 4.0 * 1.0_f64.asinh() * 3.125e-6 / (std::f64::consts::PI * 1e6);
    let shortest = (2.0 * 0.05 * compliance / 0.45).sqrt();
    let slope = 50e3 * compliance;
    for (options, stress, [flat, range]) in [
        ("", 0.1 / shortest, [0.0, shortest]),
        ("--adhesion-range 1.2um", 0.1 / 1.2e-6, [0.0, 1.2e-6]),
        ("--cohesive-stress 50kPa", 50e3, [1e-6 - slope, 1e-6 + slope]),
        ("--cohesive-stress 50kPa --adhesion-range 1.5um", 50e3, [0.5e-6, 1.5e-6]),
    ] {
        let line = format!("{SOFT} {STICKS} --max-area-fraction 0.01 {options}");
        let law = &answer(&folder.0, &line)?["law"];
        for (name, expected) in [
            ("work", 0.05),
            ("stress", stress),
            ("flat_range", flat),
            ("range", range),
            ("resolution", stress / (range - flat) * compliance),
        ] {
            // Sums and roots of a few numbers; 0 is exactly that.
            let is_near = (number(law, name) - expected).abs() <= 1e-12 * expected;
            assert!(is_near, "{name}: {expected} {law}");
        }
    }
    Ok(())
}

/// On periodic cells the compliance is the mean of those of all waves, 2/(E*|q|), and of 0 for the uniform one.
#[test]
fn laws_of_periodic_cells_are_told() -> Done {
    let folder = Scratch::new("adhesion_periodic")?;
    let wave = |k: i32| std::f64::consts::TAU * f64::from(k) / 100e-6;
    let waves = (-15..=16).flat_map(|kx| (-15..=16).map(move |ky| (kx, ky)));
    let compliance = waves
        .filter(|k| *k != (0, 0))
        .map(|(kx, ky)| 2.0 / (1e6 * wave(kx).hypot(wave(ky))) / 1024.0)
        .sum::<f64>();
    let line = format!("{SOFT} {STICKS} --periodic spectral --mean-pressure 20 --unload");
    let object = answer(&folder.0, &line)?;
    let law = &object["law"];
    let shortest = (2.0 * 0.05 * compliance / 0.45).sqrt();
    for (name, expected) in
        [("work", 0.05), ("range", shortest), ("stress", 0.1 / shortest), ("resolution", 0.45)]
    {
        assert!((number(law, name) / expected - 1.0).abs() < 1e-12, "{name}: {expected} {law}");
    }
    assert!(number(&object, "pull_off") > 0.0 && number(&object, "loop_energy") > 0.0, "{object}");
    Ok(())
}

/// A sphere takes 3πwR/2 in the limit of JKR. With 10 cells in the radius of its contact at pull-off the force is 4 %
/// too great, as the library says of its law; with 6 of them as here it is some 6 %, and twice that would be wrong.
#[test]
fn a_sphere_is_pulled_off() -> Done {
    let folder = Scratch::new("adhesion_sphere")?;
    let radius = 1e-4;
    // Not on a node, so that no two nodes are alike.
    let height = |ix: usize, iy: usize| {
        let (x, y) = (2e-6 * (ix as f64 - 15.3), 2e-6 * (iy as f64 - 15.6));
        -0.5 * (x * x + y * y) / radius
    };
    asperity::io::write_npy(folder.join("sphere.npy"), &DMatrix::from_fn(32, 32, height))?;
    let line = format!(
        "path --surface sphere.npy --side 64um --e-star 1MPa {STICKS} --max-load 5e-6 --unload"
    );
    let object = answer(&folder.0, &line)?;
    let jkr = 1.5 * std::f64::consts::PI * 0.05 * radius;
    let ratio = number(&object, "pull_off") / jkr;
    assert!(1.0 < ratio && ratio < 1.12, "{ratio}: {object}");
    Ok(())
}

/// States that are asked for are exact, with maps and fields of their own.
#[test]
fn states_are_those_that_are_asked_for() -> Done {
    let folder = Scratch::new("adhesion_at")?;
    let line = format!("{SOFT} {STICKS} --mean-pressure 200 --at 50Pa,12%,150 --fields npy");
    let object = answer(&folder.0, &line)?;
    let at = object["at"].as_array().ok_or("no states")?;
    let loads: Vec<f64> = at.iter().map(|state| number(state, "mean_pressure")).collect();
    // An area that is reached in a jump is that behind it.
    assert!((number(&at[0], "contact_area_fraction") - 0.12).abs() < 0.02, "{at:?}");
    let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-14;
    assert!(near(loads[1], 50.0) && near(loads[2], 150.0), "{loads:?}");
    for name in ["50Pa", "150Pa", "12%"] {
        assert!(folder.join(&format!("out/contact_map_{name}.png")).is_file(), "{name}");
        assert!(folder.join(&format!("out/pressure_{name}.npy")).is_file(), "{name}");
    }
    // The load is the sum of the pressures.
    let pressure = asperity::io::read_npy(folder.join("out/pressure_50Pa.npy"))?;
    assert!(pressure.min() < 0.0);
    // Pressures of both signs that are a thousand times the mean, each to 1e-12.
    assert!((pressure.mean() / 50.0 - 1.0).abs() < 1e-7, "{}", pressure.mean());
    let missed = format!("{SOFT} {STICKS} --mean-pressure 200 --at 50Pa,90%");
    let done = output(&folder.0, &missed)?;
    is_refused(&done, &["the path has no state at 90 %"]);
    Ok(())
}

/// Surfaces that stick meet before they would touch: a path may end there, and a record goes on from there.
#[test]
fn paths_end_at_approaches_below_zero() -> Done {
    let folder = Scratch::new("adhesion_approach")?;
    let before =
        answer(&folder.0, &format!("{SOFT} {STICKS} --max-approach -0.2um --record r.npz"))?;
    assert_eq!(number(&before, "approach"), -0.2e-6);
    assert_eq!(before["ended_by"], "the requested approach");
    assert!(number(&before, "contact_nodes") > 0.0 && number(&before, "load") < 0.0, "{before}");
    let on = answer(&folder.0, "path --resume r.npz --max-approach 0 --out on")?;
    assert_eq!(number(&on, "approach"), 0.0);
    let once = answer(&folder.0, &format!("{SOFT} {STICKS} --max-approach 0"))?;
    assert!((number(&on, "load") / number(&once, "load") - 1.0).abs() < 1e-8, "{on} {once}");
    let dry = answer(&folder.0, &format!("{SOFT} {STICKS} --max-approach 0 --dry-run"))?;
    assert_eq!(number(&dry, "contact_nodes"), 0.0);
    // Before the first node is pulled there is no path.
    for way in ["", "--dry-run"] {
        let far = output(&folder.0, &format!("{SOFT} {STICKS} --max-approach -5um {way}"))?;
        is_refused(&far, &["the path is at", "already"]);
        let elastic = output(&folder.0, &format!("{SOFT} --max-approach -0.2um {way}"))?;
        is_refused(&elastic, &["--max-approach -200 nm must be positive"]);
    }
    Ok(())
}

/// A record goes on to another end, and back: what comes out is what comes of one go.
#[test]
fn records_go_on() -> Done {
    let folder = Scratch::new("adhesion_resumed")?;
    let on = format!("{SOFT} {STICKS} --mean-pressure 50 --record r.npz");
    run(&folder.0, &on)?;
    let again = "path --resume r.npz --mean-pressure 100 --unload --out again";
    let again = answer(&folder.0, again)?;
    let once = answer(&folder.0, &format!("{SOFT} {STICKS} --mean-pressure 100 --unload"))?;
    // The state at 50 Pa is one more.
    assert_eq!(number(&again, "states"), number(&once, "states") + 1.0);
    // Windows begin elsewhere: rounding.
    for name in ["pull_in", "pull_off", "loop_energy", "approach", "mean_gap", "work"] {
        let [found, expected] = [&again, &once].map(|object| number(object, name));
        assert!((found / expected - 1.0).abs() < 1e-8, "{name}: {found} {expected}");
    }
    let rows = Table::read(&folder.join("again/path.csv"))?.words("step")?.len();
    assert_eq!(AdhesiveRecord::read_npz(folder.join("r.npz"))?.states().states().len(), rows);
    Ok(())
}

/// Without an end on the command line the loading of a record goes on to its own, and not at all if it is there.
#[test]
fn records_go_on_to_their_own_ends() -> Done {
    let folder = Scratch::new("adhesion_own_end")?;
    run(&folder.0, &format!("{SOFT} {STICKS} --mean-pressure 50 --unload --record both.npz"))?;
    run(&folder.0, &format!("{SOFT} {STICKS} --mean-pressure 50 --record r.npz"))?;
    for name in ["r.npz", "both.npz"] {
        let before = AdhesiveRecord::read_npz(folder.join(name))?.states().states().len();
        let line = format!("path --resume {name} --out again");
        let words = printed(&run(&folder.0, &line)?);
        assert!(words.contains("the end of loading in the record"), "{words}");
        assert!(!words.contains("of the nominal area"), "{words}");
        let after = AdhesiveRecord::read_npz(folder.join(name))?.states().states().len();
        assert_eq!(before, after, "{name}");
    }
    let record = AdhesiveRecord::read_npz(folder.join("r.npz"))?;
    let mut path = record.path()?;
    path.load_to(ContactTarget::MeanPressure(100.0))?;
    let more = path.by_ref().take(5).collect::<Result<Vec<_>, _>>()?;
    let states = record.states().states().iter().copied().chain(more).collect();
    AdhesiveRecord::new(&path, states)?.write_npz(folder.join("own.npz"), &[])?;
    let on = answer(&folder.0, "path --resume own.npz --out own")?;
    assert!((number(&on, "mean_pressure") / 100.0 - 1.0).abs() < 1e-12, "{on}");
    // One that was on its way back may go on with that, or turn around.
    let record = AdhesiveRecord::read_npz(folder.join("r.npz"))?;
    let mut path = record.path()?;
    path.unload()?;
    let more = path.by_ref().take(5).collect::<Result<Vec<_>, _>>()?;
    let states = record.states().states().iter().copied().chain(more).collect();
    AdhesiveRecord::new(&path, states)?.write_npz(folder.join("back.npz"), &[])?;
    is_refused(&output(&folder.0, "path --resume back.npz --out back")?, &["--unload"]);
    run(&folder.0, "path --resume back.npz --out back --unload")?;
    Ok(())
}

/// A record that has passed some of the states that are asked for goes on to the others; one that has no state there
/// says so, and so does one that is beyond where the path is to end.
#[test]
fn records_know_the_states_that_they_have_passed() -> Done {
    let folder = Scratch::new("adhesion_resumed_at")?;
    let on = format!("{SOFT} {STICKS} --mean-pressure 50 --at 20 --record r.npz");
    run(&folder.0, &on)?;
    let further = "path --resume r.npz --record s.npz --mean-pressure 100 --at 20,70 --out again";
    let further = answer(&folder.0, further)?;
    let pressures = further["at"].as_array().ok_or("no states")?.iter();
    let pressures: Vec<f64> = pressures.map(|state| number(state, "mean_pressure")).collect();
    assert_eq!(pressures.len(), 2, "{further}");
    for (found, asked) in pressures.iter().zip([20.0, 70.0]) {
        assert!((found / asked - 1.0).abs() < 1e-12, "{pressures:?}");
    }
    for (options, words) in [
        ("--mean-pressure 100 --at 30", &["the record has passed", "30", "no state there"][..]),
        ("--mean-pressure 70 --unload", &["the record is beyond", "state"]),
        ("--mean-pressure 80", &["the record has passed", "80", "no state there"]),
        ("--mean-pressure 200 --memory-budget 1e5", &["budget"]),
    ] {
        for way in ["", "--dry-run"] {
            let line = format!("path --resume s.npz --record t.npz {options} --out refused {way}");
            is_refused(&output(&folder.0, &line)?, words);
        }
    }
    assert!(!folder.join("refused/settings.json").exists());
    // Where nobody says where the path ends, it ends with the record.
    let at_20 = |object: &Value| (number(&object["at"][0], "mean_pressure") / 20.0 - 1.0).abs();
    let read = answer(&folder.0, "path --resume s.npz --record t.npz --at 20 --out read")?;
    assert!(at_20(&read) < 1e-12, "{read}");
    assert!((number(&read, "mean_pressure") / 100.0 - 1.0).abs() < 1e-12, "{read}");
    assert_eq!(read["ended_by"], "the end of loading in the record");
    assert!(folder.join("read/contact_map_20Pa.png").is_file());
    // One that was unloading has the states of before.
    run(&folder.0, "path --resume s.npz --record u.npz --mean-pressure 100 --unload --out back")?;
    let back = "path --resume u.npz --mean-pressure 100 --at 20 --unload --out again";
    let back = answer(&folder.0, back)?;
    assert!(at_20(&back) < 1e-12, "{back}");
    assert_eq!(back["ended_by"], "the requested load");
    let beyond = "path --resume u.npz --record t.npz --mean-pressure 70 --unload --out refused";
    is_refused(&output(&folder.0, beyond)?, &["the record is beyond"]);
    // On its way back it does not come to a further end, and pressed on again it does.
    for way in ["", "--dry-run"] {
        let further = "path --resume u.npz --record t.npz --mean-pressure 150 --out refused";
        let refused = output(&folder.0, &format!("{further} --unload {way}"))?;
        is_refused(&refused, &["on its way back", "has not come to a load of 1.5 µN"]);
    }
    // Pressed on again it comes to a state once more.
    let on = answer(&folder.0, "path --resume u.npz --mean-pressure 50 --at 30 --out on")?;
    assert!((number(&on["at"][0], "mean_pressure") / 30.0 - 1.0).abs() < 1e-12, "{on}");
    Ok(())
}

/// Behind full contact loads go on, so that a record on its way back has not come to a greater one; without adhesion
/// its branch has ended there.
#[test]
fn records_that_came_to_full_contact_do_not_have_every_load() -> Done {
    let folder = Scratch::new("adhesion_full")?;
    let soft = SOFT.replace("--sq 2um", "--sq 1um");
    for (work, is_there) in [("0.05", false), ("0", true)] {
        let record = format!("--max-load 5mN --unload --record r{work}.npz --out out{work}");
        let full = answer(&folder.0, &format!("{soft} --work-of-adhesion {work} {record}"))?;
        assert_eq!(number(&full, "contact_area_fraction"), 1.0, "{full}");
        run(&folder.0, &format!("path --resume r{work}.npz --max-load 5mN --unload --out same"))?;
        let further = format!("path --resume r{work}.npz --max-load 8mN --unload --out further");
        let done = output(&folder.0, &further)?;
        match is_there {
            true => assert!(done.status.success(), "{}", said(&done)),
            false => is_refused(&done, &["on its way back", "has not come to a load of 8 mN"]),
        }
    }
    Ok(())
}

#[test]
fn what_does_not_go_with_adhesion_is_refused() -> Done {
    let folder = Scratch::new("adhesion_refused")?;
    let small = "path --nodes 16 --work-of-adhesion 0.05";
    for (options, words) in [
        ("--hardness 1e9", "is not derived"),
        ("--yield", "is not derived"),
        ("--updater iterative", "factor"),
        ("--rule approximate-order", "order of nodes"),
        ("--report", "only grows"),
        ("--conductivity 50,237", "only presses"),
        ("--fe-table csv", "only presses"),
        ("--layer steel,6e-4 --base 3e9,0.3", "may open a gap"),
        ("--adhesion-range 1nm", "It takes cells of"),
        ("--cohesive-stress 1000GPa", "it takes cells of"),
        ("--cohesive-stress 1MPa --adhesion-range 1nm", "range of adhesion"),
        ("--memory-budget 1e5", "budget"),
    ] {
        for way in ["", "--dry-run"] {
            let done = output(&folder.0, &format!("{small} {options} {way}"))?;
            is_refused(&done, &[words]);
        }
    }
    for options in ["--adhesion-range 1um", "--cohesive-stress 1MPa"] {
        let done = output(&folder.0, &format!("path --nodes 16 {options}"))?;
        assert_eq!(done.status.code(), Some(2), "{options}");
        assert!(said(&done).contains("--work-of-adhesion"), "{}", said(&done));
    }
    is_refused(&output(&folder.0, "path --nodes 16 --unload")?, &["--work-of-adhesion"]);
    // What follows from contact that only grows.
    let line = format!("{SOFT} {STICKS} --mean-pressure 50 --record r.npz");
    run(&folder.0, &line)?;
    for command in [
        "report r.npz",
        "patches r.npz",
        "slip r.npz --friction 0.3 --material steel",
        "leak r.npz --viscosity 1e-3 --pressure-drop 1e5 --along x",
        "stress r.npz",
        "creep r.npz --prony 1,0.5 --load 1 --time 1e3",
    ] {
        is_refused(&output(&folder.0, command)?, &["with adhesion", "only grows"]);
    }
    Ok(())
}

/// The range of the cells is 0.62 µm at 64 nodes a side and 0.88 µm at 32, where k C(0,0) is 0.45.
#[test]
fn what_the_cells_do_not_resolve_is_said() -> Done {
    let folder = Scratch::new("adhesion_warned")?;
    let warns = |options: &str, words: &str| -> Result<bool, Box<dyn Error>> {
        let line = format!("{SOFT} {STICKS} --mean-pressure 50 {options}");
        let object = answer(&folder.0, &line)?;
        let warnings = object["warnings"].as_array().ok_or("no warnings")?.clone();
        Ok(warnings.iter().any(|text| text.as_str().is_some_and(|text| text.contains(words))))
    };
    assert!(!warns("", "snap one by one")?);
    // (0.88/0.76)² · 0.45 = 0.6
    assert!(warns("--adhesion-range 0.76um", "snap one by one")?);
    assert!(warns("", "the highest summit")?);
    // One wave of 0.1 mm in each direction, 0.5 µm high.
    let smooth = "path --nodes 32 --side 100um --rolloff 100um --short-cutoff 100um --sq 0.5um --e-star 1MPa";
    let object = answer(&folder.0, &format!("{smooth} {STICKS} --mean-pressure 50"))?;
    assert_eq!(object["warnings"], Value::Array(Vec::new()));
    let object = answer(&folder.0, &format!("{SOFT} {STICKS} --mean-pressure 50"))?;
    assert!((number(&object["law"], "resolution") - 0.45).abs() < 1e-12);
    let maugis = format!("{SOFT} {STICKS} --cohesive-stress 50kPa --mean-pressure 50");
    let law = &answer(&folder.0, &maugis)?["law"];
    assert!((number(law, "stress") / 50e3 - 1.0).abs() < 1e-12 && number(law, "flat_range") > 0.0);
    Ok(())
}

/// Both branches take longer than one, and than without adhesion; the contact of an area is known.
#[test]
fn what_it_takes_is_estimated() -> Done {
    let folder = Scratch::new("adhesion_dry_run")?;
    let dry = format!("{SOFT} --max-area-fraction 0.25 --dry-run");
    let elastic = answer(&folder.0, &dry)?;
    let on = answer(&folder.0, &format!("{dry} {STICKS}"))?;
    let both = answer(&folder.0, &format!("{dry} {STICKS} --unload"))?;
    assert_eq!(number(&both, "contact_nodes"), 256.0);
    let seconds = [&elastic, &on, &both].map(|object| number(object, "seconds"));
    assert!(seconds[0] < seconds[1] && seconds[1] < seconds[2], "{seconds:?}");
    assert!(number(&on, "bytes") > number(&elastic, "bytes"));
    assert!(!folder.join("out").exists());
    Ok(())
}

/// A path of `--seeds` is that of its seed alone, and the force of each surface is printed.
#[test]
fn many_surfaces_are_pulled_off() -> Done {
    let folder = Scratch::new("adhesion_seeds")?;
    let line = format!("{SOFT} {STICKS} --mean-pressure 50 --unload");
    let done = run(&folder.0, &format!("{line} --seeds 1..2 --out runs"))?;
    let printed = String::from_utf8(done.stdout)?;
    assert!(printed.contains("pull-off") && printed.contains("loop"), "{printed}");
    run(&folder.0, &format!("{line} --seed 2 --out alone"))?;
    let [one, other] =
        ["runs/seed_2", "alone"].map(|of| fs::read(folder.join(of).join("path.csv")));
    assert!(one? == other?);
    is_refused(&output(&folder.0, "gather runs")?, &["with adhesion"]);
    Ok(())
}
