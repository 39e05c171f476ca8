//! What a driver has to say.

use std::error::Error;
use std::fmt;
use std::ops::AddAssign;

/// What a driver says of an input: what it has compared, or what is wrong.
pub type Verdict = Result<Tally, Violation>;

/// Something that the library must not do.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Violation(String);

impl Violation {
    /// Something wrong, in words.
    #[must_use]
    pub fn new(what: impl Into<String>) -> Self {
        Self(what.into())
    }

    /// The same with what was being done.
    pub(crate) fn during(self, context: impl fmt::Display) -> Self {
        Self(format!("{context}: {}", self.0))
    }
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl Error for Violation {}

/// Returns a violation if a condition does not hold.
macro_rules! ensure {
    ($condition:expr, $($message:tt)+) => {
        // NaN makes a comparison false, which is a violation as well.
        if $condition {
        } else {
            return Err($crate::verdict::Violation::new(format!($($message)+)));
        }
    };
}
pub(crate) use ensure;

/// What was compared without finding anything wrong.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Tally {
    /// States, solutions, surfaces and records that were compared with something independent.
    pub checked: usize,
    /// Refusals that the input deserved.
    pub refused: usize,
    /// Greatest error found, in units of what was allowed.
    pub worst: f64,
}

impl Tally {
    /// Nothing but a refusal.
    pub(crate) fn refusal() -> Self {
        Self { refused: 1, ..Self::default() }
    }

    /// `Ok` if two numbers differ by no more than is allowed.
    pub(crate) fn close(
        &mut self,
        what: &str,
        found: f64,
        expected: f64,
        allowed: f64,
    ) -> Result<(), Violation> {
        let error = (found - expected).abs();
        ensure!(
            error <= allowed,
            "{what} is {found:e}, but {expected:e} was expected: {error:e} off, where {allowed:e} is allowed"
        );
        self.measure(error, allowed);
        Ok(())
    }

    /// `Ok` if a number that must not be negative is so by no more than is allowed.
    pub(crate) fn not_negative(
        &mut self,
        what: &str,
        found: f64,
        allowed: f64,
    ) -> Result<(), Violation> {
        ensure!(found >= -allowed, "{what} is {found:e}, below zero by more than {allowed:e}");
        self.measure((-found).max(0.0), allowed);
        Ok(())
    }

    fn measure(&mut self, error: f64, allowed: f64) {
        if error > 0.0 {
            self.worst = self.worst.max(error / allowed);
        }
    }
}

impl AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.checked += other.checked;
        self.refused += other.refused;
        self.worst = self.worst.max(other.worst);
    }
}
