//! The proposed nodes, and by their matrix how they answer once some have joined or yielded.

use super::equilibrium::Equilibrium;
use super::galerkin;
use super::local::{Local, Neighbourhood};
use super::solver::Solver;
use super::tuning::PRODUCTS;
use crate::contact::ContactSequence;
use crate::krylov::Field;
use crate::updater::{Schur, Solved, WindowFactor};
use crate::{Error, Problem, parallel};

/// Nodes out of contact that may touch next, and then nodes in contact that may yield, with their local solutions.
#[derive(Debug, Clone, Default)]
pub(super) struct Proposed {
    locals: Vec<Local>,
    /// How many of them are out of contact.
    outside: usize,
    /// Nodes in contact when they were proposed.
    count: usize,
    /// Their matrix M: see [`LinearUpdater::watch_both`](crate::updater::LinearUpdater::watch_both). Of nodes out of
    /// contact it is the Schur complement.
    complement: Schur,
}

/// What has happened to a contact: nodes that joined, and nodes that yielded, which have left it or never were in it,
/// with a pressure that is given.
#[derive(Debug, Clone, Copy)]
pub(super) struct Change<'a> {
    pub(super) joined: &'a [usize],
    pub(super) fixed: &'a [(usize, f64)],
}

/// The same by places among the proposed nodes.
struct Places {
    /// Of nodes whose pressure, or overlap, is yet to be known: those that joined, and those that yielded.
    unknown: Vec<usize>,
    /// The factor of their part of the matrix.
    factor: WindowFactor,
    /// Of nodes that joined and yielded, and their pressure.
    pressed: Vec<(usize, f64)>,
}

impl Proposed {
    /// Proposes nodes beside the contact of `count` nodes that a solver has chosen. Their row sums are yet to be told.
    pub(super) fn new(
        problem: &Problem,
        (neighbourhood, solver): (&Neighbourhood, &Solver),
        [outside, inside]: [&[usize]; 2],
        count: usize,
    ) -> Result<Self, Error> {
        let of = |&node: &usize| Local { node, ..Local::default() };
        let mut locals: Vec<Local> = outside.iter().chain(inside).map(of).collect();
        let (table, set) = (problem.table(), solver.set());
        let products = locals.len() * PRODUCTS;
        parallel::for_each(products, &mut locals, |local| {
            let node = local.node;
            *local = if set.contains(node) {
                neighbourhood.solve_inside(table, set, node)
            } else {
                neighbourhood.solve(table, set, node)
            };
        });
        let mut complement = Schur::default();
        complement.resize(locals.len())?;
        galerkin::schur(problem, &locals, complement.as_mut_slice());
        complement.row_sums_mut().fill(0.0);
        Ok(Self { locals, outside: outside.len(), count, complement })
    }

    /// Tells what the contact leaves of the row sum of each.
    pub(super) fn tell_row_sums(&mut self, left: impl FnMut(&Local) -> f64) {
        let sums = self.locals.iter().map(left);
        self.complement.row_sums_mut().iter_mut().zip(sums).for_each(|(sum, left)| *sum = left);
    }

    /// The proposed nodes.
    pub(super) fn locals(&self) -> &[Local] {
        &self.locals
    }

    /// How many of them are out of contact.
    pub(super) fn outside(&self) -> usize {
        self.outside
    }

    /// Their matrix M.
    pub(super) fn complement(&self) -> &Schur {
        &self.complement
    }

    /// For each node the contact near it, and what a unit pressure takes off that.
    pub(super) fn answers(&self) -> impl Iterator<Item = (&[u32], &[f64])> {
        self.locals.iter().map(|local| (&local.contact[..], &local.weights[..]))
    }

    /// Whether a node at a place was out of contact.
    fn is_outside(&self, place: usize) -> bool {
        place < self.outside
    }

    /// Displacements of proposed nodes out of contact, and pressures of those in it, with what the residuals of the
    /// solution say of them: pressures that took a residual r out of the contact would change either by `xᵀ r`.
    pub(super) fn improved(&self, problem: &Problem, now: &Equilibrium) -> Vec<[f64; 2]> {
        let of = |(place, local): (usize, &Local)| {
            let left = now.left_near(problem, local, |_| true);
            let known = |field: &Field| {
                let values =
                    if self.is_outside(place) { &field.displacement } else { &field.pressure };
                values[local.node]
            };
            [known(&now.load) + left[0], known(&now.rate) + left[1]]
        };
        self.locals.iter().enumerate().map(of).collect()
    }

    /// The places of what has happened; `None` if a node was not proposed, or a pivot has the wrong sign.
    fn places(&self, change: Change<'_>) -> Option<Places> {
        let place = |node: usize| self.locals.iter().position(|local| local.node == node);
        let (mut unknown, mut pressed) = (Vec::new(), Vec::new());
        for &node in change.joined {
            unknown.push(place(node).filter(|&place| self.is_outside(place))?);
        }
        for &(node, pressure) in change.fixed {
            let place = place(node)?;
            if self.is_outside(place) {
                pressed.push((place, pressure));
            } else {
                unknown.push(place);
            }
        }
        let sign = |place: usize| if self.is_outside(place) { 1.0 } else { -1.0 };
        let factor = WindowFactor::with_signs(self.complement.clone(), &unknown, sign).ok()?;
        Some(Places { unknown, factor, pressed })
    }

