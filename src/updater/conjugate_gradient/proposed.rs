//! The proposed nodes, and what their Schur complement says of them once some have joined.

use super::equilibrium::Equilibrium;
use super::galerkin;
use super::local::{Local, Neighbourhood};
use super::solver::Solver;
use super::tuning::PRODUCTS;
use crate::contact::ContactSequence;
use crate::krylov::Field;
use crate::updater::{Schur, Solved, WindowFactor};
use crate::{Error, Problem, parallel};

/// Nodes that may touch next, with their local solutions.
#[derive(Debug, Clone, Default)]
pub(super) struct Proposed {
    locals: Vec<Local>,
    /// Nodes in contact when they were proposed.
    count: usize,
    /// Their Schur complement.
    complement: Schur,
}

/// What residuals of a solution add to it, for pressure and rate.
#[derive(Debug, Clone, Default)]
pub(super) struct Improvement {
    /// To the pressures of proposed nodes that have joined, in their order.
    pressures: Vec<[f64; 2]>,
    /// To the displacements of the others.
    pub(super) displacements: Vec<(usize, [f64; 2])>,
}

impl Proposed {
    /// Proposes nodes beside the contact of `count` nodes that a solver has chosen. What the contact leaves of their
    /// row sums is `left`.
    pub(super) fn new(
        problem: &Problem,
        (neighbourhood, solver): (&Neighbourhood, &Solver),
        (nodes, count): (&[usize], usize),
        mut left: impl FnMut(&Local) -> f64,
    ) -> Result<Self, Error> {
        let of = |&node: &usize| Local { node, ..Local::default() };
        let mut locals: Vec<Local> = nodes.iter().map(of).collect();
        let products = locals.len() * PRODUCTS;
        parallel::for_each(products, &mut locals, |local| {
            *local = neighbourhood.solve(problem.table(), solver.set(), local.node);
        });
        let mut complement = Schur::default();
        complement.resize(nodes.len())?;
        galerkin::schur(problem, &locals, complement.as_mut_slice());
        for (sum, local) in complement.row_sums_mut().iter_mut().zip(&locals) {
            *sum = left(local);
        }
        Ok(Self { locals, count, complement })
    }

    /// The nodes.
    pub(super) fn nodes(&self) -> impl ExactSizeIterator<Item = usize> {
        self.locals.iter().map(|local| local.node)
    }

    /// Nodes in contact when they were proposed.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Their Schur complement.
    pub(super) fn complement(&self) -> &Schur {
        &self.complement
    }

    /// For each node the contact near it, and what a unit pressure takes off that.
    pub(super) fn answers(&self) -> impl Iterator<Item = (&[u32], &[f64])> {
        self.locals.iter().map(|local| (&local.contact[..], &local.weights[..]))
    }

    /// Adds to `C_II⁻¹ s_I` what nodes that joined since they were watched add to it, and returns whether all nodes
    /// that joined were watched.
    pub(super) fn carry_row_sums(&self, contact: &ContactSequence, pressure: &mut [f64]) -> bool {
        let joined = contact.order().get(self.count..).unwrap_or_default();
        if joined.is_empty() {
            return true;
        }
        let Some(factor) = self.factor_of(joined) else {
            return false;
        };
        let row_sums = self.complement.row_sums();
        let left = factor.positions().iter().map(|&place| [row_sums[place]]);
        self.spread(&factor, left.collect(), pressure);
        true
    }

    /// Adds pressures on nodes that joined which have displacements `left` yet to be caused, and the answer of the
    /// contact near them. Returns the sum of the pressures on the nodes that joined.
    fn spread(&self, factor: &WindowFactor, mut left: Vec<[f64; 1]>, pressure: &mut [f64]) -> f64 {
        factor.solve_both(&mut left);
        let mut sum = 0.0;
        for (&place, [value]) in factor.positions().iter().zip(&left) {
            let local = &self.locals[place];
            pressure[local.node] += value;
            for (&node, x) in local.contact.iter().zip(&local.weights) {
                pressure[node as usize] -= value * x;
            }
            sum += value;
        }
        sum
    }

