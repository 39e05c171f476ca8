//! Paths with a hardness, against events from dense solvers that share no code with this crate.

use std::path::{Path, PathBuf};

use asperity::io::read_npy;
use asperity::kernel::KernelTable;
use asperity::loading::{History, LoadingBuilder, LoadingEnd};
#[cfg(feature = "io")]
use asperity::record::LoadingRecord;
use asperity::surface::{HeightMap, Paraboloid};
use asperity::updater::{ConjugateGradient, Dense, Handover, LinearUpdater, RecursiveCholesky};
use asperity::{
    Boundary, Boussinesq, ContactEvent, ContactGrowth, ContactTarget, Error, FixedLoadSolver, Grid,
    InfluenceKernel, KernelError, LoadingSolver, LoadingState, PeriodicBoussinesq, Spectral,
};
use nalgebra::DMatrix;

#[cfg(feature = "io")]
use crate::resumed::through_a_file;

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
        let index = |name: &str| {
            let place = header.iter().position(|column| column == name).unwrap();
            fields[place].parse().unwrap()
        };
        Truth {
            yields: fields[1] == "yield",
            node: (index("ix"), index("iy")),
            values: fields.iter().map(|field| field.parse().unwrap_or(f64::NAN)).collect(),
            header: header.clone(),
        }
    });
    events.collect()
}

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/hardness").join(name)
}

/// The same events in the same order, and every column within 1e-10 of its value or of its greatest one: the events
/// come from LU solves with a condition number of some 10³, so that both sides err by 1e-12.
fn compare(context: &str, events: &[Truth], states: &[LoadingState]) {
    let last = events.last().unwrap();
    let cell = events[0].get("contact_area");
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
            ("plastic_area", plastic.yielded_nodes as f64 * cell, last.get("contact_area")),
            ("contact_stiffness", contact.contact_stiffness.unwrap_or(f64::NAN), 0.0),
            ("interfacial_stiffness", contact.interfacial_stiffness.unwrap(), 0.0),
        ];
        for (name, found, scale) in columns {
            let expected = event.get(name);
            if expected == found || (expected.is_nan() && found.is_nan()) {
                continue;
            }
            let error = (found - expected).abs() / expected.abs().max(scale);
            assert!(error < 1e-10, "{context}: {name} {found:e} for {expected:e}: {error:e}");
        }
    }
    assert_eq!(events.len(), states.len(), "{context}");
}

fn grid() -> Grid {
    Grid::new(16, 12, 2e-5, 3e-5).unwrap()
}

const HARDNESS: f64 = 3e9;

