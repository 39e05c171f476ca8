//! A path that goes on beyond its limit is the path that was never interrupted.

use crate::problems::{grid, kernels, rough, states};
use asperity::loading::{ContactEvent, LoadingEnd};
use asperity::updater::{ConjugateGradient, Handover, LinearUpdater, RecursiveCholesky};
use asperity::{ContactTarget, Error, LoadingSolver, LoadingState};
use asperity_testing::close::assert_close;

/// The events of a path that stops at every target, without the states at the limits.
fn interrupted<U: LinearUpdater>(
    path: &mut LoadingSolver<U>,
    targets: &[(ContactTarget, LoadingEnd)],
) -> Vec<LoadingState> {
    let mut events = Vec::new();
    for (target, end) in targets {
        path.continue_to(*target).unwrap();
        assert_eq!(path.end(), None);
        for state in path.by_ref() {
            let state = state.unwrap();
            if state.event != ContactEvent::Limit {
                events.push(state);
            }
        }
        assert_eq!(path.end(), Some(*end), "{target:?}");
        // Fields at the limit do not change what follows.
        path.certificate().unwrap();
    }
    events
}

/// Targets of every kind, at and between events, to the end of the path.
fn targets(all: &[LoadingState]) -> Vec<(ContactTarget, LoadingEnd)> {
    let nodes = all.len() as f64;
    vec![
        (
            ContactTarget::Load(0.3 * all[10].contact.load + 0.7 * all[11].contact.load),
            LoadingEnd::Load,
        ),
        (
            ContactTarget::Load(0.2 * all[10].contact.load + 0.8 * all[11].contact.load),
            LoadingEnd::Load,
        ),
        (ContactTarget::AreaFraction(60.0 / nodes), LoadingEnd::AreaFraction),
        (
            ContactTarget::MeanGap(0.5 * (all[100].contact.mean_gap + all[101].contact.mean_gap)),
            LoadingEnd::MeanGap,
        ),
        (
            ContactTarget::Approach(
                0.9 * all[180].contact.approach + 0.1 * all[181].contact.approach,
            ),
            LoadingEnd::Approach,
        ),
        (ContactTarget::AreaFraction(1.0), LoadingEnd::FullContact),
    ]
}

#[test]
fn continued_paths_are_uninterrupted_ones() {
    let surface = rough(&grid(), 3);
    for (name, kernel) in kernels(grid()) {
        let all = states(&surface, &kernel);
        let builder = LoadingSolver::builder(&surface, &kernel).max_nodes(3);
        let mut path = builder.build().unwrap();
        let mut events: Vec<_> = path.by_ref().map(Result::unwrap).collect();
        assert_eq!(path.end(), Some(LoadingEnd::Nodes));
        events.extend(interrupted(&mut path, &targets(&all)));
        assert_eq!(events.len(), all.len(), "{name}");
        for (found, expected) in events.iter().zip(&all) {
            assert_eq!((found.step, found.node), (expected.step, expected.node), "{name}");
            // Windows that end elsewhere: rounding only.
            assert_close(found, expected, 1e-12, all[0].contact.mean_gap);
        }
    }
}

fn continues_with<U: LinearUpdater + Clone>(updater: U, tolerance: f64) {
    let surface = rough(&grid(), 4);
    let kernel = &kernels(grid())[0].1;
    let builder = LoadingSolver::builder(&surface, kernel).updater(updater);
    let path = builder.clone().build().unwrap();
    let all: Vec<_> = path.map(Result::unwrap).collect();
    let mut path = builder.max_nodes(1).build().unwrap();
    let mut events: Vec<_> = path.by_ref().map(Result::unwrap).collect();
    events.extend(interrupted(&mut path, &targets(&all)));
    assert_eq!(events.len(), all.len());
    for (found, expected) in events.iter().zip(&all) {
        assert_eq!(found.node, expected.node);
        assert_close(found, expected, tolerance, all[0].contact.mean_gap);
    }
}

#[test]
fn every_updater_goes_on() {
    continues_with(RecursiveCholesky::new(), 1e-12);
    continues_with(Handover::new(), 1e-12);
    // Windows end elsewhere, and between their ends states are off by some 1e-6; with 200 nodes in all they
    // are long.
    continues_with(ConjugateGradient::new(), 3e-4);
}

#[test]
fn targets_that_are_not_beyond_are_refused() {
    let surface = rough(&grid(), 5);
    let kernel = &kernels(grid())[0].1;
    let builder = LoadingSolver::builder(&surface, kernel).max_area_fraction(0.3);
    let mut path = builder.build().unwrap();
    let last = path.by_ref().last().unwrap().unwrap();
    for target in [
        ContactTarget::Load(last.contact.load),
        ContactTarget::Load(0.5 * last.contact.load),
        ContactTarget::Approach(last.contact.approach),
        ContactTarget::AreaFraction(last.contact.contact_area_fraction),
        ContactTarget::MeanGap(last.contact.mean_gap),
        ContactTarget::MeanGap(1.1 * last.contact.mean_gap),
    ] {
        let error = path.continue_to(target).unwrap_err();
        assert!(matches!(error, Error::OutOfRange { .. }), "{target:?}: {error}");
        // Still at its end, and the same state.
        assert_eq!(path.end(), Some(LoadingEnd::AreaFraction));
        assert!(path.next().is_none());
        assert_eq!(path.state(), Some(last));
    }
    let error = path.continue_to(ContactTarget::Load(-1.0)).unwrap_err();
    assert!(matches!(error, Error::NotPositive { .. }), "{error}");
    path.continue_to(ContactTarget::Load(2.0 * last.contact.load)).unwrap();
    assert!(path.last().unwrap().unwrap().contact.load == 2.0 * last.contact.load);
}

#[test]
fn a_path_that_failed_does_not_go_on() {
    let surface = rough(&grid(), 6);
    let kernel = &kernels(grid())[0].1;
    // Not enough for the whole factor.
    let builder = || LoadingSolver::builder(&surface, kernel).updater(RecursiveCholesky::new());
    let budget = builder().build().unwrap().bytes() + 20_000;
    let mut path = builder().memory_budget(budget).build().unwrap();
    let error = path.find_map(Result::err).unwrap();
    assert!(matches!(error, Error::MemoryBudget { .. }), "{error}");
    assert_eq!(path.end(), Some(LoadingEnd::Memory));
    let error = path.continue_to(ContactTarget::Load(1e9)).unwrap_err();
    assert!(matches!(error, Error::CannotContinue { .. }), "{error}");
    assert_eq!(path.end(), Some(LoadingEnd::Memory));
}
