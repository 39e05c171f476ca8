//! Solutions by conjugate gradients and FFT, without a factor.

mod state;

use super::{LinearUpdater, Schur, Solution, Touched, UpdaterProfile, WindowCost, check_count};
use crate::contact::ContactSequence;
use crate::{Error, Problem};
use state::{Criteria, State};

/// What a column costs, some twenty convolutions of 12 ns for each node of the grid, is the same in
/// every window. A refresh costs as much as three columns, and products between columns, 0.3 ns
/// each, grow with their number: so many are watched that both are small beside the columns.
const WINDOW_COST: WindowCost = WindowCost {
    solve: 0.0,
    schur: 0.3,
    convolution: 700.0,
    most_watched: 0.05,
    multiple: 1,
};

/// Solves by preconditioned conjugate gradients with one convolution a step ("when the total nodes
/// get large and reach the computation or storage limitation", as the paper has it).
///
/// No factor is kept. Besides memory in proportion to the grid it holds the columns `X = C_II⁻¹ C_IP` of
/// the watched nodes P and their residuals, 16 bytes for each contact node and each watched one: some
/// hundred of them by default, fewer where the memory budget or
/// [`window_size`](crate::loading::LoadingBuilder::window_size) says so.
///
/// When nodes touch, columns and solutions are carried over by the paper's recursion (eqs. 10-13, for a
/// block of nodes), so that all starts are warm. Schur complements take the residuals into account,
/// `bᵢᵀ C⁻¹ bⱼ ≈ bᵢᵀ xⱼ + xᵢᵀ rⱼ`, whose error is the product of two: columns need only the root of the
/// tolerance.
///
/// [`RecursiveCholesky`](super::RecursiveCholesky) is faster wherever its factor fits, and
/// [`Handover`](super::Handover) chooses between the two.
#[derive(Debug, Clone)]
pub struct ConjugateGradient {
    criteria: Criteria,
    state: Option<State>,
}

impl Default for ConjugateGradient {
    fn default() -> Self {
        Self {
            criteria: Criteria {
                tolerance: 1e-12,
                max_iterations: 5000,
            },
            state: None,
        }
    }
}

impl ConjugateGradient {
    /// No node in contact, and a relative tolerance of 10⁻¹².
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// No node in contact, and another tolerance: of the greatest residual relative to the greatest
    /// right-hand side.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a tolerance that is not between 0 and 1, both excluded.
    pub fn with_tolerance(tolerance: f64) -> Result<Self, Error> {
        if !(tolerance > 0.0 && tolerance < 1.0) {
            return Err(Error::OutOfRange {
                quantity: "tolerance",
                value: tolerance,
                expected: "above 0 and below 1",
            });
        }
        let mut updater = Self::default();
        updater.criteria.tolerance = tolerance;
        Ok(updater)
    }

    /// Begins with a contact and the solution on it.
    pub(super) fn take_over(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        solution: &Solution,
    ) -> Result<(), Error> {
        problem.check_nodes(contact.order())?;
        self.state = Some(State::from_solution(problem, contact, solution));
        Ok(())
    }
}

impl LinearUpdater for ConjugateGradient {
    /// Nodes that were watched before start from their earlier columns.
    ///
    /// # Errors
    ///
    /// [`Error::NoConvergence`], and [`Error::FactorizationFailed`] if the kernel is not positive
    /// definite.
    fn watch(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        problem.check_nodes(nodes)?;
        let state = self.state.get_or_insert_with(|| State::new(problem));
        check_count(state.len(), contact.len())?;
        state.watch(self.criteria, problem, nodes, schur)
    }

    fn join(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        touched: &Touched,
    ) -> Result<(), Error> {
        problem.check_nodes(contact.order())?;
        let state = self.state.get_or_insert_with(|| State::new(problem));
        check_count(state.watched(), touched.watched())?;
        check_count(state.len() + touched.len(), contact.len())?;
        state.join(problem, contact, touched);
        Ok(())
    }

    fn solve(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        count: usize,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        problem.check_nodes(contact.order())?;
        let state = self.state.get_or_insert_with(|| State::new(problem));
        check_count(state.len(), contact.len())?;
        match contact.order().get(..count) {
            Some(nodes) if count == contact.len() => {
                state.solve(self.criteria, problem, nodes, solution)
            }
            Some(nodes) => state.solve_prefix(self.criteria, problem, nodes, solution),
            None => check_count(contact.len(), count),
        }
    }

    fn truncate(&mut self, problem: &Problem, contact: &ContactSequence) -> Result<(), Error> {
        let state = self.state.get_or_insert_with(|| State::new(problem));
        state.shrink(contact);
        Ok(())
    }

    fn release(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        _node: usize,
        _position: usize,
    ) -> Result<(), Error> {
        self.truncate(problem, contact)
    }

    fn profile(&self) -> UpdaterProfile {
        UpdaterProfile {
            exact: true,
            cost: WINDOW_COST,
        }
    }

    fn bytes(&self, contact: usize, watched: usize) -> usize {
        let fixed = self.state.as_ref().map_or(0, |state| state.bytes());
        let columns = watched.saturating_mul(2).saturating_add(8);
        contact
            .saturating_mul(columns)
            .saturating_mul(size_of::<f64>())
            .saturating_add(fixed)
    }
}
