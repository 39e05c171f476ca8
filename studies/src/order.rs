//! Orders of convergence.

use crate::line::Line;

/// The order in which an error falls with a number of cells, from (cells, error) of the finest `grids` grids by a
/// least-squares line through the logarithms.
pub fn order(points: &[(f64, f64)], grids: usize) -> f64 {
    let finest = &points[points.len().saturating_sub(grids)..];
    let logarithms: Vec<_> = finest.iter().map(|(n, e)| (n.ln(), e.ln())).collect();
    -Line::fit(&logarithms).slope
}
