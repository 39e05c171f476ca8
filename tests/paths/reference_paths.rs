//! Paths against event files made by dense solvers that share no code with this crate.

use crate::common::{Event, read_events, surface, with_window};
use asperity::loading::LoadingSolver;
use asperity::updater::{ConjugateGradient, Dense, LinearUpdater, RecursiveCholesky};
use asperity::{Boussinesq, Grid, LoadingState};

const SIDE: f64 = 1e-2;

/// Same node at every step, every column within 1e-9: the event files come from LU solves with a
/// condition number of some 10³, so that both sides err by 1e-12 at most; the last mean gaps before
/// full contact are 1e-5 of the first and lose as many digits.
fn compare(name: &str, tolerance: f64, events: &[Event], states: &[LoadingState]) {
    let mut worst = 0.0_f64;
    for (event, state) in events.iter().zip(states) {
        let context = format!("{name}, step {}", event.step);
        assert_eq!((event.step, event.node), (state.step, state.node), "{context}");
        for (column, expected, found) in [
            ("approach", event.approach, state.contact.approach),
            ("load", event.load, state.contact.load),
            ("contact_area", event.contact_area, state.contact.contact_area),
            ("fraction", event.contact_area_fraction, state.contact.contact_area_fraction),
            ("mean_gap", event.mean_gap, state.contact.mean_gap),
            (
                "contact_stiffness",
                event.contact_stiffness,
                state.contact.contact_stiffness.unwrap(),
            ),
            (
                "interfacial",
                event.interfacial_stiffness,
                state.contact.interfacial_stiffness.unwrap(),
            ),
        ] {
            if expected == found {
                continue;
            }
            let error = ((found - expected) / expected).abs();
            worst = worst.max(error);
            assert!(error < tolerance, "{context}: {column} {found} for {expected}: {error:e}");
        }
    }
    println!("{name}: worst relative error {worst:e}");
    assert_eq!(events.len(), states.len(), "{name}");
}

fn run<U: LinearUpdater>(file: &str, updater: U, window: Option<usize>, nodes: usize) {
    let heights = surface(file);
    let events = read_events(file);
    let nodes = nodes.min(events.len());
    let grid = Grid::square(heights.matrix().nrows(), SIDE).unwrap();
    let kernel = Boussinesq::new(grid, 1.0).unwrap();
    let builder = LoadingSolver::builder(&heights, &kernel).updater(updater).max_nodes(nodes);
    let mut solver = with_window(builder, window).build().unwrap();
    let states: Vec<_> = solver.by_ref().map(Result::unwrap).collect();
    compare(&format!("{file}, window {window:?}"), 1e-9, &events[..nodes], &states);
}

#[test]
fn cholesky_window_1() {
    run("selfaffine_48", RecursiveCholesky::new(), Some(1), usize::MAX);
    run("selfaffine_40_full", RecursiveCholesky::new(), Some(1), usize::MAX);
}

#[test]
fn cholesky_window_7() {
    run("selfaffine_48", RecursiveCholesky::new(), Some(7), usize::MAX);
    run("selfaffine_40_full", RecursiveCholesky::new(), Some(7), usize::MAX);
}

#[test]
fn cholesky_window_automatic() {
    run("selfaffine_48", RecursiveCholesky::new(), None, usize::MAX);
    run("selfaffine_40_full", RecursiveCholesky::new(), None, usize::MAX);
}

#[test]
fn dense_window_automatic() {
    run("selfaffine_48", Dense::new(), None, usize::MAX);
    run("selfaffine_40_full", Dense::new(), None, usize::MAX);
}

/// The same nodes without a factor. What lies between the ends of windows is checked in `without_factor`.
fn without_factor(file: &str, window: Option<usize>) {
    let heights = surface(file);
    let grid = Grid::square(heights.matrix().nrows(), SIDE).unwrap();
    let kernel = Boussinesq::new(grid, 1.0).unwrap();
    let events = read_events(file);
    let builder = LoadingSolver::builder(&heights, &kernel)
        .updater(ConjugateGradient::new())
        .max_nodes(events.len());
    let path = with_window(builder, window).build().unwrap();
    let nodes: Vec<_> = path.map(|state| state.unwrap().node).collect();
    let expected: Vec<_> = events.iter().map(|event| event.node).collect();
    assert!(nodes == expected, "{file}, window {window:?}");
}

#[test]
fn conjugate_gradient_window_automatic() {
    without_factor("selfaffine_48", None);
    without_factor("selfaffine_40_full", None);
}

#[test]
fn conjugate_gradient_window_5() {
    without_factor("selfaffine_48", Some(5));
    without_factor("selfaffine_40_full", Some(5));
}

/// Every event refactored from scratch; O(n⁴) for a path, so that only its beginning is affordable.
#[test]
fn dense_windows_1_and_7() {
    for file in ["selfaffine_48", "selfaffine_40_full"] {
        run(file, Dense::new(), Some(1), 150);
        run(file, Dense::new(), Some(7), 400);
    }
}
