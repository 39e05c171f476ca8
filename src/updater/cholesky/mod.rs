//! The recursive Cholesky factorisation.

mod columns;
mod factor;
mod operations;
mod panels;
mod products;
mod substitution;

pub use factor::CholeskyTimings;

use nalgebra::DMatrix;

use super::{JOINED, Left, LinearUpdater, Schur, Solution, WindowFactor, check_count, join_all};
use crate::clock::Stopwatch;
use crate::contact::ContactSequence;
use crate::{Error, Problem};
use columns::Columns;
use factor::Factor;

/// The Cholesky factor of the contact's influence matrix, grown by one row for each node that touches
/// (paper, eqs. 14-19), in blocks.
///
/// The factor `C_II = L Lᵀ` is stored as its lower half, 4n² bytes for n nodes. With it grow the
/// forward-substituted right-hand sides `L⁻¹B` and the columns `F = L⁻¹C_IP` of the watched nodes P, so
/// that
///
/// * the Schur complement is `C_PP − FᵀF`, and only nodes that were not watched before cost a forward
///   substitution (n² flops each);
/// * a node that touches has its row of L ready, `[F_jᵀ, …]`: the paper's lⁿ (eq. 16);
/// * a solution costs one backward substitution (eq. 17).
#[derive(Debug, Clone)]
pub struct RecursiveCholesky {
    factor: Factor,
    /// L⁻¹B, row by row.
    border: Vec<[f64; Problem::RHS]>,
    /// Reduced right-hand sides of the watched nodes.
    reduced: Vec<[f64; Problem::RHS]>,
}

impl Default for RecursiveCholesky {
    fn default() -> Self {
        Self::new()
    }
}

impl RecursiveCholesky {
    /// No node in contact.
    #[must_use]
    pub fn new() -> Self {
        Self { factor: Factor::new(), border: Vec::new(), reduced: Vec::new() }
    }

    /// The factor of a contact that is known as a whole, and the contact.
    pub(crate) fn of(problem: &Problem, nodes: &[usize]) -> Result<(Self, ContactSequence), Error> {
        let mut updater = Self::new();
        let mut contact = ContactSequence::new(problem.grid());
        join_all(&mut updater, problem, &mut contact, nodes, usize::MAX)?;
        Ok((updater, contact))
    }

    /// Bytes held at most while [`Self::of`] factors `contact` nodes.
    pub(crate) fn bytes_of(contact: usize) -> usize {
        let updater = Self::new().bytes(contact, JOINED);
        updater.saturating_add(WindowFactor::bytes(JOINED))
    }

    /// L⁻¹B, row by row: sums of products of its first n rows are those of the first n nodes.
    pub(crate) fn border(&self) -> &[[f64; Problem::RHS]] {
        &self.border
    }

    /// The same as [`watch_both`](LinearUpdater::watch_both), where nodes in contact have their positions and come in
    /// any order, and `schur` has the matrix of the first `known` of them, those that were watched before.
    pub(crate) fn watch_beside(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        watched: &[(usize, Option<usize>)],
        known: usize,
        schur: &mut Schur,
    ) -> Result<(), Error> {
        self.factor.eliminate(problem, contact, watched, known, schur)?;
        // For the nodes that join later. The row sums of `schur` are not asked for.
        self.reduced.clear();
        self.reduced.extend(watched.iter().map(|&(node, position)| {
            position.map_or_else(|| problem.rhs(node), |_| [0.0; Problem::RHS])
        }));
        self.factor.columns.subtract_products(&self.border, &mut self.reduced);
        Ok(())
    }

    /// Forgets nodes that left the contact as [`release`](LinearUpdater::release) does, but the watched nodes stay
    /// watched, and those that left are too, behind the others.
    pub(crate) fn release_watched(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        left: &[Left],
    ) -> Result<(), Error> {
        problem.check_nodes(contact.order())?;
        self.factor.release_watched(contact, left)?;
        self.renew_border(problem, contact);
        Ok(())
    }

