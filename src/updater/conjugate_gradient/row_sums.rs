//! Row sums of the influence matrix with the contact eliminated, for the rate of the mean gap.

use std::borrow::Cow;
use std::mem;

use super::local::Local;
use super::proposed::Proposed;
use super::solver::Solver;
use super::tuning::{STALE, SUMS_TOLERANCE};
use crate::contact::ContactSequence;
use crate::krylov::{Directions, Equation, Field, greatest};
use crate::{Error, Problem};

/// `C_II⁻¹ s_I` for the row sums s of C.
#[derive(Debug, Clone)]
pub(super) struct RowSums {
    /// How many nodes of the contact, the first ones, `field` is the solution on.
    count: usize,
    field: Field,
    /// The same on the whole contact, as far as local solutions tell: a start.
    start: Vec<f64>,
}

impl RowSums {
    /// Of which nothing but a start is known.
    pub(super) fn start(count: usize, pressure: Vec<f64>) -> Self {
        Self { count, start: pressure, field: Field::default() }
    }

    /// The solution on the first `count` nodes of a contact, and a start on the whole one.
    pub(super) fn of(count: usize, field: Field, start: Vec<f64>) -> Self {
        Self { count, field, start }
    }

    /// The arguments of [`Self::of`] that restore it, besides [`Self::count`].
    pub(super) fn parts(&self) -> (&Field, &[f64]) {
        (&self.field, &self.start)
    }

    /// Follows nodes that were proposed and have joined since, and solves on the whole contact if what is known is
    /// no longer good enough. `open` says what part of the grid still closes.
    pub(super) fn follow(
        &mut self,
        (solver, directions): (&mut Solver, &mut Directions),
        proposed: &Proposed,
        max_iterations: usize,
        problem: &Problem,
        contact: &ContactSequence,
        open: f64,
    ) -> Result<(), Error> {
        let new = contact.len().saturating_sub(self.count);
        if self.field.is_known() {
            if new == 0 {
                return Ok(());
            }
            // Nodes that joined without being proposed are not in the start.
            let follows = proposed.carry_row_sums(contact, &mut self.start);
            // The fewer nodes are out of contact, the greater the part of their remaining row sums that a new one
            // takes.
            let left = problem.grid().nodes() - contact.len();
            if follows && STALE * new < contact.len().min(left) {
                return Ok(());
            }
        }
        let sums = problem.row_sums();
        let most = greatest(sums.len(), 0.0, |i| sums[i]);
        let equation = Equation {
            rhs: |node: usize| sums[node],
            // What is explained already leaves less to be explained.
            tolerance: SUMS_TOLERANCE * most * open.clamp(1e-6, 1.0),
            most_drift: f64::INFINITY,
            max_iterations,
        };
        let field =
            solver.solve(&equation, self.start.clone(), Cow::Borrowed(&self.field), directions)?;
        self.start.clone_from(&field.pressure);
        self.count = contact.len();
        self.field = field;
        Ok(())
    }

    /// The row sum of a proposed node with the contact eliminated: `s_j − C_jI C_II⁻¹ s_I`.
    pub(super) fn left_at(&self, problem: &Problem, local: &Local) -> f64 {
        let left = |node: usize| problem.row_sums()[node] - self.field.displacement[node];
        let near = local.contact.iter().zip(&local.weights);
        let near = near.map(|(&node, x)| x * left(node as usize));
        left(local.node) - near.sum::<f64>()
    }

    /// Keeps, as a start, what belongs to nodes that are left in contact.
    pub(super) fn keep(&mut self, left: &ContactSequence) {
        let mut start = Field::of(mem::take(&mut self.start));
        start.keep(left);
        *self = Self::start(left.len(), start.pressure);
    }

    /// Number of nodes in contact that they have been solved for.
    pub(super) fn count(&self) -> usize {
        self.count
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::problem;
    use super::*;
    use crate::test_chain;
    use crate::updater::conjugate_gradient::local::Neighbourhood;

    /// Row sums in a row of four are 5, 6, 6 and 5. Of node 1 an answer to two nodes takes 1/4 each of what is left
    /// there.
    #[test]
    fn what_is_left_of_row_sums() -> Result<(), Error> {
        let problem = test_chain::problem(&[0.0; 4])?;
        let mut sums = RowSums::start(2, vec![1.0, 2.0, 3.0, 4.0]);
        sums.field.displacement = vec![4.0, 1.5, 4.0, 0.0];
        let local = Local { node: 1, contact: vec![0, 2], weights: vec![0.25; 2] };
        // 6 − 1.5 − (5 − 4)/4 − (6 − 4)/4.
        let left = sums.left_at(&problem, &local);
        // Row sums are those of a transform.
        assert!((left - 3.75).abs() < 1e-13, "{left}");
        let contact = ContactSequence::with_order(problem.grid(), [3])?;
        sums.keep(&contact);
        assert_eq!((sums.count(), &sums.start[..]), (1, &[0.0, 0.0, 0.0, 4.0][..]));
        assert!(!sums.field.is_known());
        Ok(())
    }

    /// With one of 51 nodes new that was watched, what is known goes on to serve; with one of 50 it does not, nor with
    /// 50 or fewer out of contact, nor with a node that was not watched. What is left of row sums is then nothing on
    /// the contact.
    #[test]
    fn row_sums_are_solved_for_when_they_are_stale() -> Result<(), Error> {
        for (before, joined, open, is_solved) in [
            (50, &[3][..], 0.5, false),
            (49, &[3], 0.5, true),
            (99, &[3, 7], 0.5, false),
            (98, &[3, 7], 0.5, true),
            (188, &[3], 0.01, false),
            (189, &[3], 0.01, true),
            (200, &[9], 0.5, true),
            (200, &[], 0.5, false),
        ] {
            let problem = problem()?;
            let free = (0..240).filter(|node| ![3, 7, 9].contains(node));
            let mut contact = ContactSequence::with_order(problem.grid(), free.take(before))?;
            let (mut solver, mut directions) = (Solver::new(&problem), Directions::default());
            solver.choose(&contact, before);
            let mut sums = RowSums::start(0, vec![0.0; 240]);
            let parts = (&mut solver, &mut directions);
            sums.follow(parts, &Proposed::default(), 1000, &problem, &contact, 1.0)?;
            assert_eq!(sums.count(), before);
            let beside = (&Neighbourhood::new(&problem), &solver);
            let left = |local: &Local| sums.left_at(&problem, local);
            let mut proposed = Proposed::new(&problem, beside, [&[3, 7], &[]], before)?;
            proposed.tell_row_sums(left);
            for &node in joined {
                contact.push(node)?;
            }
            let mut directions = Directions::default();
            solver.choose(&contact, contact.len());
            sums.follow((&mut solver, &mut directions), &proposed, 1000, &problem, &contact, open)?;
            let known = if is_solved { contact.len() } else { before };
            assert_eq!(sums.count(), known, "{before} {joined:?} {open}");
            // To 3·10⁻³ of the greatest, and of what closes if that is less.
            let most = problem.row_sums().iter().copied().fold(0.0, f64::max);
            for &node in &contact.order()[..known] {
                let left = problem.row_sums()[node] - sums.field.displacement[node];
                assert!(left.abs() <= 3e-3 * most, "{left}");
            }
        }
        Ok(())
    }
}
