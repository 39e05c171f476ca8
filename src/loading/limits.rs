//! Where a path ends, and why.

use super::state::LoadingState;
use crate::contact::ContactTarget;
use crate::{Error, Grid};

/// Why a path has ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum LoadingEnd {
    /// All nodes are in contact: from here on everything is linear in the load.
    FullContact,
    /// The greatest load, or mean pressure; the last state is at exactly this load.
    Load,
    /// The greatest approach; the last state is at exactly this approach.
    Approach,
    /// The least mean gap; the last state is at exactly this mean gap.
    MeanGap,
    /// One more node would exceed the greatest contact area fraction.
    AreaFraction,
    /// One more node would exceed the greatest number of nodes.
    Nodes,
    /// One more node would exceed the memory budget; the last item was the error that says so.
    Memory,
    /// No gap closes any more and no pressure falls, although not all nodes are in contact. It never
    /// happens with the kernels of this crate.
    NoMoreEvents,
    /// The last item was an error.
    Failed,
}

/// What the user asked for: the path ends before the first state that exceeds any of these.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Limits {
    pub(super) nodes: usize,
    area_nodes: usize,
    load: f64,
    approach: f64,
    least_mean_gap: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            nodes: usize::MAX,
            area_nodes: usize::MAX,
            load: f64::INFINITY,
            approach: f64::INFINITY,
            least_mean_gap: f64::NEG_INFINITY,
        }
    }
}

impl Limits {
    /// At most so many nodes in contact.
    pub(super) fn set_nodes(&mut self, nodes: usize) -> Result<(), Error> {
        if nodes == 0 {
            return Err(Error::OutOfRange {
                quantity: "greatest number of contact nodes",
                value: 0.0,
                expected: "at least 1",
            });
        }
        self.nodes = self.nodes.min(nodes);
        Ok(())
    }

    /// No state beyond this one, on a grid and with a mean gap before first touch.
    pub(super) fn set(
        &mut self,
        target: ContactTarget,
        grid: &Grid,
        unloaded: f64,
    ) -> Result<(), Error> {
        match target {
            ContactTarget::Load(load) => {
                self.load = Error::require_positive("greatest load", load)?;
            }
            ContactTarget::Approach(approach) => {
                self.approach = Error::require_positive("greatest approach", approach)?;
            }
            ContactTarget::AreaFraction(fraction) => self.area_nodes = grid.nodes_in(fraction)?,
            ContactTarget::MeanGap(mean_gap) => {
                if !(mean_gap >= 0.0 && mean_gap < unloaded) {
                    return Err(Error::OutOfRange {
                        quantity: "least mean gap",
                        value: mean_gap,
                        expected: "not negative, and below the mean gap of surfaces that just touch",
                    });
                }
                self.least_mean_gap = mean_gap;
            }
        }
        Ok(())
    }

    /// Whether there is a limit of load, approach or mean gap.
    pub(super) fn ends_before_full_contact(&self) -> bool {
        self.load < f64::INFINITY || self.approach < f64::INFINITY || self.least_mean_gap > 0.0
    }

    /// The same as targets, on a grid.
    pub(super) fn targets(&self, grid: &Grid) -> Vec<ContactTarget> {
        let most = self.most_nodes();
        let fraction = most as f64 / grid.nodes() as f64;
        let given = [
            (self.load < f64::INFINITY).then_some(ContactTarget::Load(self.load)),
            (self.approach < f64::INFINITY).then_some(ContactTarget::Approach(self.approach)),
            (self.least_mean_gap >= 0.0).then_some(ContactTarget::MeanGap(self.least_mean_gap)),
            (most <= grid.nodes()).then_some(ContactTarget::AreaFraction(fraction)),
        ];
        given.into_iter().flatten().collect()
    }

    /// The greatest number of nodes in contact.
    pub(super) fn most_nodes(&self) -> usize {
        self.nodes.min(self.area_nodes)
    }

    /// Why so many nodes in contact are enough, if they are.
    pub(super) fn enough(&self, nodes: usize) -> Option<LoadingEnd> {
        if nodes >= self.area_nodes {
            Some(LoadingEnd::AreaFraction)
        } else if nodes >= self.nodes {
            Some(LoadingEnd::Nodes)
        } else {
            None
        }
    }

    /// Why the path ends between two states, if it does, and the state at the limit, if that is not the
    /// earlier one.
    pub(super) fn between(
        &self,
        last: Option<LoadingState>,
        next: &LoadingState,
    ) -> Option<(LoadingEnd, Option<LoadingState>)> {
        let last = last?;
        let exceeded = [
            (
                LoadingEnd::Load,
                next.load > self.load,
                last.contact.at_load(self.load),
            ),
            (
                LoadingEnd::Approach,
                next.approach > self.approach,
                last.contact.at_approach(self.approach),
            ),
            (
                LoadingEnd::MeanGap,
                next.mean_gap < self.least_mean_gap,
                last.contact.at_mean_gap(self.least_mean_gap),
            ),
        ];
        let exceeded = exceeded.into_iter().filter(|(_, exceeded, _)| *exceeded);
        let first = exceeded
            .filter_map(|(end, _, state)| Some((end, state?)))
            .min_by(|(_, a), (_, b)| a.load.total_cmp(&b.load));
        if let Some((end, state)) = first {
            return Some((end, last.at_limit(state)));
        }
        let beyond = next.contact_nodes > last.contact_nodes;
        let end = beyond.then(|| self.enough(last.contact_nodes)).flatten();
        end.map(|end| (end, None))
    }
}
