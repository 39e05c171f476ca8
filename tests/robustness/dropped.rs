//! What is dropped before its end takes nothing with it.

use asperity::loading::History;
use asperity::record::LoadingRecord;
use asperity::surface::HeightMap;
use asperity::{Boussinesq, ContactTarget, FixedLoadSolver, Grid, LoadingSolver, LoadingState};
use nalgebra::DMatrix;

fn problem() -> (HeightMap, Boussinesq) {
    let heights = DMatrix::from_fn(7, 6, |ix, iy| ((3 * ix + 5 * iy * iy) as f64).sin());
    let grid = Grid::new(7, 6, 1.0, 1.0).unwrap();
    (HeightMap::new(heights).unwrap(), Boussinesq::new(grid, 1.0).unwrap())
}

/// States of a path that is no more are read, give their fields, and are gone on from, wherever it was dropped.
#[test]
fn a_path_dropped_midway() {
    let (surface, kernel) = problem();
    let whole: Vec<LoadingState> =
        LoadingSolver::new(&surface, &kernel).unwrap().map(Result::unwrap).collect();
    for count in 2..whole.len() {
        let mut path = LoadingSolver::new(&surface, &kernel).unwrap();
        let history: History = path.by_ref().take(count).map(Result::unwrap).collect();
        let pressure = path.fields().unwrap().pressure;
        let record = LoadingRecord::new(&path, history).unwrap();
        drop(path);
        assert!(record.states() == &whole[..count]);
        let last = whole[count - 1];
        let between = record.history().at_load(0.6 * last.contact.load).unwrap();
        assert_eq!(between.contact.load, 0.6 * last.contact.load);
        let replayed = record.replay().unwrap().fields_at(&last).unwrap().pressure;
        // Iterations in place of a factor: their tolerance of gaps, times a condition number below 10³.
        let error = (&replayed - &pressure).amax();
        assert!(error <= 1e-7 * pressure.max(), "{count}: {error:e}");
        let mut rest = record.resume().unwrap();
        for (found, expected) in rest.by_ref().map(Result::unwrap).zip(&whole[count..]) {
            assert_eq!((found.step, found.node), (expected.step, expected.node));
            // Windows that end elsewhere: rounding only.
            assert!(
                (found.contact.load - expected.contact.load).abs() <= 1e-12 * expected.contact.load
            );
        }
        assert_eq!(rest.state().unwrap().step, whole.len());
    }
}

/// A solver whose sweep was dropped solves as one that never swept.
#[test]
fn a_sweep_dropped_midway() {
    let (surface, kernel) = problem();
    let fresh = FixedLoadSolver::new(&surface, &kernel).unwrap().solve(2.0).unwrap();
    for count in 0..4 {
        let mut solver = FixedLoadSolver::new(&surface, &kernel).unwrap();
        let swept: Vec<_> = solver
            .sweep([1.0, 1.5, 3.0, 5.0].map(ContactTarget::Load))
            .take(count)
            .map(Result::unwrap)
            .collect();
        let again = solver.solve(2.0).unwrap();
        assert!(again.fields.pressure == fresh.fields.pressure, "{count}");
        assert!(again.contact == fresh.contact, "{count}");
        for (solution, load) in swept.iter().zip([1.0, 1.5, 3.0]) {
            assert_eq!(solution.contact.load, load);
        }
    }
}
