//! Memory budgets: every state that fits, then an error that says what would have fitted.

use crate::common::Sphere;
use asperity::loading::{LoadingBuilder, LoadingEnd};
use asperity::updater::RecursiveCholesky;
use asperity::{Error, LoadingState};

/// A path that keeps its factor: the default would hand over instead of coming to an end.
fn factored(sphere: &Sphere) -> LoadingBuilder<'_, RecursiveCholesky> {
    sphere.builder().updater(RecursiveCholesky::new())
}

#[test]
fn memory_budgets() {
    let sphere = Sphere::on(24);
    // Not even the grid fits.
    for budget in [0, 1, 1000] {
        let error = match factored(&sphere).memory_budget(budget).build() {
            Ok(mut path) => path.next().unwrap().unwrap_err(),
            Err(error) => error,
        };
        let Error::MemoryBudget { needed, budget: told, nodes_that_fit } = error else {
            panic!("{error}");
        };
        assert_eq!((told, nodes_that_fit), (budget, 0));
        assert!(needed > budget);
    }
    // Enough for a part of the path.
    let all: Vec<LoadingState> = factored(&sphere).build().unwrap().map(Result::unwrap).collect();
    let mut seen = Vec::new();
    for budget in (200_000..8_000_000).step_by(100_000) {
        let mut path = factored(&sphere).memory_budget(budget).build().unwrap();
        let mut states = Vec::new();
        let error = loop {
            match path.next() {
                None => break None,
                Some(Ok(state)) => states.push(state),
                Some(Err(error)) => break Some(error),
            }
        };
        // Every state up to there is that of the path without a budget.
        // Close to the limit windows are smaller, and rounding differs: 1e-11 as between windows.
        for (state, expected) in states.iter().zip(&all) {
            let change = state.contact.load - expected.contact.load;
            assert!(change.abs() <= 1e-11 * expected.contact.load, "{state:?} {expected:?}");
        }
        for _ in 0..3 {
            assert!(path.next().is_none(), "fused");
        }
        assert_eq!(path.state(), states.last().copied());
        let Some(error) = error else {
            assert_eq!(states.len(), all.len());
            seen.push(states.len());
            continue;
        };
        let Error::MemoryBudget { needed, budget: told, nodes_that_fit } = error else {
            panic!("{error}");
        };
        assert_eq!(told, budget);
        assert_eq!(path.end(), Some(LoadingEnd::Memory));
        assert!(needed > budget);
        assert!(states.len() <= nodes_that_fit && nodes_that_fit < all.len());
        seen.push(states.len());
        if !states.is_empty() {
            // What was reached can still be asked for.
            assert!(path.certificate().unwrap().least_pressure >= -1e-12);
        }
    }
    assert!(seen.is_sorted(), "{seen:?}");
    assert!(seen.iter().any(|n| (50..500).contains(n)), "{seen:?}");
    assert_eq!(seen.last(), Some(&all.len()));
}

/// What `nodes_that_fit` promises.
#[test]
fn the_nodes_that_fit_do_fit() {
    let sphere = Sphere::on(24);
    let mut partial = 0;
    for budget in (200_000..8_000_000).step_by(200_000) {
        let mut path = factored(&sphere).memory_budget(budget).build().unwrap();
        let Some(Err(Error::MemoryBudget { nodes_that_fit, .. })) = path.find(Result::is_err)
        else {
            continue;
        };
        if nodes_that_fit == 0 {
            // No path: that many nodes are refused as a limit.
            continue;
        }
        let again = factored(&sphere).memory_budget(budget).max_nodes(nodes_that_fit);
        let count = again.build().unwrap().map_while(Result::ok).count();
        assert_eq!(count, nodes_that_fit, "budget {budget}");
        partial += usize::from(nodes_that_fit > 0);
    }
    assert!(partial > 3);
}
