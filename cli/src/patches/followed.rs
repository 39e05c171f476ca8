//! The patches of a path from state to state.

use asperity::patches::{
    Connectivity, MergeTree, PatchHistory, PatchState, Percolation, contact_sequence,
};
use asperity::record::LoadingRecord;
use asperity::{Error, LoadingState};

/// The patches of a path without nodes that leave.
pub(super) struct Followed {
    /// One for each event, which are the first states of the record.
    pub(super) patches: Vec<PatchState>,
    pub(super) tree: MergeTree,
    pub(super) passages: [Passage; 4],
}

/// Something that happens once on a path, if it does.
pub(super) struct Passage {
    /// What holds from this state on, in few words.
    pub(super) name: &'static str,
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
        let at = |step: usize| record.history().events().get(step.checked_sub(1)?).copied();
        let passage = |name, step: Option<usize>| Passage { name, state: step.and_then(at) };
        Ok(Self {
            patches: PatchHistory::new(&contact, boundary, connectivity).collect(),
            tree: MergeTree::new(&contact, boundary, connectivity),
            passages: [
                passage("percolates along x", found.contact_x),
                passage("percolates along y", found.contact_y),
                passage("seals along x", found.leak_x),
                passage("seals along y", found.leak_y),
            ],
        })
    }
}
