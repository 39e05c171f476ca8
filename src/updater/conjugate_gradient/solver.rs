//! Linear systems on the contact, from a start and what is known of its displacements.

use super::equilibrium::Field;
use crate::contact::ContactSequence;
use crate::krylov::{Directions, NodeSet, Operator, Preconditioner, add_scaled, dot, greatest};
use crate::{Error, Problem};

/// Error of a displacement in single precision, relative to the greatest, and to the noise that roundings of the spectrum
/// come to. Those of several steps are independent of each other, and add up in the square.
const SINGLE: f64 = 2e-7;
/// Iterations go on to this part of the tolerance, and displacements are computed afresh once single precision
/// may have spoilt as much of them: together they stay within it.
const MARGIN: f64 = 0.5;

/// A right-hand side `C_II x = b`, and when its iteration ends.
pub(super) struct Equation<F> {
    /// b, by node.
    pub(super) rhs: F,
    /// Greatest residual.
    pub(super) tolerance: f64,
    /// What steps in single precision may have spoilt of the displacements in the end, if that must be less than
    /// the tolerance asks for.
    pub(super) most_drift: f64,
    pub(super) max_iterations: usize,
}

/// The influence matrix of a contact set, and what approximates its inverse.
#[derive(Debug, Clone)]
pub(super) struct Solver {
    operator: Operator,
    preconditioner: Preconditioner,
    set: NodeSet,
}

impl Solver {
    pub(super) fn new(problem: &Problem) -> Self {
        Self {
            operator: Operator::new(problem.convolution()),
            preconditioner: Preconditioner::new(problem.table()),
            set: NodeSet::new(problem.grid().nodes()),
        }
    }

    /// The contact set.
    pub(super) fn set(&self) -> &NodeSet {
        &self.set
    }

    /// Makes the set the first `count` nodes of a contact.
    pub(super) fn choose(&mut self, contact: &ContactSequence, count: usize) {
        let mut is_in = vec![false; self.set.places().len()];
        for &node in &contact.order()[..count] {
            is_in[node] = true;
        }
        if self.set.assign(|node| is_in[node]) {
            self.preconditioner.update(&self.set);
        }
    }

    /// Computes the displacements of a field, unless they are known.
    pub(super) fn complete(&mut self, field: &mut Field) -> Result<(), Error> {
        if !field.is_known() {
            field.displacement = self.operator.apply_field(&field.pressure)?.to_vec();
            field.drift = 0.0;
        }
        Ok(())
    }

    /// Solves an equation from pressures `start`, of which `base` knows the displacements of most. Steps are
    /// in single precision, and so are displacements as long as that is within the tolerance.
    pub(super) fn solve<F: Fn(usize) -> f64 + Sync + Send>(
        &mut self,
        equation: &Equation<F>,
        mut start: Vec<f64>,
        base: &Field,
        directions: &mut Directions,
    ) -> Result<Field, Error> {
        let (mut b, mut x) = (Vec::new(), Vec::new());
        self.set.fill(&mut b, |_, node| (equation.rhs)(node));
        self.set.gather(&start, &mut x);
        let noise = self.operator.noise();
        // What a step spoils that displaces by so much, of pressures of that norm.
        let spoilt = |most: f64, norm: f64| (SINGLE * most).hypot(SINGLE * noise * norm);
        let (mut u, mut drift);
        if base.is_known() {
            let mut change = Vec::new();
            self.set
                .fill(&mut change, |place, node| x[place] - base.pressure[node]);
            u = base.displacement.clone();
            let added = self.operator.add(&self.set, &change, &mut u)?;
            drift = base
                .drift
                .hypot(spoilt(added, dot(&change, &change).sqrt()));
        } else {
            u = self.operator.apply(&self.set, &x)?.to_vec();
            drift = 0.0;
        }
        let mut residual = self.residual(&b, &u);
        let before = worst(&residual);
        let projected = directions.project(&mut x, &mut residual, &mut u);
        drift = drift.hypot(spoilt(before, projected));
        let (mut iterations, mut last) = (0, f64::INFINITY);
        let (mut z, enough) = (Vec::new(), MARGIN * equation.tolerance);
        let most_drift = enough.min(equation.most_drift);
        let failed = |residual: f64, iterations: usize| Error::NoConvergence {
            residual,
            tolerance: equation.tolerance,
            iterations,
        };
        loop {
            let mut now = worst(&residual);
            // What lies below the drift means nothing.
            while now > enough.max(0.1 * drift) {
                if iterations == equation.max_iterations || !now.is_finite() {
                    return Err(failed(now, iterations));
                }
                self.preconditioner.apply(&residual, &mut z);
                let step = directions.advance(&mut self.operator, &self.set, &residual, &z)?;
                add_scaled(&mut x, step.length, step.values);
                add_scaled(&mut residual, -step.reach, step.image);
                add_scaled(&mut u, step.reach, step.everywhere);
                let next = worst(&residual);
                drift = drift.hypot(spoilt(now + next, step.norm));
                (now, iterations) = (next, iterations + 1);
            }
            if drift <= most_drift {
                break;
            }
            u.copy_from_slice(self.operator.apply(&self.set, &x)?);
            drift = 0.0;
            residual = self.residual(&b, &u);
            let fresh = worst(&residual);
            if fresh <= equation.tolerance {
                break;
            }
            // Rounding ends an iteration that no longer halves its residual.
            if fresh.is_nan() || fresh > 0.5 * last {
                return Err(failed(fresh, iterations));
            }
            last = fresh;
        }
        self.set.spread(&x, &mut start);
        Ok(Field {
            pressure: start,
            displacement: u,
            drift,
        })
    }

    fn residual(&self, b: &[f64], u: &[f64]) -> Vec<f64> {
        let mut residual = Vec::new();
        self.set
            .fill(&mut residual, |place, node| b[place] - u[node]);
        residual
    }
}

/// The greatest absolute value.
fn worst(residual: &[f64]) -> f64 {
    greatest(residual.len(), 0.0, |i| residual[i].abs())
}

#[cfg(test)]
mod tests;
