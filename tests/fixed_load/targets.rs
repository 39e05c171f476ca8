//! States of which something else than the load is known.

use asperity::surface::{HeightMap, Paraboloid};
use asperity::{ContactTarget, Error, FixedLoadSolver, Grid};

use crate::common::fixed_load::{check, relative};
use crate::problems::{Kernel, rough, solver};

/// Areas, in a sweep up and down with small steps and large ones, and alone.
#[test]
fn areas() {
    let grid = Grid::square(48, 1.0).unwrap();
    let map = rough(&grid, 5);
    for kernel in Kernel::all(grid, 1.0) {
        for stiffness in [true, false] {
            let mut solver = FixedLoadSolver::builder(&map, &kernel)
                .tolerance(1e-12)
                .stiffness(stiffness)
                .build()
                .unwrap();
            let fractions = [5e-4, 0.01, 0.011, 0.3, 0.32, 0.9, 1.0, 0.05];
            let areas = fractions.map(ContactTarget::AreaFraction);
            let swept: Vec<_> = solver.sweep(areas).map(Result::unwrap).collect();
            for (fraction, solution) in fractions.into_iter().zip(swept) {
                check(&solver, &solution, 1e-12);
                let nodes = grid.nodes_in(fraction).unwrap();
                assert_eq!(solution.state.contact_nodes, nodes);
            }
            // Alone, and a plain number for a load.
            let area = ContactTarget::AreaFraction(0.2);
            let alone = solver.solve_target(area).unwrap();
            assert_eq!(alone.state.contact_nodes, 460);
            let same = solver.solve_target(alone.state.load).unwrap();
            assert_eq!(same.contact_map, alone.contact_map);
            assert!(relative(same.state.approach, alone.state.approach) < 1e-11);
        }
    }
}

/// A mean gap is found whether stiffnesses are known or not.
#[test]
fn mean_gaps() {
    let grid = Grid::square(48, 1.0).unwrap();
    let map = rough(&grid, 5);
    for kernel in Kernel::all(grid, 1.0) {
        for stiffness in [true, false] {
            let mut solver = FixedLoadSolver::builder(&map, &kernel)
                .tolerance(1e-12)
                .stiffness(stiffness)
                .build()
                .unwrap();
            for load in [1e-4, 1e-2] {
                let expected = solver.solve(load).unwrap().state;
                let target = ContactTarget::MeanGap(expected.mean_gap);
                let found = solver.solve_target(target).unwrap().state;
                assert!(relative(found.load, load) < 1e-8, "{found:?}");
            }
        }
    }
}

#[test]
fn targets_that_cannot_be() {
    let grid = Grid::square(48, 1.0).unwrap();
    let mut solver = solver(&rough(&grid, 5), &Kernel::free(grid, 1.0), 1e-8);
    for bad in [
        ContactTarget::AreaFraction(0.0),
        ContactTarget::AreaFraction(1.1),
        ContactTarget::AreaFraction(f64::NAN),
        ContactTarget::MeanGap(0.0),
        ContactTarget::MeanGap(1.0),
        ContactTarget::MeanGap(f64::NAN),
    ] {
        let solved = solver.solve_target(bad);
        assert!(matches!(solved, Err(Error::OutOfRange { .. })), "{bad:?}");
    }
    let less = solver.solve_target(ContactTarget::AreaFraction(0.9 / 2304.0));
    assert!(matches!(less, Err(Error::LessThanOneNode { .. })));
}

/// Four nodes of a symmetric shape touch together: numbers between are not to be had, unless the
/// tolerance lets single ones of them pass.
#[test]
fn unreachable_areas() {
    let grid = Grid::square(16, 1.0).unwrap();
    let map = HeightMap::sample(&Paraboloid::new(10.0).unwrap(), &grid).unwrap();
    let mut sphere = solver(&map, &Kernel::free(grid, 1.0), 1e-12);
    for (asked, nearest) in [(5, 4), (10, 12), (11, 12)] {
        let area = ContactTarget::AreaFraction(f64::from(asked) / 256.0);
        let nodes = sphere.solve_target(area).unwrap().state.contact_nodes;
        assert_eq!(nodes, nearest);
    }
}
