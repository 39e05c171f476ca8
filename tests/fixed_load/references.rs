//! Other solvers' results.

use asperity::Grid;

use crate::common::fixed_load::check;
use crate::common::surface;
use crate::problems::{Kernel, solver};
use asperity_testing::close::relative;

/// Contact nodes and greatest pressure on a free half-space from aspher 0.1.3 at a tolerance of 1e-13.
#[test]
fn free_half_space() {
    let grid = Grid::square(128, 1e-2).unwrap();
    let mut solver = solver(&surface("selfaffine_128"), &Kernel::free(grid, 1.0), 1e-12);
    for (load, nodes, max_pressure) in [
        (1.0000000000000002e-08, 30, 0.1580411344104674),
        (1.0000000000000001e-07, 217, 0.2824562862218864),
        (1.0000000000000002e-06, 1772, 0.452405481594745),
        (5e-06, 6542, 0.973088073478147),
    ] {
        let solution = solver.solve(load).unwrap();
        check(&solver, &solution, 1e-12);
        assert_eq!(solution.contact.contact_nodes, nodes, "load {load}");
        // Pressures err some hundred times as much as gaps, relative to the greatest of each.
        let error = relative(solution.fields.max_pressure(), max_pressure);
        assert!(error < 1e-9, "load {load}: {error:e}");
    }
}

/// Contact nodes, greatest pressure and mean gap on a periodic one from tamaas 2.9.0 at a tolerance of
/// 1e-13, given in `tests/data/periodic_128_fixed_load.json`.
#[test]
fn periodic_half_space() {
    let grid = Grid::square(128, 1.0).unwrap();
    let [_, spectral] = Kernel::periodic(grid, 1.0);
    let mut solver = solver(&surface("periodic_128"), &spectral, 1e-12);
    for (load, nodes, max_pressure, mean_gap) in [
        (1e-4, 34, 0.10545348200430753, 0.008637231899276225),
        (1e-3, 431, 0.14872619056802042, 0.005288125769841879),
        (1e-2, 3675, 0.18943174504772775, 0.0019625055948044364),
        (4e-2, 10901, 0.23198078863035695, 0.000312262401477235),
    ] {
        let solution = solver.solve(load).unwrap();
        check(&solver, &solution, 1e-12);
        assert_eq!(solution.contact.contact_stiffness, None);
        assert_eq!(solution.contact.contact_nodes, nodes, "load {load}");
        // Pressures err some hundred times as much as gaps, relative to the greatest of each.
        let error = relative(solution.fields.max_pressure(), max_pressure);
        assert!(error < 1e-9, "load {load}: pressure {error:e}");
        let error = relative(solution.contact.mean_gap, mean_gap);
        assert!(error < 1e-9, "load {load}: mean gap {error:e}");
    }
}
