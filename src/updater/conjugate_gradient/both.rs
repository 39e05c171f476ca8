//! Proposed nodes of both kinds: out of contact, and in it, which may yield.

use nalgebra::DMatrix;

use super::equilibrium::Equilibrium;
use super::galerkin;
use super::local::{Local, Neighbourhood};
use super::solver::Solver;
use super::tuning::PRODUCTS;
use crate::contact::ContactSequence;
use crate::krylov::Field;
use crate::updater::{Schur, Solved};
use crate::{Error, Problem, parallel};

/// Nodes out of contact that may touch next, and then nodes in contact that may yield, with their local solutions.
#[derive(Debug, Clone, Default)]
pub(super) struct Both {
    locals: Vec<Local>,
    /// How many of them are out of contact.
    outside: usize,
    /// Their matrix M: see [`LinearUpdater::watch_both`](crate::updater::LinearUpdater::watch_both).
    complement: Schur,
}

/// What has happened to proposed nodes: nodes that joined, and others with a pressure that is given.
#[derive(Debug, Clone, Copy)]
pub(super) struct Change<'a> {
    pub(super) joined: &'a [usize],
    pub(super) fixed: &'a [(usize, f64)],
}

/// The same by places among the proposed nodes.
struct Places {
    /// Of nodes whose pressure, or overlap, is yet to be known: those that joined, and those that yielded.
    unknown: Vec<usize>,
    /// Of nodes that joined and yielded, and their pressure.
    pressed: Vec<(usize, f64)>,
}

impl Both {
    /// Proposes nodes beside the contact that a solver has chosen.
    pub(super) fn new(
        problem: &Problem,
        (neighbourhood, solver): (&Neighbourhood, &Solver),
        [outside, inside]: [&[usize]; 2],
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
        Ok(Self { locals, outside: outside.len(), complement })
    }

    /// Their matrix M.
    pub(super) fn complement(&self) -> &Schur {
        &self.complement
    }

    /// How many of the proposed nodes are out of contact.
    pub(super) fn outside(&self) -> usize {
        self.outside
    }

    /// The proposed nodes.
    pub(super) fn locals(&self) -> &[Local] {
        &self.locals
    }

    /// Whether a node at a place was out of contact.
    fn is_outside(&self, place: usize) -> bool {
        place < self.outside
    }

    /// Displacements of proposed nodes out of contact, and pressures of those in it, with what the residuals of the
    /// solution say of them: pressures that took a residual r out of the contact would change either by `xᵀ r`.
    pub(super) fn improved(&self, problem: &Problem, now: &Equilibrium) -> Vec<[f64; 2]> {
        let of = |(place, local): (usize, &Local)| {
            let left = now.left_near(problem, local);
            let known = |field: &Field| {
                let values =
                    if self.is_outside(place) { &field.displacement } else { &field.pressure };
                values[local.node]
            };
            [known(&now.load) + left[0], known(&now.rate) + left[1]]
        };
        self.locals.iter().enumerate().map(of).collect()
    }

    /// The places of what has happened; `None` if a node was not proposed.
    fn places(&self, change: Change<'_>) -> Option<Places> {
        let place = |node: usize| self.locals.iter().position(|local| local.node == node);
        let mut places = Places { unknown: Vec::new(), pressed: Vec::new() };
        for &node in change.joined {
            places.unknown.push(place(node).filter(|&place| self.is_outside(place))?);
        }
        for &(node, pressure) in change.fixed {
            let place = place(node)?;
            if self.is_outside(place) {
                places.pressed.push((place, pressure));
            } else {
                places.unknown.push(place);
            }
        }
        Some(places)
    }

