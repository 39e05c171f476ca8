//! A finished path as a record that can be read at any load, approach, area or mean gap.

use super::ContactState;

/// The states of a path in the order of loading, to be read at any instant between them.
///
/// Between two events a path is linear in the approach, so that every reading is exact. The
/// pressure that goes with it is
/// [`LoadingSolver::pressure_at`](super::LoadingSolver::pressure_at).
#[derive(Debug, Clone, Default)]
pub struct History {
    states: Vec<ContactState>,
}

impl FromIterator<ContactState> for History {
    fn from_iter<I: IntoIterator<Item = ContactState>>(states: I) -> Self {
        Self {
            states: states.into_iter().collect(),
        }
    }
}

impl History {
    /// The states, one for each event.
    #[must_use]
    pub fn states(&self) -> &[ContactState] {
        &self.states
    }

    /// The state at a load \[N\], `None` outside the path. Beyond the last event only a path that
    /// ended in full contact can be read.
    #[must_use]
    pub fn at_load(&self, load: f64) -> Option<ContactState> {
        let last = self.last_before(|state| state.load <= load, load)?;
        Some(last.at_load(load))
    }

    /// The state at an approach \[m\]; see [`Self::at_load`].
    #[must_use]
    pub fn at_approach(&self, approach: f64) -> Option<ContactState> {
        let last = self.last_before(|state| state.approach <= approach, approach)?;
        Some(last.at_approach(approach))
    }

    /// The state at a mean gap \[m\]; see [`Self::at_load`].
    #[must_use]
    pub fn at_mean_gap(&self, mean_gap: f64) -> Option<ContactState> {
        let last = self.last_before(|state| state.mean_gap >= mean_gap, mean_gap)?;
        Some(last.at_mean_gap(mean_gap))
    }

    /// The first state with at least this fraction of the nominal area in contact.
    #[must_use]
    pub fn at_area_fraction(&self, fraction: f64) -> Option<ContactState> {
        // Not a search by halves: area shrinks where a node leaves.
        let mut states = self.states.iter();
        let enough = |state: &&ContactState| state.contact_area_fraction >= fraction;
        states.find(enough).copied()
    }

    /// The last state that is not beyond the target.
    fn last_before(
        &self,
        reached: impl Fn(&ContactState) -> bool,
        target: f64,
    ) -> Option<&ContactState> {
        if target.is_nan() {
            return None;
        }
        let after = self.states.partition_point(reached);
        let last = self.states.get(after.checked_sub(1)?)?;
        let ended = after == self.states.len();
        let full = last.interfacial_stiffness.is_infinite();
        (!ended || full || target_is_state(last, target)).then_some(last)
    }
}

/// Whether the target is the state itself, which may be read even at the end of a path.
fn target_is_state(state: &ContactState, target: f64) -> bool {
    [state.load, state.approach, state.mean_gap].contains(&target)
}