/// Three surfaces whose rms gradients are such that the hardness is 0.1, 0.5 and 1.5 E* h'.
fn cases() -> [(&'static str, Box<dyn InfluenceKernel>); 3] {
    let e_star = 115e9;
    [
        ("free_16x12_0.1", Box::new(Boussinesq::new(grid(), e_star).unwrap())),
        ("periodic_love_16x12_0.5", Box::new(PeriodicBoussinesq::new(grid(), e_star).unwrap())),
        ("periodic_spectral_16x12_1.5", Box::new(Spectral::new(grid(), e_star).unwrap())),
    ]
}

fn surface(name: &str) -> HeightMap {
    HeightMap::new(read_npy(data(&format!("{name}.npy"))).unwrap()).unwrap()
}

fn all<U: LinearUpdater>(builder: LoadingBuilder<'_, U>) -> Vec<LoadingState> {
    let mut path = builder.build().unwrap();
    let (mut states, mut hints) = (Vec::new(), vec![path.size_hint()]);
    while let Some(state) = path.next() {
        states.push(state.unwrap());
        hints.push(path.size_hint());
    }
    assert_eq!(path.end(), Some(LoadingEnd::FullyPlastic));
    for (k, (least, most)) in hints.into_iter().enumerate() {
        let left = states.len() - k;
        assert!(least <= left && most.is_some_and(|most| most >= left), "{k}: {left} of {most:?}");
    }
    states
}

/// From first touch to the yield of the last node: 384 events, whatever the window and the updater.
#[test]
fn paths_are_those_of_a_dense_solver() {
    for (name, kernel) in cases() {
        let (events, heights) = (read(&data(&format!("{name}_events.csv"))), surface(name));
        let builder = || LoadingSolver::builder(&heights, &*kernel).hardness(HARDNESS);
        compare(name, &events, &all(builder()));
        for size in [1, 3, 16, 1000] {
            let states = all(builder().window_size(size).updater(RecursiveCholesky::new()));
            compare(&format!("{name}, window {size}"), &events, &states);
        }
        compare(&format!("{name}, dense"), &events, &all(builder().updater(Dense)));
        let map = DMatrix::from_element(16, 12, HARDNESS);
        let boxed: Box<dyn LinearUpdater> = Box::new(Handover::new());
        let states =
            all(LoadingSolver::builder(&heights, &*kernel).hardness_map(&map).updater(boxed));
        compare(&format!("{name}, map"), &events, &states);
    }
}

/// Where no pressure gets so high, the path is the elastic one: bit for bit without a limit, and to rounding with one.
#[test]
fn a_hardness_that_is_not_reached_changes_nothing() {
    for (name, kernel) in cases() {
        let heights = surface(name);
        let builder = || LoadingSolver::builder(&heights, &*kernel).max_area_fraction(0.9);
        let run = |builder: LoadingBuilder<'_>| {
            builder.build().unwrap().collect::<Result<Vec<_>, _>>().unwrap()
        };
        let elastic = run(builder());
        assert_eq!(run(builder().hardness(f64::INFINITY)), elastic);
        let infinite = DMatrix::from_element(16, 12, f64::INFINITY);
        assert_eq!(run(builder().hardness_map(&infinite)), elastic);
        let hard = run(builder().hardness(1e15));
        assert_eq!(hard.len(), elastic.len());
        for (found, expected) in hard.iter().zip(&elastic) {
            assert_eq!((found.event, found.node), (expected.event, expected.node), "{name}");
            let [a, b] = [found, expected].map(|state| state.contact.load);
            assert!((a - b).abs() <= 1e-12 * b, "{name}: {a} {b}");
            assert_eq!(found.contact.plastic.unwrap().yielded_nodes, 0);
        }
    }
}

/// Conditions of contact, fields and sets at states all along a path: of the present, and of earlier ones.
#[test]
fn states_fulfil_the_conditions() {
    for (name, kernel) in cases() {
        let heights = surface(name);
        let mut path =
            LoadingSolver::builder(&heights, &*kernel).hardness(HARDNESS).build().unwrap();
        let mut states = Vec::new();
        while let Some(state) = path.next() {
            let state = state.unwrap();
            states.push(state);
            if state.step % 11 == 3 || state.step > 380 {
                path.verify().unwrap();
                let certificate = path.certificate().unwrap();
                assert!(certificate.least_pressure > -1e-11, "{name}: {certificate:?}");
                assert!(certificate.least_gap > -1e-11, "{name}: {certificate:?}");
                assert!(certificate.greatest_contact_gap < 1e-11, "{name}: {certificate:?}");
                assert!(certificate.excess_pressure.unwrap() < 1e-11, "{name}: {certificate:?}");
                assert!(certificate.load_error.abs() < 1e-11, "{name}: {certificate:?}");
            }
        }
        let area = grid().cell_area();
        for state in states.iter().step_by(23) {
            let context = format!("{name}, state {}", state.step);
            let (contact, plastic) = (state.contact, state.contact.plastic.unwrap());
            let pressure = path.fields_at(state).unwrap().pressure;
            let (map, yielded) =
                (path.contact_map_at(state).unwrap(), path.fields_at(state).unwrap().yielded_map);
            assert_eq!(map.iter().filter(|is_in| **is_in).count(), contact.contact_nodes);
            assert_eq!(yielded.iter().filter(|is_in| **is_in).count(), plastic.yielded_nodes);
            let (gap, depth) =
                (path.fields_at(state).unwrap().gap, path.fields_at(state).unwrap().plastic_depth);
            for node in 0..grid().nodes() {
                if yielded.as_slice()[node] {
                    assert!(map.as_slice()[node], "{context}");
                    assert_eq!(pressure.as_slice()[node], HARDNESS, "{context}");
                    assert_eq!(gap.as_slice()[node], 0.0, "{context}");
                } else {
                    assert_eq!(depth.as_slice()[node], 0.0, "{context}");
                }
            }
            // Sums of numbers that are right to 1e-12.
            assert!(
                (depth.sum() * area - plastic.volume).abs() <= 1e-11 * plastic.volume,
                "{context}"
            );
            assert!(
                (pressure.sum() * area - contact.load).abs() <= 1e-11 * contact.load,
                "{context}"
            );
            let mean = gap.mean();
            assert!(
                (mean - contact.mean_gap).abs() <= 1e-11 * states[0].contact.mean_gap,
                "{context}"
            );
        }
        // In the order of touching, yielded or not.
        let touched = states.iter().filter(|state| state.event == ContactEvent::Touch);
        let touched: Vec<usize> = touched.map(|s| grid().index(s.node.0, s.node.1)).collect();
        assert_eq!(path.contact_order(), touched, "{name}");
    }
}

