//! The solution of the path, the one before it, and solutions apart from them.

mod behind;
mod kept;

use std::borrow::Cow;
use std::mem;

use super::both::Both;
use super::equilibrium::Equilibrium;
use super::instants::Instants;
use super::local::Neighbourhood;
use super::plastic_sums::PlasticSums;
use super::proposed::Proposed;
use super::row_sums::RowSums;
use super::solver::Solver;
use super::tolerances::{Aim, Criteria, Tolerances};
use crate::contact::ContactSequence;
use crate::krylov::{Directions, Equation, Field, greatest};
use crate::updater::{Behind, Proposal, Schur, Solution, Solved};
use crate::{Boundary, Error, Grid, Problem};

/// The parts that depend on the problem and its contact, made at first use.
#[derive(Debug, Clone)]
pub(super) struct Solutions {
    solver: Solver,
    neighbourhood: Neighbourhood,
    now: Equilibrium,
    /// Where the last window began: its prefixes start from there. On these nodes.
    before: Option<Equilibrium>,
    solved_before: Vec<usize>,
    instants: Instants,
    sums: RowSums,
    proposed: Proposed,
    /// Search directions of the last solution on the whole contact.
    directions: Directions,
    /// The nodes of that contact.
    solved: Vec<usize>,
    /// The proposed nodes on a path on which nodes yield, what has happened to them since, and what sums answer to
    /// them.
    both: Option<Both>,
    passage: Option<Passage>,
    plastic_sums: PlasticSums,
}

/// What has happened to proposed nodes of both kinds.
#[derive(Debug, Clone, Default)]
struct Passage {
    joined: Vec<usize>,
    fixed: Vec<(usize, f64)>,
}

