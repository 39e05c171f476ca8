//! The factor hands over to iterations where it no longer fits: the path goes on as if it did.

use crate::common::surface;
use asperity::updater::{Handover, LinearUpdater, RecursiveCholesky};
use asperity::{Boussinesq, Error, Grid, LoadingSolver, LoadingState};

fn path<U: LinearUpdater>(updater: U, budget: Option<usize>, nodes: usize) -> LoadingSolver<U> {
    let grid = Grid::square(48, 1e-2).unwrap();
    let (heights, kernel) = (
        surface("selfaffine_48"),
        Boussinesq::new(grid, 1.0).unwrap(),
    );
    let mut builder = LoadingSolver::builder(&heights, &kernel)
        .updater(updater)
        .max_nodes(nodes);
    if let Some(bytes) = budget {
        builder = builder.memory_budget(bytes);
    }
    builder.build().unwrap()
}

/// Exact to rounding before the seam; between the ends of windows behind it 3e-4 at worst, see
/// `without_factor`.
fn compare(context: &str, found: &[LoadingState], expected: &[LoadingState]) {
    assert_eq!(found.len(), expected.len(), "{context}");
    for (found, expected) in found.iter().zip(expected) {
        assert_eq!(
            found.node, expected.node,
            "{context}, step {}",
            expected.step
        );
        for (found, expected) in [
            (found.approach, expected.approach),
            (found.load, expected.load),
            (found.mean_gap, expected.mean_gap),
            (
                found.contact_stiffness.unwrap(),
                expected.contact_stiffness.unwrap(),
            ),
            (
                found.interfacial_stiffness.unwrap(),
                expected.interfacial_stiffness.unwrap(),
            ),
            (found.energy, expected.energy),
        ] {
            let error = (found - expected).abs();
            assert!(
                error <= 3e-4 * expected.abs(),
                "{context}: {found} {expected}"
            );
        }
    }
}

#[test]
fn the_same_path_on_both_sides_of_the_seam() {
    const NODES: usize = 900;
    let mut whole = path(RecursiveCholesky::new(), None, NODES);
    let expected: Vec<_> = whole.by_ref().map(Result::unwrap).collect();
    let early = expected[150];
    let early_pressure = whole.pressure_at(&early).unwrap();
    let pressure = whole.pressure().unwrap();
    let mut seams = Vec::new();
    for budget in (1_500_000..5_500_000).step_by(500_000) {
        let context = format!("budget {budget}");
        let mut path = path(Handover::new(), Some(budget), NODES);
        let mut states = Vec::new();
        let mut seam = None;
        let ended = loop {
            match path.next() {
                None => break Ok(()),
                Some(Ok(state)) => states.push(state),
                Some(Err(error)) => break Err(error),
            }
            seam = seam.or(path.updater().handed_over_at());
        };
        if let Err(error) = ended {
            // Not even the fields of the grid that an iteration needs.
            assert!(matches!(error, Error::MemoryBudget { .. }), "{error}");
            continue;
        }
        compare(&context, &states, &expected);
        seams.extend(seam);
        // Fields at the end, and at a state on the other side of the seam.
        for (found, expected) in [
            (path.pressure().unwrap(), &pressure),
            (path.pressure_at(&early).unwrap(), &early_pressure),
        ] {
            assert!(
                (found - expected).amax() <= 1e-5 * expected.amax(),
                "{context}"
            );
        }
    }
    println!("seams {seams:?}");
    assert!(
        seams.iter().filter(|&&n| n > 0 && n < NODES).count() >= 2,
        "{seams:?}"
    );
}

#[test]
fn no_seam_without_need() {
    let mut path = path(Handover::new(), None, 300);
    assert_eq!(path.by_ref().map(Result::unwrap).count(), 300);
    assert_eq!(path.updater().handed_over_at(), None);
}
