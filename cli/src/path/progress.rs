//! How far a path is, in time.

use std::time::Duration;

use indicatif::HumanDuration;

/// Points of the sum over all events still to come.
const SAMPLES: usize = 200;
/// Before this there is nothing to go by.
const FIRST: Duration = Duration::from_secs(2);

/// What all events of a path to so many nodes cost, if one with n nodes in contact costs `cost(n)`.
pub(super) fn total(nodes: f64, cost: impl Fn(usize) -> f64) -> f64 {
    let step = nodes / SAMPLES as f64;
    let at = (0..SAMPLES).map(|k| cost(((k as f64 + 0.5) * step) as usize));
    at.sum::<f64>() * step
}

/// How far a path is.
pub(super) struct Progress {
    /// The part of its time that is over.
    pub(super) done: f64,
}

impl Progress {
    /// With so many nodes in contact, which are the part `share` of those at the end, if an event costs
    /// `cost(nodes)` in some unit of time.
    pub(super) fn new(nodes: usize, share: f64, cost: impl Fn(usize) -> f64) -> Self {
        let end = nodes as f64 / share.max(1e-6);
        let done = total(nodes as f64, &cost) / total(end, &cost);
        Self { done: if done.is_finite() { done } else { 0.0 } }
    }

    /// On the way back from `most` nodes in contact to none.
    pub(super) fn back(nodes: usize, most: usize, cost: impl Fn(usize) -> f64) -> Self {
        let left = total(nodes as f64, &cost) / total(most as f64, &cost);
        Self { done: if left.is_finite() { (1.0 - left).max(0.0) } else { 0.0 } }
    }

    /// How long it will still take, in words, after so much time.
    pub(super) fn left(&self, elapsed: Duration) -> String {
        let left = elapsed.as_secs_f64() * (1.0 / self.done.max(1e-6) - 1.0);
        match Duration::try_from_secs_f64(left) {
            Ok(left) if elapsed >= FIRST => format!(", {} left", HumanDuration(left)),
            _ => String::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_is_that_of_the_events_to_come() {
        // All events cost the same: half of the nodes are half of the time.
        let same = Progress::new(500, 0.5, |_| 1.0);
        assert!((same.done - 0.5).abs() < 1e-3);
        // n² each: an eighth.
        let square = Progress::new(5000, 0.5, |n| (n as f64).powi(2));
        assert!((square.done - 0.125).abs() < 1e-3);
        assert_eq!(square.left(Duration::from_secs(1)), "");
        assert_eq!(square.left(Duration::from_secs(10)), ", 70 seconds left");
    }

    #[test]
    fn nothing_done_is_nothing() {
        assert_eq!(Progress::new(0, 0.0, |_| 1.0).done, 0.0);
    }
}
