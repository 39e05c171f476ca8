//! Preconditioned conjugate gradients for one linear system on a contact set.

use super::{Directions, NodeSet, Operator, Preconditioner, add_scaled, greatest};
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

/// Linear systems `C_II x = b` on a contact set I.
#[derive(Debug)]
pub(crate) struct LinearSystem<'a> {
    pub(crate) operator: &'a mut Operator,
    pub(crate) preconditioner: &'a mut Preconditioner,
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
    /// [`Error::FactorizationFailed`] if the matrix turns out not to be positive definite, and
    /// [`Error::NoConvergence`] as soon as the residual is not finite. Running out of iterations, or
    /// into rounding, is told by the outcome.
    pub(crate) fn solve(
        &mut self,
        b: &[f64],
        x: &mut [f64],
        residual: &mut Vec<f64>,
    ) -> Result<LinearOutcome, Error> {
        let worst = |residual: &[f64]| greatest(residual.len(), 0.0, |i| residual[i].abs());
        let mut outcome = LinearOutcome {
            residual: self.finite(worst(residual), 0)?,
            iterations: 0,
            converged: false,
        };
        let (mut z, mut directions) = (Vec::new(), Directions::default());
        while outcome.residual > self.tolerance && outcome.iterations < self.max_iterations {
            let start = outcome.residual;
            let enough = (MARGIN * self.tolerance).max(REDUCTION * start);
            let mut now = start;
            while now > enough && outcome.iterations < self.max_iterations {
                self.preconditioner.apply(residual, &mut z);
                // Directions from before a fresh residual are as good as ever.
                let step = directions.advance(self.operator, self.contact, residual, &z)?;
                add_scaled(x, step.length, step.values);
                add_scaled(residual, -step.reach, step.image);
                outcome.iterations += 1;
                now = worst(residual);
            }
            self.residual(b, x, residual)?;
            outcome.residual = self.finite(worst(residual), outcome.iterations)?;
            // Rounding ends an iteration that no longer halves its residual.
            if outcome.residual > 0.5 * start && outcome.residual > self.tolerance {
                break;
            }
        }
        outcome.converged = outcome.residual <= self.tolerance;
        Ok(outcome)
    }

    /// `Ok(residual)` if it is finite.
    fn finite(&self, residual: f64, iterations: usize) -> Result<f64, Error> {
        if residual.is_finite() {
            Ok(residual)
        } else {
            Err(Error::NoConvergence {
                residual,
                tolerance: self.tolerance,
                iterations,
            })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::convolution::Convolution;
    use crate::kernel::KernelTable;
    use crate::{Boussinesq, Grid};

    /// Solves on all nodes of a small grid, from the residual `start` of a zero solution.
    fn solve(start: f64, max_iterations: usize) -> Result<LinearOutcome, Error> {
        let grid = Grid::square(8, 1.0)?;
        let table = KernelTable::new(&Boussinesq::new(grid, 1.0)?)?;
        let mut contact = NodeSet::new(grid.nodes());
        contact.assign(|_| true);
        let mut preconditioner = Preconditioner::new(&table);
        preconditioner.update(&contact);
        let mut system = LinearSystem {
            operator: &mut Operator::new(Convolution::from_table(&table)?),
            preconditioner: &mut preconditioner,
            contact: &contact,
            tolerance: 1e-10,
            max_iterations,
        };
        let b = vec![1.0; grid.nodes()];
        let mut residual = vec![start; grid.nodes()];
        system.solve(&b, &mut vec![0.0; grid.nodes()], &mut residual)
    }

    #[test]
    fn a_residual_that_is_not_finite_is_an_error_at_once() {
        for start in [f64::INFINITY, f64::NAN] {
            let solved = solve(start, 100);
            assert!(
                matches!(solved, Err(Error::NoConvergence { iterations: 0, .. })),
                "{solved:?}"
            );
        }
    }

    #[test]
    fn iterations_are_limited() -> Result<(), Error> {
        for limit in [0, 1, 3] {
            let outcome = solve(1.0, limit)?;
            assert_eq!((outcome.iterations, outcome.converged), (limit, false));
        }
        assert!(solve(1.0, 100)?.converged);
        Ok(())
    }
}
