//! The plain dense updater, an oracle for the others.

use nalgebra::{Cholesky, DMatrix, Dyn};

use super::{LinearUpdater, Schur, Solution, SolveRequest, Touched};
use crate::contact::ContactSequence;
use crate::{Error, Problem};

/// Assembles and factors the whole influence matrix of the contact whenever it is asked.
///
/// O(n³) for every call: for testing other updaters, see [`check`](super::check). It keeps nothing, shares
/// no code with [`RecursiveCholesky`](super::RecursiveCholesky), and ignores the factor in [`Touched`].
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
        Cholesky::new(matrix).ok_or(Error::FactorizationFailed {
            nodes: contact.len(),
        })
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

    fn join(&mut self, _: &Problem, _: &ContactSequence, _: &Touched) -> Result<(), Error> {
        Ok(())
    }

    fn solve(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        request: SolveRequest,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        let Some(contact) = contact.order().get(..request.count) else {
            return Err(Error::LengthMismatch {
                expected: contact.len(),
                found: request.count,
            });
        };
        problem.check_nodes(contact)?;
        let rhs = DMatrix::from_fn(contact.len(), 2, |i, c| match c {
            0 => request.approach - problem.initial_gap()[contact[i]],
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

    fn release(
        &mut self,
        _: &Problem,
        _: &ContactSequence,
        _: usize,
        _: usize,
    ) -> Result<(), Error> {
        Ok(())
    }

    /// The matrix and its factor.
    fn bytes(&self, contact: usize, watched: usize) -> usize {
        let side = contact.saturating_add(watched);
        side.saturating_mul(side)
            .saturating_mul(2 * size_of::<f64>())
    }
}
