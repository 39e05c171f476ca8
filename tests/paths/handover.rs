//! The factor hands over to iterations where it no longer fits: the path goes on as if it did.

use crate::common::surface;
use asperity::loading::{factor_seconds, iteration_seconds, last_factor};
use asperity::updater::{Handover, LinearUpdater, RecursiveCholesky};
use asperity::{Boussinesq, Error, Grid, LoadingSolver, LoadingState};

fn path<U: LinearUpdater>(updater: U, budget: Option<usize>, nodes: usize) -> LoadingSolver<U> {
    let grid = Grid::square(48, 1e-2).unwrap();
    let (heights, kernel) = (surface("selfaffine_48"), Boussinesq::new(grid, 1.0).unwrap());
    let mut builder = LoadingSolver::builder(&heights, &kernel).updater(updater).max_nodes(nodes);
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
        assert_eq!(found.node, expected.node, "{context}, step {}", expected.step);
        for (found, expected) in [
            (found.contact.approach, expected.contact.approach),
            (found.contact.load, expected.contact.load),
            (found.contact.mean_gap, expected.contact.mean_gap),
            (found.contact.contact_stiffness.unwrap(), expected.contact.contact_stiffness.unwrap()),
            (
                found.contact.interfacial_stiffness.unwrap(),
                expected.contact.interfacial_stiffness.unwrap(),
            ),
            (found.contact.energy, expected.contact.energy),
        ] {
            let error = (found - expected).abs();
            assert!(error <= 3e-4 * expected.abs(), "{context}: {found} {expected}");
        }
    }
}

#[test]
fn the_same_path_on_both_sides_of_the_seam() {
    const NODES: usize = 900;
    let mut whole = path(RecursiveCholesky::new(), None, NODES);
    let expected: Vec<_> = whole.by_ref().map(Result::unwrap).collect();
    let early = expected[150];
    let early_pressure = whole.fields_at(&early).unwrap().pressure;
    let pressure = whole.fields().unwrap().pressure;
    let fixed = path(Handover::new(), None, NODES).bytes();
    let (mut seams, mut cut) = (Vec::new(), 0);
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
            seam = seam.or(path.handed_over_at());
        };
        if let Err(error) = ended {
            // Not even the fields of the grid that an iteration needs: a factor up to where it fits. The message speaks
            // of the budget that was given, and all fields of the states up to there are known.
            let given = matches!(error, Error::MemoryBudget { budget: told, .. } if told == budget);
            assert!(given, "{error}");
            compare(&context, &states, &expected[..states.len()]);
            let last = states.last().copied().unwrap();
            assert_eq!(path.state(), Some(last));
            assert_eq!(path.contact_order().len(), states.len());
            let found = path.fields().unwrap().pressure;
            let exact = whole.fields_at(&last).unwrap().pressure;
            assert!((&found - &exact).amax() <= 1e-9 * exact.amax(), "{context}");
            assert!(path.certificate().unwrap().least_gap > -1e-9, "{context}");
            // What is left is less than one more node with its window takes.
            let bytes = match path.updater() {
                Some(factor) => factor.bytes(states.len() + 1, 1) + fixed,
                // Iterations hold 1000 bytes for each node in contact.
                None => path.bytes() + 1000,
            };
            let bytes = bytes + (1 << 14);
            assert!(bytes > budget, "{context}: {bytes}");
            cut += 1;
            continue;
        }
        compare(&context, &states, &expected);
        seams.extend(seam);
        // Fields at the end, and at a state on the other side of the seam.
        for (found, expected) in [
            (path.fields().unwrap().pressure, &pressure),
            (path.fields_at(&early).unwrap().pressure, &early_pressure),
        ] {
            assert!((found - expected).amax() <= 1e-5 * expected.amax(), "{context}");
        }
    }
    println!("seams {seams:?}, {cut} cut");
    assert!(cut >= 2, "{cut}");
    assert!(seams.iter().filter(|&&n| n > 0 && n < NODES).count() >= 2, "{seams:?}");
}

#[test]
fn no_seam_without_need() {
    let mut path = path(Handover::new(), None, 300);
    assert_eq!(path.by_ref().map(Result::unwrap).count(), 300);
    assert_eq!(path.handed_over_at(), None);
}

/// A new one has a factor, and knows no seam.
#[test]
fn the_default_is_a_new_one() {
    let default = Handover::default();
    assert_eq!(path(Handover::default(), None, 300).handed_over_at(), None);
    assert_eq!(default.bytes(100, 10), Handover::new().bytes(100, 10));
}

/// An event costs n² times 10 ps, or 0.2 ms, 3.5 ns for each node of the grid and 4 ns for each one in contact,
/// whichever is less: they are equal at the root of a quadratic equation.
#[test]
fn a_factor_is_given_up_where_both_cost_the_same() {
    for side in [64_usize, 128, 256, 512, 2048] {
        let nodes = side * side;
        let iterations = |contact: f64| 2e-4 + 3.5e-9 * nodes as f64 + 4e-9 * contact;
        let discriminant = 4e-9_f64.powi(2) + 4.0 * 1e-11 * iterations(0.0);
        let root = (4e-9 + discriminant.sqrt()) / 2e-11;
        // The first number at which a factor is dearer, if there are so many nodes; rounding does not reach the next.
        let last = (root.floor() as usize + 1).min(nodes);
        assert_eq!(last_factor(nodes), last, "{side}");
        for contact in [1, last / 2, last - 1, last, last + 1, 2 * last] {
            let n = contact as f64;
            let expected = (1e-11 * n * n).min(iterations(n));
            let found = factor_seconds(contact).min(iteration_seconds(nodes, contact));
            // A few rounding errors of the same sum.
            assert!((found / expected - 1.0).abs() < 1e-14, "{side}: {contact}");
        }
    }
}
