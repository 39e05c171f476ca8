//! The plain dense updater, an oracle for the others.

use nalgebra::{Cholesky, DMatrix, Dyn};

use super::{LinearUpdater, Schur, Solution, System, Touched};
use crate::Error;

/// Assembles and factors the whole influence matrix of the contact set whenever it is asked.
///
/// O(n³) for every call: primarily for testing other updaters. It shares no code with
/// [`RecursiveCholesky`](super::RecursiveCholesky) and ignores the factor in [`Touched`].
#[derive(Debug, Clone, Default)]
pub struct Dense {
    contact: Vec<usize>,
}

impl Dense {
    /// An empty contact set.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Influence coefficients between two sets of nodes.
    fn influence(
        system: &System,
        rows: &[usize],
        columns: &[usize],
    ) -> Result<DMatrix<f64>, Error> {
        system.check_nodes(rows)?;
        system.check_nodes(columns)?;
        Ok(DMatrix::from_fn(rows.len(), columns.len(), |i, j| {
            system.coefficient(rows[i], columns[j]).unwrap_or_default()
        }))
    }

    /// Right-hand sides of a set of nodes.
    fn rhs(system: &System, nodes: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(nodes.len(), System::RHS, |i, c| {
            system.rhs(nodes[i]).unwrap_or_default()[c]
        })
    }

    fn factor(system: &System, contact: &[usize]) -> Result<Cholesky<f64, Dyn>, Error> {
        let matrix = Self::influence(system, contact, contact)?;
        Cholesky::new(matrix).ok_or(Error::FactorizationFailed {
            nodes: contact.len(),
        })
    }
}

impl LinearUpdater for Dense {
    fn schur(&mut self, system: &System, nodes: &[usize], schur: &mut Schur) -> Result<(), Error> {
        schur.resize(nodes.len());
        let inside = Self::factor(system, &self.contact)?;
        let coupling = Self::influence(system, &self.contact, nodes)?;
        let own = Self::influence(system, nodes, nodes)?;
        let complement = own - coupling.transpose() * inside.solve(&coupling);
        schur.matrix_mut().copy_from(&complement);
        let eliminated = coupling.transpose() * inside.solve(&Self::rhs(system, &self.contact));
        let reduced = Self::rhs(system, nodes) - eliminated;
        for (target, row) in schur.rhs_mut().iter_mut().zip(reduced.row_iter()) {
            for (target, value) in target.iter_mut().zip(row.iter()) {
                *target = *value;
            }
        }
        Ok(())
    }

    fn commit(&mut self, system: &System, touched: &Touched) -> Result<(), Error> {
        system.check_nodes(touched.nodes())?;
        self.contact.extend_from_slice(touched.nodes());
        Ok(())
    }

    fn release(&mut self, system: &System, node: usize) -> Result<(), Error> {
        system.check_nodes(&[node])?;
        let position = self.contact.iter().position(|&other| other == node);
        let position = position.ok_or_else(|| system.not_in_contact(node))?;
        self.contact.remove(position);
        Ok(())
    }

    fn solve(
        &mut self,
        system: &System,
        touched: &Touched,
        count: usize,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        let contact = touched.sequence(&self.contact, count)?;
        let solved = Self::factor(system, &contact)?.solve(&Self::rhs(system, &contact));
        solution.y1 = solved.column(0).iter().map(|value| -value).collect();
        solution.y2 = solved.column(1).iter().copied().collect();
        Ok(())
    }

    /// The matrix and its factor.
    fn bytes(&self, contact: usize, watched: usize) -> usize {
        let side = contact.saturating_add(watched);
        side.saturating_mul(side)
            .saturating_mul(2 * size_of::<f64>())
    }
}
