//! The patches of a path from state to state.

use asperity::patches::{Connectivity, MergeTree, PatchHistory, PatchState};
use asperity::record::LoadingRecord;
use asperity::{ContactEvent, Error, LoadingState};

use crate::passages::{self, Passage};

/// The patches of a path without nodes that leave.
pub(super) struct Followed {
    /// The states at which nodes touch.
    pub(super) touches: Vec<LoadingState>,
    /// One for each of them.
    pub(super) patches: Vec<PatchState>,
    pub(super) tree: MergeTree,
    /// From end to end.
    pub(super) passages: [Passage<LoadingState>; 4],
    /// Around a grid that repeats.
    pub(super) around: Vec<Passage<LoadingState>>,
}

impl Followed {
    /// [`Error::NodeLeaves`] where there is no order of contact.
    pub(super) fn new(record: &LoadingRecord, connectivity: Connectivity) -> Result<Self, Error> {
        let contact = record.history().contact_sequence(record.grid())?;
        let boundary = record.kernel().boundary;
        let touches = record.states().iter().filter(|state| state.event == ContactEvent::Touch);
        let touches: Vec<LoadingState> = touches.copied().collect();
        let at = |step: usize| touches.get(step.checked_sub(1)?).copied();
        let passages = passages::from_end_to_end(&contact, boundary, connectivity, at);
        let around = passages::around(&contact, boundary, connectivity, at);
        Ok(Self {
            touches,
            patches: PatchHistory::new(&contact, boundary, connectivity).collect(),
            tree: MergeTree::new(&contact, boundary, connectivity),
            passages,
            around,
        })
    }
}
