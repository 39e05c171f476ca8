//! Solutions when nodes have yielded since the last one.
//!
//! Nodes that yield leave the contact and are a load from then on. Until all pressures are known they are counted among
//! them: a field of the contact before, with what joined and what yielded, has displacements that are known but for the
//! change; in the end those under the yielded nodes are taken off.

use std::borrow::Cow;
use std::mem;

use super::{Passage, Solutions};
use crate::contact::ContactSequence;
use crate::krylov::{Directions, Equation, Field, greatest};
use crate::updater::conjugate_gradient::both::{Both, Change};
use crate::updater::conjugate_gradient::equilibrium::Equilibrium;
use crate::updater::conjugate_gradient::proposed::Proposed;
use crate::updater::conjugate_gradient::row_sums::RowSums;
use crate::updater::conjugate_gradient::tolerances::{Aim, Criteria, Tolerances};
use crate::updater::conjugate_gradient::tuning::OF_PRESSURE;
use crate::updater::{Behind, Beside, Proposal, Schur, Solved};
use crate::{Error, Problem};

impl Passage {
    /// What has happened since a contact of `count` nodes.
    fn of(behind: &Behind<'_>, before: &Equilibrium, has_been: impl Fn(usize) -> bool) -> Self {
        let left = behind.yielded.iter().filter(|&&(node, _)| has_been(node)).count();
        let kept = before.count.saturating_sub(left);
        let joined = behind.contact.order().get(kept..).unwrap_or_default().to_vec();
        Self { joined, fixed: behind.yielded.to_vec() }
    }

    fn change(&self) -> Change<'_> {
        Change { joined: &self.joined, fixed: &self.fixed }
    }
}

impl Solutions {
    /// Proposes nodes out of contact and nodes in it: returns their matrix M, and improved lines.
    pub(in super::super) fn propose_both(
        &mut self,
        criteria: Criteria,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: [&[usize]; 2],
        beside: &Beside<'_>,
    ) -> Result<(&Schur, Proposal), Error> {
        self.proposed = Proposed::default();
        self.sums = RowSums::start(0, vec![0.0; problem.grid().nodes()]);
        self.solver.choose(contact, contact.len());
        self.solver.complete(&mut self.now.load)?;
        self.solver.complete(&mut self.now.rate)?;
        let mut directions = mem::take(&mut self.directions);
        let before = self.both.take().unwrap_or_default();
        let passage = self.passage.take();
        self.plastic_sums.follow(
            (&mut self.solver, &mut directions),
            criteria.max_iterations,
            problem,
            (&before, passage.as_ref().map(Passage::change)),
            beside,
            self.now.rate.open(),
        )?;
        self.instants.clear();
        let both = Both::new(problem, (&self.neighbourhood, &self.solver), nodes)?;
        let lines = both.improved(problem, &self.now);
        let rates = lines.iter().zip(both.locals());
        let rates =
            rates.map(|(line, local)| if local.is_in_contact() { line[1] } else { 1.0 - line[1] });
        let sums = self.plastic_sums.of(problem, &both, beside, rates);
        let both = self.both.insert(both);
        Ok((both.complement(), Proposal { lines, sums }))
    }

    /// Moves the path's solution to a state behind it.
    pub(super) fn advance_behind(
        &mut self,
        criteria: Criteria,
        behind: &Behind<'_>,
        aim: Aim,
        solved: &mut Solved,
    ) -> Result<(), Error> {
        let now = mem::take(&mut self.now);
        let is_in = self.membership();
        let passage = Passage::of(behind, &now, |node| is_in[node]);
        match self.solve_behind(criteria, behind, aim, &now, &passage) {
            Ok((equilibrium, directions)) => {
                self.before = Some(now);
                self.solved_before =
                    mem::replace(&mut self.solved, behind.contact.order().to_vec());
                self.now = equilibrium;
                self.directions = directions;
            }
            Err(error) => {
                self.now = now;
                return Err(error);
            }
        }
        self.now.write(behind.contact, solved);
        if aim != Aim::Exact {
            self.improve_behind(behind, &self.now, &passage, solved);
            self.now.scale(behind.problem, behind.contact, &mut solved.solution);
        }
        if self.passage.replace(passage).is_some() {
            // Nothing was proposed in between.
            self.plastic_sums.keep(behind.contact);
        }
        Ok(())
    }

