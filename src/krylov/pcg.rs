//! Preconditioned conjugate gradients for one linear system on a contact set, from a start and what is known of its
//! displacements.

use std::borrow::Cow;

use super::tuning::{MARGIN, SINGLE};
use super::{Directions, NodeSet, Operator, Preconditioner, add_scaled, dot, greatest};
use crate::Error;

/// Pressures of the grid and the displacements that they cause.
#[derive(Debug, Clone, Default)]
pub(crate) struct Field {
    pub(crate) pressure: Vec<f64>,
    /// Empty if it is not known.
    pub(crate) displacement: Vec<f64>,
    /// Error of the displacements by changes in single precision.
    pub(crate) drift: f64,
}

impl Field {
    pub(crate) fn zero(nodes: usize) -> Self {
        Self { pressure: vec![0.0; nodes], displacement: vec![0.0; nodes], drift: 0.0 }
    }

    /// Pressures whose displacements are not known.
    pub(crate) fn of(pressure: Vec<f64>) -> Self {
        Self { pressure, ..Self::default() }
    }

    pub(crate) fn is_known(&self) -> bool {
        !self.displacement.is_empty()
    }
}

/// A right-hand side `C_II x = b`, and when its iteration ends.
pub(crate) struct Equation<F> {
    /// b, by node.
    pub(crate) rhs: F,
    /// Greatest residual.
    pub(crate) tolerance: f64,
    /// What steps in single precision may have spoilt of the displacements in the end, if that must be less than
    /// the tolerance asks for.
    pub(crate) most_drift: f64,
    pub(crate) max_iterations: usize,
}

/// The influence matrix `C_II` of a contact set I, and what approximates its inverse.
#[derive(Debug)]
pub(crate) struct LinearSystem<'a> {
    pub(crate) operator: &'a mut Operator,
    pub(crate) preconditioner: &'a mut Preconditioner,
    pub(crate) contact: &'a NodeSet,
}

impl LinearSystem<'_> {
    /// Solves an equation from pressures `start`, of which `base` knows the displacements of most. Steps are in single
    /// precision, and so are displacements as long as that is within the tolerance. Returns the number of iterations
    /// too.
    ///
    /// # Errors
    ///
    /// [`Error::FactorizationFailed`] if the matrix turns out not to be positive definite, and [`Error::NoConvergence`]
    /// if the residual is not finite, after too many iterations, or where rounding keeps it above the tolerance.
    pub(crate) fn solve<F: Fn(usize) -> f64 + Sync + Send>(
        &mut self,
        equation: &Equation<F>,
        mut start: Vec<f64>,
        base: Cow<'_, Field>,
        directions: &mut Directions,
    ) -> Result<(Field, usize), Error> {
        let contact = self.contact;
        let (mut b, mut x) = (Vec::new(), Vec::new());
        contact.fill(&mut b, |_, node| (equation.rhs)(node));
        contact.gather(&start, &mut x);
        let noise = self.operator.noise();
        // What a step spoils that displaces by so much, of pressures of that norm.
        let spoilt = |most: f64, norm: f64| (SINGLE * most).hypot(SINGLE * noise * norm);
        let (mut u, mut drift);
        if base.is_known() {
            let mut change = Vec::new();
            contact.fill(&mut change, |place, node| x[place] - base.pressure[node]);
            drift = base.drift;
            u = match base {
                Cow::Owned(base) => base.displacement,
                Cow::Borrowed(base) => base.displacement.clone(),
            };
            let added = self.operator.add(contact, &change, &mut u)?;
            drift = drift.hypot(spoilt(added, dot(&change, &change).sqrt()));
        } else {
            u = self.operator.apply(contact, &x)?.to_vec();
            drift = 0.0;
        }
        let left = |u: &[f64]| {
            let mut residual = Vec::new();
            contact.fill(&mut residual, |place, node| b[place] - u[node]);
            residual
        };
        let mut residual = left(&u);
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
                let step = directions.advance(self.operator, contact, &residual, &z)?;
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
            u.copy_from_slice(self.operator.apply(contact, &x)?);
            drift = 0.0;
            residual = left(&u);
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
        contact.spread(&x, &mut start);
        let field = Field { pressure: start, displacement: u, drift };
        Ok((field, iterations))
    }
}

/// The greatest absolute value.
pub(crate) fn worst(residual: &[f64]) -> f64 {
    greatest(residual.len(), 0.0, |i| residual[i].abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::convolution::Convolution;
    use crate::kernel::KernelTable;
    use crate::{Boussinesq, Grid};

    /// Solves on all nodes of a small grid for a right-hand side that is the same everywhere.
    fn solve(rhs: f64, max_iterations: usize) -> Result<usize, Error> {
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
        };
        let equation =
            Equation { rhs: |_| rhs, tolerance: 1e-10, most_drift: f64::INFINITY, max_iterations };
        let nothing = Field::zero(grid.nodes());
        let start = nothing.pressure.clone();
        let solved =
            system.solve(&equation, start, Cow::Owned(nothing), &mut Directions::default());
        solved.map(|(_, iterations)| iterations)
    }

    #[test]
    fn a_residual_that_is_not_finite_is_an_error_at_once() {
        for rhs in [f64::INFINITY, f64::NAN] {
            let solved = solve(rhs, 100);
            assert!(
                matches!(solved, Err(Error::NoConvergence { iterations: 0, .. })),
                "{solved:?}"
            );
        }
    }

    #[test]
    fn iterations_are_limited() -> Result<(), Error> {
        for limit in [0, 1, 3] {
            let solved = solve(1.0, limit);
            assert!(
                matches!(solved, Err(Error::NoConvergence { iterations, .. }) if iterations == limit),
                "{solved:?}"
            );
        }
        assert!(solve(1.0, 100)? > 3);
        Ok(())
    }
}