    /// Adds the pressures that go with a pressure, or an overlap, of a proposed node.
    fn add(&self, place: usize, amount: f64, pressure: &mut [f64]) {
        let local = &self.locals[place];
        if self.is_outside(place) {
            pressure[local.node] += amount;
        }
        for (&node, x) in local.contact.iter().zip(&local.weights) {
            pressure[node as usize] -= amount * x;
        }
    }

    /// Adds to `C_II⁻¹ s_I` what nodes that joined since they were proposed add to it, and returns whether all nodes
    /// that joined were proposed.
    pub(super) fn carry_row_sums(&self, contact: &ContactSequence, pressure: &mut [f64]) -> bool {
        let joined = contact.order().get(self.count..).unwrap_or_default();
        let Some(places) = self.places(Change { joined, fixed: &[] }) else {
            return false;
        };
        let row_sums = self.complement.row_sums();
        let mut left: Vec<[f64; 1]> =
            places.unknown.iter().map(|&place| [row_sums[place]]).collect();
        places.factor.solve_both(&mut left);
        for (&place, [value]) in places.unknown.iter().zip(left) {
            self.add(place, value, pressure);
        }
        true
    }

    /// The pressures of a field after a change, with displacements in contact of `rhs`, as far as local solutions tell;
    /// and the sum of what nodes that joined bear and of what yielded ones give way, as a length, which grows from 0.
    pub(super) fn carried(
        &self,
        problem: &Problem,
        field: &Field,
        change: Change<'_>,
        rhs: impl Fn(usize) -> f64,
    ) -> (Vec<f64>, f64) {
        let mut pressure = field.pressure.clone();
        let mut way = 0.0;
        if field.is_known()
            && let Some(Places { unknown, factor, pressed }) = self.places(change)
        {
            let unit = problem.table().self_influence();
            let given = |place: usize| {
                let terms = pressed.iter();
                terms.map(|&(other, p)| self.complement.entry(place, other) * p).sum::<f64>()
            };
            let fixed = |node: usize| {
                let found = change.fixed.iter().find(|(other, _)| *other == node);
                found.map_or(0.0, |(_, pressure)| *pressure)
            };
            let left = unknown.iter().map(|&place| {
                let node = self.locals[place].node;
                let left = if self.is_outside(place) {
                    rhs(node) - field.displacement[node]
                } else {
                    fixed(node) - field.pressure[node]
                };
                [left - given(place)]
            });
            let mut found: Vec<[f64; 1]> = left.collect();
            factor.solve_both(&mut found);
            let found = unknown.iter().zip(&found).map(|(&place, &[amount])| (place, amount));
            for (place, amount) in found.chain(pressed.iter().copied()) {
                self.add(place, amount, &mut pressure);
                way += if self.is_outside(place) { unit * amount } else { amount };
            }
        }
        for &(node, value) in change.fixed {
            pressure[node] = value;
        }
        (pressure, way)
    }

    /// Improves what a solution says of the proposed nodes, after a change since: pressures of those that joined or
    /// have not yielded, and displacements of the others.
    pub(super) fn improve(
        &self,
        problem: &Problem,
        contact: &ContactSequence,
        equilibrium: &Equilibrium,
        change: Change<'_>,
        solved: &mut Solved,
    ) {
        let Some(Places { unknown, factor, .. }) = self.places(change) else {
            return;
        };
        let is_in = |node: usize| contact.contains(node);
        let near: Vec<[f64; 2]> =
            self.locals.iter().map(|local| equilibrium.left_near(problem, local, is_in)).collect();
        let left = |&place: &usize| {
            let own = if self.is_outside(place) {
                equilibrium.left(problem, self.locals[place].node)
            } else {
                [0.0; 2]
            };
            [0, 1].map(|k| own[k] - near[place][k])
        };
        let mut changes: Vec<[f64; 2]> = unknown.iter().map(left).collect();
        factor.solve_both(&mut changes);
        let count = contact.len() - change.joined.len();
        // The contact may have been put into another order since.
        let in_contact = contact.places();
        let position = |(place, local): (usize, &Local)| {
            let has_place = !self.is_outside(place) || change.joined.contains(&local.node);
            in_contact[local.node].filter(|_| has_place)
        };
        let positions: Vec<Option<usize>> = self.locals.iter().enumerate().map(position).collect();
        let Solved { solution, displacement } = solved;
        let fields = if equilibrium.rate.is_known() { 2 } else { 1 };
        let pressures = [&mut solution.pressure, &mut solution.rate];
        for (k, (pressures, displacement)) in
            pressures.into_iter().zip(displacement).take(fields).enumerate()
        {
            for (place, (local, near)) in self.locals.iter().zip(&near).enumerate() {
                let own = unknown.iter().position(|&other| other == place);
                let of_changes = || {
                    let terms = unknown.iter().zip(&changes);
                    terms.map(|(&other, c)| self.complement.entry(place, other) * c[k]).sum::<f64>()
                };
                match (positions[place], own) {
                    // It has joined.
                    (Some(position), Some(own)) if position >= count => {
                        pressures[position] += changes[own][k];
                    }
                    (Some(position), _) => pressures[position] += near[k] + of_changes(),
                    // It has yielded.
                    (None, Some(own)) => displacement[local.node] -= changes[own][k],
                    (None, None) => displacement[local.node] += near[k] + of_changes(),
                }
            }
        }
    }
}

#[cfg(test)]
mod dense_tests;
#[cfg(test)]
mod tests;
