//! The plain dense updater, an oracle for the others.

use nalgebra::{Cholesky, DMatrix, Dyn};

use super::{Left, LinearUpdater, Schur, Solution, WindowFactor, check_count};
use crate::contact::ContactSequence;
use crate::{Error, Problem};

/// Assembles and factors the whole influence matrix of the contact whenever it is asked.
///
/// O(n³) for every call: for testing other updaters, see [`check`](super::check). It keeps nothing, shares
/// no code with [`RecursiveCholesky`](super::RecursiveCholesky), and ignores the factor in [`WindowFactor`].
#[derive(Debug, Clone, Copy, Default)]
pub struct Dense;

impl Dense {
    /// The updater, which has no state.
    #[must_use]
    pub fn new() -> Self {
        Self
    }

    /// Influence coefficients between two sets of nodes.
    fn influence(
        problem: &Problem,
        rows: &[usize],
        columns: &[usize],
    ) -> Result<DMatrix<f64>, Error> {
        problem.check_nodes(rows)?;
        problem.check_nodes(columns)?;
        Ok(DMatrix::from_fn(rows.len(), columns.len(), |i, j| {
            problem.coefficient(rows[i], columns[j]).unwrap_or_default()
        }))
    }

    /// Right-hand sides of a set of nodes.
    fn rhs(problem: &Problem, nodes: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(nodes.len(), Problem::RHS, |i, c| problem.rhs(nodes[i])[c])
    }

    fn factor(problem: &Problem, contact: &[usize]) -> Result<Cholesky<f64, Dyn>, Error> {
        let matrix = Self::influence(problem, contact, contact)?;
        Cholesky::new(matrix).ok_or(Error::FactorizationFailed { nodes: contact.len() })
    }
}

impl LinearUpdater for Dense {
    fn watch(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        let contact = contact.order();
        let coupling = Self::influence(problem, contact, nodes)?;
        let solved = Self::factor(problem, contact)?.solve(&coupling);
        schur.resize(nodes.len())?;
        let complement = Self::influence(problem, nodes, nodes)? - coupling.transpose() * &solved;
        schur.matrix_mut().copy_from(&complement);
        let sums = Self::rhs(problem, nodes) - solved.transpose() * Self::rhs(problem, contact);
        for (target, sum) in schur.row_sums_mut().iter_mut().zip(sums.column(2).iter()) {
            *target = *sum;
        }
        Ok(())
    }

    fn join(&mut self, _: &Problem, _: &ContactSequence, _: &WindowFactor) -> Result<(), Error> {
        Ok(())
    }

    fn solve(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        count: usize,
        approach: f64,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        let Some(contact) = contact.order().get(..count) else {
            return Err(Error::LengthMismatch { expected: contact.len(), found: count });
        };
        problem.check_nodes(contact)?;
        let rhs = DMatrix::from_fn(contact.len(), 2, |i, c| match c {
            0 => approach - problem.initial_gap()[contact[i]],
            _ => 1.0,
        });
        let solved = Self::factor(problem, contact)?.solve(&rhs);
        solution.pressure = solved.column(0).iter().copied().collect();
        solution.rate = solved.column(1).iter().copied().collect();
        Ok(())
    }

    fn truncate(&mut self, _: &Problem, _: &ContactSequence) -> Result<(), Error> {
        Ok(())
    }

    fn release(&mut self, _: &Problem, _: &ContactSequence, _: &[Left]) -> Result<(), Error> {
        Ok(())
    }

    fn watch_both(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        positions: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        let contact = contact.order();
        let outside = Self::influence(problem, contact, nodes)?;
        let size = nodes.len() + positions.len();
        let coupling =
            DMatrix::from_fn(contact.len(), size, |i, j| match j.checked_sub(nodes.len()) {
                None => outside[(i, j)],
                Some(q) => f64::from(u8::from(positions[q] == i)),
            });
        let solved = Self::factor(problem, contact)?.solve(&coupling);
        let mut matrix = coupling.transpose() * solved * -1.0;
        let mut own = matrix.view_mut((0, 0), (nodes.len(), nodes.len()));
        own += Self::influence(problem, nodes, nodes)?;
        schur.resize(size)?;
        schur.matrix_mut().copy_from(&matrix);
        Ok(())
    }

    fn relief(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
    ) -> Result<Option<DMatrix<f64>>, Error> {
        let contact = contact.order();
        let coupling = Self::influence(problem, contact, nodes)?;
        Ok(Some(Self::factor(problem, contact)?.solve(&coupling)))
    }

    fn solve_for(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        rhs: &mut [[f64; 2]],
    ) -> Result<(), Error> {
        check_count(contact.len(), rhs.len())?;
        let b = DMatrix::from_fn(rhs.len(), 2, |i, c| rhs[i][c]);
        let solved = Self::factor(problem, contact.order())?.solve(&b);
        for (i, x) in rhs.iter_mut().enumerate() {
            *x = [solved[(i, 0)], solved[(i, 1)]];
        }
        Ok(())
    }

    /// The matrix and its factor.
    fn bytes(&self, contact: usize, watched: usize) -> usize {
        let side = contact.saturating_add(watched);
        side.saturating_mul(side).saturating_mul(2 * size_of::<f64>())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_chain;

    /// With node 0 in contact, C = 4 and 1 beside it: nodes 1 and 3 have the Schur complement (4 − 1/4, 0; 0, 4), and
    /// the row sums 6 − 5/4 and 5.
    #[test]
    fn complements_of_nodes_in_a_row() -> Result<(), Error> {
        let problem = test_chain::problem(&[0.0, 1.0, 2.0, 3.0])?;
        let contact = ContactSequence::with_order(problem.grid(), [0])?;
        let mut schur = Schur::default();
        Dense.watch(&problem, &contact, &[1, 3], &mut schur)?;
        let matrix = schur.matrix();
        let found = matrix.iter().chain(schur.row_sums());
        for (found, expected) in found.zip([3.75, 0.0, 0.0, 4.0, 4.75, 5.0]) {
            // Row sums are those of a transform.
            assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        }
        let mut solution = Solution::default();
        Dense.solve(&problem, &contact, 1, 3.0, &mut solution)?;
        assert_eq!((&solution.pressure[..], &solution.rate[..]), (&[0.75][..], &[0.25][..]));
        assert!(matches!(
            Dense.solve(&problem, &contact, 2, 3.0, &mut solution),
            Err(Error::LengthMismatch { expected: 1, found: 2 })
        ));
        assert!(Dense.watch(&problem, &contact, &[4], &mut schur).is_err());
        Ok(())
    }

    /// A matrix of 5 × 5 and its factor.
    #[test]
    fn bytes_are_those_of_two_matrices() {
        assert_eq!((Dense.bytes(3, 2), Dense.bytes(usize::MAX, 1)), (400, usize::MAX));
    }
}
