//! How exact solutions have to be.

use super::tuning::{
    ADJOINT, DRIFT, LEAST_RATE_TOLERANCE, OF_LENGTH, OF_OPEN, OF_SPAN, RATE_DRIFT, RATE_TOLERANCE,
};

/// The purpose of a solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Aim {
    /// The gaps of proposed nodes, to this error \[m\]. No rate.
    Gaps(f64),
    /// A path that goes on with the solution over this span of the approach \[m\].
    Span(f64),
    /// The solution itself, as exact as iterations go.
    Exact,
}

impl Aim {
    /// How far the approach may go on with a solution.
    pub(super) fn span(self) -> f64 {
        match self {
            Self::Gaps(_) => 0.0,
            Self::Span(span) => span,
            Self::Exact => f64::INFINITY,
        }
    }
}

/// When iterations end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Criteria {
    /// Greatest residual of a gap in contact, relative to the approach.
    pub(super) tolerance: f64,
    pub(super) max_iterations: usize,
}

/// Greatest residuals of a solution.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tolerances {
    pub(super) load: f64,
    pub(super) rate: f64,
    /// Greatest error of both displacements by single precision: solutions inside the next window begin with
    /// them, and would all have to compute them afresh.
    pub(super) drift: [f64; 2],
}

impl Tolerances {
    /// For overlaps of up to `length`, and gaps that close at the rate `open` on average.
    pub(super) fn of(criteria: Criteria, aim: Aim, length: f64, open: f64) -> Self {
        let least = criteria.tolerance * length;
        match aim {
            Aim::Exact => {
                Self { load: least, rate: LEAST_RATE_TOLERANCE, drift: [f64::INFINITY; 2] }
            }
            Aim::Gaps(error) => Self {
                load: ADJOINT * error.max(least),
                rate: LEAST_RATE_TOLERANCE,
                drift: [f64::INFINITY; 2],
            },
            Aim::Span(span) => {
                let of_span = (OF_SPAN * span).min(OF_LENGTH * length);
                let of_length = ADJOINT * OF_LENGTH * length / span;
                let rate = RATE_TOLERANCE.min(OF_OPEN * open).min(of_length);
                let drift = DRIFT * ADJOINT * least;
                Self {
                    load: ADJOINT * of_span.max(least),
                    rate: rate.max(LEAST_RATE_TOLERANCE),
                    drift: [drift, RATE_DRIFT * drift / span],
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tolerances(aim: Aim, length: f64, open: f64) -> Tolerances {
        let criteria = Criteria { tolerance: 1e-10, max_iterations: 1 };
        Tolerances::of(criteria, aim, length, open)
    }

    fn check(found: Tolerances, load: f64, rate: f64, drift: [f64; 2]) {
        let pairs = [
            (found.load, load),
            (found.rate, rate),
            (found.drift[0], drift[0]),
            (found.drift[1], drift[1]),
        ];
        for (found, expected) in pairs {
            // Rounding errors of a few products.
            let same = found == expected || (found / expected - 1.0).abs() < 1e-14;
            assert!(same, "{found:e} {expected:e}");
        }
    }

    /// Each bound in turn is the tightest one; the numbers are worked out by hand.
    #[test]
    fn the_tightest_bound_counts() {
        let none = f64::INFINITY;
        // The solution itself: rounding.
        check(tolerances(Aim::Exact, 2.0, 0.5), 2e-10, 1e-11, [none; 2]);
        // Gaps, to the tolerance times 30 or an error times 30.
        check(tolerances(Aim::Gaps(0.0), 2.0, 0.5), 6e-9, 1e-11, [none; 2]);
        check(tolerances(Aim::Gaps(1e-6), 2.0, 0.5), 3e-5, 1e-11, [none; 2]);
        // A window of a hundredth of the length: 2e-6 of the span, and a quarter of 30 times the least.
        check(tolerances(Aim::Span(1e-2), 1.0, 0.5), 30.0 * 1e-8, 1.5e-5, [7.5e-10, 7.5e-9]);
        // A shorter one.
        check(tolerances(Aim::Span(1e-3), 1.0, 0.5), 30.0 * 2e-9, 1.5e-5, [7.5e-10, 7.5e-8]);
        // Gaps that hardly close: 1e-3 of the rate.
        check(tolerances(Aim::Span(1e-3), 1.0, 1e-3), 30.0 * 2e-9, 1e-6, [7.5e-10, 7.5e-8]);
        // A window that is long beside the length: 3e-7 of length over span.
        check(tolerances(Aim::Span(10.0), 0.1, 0.5), 30.0 * 1e-9, 3e-9, [7.5e-11, 7.5e-13]);
    }
}
