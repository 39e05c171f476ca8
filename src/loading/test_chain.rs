//! Paths on nodes in a row, whose numbers can be worked out by hand: see [`test_chain`](crate::test_chain).

use std::sync::Arc;

use nalgebra::DMatrix;

use super::gap_field::GapLine;
use super::run::LoadingRun;
use super::solver::LoadingSolver;
use super::tolerances::WindowTolerances;
use super::window::{Course, Window, WindowEvent};
use crate::contact::ContactSequence;
use crate::updater::{
    Dense, Iterations, LinearUpdater, Method, Schur, Solution, Solved, WindowFactor,
};
use crate::{Error, Problem, test_chain};

/// A path that has not begun.
pub(super) fn run(gaps: &[f64]) -> Result<LoadingRun, Error> {
    let (surface, kernel) = (test_chain::surface(gaps)?, test_chain::kernel(gaps.len())?);
    let builder = LoadingSolver::builder(&surface, &kernel).updater(Dense);
    Ok(builder.build()?.run)
}

/// A path with nodes in contact, solved at an approach.
pub(super) fn solved(gaps: &[f64], contact: &[usize], approach: f64) -> Result<LoadingRun, Error> {
    let mut run = run(gaps)?;
    for &node in contact {
        run.contact.push(node)?;
    }
    run.scalars.place_at(approach);
    run.renew_field(&mut Dense, approach)?;
    Ok(run)
}

/// The same with all scalars known there.
pub(super) fn surveyed(
    gaps: &[f64],
    contact: &[usize],
    approach: f64,
) -> Result<LoadingRun, Error> {
    let mut run = solved(gaps, contact, approach)?;
    let LoadingRun {
        problem,
        contact,
        field,
        scalars,
        ..
    } = &mut run;
    scalars.renew_load(problem, contact, field);
    run.survey(false, |_, _| ())?;
    Ok(run)
}

/// A window from the approach 1 on: nodes, `[gap, closing]` of each, their Schur complement, and their row sums.
pub(super) fn window(
    lines: &[(usize, [f64; 2])],
    matrix: &DMatrix<f64>,
    row_sums: &[f64],
    horizon: f64,
) -> Window {
    let mut window = Window::default();
    let lines = lines.iter().map(|&(node, line)| (node, gap_line(line)));
    let (nodes, schur) = window.open((1.0, horizon), lines);
    assert!(schur.resize(nodes.len()).is_ok());
    schur.matrix_mut().copy_from(matrix);
    schur.row_sums_mut().copy_from_slice(row_sums);
    window.begin();
    window
}

/// A window of nodes that do not act on each other, each with its gap; all close at the rate 1.
pub(super) fn apart(gaps: &[(usize, f64)], horizon: f64) -> Window {
    let size = gaps.len();
    let lines: Vec<_> = gaps.iter().map(|&(node, gap)| (node, [gap, 1.0])).collect();
    // Each acts on itself and two neighbours.
    let (matrix, row_sums) = (
        DMatrix::from_diagonal_element(size, size, 4.0),
        vec![6.0; size],
    );
    window(&lines, &matrix, &row_sums, horizon)
}

/// The Schur complement of a window.
pub(super) fn matrix(window: &Window) -> DMatrix<f64> {
    let (schur, size) = (window.schur(), window.nodes().len());
    DMatrix::from_fn(size, size, |i, j| schur.entry(i, j))
}

pub(super) fn gap_line([gap, closing]: [f64; 2]) -> GapLine {
    GapLine { gap, closing }
}

/// `c₀ − c₁ t + c₂ t² + c₃ t³`.
pub(super) fn course([c0, c1, c2, c3]: [f64; 4]) -> Course {
    Course {
        line: gap_line([c0, c1]),
        curve: [c2, c3],
    }
}

/// Events from (position, time).
pub(super) fn events(pairs: &[(usize, f64)]) -> Vec<WindowEvent> {
    let event = |&(position, time): &(usize, f64)| WindowEvent { position, time };
    pairs.iter().map(event).collect()
}

