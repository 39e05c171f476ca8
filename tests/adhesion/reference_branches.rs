//! Both branches against events of a solver that shares no code with this crate and solves each with a fresh dense
//! inverse.

use std::path::{Path, PathBuf};

use asperity::adhesion::{Adhesion, AdhesiveEvent, AdhesivePath, AdhesiveState, Direction};
use asperity::io::read_npy;
use asperity::surface::HeightMap;
use asperity::{
    Boundary, Boussinesq, ContactGrowth, ContactTarget, Grid, InfluenceKernel, KernelTable,
    PeriodicBoussinesq, Spectral,
};

/// An event on record.
#[derive(Debug)]
struct Truth {
    kind: String,
    direction: Direction,
    node: (i64, i64),
    approach: f64,
    load: f64,
    contact_nodes: usize,
    pulled: usize,
    mean_gap: f64,
    energies: [f64; 4],
}

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/adhesion").join(name)
}

fn read(name: &str) -> Vec<Truth> {
    let text = std::fs::read_to_string(data(&format!("{name}_events.csv"))).unwrap();
    let events = text.lines().skip(1).map(|line| {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |k: usize| fields[k].parse::<f64>().unwrap();
        let count = |k: usize| fields[k].parse::<usize>().unwrap();
        let place = |k: usize| fields[k].parse::<i64>().unwrap();
        Truth {
            direction: if fields[0] == "loading" {
                Direction::Loading
            } else {
                Direction::Unloading
            },
            kind: fields[1].to_string(),
            node: (place(2), place(3)),
            approach: number(4),
            load: number(5),
            contact_nodes: count(6),
            pulled: count(7) - count(6),
            mean_gap: number(8),
            energies: [9, 10, 11, 12].map(number),
        }
    });
    events.collect()
}

fn kind(event: AdhesiveEvent) -> &'static [&'static str] {
    match event {
        AdhesiveEvent::Near => &["near"],
        AdhesiveEvent::Pull => &["pull"],
        AdhesiveEvent::Touch => &["touch"],
        AdhesiveEvent::Part => &["part"],
        AdhesiveEvent::Soften => &["soften"],
        AdhesiveEvent::Far => &["far"],
        AdhesiveEvent::JumpStart => &["before"],
        AdhesiveEvent::JumpEnd => &["snap_in", "snap_out", "part_snap"],
        _ => &["stop"],
    }
}

/// Loads and unloads as the events on record do, with ends at the same approaches.
fn follow(path: &mut AdhesivePath, truth: &[Truth], ends: &[f64]) -> Vec<AdhesiveState> {
    let mut states = Vec::new();
    let mut direction = Direction::Loading;
    let stops = truth.iter().filter(|event| event.kind == "stop");
    for (stop, &end) in stops.zip(ends) {
        direction = stop.direction;
        let target = ContactTarget::Approach(end);
        match direction {
            Direction::Loading => path.load_to(target).unwrap(),
            Direction::Unloading => path.unload_to(target).unwrap(),
        }
        states.extend(path.by_ref().map(|state| state.unwrap()));
    }
    assert_eq!(direction, Direction::Unloading);
    path.unload().unwrap();
    states.extend(path.by_ref().map(|state| state.unwrap()));
    states
}

/// The last of the events at each approach, where several nodes have theirs together.
fn last_of_each<T>(events: Vec<T>, approach: impl Fn(&T) -> f64) -> Vec<T> {
    let mut last: Vec<T> = Vec::new();
    for event in events {
        if last.last().is_some_and(|last| (approach(last) - approach(&event)).abs() < 1e-12) {
            last.pop();
        }
        last.push(event);
    }
    last
}

