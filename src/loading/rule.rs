//! Which node touches next.

/// Which node is taken to touch next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ContactRule {
    /// The node whose gap closes first as the approach grows. Exact.
    #[default]
    FirstContact,
    /// The same, nearly: where the updater has no factor, windows are twice as long and nothing is settled
    /// inside them, which takes some 0.7 of the time. States at the ends of windows are exact, and so is the
    /// set of nodes in contact there; between them some thousandths of the nodes change places with a
    /// neighbour, whose approach is within some hundredths of the mean spacing of events.
    ApproximateOrder,
}