/// Two nodes with C = (2, 1; 1, 2), gaps 0 and 1 and H = 3/4: touch at 0, yield at 3/2, touch at 7/4, yield at 13/4.
/// Between 3/2 and 7/4 the load stays at 3/4.
#[test]
fn two_nodes_by_hand() {
    let two = Grid::new(2, 1, 1.0, 1.0).unwrap();
    let coefficient = |di: isize, _: isize| if di == 0 { 4.0 } else { 2.0 };
    let kernel =
        KernelTable::from_fn(two, Boundary::Free, ContactGrowth::Monotone, coefficient).unwrap();
    let heights = HeightMap::new(DMatrix::from_row_slice(2, 1, &[0.0, -1.0])).unwrap();
    let builder = || LoadingSolver::builder(&heights, &kernel).hardness(0.375);
    let states = all(builder());
    let found: Vec<_> = states
        .iter()
        .map(|state| (state.event, state.node.0, state.contact.approach, state.contact.load))
        .collect();
    use ContactEvent::{Touch, Yield};
    let expected = [
        (Touch, 0, 0.0, 0.0),
        (Yield, 0, 1.5, 0.375),
        (Touch, 1, 1.75, 0.375),
        (Yield, 1, 3.25, 0.75),
    ];
    for (found, expected) in found.iter().zip(expected) {
        assert_eq!((found.0, found.1), (expected.0, expected.1));
        assert!((found.2 - expected.2).abs() < 1e-14, "{found:?}");
        assert!((found.3 - expected.3).abs() < 1e-14, "{found:?}");
    }
    // K = 1/4, none on the plateau, and 1/4 again of the second node.
    let stiffness: Vec<f64> = states.iter().map(|s| s.contact.contact_stiffness.unwrap()).collect();
    assert_eq!(stiffness, [0.25, 0.0, 0.25, 0.0]);
    let history: History = states.into_iter().collect();
    // The plateau begins where its load is reached; along it the approach tells the states apart.
    assert_eq!(history.at_load(0.375).unwrap().contact.approach, 1.5);
    let along = history.at_approach(1.625).unwrap().contact;
    // Of two limits on the plateau the one that the approach comes to first.
    let limits = [ContactTarget::Approach(1.7), ContactTarget::MeanGap(along.mean_gap)];
    let mut path = limits.into_iter().fold(builder(), |path, limit| path.until(limit)).build();
    let last = path.as_mut().unwrap().by_ref().last().unwrap().unwrap();
    assert_eq!(path.unwrap().end(), Some(LoadingEnd::MeanGap));
    assert!((last.contact.approach - 1.625).abs() < 1e-14, "{last:?}");
    let plastic = along.plastic.unwrap();
    assert_eq!((along.load, along.mean_gap, plastic.volume), (0.375, 0.0625, 0.125));
    assert_eq!(plastic.work, 0.375 * 0.125);
    let mid = history.at_mean_gap(0.0625).unwrap().contact;
    assert_eq!((mid.approach, mid.load), (1.625, 0.375));
    // Half a metre behind the second touch: W = 3/8 + 1/8, and the first node has given way by 1/4 + 1/2 (1 - 1/2).
    let later = history.at_approach(2.25).unwrap().contact;
    assert!((later.load - 0.5).abs() < 1e-14);
    assert!((later.plastic.unwrap().volume - 0.5).abs() < 1e-14);
    assert!((history.at_load(0.5).unwrap().contact.approach - 2.25).abs() < 1e-14);
    // Behind the end the approach grows under the last load.
    assert_eq!(history.at_approach(4.0).unwrap().contact.load, 0.75);
    assert!(history.at_load(0.8).is_none());
    // Where a limit is the load of a plateau the path ends where it begins.
    let mut path = builder().max_load(0.375).build().unwrap();
    let last = path.by_ref().last().unwrap().unwrap();
    assert_eq!((last.contact.approach, path.end()), (1.5, Some(LoadingEnd::Load)));
}

