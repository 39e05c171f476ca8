//! Eq. (19) as printed and as it should be, on a small system of influence coefficients.

use asperity::{Boussinesq, Error, Grid, InfluenceKernel};
use nalgebra::{DMatrix, DVector};

/// Nodes a side of the contact.
const SIDE: usize = 6;

/// Relative residuals of C x = c: by eq. (19) as printed, and corrected.
pub(crate) fn residuals() -> Result<[f64; 2], Error> {
    let kernel = Boussinesq::new(Grid::square(SIDE + 1, 1.0)?, 1.0)?;
    let n = SIDE * SIDE;
    let offset = |a: usize, b: usize| a as isize - b as isize;
    let between = |a: (usize, usize), b: (usize, usize)| {
        kernel.coefficient(offset(a.0, b.0), offset(a.1, b.1))
    };
    let place = |node: usize| (node % SIDE, node / SIDE);
    let matrix = DMatrix::from_fn(n, n, |i, j| between(place(i), place(j)));
    // The column of the next node, a neighbour of the contact.
    let column = DVector::from_fn(n, |i, _| between(place(i), (SIDE, 2)));
    let Some(factor) = matrix.clone().cholesky().map(|found| found.l()) else {
        return Err(Error::FactorizationFailed { nodes: n });
    };

    // Eq. (18).
    let mut l = column.clone();
    for m in 0..n {
        let sum: f64 = (0..m).map(|i| factor[(m, i)] * l[i]).sum();
        l[m] = (column[m] - sum) / factor[(m, m)];
    }
    let mut printed = DVector::zeros(n);
    for m in 0..n {
        let sum: f64 = (0..m).map(|i| factor[(m, i)] * printed[i]).sum();
        printed[m] = (column[m] - sum) / factor[(m, m)];
    }
    let mut corrected = DVector::zeros(n);
    for m in (0..n).rev() {
        let sum: f64 = (m + 1..n).map(|i| factor[(i, m)] * corrected[i]).sum();
        corrected[m] = (l[m] - sum) / factor[(m, m)];
    }
    let residual = |x: &DVector<f64>| (&matrix * x - &column).norm() / column.norm();
    Ok([residual(&printed), residual(&corrected)])
}
