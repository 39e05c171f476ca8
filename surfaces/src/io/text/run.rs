//! Evenly spaced numbers: positions, or running numbers.

/// How far a position may be from even spacing, in spacings.
pub(super) const UNEVEN: f64 = 0.02;

/// Evenly spaced numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Run {
    start: f64,
    pub(super) step: f64,
    count: usize,
}

impl Run {
    /// Numbers that grow, or fall, by even steps; one is even.
    pub(super) fn of(numbers: &[f64], allowed: f64) -> Option<Self> {
        let is_whole = !numbers.is_empty() && numbers.iter().all(|number| number.is_finite());
        Self::with_gaps(numbers, allowed).filter(|_| is_whole)
    }

    /// The same, whatever is missing between them.
    pub(super) fn with_gaps(numbers: &[f64], allowed: f64) -> Option<Self> {
        let known = || numbers.iter().enumerate().filter(|(_, number)| number.is_finite());
        let ((first, start), (last, end)) = (known().next()?, known().next_back()?);
        let step = if last > first { (end - start) / (last - first) as f64 } else { 1.0 };
        let allowed = step.abs() * allowed;
        let is_even = |(k, number): (usize, &f64)| {
            (number - start - (k - first) as f64 * step).abs() <= allowed
        };
        let is_run = step.is_finite() && step != 0.0 && known().all(is_even);
        is_run.then_some(Self { start: *start, step, count: numbers.len() })
    }

    /// Whether it counts from 0 or 1.
    pub(super) fn counts(self) -> bool {
        self.step == 1.0 && (self.start == 0.0 || self.start == 1.0)
    }

    pub(super) fn told(self, line: &str, along: &str) -> String {
        let Self { start, step, count } = self;
        let end = start + step * (count - 1) as f64;
        let what = if self.counts() { "running numbers" } else { "positions" };
        format!(
            "the first {line} is evenly spaced from {start} to {end:.6}: {what} along {along}, no heights"
        )
    }
}