/// A hardness that no node comes to leaves every bit of the elastic path as it is.
#[test]
fn an_unlimited_hardness_is_none() {
    type ElasticColumns = (ContactEvent, (usize, usize), usize, Vec<u64>);
    fn elastic_columns(state: &LoadingState) -> ElasticColumns {
        let contact = state.contact;
        let stiffness = [contact.contact_stiffness, contact.interfacial_stiffness];
        let numbers = [contact.approach, contact.load, contact.energy, contact.mean_gap];
        let numbers = numbers.into_iter().chain(stiffness.map(Option::unwrap_or_default));
        (state.event, state.node, state.step, numbers.map(f64::to_bits).collect())
    }
    fn columns<U: LinearUpdater>(
        builder: LoadingBuilder<'_, U>,
        window: Option<usize>,
    ) -> Vec<ElasticColumns> {
        let builder = match window {
            Some(size) => builder.window_size(size),
            None => builder,
        };
        let path = builder.max_area_fraction(1.0).build().unwrap();
        path.map(|state| elastic_columns(&state.unwrap())).collect()
    }
    for (name, kernel) in cases() {
        let heights = surface(name);
        let builder = || LoadingSolver::builder(&heights, &*kernel);
        for window in [None, Some(24)] {
            let with_factor = || builder().updater(RecursiveCholesky::new());
            let elastic = columns(with_factor(), window);
            assert_eq!(elastic.len(), 192);
            assert!(columns(with_factor().hardness(1e30), window) == elastic, "{name} {window:?}");
            let without = || builder().updater(ConjugateGradient::new());
            let elastic = columns(without(), window);
            assert_eq!(elastic.len(), 192);
            assert!(columns(without().hardness(1e30), window) == elastic, "{name} {window:?}");
        }
    }
}

