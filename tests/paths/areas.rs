//! One rule of rounding for contact areas: `Grid::nodes_in`, for paths, their records and fixed loads.

use crate::problems::rough;
use asperity::loading::{History, LoadingEnd};
use asperity::{Boussinesq, ContactTarget, FixedLoadSolver, Grid, LoadingSolver};

#[test]
fn paths_records_and_fixed_loads_round_alike() {
    // 49 and 121 are such that k/M times M is not always k.
    for n in [7, 11] {
        let grid = Grid::square(n, 1e-3).unwrap();
        let surface = rough(&grid, n as u64);
        let kernel = Boussinesq::new(grid, 1e9).unwrap();
        let path = LoadingSolver::new(&surface, &kernel).unwrap();
        let history: History = path.map(Result::unwrap).collect();
        let mut solver =
            FixedLoadSolver::builder(&surface, &kernel).tolerance(1e-11).build().unwrap();
        let nodes = grid.nodes();
        let mut inexact = 0;
        for k in 1..=nodes {
            let whole = k as f64 / nodes as f64;
            inexact += usize::from(whole * (nodes as f64) < k as f64);
            // A node more or less by a whole cell, not by the last bit.
            for (fraction, expected) in [
                (whole, k),
                (k as f64 * (1.0 / nodes as f64), k),
                ((k as f64 + 0.5) / nodes as f64, k),
            ] {
                if fraction > 1.0 {
                    continue;
                }
                assert_eq!(grid.nodes_in(fraction).unwrap(), expected);
                let read = history.at_area_fraction(fraction).unwrap();
                assert_eq!(read.contact.contact_nodes, expected, "{fraction}");
                // Every path and every search only where that is cheap.
                if k % 10 != 1 {
                    continue;
                }
                let builder = LoadingSolver::builder(&surface, &kernel);
                let mut path = builder.max_area_fraction(fraction).build().unwrap();
                assert_eq!(path.by_ref().count(), expected);
                let end = if expected == nodes {
                    LoadingEnd::FullContact
                } else {
                    LoadingEnd::AreaFraction
                };
                assert_eq!(path.end(), Some(end));
                let target = ContactTarget::AreaFraction(fraction);
                let solution = solver.solve_target(target).unwrap();
                assert_eq!(solution.contact.contact_nodes, expected, "{fraction}");
            }
        }
        // So that one rule of rounding has something to do.
        println!("{inexact} of {nodes} fractions fall short");
        assert!(inexact > 0, "{nodes}");
    }
}
