//! Lengths below which two events are a tie.

use super::gap_field::GapLine;
use super::run::LoadingRun;
use super::tuning::{EXACT_TIE, OF_GAP, RATE_TOLERANCE, ROUNDING, TIE, UNWATCHED};

/// The approach up to which events tie with one at `approach`, with an exact updater.
pub(super) fn ties_until(approach: f64) -> f64 {
    approach + EXACT_TIE * approach
}

/// When a gap that closes from an approach on falls to a tie, with an exact updater. Rounding leaves a part of the
/// approach in a gap; the time at which a gap that closes slowly is zero may be off by far more.
pub(super) fn ties_from(approach: f64, line: GapLine) -> f64 {
    if line.closing > 0.0 {
        (line.gap - EXACT_TIE * approach) / (line.closing + EXACT_TIE)
    } else {
        f64::INFINITY
    }
}

/// Errors of the lengths in a window, with solutions of a tolerance.
#[derive(Debug, Clone, Copy)]
pub(super) struct WindowTolerances {
    /// The length that errors are relative to: the approach at the window's beginning, or a part of the mean gap if
    /// that is greater.
    pub(super) length: f64,
    /// Tolerance of the solutions, relative to it; 0 if the updater is exact to rounding.
    pub(super) tolerance: f64,
    /// Events closer than this are ties.
    pub(super) tie: f64,
}

impl WindowTolerances {
    /// At the present approach, of solutions that leave gaps of `tolerance` in contact, relative to the approach.
    pub(super) fn of(run: &LoadingRun, tolerance: f64) -> Self {
        let length = run.scalars.approach().max(run.problem.least_length());
        Self { length, tolerance, tie: (TIE * length).max(ROUNDING * run.problem.greatest_gap()) }
    }

    /// Difference of times below which a node that closes at a rate may be before or after another one, at the
    /// window's beginning.
    pub(super) fn tie_of(&self, closing: f64) -> f64 {
        let error = UNWATCHED * self.tolerance * self.length;
        self.tie.max(error / closing.max(1e-12))
    }

    /// Error of the time at which a node that closes at a rate touches, by the error of its gap at the window's
    /// beginning.
    pub(super) fn time_of_gap(&self, closing: f64) -> f64 {
        OF_GAP * self.tolerance * self.length / closing.max(1e-12)
    }

    /// Tolerance of rates that serve over a span.
    pub(super) fn rate_tolerance(&self, span: f64) -> f64 {
        let [least, most] = RATE_TOLERANCE;
        (self.tolerance * self.length / span.max(1e-12 * self.length)).clamp(least, most)
    }

    /// Overlap that a solution at an approach may leave, the tension that goes with it times a compliance, and what
    /// an approach may be off by, times the closing rate of the gap that closes there.
    pub(super) fn overlap(&self, approach: f64) -> f64 {
        UNWATCHED * self.tolerance * approach.max(self.length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The slower a gap closes, the later it may by its error; but never less than a tie, and no slower than
    /// rounding tells. Lengths scale with their unit, and rates do not.
    #[test]
    fn errors_of_gaps_become_errors_of_times() {
        for unit in [1.0, 1e-9] {
            let tolerances =
                WindowTolerances { length: 2.0 * unit, tolerance: 1e-10, tie: 1e-9 * unit };
            // 100 · 1e-10 · 2 over the rate.
            for (closing, time) in [(1.0, 2e-8), (0.25, 8e-8), (100.0, 1e-9), (0.0, 2e4)] {
                let found = tolerances.tie_of(closing) / unit;
                assert!((found / time - 1.0).abs() < 1e-12, "{closing}: {found:e}");
            }
            // 30 · 1e-10 · 2 over the rate.
            let found = tolerances.time_of_gap(0.25) / unit;
            assert!((found / 2.4e-8 - 1.0).abs() < 1e-12, "{found:e}");
            // Solutions over a span: 1e-10 · 2 / span, between its bounds.
            for (span, rate) in [(1e-4, 2e-6), (1.0, 5e-7), (0.0, 1e-5)] {
                let found = tolerances.rate_tolerance(span * unit);
                assert!((found / rate - 1.0).abs() < 1e-12, "{span}: {found:e}");
            }
            for (approach, overlap) in [(1.0, 2e-8), (3.0, 3e-8)] {
                let found = tolerances.overlap(approach * unit) / unit;
                assert!((found / overlap - 1.0).abs() < 1e-12, "{approach}: {found:e}");
            }
        }
    }
}
