//! States cost no allocation: only a new window does.
#![allow(clippy::unwrap_used, missing_docs)]

use allocation_counter::measure;
use asperity::surface::Paraboloid;
use asperity::updater::{LinearUpdater, RecursiveCholesky};
use asperity::{Boussinesq, Grid, LoadingSolver, SelfAffine, Surface};

/// One call of `next`.
struct Call {
    renewed_window: bool,
    allocations: u64,
}

/// Every call of `next` of a path to 20 % contact on 64 × 64 nodes.
fn calls<S, U>(surface: S, updater: U, window: Option<usize>) -> Vec<Call>
where
    S: Surface + Sync,
    U: LinearUpdater + Send,
{
    // Allocations are counted by thread: all the work in one.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.unwrap().install(|| {
        let kernel = Boussinesq::new(Grid::square(64, 2.5e-3).unwrap(), 1.0).unwrap();
        let mut builder =
            LoadingSolver::builder(&surface, &kernel).updater(updater).max_area_fraction(0.2);
        if let Some(size) = window {
            builder = builder.window_size(size);
        }
        let mut path = builder.build().unwrap();
        let mut calls = Vec::new();
        loop {
            let windows = path.timings().windows;
            let mut yielded = false;
            let counted = measure(|| yielded = path.next().is_some_and(|state| state.is_ok()));
            if !yielded {
                break;
            }
            calls.push(Call {
                renewed_window: path.timings().windows > windows,
                allocations: counted.count_total,
            });
        }
        assert_eq!(calls.len(), 819);
        calls
    })
}

/// Calls that allocated although they did not renew the window.
fn other_allocations(calls: &[Call]) -> usize {
    let others = calls.iter().filter(|call| !call.renewed_window);
    others.filter(|call| call.allocations > 0).count()
}

fn windows(calls: &[Call]) -> usize {
    calls.iter().filter(|call| call.renewed_window).count()
}

#[test]
fn the_counter_counts() {
    let calls = calls(SelfAffine::zhang2020(1), RecursiveCholesky::new(), Some(32));
    assert!(calls[0].renewed_window && calls[0].allocations > 0);
}

#[test]
fn states_of_a_window_allocate_nothing() {
    for window in [16, 32, 100] {
        let rough = calls(SelfAffine::zhang2020(1), RecursiveCholesky::new(), Some(window));
        let smooth = calls(Paraboloid::new(1.0).unwrap(), RecursiveCholesky::new(), Some(window));
        for calls in [rough, smooth] {
            // The factor inside a window grows by doubling up to the first window that is all used:
            // a steady state after the first third of the path.
            let steady = &calls[calls.len() / 3..];
            assert_eq!(other_allocations(steady), 0, "window {window}");
            assert!(other_allocations(&calls) < 16, "window {window}");
            assert!(windows(steady) * window < 4 * steady.len());
        }
    }
}

#[test]
fn growing_windows_allocate_a_few_times_in_all() {
    let calls = calls(SelfAffine::zhang2020(1), RecursiveCholesky::new(), None);
    // Each doubles a buffer whose last size is below 2^17 numbers.
    assert!(other_allocations(&calls) <= 17);
    assert!(windows(&calls) < calls.len() / 4);
}
