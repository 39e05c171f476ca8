//! Influence matrices, and dense solutions that share nothing with the library but the influence coefficients.

use asperity::InfluenceKernel;
use nalgebra::{DMatrix, DVector};

/// Influence coefficients between nodes given by their indices, straight from the kernel.
#[must_use]
pub fn influence(
    kernel: &(impl InfluenceKernel + ?Sized),
    rows: &[usize],
    columns: &[usize],
) -> DMatrix<f64> {
    let grid = kernel.grid();
    DMatrix::from_fn(rows.len(), columns.len(), |i, j| {
        let (a, b) = (grid.coordinates(rows[i]), grid.coordinates(columns[j]));
        kernel.coefficient(a.0 as isize - b.0 as isize, a.1 as isize - b.1 as isize)
    })
}

/// Influence coefficients between all nodes.
#[must_use]
pub fn influence_matrix(kernel: &(impl InfluenceKernel + ?Sized)) -> DMatrix<f64> {
    let nodes: Vec<usize> = (0..kernel.grid().nodes()).collect();
    influence(kernel, &nodes, &nodes)
}

/// Initial gaps by node index.
#[must_use]
pub fn initial_gap(heights: &DMatrix<f64>) -> Vec<f64> {
    let highest = heights.max();
    heights.iter().map(|height| highest - height).collect()
}

/// Pressures that press the `contact` nodes into the plane of `approach`: C p = approach - gap, by LU.
#[must_use]
pub fn pressure(
    kernel: &(impl InfluenceKernel + ?Sized),
    contact: &[usize],
    gap: &[f64],
    approach: f64,
) -> DVector<f64> {
    let rhs =
        DVector::from_iterator(contact.len(), contact.iter().map(|&node| approach - gap[node]));
    influence(kernel, contact, contact).lu().solve(&rhs).unwrap()
}

/// Gaps whose least is zero, as a path measures them.
#[must_use]
pub fn from_first_touch(gaps: &[f64]) -> Vec<f64> {
    let least = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    gaps.iter().map(|gap| gap - least).collect()
}

/// The part of a matrix that belongs to some nodes.
#[must_use]
pub fn restrict(matrix: &DMatrix<f64>, nodes: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(nodes.len(), nodes.len(), |i, j| matrix[(nodes[i], nodes[j])])
}

/// p ≥ 0, g + C p − δ ≥ 0, one of them zero at each node: least squares with bounds after Lawson and
/// Hanson (1974), which grows the set of free nodes one at a time from nothing, at this δ alone.
#[must_use]
pub fn complementary(matrix: &DMatrix<f64>, gaps: &[f64], approach: f64) -> DVector<f64> {
    let n = gaps.len();
    let rhs = DVector::from_iterator(n, gaps.iter().map(|gap| approach - gap));
    let mut p = DVector::zeros(n);
    let mut free: Vec<usize> = Vec::new();
    loop {
        let residual = &rhs - matrix * &p;
        let outside = (0..n).filter(|i| !free.contains(i));
        let worst = outside.max_by(|&a, &b| residual[a].total_cmp(&residual[b]));
        // Rounding of a residual of numbers up to the approach.
        let Some(worst) = worst.filter(|&i| residual[i] > 1e-14 * (approach + 1.0)) else {
            return p;
        };
        free.push(worst);
        loop {
            let b = DVector::from_iterator(free.len(), free.iter().map(|&i| rhs[i]));
            let solved = restrict(matrix, &free).cholesky().unwrap().solve(&b);
            let blocking = free.iter().zip(&solved).filter(|(_, s)| **s <= 0.0);
            let step = blocking.map(|(&i, s)| p[i] / (p[i] - s)).fold(1.0, f64::min);
            for (&i, s) in free.iter().zip(&solved) {
                p[i] += step * (s - p[i]);
            }
            if step >= 1.0 {
                break;
            }
            let nodes = free.iter().zip(&solved);
            let out: Vec<usize> = nodes
                .filter(|&(&i, s)| *s <= 0.0 && p[i] <= 1e-15 * p.max())
                .map(|(&i, _)| i)
                .collect();
            for &i in &out {
                p[i] = 0.0;
            }
            free.retain(|i| !out.contains(i));
        }
    }
}
