//! Which errors an input deserves.

use asperity::{ContactGrowth, Error};

use crate::dense::Dense;
use crate::verdict::{Tally, Verdict, ensure};

/// What is known of a problem that ended with an error.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Circumstances {
    /// Roundings times the condition number: the error of a solution relative to itself. Infinite if the matrix is not
    /// positive definite.
    pub(crate) error: f64,
    pub(crate) growth: ContactGrowth,
    /// Whether memory was limited.
    pub(crate) budget: bool,
    /// What an iteration was asked for, if there is one: gaps in contact, relative to the approach.
    pub(crate) tolerance: Option<f64>,
    /// Nodes that touch or leave together at the last state.
    pub(crate) on_the_edge: usize,
}

impl Circumstances {
    /// Of a problem, with an exact solution wanted and no bound on memory.
    pub(crate) fn of(dense: &Dense, growth: ContactGrowth) -> Self {
        let condition = dense.condition().unwrap_or(f64::INFINITY);
        Self {
            error: condition * Dense::rounding(dense.nodes()),
            growth,
            budget: false,
            tolerance: None,
            on_the_edge: 0,
        }
    }

    /// Whether an error is deserved.
    pub(crate) fn deserve(&self, error: &Error) -> bool {
        match error {
            Error::MemoryBudget { .. } => self.budget,
            // A pivot is the least eigenvalue at best.
            Error::NotPositiveDefinite { .. } | Error::FactorizationFailed { .. } => {
                self.error > 1e-3
            }
            // The signs that are promised are looked at to 1e-9 or better.
            Error::NotMonotone { .. } => self.growth != ContactGrowth::Unknown && self.error > 1e-6,
            // States are recognised to 1e-6.
            Error::NotOnPath { .. } => self.error > 1e-6,
            Error::NoConvergence { .. } => self
                .tolerance
                .is_some_and(|tolerance| self.error > tolerance),
            Error::Cycling { .. } => self.growth == ContactGrowth::Unknown && self.on_the_edge > 1,
            _ => false,
        }
    }

    /// Whether an error is one that the library ought not to give, and that is known. To be deleted one by one as they are
    /// mended.
    pub(crate) fn is_known(&self, error: &Error) -> bool {
        let stepwise = self.growth == ContactGrowth::Unknown && self.tolerance.is_some();
        match error {
            // A path that goes one event at a time looks at pressures to 10⁻¹⁰ of the greatest one, whatever the updater:
            // iterations leave 10⁻¹⁰ of the approach in gaps, which is more of a pressure by the condition number.
            Error::NotMonotone { .. } => stepwise,
            // Behind other states iterations begin with numbers that single precision does not hold: from heights of 10³⁹ on.
            Error::NoConvergence { residual, .. } => stepwise && residual.is_nan(),
            Error::NotFinite { .. } => self.tolerance.is_some(),
            _ => false,
        }
    }

    /// The same of solutions for one load, with a load that was given or one that was searched for.
    pub(crate) fn is_known_of_fixed_loads(&self, error: &Error, searched: bool) -> bool {
        match error {
            // Searches for an area or a mean gap go from load to load, each from the solution before. Where nodes touch
            // together, on symmetric surfaces, such a start may end in no convergence; the same loads by themselves do not.
            Error::NoConvergence { residual, .. } => searched && residual.is_infinite(),
            // The kernel on a coarser grid of an odd number of nodes need not be positive definite where the kernel is.
            Error::FactorizationFailed { .. } => self.growth == ContactGrowth::Unknown,
            _ => false,
        }
    }

    /// `Ok` if an error is deserved, or known.
    pub(crate) fn judge(&self, error: &Error) -> Verdict {
        if self.deserve(error) {
            return Ok(Tally::refusal());
        }
        ensure!(self.is_known(error), "{self:?}: {error}");
        Ok(Tally::known_fault())
    }
}