/// All limits, and targets afterwards.
#[test]
fn paths_end_where_they_are_to_end() {
    let (name, kernel) = &cases()[0];
    let heights = surface(name);
    let builder = || LoadingSolver::builder(&heights, &**kernel).hardness(HARDNESS);
    let history: History = all(builder()).into_iter().collect();
    let states = history.states();
    for k in [60, 200, 300] {
        let contact = states[k].contact;
        for (target, end) in [
            (ContactTarget::Load(contact.load * 1.0001), LoadingEnd::Load),
            (ContactTarget::Approach(contact.approach * 1.0001), LoadingEnd::Approach),
            (ContactTarget::MeanGap(contact.mean_gap * 0.9999), LoadingEnd::MeanGap),
            (ContactTarget::AreaFraction(contact.contact_area_fraction), LoadingEnd::AreaFraction),
        ] {
            // Full contact has no other mean gap or area.
            if contact.mean_gap == 0.0 && end != LoadingEnd::Load && end != LoadingEnd::Approach {
                continue;
            }
            let mut path = builder().until(target).build().unwrap();
            let last = path.by_ref().last().unwrap().unwrap();
            assert_eq!(path.end(), Some(end), "{target:?}");
            let read = history.at(target).unwrap();
            assert_eq!(last.contact.contact_nodes, read.contact.contact_nodes, "{target:?}");
            let [a, b] = [last, read].map(|state| state.contact.approach);
            assert!((a - b).abs() <= 1e-12 * b, "{target:?}: {a} {b}");
            path.verify().unwrap();
            // And on from there.
            path.continue_to(ContactTarget::Load(states[340].contact.load)).unwrap();
            let last = path.last().unwrap().unwrap();
            // Rounding of solutions in other windows, with a condition number of some 10³.
            assert!((last.contact.approach / states[340].contact.approach - 1.0).abs() < 1e-10);
        }
    }
}

/// A path to full contact ends there, though nodes would yield behind it; one to the infinite hardness of the rest is
/// at its end.
#[test]
fn full_contact_is_an_end_if_nothing_yields() {
    let square = Grid::new(3, 3, 1.0, 1.0).unwrap();
    let kernel = Boussinesq::new(square, 1.0).unwrap();
    let flat = HeightMap::new(DMatrix::zeros(3, 3)).unwrap();
    let builder = || LoadingSolver::builder(&flat, &kernel).hardness(1.0);
    for (builder, end) in [
        (builder().max_area_fraction(1.0), LoadingEnd::AreaFraction),
        (builder().max_nodes(9), LoadingEnd::Nodes),
        (builder().hardness(f64::INFINITY).max_nodes(9), LoadingEnd::FullContact),
    ] {
        let mut path = builder.build().unwrap();
        assert_eq!(path.by_ref().count(), 9);
        assert_eq!(path.end(), Some(end));
    }
}

/// A record of a path under way: read, resumed and replayed it is the path that was not interrupted.
#[cfg(feature = "io")]
#[test]
fn records_of_paths_on_which_nodes_yield() {
    for (name, kernel) in cases() {
        let heights = surface(name);
        let builder = || LoadingSolver::builder(&heights, &*kernel).hardness(HARDNESS);
        let states = all(builder());
        for at in [1, 40, 150, 260, 383] {
            let mut path = builder().build().unwrap();
            let history: History = path.by_ref().take(at).collect::<Result<_, _>>().unwrap();
            let record = LoadingRecord::new(&path, history).unwrap();
            let read = through_a_file(&record);
            assert_eq!(read.states(), record.states());
            assert_eq!(read.settings(), record.settings());
            let as_text = serde_json::to_string(&record).unwrap();
            let again: LoadingRecord = serde_json::from_str(&as_text).unwrap();
            assert_eq!(again.states(), record.states());
            let mut resumed = read.resume().unwrap();
            let rest = resumed.by_ref().collect::<Result<Vec<_>, _>>().unwrap();
            assert_eq!(rest.len() + at, states.len(), "{name}, {at}");
            for (found, expected) in rest.iter().zip(&states[at..]) {
                assert_eq!((found.event, found.node), (expected.event, expected.node));
                let [a, b] = [found, expected].map(|state| state.contact.approach);
                assert!((a - b).abs() <= 1e-11 * b, "{name}, {at}: {a} {b}");
            }
            let mut replayed = read.replay().unwrap();
            let state = record.states()[at / 2];
            let [a, b] = [
                replayed.fields_at(&state).unwrap().pressure,
                path.fields_at(&state).unwrap().pressure,
            ];
            // A solution by iterations to some 10⁻¹², with that condition number, beside one of a factor.
            assert!((a - b).amax() <= 1e-9 * HARDNESS, "{name}, {at}");
            assert_eq!(
                replayed.fields_at(&state).unwrap().yielded_map,
                path.fields_at(&state).unwrap().yielded_map
            );
            // It goes on, by iterations: the same events.
            for (found, expected) in replayed.by_ref().map(Result::unwrap).zip(&states[at..]) {
                assert_eq!((found.event, found.node), (expected.event, expected.node));
            }
            assert_eq!(replayed.end(), Some(LoadingEnd::FullyPlastic));
        }
        // Without the hardness it is another path.
        let history: History = states[..200].iter().copied().collect();
        assert!(LoadingSolver::builder(&heights, &*kernel).resume(&history).is_err());
    }
}

