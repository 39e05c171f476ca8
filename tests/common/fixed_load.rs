//! What every fixed-load solution has to fulfil.

use asperity::{FixedLoadSolution, FixedLoadSolver};
use asperity_testing::close::relative;

/// Checks the conditions of contact against the solution's own fields, its certificate against the
/// tolerance, and its scalars against the fields.
pub fn check(solver: &FixedLoadSolver, solution: &FixedLoadSolution, tolerance: f64) {
    let (state, certificate) = (&solution.contact, &solution.certificate);
    let context = format!("{state:?} {certificate:?}");
    assert!(certificate.complementarity <= tolerance, "{context}");
    assert!(certificate.least_gap >= -tolerance, "{context}");
    assert!(certificate.greatest_contact_gap <= tolerance, "{context}");
    assert!(certificate.least_pressure >= 0.0, "{context}");
    // A sum of positive numbers, scaled: rounding of the sum only.
    assert!(certificate.load_error.abs() <= 1e-13, "{context}");
    assert!(certificate.length >= state.approach, "{context}");

    let grid = solver.grid();
    let nodes = grid.nodes();
    let (mut count, mut sum, mut open) = (0, 0.0, 0.0);
    for node in 0..nodes {
        let (pressure, gap) = (solution.fields.pressure[node], solution.fields.gap[node]);
        let in_contact = solution.fields.contact_map[node];
        assert!(pressure >= 0.0, "node {node}: {pressure}");
        assert_eq!(in_contact, pressure > 0.0 || gap <= 0.0, "node {node}");
        if in_contact {
            count += 1;
            sum += pressure;
            assert!(gap.abs() <= tolerance * certificate.length, "node {node}");
        } else {
            open += gap;
        }
    }
    assert_eq!(state.contact_nodes, count);
    assert_eq!(state.contact_area, count as f64 * grid.cell_area());
    assert_eq!(state.contact_area_fraction, count as f64 / nodes as f64);
    // Two orders of some ten thousand positive terms.
    assert!(relative(grid.cell_area() * sum, state.load) < 1e-12);
    let mean_gap = open / nodes as f64;
    assert!((mean_gap - state.mean_gap).abs() <= 1e-12 * mean_gap);
}
