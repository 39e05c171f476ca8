//! Solutions by conjugate gradients and FFT, without a factor.

mod equilibrium;
mod galerkin;
mod instants;
mod local;
mod row_sums;
mod solver;
mod state;
#[cfg(test)]
mod tests;
mod tolerances;
mod watched;

use super::{
    LinearUpdater, Schur, Solution, SolveRequest, Touched, UpdaterProfile, WindowCost, check_count,
};
use crate::contact::ContactSequence;
use crate::krylov::check_cells;
use crate::parallel::inside;
use crate::{Error, Problem};
use state::State;
use tolerances::Criteria;

/// Bytes held at most for each node of the grid, and in addition for each one in contact. Measured on grids from
/// 20 × 20 to 96 × 96: 315 to 470, and 390 to 800; see `tests/robustness/memory_peaks.rs`.
const BYTES_A_NODE: usize = 480;
const BYTES_A_CONTACT_NODE: usize = 1000;

/// Solves by preconditioned conjugate gradients with one convolution a step ("when the total nodes
/// get large and reach the computation or storage limitation", as the paper has it).
///
/// No factor is kept, and nothing else that grows faster than the grid: a path to full contact on 512 × 512
/// nodes takes some 300 MB instead of 219 GB.
///
/// * A solution is exact to the [tolerance](Self::with_tolerance): gaps in contact are zero to 10⁻¹⁰ of the
///   approach. It starts from the last one, and from what the watched nodes did to the contact near them.
/// * A Schur complement is not exact. Inside a window it acts on what has changed since the window began
///   only, and there the contact near a node answers for nearly all of it. With the local solutions
///   `x_j = C_KK⁻¹ C_Kj` on the 144 nearest contact nodes K of each watched node j,
///
///   ```math
///   \tilde S_{ij} = (e_i - x_i)^T C\, (e_j - x_j)
///   ```
///
///   exceeds S by the square of the error of x. The path corrects it by what the next solution shows; see
///   [`loading`](crate::loading).
///
/// Cells of a periodic half-space may be [`MAX_ASPECT`](Self::MAX_ASPECT) times as long as wide: on longer ones
/// [`watch`](LinearUpdater::watch) is an [`Error::OutOfRange`], but a solution on a known contact is not.
///
/// Memory: some twenty fields of the grid.
#[derive(Debug, Clone)]
pub struct ConjugateGradient {
    criteria: Criteria,
    state: Option<State>,
    /// Nodes of the grid, once they are known.
    nodes: usize,
}

impl Default for ConjugateGradient {
    fn default() -> Self {
        Self {
            criteria: Criteria {
                tolerance: 1e-10,
                max_iterations: 5000,
            },
            state: None,
            nodes: 0,
        }
    }
}

impl ConjugateGradient {
    /// Greatest ratio of the sides of a periodic cell on a path. Long waves along longer cells are so soft that the nearest
    /// nodes do not say enough of a distant one: errors exceed their estimates, and events change places.
    pub const MAX_ASPECT: f64 = 10.0;

    /// No node in contact, and a tolerance of 10⁻¹⁰.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// No node in contact, and another tolerance: of the greatest gap in contact relative to the approach.
    /// The events of a path lie some 4·10⁻⁶ of the approach apart on a grid of 512 × 512 nodes.
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

    /// What there is for a problem, made at first use.
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`] for a problem on another grid than the one before, and
    /// [`Error::NodeOutOfGrid`] for a contact that is not one of it.
    fn state(&mut self, problem: &Problem, contact: &ContactSequence) -> Result<&mut State, Error> {
        problem.check_nodes(contact.order())?;
        let state = self.state.get_or_insert_with(|| State::new(problem));
        state.grid().check_shape(problem.grid().shape())?;
        Ok(state)
    }

    /// Bytes held on a grid of so many nodes with so many of them in contact.
    pub(crate) fn bytes_of(nodes: usize, contact: usize) -> usize {
        let fixed = nodes.saturating_mul(BYTES_A_NODE);
        fixed.saturating_add(contact.saturating_mul(BYTES_A_CONTACT_NODE))
    }

    /// `Ok` if a path on these cells needs no factor.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] otherwise.
    pub(super) fn check_cells(problem: &Problem) -> Result<(), Error> {
        let expected = "at most 10 without a factor; a path with one takes any";
        check_cells(
            &problem.grid(),
            problem.boundary(),
            (Self::MAX_ASPECT, expected),
        )
    }

    /// `Ok` if a budget in bytes is enough for a grid with so many nodes in contact.
    ///
    /// # Errors
    ///
    /// [`Error::MemoryBudget`] otherwise.
    pub(super) fn check_room(
        &mut self,
        problem: &Problem,
        budget: usize,
        contact: usize,
    ) -> Result<(), Error> {
        self.nodes = problem.grid().nodes();
        let needed = self.bytes(contact, 0);
        if needed <= budget {
            return Ok(());
        }
        let fixed = self.bytes(0, 0);
        Err(Error::MemoryBudget {
            needed,
            budget,
            nodes_that_fit: budget.saturating_sub(fixed) / BYTES_A_CONTACT_NODE,
        })
    }

    /// Begins with a contact and the solution on it.
    pub(super) fn take_over(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        approach: f64,
        solution: &Solution,
    ) -> Result<(), Error> {
        problem.check_nodes(contact.order())?;
        let mut state = State::new(problem);
        state.take_over(contact, approach, solution);
        self.state = Some(state);
        Ok(())
    }
}

impl LinearUpdater for ConjugateGradient {
    /// # Errors
    ///
    /// [`Error::NoConvergence`], [`Error::FactorizationFailed`] if the kernel is not positive
    /// definite, and [`Error::OutOfRange`] for periodic cells that are too long.
    fn watch(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        problem.check_nodes(nodes)?;
        Self::check_cells(problem)?;
        let criteria = self.criteria;
        let state = self.state(problem, contact)?;
        check_count(state.count(), contact.len())?;
        inside(|| state.watch(criteria, problem, contact, nodes, schur))
    }

    /// Nothing happens before the next solution, which finds the nodes in the contact.
    fn join(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        touched: &Touched,
    ) -> Result<(), Error> {
        let state = self.state(problem, contact)?;
        let joined = contact.len().checked_sub(state.count());
        match joined {
            Some(joined) if joined >= touched.len() => Ok(()),
            _ => check_count(state.count() + touched.len(), contact.len()),
        }
    }

    fn solve(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        request: SolveRequest,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        if request.count > contact.len() {
            return check_count(contact.len(), request.count);
        }
        let criteria = self.criteria;
        let state = self.state(problem, contact)?;
        inside(|| state.solve(criteria, problem, contact, request, solution))
    }

    fn truncate(&mut self, problem: &Problem, contact: &ContactSequence) -> Result<(), Error> {
        self.state(problem, contact)?.truncate(contact);
        Ok(())
    }

    fn release(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        _node: usize,
        _position: usize,
    ) -> Result<(), Error> {
        self.state(problem, contact)?.keep(contact);
        Ok(())
    }

    fn profile(&self) -> UpdaterProfile {
        UpdaterProfile {
            exact: false,
            tolerance: self.criteria.tolerance,
            cost: WindowCost::default(),
        }
    }

    /// Not before the grid is known, by [`make_room`](Self::make_room).
    fn bytes(&self, contact: usize, _watched: usize) -> usize {
        Self::bytes_of(self.nodes, contact)
    }

    fn make_room(&mut self, problem: &Problem, bytes: usize) -> Result<(), Error> {
        self.check_room(problem, bytes, 0)
    }
}