/// Unloading and loading again is the elastic path of the surface that is left, up to the same load and the same
/// approach; beyond it the first path goes on. The loop takes the plastic work.
#[test]
fn unloading_is_elastic() {
    let (name, kernel) = &cases()[0];
    let heights = surface(name);
    let mut path = LoadingSolver::builder(&heights, &**kernel).hardness(HARDNESS).build().unwrap();
    let states: Vec<_> = path.by_ref().take(135).collect::<Result<_, _>>().unwrap();
    let last = states[134];
    let residual = path.residual_surface().unwrap();
    assert_eq!(residual, path.residual_surface_at(&last).unwrap());
    let truth = read(&data("free_16x12_0.1_reloading_from_135.csv"));
    let again = LoadingSolver::builder(&residual, &**kernel).max_load(last.contact.load);
    let again = again.build().unwrap().collect::<Result<Vec<_>, _>>().unwrap();
    let reloaded = again.last().unwrap();
    // Approaches count from the first touch of the surface that is left.
    let shift = -residual.max_height();
    assert!((reloaded.contact.approach + shift - last.contact.approach).abs() < 1e-17);
    assert_eq!(reloaded.contact.contact_nodes, last.contact.contact_nodes);
    assert!((reloaded.contact.mean_gap / last.contact.mean_gap - 1.0).abs() < 1e-11);
    let work = last.contact.plastic.unwrap().work;
    assert!((reloaded.contact.energy / last.contact.energy - 1.0).abs() < 1e-11);
    assert!(work > 0.1 * last.contact.energy);
    for (event, state) in truth.iter().zip(&again) {
        assert_eq!(state.node, event.node);
        // From the first touch of the surface that is left, as this path has it.
        let [expected, found] = [event.get("approach"), state.contact.approach];
        let error = (found - expected).abs();
        assert!(error <= 1e-10 * last.contact.approach, "{found:e} {expected:e}");
    }
    // A hardness that is not exceeded again changes nothing, and beyond the old load both paths are one.
    let beyond = LoadingSolver::builder(&residual, &**kernel).hardness(HARDNESS);
    let beyond: History = beyond.build().unwrap().collect::<Result<_, _>>().unwrap();
    let first: History =
        all(LoadingSolver::builder(&heights, &**kernel).hardness(HARDNESS)).into_iter().collect();
    for load in [1.1, 1.5, 2.5].map(|factor| factor * last.contact.load) {
        let [a, b] = [&beyond, &first].map(|history| history.at_load(load).unwrap().contact);
        assert_eq!(a.contact_nodes, b.contact_nodes);
        assert!((a.approach + shift - b.approach).abs() <= 1e-11 * b.approach);
        let [a, b] = [a, b].map(|contact| contact.plastic.unwrap().volume);
        let before = last.contact.plastic.unwrap().volume;
        assert!((a + before - b).abs() <= 1e-10 * b, "{a:e} {before:e} {b:e}");
    }
}

