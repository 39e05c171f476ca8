//! The solution of the path, the one before it, and solutions apart from them.

mod kept;

use std::borrow::Cow;
use std::mem;
use std::sync::Arc;

use super::equilibrium::Equilibrium;
use super::instants::Instants;
use super::local::Neighbourhood;
use super::plastic_sums::PlasticSums;
use super::proposed::{Change, Proposed};
use super::row_sums::RowSums;
use super::solver::Solver;
use super::tolerances::{Aim, Criteria, Tolerances};
use super::tuning::OF_PRESSURE;
use crate::contact::ContactSequence;
use crate::kernel::KernelTable;
use crate::krylov::{Directions, Equation, Field, greatest};
use crate::updater::{Behind, Beside, Proposal, Schur, Solution, Solved};
use crate::{Boundary, Error, Grid, Problem};

/// The parts that depend on the problem and its contact, made at first use.
#[derive(Debug, Clone)]
pub(super) struct Solutions {
    table: Arc<KernelTable>,
    solver: Solver,
    neighbourhood: Neighbourhood,
    now: Equilibrium,
    /// Where the last window began: solutions inside it start from there.
    before: Option<Equilibrium>,
    /// The nodes in contact then.
    solved_before: Vec<usize>,
    instants: Instants,
    proposed: Proposed,
    /// What has happened since they were proposed.
    passage: Option<Passage>,
    /// Whether nodes may yield: then `plastic_sums` are followed, and otherwise `sums`.
    may_yield: bool,
    sums: RowSums,
    plastic_sums: PlasticSums,
    /// Search directions of the last solution on the whole contact.
    directions: Directions,
    /// The nodes of that contact.
    solved: Vec<usize>,
}

/// What has happened since a solution: nodes that joined, and nodes that yielded.
#[derive(Debug, Clone, Default)]
struct Passage {
    joined: Vec<usize>,
    fixed: Vec<(usize, f64)>,
}

impl Passage {
    /// What has happened since a contact of `count` nodes, in which some have been.
    fn of(behind: &Behind<'_>, count: usize, has_been: impl Fn(usize) -> bool) -> Self {
        let left = behind.yielded.iter().filter(|&&(node, _)| has_been(node)).count();
        let kept = count.saturating_sub(left);
        let joined = behind.contact.order().get(kept..).unwrap_or_default().to_vec();
        Self { joined, fixed: behind.yielded.to_vec() }
    }

    fn change(&self) -> Change<'_> {
        Change { joined: &self.joined, fixed: &self.fixed }
    }

    /// The same, behind what had happened before.
    fn behind(mut self, before: Option<Self>) -> Self {
        if let Some(mut before) = before {
            before.joined.retain(|node| !self.fixed.iter().any(|(other, _)| other == node));
            before.joined.append(&mut self.joined);
            before.fixed.append(&mut self.fixed);
            self = before;
        }
        self
    }
}

