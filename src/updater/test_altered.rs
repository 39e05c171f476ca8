//! Dense solutions and Schur complements for tests, whose answers are changed on their way.

use std::sync::Arc;

use super::{
    Behind, Beside, Dense, Iterations, LinearUpdater, Proposal as BothProposal, Schur, Solution,
    Solved, WindowFactor,
};
use crate::contact::ContactSequence;
use crate::{Error, Problem};

/// What is done to an answer on its way.
type Alteration<T> = Arc<dyn Fn(&mut T) + Send + Sync>;
/// A Schur complement, and the displacements of its nodes.
pub(crate) type Proposal = (Schur, Vec<[f64; 2]>);

/// Dense solutions and Schur complements, as an updater and as iterations, whose answers are changed on their way.
#[derive(Clone)]
pub(crate) struct Altered {
    proposal: Alteration<Proposal>,
    solution: Alteration<Solution>,
    tolerance: f64,
    /// Bytes that it asks for before the first node is in contact.
    room: usize,
    /// Displacements of all nodes under the last solution, and under its rate.
    displacement: [Vec<f64>; 2],
    /// That solution.
    solution_now: Solution,
}

impl Altered {
    /// Iterations that leave `tolerance`; nothing is changed.
    pub(crate) fn inexact(tolerance: f64) -> Self {
        Self {
            proposal: Arc::new(|_| {}),
            solution: Arc::new(|_| {}),
            tolerance,
            room: 0,
            displacement: [Vec::new(), Vec::new()],
            solution_now: Solution::default(),
        }
    }

    /// Iterations with one answer to all questions.
    pub(crate) fn given(pressure: Vec<f64>, rate: Vec<f64>) -> Self {
        Self {
            solution: Arc::new(move |solution| {
                solution.pressure.clone_from(&pressure);
                solution.rate.clone_from(&rate);
            }),
            ..Self::inexact(1e-12)
        }
    }

    /// Iterations with other proposals.
    pub(crate) fn estimates(
        tolerance: f64,
        proposal: impl Fn(&mut Proposal) + Send + Sync + 'static,
    ) -> Self {
        Self { proposal: Arc::new(proposal), ..Self::inexact(tolerance) }
    }

    /// An updater with other solutions.
    pub(crate) fn solutions(solution: impl Fn(&mut Solution) + Send + Sync + 'static) -> Self {
        Self { solution: Arc::new(solution), ..Self::inexact(0.0) }
    }

    /// An updater with other Schur complements.
    pub(crate) fn complements(proposal: impl Fn(&mut Proposal) + Send + Sync + 'static) -> Self {
        Self::estimates(0.0, proposal)
    }

    /// An updater that asks for room.
    pub(crate) fn needing(room: usize) -> Self {
        Self { room, ..Self::complements(|_| {}) }
    }

    /// The displacements of all nodes under pressures on the first nodes of a contact.
    fn displace(problem: &Problem, contact: &ContactSequence, pressure: &[f64]) -> Vec<f64> {
        let at = |node: usize| {
            let carrying = contact.order().iter().zip(pressure);
            let terms = carrying
                .map(|(&other, p)| problem.coefficient(node, other).unwrap_or(f64::NAN) * p);
            terms.sum()
        };
        (0..problem.grid().nodes()).map(at).collect()
    }
}

impl std::fmt::Debug for Altered {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Altered").finish_non_exhaustive()
    }
}

impl Iterations for Altered {
    fn tolerance(&self) -> f64 {
        self.tolerance
    }

    fn take_over(
        &mut self,
        _: &Problem,
        _: &ContactSequence,
        _: f64,
        _: &Solution,
    ) -> Result<(), Error> {
        Ok(())
    }

    fn advance(&mut self, behind: &Behind<'_>, _: f64, solved: &mut Solved) -> Result<(), Error> {
        let Behind { problem, contact, approach, .. } = *behind;
        self.solve_apart(problem, contact, contact.len(), approach, &mut solved.solution)?;
        let Solution { pressure, rate } = &solved.solution;
        self.displacement = [pressure, rate].map(|values| Self::displace(problem, contact, values));
        solved.displacement.clone_from(&self.displacement);
        self.solution_now = solved.solution.clone();
        Ok(())
    }