/// Symmetric surfaces: sets behind all events of one approach are those of the truth, in whatever order.
#[test]
fn ties_end_in_the_same_states() {
    let heights = surface("sphere_9");
    let kernel = Boussinesq::new(Grid::new(9, 9, 1.0, 1.0).unwrap(), 1.0).unwrap();
    let events = read(&data("sphere_9_events.csv"));
    let mut path = LoadingSolver::builder(&heights, &kernel).hardness(0.25).build().unwrap();
    let states = path.by_ref().collect::<Result<Vec<_>, _>>().unwrap();
    assert_eq!(states.len(), events.len());
    let mut compared = 0;
    for k in 0..events.len() {
        let approach = |k: usize| events[k].get("approach");
        if k + 1 < events.len() && approach(k + 1) - approach(k) < 1e-9 * approach(k + 1) {
            continue;
        }
        let set = |yields: bool| {
            let of = events[..=k].iter().filter(|event| event.yields == yields);
            let mut nodes: Vec<_> = of.map(|event| event.node).collect();
            nodes.sort_unstable();
            nodes
        };
        let found = |kind: ContactEvent| {
            let of = states[..=k].iter().filter(|state| state.event == kind);
            let mut nodes: Vec<_> = of.map(|state| state.node).collect();
            nodes.sort_unstable();
            nodes
        };
        assert_eq!(found(ContactEvent::Touch), set(false), "{k}");
        assert_eq!(found(ContactEvent::Yield), set(true), "{k}");
        let [a, b] = [states[k].contact.load, events[k].get("load")];
        assert!((a - b).abs() <= 1e-10 * b, "{k}: {a} {b}");
        compared += 1;
    }
    assert!(compared > 20, "{compared}");
}

/// Flat surfaces touch with all nodes at once, and with a tiny hardness all yield nearly at once.
#[test]
fn flat_and_soft_surfaces() {
    let square = Grid::new(8, 6, 1.0, 1.0).unwrap();
    for kernel in [
        Box::new(Boussinesq::new(square, 1.0).unwrap()) as Box<dyn InfluenceKernel>,
        Box::new(PeriodicBoussinesq::new(square, 1.0).unwrap()),
        Box::new(Spectral::new(square, 1.0).unwrap()),
    ] {
        let flat = HeightMap::new(DMatrix::zeros(8, 6)).unwrap();
        let ball = Paraboloid::new(10.0).unwrap();
        for surface in [&flat as &dyn asperity::Surface, &ball] {
            for hardness in [1e-18, 1e-9, 0.1, 10.0] {
                let states = all(LoadingSolver::builder(surface, &*kernel).hardness(hardness));
                assert_eq!(states.len(), 96);
                let last = states.last().unwrap().contact;
                assert!(
                    (last.load / (48.0 * hardness) - 1.0).abs() < 1e-12,
                    "{hardness:e} {last:?}"
                );
                assert_eq!((last.mean_gap, last.contact_nodes), (0.0, 48));
                for pair in states.windows(2) {
                    let [a, b] = [pair[0].contact, pair[1].contact];
                    assert!(a.approach <= b.approach && a.load <= b.load);
                    assert!(a.plastic.unwrap().volume <= b.plastic.unwrap().volume);
                }
            }
        }
    }
}

/// Each node has its own hardness, of some it is infinite: the same states as single loads have.
#[test]
fn a_hardness_for_each_node() {
    for (name, kernel) in cases() {
        let heights = surface(name);
        let map = DMatrix::from_fn(16, 12, |ix, iy| match (3 * ix + 5 * iy) % 7 {
            0 => f64::INFINITY,
            k => HARDNESS * (0.5 + 0.3 * k as f64),
        });
        let mut path =
            LoadingSolver::builder(&heights, &*kernel).hardness_map(&map).build().unwrap();
        let history = path.run().unwrap();
        // What does not yield carries all the load in the end.
        assert_eq!(path.end(), Some(LoadingEnd::FullContact));
        let yielding = map.iter().filter(|value| value.is_finite()).count();
        assert_eq!(history.states().len(), 192 + yielding);
        let mut solver = FixedLoadSolver::builder(&heights, &*kernel)
            .hardness_map(&map)
            .tolerance(1e-11)
            .build()
            .unwrap();
        for k in [50, 120, 200, 300] {
            let states = history.states();
            // Where hardly any load lies between two events the sets rest on rounding.
            let wide = |k: &usize| states[k + 1].contact.load > 1.00001 * states[*k].contact.load;
            let k = (k..).find(wide).unwrap();
            let load = 0.5 * (states[k].contact.load + states[k + 1].contact.load);
            let (state, solution) = (history.at_load(load).unwrap(), solver.solve(load).unwrap());
            let plastic = solution.contact.plastic.unwrap();
            assert_eq!(
                path.contact_map_at(&state).unwrap(),
                solution.fields.contact_map,
                "{name} {k}"
            );
            assert_eq!(
                path.fields_at(&state).unwrap().yielded_map,
                solution.fields.yielded_map,
                "{name} {k}"
            );
            let found = state.contact.plastic.unwrap();
            let [work, volume] = [found.work - plastic.work, found.volume - plastic.volume];
            assert!(work.abs() <= 1e-8 * plastic.work, "{name} {k}: {work:e}");
            assert!(volume.abs() <= 1e-8 * plastic.volume, "{name} {k}: {volume:e}");
        }
    }
}

