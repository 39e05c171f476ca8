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
        assert_eq!(
            (event.step, event.node),
            (state.step, state.node),
            "{context}"
        );
        for (column, expected, found) in [
            ("approach", event.approach, state.approach),
            ("load", event.load, state.load),
            ("contact_area", event.contact_area, state.contact_area),
            (
                "fraction",
                event.contact_area_fraction,
                state.contact_area_fraction,
            ),
            ("mean_gap", event.mean_gap, state.mean_gap),
            (
                "contact_stiffness",
                event.contact_stiffness,
                state.contact_stiffness.unwrap(),
            ),
            (
                "interfacial",
                event.interfacial_stiffness,
                state.interfacial_stiffness.unwrap(),
            ),
        ] {
            if expected == found {
                continue;
            }
            let error = ((found - expected) / expected).abs();
            worst = worst.max(error);
            assert!(
                error < tolerance,
                "{context}: {column} {found} for {expected}: {error:e}"
            );
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
    let builder = LoadingSolver::builder(&heights, &kernel)
        .updater(updater)
        .max_nodes(nodes);
    let mut solver = with_window(builder, window).build().unwrap();
    let states: Vec<_> = solver.by_ref().map(Result::unwrap).collect();
    // What changes between two refreshes carries errors of single precision, 6e-8.
    let tolerance = if solver.updater().profile().exact {
        1e-9
    } else {
        1e-7
    };
    compare(
        &format!("{file}, window {window:?}"),
        tolerance,
        &events[..nodes],
        &states,
    );
}

#[test]
fn cholesky_window_1() {
    run(
        "selfaffine_48",
        RecursiveCholesky::new(),
        Some(1),
        usize::MAX,
    );
    run(
        "selfaffine_40_full",
        RecursiveCholesky::new(),
        Some(1),
        usize::MAX,
    );
}

#[test]
fn cholesky_window_7() {
    run(
        "selfaffine_48",
        RecursiveCholesky::new(),
        Some(7),
        usize::MAX,
    );
    run(
        "selfaffine_40_full",
        RecursiveCholesky::new(),
        Some(7),
        usize::MAX,
    );
}

#[test]
fn cholesky_window_automatic() {
    run("selfaffine_48", RecursiveCholesky::new(), None, usize::MAX);
    run(
        "selfaffine_40_full",
        RecursiveCholesky::new(),
        None,
        usize::MAX,
    );
}

#[test]
fn dense_window_automatic() {
    run("selfaffine_48", Dense::new(), None, usize::MAX);
    run("selfaffine_40_full", Dense::new(), None, usize::MAX);
}

/// Without a factor: every window costs solves by conjugate gradients.
#[test]
fn conjugate_gradient_window_automatic() {
    run("selfaffine_48", ConjugateGradient::new(), None, usize::MAX);
    // At the last nodes the mean gap, 1e-5 of the first, has lost five of the twelve digits.
    run("selfaffine_40_full", ConjugateGradient::new(), None, 1500);
}

#[test]
fn conjugate_gradient_window_5() {
    run("selfaffine_48", ConjugateGradient::new(), Some(5), 150);
}

/// Every event refactored from scratch; O(n⁴) for a path, so that only its beginning is affordable.
#[test]
fn dense_windows_1_and_7() {
    for file in ["selfaffine_48", "selfaffine_40_full"] {
        run(file, Dense::new(), Some(1), 150);
        run(file, Dense::new(), Some(7), 400);
    }
}
