//! Paths without a factor on cells that are longer than wide, and those that they are not made for.

use crate::without_factor::{Tolerances, compare, half_spaces, states};
use asperity::surface::HeightMap;
use asperity::updater::{ConjugateGradient, Handover, LinearUpdater, RecursiveCholesky};
use asperity::{
    Error, Grid, InfluenceKernel, LoadingSolver, LoadingState, PeriodicBoussinesq, Spectral,
};
use asperity_testing::surfaces::scattered;
use nalgebra::DMatrix;

/// Heights that know nothing of each other, without ties.
fn uncorrelated(nx: usize, ny: usize) -> HeightMap {
    let height = |node: usize| (node as f64 * 0.618_033_988_749_894_9).fract();
    // Neighbours of a golden sequence are related: a square of the index is not.
    let heights = DMatrix::from_fn(nx, ny, |ix, iy| height((ix + nx * iy).pow(2)));
    HeightMap::new(heights).unwrap()
}

/// More nodes than a local solution takes in, so that it has to choose: the same events, and states as exact as their
/// estimates say. Where nodes were looked for within 32 of the shorter sides only, loads were off by 8e-4 on a free
/// half-space, and one error in fifty exceeded its estimate, by up to 200 times.
#[test]
fn long_cells_have_the_events_of_the_factor() {
    let surface = uncorrelated(40, 40);
    for (dx, dy, half_spaces_tried) in [(10.0, 1.0, 3), (1.0, 10.0, 3), (1.0, 100.0, 1)] {
        let (mut events, mut exceeded) = (0, 0);
        let grid = Grid::new(40, 40, dx, dy).unwrap();
        for (name, kernel) in half_spaces(grid).into_iter().take(half_spaces_tried) {
            let exact = states(&surface, &kernel, RecursiveCholesky::new(), None);
            let found = states(&surface, &kernel, ConjugateGradient::new(), None);
            // A window is a large part of so short a path, and long waves of a periodic one are far softer than short
            // ones.
            let allowed = Tolerances {
                load: if name == "free" { 2e-5 } else { 2e-4 },
                stiffness: 3e-6,
                interfacial: 3e-4,
                mean_gap: 3e-5,
            };
            let context = format!("{name}, {dx} : {dy}");
            exceeded += compare(&context, &found, &exact, &allowed);
            events += exact.len();
        }
        println!("{dx} : {dy}: {exceeded} of {events} errors exceed their estimate");
        assert!(200 * exceeded <= events, "{exceeded} of {events}");
    }
}

/// With a hardness and a factor windows of any size have the same events and states, also on cells far longer than wide.
/// What a window left open grew in the next one: on most of these paths to 1e-9 and more, where they broke off.
#[test]
fn nodes_yield_on_long_periodic_cells() {
    let heights = scattered((24, 24), 99_991, 1) / 99_991.0;
    let surface = HeightMap::new(heights).unwrap();
    for (aspect, hardness) in [(0.02, 0.5), (0.01, 1.0), (100.0, 0.5), (100.0, 1.0), (300.0, 3.0)] {
        let (dx, dy) = (f64::sqrt(aspect), 1.0 / f64::sqrt(aspect));
        let grid = Grid::new(24, 24, dx, dy).unwrap();
        let kernels: [Box<dyn InfluenceKernel>; 2] = [
            Box::new(Spectral::new(grid, 1.0).unwrap()),
            Box::new(PeriodicBoussinesq::new(grid, 1.0).unwrap()),
        ];
        for kernel in kernels {
            let path = |window: Option<usize>| -> Vec<LoadingState> {
                let builder = LoadingSolver::builder(&surface, &*kernel).hardness(hardness);
                let builder = builder.updater(RecursiveCholesky::new());
                let builder =
                    window.into_iter().fold(builder, |builder, size| builder.window_size(size));
                builder.build().unwrap().map(Result::unwrap).collect()
            };
            let single = path(Some(1));
            let end = single.last().unwrap().contact;
            for window in [None, Some(8), Some(64)] {
                let found = path(window);
                assert_eq!(found.len(), single.len(), "{aspect} {hardness} {window:?}");
                let mut worst = 0.0_f64;
                for (found, expected) in found.iter().zip(&single) {
                    let (found, expected) = (found.contact, expected.contact);
                    worst = worst.max((found.load - expected.load).abs() / end.load);
                    worst = worst.max((found.approach - expected.approach).abs() / end.approach);
                }
                println!("{aspect} {hardness} {window:?}: {worst:e}");
                // Rounding times the condition, some 20 times the ratio of the sides.
                assert!(worst < 1e-10, "{aspect} {hardness} {window:?}: {worst:e}");
            }
        }
    }
}

/// Periodic cells beyond 10 : 1 need a factor: iterations do not begin, and the default ends as soon as no factor fits.
#[test]
fn long_periodic_cells_need_a_factor() {
    let grid = Grid::new(40, 20, 1.0, 11.0).unwrap();
    let surface = uncorrelated(40, 20);
    let kernel = Spectral::new(grid, 1.0).unwrap();
    let exact = states(&surface, &kernel, RecursiveCholesky::new(), None);
    let default = states(&surface, &kernel, Handover::new(), None);
    assert!(default == exact);
    let refused = |updater: Box<dyn LinearUpdater>, budget: usize| -> Vec<LoadingState> {
        let builder = LoadingSolver::builder(&surface, &kernel).updater(updater);
        let mut path = builder.memory_budget(budget).build().unwrap();
        let mut followed = Vec::new();
        let error = loop {
            match path.next().unwrap() {
                Ok(state) => followed.push(state),
                Err(error) => break error,
            }
        };
        assert!(matches!(error, Error::OutOfRange { value: 11.0, .. }), "{error}");
        assert!(path.next().is_none());
        followed
    };
    let fixed = LoadingSolver::new(&surface, &kernel).unwrap().bytes();
    assert_eq!(refused(Box::new(ConjugateGradient::new()), usize::MAX), []);
    // A factor of some 300 nodes fits.
    let followed = refused(Box::new(Handover::new()), fixed + 1_500_000);
    assert!((100..700).contains(&followed.len()), "{}", followed.len());
    assert_eq!(followed, exact[..followed.len()]);
}