#[test]
fn what_makes_no_sense_is_refused() {
    let (name, kernel) = &cases()[0];
    let heights = surface(name);
    let builder = || LoadingSolver::builder(&heights, &**kernel);
    for hardness in [0.0, -1.0, f64::NAN, f64::NEG_INFINITY] {
        let refused = builder().hardness(hardness).build();
        assert!(
            matches!(refused, Err(Error::NotPositive { quantity: "hardness", .. })),
            "{hardness}: {refused:?}"
        );
    }
    let map = DMatrix::from_element(12, 16, HARDNESS);
    let refused = builder().hardness_map(&map).build();
    assert!(matches!(refused, Err(Error::GridMismatch { .. })), "{refused:?}");
    let most = HARDNESS * grid().nominal_area();
    for (load, is_refused) in [(most, true), (2.0 * most, true), (0.999 * most, false)] {
        let built = builder().hardness(HARDNESS).max_load(load).build();
        assert_eq!(matches!(built, Err(Error::BeyondHardness { .. })), is_refused, "{load}");
    }
    // Nor does a path go on to such a load, and it stays as it is.
    let mut path = builder().hardness(HARDNESS).max_nodes(3).build().unwrap();
    path.run().unwrap();
    for load in [most, 2.0 * most] {
        let refused = path.continue_to(ContactTarget::Load(load));
        assert!(matches!(refused, Err(Error::BeyondHardness { .. })), "{load}: {refused:?}");
        assert_eq!(path.end(), Some(LoadingEnd::Nodes));
    }
    path.continue_to(ContactTarget::Load(0.999 * most)).unwrap();
    let unknown = KernelTable::new(&**kernel).unwrap();
    let coefficient = |di, dj| unknown.coefficient(di, dj).unwrap_or_default();
    let unknown =
        KernelTable::from_fn(grid(), Boundary::Free, ContactGrowth::Unknown, coefficient).unwrap();
    let refused = LoadingSolver::builder(&heights, &unknown).hardness(HARDNESS).build();
    assert!(matches!(refused, Err(Error::Kernel(KernelError::GrowthUnknown))), "{refused:?}");
    // One that promises growth and breaks it says where.
    let row = Grid::new(3, 1, 1.0, 1.0).unwrap();
    let coefficient = |di: isize, _: isize| [3.75, 2.75, 0.75][di.unsigned_abs()];
    let broken =
        KernelTable::from_fn(row, Boundary::Free, ContactGrowth::Monotone, coefficient).unwrap();
    let heights = HeightMap::new(DMatrix::from_row_slice(3, 1, &[-1.0, 0.0, -2.0])).unwrap();
    let path = LoadingSolver::builder(&heights, &broken).hardness(1.25).build().unwrap();
    let ended = path.collect::<Result<Vec<_>, _>>();
    assert!(matches!(ended, Err(Error::NotMonotone { .. })), "{ended:?}");
}
