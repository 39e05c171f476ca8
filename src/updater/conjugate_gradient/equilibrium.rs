//! A solution on a contact, as fields of the grid.

use super::local::Local;
use crate::Problem;
use crate::contact::ContactSequence;
use crate::krylov::{Field, add_scaled};
use crate::updater::{Solution, Solved};

/// The pressure at an approach and its rate, on the first `count` nodes of a contact.
#[derive(Debug, Clone, Default)]
pub(super) struct Equilibrium {
    pub(super) count: usize,
    pub(super) approach: f64,
    /// How far the approach may go on with the rate.
    pub(super) serves: f64,
    pub(super) load: Field,
    pub(super) rate: Field,
}

impl Field {
    /// 1 less the mean displacement: the mean closing rate of the gaps if this is a rate.
    pub(super) fn open(&self) -> f64 {
        let nodes = self.displacement.len().max(1) as f64;
        1.0 - self.displacement.iter().sum::<f64>() / nodes
    }

    /// Keeps the pressures on nodes in contact; what they cause is not known then.
    pub(super) fn keep(&mut self, contact: &ContactSequence) {
        self.displacement.clear();
        for (node, value) in self.pressure.iter_mut().enumerate() {
            if !contact.contains(node) {
                *value = 0.0;
            }
        }
    }
}

impl Equilibrium {
    /// Before any contact.
    pub(super) fn zero(nodes: usize) -> Self {
        Self { load: Field::zero(nodes), rate: Field::zero(nodes), ..Self::default() }
    }

    /// The pressures on its contact, the first nodes of a sequence, and all displacements, as they are.
    pub(super) fn write(&self, contact: &ContactSequence, solved: &mut Solved) {
        let values = |field: &Field| {
            let nodes = contact.order()[..self.count].iter();
            nodes.map(|&node| field.pressure.get(node).copied().unwrap_or(0.0)).collect()
        };
        solved.solution.pressure = values(&self.load);
        solved.solution.rate = values(&self.rate);
        let [u, u_rate] = &mut solved.displacement;
        u.clone_from(&self.load.displacement);
        u_rate.clone_from(&self.rate.displacement);
    }

    /// The pressure at another approach, as long as no node joins.
    pub(super) fn load_at(&self, approach: f64) -> Field {
        let (time, load, rate) = (approach - self.approach, &self.load, &self.rate);
        let sum = |a: &[f64], b: &[f64]| {
            // Of what is not known nothing follows.
            if a.is_empty() || b.is_empty() {
                return Vec::new();
            }
            let mut sum = a.to_vec();
            add_scaled(&mut sum, time, b);
            sum
        };
        Field {
            pressure: sum(&load.pressure, &rate.pressure),
            displacement: sum(&load.displacement, &rate.displacement),
            drift: load.drift + time.abs() * rate.drift,
        }
    }

    /// Residuals of the equations of a node in contact, for pressure and rate.
    pub(super) fn left(&self, problem: &Problem, node: usize) -> [f64; 2] {
        let overlap = self.approach - problem.initial_gap()[node];
        let rate = self.rate.displacement.get(node);
        [overlap - self.load.displacement[node], rate.map_or(0.0, |rate| 1.0 - rate)]
    }

    /// `x_jᵀ r` for what is left on the contact near a proposed node, of nodes that are in it still.
    pub(super) fn left_near(
        &self,
        problem: &Problem,
        local: &Local,
        is_in: impl Fn(usize) -> bool,
    ) -> [f64; 2] {
        let mut sums = [0.0; 2];
        let near = local.contact.iter().zip(&local.weights);
        for (&node, x) in near.filter(|(node, _)| is_in(**node as usize)) {
            let left = self.left(problem, node as usize);
            for (sum, left) in sums.iter_mut().zip(left) {
                *sum += x * left;
            }
        }
        sums
    }