    /// Pressures and displacements at a state between the last two. What the path goes on with stays as it is.
    pub(super) fn probe_behind(
        &mut self,
        criteria: Criteria,
        behind: &Behind<'_>,
        error: f64,
    ) -> Result<Solved, Error> {
        let aim = Aim::Gaps(error);
        let mut solved = Solved::default();
        let Some(before) = self.before.take() else {
            let at = (behind.contact.len(), behind.approach);
            let (alone, _) =
                Self::solve_from_nothing(criteria, behind.problem, behind.contact, at, aim)?;
            alone.write(behind.contact, &mut solved);
            return Ok(solved);
        };
        let mut has_been = vec![false; behind.problem.grid().nodes()];
        self.solved_before.iter().for_each(|&node| has_been[node] = true);
        let passage = Passage::of(behind, &before, |node| has_been[node]);
        let found = self.solve_behind(criteria, behind, aim, &before, &passage);
        self.before = Some(before);
        let (equilibrium, _) = found?;
        equilibrium.write(behind.contact, &mut solved);
        self.improve_behind(behind, &equilibrium, &passage, &mut solved);
        Ok(solved)
    }

    /// Which nodes the present solution is on.
    fn membership(&self) -> Vec<bool> {
        let mut is_in = vec![false; self.grid().nodes()];
        self.solved.iter().for_each(|&node| is_in[node] = true);
        is_in
    }

    pub(super) fn improve_behind(
        &self,
        behind: &Behind<'_>,
        equilibrium: &Equilibrium,
        passage: &Passage,
        solved: &mut Solved,
    ) {
        let Some(both) = &self.both else {
            return;
        };
        let count = behind.contact.len() - passage.joined.len();
        let change = passage.change();
        both.improve(behind.problem, behind.contact, (equilibrium, count), change, solved);
    }

    /// Solves for rate and pressure at a state behind another one, as [`Self::solve_from`] does.
    fn solve_behind(
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
        let nothing = Both::default();
        let both = self.both.as_ref().unwrap_or(&nothing);
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
            let (start, _) = both.carried(problem, &from.rate, change, |_| 1.0);
            let base = self.solver.moved(&from.rate, start.clone())?;
            rate = self.solver.solve(&equation, start, Cow::Owned(base), &mut directions)?;
        }
        let equation = Equation {
            rhs: overlap,
            tolerance: if wants_rate { OF_PRESSURE * tolerances.load } else { tolerances.load },
            most_drift: tolerances.drift[0],
            max_iterations,
        };
        let before = from.load_at(approach);
        // In terms of the problem before, whose nodes were not a load yet.
        let overlap_before =
            |node: usize| overlap(node) + behind.load.get(node).copied().unwrap_or(0.0);
        let (mut start, way) = both.carried(problem, &before, passage.change(), overlap_before);
        let is_in_window = way != 0.0 && aim != Aim::Exact;
        let carried = is_in_window.then(|| {
            let mut carried = start.clone();
            passage.fixed.iter().for_each(|&(node, _)| carried[node] = 0.0);
            carried
        });
        if !wants_rate {
            self.instants.complete(way, &mut start);
            // What was left out of nodes that join later only is not in contact yet.
            for (node, value) in start.iter_mut().enumerate() {
                if !contact.contains(node) {
                    *value = 0.0;
                }
            }
            passage.fixed.iter().for_each(|&(node, pressure)| start[node] = pressure);
        }
        let mut base = self.solver.moved(&before, start)?;
        for (u, load) in base.displacement.iter_mut().zip(behind.load) {
            *u -= load;
        }
        for &(node, _) in &passage.fixed {
            base.pressure[node] = 0.0;
        }
        let start = base.pressure.clone();
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
}
