//! Contact problems whose numbers can be worked out by hand, for tests: nodes in a row, whose influence reaches as
//! far as the next one, C = 4 on a node itself and 1 on its neighbours. Cells are 1 m × 2 m.
//!
//! A node that is in contact without a neighbour carries `(δ − g)/4`, a quarter more for each metre of approach; two
//! neighbours carry a fifth each for each metre, since `C⁻¹ e = (1/5, 1/5)`.

use nalgebra::DMatrix;

use crate::surface::HeightMap;
use crate::{Boundary, ContactGrowth, Error, Grid, KernelTable, Problem};

/// The grid of so many nodes.
pub(crate) fn grid(nodes: usize) -> Result<Grid, Error> {
    Ok(Grid::new(nodes, 1, 1.0, 2.0)?)
}

/// The influence of so many nodes.
pub(crate) fn kernel(nodes: usize) -> Result<KernelTable, Error> {
    let coefficient = |di: isize, _: isize| match di.abs() {
        0 => 4.0,
        1 => 1.0,
        _ => 0.0,
    };
    KernelTable::from_fn(grid(nodes)?, Boundary::Free, ContactGrowth::Monotone, coefficient)
}

/// A surface of these gaps, of which the least is 0.
pub(crate) fn surface(gaps: &[f64]) -> Result<HeightMap, Error> {
    let heights = DMatrix::from_fn(gaps.len(), 1, |node, _| -gaps[node]);
    Ok(HeightMap::new(heights)?)
}

/// The problem of these gaps, of which the least is 0.
pub(crate) fn problem(gaps: &[f64]) -> Result<Problem, Error> {
    Problem::new(&surface(gaps)?, &kernel(gaps.len())?)
}