    fn propose(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        [outside, inside]: [&[usize]; 2],
        beside: Option<&Beside<'_>>,
        schur: &mut Schur,
    ) -> Result<BothProposal, Error> {
        let Some(beside) = beside else {
            let mut complement = Schur::default();
            Dense.watch(problem, contact, outside, &mut complement)?;
            let [u, rate] = &self.displacement;
            let known = outside.iter().map(|&node| [u[node], rate[node]]).collect();
            let mut proposal = (complement, known);
            (self.proposal)(&mut proposal);
            let (complement, lines) = proposal;
            *schur = complement;
            let sums = schur.row_sums().iter().map(|&sum| [sum, 0.0, 0.0]).collect();
            return Ok(BothProposal { lines, sums });
        };
        let place = |node: &usize| contact.order().iter().position(|other| other == node);
        let places: Vec<usize> = inside.iter().filter_map(place).collect();
        // Positions ascend.
        let mut positions = places.clone();
        positions.sort_unstable();
        let mut complement = Schur::default();
        Dense.watch_both(problem, contact, outside, &positions, &mut complement)?;
        let size = outside.len() + inside.len();
        let of = |k: usize| match k.checked_sub(outside.len()) {
            Some(q) => outside.len() + positions.partition_point(|&other| other < places[q]),
            None => k,
        };
        let mut ordered = Schur::default();
        ordered.resize(size)?;
        for j in 0..size {
            for i in j..size {
                ordered.matrix_mut()[(i, j)] = complement.entry(of(i), of(j));
            }
        }
        ordered.row_sums_mut().fill(0.0);
        let Solution { pressure, rate } = &self.solution_now;
        let [u, u_rate] = &self.displacement;
        let known = outside.iter().map(|&node| [u[node], u_rate[node]]);
        let lines = known.chain(places.iter().map(|&place| [pressure[place], rate[place]]));
        let mut proposal = (ordered, lines.collect());
        (self.proposal)(&mut proposal);
        *schur = proposal.0;

        let rhs = |node: usize| [problem.row_sums()[node], -beside.unit[node], -beside.load[node]];
        let mut sums: Vec<[f64; 3]> = outside.iter().map(|&node| rhs(node)).collect();
        sums.extend(vec![[0.0; 3]; inside.len()]);
        for k in 0..3 {
            let mut solved: Vec<[f64; 2]> =
                contact.order().iter().map(|&node| [rhs(node)[k], 0.0]).collect();
            Dense.solve_for(problem, contact, &mut solved)?;
            let values: Vec<f64> = solved.iter().map(|value| value[0]).collect();
            let displaced = Self::displace(problem, contact, &values);
            for (sum, &node) in sums.iter_mut().zip(outside) {
                sum[k] -= displaced[node];
            }
            for (sum, &place) in sums[outside.len()..].iter_mut().zip(&places) {
                sum[k] = values[place];
            }
        }
        Ok(BothProposal { lines: proposal.1, sums })
    }

    fn probe(&mut self, behind: &Behind<'_>, _: f64) -> Result<Solved, Error> {
        let Behind { problem, contact, approach, .. } = *behind;
        let mut solved = Solved::default();
        self.solve_apart(problem, contact, contact.len(), approach, &mut solved.solution)?;
        let values = &solved.solution.pressure;
        solved.displacement[0] = Self::displace(problem, contact, values);
        Ok(solved)
    }

    fn solve_apart(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        count: usize,
        approach: f64,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        Dense.solve(problem, contact, count, approach, solution)?;
        (self.solution)(solution);
        Ok(())
    }

    fn cut(&mut self, _: &Problem, _: &ContactSequence) -> Result<(), Error> {
        Ok(())
    }

    fn bytes(&self, _: usize, _: usize) -> usize {
        0
    }

    fn check_cells(&self, _: &Problem) -> Result<(), Error> {
        Ok(())
    }
}

impl LinearUpdater for Altered {
    fn watch(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        let mut proposal = (Schur::default(), Vec::new());
        Dense.watch(problem, contact, nodes, &mut proposal.0)?;
        (self.proposal)(&mut proposal);
        *schur = proposal.0;
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
        self.solve_apart(problem, contact, count, approach, solution)
    }

    fn truncate(&mut self, _: &Problem, _: &ContactSequence) -> Result<(), Error> {
        Ok(())
    }

    fn make_room(&mut self, _: &Problem, budget: usize) -> Result<(), Error> {
        let needed = self.room;
        if needed <= budget {
            return Ok(());
        }
        Err(Error::MemoryBudget { needed, budget, nodes_that_fit: 0 })
    }
}
