//! States that are none of the path: refused, with the number that says so.

use crate::common::{half_way, loaded};
use crate::problems::{grid, kernels, rough, states};
use asperity::loading::History;
use asperity::{Error, LoadingSolver, LoadingState};

#[track_caller]
fn assert_refused(path: &mut LoadingSolver, state: &LoadingState, context: &str) {
    match path.fields_at(state).map(|fields| fields.pressure) {
        Err(Error::NotOnPath { step, .. }) => assert_eq!(step, state.step),
        Err(error) => panic!("{context}: {error}"),
        Ok(_) => panic!("{context}: {state:?} was accepted"),
    }
}

#[test]
fn states_of_another_path_are_refused() {
    let surface = rough(&grid(), 7);
    for (name, kernel) in kernels(grid()) {
        let mut path = LoadingSolver::new(&surface, &kernel).unwrap();
        let own: History = path.by_ref().map(Result::unwrap).collect();
        let foreign: History = states(&rough(&grid(), 8), &kernel).into_iter().collect();
        let length = own.states().len();
        for step in [3, 50, 120, 200] {
            let context = format!("{name}, step {step}");
            let own = own.states();
            for state in [own[step - 1], half_way(own[step - 1], Some(own[step]))] {
                assert!(path.fields_at(&state).map(|fields| fields.pressure).is_ok(), "{context}");
            }
            let foreign = foreign.states();
            assert_refused(&mut path, &foreign[step - 1], &context);
            let between = half_way(foreign[step - 1], Some(foreign[step]));
            assert_refused(&mut path, &between, &context);
        }
        // A state that this path has not reached is not foreign.
        let mut early = LoadingSolver::new(&surface, &kernel).unwrap();
        early.by_ref().take(10).last();
        let later = &own.states()[length / 2];
        let error = early.fields_at(later).map(|fields| fields.pressure).unwrap_err();
        assert!(matches!(error, Error::StateNotReached { .. }), "{error}");
    }
}

#[test]
fn states_beyond_their_interval_are_refused() {
    let surface = rough(&grid(), 9);
    for (name, kernel) in kernels(grid()) {
        let mut path = LoadingSolver::new(&surface, &kernel).unwrap();
        let all: Vec<_> = path.by_ref().map(Result::unwrap).collect();
        for step in [3, 50, 120, 200] {
            let context = format!("{name}, step {step}");
            let (state, next) = (all[step - 1], all[step]);
            // The contact of this step under the load of many events later, and earlier.
            assert_refused(&mut path, &loaded(state, all[step + 40].contact.load), &context);
            let before = loaded(state, 0.3 * state.contact.load);
            assert_refused(&mut path, &before, &context);
            // Inside the interval the same relations give states.
            let inside = loaded(state, 0.5 * (state.contact.load + next.contact.load));
            assert!(path.fields_at(&inside).map(|fields| fields.pressure).is_ok(), "{context}");
        }
        // In full contact the line goes on.
        let last = all[all.len() - 1];
        let beyond = loaded(last, 100.0 * last.contact.load);
        assert!(path.fields_at(&beyond).map(|fields| fields.pressure).is_ok(), "{name}");
    }
}

/// What was changed by hand.
#[test]
fn states_that_were_tampered_with_are_refused() {
    let surface = rough(&grid(), 10);
    let kernel = &kernels(grid())[0].1;
    let mut path = LoadingSolver::new(&surface, kernel).unwrap();
    let all: Vec<_> = path.by_ref().map(Result::unwrap).collect();
    let state = all[80];
    for change in [0.99, 1.01, f64::NAN, f64::INFINITY] {
        let mut other = state;
        other.contact.load *= change;
        assert_refused(&mut path, &other, "load");
        let mut other = state;
        other.contact.approach *= change;
        assert_refused(&mut path, &other, "approach");
    }
    let mut other = state;
    other.step = 40;
    assert_refused(&mut path, &other, "step");
    // And nothing of that harms the path.
    let again = path.fields_at(&state).unwrap().pressure;
    let load = again.sum() * path.grid().cell_area();
    assert!((load / state.contact.load - 1.0).abs() < 1e-12);
}
