//! From when on something holds.

/// A time from which on something holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Onset {
    /// The time \[s\].
    pub(super) time: f64,
    /// Whether it begins at once, so that it holds just after this time already.
    pub(super) is_jump: bool,
}

impl Onset {
    /// Whether it holds just after a time.
    pub(super) fn has_begun(self, time: f64) -> bool {
        time > self.time || (self.is_jump && time == self.time)
    }
}
