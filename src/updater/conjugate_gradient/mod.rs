//! Solutions by conjugate gradients and FFT, without a factor.

mod equilibrium;
mod galerkin;
mod instants;
mod local;
mod plastic_sums;
mod proposed;
mod row_sums;
mod solutions;
mod solver;
#[cfg(test)]
mod tests;
mod tolerances;
mod tuning;

use super::{
    Behind, Beside, Iterations, Kept, Left, LinearUpdater, Proposal, Schur, Solution, Solved,
    WindowFactor, check_count,
};
use crate::contact::ContactSequence;
use crate::krylov::{Field, check_cells};
use crate::parallel::inside;
use crate::{Error, Problem};
use solutions::Solutions;
use tolerances::{Aim, Criteria};
use tuning::{BYTES_A_CONTACT_NODE, BYTES_A_NODE};

/// Solves by preconditioned conjugate gradients with one convolution a step ("when the total nodes
/// get large and reach the computation or storage limitation", as the paper has it).
///
/// No factor is kept, and nothing else that grows faster than the grid: a path to full contact on 512 × 512
/// nodes takes 0.4 GB instead of 275 GB.
///
/// A solution is exact to the [tolerance](Self::with_tolerance): gaps in contact are zero to 10⁻¹⁰ of the
/// approach. It starts from the last one, and from what nodes that joined did to the contact near them. An exact
/// [Schur complement](LinearUpdater::watch) takes a solution for each of its nodes.
///
/// A path does not need that: it takes Schur complements that are nearly exact, and corrects them by what the next
/// solution shows (see [`loading`](crate::loading)). Inside a window a Schur complement acts on what has changed since
/// the window began only, and there the contact near a node answers for nearly all of it. With the local solutions `x_j
/// = C_KK⁻¹ C_Kj` on the 144 nearest contact nodes K of each watched node j,
///
/// ```math
/// \tilde S_{ij} = (e_i - x_i)^T C\, (e_j - x_j)
/// ```
///
/// exceeds S by the square of the error of x. With a hardness nodes q in contact are watched too, with `x_q = C_KK⁻¹
/// e_q`: what a gap of q adds to the pressures near it.
///
/// As an updater of nodes that yield ([`watch_both`](LinearUpdater::watch_both)) it takes a solution for each node too;
/// a path does with local ones there as well.
///
/// Cells of a periodic half-space may be [`MAX_ASPECT`](Self::MAX_ASPECT) times as long as wide: on longer ones
/// a path is an [`Error::OutOfRange`], but a solution on a known contact is not.
///
/// Memory: at most 480 bytes for each node of the grid, and 1000 more for each node in contact.
#[derive(Debug, Clone)]
pub struct ConjugateGradient {
    criteria: Criteria,
    solutions: Option<Solutions>,
}

impl Default for ConjugateGradient {
    fn default() -> Self {
        Self { criteria: Criteria { tolerance: 1e-10, max_iterations: 5000 }, solutions: None }
    }
}

impl ConjugateGradient {
    /// Greatest ratio of the sides of a periodic cell on a path. Long waves along longer cells are so soft that the
    /// nearest nodes do not say enough of a distant one: errors exceed their estimates, and events change places.
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

    /// The same without anything that it has solved before.
    pub(crate) fn afresh(&self) -> Self {
        Self { criteria: self.criteria, solutions: None }
    }

