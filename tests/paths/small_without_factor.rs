//! What iterations say of small contacts, beside the factor.

use asperity::loading::LoadingState;
use asperity::surface::HeightMap;
use asperity::updater::{ConjugateGradient, LinearUpdater, RecursiveCholesky};
use asperity::{
    Boundary, Boussinesq, ContactGrowth, Grid, InfluenceKernel, KernelTable, LoadingSolver,
    PeriodicBoussinesq,
};
use nalgebra::DMatrix;

fn states<U: LinearUpdater>(
    updater: U,
    map: &HeightMap,
    kernel: &dyn InfluenceKernel,
) -> Vec<LoadingState> {
    LoadingSolver::builder(map, kernel)
        .updater(updater)
        .build()
        .unwrap()
        .collect::<Result<_, _>>()
        .unwrap()
}

/// Rough, without ties.
fn rough(grid: Grid) -> HeightMap {
    let (nx, ny) = grid.shape();
    HeightMap::new(DMatrix::from_fn(nx, ny, |ix, iy| {
        let (x, y) = (ix as f64, iy as f64);
        (1.3 * x + 0.7 * y).sin() + (0.9 * y - 0.4 * x).cos() + 0.3 * (1.9 * x * y).sin()
    }))
    .unwrap()
}

/// One node stands out, and all others have the same gap. They close at the same rate before first touch, which does
/// not make them images of each other: once the first one carries, those next to it are later by a few parts in a
/// million, which is within what windows leave open.
#[test]
fn nodes_of_the_same_height_are_told_apart() {
    let grid = Grid::new(2, 3, 9e-3, 1e-3).unwrap();
    let kernel = PeriodicBoussinesq::new(grid, 1.0).unwrap();
    let mut heights = DMatrix::zeros(2, 3);
    heights[(1, 0)] = 1e-6;
    let map = HeightMap::new(heights).unwrap();
    let exact = states(RecursiveCholesky::new(), &map, &kernel);
    let found = states(ConjugateGradient::new(), &map, &kernel);
    assert!(
        exact[3].contact.approach - exact[2].contact.approach > 5e-6 * exact[2].contact.approach
    );
    for (found, exact) in found.iter().zip(&exact) {
        assert_eq!(found.node, exact.node);
        // Ties are closer than 1e-9 of the approach.
        let off = (found.contact.approach - exact.contact.approach).abs();
        assert!(off <= 1e-9 * exact.contact.approach, "{off:e} at {exact:?}");
    }
}

/// The estimate of an approach covers what it is off by, also where each event is found by a solution of its own: on
/// bodies that promise nothing, an elastic half-space among them.
#[test]
fn single_events_say_what_they_are_off_by() {
    let grid = Grid::new(6, 7, 1.0, 1.0).unwrap();
    let map = rough(grid);
    let free = Boussinesq::new(grid, 1.0).unwrap();
    let half_space = |di: isize, dj: isize| free.coefficient(di, dj);
    let decaying = |di: isize, dj: isize| (-((di * di + dj * dj) as f64).sqrt() / 3.0).exp();
    let unknown = ContactGrowth::Unknown;
    for kernel in [
        KernelTable::from_fn(grid, Boundary::Free, unknown, half_space).unwrap(),
        KernelTable::from_fn(grid, Boundary::Free, unknown, decaying).unwrap(),
    ] {
        let exact = states(RecursiveCholesky::new(), &map, &kernel);
        let found = states(ConjugateGradient::new(), &map, &kernel);
        assert_eq!(found.len(), exact.len());
        for (found, exact) in found.iter().zip(&exact) {
            assert_eq!((found.node, found.event), (exact.node, exact.event));
            let off = (found.contact.approach - exact.contact.approach).abs();
            let error = found.approach_error;
            assert!(off <= error, "{off:e} of {error:e} at {exact:?}");
            // And it says something: the tolerance of the solutions is 1e-10 of the approach.
            let enough = 1e-6 * exact.contact.approach.max(1e-3);
            assert!(error > 0.0 && error < enough, "{error:e} at {exact:?}");
            assert_eq!(exact.approach_error, 0.0);
        }
    }
}
