//! What both branches are read for.

use asperity::adhesion::{AdhesiveBranch, AdhesiveEvent, AdhesiveState};

use super::course::Followed;

/// The extremes of both branches, and what they cost.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Pulled {
    /// The last state of loading.
    pub(in super::super) pressed: Option<AdhesiveState>,
    /// The states of the greatest pull: on loading, and on unloading if there was any.
    pub(in super::super) pull_in: Option<AdhesiveState>,
    pub(in super::super) pull_off: Option<AdhesiveState>,
    /// On both branches \[J\].
    pub(in super::super) dissipated: f64,
    pub(in super::super) jumps: usize,
}

impl Pulled {
    pub(super) fn of(followed: &Followed) -> Self {
        let [loading, unloading] = followed.branches();
        let jumps = followed.states.iter();
        let jumps = jumps.filter(|state| state.event == AdhesiveEvent::JumpEnd).count();
        Self {
            pressed: followed.pressed(),
            pull_in: greatest_pull(&loading),
            // It begins at the last state of loading.
            pull_off: greatest_pull(&unloading),
            dissipated: followed.states.last().map_or(0.0, |state| state.dissipated),
            jumps,
        }
    }
}

/// The state of the least load.
fn greatest_pull(branch: &AdhesiveBranch) -> Option<AdhesiveState> {
    let states = branch.states().iter().copied();
    states.min_by(|a, b| a.contact.load.total_cmp(&b.contact.load))
}

/// The pull of a state \[N\], 0 where nothing pulls.
pub(in super::super) fn pull(state: &AdhesiveState) -> f64 {
    (-state.contact.load).max(0.0)
}
