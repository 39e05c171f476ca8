//! What both branches are read for.

use asperity::adhesion::{AdhesiveEvent, AdhesiveState};

use super::course::Followed;

/// The extremes of both branches, of the last ones if there are more, and what they cost.
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
        let states = || loading.states().iter().chain(unloading.states());
        let lost = |state: Option<AdhesiveState>| state.map_or(0.0, |state| state.dissipated);
        let pressed = followed.pressed();
        // Unloading begins at the last state of loading, which may be pulled most.
        let unloading =
            pressed.iter().filter(|_| !unloading.states().is_empty()).chain(unloading.states());
        Self {
            pressed,
            pull_in: greatest_pull(loading.states().iter()),
            pull_off: greatest_pull(unloading),
            dissipated: lost(followed.states.last().copied()) - lost(followed.before_loading()),
            jumps: states().filter(|state| state.event == AdhesiveEvent::JumpEnd).count(),
        }
    }
}

/// The state of the least load.
fn greatest_pull<'a>(states: impl Iterator<Item = &'a AdhesiveState>) -> Option<AdhesiveState> {
    states.copied().min_by(|a, b| a.contact.load.total_cmp(&b.contact.load))
}

/// The pull of a state \[N\], 0 where nothing pulls.
pub(in super::super) fn pull(state: &AdhesiveState) -> f64 {
    (-state.contact.load).max(0.0)
}
