//! The watched nodes, and what their Schur complement says of them once some have joined.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::equilibrium::{Equilibrium, Field};
use super::galerkin;
use super::local::{self, Local, Neighbourhood};
use crate::contact::ContactSequence;
use crate::krylov::NodeSet;
use crate::updater::{Schur, Solution};
use crate::{Problem, parallel};

/// Nodes that are watched, with their local solutions.
#[derive(Debug, Clone, Default)]
pub(super) struct Watched {
    locals: Vec<Local>,
    /// Nodes in contact when they were watched.
    count: usize,
    /// Their Schur complement.
    complement: Vec<f64>,
    /// What the contact leaves of their row sums.
    row_sums: Vec<f64>,
}

impl Watched {
    /// Watches nodes beside a contact set of `count` nodes, and fills their Schur complement.
    pub(super) fn new(
        problem: &Problem,
        (neighbourhood, set): (&Neighbourhood, &NodeSet),
        nodes: &[usize],
        count: usize,
        schur: &mut Schur,
    ) -> Self {
        let of = |&node: &usize| Local {
            node,
            ..Local::default()
        };
        let mut locals: Vec<Local> = nodes.iter().map(of).collect();
        let products = locals.len() * local::PRODUCTS;
        parallel::for_each(products, &mut locals, |local| {
            *local = neighbourhood.solve(problem.table(), set, local.node);
        });
        galerkin::schur(problem, &locals, schur.as_mut_slice());
        Self {
            locals,
            count,
            complement: schur.as_mut_slice().to_vec(),
            row_sums: Vec::new(),
        }
    }

    /// Notes what the contact leaves of each row sum.
    pub(super) fn find_row_sums(&mut self, left: impl Fn(&Local) -> f64) {
        self.row_sums = self.locals.iter().map(left).collect();
    }

    /// What the contact leaves of the row sums.
    pub(super) fn row_sums(&self) -> &[f64] {
        &self.row_sums
    }

    /// Adds to `C_II⁻¹ s_I` what nodes that joined since they were watched add to it, and returns whether all nodes that
    /// joined were watched.
    pub(super) fn carry_row_sums(&self, contact: &ContactSequence, pressure: &mut [f64]) -> bool {
        let joined = contact.order().get(self.count..).unwrap_or_default();
        if joined.is_empty() {
            return true;
        }
        let Some((factor, places)) = self.factor_of(joined) else {
            return false;
        };
        let left = places.iter().map(|&place| self.row_sums[place]);
        let solved = factor.solve(&DVector::from_iterator(places.len(), left));
        self.spread(&places, &solved, pressure);
        true
    }

    /// Adds pressures on some watched nodes, and the answer of the contact near them.
    fn spread(&self, places: &[usize], values: &DVector<f64>, pressure: &mut [f64]) {
        for (&place, value) in places.iter().zip(values.iter()) {
            let local = &self.locals[place];
            pressure[local.node] += value;
            for (&node, x) in local.contact.iter().zip(&local.weights) {
                pressure[node as usize] -= value * x;
            }
        }
    }

    /// Displacements of the watched nodes with what the residuals of the solution say of them: pressures that
    /// took a residual r out of the contact would change that of node j by `x_jᵀ r`.
    pub(super) fn improved(&self, problem: &Problem, now: &Equilibrium) -> Vec<[f64; 2]> {
        let of = |local: &Local| {
            let left = now.left_near(problem, local);
            let node = local.node;
            [
                now.load.displacement[node] + left[0],
                now.rate.displacement[node] + left[1],
            ]
        };
        self.locals.iter().map(of).collect()
    }

    /// Improves what a solution says of the watched nodes, of which some have joined since they were watched:
    /// the pressures of these, and the displacements of the others.
    pub(super) fn improve(
        &self,
        problem: &Problem,
        contact: &ContactSequence,
        solved: &Equilibrium,
        solution: &mut Solution,
    ) {
        let from = self.count;
        let Some(joined) = contact.order()[..solved.count].get(from..) else {
            return;
        };
        let Some((factor, places)) = self.factor_of(joined) else {
            return;
        };
        let near: Vec<[f64; 2]> = self
            .locals
            .iter()
            .map(|local| solved.left_near(problem, local))
            .collect();
        let [u, u_rate] = &mut solution.displacement;
        let of_load = (&mut solution.pressure, u);
        let of_rate = (&mut solution.rate, u_rate);
        let fields = if solved.rate.is_known() { 2 } else { 1 };
        let fields = [of_load, of_rate].into_iter().take(fields);
        for (k, (pressures, displacement)) in fields.enumerate() {
            let of_near: Vec<f64> = near.iter().map(|near| near[k]).collect();
            let left = places.iter().zip(joined);
            let left = left.map(|(&place, &node)| solved.left(problem, node)[k] - of_near[place]);
            let left = DVector::from_iterator(places.len(), left);
            let change = if places.is_empty() {
                left
            } else {
                factor.solve(&left)
            };
            for (pressure, change) in pressures[from..].iter_mut().zip(change.iter()) {
                *pressure += change;
            }
            for (i, (local, near)) in self.locals.iter().zip(&of_near).enumerate() {
                if !places.contains(&i) {
                    let of_joined = places.iter().zip(change.iter());
                    let of_joined =
                        of_joined.map(|(&place, change)| self.between(i, place) * change);
                    displacement[local.node] += near + of_joined.sum::<f64>();
                }
            }
        }
    }

    /// An entry of the Schur complement.
    fn between(&self, i: usize, j: usize) -> f64 {
        self.complement[i.max(j) + self.locals.len() * i.min(j)]
    }

    /// The factor of the Schur complement of some watched nodes, and their places; `None` if one was not
    /// watched.
    fn factor_of(&self, joined: &[usize]) -> Option<(Cholesky<f64, Dyn>, Vec<usize>)> {
        let place = |node: &usize| self.locals.iter().position(|local| local.node == *node);
        let places: Vec<usize> = joined.iter().map(place).collect::<Option<_>>()?;
        let size = places.len();
        let matrix = DMatrix::from_fn(size, size, |i, j| self.between(places[i], places[j]));
        Some((matrix.cholesky()?, places))
    }

    /// The pressures of a field and what nodes that joined, with the right-hand sides `rhs`, add to them; and the sum of
    /// the pressures on these nodes.
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
        let Some((factor, places)) = self.factor_of(joined) else {
            return (pressure, 0.0);
        };
        let left = joined
            .iter()
            .map(|&node| rhs(node) - field.displacement[node]);
        let solved = factor.solve(&DVector::from_iterator(joined.len(), left));
        self.spread(&places, &solved, &mut pressure);
        (pressure, solved.sum())
    }
}

#[cfg(test)]
mod tests;
