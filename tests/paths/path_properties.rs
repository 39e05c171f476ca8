//! What holds at every event of every path, on random rough surfaces.

use crate::common::with_window;
use asperity::convolution::Convolution;
use asperity::loading::{History, LoadingSolver};
use asperity::surface::{FlatPunch, HeightMap};
use asperity::updater::Dense;
use asperity::{Boussinesq, LoadingState};
use asperity_testing::dense::{self, initial_gap};
use asperity_testing::random::{Case, Roughness, case, noise, rms, roughness};
use proptest::prelude::*;

/// What the crate promises of pressures and gaps. The solves lose the condition number, below 1e3
/// for these grids, from 1e-16: in 2500 cases the worst pressure was -6e-15 of the mean, the worst
/// gap -4e-15 Sq, the worst newest pressure 2e-14 of the mean.
const EXACT: f64 = 1e-12;
/// Rounding of sums over some hundred nodes or events, relative to sums of terms of one sign: at
/// worst 5e-15 in 2500 cases.
const SUMMED: f64 = 1e-13;

fn solver(case: &Case, window: Option<usize>) -> LoadingSolver {
    let surface = HeightMap::new(case.heights()).unwrap();
    let kernel = Boussinesq::new(case.grid(), case.e_star).unwrap();
    let builder = LoadingSolver::builder(&surface, &kernel);
    with_window(builder, window).build().unwrap()
}

fn states(case: &Case, window: Option<usize>) -> Vec<LoadingState> {
    solver(case, window).map(Result::unwrap).collect()
}

/// |a - b| <= tolerance * scale, with the numbers in the message.
#[track_caller]
fn close(what: &str, a: f64, b: f64, tolerance: f64, scale: f64) {
    let error = (a - b).abs();
    assert!(
        error <= tolerance * scale.abs(),
        "{what}: {a:e} and {b:e} differ by {:e} of {scale:e}",
        error / scale.abs()
    );
}

/// Everything that the fields of one state say about it, and about the state before it.
fn check_event(path: &mut LoadingSolver, before: Option<Seen>, sq: f64) -> Seen {
    let state = path.state().unwrap();
    let grid = path.grid();
    let (pressure, gap) = (path.fields().unwrap().pressure, path.fields().unwrap().gap);
    let displacement = path.fields().unwrap().displacement;
    let map = path.contact_map();
    let order = path.contact_order();
    let nodes = grid.nodes() as f64;

    assert_eq!(order.len(), state.step);
    assert_eq!(grid.coordinates(order[state.step - 1]), state.node);
    assert_eq!(map.iter().filter(|inside| **inside).count(), state.step);
    let area = state.step as f64 * grid.cell_area();
    close("area", state.contact.contact_area, area, 4.0 * f64::EPSILON, area);
    let fraction = state.step as f64 / nodes;
    close("fraction", state.contact.contact_area_fraction, fraction, f64::EPSILON, fraction);

    // Complementarity. Lengths that cancel in the gap: the initial gap and the approach.
    let mean = pressure.sum() / state.step as f64;
    let length = sq.max(state.contact.approach);
    for ((&p, &g), &inside) in pressure.iter().zip(&gap).zip(&map) {
        if inside {
            assert!(p >= -EXACT * mean, "pressure {p:e}, mean {mean:e}, {state:?}");
            close("gap in contact", g, 0.0, EXACT, length);
        } else {
            assert_eq!(p, 0.0);
            assert!(g >= -EXACT * sq, "gap {g:e}, Sq {sq:e}, {state:?}");
        }
    }
    // The newest node has only just touched. Its pressure is y1 + approach y2, each of which is of
    // the order of the mean pressure.
    close("newest pressure", pressure[state.node], 0.0, EXACT, mean);

    let load = grid.cell_area() * pressure.sum();
    close("load", state.contact.load, load, SUMMED, load);
    // Elastic energy is half of pressure times displacement: load rises from nothing, and pressure
    // and gap are never both there. The state has it as the work of the load.
    let energy = 0.5 * grid.cell_area() * pressure.dot(&displacement);
    close("energy", state.contact.energy, energy, SUMMED, energy);
    let mean_gap = if map.iter().all(|inside| *inside) { 0.0 } else { gap.mean() };
    close("mean gap", state.contact.mean_gap, mean_gap, SUMMED, length);

    let certificate = path.certificate().unwrap();
    assert!(certificate.least_pressure >= -EXACT, "{certificate:?}");
    assert!(certificate.least_gap >= -EXACT, "{certificate:?}");
    assert!(certificate.greatest_contact_gap <= EXACT, "{certificate:?}");
    // Of a flat surface that just touches it is 1.
    let expected = if length > 0.0 { length } else { 1.0 };
    close("length", certificate.length, expected, SUMMED, expected);
    assert!(certificate.load_error.abs() <= SUMMED, "{certificate:?}");

    let seen = Seen { state, load, mean_gap };
    if let Some(Seen { state: last, load: last_load, mean_gap: last_gap }) = before {
        assert_eq!(state.step, last.step + 1);
        // Monotone to the last bit: all are sums of terms that are not negative.
        assert!(state.contact.approach >= last.contact.approach, "{last:?} {state:?}");
        assert!(state.contact.load >= last.contact.load, "{last:?} {state:?}");
        assert!(state.contact.contact_area > last.contact.contact_area, "{last:?} {state:?}");
        assert!(
            state.contact.contact_stiffness >= last.contact.contact_stiffness,
            "{last:?} {state:?}"
        );
        // Stiffnesses are the slopes from there to here, of load and mean gap from the fields.
        let change = state.contact.approach - last.contact.approach;
        close(
            "dW",
            load - last_load,
            last.contact.contact_stiffness.unwrap() * change,
            SUMMED,
            load,
        );
        let closed = (load - last_load) / last.contact.interfacial_stiffness.unwrap();
        close("dW/Ki", last_gap - mean_gap, closed, SUMMED, length);
        assert!(mean_gap <= last_gap + SUMMED * length);
    } else {
        assert_eq!((state.step, state.contact.approach, state.contact.load), (1, 0.0, 0.0));
        assert_eq!(state.contact.energy, 0.0);
    }
    seen
}

