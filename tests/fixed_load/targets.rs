//! States of which something else than the load is known.

use std::f64::consts::TAU;

use asperity::kernel::{KernelTable, MeanDisplacement};
use asperity::nalgebra::DMatrix;
use asperity::surface::{HeightMap, Paraboloid};
use asperity::{
    Boussinesq, ContactGrowth, ContactTarget, Error, FixedLoadSolver, Grid, LoadingSolver,
    LoadingState, SurfaceError,
};

use crate::common::fixed_load::check;
use crate::problems::{Kernel, solver};
use asperity_testing::close::relative;
use asperity_testing::surfaces::rough;

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
                assert_eq!(solution.contact.contact_nodes, nodes);
            }
            // Alone, and under the load that was found.
            let area = ContactTarget::AreaFraction(0.2);
            let alone = solver.solve_target(area).unwrap();
            assert_eq!(alone.contact.contact_nodes, 460);
            let same = solver.solve_target(ContactTarget::Load(alone.contact.load)).unwrap();
            assert_eq!(same.fields.contact_map, alone.fields.contact_map);
            assert!(relative(same.contact.approach, alone.contact.approach) < 1e-11);
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
                let expected = solver.solve(load).unwrap().contact;
                let target = ContactTarget::MeanGap(expected.mean_gap);
                let found = solver.solve_target(target).unwrap().contact;
                assert!(relative(found.load, load) < 1e-8, "{found:?}");
            }
        }
    }
}

/// Just behind first touch the tolerance of gaps lies below the rounding of their mean, which is met as far as that
/// goes.
#[test]
fn mean_gaps_of_surfaces_that_barely_touch() {
    let grid = Grid::square(48, 1.0).unwrap();
    let map = rough(&grid, 5);
    let unloaded = map.matrix().max() - map.matrix().mean();
    for kernel in Kernel::all(grid, 1.0) {
        for stiffness in [true, false] {
            let builder = FixedLoadSolver::builder(&map, &kernel).tolerance(1e-12);
            let mut solver = builder.stiffness(stiffness).build().unwrap();
            for digits in 3..=10 {
                let mean_gap = unloaded * (1.0 - 0.1_f64.powi(digits));
                let target = ContactTarget::MeanGap(mean_gap);
                let state = solver.solve_target(target).unwrap().contact;
                let allowed = (1e-12 * state.approach).max(1e-14 * unloaded);
                assert!((state.mean_gap - mean_gap).abs() <= allowed, "{state:?}");
            }
        }
    }
}

/// Close to full contact a plate is stiff for the short waves that are left: its approach of mean planes is far less
/// than C(0, 0) p̄, to which its solutions are exact, and a mean gap is found to the same.
#[test]
fn mean_gaps_where_little_is_left_to_approach() {
    let nodes = 32;
    let grid = Grid::new(nodes, 1, 1.0, 1.0).unwrap();
    let (arbitrary, growth) = (MeanDisplacement::Arbitrary, ContactGrowth::Unknown);
    // Waves as many to the period as the first one answer with the fourth power of their length.
    let bending = |q: f64, _| (TAU / nodes as f64 / q).powi(4);
    let plate = KernelTable::from_symbol(grid, arbitrary, growth, bending).unwrap();
    // Every other node stands out, and one a little more than another.
    let heights = DMatrix::from_fn(nodes, 1, |i, _| (i % 2) as f64 + 1e-5 * (7 * i % 32) as f64);
    let unloaded = heights.max() - heights.mean();
    let map = HeightMap::new(heights).unwrap();
    for tolerance in [1e-4, 1e-6, 1e-8] {
        let mut solver = solver(&map, &plate, tolerance);
        let mut least = f64::INFINITY;
        for digits in 1..=5 {
            let mean_gap = 0.1_f64.powi(digits) * unloaded;
            let solution = solver.solve_target(ContactTarget::MeanGap(mean_gap)).unwrap();
            check(&solver, &solution, tolerance);
            let state = &solution.contact;
            // In the gauge that a kernel gets from its symbol, which is the one that is computed with.
            let own = plate.coefficient(0, 0).unwrap() * state.load / nodes as f64;
            assert!((state.mean_gap - mean_gap).abs() <= tolerance * own, "{state:?}");
            least = least.min(state.approach / own);
        }
        assert!(least < 0.05, "{least}");
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
    assert!(matches!(less, Err(Error::Surface(SurfaceError::LessThanOneNode { .. }))));
}

/// Four nodes of a symmetric shape touch together: numbers between are not to be had, unless the
/// tolerance lets single ones of them pass.
#[test]
fn unreachable_areas() {
    let grid = Grid::square(16, 1.0).unwrap();
    let map = HeightMap::sample(&Paraboloid::new(10.0).unwrap(), &grid).unwrap();
    let mut sphere = solver(&map, &Kernel::free(grid, 1.0), 1e-12);
    let kernel = Boussinesq::new(grid, 1.0).unwrap();
    let path = LoadingSolver::builder(&map, &kernel).max_area_fraction(0.1).build().unwrap();
    let states: Vec<LoadingState> = path.map(Result::unwrap).collect();
    for (asked, nearest) in [(5, 4), (7, 4), (10, 12), (11, 12)] {
        let area = ContactTarget::AreaFraction(asked as f64 / 256.0);
        let found = sphere.solve_target(area).unwrap().contact;
        assert_eq!(found.contact_nodes, nearest);
        // Where the number jumps the search ends, to its 10⁻¹³.
        let jump = states.iter().find(|state| state.contact.contact_nodes == asked);
        let jump = jump.unwrap().contact.load;
        assert!((found.load / jump - 1.0).abs() < 1e-9, "{asked}: {} {jump}", found.load);
    }
}

/// On a worn surface the plateau touches at once, and fewer nodes are not to be had: the answer is the plateau, which
/// was looked for in vain under ever smaller loads before.
#[test]
fn fewer_nodes_than_touch_first() {
    let grid = Grid::square(16, 1.0).unwrap();
    let worn = rough(&grid, 5).matrix().map(|height| height.min(0.0));
    let plateau = worn.iter().filter(|height| **height == 0.0).count();
    assert!((60..200).contains(&plateau), "{plateau}");
    let map = HeightMap::new(worn).unwrap();
    for kernel in Kernel::all(grid, 1.0) {
        let mut worn = solver(&map, &kernel, 1e-8);
        let asked = [1, plateau - 1, plateau, plateau + 1, 5];
        let targets = asked.map(|nodes| ContactTarget::AreaFraction(nodes as f64 / 256.0));
        for (solution, asked) in worn.sweep(targets).zip(asked) {
            let solution = solution.unwrap();
            assert_eq!(solution.contact.contact_nodes, plateau.max(asked));
            let steps = solution.effort.convolutions;
            assert!(steps < 1000, "{steps} convolutions for {asked} nodes");
        }
    }
}
