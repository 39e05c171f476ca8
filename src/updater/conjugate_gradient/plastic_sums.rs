//! What sums over all nodes answer to a pressure on a node or to an overlap of one, beside nodes that have yielded.

use std::borrow::Cow;
use std::mem;

use super::local::Local;
use super::proposed::{Change, Proposed};
use super::solver::Solver;
use super::tuning::SUMS_TOLERANCE;
use crate::contact::ContactSequence;
use crate::krylov::{Directions, Equation, Field, greatest};
use crate::updater::iterations::{Beside, SUMS};
use crate::{Error, Problem};

/// `C_II⁻¹ b` on the contact I for each right-hand side b: the row sums of the nodes that have not yielded, the
/// displacement under a pressure of 1 on those that have, and the one under their hardness. C is symmetric, so that bᵀp
/// = (C_II⁻¹ b)ᵀ C_II p: the sums follow from the displacements on the contact.
#[derive(Debug, Clone, Default)]
pub(super) struct PlasticSums {
    fields: [Field; SUMS],
    /// The last two right-hand sides that they belong to.
    under: [Vec<f64>; 2],
}

/// A right-hand side at a node.
fn rhs(problem: &Problem, beside: &Beside<'_>, which: usize, node: usize) -> f64 {
    match which {
        0 => problem.row_sums()[node],
        1 => beside.unit[node],
        _ => beside.load[node],
    }
}

/// Which fields have to be solved for: the others follow from one of these.
fn needed(beside: &Beside<'_>) -> [bool; SUMS] {
    [beside.row_sum.is_none(), true, beside.hardness.is_none()]
}

impl PlasticSums {
    /// Fields, and the right-hand sides that they belong to.
    pub(super) fn of_parts(fields: [Field; SUMS], under: [Vec<f64>; 2]) -> Self {
        Self { fields, under }
    }

    /// The arguments of [`Self::of_parts`] that restore it; `None` where it is only a start.
    pub(super) fn parts(&self) -> Option<(&[Field; SUMS], &[Vec<f64>; 2])> {
        let are_known = self.under.iter().all(|under| !under.is_empty());
        are_known.then_some((&self.fields, &self.under))
    }

    /// Solves for the fields, after a change since the last time; `open` says what part of the grid still closes.
    pub(super) fn follow(
        &mut self,
        (solver, directions): (&mut Solver, &mut Directions),
        max_iterations: usize,
        problem: &Problem,
        (proposed, change): (&Proposed, Option<Change<'_>>),
        beside: &Beside<'_>,
        open: f64,
    ) -> Result<(), Error> {
        let nodes = problem.grid().nodes();
        let needed = needed(beside);
        let are_known = self.under.iter().all(|under| under.len() == nodes);
        for which in (0..SUMS).filter(|&which| needed[which]) {
            let rhs = |node: usize| rhs(problem, beside, which, node);
            let most = greatest(nodes, 0.0, |node| rhs(node).abs());
            if most == 0.0 {
                self.fields[which] = Field::zero(nodes);
                continue;
            }
            let before = mem::take(&mut self.fields[which]);
            let base = match change {
                Some(change) if are_known && before.is_known() => {
                    let more = |k: usize, node: usize| {
                        [beside.unit, beside.load][k][node] - self.under[k][node]
                    };
                    // Nodes that have yielded since are a load on the others: row sums fall by what a pressure of 1 on
                    // them displaces, and displacements under 1 or under their hardness grow.
                    let sign = if which == 0 { 1.0 } else { -1.0 };
                    let given = |pressure: f64| if which == 2 { -pressure } else { sign };
                    let fixed: Vec<(usize, f64)> =
                        change.fixed.iter().map(|&(node, p)| (node, given(p))).collect();
                    let k = usize::from(which == 2);
                    let old = |node: usize| rhs(node) + sign * more(k, node);
                    let change = Change { fixed: &fixed, ..change };
                    let (pressure, _) = proposed.carried(problem, &before, change, old);
                    let mut moved = solver.moved(&before, pressure)?;
                    for (node, u) in moved.displacement.iter_mut().enumerate() {
                        *u -= sign * more(k, node);
                    }
                    for &(node, _) in &fixed {
                        moved.pressure[node] = 0.0;
                    }
                    moved
                }
                None if before.is_known() => before,
                _ => Field::zero(nodes),
            };
            let equation = Equation {
                rhs,
                tolerance: SUMS_TOLERANCE * most * open.clamp(1e-6, 1.0),
                most_drift: f64::INFINITY,
                max_iterations,
            };
            let start = base.pressure.clone();
            self.fields[which] = solver.solve(&equation, start, Cow::Owned(base), directions)?;
        }
        self.under = [beside.unit.to_vec(), beside.load.to_vec()];
        Ok(())
    }

    /// What a pressure on each proposed node out of contact, or a gap of one in it, adds to the sums. `rates` are those
    /// at which gaps close and pressures grow: where all row sums are the same they explain these.
    pub(super) fn of(
        &self,
        problem: &Problem,
        proposed: &Proposed,
        beside: &Beside<'_>,
        rates: impl Iterator<Item = f64>,
    ) -> Vec<[f64; SUMS]> {
        let needed = needed(beside);
        let of = |(local, rate): (&Local, f64)| {
            let mut sums = [0.0; SUMS];
            for which in (0..SUMS).filter(|&which| needed[which]) {
                let field = &self.fields[which];
                let left =
                    |node: usize| rhs(problem, beside, which, node) - field.displacement[node];
                let near = local.contact.iter().zip(&local.weights);
                let near: f64 = near.map(|(&node, x)| x * left(node as usize)).sum();
                let sum = if local.is_in_contact() {
                    field.pressure[local.node] + near
                } else {
                    left(local.node) - near
                };
                sums[which] = if which == 0 { sum } else { -sum };
            }
            if let Some(row_sum) = beside.row_sum {
                sums[0] = row_sum * rate + sums[1];
            }
            if let Some(hardness) = beside.hardness {
                sums[2] = hardness * sums[1];
            }
            sums
        };
        proposed.locals().iter().zip(rates).map(of).collect()
    }

    /// Keeps, as starts, what belongs to nodes that are left in contact.
    pub(super) fn keep(&mut self, left: &ContactSequence) {
        for field in &mut self.fields {
            field.keep(left);
        }
        self.under = [Vec::new(), Vec::new()];
    }
}