    /// Solver and solutions of a problem, made at first use.
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`] for a problem on another grid than the one before, and
    /// [`Error::NodeOutOfGrid`] for a contact that is not one of it.
    fn solutions(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
    ) -> Result<&mut Solutions, Error> {
        problem.check_nodes(contact.order())?;
        // What is left of solutions on another kernel is none on this one.
        let known = self.solutions.take();
        let known = known.filter(|known| known.count() > 0 || problem.has_table(known.table()));
        let solutions = self.solutions.insert(known.unwrap_or_else(|| Solutions::new(problem)));
        solutions.grid().check_shape(problem.grid().shape())?;
        Ok(solutions)
    }

    /// Bytes held on a grid of so many nodes with so many of them in contact.
    pub(crate) fn bytes_of(nodes: usize, contact: usize) -> usize {
        let fixed = nodes.saturating_mul(BYTES_A_NODE);
        fixed.saturating_add(contact.saturating_mul(BYTES_A_CONTACT_NODE))
    }
}

impl Iterations for ConjugateGradient {
    fn tolerance(&self) -> f64 {
        self.criteria.tolerance
    }

    fn take_over(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        approach: f64,
        solution: &Solution,
    ) -> Result<(), Error> {
        problem.check_nodes(contact.order())?;
        let mut solutions = Solutions::new(problem);
        solutions.take_over(contact, approach, solution);
        self.solutions = Some(solutions);
        Ok(())
    }

    fn keep(&self, problem: &Problem, contact: &ContactSequence, may_yield: bool) -> Option<Kept> {
        self.solutions.as_ref()?.keep_all(self.criteria, problem, contact, may_yield)
    }

    fn restore(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        kept: &Kept,
    ) -> Result<bool, Error> {
        let criteria = self.criteria;
        if kept.tolerance != criteria.tolerance {
            return Ok(false);
        }
        problem.check_nodes(contact.order())?;
        let restored = inside(|| Solutions::restore(criteria, problem, contact, kept))?;
        self.solutions = Some(restored);
        Ok(true)
    }

    /// # Errors
    ///
    /// [`Error::NoConvergence`], [`Error::FactorizationFailed`] if the kernel
    /// is not positive definite, and [`Error::OutOfRange`] for periodic cells that are too long.
    fn propose(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: [&[usize]; 2],
        beside: Option<&Beside<'_>>,
        schur: &mut Schur,
    ) -> Result<Proposal, Error> {
        nodes.into_iter().try_for_each(|nodes| problem.check_nodes(nodes))?;
        Iterations::check_cells(self, problem)?;
        let criteria = self.criteria;
        let solutions = self.solutions(problem, contact)?;
        check_count(solutions.count(), contact.len())?;
        inside(|| {
            let (complement, proposal) =
                solutions.propose(criteria, problem, contact, nodes, beside)?;
            schur.clone_from(complement);
            Ok(proposal)
        })
    }

    fn answers(&self) -> Vec<(&[u32], &[f64])> {
        let solutions = self.solutions.as_ref();
        solutions.map_or_else(Vec::new, |solutions| solutions.answers().collect())
    }

    fn advance(
        &mut self,
        behind: &Behind<'_>,
        span: f64,
        solved: &mut Solved,
    ) -> Result<(), Error> {
        let criteria = self.criteria;
        let aim = if span < f64::INFINITY { Aim::Span(span) } else { Aim::Exact };
        let solutions = self.solutions(behind.problem, behind.contact)?;
        inside(|| solutions.advance(criteria, behind, aim, solved))
    }

    fn probe(&mut self, behind: &Behind<'_>, error: f64) -> Result<Solved, Error> {
        let criteria = self.criteria;
        let solutions = self.solutions(behind.problem, behind.contact)?;
        inside(|| solutions.probe(criteria, behind, error))
    }

    fn solve_apart(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        count: usize,
        approach: f64,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        check_prefix(contact, count)?;
        let criteria = self.criteria;
        let solutions = self.solutions(problem, contact)?;
        let mut solved = Solved::default();
        let at = (count, approach);
        inside(|| solutions.solve_apart(criteria, problem, contact, at, &mut solved))?;
        *solution = solved.solution;
        Ok(())
    }

    fn cut(&mut self, problem: &Problem, contact: &ContactSequence) -> Result<(), Error> {
        self.solutions(problem, contact)?.truncate(contact);
        Ok(())
    }

    fn convolutions(&self) -> usize {
        self.solutions.as_ref().map_or(0, Solutions::convolutions)
    }

    fn bytes(&self, nodes: usize, contact: usize) -> usize {
        Self::bytes_of(nodes, contact)
    }

    fn check_cells(&self, problem: &Problem) -> Result<(), Error> {
        let expected = "at most 10 without a factor; a path with one takes any";
        check_cells(&problem.grid(), problem.boundary(), (Self::MAX_ASPECT, expected))
    }
}

/// Exact to the tolerance, at the cost of a solution for each watched node.
impl LinearUpdater for ConjugateGradient {
    fn watch(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        problem.check_nodes(nodes)?;
        // Solutions begin with this one. Only here it moves, so that no answer depends on what was asked before.
        let here = Behind::on(problem, contact, 0.0);
        self.advance(&here, f64::INFINITY, &mut Solved::default())?;
        let criteria = self.criteria;
        let solutions = self.solutions(problem, contact)?;
        schur.resize(nodes.len())?;
        let (table, sums) = (problem.table(), problem.row_sums());
        for (j, &node) in nodes.iter().enumerate() {
            let place = table.place(node);
            let coupling = |other: usize| table.between(table.place(other), place);
            let answer = inside_of(solutions, criteria, (problem, contact), coupling)?;
            let mut matrix = schur.matrix_mut();
            for (i, &other) in nodes.iter().enumerate().skip(j) {
                matrix[(i, j)] = coupling(other) - answer.displacement[other];
            }
            let contact = contact.order().iter();
            let explained: f64 = contact.map(|&i| sums[i] * answer.pressure[i]).sum();
            schur.row_sums_mut()[j] = sums[node] - explained;
        }
        Ok(())
    }

    /// Nothing happens before the next solution, which finds the nodes in the contact.
    fn join(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        factor: &WindowFactor,
    ) -> Result<(), Error> {
        let count = self.solutions(problem, contact)?.count();
        let joined = contact.len().checked_sub(count);
        match joined {
            Some(joined) if joined >= factor.len() => Ok(()),
            _ => check_count(count + factor.len(), contact.len()),
        }
    }

    fn solve(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        count: usize,
        approach: f64,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        self.solve_apart(problem, contact, count, approach, solution)
    }

    fn truncate(&mut self, problem: &Problem, contact: &ContactSequence) -> Result<(), Error> {
        self.cut(problem, contact)
    }

    fn release(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        _left: &[Left],
    ) -> Result<(), Error> {
        self.solutions(problem, contact)?.keep(contact);
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
        problem.check_nodes(nodes)?;
        if let Some(&position) = positions.iter().find(|&&position| position >= contact.len()) {
            return check_count(contact.len(), position + 1);
        }
        let criteria = self.criteria;
        let solutions = self.solutions(problem, contact)?;
        schur.resize(nodes.len() + positions.len())?;
        let table = problem.table();
        let inside: Vec<usize> = positions.iter().map(|&q| contact.order()[q]).collect();
        for (j, &node) in nodes.iter().chain(&inside).enumerate() {
            let place = table.place(node);
            let coupling = |other: usize| table.between(table.place(other), place);
            let is_outside = j < nodes.len();
            let rhs = |other: usize| match is_outside {
                true => coupling(other),
                false => f64::from(u8::from(other == node)),
            };
            let answer = inside_of(solutions, criteria, (problem, contact), rhs)?;
            let mut matrix = schur.matrix_mut();
            for (i, &other) in nodes.iter().enumerate().skip(j) {
                matrix[(i, j)] = coupling(other) - answer.displacement[other];
            }
            for (i, &other) in (nodes.len()..).zip(&inside).filter(|(i, _)| *i >= j) {
                matrix[(i, j)] = -answer.pressure[other];
            }
        }
        Ok(())
    }

    fn solve_for(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        rhs: &mut [[f64; 2]],
    ) -> Result<(), Error> {
        check_count(contact.len(), rhs.len())?;
        let criteria = self.criteria;
        let solutions = self.solutions(problem, contact)?;
        let mut field = vec![0.0; problem.grid().nodes()];
        for k in 0..2 {
            for (&node, values) in contact.order().iter().zip(&*rhs) {
                field[node] = values[k];
            }
            let of = |node: usize| field[node];
            let answer = inside_of(solutions, criteria, (problem, contact), of)?;
            for (&node, values) in contact.order().iter().zip(&mut *rhs) {
                values[k] = answer.pressure[node];
            }
        }
        Ok(())
    }

    /// Of the contact alone before the first call, when the grid is not known.
    fn bytes(&self, contact: usize, _watched: usize) -> usize {
        let nodes = self.solutions.as_ref();
        Self::bytes_of(nodes.map_or(0, |known| known.grid().nodes()), contact)
    }
}

/// [`Solutions::respond`], with all threads.
fn inside_of(
    solutions: &mut Solutions,
    criteria: Criteria,
    (problem, contact): (&Problem, &ContactSequence),
    rhs: impl Fn(usize) -> f64 + Sync + Send,
) -> Result<Field, Error> {
    inside(|| solutions.respond(criteria, problem, contact, rhs))
}

/// `Ok` if a contact has at least `count` nodes.
fn check_prefix(contact: &ContactSequence, count: usize) -> Result<(), Error> {
    check_count(contact.len(), count.max(contact.len()))
}