/// A state, with load and mean gap computed from its fields.
#[derive(Clone, Copy)]
struct Seen {
    state: LoadingState,
    load: f64,
    mean_gap: f64,
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn every_event_is_exact(case in case(13, roughness())) {
        let heights = case.heights();
        let mut path = solver(&case, case.window);
        let sq = rms(&heights);
        let mut before = None;
        while let Some(state) = path.next() {
            prop_assert_eq!(Some(state.unwrap()), path.state());
            before = Some(check_event(&mut path, before, sq));
        }
        prop_assert!(path.next().is_none());
        let last = before.unwrap().state;
        prop_assert_eq!(last.step, case.grid().nodes());

        // The end of every path is the rigid flat punch, the stiffest of all.
        let kernel = Boussinesq::new(case.grid(), case.e_star).unwrap();
        let punch = LoadingSolver::new(&FlatPunch::default(), &kernel).unwrap();
        let stiffest = punch.last().unwrap().unwrap().contact.contact_stiffness.unwrap();
        close("punch", last.contact.contact_stiffness.unwrap(), stiffest, SUMMED, stiffest);
    }

    /// Pressure, and contact stiffness as a finite difference of load inside the next interval,
    /// from LU solves of the contact set.
    #[test]
    fn dense_solutions_agree_inside_every_interval(case in case(8, roughness())) {
        let gap = initial_gap(&case.heights());
        let kernel = Boussinesq::new(case.grid(), case.e_star).unwrap();
        let mut path = solver(&case, case.window);
        let states: Vec<_> = path.by_ref().map(Result::unwrap).collect();
        let history: History = states.iter().copied().collect();
        let order = path.contact_order();
        let cell = case.grid().cell_area();
        for pair in states.windows(2) {
            let [state, next] = [pair[0], pair[1]];
            let contact = &order[..state.step];
            let width = next.contact.approach - state.contact.approach;
            let mut loads = [0.0; 2];
            for (load, part) in loads.iter_mut().zip([0.25, 0.75]) {
                let approach = state.contact.approach + part * width;
                let expected = dense::pressure(&kernel, contact, &gap, approach);
                let inside = history.at_approach(approach).unwrap();
                let pressure = path.fields_at(&inside).unwrap().pressure;
                // Scale: the pressure that the whole approach would cause on one cell.
                let scale = approach / kernel_self(&kernel);
                for (&node, &p) in contact.iter().zip(&expected) {
                    close("pressure", pressure[node], p, EXACT, scale);
                }
                *load = cell * expected.sum();
                close("load", inside.contact.load, *load, SUMMED, *load);
            }
            let slope = state.contact.contact_stiffness.unwrap() * 0.5 * width;
            close("stiffness", loads[1] - loads[0], slope, SUMMED, next.contact.load);
        }
    }

    /// The window is a matter of speed, the updater of memory and speed.
    #[test]
    fn windows_and_updaters_give_one_path(case in case(12, noise()), size in 2_usize..40) {
        let reference = states(&case, Some(1));
        let length = reference.last().unwrap().contact.approach;
        let dense: Vec<_> = {
            let surface = HeightMap::new(case.heights()).unwrap();
            let kernel = Boussinesq::new(case.grid(), case.e_star).unwrap();
            let builder = LoadingSolver::builder(&surface, &kernel).updater(Dense::new());
            let path = builder.window_size(size).build().unwrap();
            path.map(Result::unwrap).collect()
        };
        for other in [states(&case, Some(size)), states(&case, None), dense] {
            prop_assert_eq!(reference.len(), other.len());
            for (a, b) in reference.iter().zip(&other) {
                prop_assert_eq!((a.step, a.node), (b.step, b.node));
                // The crate promises 1e-9. Two paths that are exact to rounding differ by 1e-13 at
                // worst, interfacial stiffness by 3e-12: near full contact its inverse is a
                // difference of lengths that are nearly equal.
                close("approach", a.contact.approach, b.contact.approach, 1e-11, a.contact.approach);
                close("load", a.contact.load, b.contact.load, 1e-11, a.contact.load);
                close("energy", a.contact.energy, b.contact.energy, 1e-11, a.contact.energy);
                let (k, ki) = (a.contact.contact_stiffness.unwrap(), a.contact.interfacial_stiffness.unwrap());
                close("stiffness", k, b.contact.contact_stiffness.unwrap(), 1e-11, k);
                // The mean gap is a difference of lengths as long as the approach.
                close("mean gap", a.contact.mean_gap, b.contact.mean_gap, SUMMED, length);
                if ki.is_finite() {
                    close("interfacial stiffness", ki, b.contact.interfacial_stiffness.unwrap(), 1e-9, ki);
                } else {
                    prop_assert_eq!(Some(ki), b.contact.interfacial_stiffness);
                }
            }
        }
    }