    /// Displacements of the proposed nodes with what the residuals of the solution say of them: pressures that
    /// took a residual r out of the contact would change that of node j by `x_jᵀ r`.
    pub(super) fn improved(&self, problem: &Problem, now: &Equilibrium) -> Vec<[f64; 2]> {
        let of = |local: &Local| {
            let left = now.left_near(problem, local);
            let node = local.node;
            [now.load.displacement[node] + left[0], now.rate.displacement[node] + left[1]]
        };
        self.locals.iter().map(of).collect()
    }

    /// Improves what a solution says of the proposed nodes, of which some have joined since.
    pub(super) fn improve(
        &self,
        problem: &Problem,
        contact: &ContactSequence,
        equilibrium: &Equilibrium,
        solved: &mut Solved,
    ) {
        let Some(improvement) = self.improvement(problem, contact, equilibrium) else {
            return;
        };
        let Solved { solution, displacement } = solved;
        let pressures = [&mut solution.pressure, &mut solution.rate];
        let fields = if equilibrium.rate.is_known() { 2 } else { 1 };
        let fields = pressures.into_iter().zip(displacement).take(fields);
        for (k, (pressures, displacement)) in fields.enumerate() {
            for (pressure, change) in pressures[self.count..].iter_mut().zip(&improvement.pressures)
            {
                *pressure += change[k];
            }
            for (node, change) in &improvement.displacements {
                displacement[*node] += change[k];
            }
        }
    }

    /// What residuals of a solution say of the proposed nodes; `None` if one has joined that was not proposed.
    pub(super) fn improvement(
        &self,
        problem: &Problem,
        contact: &ContactSequence,
        equilibrium: &Equilibrium,
    ) -> Option<Improvement> {
        let joined = contact.order()[..equilibrium.count].get(self.count..)?;
        let factor = self.factor_of(joined)?;
        let near: Vec<[f64; 2]> =
            self.locals.iter().map(|local| equilibrium.left_near(problem, local)).collect();
        let places = factor.positions();
        let left = places.iter().zip(joined).map(|(&place, &node)| {
            let left = equilibrium.left(problem, node);
            [0, 1].map(|k| left[k] - near[place][k])
        });
        let mut pressures: Vec<[f64; 2]> = left.collect();
        factor.solve_both(&mut pressures);
        let change = |i: usize, k: usize| {
            let of_joined = places.iter().zip(&pressures);
            let of_joined =
                of_joined.map(|(&place, change)| self.complement.entry(i, place) * change[k]);
            near[i][k] + of_joined.sum::<f64>()
        };
        let others = self.locals.iter().enumerate().filter(|(i, _)| !factor.has_touched(*i));
        let displacements =
            others.map(|(i, local)| (local.node, [0, 1].map(|k| change(i, k)))).collect();
        Some(Improvement { pressures, displacements })
    }

    /// The factor of the Schur complement of some proposed nodes; `None` if one was not proposed.
    fn factor_of(&self, joined: &[usize]) -> Option<WindowFactor> {
        let place = |node: &usize| self.locals.iter().position(|local| local.node == *node);
        let places: Vec<usize> = joined.iter().map(place).collect::<Option<_>>()?;
        WindowFactor::of(self.complement.clone(), &places).ok()
    }

    /// The pressures of a field and what nodes that joined, with the right-hand sides `rhs`, add to them; and the sum
    /// of the pressures on these nodes.
    pub(super) fn carried(
        &self,
        field: &Field,
        joined: &[usize],
        rhs: impl Fn(usize) -> f64,
    ) -> (Vec<f64>, f64) {
        let mut pressure = field.pressure.clone();
        if joined.is_empty() || !field.is_known() {
            return (pressure, 0.0);
        }
        let Some(factor) = self.factor_of(joined) else {
            return (pressure, 0.0);
        };
        let left = joined.iter().map(|&node| [rhs(node) - field.displacement[node]]);
        let sum = self.spread(&factor, left.collect(), &mut pressure);
        (pressure, sum)
    }
}

#[cfg(test)]
mod tests;
