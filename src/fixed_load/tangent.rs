//! What a little more load would change: exact stiffnesses.

use nalgebra::DMatrix;

use super::level::Level;
use super::solution::FixedLoadSolution;
use super::solver::FixedLoadSolver;
use crate::iterative::{dot, solve_linear, sum, sum_over};
use crate::{Boundary, Error, InfluenceKernel, Surface};

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

    /// Solves $C_{II}\\, y_2 = e$ on the nodes that carry, from the tangent of another solution; in
    /// the gauge of the level, since in the zero gauge full contact is singular.
    pub(super) fn tangent(
        &mut self,
        solution: &mut FixedLoadSolution,
        start: Option<&FixedLoadSolution>,
    ) -> Result<(), Error> {
        self.grid.check_shape(solution.pressure.shape())?;
        let pressure = solution.pressure.as_slice();
        let Level {
            operator,
            inverse,
            iterate,
            gauge,
            boundary,
            ..
        } = &mut self.levels[0];
        let contact = &mut iterate.contact;
        if contact.assign(|node| pressure[node] > 0.0) {
            inverse.update(contact);
        }
        let mut residual = vec![1.0; contact.len()];
        let mut rate = Vec::new();
        let cell_area = self.grid.cell_area();
        match start.and_then(|start| Some((start, start.state.interfacial_stiffness?))) {
            Some((start, stiffness)) => {
                // $1 / K_s = 1 / K_i + s / \Delta A$ in the gauge s.
                let stiffness = start
                    .state
                    .contact_stiffness
                    .unwrap_or(1.0 / (1.0 / stiffness + *gauge / cell_area));
                contact.gather(start.pressure_rate.as_slice(), &mut rate);
                for value in &mut rate {
                    *value *= stiffness;
                }
            }
            None => inverse.apply(&residual, &mut rate),
        }
        operator.set_uniform(*gauge);
        let solved = solve_linear(
            operator,
            inverse,
            contact,
            &mut residual,
            &mut rate,
            self.tolerance,
            self.max_iterations,
        )
        .and_then(|outcome| Ok((outcome, operator.apply(contact, &rate)?.to_vec())));
        operator.set_uniform(0.0);
        let (outcome, displacement) = solved?;
        if !outcome.converged {
            return Err(Error::NoConvergence {
                residual: outcome.residual,
                tolerance: self.tolerance,
                iterations: outcome.iterations,
            });
        }
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
        let stiffness = cell_area * (sum(&rate) + dot(&rate, &residual));
        for value in &mut rate {
            *value /= stiffness;
        }
        let (nx, ny) = self.grid.shape();
        solution.pressure_rate = DMatrix::zeros(nx, ny);
        contact.scatter(&rate, solution.pressure_rate.as_mut_slice());
        solution.state.contact_stiffness = match boundary {
            Boundary::Free => Some(stiffness),
            Boundary::Periodic => None,
        };
        solution.state.interfacial_stiffness = Some(stiffness / (closing / nodes as f64));
        solution.stiffness_iterations = outcome.iterations;
        solution.convolutions += operator.take_convolutions();
        Ok(())
    }
}