impl Solutions {
    pub(super) fn new(problem: &Problem) -> Self {
        let nodes = problem.grid().nodes();
        Self {
            solver: Solver::new(problem),
            neighbourhood: Neighbourhood::new(problem),
            now: Equilibrium::zero(nodes),
            before: None,
            solved_before: Vec::new(),
            instants: Instants::default(),
            sums: RowSums::start(0, vec![0.0; nodes]),
            proposed: Proposed::default(),
            directions: Directions::default(),
            solved: Vec::new(),
            both: None,
            passage: None,
            plastic_sums: PlasticSums::default(),
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
        self.now = Equilibrium { count: contact.len(), approach, serves: 0.0, load, rate };
        self.sums = RowSums::start(contact.len(), vec![0.0; self.now.rate.pressure.len()]);
        self.solved = contact.order().to_vec();
        (self.both, self.passage) = (None, None);
        self.plastic_sums = PlasticSums::default();
    }

    /// The grid of the problem.
    pub(super) fn grid(&self) -> Grid {
        self.neighbourhood.grid()
    }

    /// Number of convolutions so far.
    pub(super) fn convolutions(&self) -> usize {
        self.solver.convolutions()
    }

    /// Number of nodes in contact that there is a solution or a start for.
    pub(super) fn count(&self) -> usize {
        self.now.count
    }

    /// Proposes nodes out of contact: returns their Schur complement, and improves the displacements that the present
    /// solution and its rate cause there.
    pub(super) fn propose(
        &mut self,
        criteria: Criteria,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
    ) -> Result<(&Schur, Proposal), Error> {
        (self.both, self.passage) = (None, None);
        self.solver.choose(contact, contact.len());
        self.solver.complete(&mut self.now.load)?;
        self.solver.complete(&mut self.now.rate)?;
        let periodic = problem.boundary() == Boundary::Periodic;
        if !periodic {
            let mut directions = mem::take(&mut self.directions);
            self.sums.follow(
                (&mut self.solver, &mut directions),
                &self.proposed,
                criteria.max_iterations,
                problem,
                contact,
                self.now.rate.open(),
            )?;
        }
        self.instants.clear();
        let beside = (&self.neighbourhood, &self.solver);
        self.proposed = Proposed::new(problem, beside, (nodes, contact.len()), |local| {
            if periodic {
                // All row sums are the same, so that y₂ explains them.
                problem.row_sums()[local.node] * (1.0 - self.now.rate.displacement[local.node])
            } else {
                self.sums.left_at(problem, local)
            }
        })?;
        let lines = self.proposed.improved(problem, &self.now);
        let complement = self.proposed.complement();
        let sums = complement.row_sums().iter().map(|&sum| [sum, 0.0, 0.0]).collect();
        Ok((complement, Proposal { lines, sums }))
    }

    /// How the contact answers the proposed nodes.
    pub(super) fn answers(&self) -> impl Iterator<Item = (&[u32], &[f64])> {
        self.proposed.answers()
    }

    /// Moves the path's solution to a state, unless it is there and serves the aim.
    pub(super) fn advance(
        &mut self,
        criteria: Criteria,
        behind: &Behind<'_>,
        aim: Aim,
        solved: &mut Solved,
    ) -> Result<(), Error> {
        let Behind { problem, contact, approach, yielded, .. } = *behind;
        if self.both.is_some() && (contact.len() != self.now.count || !yielded.is_empty()) {
            return self.advance_behind(criteria, behind, aim, solved);
        }
        if !yielded.is_empty() || self.solved.iter().any(|&node| !contact.contains(node)) {
            // Nodes have left since, or have come and left.
            self.keep(contact);
        }
        let now = &self.now;
        let is_here = now.count == contact.len() && now.load.is_known() && now.approach == approach;
        if !(is_here && aim.span() <= now.serves) {
            let now = mem::take(&mut self.now);
            match self.solve_from(criteria, problem, contact, (contact.len(), approach), aim, &now)
            {
                Ok((equilibrium, directions)) => {
                    let solved = mem::replace(&mut self.solved, contact.order().to_vec());
                    if now.count < contact.len() && now.load.is_known() {
                        self.before = Some(now);
                        self.solved_before = solved;
                    }
                    self.now = equilibrium;
                    self.directions = directions;
                }
                Err(error) => {
                    self.now = now;
                    return Err(error);
                }
            }
        }
        self.now.write(contact, solved);
        if aim != Aim::Exact {
            match &self.passage {
                Some(passage) => self.improve_behind(behind, &self.now, passage, solved),
                None => self.proposed.improve(problem, contact, &self.now, solved),
            }
            self.now.scale(problem, contact, &mut solved.solution);
        }
        Ok(())
    }

    /// Pressures and displacements at a state between the last two. What the path goes on with stays as it is.
    pub(super) fn probe(
        &mut self,
        criteria: Criteria,
        behind: &Behind<'_>,
        error: f64,
    ) -> Result<Solved, Error> {
        if self.both.is_some() {
            return self.probe_behind(criteria, behind, error);
        }
        let Behind { problem, contact, approach, .. } = *behind;
        let (before, at) = (self.before.take(), (contact.len(), approach));
        let aim = Aim::Gaps(error);
        let within = |from: &&Equilibrium| from.count <= at.0 && at.0 <= self.now.count;
        let found = match before.as_ref().filter(within) {
            Some(from) => self.solve_from(criteria, problem, contact, at, aim, from),
            None => Self::solve_from_nothing(criteria, problem, contact, at, aim),
        };
        self.before = before;
        let (equilibrium, _) = found?;
        let mut solved = Solved::default();
        equilibrium.write(contact, &mut solved);
        let improvement = self.proposed.improvement(problem, contact, &equilibrium);
        for (node, [change, _]) in improvement.unwrap_or_default().displacements {
            solved.displacement[0][node] += change;
        }
        Ok(solved)
    }

    /// Solves exactly with the first `count` nodes in contact. The solution that the path goes on with is left as it
    /// is.
    pub(super) fn solve_apart(
        &mut self,
        criteria: Criteria,
        problem: &Problem,
        contact: &ContactSequence,
        at: (usize, f64),
        solved: &mut Solved,
    ) -> Result<(), Error> {
        let belongs = || self.solved.iter().all(|&node| contact.contains(node));
        let equilibrium = if self.now.count <= at.0 && self.now.load.is_known() && belongs() {
            let now = mem::take(&mut self.now);
            let found = self.solve_from(criteria, problem, contact, at, Aim::Exact, &now);
            self.now = now;
            found?.0
        } else {
            Self::solve_from_nothing(criteria, problem, contact, at, Aim::Exact)?.0
        };
        equilibrium.write(contact, solved);
        Ok(())
    }

    /// Solves with nothing that the path uses.
    fn solve_from_nothing(
        criteria: Criteria,
        problem: &Problem,
        contact: &ContactSequence,
        at: (usize, f64),
        aim: Aim,
    ) -> Result<(Equilibrium, Directions), Error> {
        let nothing = Equilibrium::zero(problem.grid().nodes());
        Self::new(problem).solve_from(criteria, problem, contact, at, aim, &nothing)
    }

    /// The displacements of all nodes under the pressures on the whole contact that displace it as `rhs` says.
    pub(super) fn respond(
        &mut self,
        criteria: Criteria,
        problem: &Problem,
        contact: &ContactSequence,
        rhs: impl Fn(usize) -> f64 + Sync + Send,
    ) -> Result<Field, Error> {
        self.solver.choose(contact, contact.len());
        let nodes = contact.order();
        let most = greatest(nodes.len(), 0.0, |k| rhs(nodes[k]).abs());
        let equation = Equation {
            rhs,
            tolerance: criteria.tolerance * most.max(f64::MIN_POSITIVE),
            most_drift: f64::INFINITY,
            max_iterations: criteria.max_iterations,
        };
        let nothing = Field::zero(problem.grid().nodes());
        let start = nothing.pressure.clone();
        self.solver.solve(&equation, start, Cow::Owned(nothing), &mut Directions::default())
    }

    /// Solves with the first `count` nodes in contact for rate and pressure, in this order: the directions of the one
    /// serve the other, and are returned. The rate stays empty if gaps are the aim.
    fn solve_from(
        &mut self,
        criteria: Criteria,
        problem: &Problem,
        contact: &ContactSequence,
        (count, approach): (usize, f64),
        aim: Aim,
        from: &Equilibrium,
    ) -> Result<(Equilibrium, Directions), Error> {
        Error::require("approach", approach, approach.is_finite(), "finite")?;
        self.solver.choose(contact, count);
        let nodes = &contact.order()[..count];
        let joined = nodes.get(from.count..).unwrap_or_default();
        let gap = problem.initial_gap();
        let overlap = |node: usize| approach - gap[node];
        let least = problem.least_length();
        let length = greatest(count, least, |k| overlap(nodes[k]).abs());
        let tolerances = Tolerances::of(criteria, aim, length, from.rate.open());
        let max_iterations = criteria.max_iterations;
        let wants_rate = !matches!(aim, Aim::Gaps(_));
        let (mut directions, mut rate) = (Directions::default(), Field::default());
        if wants_rate {
            directions = Directions::keeping();
            let equation = Equation {
                rhs: |_| 1.0,
                tolerance: tolerances.rate,
                most_drift: tolerances.drift[1],
                max_iterations,
            };
            let (start, _) = self.proposed.carried(&from.rate, joined, equation.rhs);
            let base = Cow::Borrowed(&from.rate);
            rate = self.solver.solve(&equation, start, base, &mut directions)?;
        }
        let equation = Equation {
            rhs: overlap,
            tolerance: tolerances.load,
            most_drift: tolerances.drift[0],
            max_iterations,
        };
        let base = from.load_at(approach);
        let (mut start, sum) = self.proposed.carried(&base, joined, overlap);
        let is_in_window = !joined.is_empty() && aim != Aim::Exact;
        let carried = is_in_window.then(|| start.clone());
        if !wants_rate {
            self.instants.complete(sum, &mut start);
        }
        let load = self.solver.solve(&equation, start, Cow::Owned(base), &mut directions)?;
        if let Some(carried) = carried {
            if wants_rate {
                self.instants.clear();
            }
            self.instants.add(sum, &load.pressure, &carried);
        }
        let solved = Equilibrium { count, approach, serves: aim.span(), load, rate };
        Ok((solved, directions))
    }

    /// Goes back to the first nodes of the contact.
    pub(super) fn truncate(&mut self, left: &ContactSequence) {
        match self.before.take() {
            Some(before) if self.was_on(&before, left) => {
                self.now = before;
                self.passage = None;
                self.instants.clear();
                self.directions = Directions::default();
                if self.sums.count() > left.len() {
                    self.sums.keep(left);
                }
                self.solved = left.order().to_vec();
            }
            _ => self.keep(left),
        }
    }

    /// Whether the solution before is one on a contact.
    fn was_on(&self, before: &Equilibrium, left: &ContactSequence) -> bool {
        let is_in = |&node: &usize| left.contains(node);
        before.count == left.len() && self.solved_before.iter().all(is_in)
    }

    /// Keeps of all solutions, as starts, what belongs to nodes that are left in contact.
    pub(super) fn keep(&mut self, left: &ContactSequence) {
        self.before = None;
        self.instants.clear();
        self.directions = Directions::default();
        self.proposed = Proposed::default();
        self.now.load.keep(left);
        self.now.rate.keep(left);
        self.now.count = left.len();
        self.sums.keep(left);
        self.solved = left.order().to_vec();
        (self.both, self.passage) = (None, None);
        self.plastic_sums.keep(left);
    }
}

#[cfg(test)]
mod tests;
