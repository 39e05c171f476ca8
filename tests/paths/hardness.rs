//! Paths with a hardness, against events from dense solvers that share no code with this crate.

use std::path::{Path, PathBuf};

use asperity::io::read_npy;
use asperity::surface::HeightMap;
use asperity::updater::{LinearUpdater, RecursiveCholesky};
use asperity::{
    Boussinesq, ContactEvent, Grid, InfluenceKernel, LoadingSolver, LoadingState,
    PeriodicBoussinesq, Spectral,
};

/// An event: its kind, its node, and columns by name.
struct Truth {
    yields: bool,
    node: (usize, usize),
    header: Vec<String>,
    values: Vec<f64>,
}

impl Truth {
    /// A column; NaN where there is none.
    fn get(&self, name: &str) -> f64 {
        self.values[self.header.iter().position(|column| column == name).unwrap()]
    }
}

fn read(path: &Path) -> Vec<Truth> {
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let header: Vec<String> = lines.next().unwrap().split(',').map(str::to_string).collect();
    let events = lines.map(|line| {
        let fields: Vec<&str> = line.split(',').collect();
        Truth {
            yields: fields[1] == "yield",
            node: (fields[2].parse().unwrap(), fields[3].parse().unwrap()),
            values: fields.iter().map(|field| field.parse().unwrap_or(f64::NAN)).collect(),
            header: header.clone(),
        }
    });
    events.collect()
}

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/hardness").join(name)
}

/// Every column within `tolerance` of its own value, or of its greatest one where it is a sum with cancellation.
fn compare(context: &str, tolerance: f64, events: &[Truth], states: &[LoadingState]) {
    let last = events.last().unwrap();
    let mut worst = [0.0_f64; 9];
    for (k, (event, state)) in events.iter().zip(states).enumerate() {
        let context = format!("{context}, event {}", k + 1);
        let kind = if event.yields { ContactEvent::Yield } else { ContactEvent::Touch };
        assert_eq!((state.step, state.event, state.node), (k + 1, kind, event.node), "{context}");
        let contact = &state.contact;
        let plastic = contact.plastic.unwrap();
        assert_eq!(contact.contact_nodes as f64, event.get("contact_nodes"), "{context}");
        assert_eq!(plastic.yielded_nodes as f64, event.get("yielded_nodes"), "{context}");
        let energy = last.get("elastic_energy") + last.get("plastic_work");
        let columns = [
            ("approach", contact.approach, last.get("approach")),
            ("load", contact.load, last.get("load")),
            ("mean_gap", contact.mean_gap, events[0].get("mean_gap")),
            ("elastic_energy", contact.energy, energy),
            ("plastic_work", plastic.work, energy),
            ("plastic_volume", plastic.volume, last.get("plastic_volume")),
            ("plastic_area", plastic.yielded_area_fraction * last.get("contact_area"), 1.0),
            ("contact_stiffness", contact.contact_stiffness.unwrap_or(f64::NAN), 0.0),
            ("interfacial_stiffness", contact.interfacial_stiffness.unwrap(), 0.0),
        ];
        for (k, (name, found, scale)) in columns.into_iter().enumerate() {
            let expected = event.get(name);
            if expected == found || (expected.is_nan() && found.is_nan()) {
                continue;
            }
            let error = (found - expected).abs() / expected.abs().max(scale);
            worst[k] = worst[k].max(error);
            assert!(error < tolerance, "{context}: {name} {found:e} for {expected:e}: {error:e}");
        }
    }
    println!("{context}: {} events, {worst:?}", states.len());
    assert!(events.len() <= states.len(), "{context}: {} {}", events.len(), states.len());
}

fn path<U: LinearUpdater>(
    surface: &HeightMap,
    kernel: &dyn InfluenceKernel,
    hardness: f64,
    (updater, window): (U, Option<usize>),
) -> Vec<LoadingState> {
    let mut builder = LoadingSolver::builder(surface, kernel).updater(updater).hardness(hardness);
    if surface.shape() == (48, 48) {
        builder = builder.max_nodes(760);
    }
    if let Some(size) = window {
        builder = builder.window_size(size);
    }
    builder.build().unwrap().collect::<Result<_, _>>().unwrap()
}

fn kernel(name: &str, grid: Grid, e_star: f64) -> Box<dyn InfluenceKernel> {
    match name {
        "love" => Box::new(Boussinesq::new(grid, e_star).unwrap()),
        "periodic-love" => Box::new(PeriodicBoussinesq::new(grid, e_star).unwrap()),
        _ => Box::new(Spectral::new(grid, e_star).unwrap()),
    }
}

#[test]
fn all_truth() {
    let Ok(directory) = std::env::var("ASPERITY_TRUTH") else { return };
    let list = std::fs::read_to_string("/tmp/t/truth.txt").unwrap();
    for line in list.lines() {
        let f: Vec<&str> = line.split(' ').collect();
        let n = |k: usize| f[k].parse::<f64>().unwrap();
        let grid = Grid::new(n(2) as usize, n(3) as usize, n(4), n(5)).unwrap();
        let kernel = kernel(f[1], grid, n(6));
        let dir = Path::new(&directory);
        let surface = HeightMap::new(read_npy(f[8]).unwrap()).unwrap();
        let events = read(&dir.join(format!("{}_events.csv", f[0])));
        for window in [None, Some(1), Some(16)] {
            let states = path(&surface, &*kernel, n(7), (RecursiveCholesky::new(), window));
            if f[9] == "True" {
                println!("{}: {} of {}", f[0], states.len(), events.len());
                continue;
            }
            compare(&format!("{} {window:?}", f[0]), 1e-9, &events, &states);
        }
    }
}
