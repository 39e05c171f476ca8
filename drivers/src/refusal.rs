//! Which errors an input deserves.

use asperity::updater::ConjugateGradient;
use asperity::{ContactGrowth, Error, UpdaterError};

use crate::dense::Dense;
use crate::verdict::{Tally, Verdict, ensure};

/// What is known of a problem that ended with an error.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Circumstances {
    /// Rounding errors times the condition number: the error of a solution relative to itself. Infinite if the matrix
    /// is not positive definite.
    pub(crate) error: f64,
    pub(crate) growth: ContactGrowth,
    /// Whether memory was limited.
    pub(crate) budget: bool,
    /// What an iteration was asked for, if there is one: gaps in contact, relative to the approach.
    pub(crate) tolerance: Option<f64>,
    /// Nodes that touch or leave together at the last state.
    pub(crate) on_the_edge: usize,
    /// Mean hardness of the nodes \[Pa\], infinite without one.
    pub(crate) bears: f64,
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
            bears: dense
                .hardness()
                .map_or(f64::INFINITY, |all| all.mean() / dense.own_pressure(1.0)),
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
            // The signs that are promised are looked at to 1e-9 or better. Where nothing is promised and the matrix is not
            // positive definite, or so nearly so that rounding is more than that, nodes that touch together may be pulled
            // whatever follows.
            Error::NotMonotone { .. } => match self.growth {
                ContactGrowth::Unknown => self.error > 1e-8 && self.on_the_edge > 1,
                _ => self.error > 1e-6,
            },
            // Contact is closed to 1e-10 of the lengths at ends of windows. Where nodes yield in them, up to 1.6 times
            // this error was left, in gauges of a thousand cells' own displacements.
            Error::Updater(UpdaterError::ContactNotClosed { .. }) => {
                self.growth != ContactGrowth::Unknown && self.error > 1e-11
            }
            // States are recognised to 1e-6.
            Error::NotOnPath { .. } => self.error > 1e-6,
            Error::NoConvergence { .. } => {
                self.tolerance.is_some_and(|tolerance| self.error > tolerance)
            }
            // Cells so long that paths need a factor.
            Error::OutOfRange { value, .. } => {
                self.tolerance.is_some() && *value > ConjugateGradient::MAX_ASPECT
            }
            // Sums of some hundred terms at most, which are rounded in another order.
            Error::BeyondHardness { mean_pressure, .. } => {
                *mean_pressure >= self.bears * (1.0 - 1e-13)
            }
            Error::Cycling { .. } => self.growth == ContactGrowth::Unknown && self.on_the_edge > 1,
            _ => false,
        }
    }

    /// `Ok` if an error is deserved.
    pub(crate) fn judge(&self, error: &Error) -> Verdict {
        ensure!(self.deserve(error), "{self:?}: {error}");
        Ok(Tally::refusal())
    }
}
