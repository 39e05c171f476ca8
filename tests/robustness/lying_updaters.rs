//! Updaters that skip calls, or answer them for another contact: an error or nonsense, and never a panic.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use asperity::loading::LoadingEnd;
use asperity::surface::HeightMap;
use asperity::updater::{ConjugateGradient, LinearUpdater, RecursiveCholesky};
use asperity::{Boussinesq, Grid, InfluenceKernel, LoadingSolver, Spectral};
use asperity_testing::{Altered, Call};
use nalgebra::DMatrix;

/// An updater that skips every n-th call of a kind, or answers it for another contact. It counts how often.
fn lying(
    inner: Box<dyn LinearUpdater>,
    (what, turn): (&'static str, usize),
    struck: &Arc<AtomicUsize>,
) -> impl LinearUpdater {
    let mut calls = 0_usize;
    let (struck, of_memory) = (struck.clone(), struck.clone());
    let mut lies = move |lie: &str| {
        calls += usize::from(what == lie);
        let strikes = what == lie && calls.is_multiple_of(turn);
        struck.fetch_add(usize::from(strikes), Ordering::Relaxed);
        strikes
    };
    Altered::new(inner)
        .on_call(move |inner, call| {
            match call {
                Call::Watch { problem, contact, nodes, schur } if lies("watch others") => {
                    let all = 0..problem.grid().nodes();
                    let others: Vec<usize> = all.rev().take(nodes.len()).collect();
                    return inner.watch(problem, contact, &others, schur);
                }
                Call::Watch { nodes, schur, .. } if lies("watch nothing") => {
                    return schur.resize(nodes.len());
                }
                Call::Join { .. } if lies("join nothing") => return Ok(()),
                Call::Truncate { .. } if lies("truncate nothing") => return Ok(()),
                Call::Release { .. } if lies("release nothing") => return Ok(()),
                _ => call.ask(inner)?,
            }
            match call {
                Call::Watch { schur, .. } => {
                    if lies("huge complement") {
                        schur.matrix_mut().fill(f64::MAX);
                    }
                    if lies("negative complement") {
                        schur.matrix_mut().fill(-1.0);
                    }
                    if lies("infinite sums") {
                        schur.row_sums_mut().fill(f64::INFINITY);
                    }
                }
                Call::Solve { solution, .. } => {
                    for (what, value) in [
                        ("NaN pressure", f64::NAN),
                        ("infinite pressure", f64::INFINITY),
                        ("no pressure", 0.0),
                        ("negative pressure", -1.0),
                    ] {
                        if lies(what) {
                            solution.pressure.fill(value);
                        }
                    }
                    for (what, value) in [
                        ("NaN rate", f64::NAN),
                        ("infinite rate", f64::INFINITY),
                        ("no rate", 0.0),
                        ("negative rate", -1.0),
                    ] {
                        if lies(what) {
                            solution.rate.fill(value);
                        }
                    }
                }
                _ => {}
            }
            Ok(())
        })
        .on_bytes(move |inner, (contact, watched)| match what {
            "all memory" => {
                of_memory.fetch_add(1, Ordering::Relaxed);
                usize::MAX
            }
            _ => inner.bytes(contact, watched),
        })
}

const LIES: [&str; 17] = [
    "watch others",
    "watch nothing",
    "huge complement",
    "negative complement",
    "infinite sums",
    "join nothing",
    "NaN pressure",
    "infinite pressure",
    "no pressure",
    "negative pressure",
    "NaN rate",
    "infinite rate",
    "no rate",
    "negative rate",
    "truncate nothing",
    "release nothing",
    "all memory",
];

/// A path with such an updater comes to an end, and delivers no state that is not finite.
#[test]
fn lying_updaters() {
    let grid = Grid::new(6, 5, 1.0, 1.0).unwrap();
    let heights = DMatrix::from_fn(6, 5, |ix, iy| ((3 * ix + 5 * iy * iy) as f64).sin());
    let rough = HeightMap::new(heights).unwrap();
    let kernels: [&dyn InfluenceKernel; 2] =
        [&Boussinesq::new(grid, 1.0).unwrap(), &Spectral::new(grid, 1.0).unwrap()];
    let mut strikes = LIES.map(|_| Arc::new(AtomicUsize::new(0)));
    for kernel in kernels {
        let mut states = 0;
        for (what, struck) in LIES.into_iter().zip(&mut strikes) {
            for turn in 1..4 {
                for (exact, hardness) in
                    [(true, f64::INFINITY), (false, f64::INFINITY), (true, 0.2)]
                {
                    let inner: Box<dyn LinearUpdater> = if exact {
                        Box::new(RecursiveCholesky::new())
                    } else {
                        Box::new(ConjugateGradient::new())
                    };
                    let builder = LoadingSolver::builder(&rough, kernel).hardness(hardness);
                    let builder = builder.updater(lying(inner, (what, turn), struck));
                    // Nothing is asked of an updater before the first state.
                    let mut path = builder.window_size(4).build().unwrap();
                    let mut count = 0;
                    while let Some(item) = path.next() {
                        count += 1;
                        assert!(count < 1000, "{what} has no end");
                        let Ok(state) = item else { continue };
                        states += 1;
                        for value in [
                            state.contact.approach,
                            state.contact.load,
                            state.contact.mean_gap,
                            state.contact.energy,
                        ] {
                            assert!(value.is_finite(), "{what}: {state:?}");
                        }
                        let _ = (
                            path.fields().map(|fields| fields.pressure),
                            path.fields().map(|fields| fields.gap),
                            path.certificate(),
                        );
                    }
                    // On these half-spaces contact grows to its end: what ends it early is an error.
                    assert_ne!(path.end(), Some(LoadingEnd::NoMoreEvents), "{what} {turn}");
                }
            }
        }
        println!("{states} states");
        // Of 17 × 9 paths of 30 nodes.
        assert!(states > 900, "{states}");
    }
    for (what, struck) in LIES.iter().zip(strikes) {
        let struck = struck.load(Ordering::Relaxed);
        println!("{what}: {struck}");
        assert!(struck > 0, "{what} was never told");
    }
}
