//! The solutions on the contact, and the watched nodes.

use std::mem;

use super::equilibrium::{Equilibrium, Field};
use super::instants::Instants;
use super::local::Neighbourhood;
use super::row_sums::RowSums;
use super::solver::{Equation, Solver};
use super::tolerances::{Criteria, Tolerances};
use super::watched::Watched;
use crate::contact::ContactSequence;
use crate::krylov::{Directions, greatest};
use crate::updater::{Schur, Solution, SolveRequest};
use crate::{Boundary, Error, Grid, Problem};

/// What depends on the problem and its contact, made at first use.
#[derive(Debug, Clone)]
pub(super) struct State {
    solver: Solver,
    neighbourhood: Neighbourhood,
    now: Equilibrium,
    /// Where the last window began: its prefixes start from there.
    before: Option<Equilibrium>,
    instants: Instants,
    sums: RowSums,
    watched: Watched,
    /// Search directions of the last solution on the whole contact.
    directions: Directions,
}

impl State {
    pub(super) fn new(problem: &Problem) -> Self {
        let nodes = problem.grid().nodes();
        Self {
            solver: Solver::new(problem),
            neighbourhood: Neighbourhood::new(problem),
            now: Equilibrium::zero(nodes),
            before: None,
            instants: Instants::default(),
            sums: RowSums::start(0, vec![0.0; nodes]),
            watched: Watched::default(),
            directions: Directions::default(),
        }
    }

    /// Begins with a contact and a solution on it, as a start.
    pub(super) fn take_over(
        &mut self,
        contact: &ContactSequence,
        approach: f64,
        solution: &Solution,
    ) {
        let [load, rate] = [&solution.pressure, &solution.rate].map(|values| {
            let mut pressure = vec![0.0; self.now.load.pressure.len()];
            for (&node, value) in contact.order().iter().zip(values) {
                pressure[node] = *value;
            }
            Field::of(pressure)
        });
        self.now = Equilibrium {
            count: contact.len(),
            approach,
            span: 0.0,
            load,
            rate,
        };
        self.sums = RowSums::start(contact.len(), vec![0.0; self.now.rate.pressure.len()]);
    }

    /// The grid of the problem.
    pub(super) fn grid(&self) -> Grid {
        self.neighbourhood.grid()
    }

    /// Number of nodes in contact that there is a solution or a start for.
    pub(super) fn count(&self) -> usize {
        self.now.count
    }

    pub(super) fn watch(
        &mut self,
        criteria: Criteria,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        self.solver.choose(contact, contact.len());
        self.solver.complete(&mut self.now.load)?;
        self.solver.complete(&mut self.now.rate)?;
        let periodic = problem.boundary() == Boundary::Periodic;
        if !periodic {
            let mut directions = mem::take(&mut self.directions);
            self.sums.follow(
                (&mut self.solver, &mut directions),
                &self.watched,
                criteria.max_iterations,
                problem,
                contact,
                self.now.rate.open(),
            )?;
        }
        schur.resize(nodes.len())?;
        self.instants.clear();
        let beside = (&self.neighbourhood, self.solver.set());
        self.watched = Watched::new(problem, beside, nodes, contact.len(), schur);
        self.watched.find_row_sums(|local| {
            if periodic {
                // All row sums are the same, so that y₂ explains them.
                problem.row_sums()[local.node] * (1.0 - self.now.rate.displacement[local.node])
            } else {
                self.sums.left_at(problem, local)
            }
        });
        schur
            .row_sums_mut()
            .copy_from_slice(self.watched.row_sums());
        schur.set_displacements(self.watched.improved(problem, &self.now));
        Ok(())
    }

    pub(super) fn solve(
        &mut self,
        criteria: Criteria,
        problem: &Problem,
        contact: &ContactSequence,
        request: SolveRequest,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        let count = request.count;
        let is_solved = self.now.count == count && self.now.load.is_known();
        let is_here = self.now.approach == request.approach;
        // The path must not notice questions, which are all that may be asked of a contact that is solved, at
        // another approach or more exactly than the path needs.
        let is_question = is_solved && (!is_here || request.span == f64::INFINITY);
        let asked = if is_solved && is_here && request.span <= self.now.span {
            None
        } else if is_question {
            let now = mem::take(&mut self.now);
            let solved = self.solve_from(criteria, problem, contact, request, &now);
            self.now = now;
            Some(solved?.0)
        } else if count == contact.len() && self.now.count <= count && request.span > 0.0 {
            let now = mem::take(&mut self.now);
            match self.solve_from(criteria, problem, contact, request, &now) {
                Ok((solved, directions)) => {
                    if now.count < count && now.load.is_known() {
                        self.before = Some(now);
                    }
                    self.now = solved;
                    self.directions = directions;
                }
                Err(error) => {
                    self.now = now;
                    return Err(error);
                }
            }
            None
        } else {
            Some(self.solve_prefix(criteria, problem, contact, request)?)
        };
        let solved = asked.as_ref().unwrap_or(&self.now);
        let values = |field: &Field| {
            let nodes = contact.order()[..count].iter();
            nodes
                .map(|&node| field.pressure.get(node).copied().unwrap_or(0.0))
                .collect()
        };
        solution.pressure = values(&solved.load);
        solution.rate = values(&solved.rate);
        solution.displacement[0].clone_from(&solved.load.displacement);
        solution.displacement[1].clone_from(&solved.rate.displacement);
        if request.span < f64::INFINITY {
            self.watched.improve(problem, contact, solved, solution);
            solved.scale(problem, contact, solution);
        }
        Ok(())
    }

