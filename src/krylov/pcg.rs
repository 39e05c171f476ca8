//! Preconditioned conjugate gradients for one linear system on a contact set.

use super::{Directions, NodeSet, Operator, SparseInverse, add_scaled, dot, greatest};
use crate::Error;

/// So far a residual falls on steps of single precision before it is computed afresh: then their
/// errors, some 10⁻⁷ of what they change, are still small beside it.
const REDUCTION: f64 = 1e-5;
/// Steps go on to this part of the tolerance, so that the fresh residual is within it.
const MARGIN: f64 = 0.5;

/// How an iteration ended.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LinearOutcome {
    /// Greatest component of the residual.
    pub(crate) residual: f64,
    pub(crate) iterations: usize,
    pub(crate) converged: bool,
}

/// Linear systems $C_{II} x = b$ on a contact set.
#[derive(Debug)]
pub(crate) struct LinearSystem<'a> {
    pub(crate) operator: &'a mut Operator,
    pub(crate) inverse: &'a mut SparseInverse,
    pub(crate) contact: &'a NodeSet,
    /// Greatest component that a residual may have, in the unit of b.
    pub(crate) tolerance: f64,
    pub(crate) max_iterations: usize,
}

impl LinearSystem<'_> {
    /// The residual b − C x, in double precision; the operator then holds the displacements of x.
    pub(crate) fn residual(
        &mut self,
        b: &[f64],
        x: &[f64],
        residual: &mut Vec<f64>,
    ) -> Result<(), Error> {
        let image = self.operator.apply(self.contact, x)?;
        let nodes = b.iter().zip(self.contact.nodes());
        residual.clear();
        residual.extend(nodes.map(|(b, &node)| b - image[node as usize]));
        Ok(())
    }

    /// Solves for b from the start `x` with its `residual`, and leaves the residual of the solution
    /// there. If there were any iterations the residual is fresh, and the operator holds the
    /// displacements of x.
    ///
    /// # Errors
    ///
    /// [`Error::FactorizationFailed`] if the matrix turns out not to be positive definite.
    pub(crate) fn solve(
        &mut self,
        b: &[f64],
        x: &mut [f64],
        residual: &mut Vec<f64>,
    ) -> Result<LinearOutcome, Error> {
        let worst = |residual: &[f64]| greatest(residual.len(), 0.0, |i| residual[i].abs());
        let mut outcome = LinearOutcome {
            residual: worst(residual),
            iterations: 0,
            converged: false,
        };
        let (mut z, mut directions) = (Vec::new(), Directions::default());
        // NaN is not above the tolerance, and no convergence either.
        while outcome.residual > self.tolerance && outcome.iterations < self.max_iterations {
            let start = outcome.residual;
            let enough = (MARGIN * self.tolerance).max(REDUCTION * start);
            let mut now = start;
            while now > enough && outcome.iterations < self.max_iterations {
                self.inverse.apply(residual, &mut z);
                // Those from before a fresh residual are as good as ever.
                let direction = directions.conjugate(&z);
                let displacement = self.operator.step(self.contact, &direction)?;
                let mut image = Vec::new();
                self.contact.gather(displacement, &mut image);
                let curvature = dot(&direction, &image);
                if curvature.is_nan() || curvature <= 0.0 {
                    if directions.forget() {
                        continue;
                    }
                    return Err(Error::FactorizationFailed {
                        nodes: self.contact.len(),
                    });
                }
                let step = dot(residual, &direction) / curvature;
                add_scaled(x, step, &direction);
                add_scaled(residual, -step, &image);
                directions.push(direction, image, curvature);
                outcome.iterations += 1;
                now = worst(residual);
            }
            self.residual(b, x, residual)?;
            outcome.residual = worst(residual);
            // Rounding ends an iteration that no longer halves its residual.
            if outcome.residual > 0.5 * start && outcome.residual > self.tolerance {
                break;
            }
        }
        outcome.converged = outcome.residual <= self.tolerance;
        Ok(outcome)
    }
}