    /// Pressures and overlaps of the unknown nodes that change their displacements, or pressures, by `rhs`; `None` if
    /// no numbers do.
    fn answer<const N: usize>(&self, unknown: &[usize], rhs: &[[f64; N]]) -> Option<Vec<[f64; N]>> {
        let size = unknown.len();
        if size == 0 {
            return Some(Vec::new());
        }
        // Pressures and lengths have units of their own.
        let unit: Vec<f64> = unknown
            .iter()
            .map(|&place| self.complement.entry(place, place).abs().sqrt().recip())
            .collect();
        // In terms of gaps it is positive definite, and in terms of overlaps symmetric.
        let sign = |k: usize| if self.is_outside(unknown[k]) { 1.0 } else { -1.0 };
        let matrix = DMatrix::from_fn(size, size, |i, j| {
            sign(j) * unit[i] * unit[j] * self.complement.entry(unknown[i], unknown[j])
        });
        let columns = DMatrix::from_fn(size, N, |i, k| unit[i] * rhs[i][k]);
        let solved = matrix.lu().solve(&columns)?;
        let value = |i: usize, k: usize| sign(i) * unit[i] * solved[(i, k)];
        let found: Vec<[f64; N]> =
            (0..size).map(|i| std::array::from_fn(|k| value(i, k))).collect();
        found.as_flattened().iter().all(|value| value.is_finite()).then_some(found)
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

    /// The pressures of a field, after a change that makes displacements in contact `rhs`, as far as local solutions
    /// tell; and how far nodes have given way, in units of a length, which grows from nothing.
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
            && let Some(Places { unknown, pressed }) = self.places(change)
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
            let left: Vec<[f64; 1]> = left.collect();
            if let Some(found) = self.answer(&unknown, &left) {
                let found = unknown.iter().zip(&found).map(|(&place, &[amount])| (place, amount));
                for (place, amount) in found.chain(pressed.iter().copied()) {
                    self.add(place, amount, &mut pressure);
                    way += if self.is_outside(place) { unit * amount } else { amount };
                }
            }
        }
        for &(node, value) in change.fixed {
            pressure[node] = value;
        }
        (pressure, way)
    }

    /// Improves what a solution says of the proposed nodes, after a change: pressures of those that joined or have not
    /// yielded, and displacements of the others. `count` nodes of the contact were there before.
    pub(super) fn improve(
        &self,
        problem: &Problem,
        contact: &ContactSequence,
        (equilibrium, count): (&Equilibrium, usize),
        change: Change<'_>,
        solved: &mut Solved,
    ) {
        let Some(Places { unknown, .. }) = self.places(change) else {
            return;
        };
        let near =
            |local: &Local| equilibrium.left_near_in(problem, local, |node| contact.contains(node));
        let near: Vec<[f64; 2]> = self.locals.iter().map(near).collect();
        let left = |&place: &usize| {
            let own = if self.is_outside(place) {
                equilibrium.left(problem, self.locals[place].node)
            } else {
                [0.0; 2]
            };
            [0, 1].map(|k| own[k] - near[place][k])
        };
        let left: Vec<[f64; 2]> = unknown.iter().map(left).collect();
        let Some(change) = self.answer(&unknown, &left) else {
            return;
        };
        let mut places = vec![None; self.locals.len()];
        for (position, node) in contact.order().iter().enumerate() {
            if let Some(place) = self.locals.iter().position(|local| local.node == *node) {
                places[place] = Some(position);
            }
        }
        let Solved { solution, displacement } = solved;
        let fields = if equilibrium.rate.is_known() { 2 } else { 1 };
        let pressures = [&mut solution.pressure, &mut solution.rate];
        for (k, (pressures, displacement)) in
            pressures.into_iter().zip(displacement).take(fields).enumerate()
        {
            for (place, (local, near)) in self.locals.iter().zip(&near).enumerate() {
                let own = unknown.iter().position(|&other| other == place);
                let of_change = || {
                    let terms = unknown.iter().zip(&change);
                    terms.map(|(&other, c)| self.complement.entry(place, other) * c[k]).sum::<f64>()
                };
                match (places[place], own) {
                    // It has joined.
                    (Some(position), Some(own)) if position >= count => {
                        pressures[position] += change[own][k];
                    }
                    (Some(position), _) => pressures[position] += near[k] + of_change(),
                    // It has yielded.
                    (None, Some(own)) => displacement[local.node] -= change[own][k],
                    (None, None) => displacement[local.node] += near[k] + of_change(),
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
