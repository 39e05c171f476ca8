//! When contact percolates and when the last channel closes, in time.

use asperity::patches::{Connectivity, Percolation, contact_sequence};
use asperity::record::LoadingRecord;
use asperity::{ContactEvent, Error};

use super::followed::Followed;

/// Something that happens once as contact grows, if it does.
pub(super) struct Passage {
    /// What holds from then on, in few words.
    pub(super) name: &'static str,
    /// The same for programs.
    pub(super) key: &'static str,
    /// When it happens first \[s\].
    pub(super) time: Option<f64>,
}

impl Passage {
    /// In the order of contact of the path, with the times at which its states are reached.
    pub(super) fn all(
        record: &LoadingRecord,
        followed: &Followed,
        connectivity: Connectivity,
    ) -> Result<[Self; 4], Error> {
        let states = record.states();
        let events = states.iter().map(|state| (state.event, state.node));
        let contact = contact_sequence(record.grid(), events)?;
        let found = Percolation::of(&contact, record.kernel().boundary, connectivity);
        // The states at which nodes touch, among all.
        let touches = states.iter().enumerate();
        let touches = touches.filter(|(_, state)| state.event == ContactEvent::Touch);
        let touches: Vec<usize> = touches.map(|(k, _)| k).collect();
        let passage = |name, key, nodes: Option<usize>| {
            let knot = nodes.and_then(|nodes| touches.get(nodes.checked_sub(1)?));
            let time = knot.and_then(|knot| followed.times.get(*knot)).copied();
            Self { name, key, time }
        };
        Ok([
            passage("percolates along x", "percolates_x", found.contact_x),
            passage("percolates along y", "percolates_y", found.contact_y),
            passage("seals along x", "seals_x", found.leak_x),
            passage("seals along y", "seals_y", found.leak_y),
        ])
    }
}
