//! What the contact makes of the row sums of the influence matrix, for the rate of the mean gap.

use std::mem;

use super::equilibrium::Field;
use super::solver::{Equation, Solver};
use super::watched::Watched;
use crate::contact::ContactSequence;
use crate::krylov::{Directions, greatest};
use crate::{Error, Problem};

/// Residual of the row sums relative to the greatest one: what depends on them, the mean gap's rate, is
/// exact at the ends of windows anyway.
const SUMS_TOLERANCE: f64 = 1e-4;
/// Windows after which the row sums are solved for; in between they follow the contact by local solutions.
const SUMS_WINDOWS: usize = 3;
/// At lower mean closing rates, close to full contact, always: differences of row sums are all that is left.
const SUMS_OPEN: f64 = 0.03;
/// `C_II⁻¹ s_I` for the row sums s of C.
#[derive(Debug, Clone)]
pub(super) struct RowSums {
    /// On the first so many nodes.
    pub(super) count: usize,
    pub(super) field: Field,
    /// Windows since they were solved for.
    age: usize,
}

impl RowSums {
    /// Of which nothing but a start is known.
    pub(super) fn start(count: usize, field: Field) -> Self {
        Self {
            count,
            field,
            age: SUMS_WINDOWS,
        }
    }

    /// `C_II⁻¹ s_I` on the whole contact, unless it is known.
    /// `open` says what part of the grid still closes.
    pub(super) fn renew(
        &mut self,
        (solver, directions): (&mut Solver, &mut Directions),
        watched: &Watched,
        max_iterations: usize,
        problem: &Problem,
        contact: &ContactSequence,
        open: f64,
    ) -> Result<(), Error> {
        let Self { count, field, age } = &self;
        if *count == contact.len() && field.is_known() {
            return Ok(());
        }
        let sums = problem.row_sums();
        let joined = contact.order().get(*count..).unwrap_or_default();
        let start = watched.carried(field, joined, |node| sums[node]);
        let open = open.clamp(1e-6, 1.0);
        // Nodes that joined without being watched are not in the start.
        let follows = field.is_known() && watched.knows(joined);
        let (age, tolerance) = if follows && *age < SUMS_WINDOWS && open > SUMS_OPEN {
            (age + 1, f64::INFINITY)
        } else {
            let most = greatest(sums.len(), 0.0, |i| sums[i]);
            // What is explained already leaves less to be explained.
            (0, SUMS_TOLERANCE * most * open)
        };
        let equation = Equation {
            rhs: |node: usize| sums[node],
            tolerance,
            max_iterations,
        };
        let field = solver.solve(&equation, start, field, directions)?;
        *self = Self {
            count: contact.len(),
            field,
            age,
        };
        Ok(())
    }

    /// Keeps, as a start, what belongs to nodes that are left in contact.
    pub(super) fn keep(&mut self, left: &ContactSequence) {
        let mut field = mem::take(&mut self.field);
        field.keep(left);
        *self = Self::start(left.len(), field);
    }
}
