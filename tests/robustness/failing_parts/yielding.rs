//! Faults on a path with a hardness. The oracle is the same path without a fault.

use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};

use asperity::loading::LoadingEnd;
use asperity::surface::HeightMap;
use asperity::updater::{Dense, LinearUpdater, RecursiveCholesky};
use asperity::{
    Boussinesq, Error, Grid, InfluenceKernel, LoadingSolver, LoadingState, PeriodicBoussinesq,
};
use asperity_testing::surfaces::with_gaps;
use nalgebra::DMatrix;

use super::updater::{Failing, Fault, failing, is_refusal};

const HARDNESS: f64 = 0.2;
type Path = LoadingSolver<Failing<Box<dyn LinearUpdater>>>;

fn kernels() -> [Box<dyn InfluenceKernel>; 2] {
    let grid = Grid::new(5, 4, 1.0, 1.0).unwrap();
    [
        Box::new(Boussinesq::new(grid, 1.0).unwrap()),
        Box::new(PeriodicBoussinesq::new(grid, 1.0).unwrap()),
    ]
}

fn surface() -> HeightMap {
    let grid = Grid::new(5, 4, 1.0, 1.0).unwrap();
    let gaps: Vec<f64> = (0..grid.nodes())
        .map(|node| 1.0 + (2.3 * node as f64 + 0.7 * (node * node) as f64).sin())
        .collect();
    with_gaps(&grid, &gaps)
}

const MAKERS: [fn() -> Box<dyn LinearUpdater>; 2] =
    [|| Box::new(RecursiveCholesky::new()), || Box::new(Dense)];

fn path(
    kernel: &dyn InfluenceKernel,
    make: fn() -> Box<dyn LinearUpdater>,
    fault: Fault,
    at: usize,
) -> Result<Path, Error> {
    LoadingSolver::builder(&surface(), kernel)
        .hardness(HARDNESS)
        .window_size(4)
        .updater(failing(make(), fault, at))
        .build()
}

/// States and pressures of the path without a fault.
fn healthy(kernel: &dyn InfluenceKernel) -> Vec<(LoadingState, DMatrix<f64>)> {
    let mut path = path(kernel, MAKERS[0], Fault::Refuse, usize::MAX).unwrap();
    let states: Vec<LoadingState> = path.by_ref().map(Result::unwrap).collect();
    assert_eq!((states.len(), path.end()), (40, Some(LoadingEnd::FullyPlastic)));
    states.into_iter().map(|state| (state, path.fields_at(&state).unwrap().pressure)).collect()
}

/// What was yielded is known afterwards as before; of an updater that has failed no answer is welcome but a right one.
fn is_known(path: &mut Path, states: &[LoadingState], healthy: &[(LoadingState, DMatrix<f64>)]) {
    for (state, (expected, pressure)) in states.iter().zip(healthy) {
        assert_eq!((state.event, state.node), (expected.event, expected.node));
        let [a, b] = [state, expected].map(|state| state.contact.approach);
        // Of two updaters: condition numbers below 10³.
        assert!((a - b).abs() <= 1e-11 * (1.0 + b), "{a} {b}");
        let map = path.contact_map_at(state).unwrap();
        let count = map.iter().filter(|is_in| **is_in).count();
        assert_eq!(count, state.contact.contact_nodes);
        let yielded = path.yielded_map_at(state).unwrap();
        let count = yielded.iter().filter(|is_in| **is_in).count();
        assert_eq!(count, state.contact.plastic.unwrap().yielded_nodes);
        if let Ok(found) = path.fields_at(state).map(|fields| fields.pressure) {
            assert!((found - pressure).amax() <= 1e-9, "{state:?}");
        }
    }
}

#[test]
fn errors_and_panics_end_paths_on_which_nodes_yield() {
    let mut methods = BTreeSet::new();
    for kernel in kernels() {
        let healthy = healthy(&*kernel);
        for make in MAKERS {
            for fault in [Fault::Refuse, Fault::PanicBefore, Fault::PanicAfter] {
                for at in 0.. {
                    let building = AssertUnwindSafe(|| path(&*kernel, make, fault, at));
                    let built = catch_unwind(building);
                    let Ok(Ok(mut path)) = built else {
                        methods.insert("make_room");
                        continue;
                    };
                    let mut states = Vec::new();
                    let ended = loop {
                        match catch_unwind(AssertUnwindSafe(|| path.next())) {
                            Ok(Some(Ok(state))) => states.push(state),
                            Ok(Some(Err(error))) => break Some(is_refusal(&error)),
                            Ok(None) => break None,
                            Err(_) => break Some(true),
                        }
                    };
                    let Some(method) = path.updater().unwrap().state.struck() else {
                        if ended.is_none() && at >= path.updater().unwrap().state.calls() {
                            break;
                        }
                        assert_eq!(states.len(), healthy.len());
                        continue;
                    };
                    methods.insert(method);
                    assert_eq!(ended, Some(true), "{method} at {at}");
                    assert!(path.next().is_none() && path.end() == Some(LoadingEnd::Failed));
                    assert!(states.len() < healthy.len());
                    is_known(&mut path, &states, &healthy);
                }
            }
        }
    }
    let expected =
        ["bytes", "join", "make_room", "release", "solve", "solve_for", "watch", "watch_both"];
    assert_eq!(methods.into_iter().collect::<Vec<_>>(), expected);
}