/// The same events at the same nodes in the same order, and every column within 1e-9 of the greatest value, energies
/// within 1e-12. Where nodes have their events together, what is behind the last of them.
fn compare(name: &str, mut truth: Vec<Truth>, mut states: Vec<AdhesiveState>, has_ties: bool) {
    let greatest = |value: &dyn Fn(&Truth) -> f64| {
        truth.iter().map(|event| value(event).abs()).fold(0.0, f64::max)
    };
    let units = [greatest(&|e| e.approach), greatest(&|e| e.load), greatest(&|e| e.mean_gap)];
    let energy = greatest(&|e| e.energies.iter().fold(0.0, |a: f64, b| a.max(b.abs())));
    if has_ties {
        truth = last_of_each(truth, |event| event.approach);
        states = last_of_each(states, |state| state.contact.approach);
    }
    assert_eq!(states.len(), truth.len(), "{name}");
    for (k, (event, state)) in truth.iter().zip(&states).enumerate() {
        let context = format!("{name}, event {}: {event:?} {state:?}", k + 1);
        let contact = &state.contact;
        let found = [contact.approach, contact.load, contact.mean_gap];
        let expected = [event.approach, event.load, event.mean_gap];
        for ((found, expected), unit) in found.iter().zip(expected).zip(units) {
            assert!((found - expected).abs() < 1e-9 * unit, "{context}");
        }
        let found = [contact.energy, state.adhesive_energy, state.dissipated, state.work];
        for (found, expected) in found.iter().zip(event.energies) {
            assert!((found - expected).abs() < 1e-12 * energy, "{context}");
        }
        assert_eq!(state.direction, event.direction, "{context}");
        // On record the node that begins a jump is in it already.
        if event.kind != "before" {
            let pulled = state.soft_nodes + state.cohesive_nodes;
            let expected = (event.contact_nodes, event.pulled);
            assert_eq!((contact.contact_nodes, pulled), expected, "{context}");
        }
        if !has_ties {
            assert!(kind(state.event).contains(&event.kind.as_str()), "{context}");
            let node = (state.node.0 as i64, state.node.1 as i64);
            assert!(event.kind == "stop" || node == event.node, "{context}");
        }
    }
}

fn check(name: &str, kernel: &dyn InfluenceKernel, law: Adhesion, has_ties: bool) {
    let surface = HeightMap::new(read_npy(data(&format!("{name}.npy"))).unwrap()).unwrap();
    for size in [1, 16, 64] {
        let truth = read(name);
        let ends: Vec<f64> =
            truth.iter().filter(|event| event.kind == "stop").map(|event| event.approach).collect();
        let mut path =
            AdhesivePath::builder(&surface, kernel, law).window_size(size).build().unwrap();
        let states = follow(&mut path, &truth, &ends);
        compare(name, truth, states, has_ties);
    }
}

fn rough(name: &str, kernel: &dyn InfluenceKernel) {
    let law = Adhesion::maugis(0.0032, 0.16).range(0.035);
    check(name, kernel, law, false);
}

fn grid() -> Grid {
    Grid::new(16, 12, 1.0 / 16.0, 1.0 / 16.0).unwrap()
}

#[test]
fn rough_surface_on_a_free_half_space() {
    rough("slope_free_16x12", &Boussinesq::new(grid(), 1.0).unwrap());
}

#[test]
fn rough_surface_on_a_periodic_half_space() {
    rough("slope_periodic_love_16x12", &PeriodicBoussinesq::new(grid(), 1.0).unwrap());
}

/// Jumps depend on the compliance of the machine, and a gauge is one: this is that of the record.
#[test]
fn rough_surface_on_a_spectral_half_space() {
    let spectral = Spectral::new(grid(), 1.0).unwrap();
    let shift = 0.004510548978043951 - spectral.gauge();
    let coefficient = |di, dj| spectral.coefficient(di, dj) + shift;
    let growth = ContactGrowth::Monotone;
    let kernel = KernelTable::from_fn(grid(), Boundary::Periodic, growth, coefficient).unwrap();
    rough("slope_spectral_16x12", &kernel);
}

#[test]
fn sphere() {
    let name = "slope_sphere_24";
    let kernel = Boussinesq::new(Grid::square(24, 4.8).unwrap(), 1.0).unwrap();
    // As the record was made: h₁ is a thousandth of h₂.
    let law = Adhesion::maugis(0.2829421210522584, 1.0641083464811778).range(0.531260679470044);
    check(name, &kernel, law, true);
}
