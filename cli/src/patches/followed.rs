//! The patches of a path from state to state.

use asperity::patches::{
    Connectivity, MergeTree, PatchHistory, PatchState, Percolation, contact_sequence,
};
use asperity::record::LoadingRecord;
use asperity::{ContactEvent, Error, LoadingState};

/// The patches of a path without nodes that leave.
pub(super) struct Followed {
    /// The states at which nodes touch.
    pub(super) touches: Vec<LoadingState>,
    /// One for each of them.
    pub(super) patches: Vec<PatchState>,
    pub(super) tree: MergeTree,
    pub(super) passages: [Passage; 4],
}

/// Something that happens once on a path, if it does.
pub(super) struct Passage {
    /// What holds from this state on, in few words.
    pub(super) name: &'static str,
    /// The same for programs.
    pub(super) key: &'static str,
    pub(super) state: Option<LoadingState>,
}

impl Followed {
    /// [`Error::NodeLeaves`] where there is no order of contact.
    pub(super) fn new(record: &LoadingRecord, connectivity: Connectivity) -> Result<Self, Error> {
        let events = record.states().iter();
        let events = events.map(|state| (state.event, state.node));
        let contact = contact_sequence(record.grid(), events)?;
        let boundary = record.kernel().boundary;
        let found = Percolation::of(&contact, boundary, connectivity);
        let touches = record.states().iter().filter(|state| state.event == ContactEvent::Touch);
        let touches: Vec<LoadingState> = touches.copied().collect();
        let at = |step: usize| touches.get(step.checked_sub(1)?).copied();
        let passage = |name, key, step: Option<usize>| {
            let state = step.and_then(at);
            Passage { name, key, state }
        };
        let passages = [
            passage("percolates along x", "percolates_x", found.contact_x),
            passage("percolates along y", "percolates_y", found.contact_y),
            passage("seals along x", "seals_x", found.leak_x),
            passage("seals along y", "seals_y", found.leak_y),
        ];
        Ok(Self {
            touches,
            patches: PatchHistory::new(&contact, boundary, connectivity).collect(),
            tree: MergeTree::new(&contact, boundary, connectivity),
            passages,
        })
    }
}
