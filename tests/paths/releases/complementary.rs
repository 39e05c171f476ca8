//! An independent solver of the linear complementarity problem.

use nalgebra::{DMatrix, DVector};

/// Gaps whose least is zero, as a path measures them.
pub(super) fn from_first_touch(gaps: &[f64]) -> Vec<f64> {
    let least = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    gaps.iter().map(|gap| gap - least).collect()
}

pub(super) fn restrict(matrix: &DMatrix<f64>, nodes: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(nodes.len(), nodes.len(), |i, j| matrix[(nodes[i], nodes[j])])
}

/// p ≥ 0, g + C p − δ ≥ 0, one of them zero at each node: least squares with bounds after Lawson and
/// Hanson (1974), which grows the set of free nodes one at a time from nothing, at this δ alone.
pub(super) fn complementary(matrix: &DMatrix<f64>, gaps: &[f64], approach: f64) -> DVector<f64> {
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