    /// A path is a record of every instant in it.
    #[test]
    fn history_reads_any_instant(case in case(10, roughness()), parts in prop::array::uniform8(0.0..1.0)) {
        let mut path = solver(&case, case.window);
        let history: History = path.by_ref().map(Result::unwrap).collect();
        let last = *history.states().last().unwrap();
        let cell = case.grid().cell_area();
        let kernel = Boussinesq::new(case.grid(), case.e_star).unwrap();
        let mut convolution = Convolution::new(&kernel).unwrap();
        let gap = initial_gap(&case.heights());
        // Beyond the last event too, in full contact.
        for part in parts {
            let load = 1.2 * part * last.contact.load;
            let state = history.at_load(load).unwrap();
            let pressure = path.fields_at(&state).unwrap().pressure;
            let displacement = convolution.convolve(&pressure).unwrap();
            let energy = 0.5 * cell * pressure.dot(&displacement);
            prop_assert_eq!(state.contact.load, load);
            close("load", cell * pressure.sum(), load, SUMMED, load);
            close("energy", state.contact.energy, energy, SUMMED, energy);
            let sum: f64 = displacement.iter().zip(&gap).map(|(u, g)| g + u - state.contact.approach).sum();
            let length = last.contact.approach.max(state.contact.approach);
            close("mean gap", state.contact.mean_gap, sum / gap.len() as f64, SUMMED, length);
            // Reading by approach finds the same instant.
            let same = history.at_approach(state.contact.approach).unwrap();
            close("load", same.contact.load, load, SUMMED, load);
        }
        prop_assert!(history.at_load(-1.0).is_none());
        prop_assert!(history.at_load(f64::NAN).is_none());
    }

    /// Asking for fields does not disturb the path, and the same input gives the same bits.
    #[test]
    fn same_input_same_bits(case in case(12, roughness())) {
        let first = states(&case, case.window);
        let mut path = solver(&case, case.window);
        let mut second = Vec::new();
        while let Some(state) = path.next() {
            second.push(state.unwrap());
            path.certificate().unwrap();
            path.fields_at(&second[second.len() / 2]).unwrap();
        }
        prop_assert_eq!(bits(&first), bits(&second));
    }
}

fn kernel_self(kernel: &Boussinesq) -> f64 {
    asperity::InfluenceKernel::coefficient(kernel, 0, 0)
}

/// Every number of every state, bit by bit.
fn bits(states: &[LoadingState]) -> Vec<[u64; 10]> {
    let row = |s: &LoadingState| {
        [
            s.step as u64,
            s.node.0 as u64,
            s.node.1 as u64,
            s.contact.approach.to_bits(),
            s.contact.load.to_bits(),
            s.contact.contact_area.to_bits(),
            s.contact.mean_gap.to_bits(),
            s.contact.contact_stiffness.unwrap().to_bits(),
            s.contact.interfacial_stiffness.unwrap().to_bits(),
            s.contact.energy.to_bits(),
        ]
    };
    states.iter().map(row).collect()
}

/// Enough nodes for several blocks of the factor, and for threads to share the work.
#[test]
fn threads_do_not_change_a_bit() {
    let case = Case {
        nodes: (96, 96),
        cell: (1e-4, 1e-4),
        e_star: 1e9,
        height: 1e-5,
        roughness: Roughness::SelfAffine(0.8, 12.0),
        seed: 3,
        window: None,
    };
    let surface = HeightMap::new(case.heights()).unwrap();
    let run = |threads: usize, window: Option<usize>| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let kernel = Boussinesq::new(case.grid(), case.e_star).unwrap();
            let builder = LoadingSolver::builder(&surface, &kernel).max_area_fraction(0.25);
            let mut path = with_window(builder, window).build().unwrap();
            let states: Vec<_> = path.by_ref().map(Result::unwrap).collect();
            let pressure = path.fields().unwrap().pressure;
            let pressure: Vec<u64> = pressure.iter().map(|p| p.to_bits()).collect();
            (bits(&states), pressure)
        })
    };
    for window in [None, Some(100)] {
        let one = run(1, window);
        assert_eq!(one.0.len(), 96 * 96 / 4);
        for threads in [1, 2, 3] {
            assert!(one == run(threads, window), "{threads} threads, window {window:?}");
        }
    }
}
