//! Dense solutions that tests of this module compare with. They use nothing of the repository but this file, so that
//! the tests of the packed crate run.

use nalgebra::{DMatrix, DVector};

/// Gaps above the least of them.
pub(super) fn from_first_touch(gaps: &[f64]) -> Vec<f64> {
    let least = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    gaps.iter().map(|gap| gap - least).collect()
}

/// p ≥ 0, g + C p − δ ≥ 0, one of them zero at each node: projected Gauss–Seidel, which converges for every symmetric
/// positive definite matrix (Cryer, SIAM J. Control 9 (1971) 385), until nothing changes by more than 10⁻¹⁴ of the
/// greatest pressure.
pub(super) fn complementary(matrix: &DMatrix<f64>, gaps: &[f64], approach: f64) -> DVector<f64> {
    let mut p = DVector::zeros(gaps.len());
    for _ in 0..100_000 {
        let mut change = 0.0_f64;
        for (i, gap) in gaps.iter().enumerate() {
            let residual = approach - gap - matrix.row(i).transpose().dot(&p);
            let next = f64::max(p[i] + residual / matrix[(i, i)], 0.0);
            change = change.max((next - p[i]).abs());
            p[i] = next;
        }
        if change <= 1e-14 * p.max() {
            return p;
        }
    }
    panic!("the projected iterations do not end");
}
