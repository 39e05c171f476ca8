//! What a little more load would change: exact stiffnesses.

use nalgebra::DMatrix;

use super::level::Level;
use super::solution::FixedLoadSolution;
use super::solver::FixedLoadSolver;
use crate::iterative::{dot, solve_linear, sum, sum_over};
use crate::{Error, InfluenceKernel, Surface};

impl<S: Surface, K: InfluenceKernel> FixedLoadSolver<S, K> {
    /// Adds the stiffnesses and the rate of pressure to a solution of this solver that was computed
    /// [without](super::FixedLoadBuilder::stiffness).
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`] if the solution lives on another grid, [`Error::NoConvergence`], and
    /// [`Error::FactorizationFailed`] if the kernel is not positive definite.
    pub fn add_stiffness(&mut self, solution: &mut FixedLoadSolution) -> Result<(), Error> {
        self.tangent(solution, None)
    }

    /// Solves $C_{II}\\, y_2 = e$ on the nodes that carry, from a start that is a field.
    pub(super) fn tangent(
        &mut self,
        solution: &mut FixedLoadSolution,
        start: Option<&[f64]>,
    ) -> Result<(), Error> {
        self.grid.check_shape(solution.pressure.shape())?;
        let pressure = solution.pressure.as_slice();
        let Level {
            operator,
            inverse,
            iterate,
            ..
        } = &mut self.levels[0];
        let contact = &mut iterate.contact;
        if contact.assign(|node| pressure[node] > 0.0) {
            inverse.update(contact);
        }
        let mut residual = vec![1.0; contact.len()];
        let mut rate = Vec::new();
        match start {
            Some(start) => contact.gather(start, &mut rate),
            None => inverse.apply(&residual, &mut rate),
        }
        let outcome = solve_linear(
            operator,
            inverse,
            contact,
            &mut residual,
            &mut rate,
            self.tolerance,
            self.max_iterations,
        )?;
        if !outcome.converged {
            return Err(Error::NoConvergence {
                residual: outcome.residual,
                tolerance: self.tolerance,
                iterations: outcome.iterations,
            });
        }
        let displacement = operator.apply(contact, &rate)?;
        let nodes = displacement.len();
        // Nodes in contact are left out: then full contact is exact.
        let closing = sum_over(nodes, |node| {
            if pressure[node] > 0.0 {
                0.0
            } else {
                1.0 - displacement[node]
            }
        });
        // With the residual r, $e^T C^{-1} e = e^T y + y^T r$ but for the square of the error.
        let stiffness = self.grid.cell_area() * (sum(&rate) + dot(&rate, &residual));
        let (nx, ny) = self.grid.shape();
        solution.pressure_rate = DMatrix::zeros(nx, ny);
        contact.scatter(&rate, solution.pressure_rate.as_mut_slice());
        solution.state.contact_stiffness = stiffness;
        solution.state.interfacial_stiffness = stiffness / (closing / nodes as f64);
        solution.stiffness_iterations = outcome.iterations;
        solution.convolutions += operator.take_convolutions();
        Ok(())
    }
}