    /// Solves on a part of the contact: inside the last window from its beginning, and otherwise from nothing
    /// and with nothing that the path uses.
    fn solve_prefix(
        &mut self,
        criteria: Criteria,
        problem: &Problem,
        contact: &ContactSequence,
        request: SolveRequest,
    ) -> Result<Equilibrium, Error> {
        let count = request.count;
        let before = self.before.take();
        let within = |from: &&Equilibrium| {
            request.span == 0.0 && from.count <= count && count <= self.now.count
        };
        let solved = match before.as_ref().filter(within) {
            Some(from) => {
                let solved = self.solve_from(criteria, problem, contact, request, from);
                solved.map(|(solved, _)| solved)
            }
            None => {
                let solved = Self::new(problem).solve_from(
                    criteria,
                    problem,
                    contact,
                    request,
                    &Equilibrium::zero(problem.grid().nodes()),
                );
                solved.map(|(solved, _)| solved)
            }
        };
        self.before = before;
        solved
    }

    /// Solves for rate and pressure, in this order: the directions of the one serve the other, and are
    /// returned. The rate stays empty if it is not asked for.
    fn solve_from(
        &mut self,
        criteria: Criteria,
        problem: &Problem,
        contact: &ContactSequence,
        request: SolveRequest,
        from: &Equilibrium,
    ) -> Result<(Equilibrium, Directions), Error> {
        let SolveRequest {
            count,
            approach,
            span,
            ..
        } = request;
        self.solver.choose(contact, count);
        let nodes = &contact.order()[..count];
        let joined = nodes.get(from.count..).unwrap_or_default();
        let gap = problem.initial_gap();
        let overlap = |node: usize| approach - gap[node];
        let least = problem.least_length();
        let length = greatest(count, least, |k| overlap(nodes[k]).abs());
        let tolerances = Tolerances::of(criteria, request, length, from.rate.open());
        let max_iterations = criteria.max_iterations;
        let mut directions = if span > 0.0 {
            Directions::keeping()
        } else {
            Directions::default()
        };
        let mut rate = Field::default();
        if span > 0.0 {
            let equation = Equation {
                rhs: |_| 1.0,
                tolerance: tolerances.rate,
                most_drift: tolerances.drift[1],
                max_iterations,
            };
            let (start, _) = self.watched.carried(&from.rate, joined, equation.rhs);
            rate = self
                .solver
                .solve(&equation, start, &from.rate, &mut directions)?;
        }
        let equation = Equation {
            rhs: overlap,
            tolerance: tolerances.load,
            most_drift: tolerances.drift[0],
            max_iterations,
        };
        let base = from.load_at(approach);
        let (mut start, sum) = self.watched.carried(&base, joined, overlap);
        let is_in_window = !joined.is_empty() && span < f64::INFINITY;
        let carried = is_in_window.then(|| start.clone());
        if span == 0.0 {
            self.instants.complete(sum, &mut start);
        }
        let load = self
            .solver
            .solve(&equation, start, &base, &mut directions)?;
        if let Some(carried) = carried {
            if span > 0.0 {
                self.instants.clear();
            }
            self.instants.add(sum, &load.pressure, &carried);
        }
        let solved = Equilibrium {
            count,
            approach,
            span,
            load,
            rate,
        };
        Ok((solved, directions))
    }

    /// Goes back to the first nodes of the contact.
    pub(super) fn truncate(&mut self, left: &ContactSequence) {
        match self.before.take() {
            Some(before) if before.count == left.len() => {
                self.now = before;
                self.instants.clear();
                self.directions = Directions::default();
                if self.sums.count() > left.len() {
                    self.sums.keep(left);
                }
            }
            _ => self.keep(left),
        }
    }

    /// Keeps of all solutions, as starts, what belongs to nodes that are left in contact.
    pub(super) fn keep(&mut self, left: &ContactSequence) {
        self.before = None;
        self.instants.clear();
        self.directions = Directions::default();
        self.watched = Watched::default();
        self.now.load.keep(left);
        self.now.rate.keep(left);
        self.now.count = left.len();
        self.sums.keep(left);
    }
}

#[cfg(test)]
mod tests;