    /// Scales pressures and rates of an improved solution so that their sums, load and stiffness, are right to second
    /// order: with a residual r left those of this one lack `y₂ᵀ r`. What improved single pressures without the answer
    /// of others is no part of it.
    pub(super) fn scale(
        &self,
        problem: &Problem,
        contact: &ContactSequence,
        solution: &mut Solution,
    ) {
        if !self.rate.is_known() {
            return;
        }
        let (mut lacking, mut sums) = ([0.0; 2], [0.0; 2]);
        for &node in &contact.order()[..self.count] {
            let rate = self.rate.pressure[node];
            let left = self.left(problem, node);
            for k in 0..2 {
                lacking[k] += rate * left[k];
            }
            sums[0] += self.load.pressure[node];
            sums[1] += rate;
        }
        for (k, values) in [&mut solution.pressure, &mut solution.rate].into_iter().enumerate() {
            let factor = (sums[k] + lacking[k]) / values.iter().sum::<f64>();
            if factor.is_finite() {
                for value in values {
                    *value *= factor;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field(pressure: [f64; 2], displacement: &[f64], drift: f64) -> Field {
        Field { pressure: pressure.to_vec(), displacement: displacement.to_vec(), drift }
    }

    #[test]
    fn what_displacements_leave_open() {
        assert_eq!(field([0.0; 2], &[0.5, 0.25], 0.0).open(), 0.625);
        // Of what is not known nothing is taken off.
        assert_eq!(field([0.0; 2], &[], 0.0).open(), 1.0);
    }

    /// Pressures, displacements and what may be spoilt of them are lines, forwards and backwards; displacements that
    /// are not known at either end of the sum are not known there.
    #[test]
    fn another_approach_is_on_a_line() {
        let known = Equilibrium {
            count: 2,
            approach: 3.0,
            serves: 1.0,
            load: field([1.0, 2.0], &[10.0, 20.0], 0.5),
            rate: field([0.25, 0.5], &[2.0, 4.0], 0.125),
        };
        let ahead = known.load_at(7.0);
        assert_eq!(ahead.pressure, [2.0, 4.0]);
        assert_eq!(ahead.displacement, [18.0, 36.0]);
        assert_eq!(ahead.drift, 1.0);
        assert_eq!(known.load_at(1.0).drift, 0.75);
        for (load, rate) in [(true, false), (false, true), (false, false)] {
            let mut partly = known.clone();
            if !load {
                partly.load.displacement.clear();
            }
            if !rate {
                partly.rate.displacement.clear();
            }
            let ahead = partly.load_at(7.0);
            assert_eq!(ahead.pressure, [2.0, 4.0]);
            assert!(!ahead.is_known());
        }
    }

    /// Nodes 0 and 2 of four in a row are solved at the approach 3, and node 1 not: what is left is 3 − 0 − 2.5, 3 − 1
    /// − 1.5 and 3 − 2 − 1.125, and of rates 1/2, 3/4 and 0.
    fn solved() -> Result<(Problem, ContactSequence, Equilibrium), crate::Error> {
        let problem = crate::test_chain::problem(&[0.0, 1.0, 2.0, 9.0])?;
        let contact = ContactSequence::with_order(problem.grid(), [0, 2, 1])?;
        let of = |pressure: [f64; 4], displacement: [f64; 4]| Field {
            pressure: pressure.to_vec(),
            displacement: displacement.to_vec(),
            drift: 0.0,
        };
        let solved = Equilibrium {
            count: 2,
            approach: 3.0,
            serves: 1.0,
            load: of([0.5, 7.0, 0.25, 0.0], [2.5, 1.5, 1.125, 0.0]),
            rate: of([0.25, 7.0, 0.5, 0.0], [0.5, 0.25, 1.0, 0.0]),
        };
        Ok((problem, contact, solved))
    }

    #[test]
    fn what_a_solution_leaves() -> Result<(), crate::Error> {
        let (problem, _, mut solved) = solved()?;
        let left = [0, 1, 2].map(|node| solved.left(&problem, node));
        assert_eq!(left, [[0.5, 0.5], [0.5, 0.75], [-0.125, 0.0]]);
        let local = Local { node: 3, contact: vec![1, 2], weights: vec![0.5, 2.0] };
        // 0.5 · 0.5 − 2 · 0.125, and 0.5 · 0.75.
        assert_eq!(solved.left_near(&problem, &local, |_| true), [0.0, 0.375]);
        // Of a rate that was not asked for nothing is left.
        solved.rate.displacement.clear();
        assert_eq!(solved.left(&problem, 1), [0.5, 0.0]);
        Ok(())
    }

    /// Rates of 1/4 and 1/2 times what is left: 1/8 − 1/16 for the load, 1/8 for the rate, beside sums of 3/4 each.
    #[test]
    fn sums_are_right_to_second_order() -> Result<(), crate::Error> {
        let (problem, contact, mut solved) = solved()?;
        let scaled = |solved: &Equilibrium, pressure: [f64; 2], rate: [f64; 2]| {
            let mut solution = Solution { pressure: pressure.to_vec(), rate: rate.to_vec() };
            solved.scale(&problem, &contact, &mut solution);
            [solution.pressure, solution.rate].concat()
        };
        let (own, own_rate) = ([0.5, 0.25], [0.25, 0.5]);
        let [load, rate] = [0.8125 / 0.75, 0.875 / 0.75];
        let of_rate = [0.25 * rate, 0.5 * rate];
        let found = scaled(&solved, own, own_rate);
        assert_eq!(found, [0.5 * load, 0.25 * load, of_rate[0], of_rate[1]]);
        // The same sums where single pressures were improved: 13/16 from 1 + 5/8, and 7/8 from 1 + 3/4.
        assert_eq!(scaled(&solved, [1.0, 0.625], [1.0, 0.75]), [0.5, 0.3125, 0.5, 0.375]);
        // Sums of nothing are not scaled, and without a rate there is nothing to scale by.
        assert_eq!(scaled(&solved, [0.0; 2], own_rate), [0.0, 0.0, of_rate[0], of_rate[1]]);
        solved.rate.displacement.clear();
        assert_eq!(scaled(&solved, own, own_rate), [0.5, 0.25, 0.25, 0.5]);
        Ok(())
    }

    #[test]
    fn pressures_out_of_contact_are_dropped() -> Result<(), crate::Error> {
        let (_, mut contact, mut solved) = solved()?;
        contact.truncate(2);
        solved.load.keep(&contact);
        assert_eq!(solved.load.pressure, [0.5, 0.0, 0.25, 0.0]);
        assert!(!solved.load.is_known());
        let zero = Equilibrium::zero(3);
        assert_eq!((zero.count, zero.rate.pressure.len(), zero.load.displacement.len()), (0, 3, 3));
        Ok(())
    }
}