impl Solutions {
    pub(super) fn new(problem: &Problem) -> Self {
        let nodes = problem.grid().nodes();
        Self {
            table: problem.shared_table(),
            solver: Solver::new(problem),
            neighbourhood: Neighbourhood::new(problem),
            now: Equilibrium::zero(nodes),
            before: None,
            solved_before: Vec::new(),
            instants: Instants::default(),
            proposed: Proposed::default(),
            passage: None,
            may_yield: false,
            sums: RowSums::start(0, vec![0.0; nodes]),
            plastic_sums: PlasticSums::default(),
            directions: Directions::default(),
            solved: Vec::new(),
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
        (self.passage, self.may_yield) = (None, false);
        self.plastic_sums = PlasticSums::default();
    }

    /// The kernel that they are solutions on.
    pub(super) fn table(&self) -> &Arc<KernelTable> {
        &self.table
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

    /// Proposes nodes out of contact, and nodes in it, which may yield: returns their matrix M, and the displacements
    /// and pressures of the present solution and its rate, improved. With `beside` nodes may yield.
    pub(super) fn propose(
        &mut self,
        criteria: Criteria,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: [&[usize]; 2],
        beside: Option<&Beside<'_>>,
    ) -> Result<(&Schur, Proposal), Error> {
        self.solver.choose(contact, contact.len());
        self.solver.complete(&mut self.now.load)?;
        self.solver.complete(&mut self.now.rate)?;
        let mut directions = mem::take(&mut self.directions);
        let parts = (&mut self.solver, &mut directions);
        let (max_iterations, open) = (criteria.max_iterations, self.now.rate.open());
        let passage = self.passage.take();
        let periodic = problem.boundary() == Boundary::Periodic;
        if let Some(beside) = beside {
            let change = passage.as_ref().map(Passage::change);
            let since = (&self.proposed, change);
            self.plastic_sums.follow(parts, max_iterations, problem, since, beside, open)?;
            self.sums = RowSums::start(0, vec![0.0; problem.grid().nodes()]);
        } else if !periodic {
            self.sums.follow(parts, &self.proposed, max_iterations, problem, contact, open)?;
        }
        self.may_yield = beside.is_some();
        self.instants.clear();
        let near = (&self.neighbourhood, &self.solver);
        let mut proposed = Proposed::new(problem, near, nodes, contact.len())?;
        let lines = proposed.improved(problem, &self.now);
        let sums = if let Some(beside) = beside {
            let rates = lines.iter().zip(proposed.locals());
            let rates = rates
                .map(|(line, local)| if local.is_in_contact() { line[1] } else { 1.0 - line[1] });
            self.plastic_sums.of(problem, &proposed, beside, rates)
        } else {
            proposed.tell_row_sums(|local| {
                if periodic {
                    // All row sums are the same, so that y₂ explains them.
                    problem.row_sums()[local.node] * (1.0 - self.now.rate.displacement[local.node])
                } else {
                    self.sums.left_at(problem, local)
                }
            });
            proposed.complement().row_sums().iter().map(|&sum| [sum, 0.0, 0.0]).collect()
        };
        self.proposed = proposed;
        Ok((self.proposed.complement(), Proposal { lines, sums }))
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
        let is_behind = self.may_yield && (contact.len() != self.now.count || !yielded.is_empty());
        let has_left = || self.solved.iter().any(|&node| !contact.contains(node));
        if !is_behind && (!yielded.is_empty() || has_left()) {
            // Nodes have left since, or have come and left.
            self.keep(contact);
        }
        let now = &self.now;
        let is_here = !is_behind
            && now.count == contact.len()
            && now.load.is_known()
            && now.approach == approach;
        if !(is_here && aim.span() <= now.serves) {
            let now = mem::take(&mut self.now);
            let was_in = membership(self.grid(), &self.solved);
            let passage = Passage::of(behind, now.count, |node| was_in[node]);
            match self.solve_from(criteria, behind, aim, &now, &passage) {
                Ok((equilibrium, directions)) => {
                    let solved = mem::replace(&mut self.solved, contact.order().to_vec());
                    if is_behind || (now.count < contact.len() && now.load.is_known()) {
                        self.before = Some(now);
                        self.solved_before = solved;
                        if is_behind && self.passage.is_some() {
                            // Nothing was proposed in between.
                            self.plastic_sums.keep(contact);
                        }
                        self.passage = Some(passage.behind(self.passage.take()));
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
            let since = self.passage.as_ref().map(Passage::change);
            self.proposed.improve(
                problem,
                contact,
                &self.now,
                since.unwrap_or(Change { joined: &[], fixed: &[] }),
                solved,
            );
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
        let Behind { problem, contact, .. } = *behind;
        let mut solved = Solved::default();
        let within = |from: &Equilibrium| {
            self.may_yield || (from.count <= contact.len() && contact.len() <= self.now.count)
        };
        let Some(before) = self.before.take_if(|before| within(before)) else {
            Self::solve_from_nothing(criteria, behind)?.write(contact, &mut solved);
            return Ok(solved);
        };
        let was_in = membership(self.grid(), &self.solved_before);
        let passage = Passage::of(behind, before.count, |node| was_in[node]);
        let found = self.solve_from(criteria, behind, Aim::Gaps(error), &before, &passage);
        self.before = Some(before);
        let (equilibrium, _) = found?;
        equilibrium.write(contact, &mut solved);
        self.proposed.improve(problem, contact, &equilibrium, passage.change(), &mut solved);
        Ok(solved)
    }

    /// Solves exactly with the first `count` nodes in contact. The solution that the path goes on with is left as it
    /// is.
    pub(super) fn solve_apart(
        &mut self,
        criteria: Criteria,
        problem: &Problem,
        contact: &ContactSequence,
        (count, approach): (usize, f64),
        solved: &mut Solved,
    ) -> Result<(), Error> {
        let mut part = contact.clone();
        part.truncate(count);
        let behind = Behind::on(problem, &part, approach);
        // From no contact, the solver would tell in the last digits what it solved before.
        let begins = (1..=count).contains(&self.now.count)
            && self.now.load.is_known()
            && self.solved.iter().all(|&node| contact.contains(node));
        let equilibrium = if begins {
            let now = mem::take(&mut self.now);
            let passage = Passage::of(&behind, now.count, |_| false);
            let found = self.solve_from(criteria, &behind, Aim::Exact, &now, &passage);
            self.now = now;
            found?.0
        } else {
            Self::solve_from_nothing(criteria, &behind)?
        };
        equilibrium.write(&part, solved);
        Ok(())
    }

    /// Solves exactly with nothing that the path uses.
    fn solve_from_nothing(criteria: Criteria, behind: &Behind<'_>) -> Result<Equilibrium, Error> {
        let nothing = Equilibrium::zero(behind.problem.grid().nodes());
        let alone = Behind::on(behind.problem, behind.contact, behind.approach);
        let passage = Passage::of(&alone, 0, |_| false);
        let mut own = Self::new(behind.problem);
        Ok(own.solve_from(criteria, &alone, Aim::Exact, &nothing, &passage)?.0)
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

    /// Solves for rate and pressure at a state, in this order: the directions of the one serve the other, and are
    /// returned. The rate stays empty if gaps are the aim.
    ///
    /// Nodes that yield leave the contact and are a load from then on. Until all pressures are known they are counted
    /// among them: a field of the contact before, with what joined and what yielded, has displacements that are known
    /// but for the change; in the end those under the yielded nodes are taken off.
    fn solve_from(
        &mut self,
        criteria: Criteria,
        behind: &Behind<'_>,
        aim: Aim,
        from: &Equilibrium,
        passage: &Passage,
    ) -> Result<(Equilibrium, Directions), Error> {
        let Behind { problem, contact, approach, .. } = *behind;
        Error::require("approach", approach, approach.is_finite(), "finite")?;
        let count = contact.len();
        self.solver.choose(contact, count);
        let nodes = contact.order();
        let gap = problem.initial_gap();
        let overlap = |node: usize| approach - gap[node];
        let least = problem.least_length();
        let length = greatest(count, least, |k| overlap(nodes[k]).abs());
        let tolerances = Tolerances::of(criteria, aim, length, from.rate.open());
        let max_iterations = criteria.max_iterations;
        let wants_rate = !matches!(aim, Aim::Gaps(_));
        let yields = !passage.fixed.is_empty();
        let (mut directions, mut rate) = (Directions::default(), Field::default());
        if wants_rate {
            directions = Directions::keeping();
            let equation = Equation {
                rhs: |_| 1.0,
                tolerance: tolerances.rate,
                most_drift: tolerances.drift[1],
                max_iterations,
            };
            let at_rest: Vec<(usize, f64)> =
                passage.fixed.iter().map(|&(node, _)| (node, 0.0)).collect();
            let change = Change { joined: &passage.joined, fixed: &at_rest };
            let (start, _) = self.proposed.carried(problem, &from.rate, change, |_| 1.0);
            let base = match yields {
                true => Cow::Owned(self.solver.moved(&from.rate, start.clone())?),
                false => Cow::Borrowed(&from.rate),
            };
            rate = self.solver.solve(&equation, start, base, &mut directions)?;
        }
        let is_of_pressures =
            self.may_yield && wants_rate && (yields || !passage.joined.is_empty());
        let equation = Equation {
            rhs: overlap,
            tolerance: tolerances.load * if is_of_pressures { OF_PRESSURE } else { 1.0 },
            most_drift: tolerances.drift[0],
            max_iterations,
        };
        // Without any length, as at the first touch of a flat surface, nothing is pressed.
        let mut base = match length {
            0.0 => Field::zero(gap.len()),
            _ => from.load_at(approach),
        };
        // In the problem before, in which the nodes that yield were not a load yet.
        let overlap_before =
            |node: usize| overlap(node) + behind.load.get(node).copied().unwrap_or(0.0);
        let (mut start, way) =
            self.proposed.carried(problem, &base, passage.change(), overlap_before);
        let is_in_window = way != 0.0 && aim != Aim::Exact;
        let carried = is_in_window.then(|| {
            let mut carried = start.clone();
            passage.fixed.iter().for_each(|&(node, _)| carried[node] = 0.0);
            carried
        });
        if !wants_rate {
            self.instants.complete(way, &mut start);
        }
        if yields {
            // What was left out includes nodes that join later, which are not in contact yet.
            for (node, value) in start.iter_mut().enumerate() {
                if !contact.contains(node) {
                    *value = 0.0;
                }
            }
            passage.fixed.iter().for_each(|&(node, pressure)| start[node] = pressure);
            base = self.solver.moved(&base, start)?;
            for (u, load) in base.displacement.iter_mut().zip(behind.load) {
                *u -= load;
            }
            for &(node, _) in &passage.fixed {
                base.pressure[node] = 0.0;
            }
            start = base.pressure.clone();
        }
        let load = self.solver.solve(&equation, start, Cow::Owned(base), &mut directions)?;
        if let Some(carried) = carried {
            if wants_rate {
                self.instants.clear();
            }
            self.instants.add(way, &load.pressure, &carried);
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
        (self.passage, self.may_yield) = (None, false);
        self.plastic_sums.keep(left);
    }
}

/// Which nodes of a grid are among some.
fn membership(grid: Grid, some: &[usize]) -> Vec<bool> {
    let mut is_in = vec![false; grid.nodes()];
    some.iter().for_each(|&node| is_in[node] = true);
    is_in
}

#[cfg(test)]
mod tests;