/// (position, time) of events.
pub(super) fn pairs(events: &[WindowEvent]) -> Vec<(usize, f64)> {
    let pair = |event: &WindowEvent| (event.position, event.time);
    events.iter().map(pair).collect()
}

pub(super) fn tolerances(length: f64, tolerance: f64, tie: f64) -> WindowTolerances {
    WindowTolerances {
        length,
        tolerance,
        tie,
    }
}

/// What is done to an answer on its way.
type Alteration<T> = Arc<dyn Fn(&mut T) + Send + Sync>;
/// A Schur complement, and the displacements of its nodes.
pub(super) type Proposal = (Schur, Vec<[f64; 2]>);

/// Dense solutions and Schur complements, as an updater and as iterations, whose answers are changed on their way.
#[derive(Clone)]
pub(super) struct Altered {
    proposal: Alteration<Proposal>,
    solution: Alteration<Solution>,
    tolerance: f64,
    /// Whether a path takes it for iterations.
    iterates: bool,
    /// Displacements of all nodes under the last solution, and under its rate.
    displacement: [Vec<f64>; 2],
}

impl Altered {
    /// Iterations that leave `tolerance`; nothing is changed.
    pub(super) fn inexact(tolerance: f64) -> Self {
        Self {
            proposal: Arc::new(|_| {}),
            solution: Arc::new(|_| {}),
            tolerance,
            iterates: true,
            displacement: [Vec::new(), Vec::new()],
        }
    }

    /// Iterations with one answer to all questions.
    pub(super) fn given(pressure: Vec<f64>, rate: Vec<f64>) -> Self {
        Self {
            solution: Arc::new(move |solution| {
                solution.pressure.clone_from(&pressure);
                solution.rate.clone_from(&rate);
            }),
            ..Self::inexact(1e-12)
        }
    }

    /// Iterations with other proposals.
    pub(super) fn estimates(
        tolerance: f64,
        proposal: impl Fn(&mut Proposal) + Send + Sync + 'static,
    ) -> Self {
        Self {
            proposal: Arc::new(proposal),
            ..Self::inexact(tolerance)
        }
    }

    /// An updater with other solutions.
    pub(super) fn solutions(solution: impl Fn(&mut Solution) + Send + Sync + 'static) -> Self {
        Self {
            solution: Arc::new(solution),
            iterates: false,
            ..Self::inexact(0.0)
        }
    }

    /// An updater with other Schur complements.
    pub(super) fn complements(proposal: impl Fn(&mut Proposal) + Send + Sync + 'static) -> Self {
        Self {
            iterates: false,
            ..Self::estimates(0.0, proposal)
        }
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

    fn propose(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<Vec<[f64; 2]>, Error> {
        let mut complement = Schur::default();
        Dense.watch(problem, contact, nodes, &mut complement)?;
        let [u, rate] = &self.displacement;
        let known = nodes.iter().map(|&node| [u[node], rate[node]]).collect();
        let mut proposal = (complement, known);
        (self.proposal)(&mut proposal);
        *schur = proposal.0;
        Ok(proposal.1)
    }

    fn advance(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        approach: f64,
        _: f64,
        solved: &mut Solved,
    ) -> Result<(), Error> {
        let count = contact.len();
        self.solve_apart(problem, contact, count, approach, &mut solved.solution)?;
        let Solution { pressure, rate } = &solved.solution;
        self.displacement = [pressure, rate].map(|values| Self::displace(problem, contact, values));
        solved.displacement.clone_from(&self.displacement);
        Ok(())
    }

    fn probe(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        count: usize,
        approach: f64,
        _: f64,
    ) -> Result<Vec<f64>, Error> {
        let mut solution = Solution::default();
        self.solve_apart(problem, contact, count, approach, &mut solution)?;
        Ok(Self::displace(problem, contact, &solution.pressure))
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

    fn leave(&mut self, _: &Problem, _: &ContactSequence) -> Result<(), Error> {
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

    fn method(&self) -> Method {
        if self.iterates {
            Method::Iterations(Box::new(self.clone()))
        } else {
            Method::Factor
        }
    }
}
