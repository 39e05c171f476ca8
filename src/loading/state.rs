//! A state of a path, and what happened there.

use crate::contact::ContactState;

/// The event at a state of a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum ContactEvent {
    /// The gap of a node has closed, and it joins the contact.
    Touch,
    /// The pressure of a node has fallen to zero, and it leaves the contact. Of the kernels of
    /// this crate stiff coats let it happen; see [`ContactGrowth`](crate::ContactGrowth).
    Release,
    /// The pressure of a node has risen to its [hardness](super::LoadingBuilder::hardness), and it yields for good. It
    /// stays in contact.
    Yield,
    /// Nothing: the path has reached the load, approach or mean gap at which it was to end.
    Limit,
}

impl ContactEvent {
    /// All events, each at the place of its number in records.
    pub const ALL: [Self; 4] = [Self::Touch, Self::Release, Self::Limit, Self::Yield];

    /// Its number in records.
    #[must_use]
    pub fn code(self) -> u8 {
        match self {
            Self::Touch => 0,
            Self::Release => 1,
            Self::Limit => 2,
            Self::Yield => 3,
        }
    }

    /// Its name in files and tables: `touch` for [`Self::Touch`].
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Touch => "touch",
            Self::Release => "release",
            Self::Limit => "limit",
            Self::Yield => "yield",
        }
    }
}

/// A state of a path: the instant of an event, with the event already done.
///
/// The node that touches or leaves has no pressure at that instant; one that yields has its hardness, and no plastic
/// depth yet. Load, approach, area and the other scalars are those of the contact: `state.contact.load`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct LoadingState {
    /// Number of events up to here, 1 for first touch. Where no node ever leaves the contact it is the
    /// number of nodes in contact too.
    pub step: usize,
    /// The event.
    pub event: ContactEvent,
    /// The node to which it happens, (ix, iy); at a limit the node of the last event.
    pub node: (usize, usize),
    /// Estimated error of the approach \[m\], as the state has it: 0 where events are exact to rounding. See
    /// [`loading`](crate::loading) for what it covers.
    pub approach_error: f64,
    /// The scalars of the contact.
    pub contact: ContactState,
}

impl LoadingState {
    /// A state from data, of the user's own file for example.
    #[must_use]
    pub fn new(
        step: usize,
        event: ContactEvent,
        node: (usize, usize),
        contact: ContactState,
    ) -> Self {
        Self { step, event, node, approach_error: 0.0, contact }
    }

    /// The same nodes in contact with other scalars.
    pub(super) fn with(self, contact: ContactState) -> Self {
        Self { contact, ..self }
    }

    /// The state at a limit, if that is not the state itself.
    pub(super) fn at_limit(self, contact: ContactState) -> Option<Self> {
        (contact != self.contact).then_some(Self { event: ContactEvent::Limit, contact, ..self })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn events_are_at_the_places_of_their_numbers() {
        for (place, event) in ContactEvent::ALL.into_iter().enumerate() {
            assert_eq!(usize::from(event.code()), place, "{}", event.name());
        }
    }
}
