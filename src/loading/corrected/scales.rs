//! Lengths below which nothing is told apart.

use crate::loading::run::LoadingRun;
use crate::updater::LinearUpdater;

/// Events closer than this, relative to the approach, are ties: the lowest index comes first.
const TIE: f64 = 1e-9;
/// The same relative to the greatest initial gap: rounding of heights.
const ROUNDING: f64 = 1e-14;
/// Bounds of the tolerance of rates.
const RATE_TOLERANCE: [f64; 2] = [5e-7, 1e-5];
/// What the gap of a node that is not watched may be off by, over the tolerance.
const UNWATCHED: f64 = 100.0;

/// Lengths of a window.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scales {
    /// What errors are relative to: the approach at the window's beginning.
    pub(super) length: f64,
    /// Tolerance of the solutions, relative to it.
    pub(super) tolerance: f64,
    /// Events closer than this are ties.
    pub(super) tie: f64,
}

impl Scales {
    pub(super) fn of<U: LinearUpdater>(run: &LoadingRun<U>) -> Self {
        let approach = run.front.approach();
        let length = if approach > 0.0 {
            approach
        } else {
            run.problem.least_length()
        };
        Self {
            length,
            tolerance: run.updater.profile().tolerance,
            tie: (TIE * length).max(ROUNDING * run.problem.greatest_gap()),
        }
    }

    /// Difference of times below which a node that closes at a rate may be before or after another one, at the
    /// window's beginning.
    pub(super) fn tie_of(&self, closing: f64) -> f64 {
        let error = UNWATCHED * self.tolerance * self.length;
        self.tie.max(error / closing.max(1e-12))
    }

    /// Tolerance of rates that serve over a span.
    pub(super) fn rate_tolerance(&self, span: f64) -> f64 {
        let [least, most] = RATE_TOLERANCE;
        (self.tolerance * self.length / span.max(1e-12 * self.length)).clamp(least, most)
    }

    /// Overlap that a solution at an approach may leave, and the tension that goes with it times a
    /// compliance.
    pub(super) fn overlap(&self, approach: f64) -> f64 {
        UNWATCHED * self.tolerance * approach.max(self.length)
    }
}