    fn renew_border(&mut self, problem: &Problem, contact: &ContactSequence) {
        self.border.clear();
        self.border.extend(contact.order().iter().map(|&node| problem.rhs(node)));
        Columns::solve(&self.factor.panels, &mut self.border);
    }

    /// Where the time went so far.
    #[doc(hidden)]
    #[must_use]
    pub fn timings(&self) -> CholeskyTimings {
        self.factor.timings
    }
}

impl LinearUpdater for RecursiveCholesky {
    /// Nodes that were watched before are recognised if they come first and in the same order;
    /// only the others cost a forward substitution.
    fn watch(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        let watched: Vec<_> = nodes.iter().map(|&node| (node, None)).collect();
        self.factor.eliminate(problem, contact, &watched, 0, schur)?;
        let start = Stopwatch::start();
        self.reduced.clear();
        self.reduced.extend(nodes.iter().map(|&node| problem.rhs(node)));
        let columns = &self.factor.columns;
        columns.subtract_products(&self.border, &mut self.reduced);
        for (sum, [_, _, reduced]) in schur.row_sums_mut().iter_mut().zip(&self.reduced) {
            *sum = *reduced;
        }
        self.factor.timings.schur += start.elapsed();
        Ok(())
    }

    fn join(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        touched: &WindowFactor,
    ) -> Result<(), Error> {
        self.factor.join(problem, contact, touched)?;
        let positions = touched.positions().iter();
        let mut rows: Vec<_> =
            positions.filter_map(|&position| self.reduced.get(position).copied()).collect();
        touched.solve(&mut rows);
        self.border.append(&mut rows);
        Ok(())
    }

    fn solve(
        &mut self,
        _problem: &Problem,
        contact: &ContactSequence,
        count: usize,
        approach: f64,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        check_count(self.factor.len(), contact.len())?;
        let start = Stopwatch::start();
        let Some(border) = self.border.get(..count) else {
            return check_count(self.border.len(), count);
        };
        let Solution { pressure, rate } = solution;
        pressure.clear();
        pressure.extend(border.iter().map(|[gap, unit, _]| approach * unit - gap));
        rate.clear();
        rate.extend(border.iter().map(|[_, unit, _]| unit));
        let panels = &self.factor.panels;
        panels.solve_transposed([&mut pressure[..], &mut rate[..]]);
        self.factor.timings.solve += start.elapsed();
        Ok(())
    }

    fn truncate(&mut self, _problem: &Problem, contact: &ContactSequence) -> Result<(), Error> {
        self.factor.truncate(contact.len());
        self.border.truncate(contact.len());
        Ok(())
    }

    /// The rows of later nodes are rotated into place: much less than a new factor, and as accurate.
    fn release(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        left: &[Left],
    ) -> Result<(), Error> {
        problem.check_nodes(contact.order())?;
        let positions: Vec<usize> = left.iter().map(|left| left.position).collect();
        self.factor.release(contact, &positions)?;
        self.renew_border(problem, contact);
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
        let outside = nodes.iter().map(|&node| (node, None));
        let inside = positions.iter().map(|&position| {
            (contact.order().get(position).copied().unwrap_or(usize::MAX), Some(position))
        });
        let watched: Vec<_> = outside.chain(inside).collect();
        self.watch_beside(problem, contact, &watched, 0, schur)
    }

    fn relief(
        &mut self,
        _problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
    ) -> Result<Option<DMatrix<f64>>, Error> {
        check_count(self.factor.len(), contact.len())?;
        let start = Stopwatch::start();
        let relief = self.factor.relief(nodes)?;
        self.factor.timings.forward += start.elapsed();
        Ok(Some(relief))
    }

