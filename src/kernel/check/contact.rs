//! One contact set: its influence matrix, and what the inverse says about the growth of contact.

use nalgebra::{Cholesky, DMatrix, DVector};

use crate::kernel::{ContactGrowth, KernelTable};
use crate::{Error, KernelError};

/// A contact set whose influence matrix is positive definite.
pub(super) struct Contact {
    nodes: Vec<usize>,
    /// C_II⁻¹.
    inverse: DMatrix<f64>,
    /// y₂ = C_II⁻¹ e.
    growth: DVector<f64>,
    /// r₂ = 1 − C_:I y₂ at all nodes that are not in contact, with their indices.
    closing: Vec<(usize, f64)>,
    /// Relative error that rounding may have made of inverse and growth, and absolute one of closing.
    rounding: f64,
}

/// A sign that contradicts a promise.
pub(super) struct Violation {
    promise: &'static str,
    quantity: &'static str,
    node: usize,
    value: f64,
}

impl Contact {
    /// # Errors
    ///
    /// [`KernelError::BrokenPromise`] if the influence matrix is not positive definite.
    pub(super) fn new(table: &KernelTable, nodes: Vec<usize>) -> Result<Self, Error> {
        let places: Vec<usize> = nodes.iter().map(|&node| table.place(node)).collect();
        let n = nodes.len();
        let matrix = DMatrix::from_fn(n, n, |i, j| table.between(places[i], places[j]));
        let factor = factored(matrix.clone()).map_err(|(row, value)| {
            Error::Kernel(KernelError::BrokenPromise {
                promise: "positive definite",
                quantity: "pivot",
                contact: nodes.clone(),
                node: table.grid().coordinates(nodes[row]),
                value,
            })
        })?;
        let inverse = factor.inverse();
        let growth = factor.solve(&DVector::from_element(n, 1.0));
        let mut in_contact = vec![false; table.grid().nodes()];
        for &node in &nodes {
            in_contact[node] = true;
        }
        let closing = (0..in_contact.len())
            .filter(|&node| !in_contact[node])
            .map(|node| {
                let place = table.place(node);
                let pairs = places.iter().zip(growth.iter());
                let displacement: f64 =
                    pairs.map(|(&other, rate)| table.between(place, other) * rate).sum();
                (node, 1.0 - displacement)
            })
            .collect();
        // The inverse of a matrix errs by its condition number times a rounding for each row.
        let condition = row_sum_norm(&matrix) * row_sum_norm(&inverse);
        Ok(Self { rounding: n as f64 * condition * f64::EPSILON, nodes, inverse, growth, closing })
    }

    /// The most that this set allows to promise, and what forbids to promise more.
    pub(super) fn growth(&self) -> (ContactGrowth, Option<Violation>) {
        let lost = -self.rounding * self.growth.amax();
        for (&node, &value) in self.nodes.iter().zip(self.growth.iter()) {
            if value < lost {
                let violation = Violation {
                    promise: "contact grows monotonically",
                    quantity: "growth of pressure y₂",
                    node,
                    value,
                };
                return (ContactGrowth::Unknown, Some(violation));
            }
        }
        for &(node, value) in &self.closing {
            if value < -self.rounding {
                let violation = Violation {
                    promise: "contact grows monotonically",
                    quantity: "rate r₂ at which the gap closes",
                    node,
                    value,
                };
                return (ContactGrowth::Unknown, Some(violation));
            }
        }
        let found = self.rounding * self.inverse.amax();
        for (column, &node) in self.nodes.iter().enumerate() {
            for (row, &value) in self.inverse.column(column).iter().enumerate() {
                if row != column && value > found {
                    let violation = Violation {
                        promise: "gaps are convex in the approach",
                        quantity: "greatest element of the inverse off the diagonal",
                        node,
                        value,
                    };
                    return (ContactGrowth::Monotone, Some(violation));
                }
            }
        }
        (ContactGrowth::Convex, None)
    }

    /// The error for a violation on this set.
    pub(super) fn broken(&self, table: &KernelTable, violation: Violation) -> Error {
        Error::Kernel(KernelError::BrokenPromise {
            promise: violation.promise,
            quantity: violation.quantity,
            contact: self.nodes.clone(),
            node: table.grid().coordinates(violation.node),
            value: violation.value,
        })
    }
}

/// The Cholesky factor, or the first row whose pivot is not positive, with the pivot.
fn factored(mut matrix: DMatrix<f64>) -> Result<Cholesky<f64, nalgebra::Dyn>, (usize, f64)> {
    for j in 0..matrix.nrows() {
        let own = matrix[(j, j)];
        let row = matrix.row(j);
        let pivot = own - row.columns(0, j).norm_squared();
        // What rounding leaves of a pivot that is zero: a few units of the diagonal for each column.
        let rounding = (j + 4) as f64 * f64::EPSILON * own;
        if pivot.is_nan() || pivot <= rounding {
            return Err((j, pivot));
        }
        let diagonal = pivot.sqrt();
        matrix[(j, j)] = diagonal;
        for i in j + 1..matrix.nrows() {
            let product = matrix.row(i).columns(0, j).dot(&matrix.row(j).columns(0, j));
            matrix[(i, j)] = (matrix[(i, j)] - product) / diagonal;
        }
    }
    Ok(Cholesky::pack_dirty(matrix))
}

/// The greatest sum of absolute values along a row.
fn row_sum_norm(matrix: &DMatrix<f64>) -> f64 {
    matrix.row_iter().map(|row| row.lp_norm(1)).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_norm_is_the_greatest_row() {
        let matrix = DMatrix::from_row_slice(2, 2, &[1.0, -2.0, -3.0, 4.0]);
        assert_eq!(row_sum_norm(&matrix), 7.0);
        assert_eq!(row_sum_norm(&matrix.transpose()), 6.0);
    }
}
