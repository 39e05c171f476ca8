//! What a little more load would change: exact stiffnesses.

use nalgebra::DMatrix;

use super::level::Level;
use super::solution::FixedLoadSolution;
use super::solver::FixedLoadSolver;
use crate::krylov::{LinearSystem, NodeSet, dot, sum, sum_over};
use crate::parallel::inside;
use crate::{Boundary, Error, InfluenceKernel, Surface};

/// The pressure per unit of approach, $y_2$, and its displacement, both on the whole grid and in the
/// gauge of the level: in the zero gauge full contact is singular. Empty where they are not known.
#[derive(Debug, Clone, Default)]
pub(super) struct Tangent {
    pub(super) rate: Vec<f64>,
    pub(super) displacement: Vec<f64>,
}

impl Tangent {
    pub(super) fn is_known(&self) -> bool {
        !self.rate.is_empty()
    }

    /// That of a solution, which costs a convolution; unknown if it has no stiffnesses.
    pub(super) fn of(level: &mut Level, solution: &FixedLoadSolution) -> Result<Self, Error> {
        let state = &solution.state;
        let Some(interfacial) = state.interfacial_stiffness else {
            return Ok(Self::default());
        };
        let (gauge, cell_area) = (level.gauge, level.grid.cell_area());
        // $1 / K_s = 1 / K_i + s / \Delta A$ in the gauge s.
        let in_gauge = 1.0 / (1.0 / interfacial + gauge / cell_area);
        let stiffness = state.contact_stiffness.unwrap_or(in_gauge);
        let rates = solution.pressure_rate.iter();
        let rate: Vec<f64> = rates.map(|rate| stiffness * rate).collect();
        let displacement =
            level.in_gauge(|level| Ok(level.operator.apply_field(&rate)?.to_vec()))?;
        Ok(Self { rate, displacement })
    }
}

/// What a solution for the tangent took and gave.
struct Solved {
    iterations: usize,
    /// $e^T C_{II}^{-1} e$.
    unit_unit: f64,
}

impl Level {
    /// Does `work` with displacements in the gauge of the level.
    fn in_gauge<T>(
        &mut self,
        work: impl FnOnce(&mut Self) -> Result<T, Error>,
    ) -> Result<T, Error> {
        self.operator.set_uniform(self.gauge);
        let done = work(self);
        self.operator.set_uniform(0.0);
        done
    }

    /// Solves $C_{II}\\, y_2 = e$ on the contact set, from the tangent of another one if it is known.
    fn solve_tangent(
        &mut self,
        tangent: &mut Tangent,
        tolerance: f64,
        max_iterations: usize,
    ) -> Result<Solved, Error> {
        let contact = &self.iterate.contact;
        let ones = vec![1.0; contact.len()];
        let mut y = Vec::new();
        let mut residual = Vec::new();
        let is_known = tangent.is_known();
        if is_known {
            contact.gather(&tangent.rate, &mut y);
            contact.gather(&tangent.displacement, &mut residual);
            for value in &mut residual {
                *value = 1.0 - *value;
            }
        } else {
            self.inverse.apply(&ones, &mut y);
        }
        // Nodes that have left take their displacements with them.
        let places = contact.places();
        let mut rates = tangent.rate.iter().zip(places);
        let lost = rates.any(|(rate, place)| *rate != 0.0 && *place == NodeSet::NONE);
        let mut equations = LinearSystem {
            operator: &mut self.operator,
            inverse: &mut self.inverse,
            contact,
            tolerance,
            max_iterations,
        };
        let stale = lost || !is_known;
        if stale {
            equations.residual(&ones, &y, &mut residual)?;
        }
        let outcome = equations.solve(&ones, &mut y, &mut residual)?;
        if !outcome.converged {
            return Err(Error::NoConvergence {
                residual: outcome.residual,
                tolerance,
                iterations: outcome.iterations,
            });
        }
        if stale || outcome.iterations > 0 {
            tangent.displacement.clear();
            tangent
                .displacement
                .extend_from_slice(self.operator.displacement());
        }
        tangent.rate.clear();
        tangent.rate.resize(self.gap.len(), 0.0);
        contact.scatter(&y, &mut tangent.rate);
        Ok(Solved {
            iterations: outcome.iterations,
            // With the residual r, $e^T C^{-1} e = e^T y + y^T r$ but for the square of the error.
            unit_unit: sum(&y) + dot(&y, &residual),
        })
    }
}

impl<S: Surface, K: InfluenceKernel> FixedLoadSolver<S, K> {
    /// Adds the stiffnesses and the rate of pressure to a solution of this solver that was computed
    /// [without](super::FixedLoadBuilder::stiffness).
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`] if the solution lives on another grid, [`Error::NoConvergence`], and
    /// [`Error::FactorizationFailed`] if the kernel is not positive definite.
    pub fn add_stiffness(&mut self, solution: &mut FixedLoadSolution) -> Result<(), Error> {
        self.tangent(solution, &mut Tangent::default())
    }

    /// Stiffnesses of a solution, from the tangent of another one if it is known.
    pub(super) fn tangent(
        &mut self,
        solution: &mut FixedLoadSolution,
        tangent: &mut Tangent,
    ) -> Result<(), Error> {
        self.grid.check_shape(solution.pressure.shape())?;
        let pressure = solution.pressure.as_slice();
        let fine = &mut self.levels[0];
        let contact = &mut fine.iterate.contact;
        if contact.assign(|node| pressure[node] > 0.0) {
            fine.inverse.update(contact);
        }
        let (tolerance, max_iterations) = (self.tolerance, self.max_iterations);
        let solve = |fine: &mut Level| fine.solve_tangent(tangent, tolerance, max_iterations);
        let solved = inside(|| fine.in_gauge(solve))?;
        let nodes = self.grid.nodes();
        let displacement = &tangent.displacement;
        // Nodes in contact are left out: then full contact is exact.
        let closing = sum_over(nodes, |node| {
            if pressure[node] > 0.0 {
                0.0
            } else {
                1.0 - displacement[node]
            }
        });
        let stiffness = self.grid.cell_area() * solved.unit_unit;
        let (nx, ny) = self.grid.shape();
        let rates = tangent.rate.iter().map(|rate| rate / stiffness);
        solution.pressure_rate = DMatrix::from_iterator(nx, ny, rates);
        solution.state.contact_stiffness = match fine.boundary {
            Boundary::Free => Some(stiffness),
            Boundary::Periodic => None,
        };
        solution.state.interfacial_stiffness = Some(stiffness / (closing / nodes as f64));
        solution.stiffness_iterations = solved.iterations;
        solution.convolutions += self.levels[0].operator.take_convolutions();
        Ok(())
    }
}