    fn solve_for(
        &mut self,
        _problem: &Problem,
        contact: &ContactSequence,
        rhs: &mut [[f64; 2]],
    ) -> Result<(), Error> {
        check_count(self.factor.len(), contact.len())?;
        check_count(self.factor.len(), rhs.len())?;
        let start = Stopwatch::start();
        let panels = &self.factor.panels;
        Columns::solve(panels, rhs);
        let [mut first, mut second] = [0, 1].map(|k| rhs.iter().map(|x| x[k]).collect::<Vec<_>>());
        panels.solve_transposed([&mut first[..], &mut second[..]]);
        for (x, solved) in rhs.iter_mut().zip(first.into_iter().zip(second)) {
            *x = solved.into();
        }
        self.factor.timings.solve += start.elapsed();
        Ok(())
    }

    fn bytes(&self, contact: usize, watched: usize) -> usize {
        let rows = contact.saturating_add(watched);
        Factor::bytes(contact, watched)
            .saturating_add(rows.saturating_mul(size_of::<[f64; Problem::RHS]>()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::updater::Dense;

    /// One block of 256 × 256 numbers, columns of 256 rows for two watched nodes, and three right-hand sides of five
    /// nodes.
    #[test]
    fn bytes_are_those_of_factor_columns_and_right_hand_sides() {
        let bytes = 8 * (256 * 256 + 256 * 2 + 3 * 5);
        assert_eq!(RecursiveCholesky::new().bytes(3, 2), bytes);
        assert_eq!(RecursiveCholesky::new().bytes(usize::MAX, 2), usize::MAX);
        // Joined in blocks of 256, whose Schur complement and factor come to it.
        let joined = 8 * (256 * 256 + 256 * 256 + 3 * 356 + 2 * 256 * 256);
        assert_eq!(RecursiveCholesky::bytes_of(100), joined);
    }

    /// Three panels, and columns of two blocks in another order than they are watched: the answers of a dense solution.
    #[test]
    fn nodes_that_touch_relieve_the_contact() -> Result<(), Error> {
        let problem = crate::test_chain::problem(&[0.0; 900])?;
        let contact: Vec<usize> = (0..900).filter(|node| node % 3 != 1).collect();
        let (mut updater, sequence) = RecursiveCholesky::of(&problem, &contact)?;
        let watched: Vec<usize> = (0..600).filter(|node| node % 3 == 1).collect();
        updater.watch(&problem, &sequence, &watched, &mut Schur::default())?;
        let touching: Vec<usize> = watched.iter().rev().step_by(2).copied().collect();
        let found = updater.relief(&problem, &sequence, &touching)?.unwrap_or_default();
        let expected = Dense.relief(&problem, &sequence, &touching)?.unwrap_or_default();
        assert_eq!((found.shape(), expected.amax() > 0.1), ((600, 100), true));
        // Rounding of numbers below 1, in a well-conditioned matrix.
        assert!((found - expected).amax() < 1e-14);
        assert!(updater.relief(&problem, &sequence, &[1, 4])?.is_some());
        assert!(updater.relief(&problem, &sequence, &[600]).is_err());
        Ok(())
    }

    /// Nodes that were watched before are known again, also those that were new then: the same matrix as of an updater
    /// that has watched nothing.
    #[test]
    fn nodes_are_watched_again_before_any_touches() -> Result<(), Error> {
        let problem = crate::test_chain::problem(&[0.0; 400])?;
        let contact: Vec<usize> = (0..400).step_by(7).collect();
        let free = |step| -> Vec<usize> {
            (0..400_usize).step_by(step).filter(|node| node % 7 != 0).collect()
        };
        let (mut updater, sequence) = RecursiveCholesky::of(&problem, &contact)?;
        let mut again = Schur::default();
        for step in [1, 2, 6] {
            updater.watch(&problem, &sequence, &free(step), &mut again)?;
        }
        let (mut other, sequence) = RecursiveCholesky::of(&problem, &contact)?;
        let mut first = Schur::default();
        other.watch(&problem, &sequence, &free(6), &mut first)?;
        for j in 0..first.size() {
            for i in j..first.size() {
                assert!((first.entry(i, j) - again.entry(i, j)).abs() < 1e-15, "{i} {j}");
            }
        }
        Ok(())
    }
}
