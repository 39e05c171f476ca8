//! Where a path ends, and why.

use super::state::{ContactEvent, LoadingState};
use crate::contact::{ContactState, ContactTarget};
use crate::hardness::Hardness;
use crate::{Error, Grid};

/// Why a path has ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum LoadingEnd {
    /// All nodes are in contact, and from here on everything is linear in the load. With a hardness only if that of the
    /// nodes that have not yielded is infinite.
    FullContact,
    /// All nodes have yielded: the load is the hardness times the nominal area, and cannot grow.
    FullyPlastic,
    /// The greatest load, or mean pressure; the last state is at exactly this load.
    Load,
    /// The greatest approach; the last state is at exactly this approach.
    Approach,
    /// The least mean gap; the last state is at exactly this mean gap.
    MeanGap,
    /// One more node would exceed the greatest contact area fraction, or the next event is a yield.
    AreaFraction,
    /// One more node would exceed the greatest number of nodes, or the next event is a yield.
    Nodes,
    /// One more node would exceed the memory budget; the last item was the error that says so.
    Memory,
    /// No gap closes any more and no pressure falls, although not all nodes are in contact. Of the
    /// kernels of this crate stiff coats with a free boundary let it happen.
    NoMoreEvents,
    /// The last item was an error.
    Failed,
}

/// What the user asked for: the path ends before the first state that exceeds any of these.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Limits {
    pub(super) nodes: usize,
    area_nodes: usize,
    /// The fraction of the nominal area that was asked for, in which `area_nodes` fit.
    area_fraction: f64,
    load: f64,
    approach: f64,
    least_mean_gap: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            nodes: usize::MAX,
            area_nodes: usize::MAX,
            area_fraction: f64::INFINITY,
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
                self.load = self.load.min(Error::require_positive("greatest load", load)?);
            }
            ContactTarget::MeanPressure(mean_pressure) => {
                let mean_pressure =
                    Error::require_positive("greatest mean pressure", mean_pressure)?;
                let load = ContactTarget::Load(mean_pressure * grid.nominal_area());
                self.set(load, grid, unloaded)?;
            }
            ContactTarget::Approach(approach) => {
                let approach = Error::require_positive("greatest approach", approach)?;
                self.approach = self.approach.min(approach);
            }
            ContactTarget::AreaFraction(fraction) => {
                self.area_nodes = self.area_nodes.min(grid.nodes_in(fraction)?);
                self.area_fraction = self.area_fraction.min(fraction);
            }
            ContactTarget::MeanGap(mean_gap) => {
                if !(mean_gap >= 0.0 && mean_gap < unloaded) {
                    return Err(Error::OutOfRange {
                        quantity: "least mean gap",
                        value: mean_gap,
                        expected: "not negative, and below the mean gap of surfaces that just touch",
                    });
                }
                self.least_mean_gap = self.least_mean_gap.max(mean_gap);
            }
        }
        Ok(())
    }

    /// `Ok` unless the greatest load is one under which all nodes would yield.
    pub(super) fn check_hardness(&self, hardness: &Hardness, grid: &Grid) -> Result<(), Error> {
        if self.load == f64::INFINITY { Ok(()) } else { hardness.check(self.load, grid) }
    }

    /// `Ok` if a path that has got to a state has not passed any of the limits. It may be at one already, unless it is
    /// to go on.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] with the first that it has passed.
    pub(super) fn check_ahead(&self, state: &LoadingState, goes_on: bool) -> Result<(), Error> {
        let most = self.most_nodes();
        // What is asked for, and the way there.
        let targets = [
            ("load at which the path ends", self.load, self.load - state.contact.load),
            (
                "approach at which the path ends",
                self.approach,
                self.approach - state.contact.approach,
            ),
            (
                "mean gap at which the path ends",
                self.least_mean_gap,
                state.contact.mean_gap - self.least_mean_gap,
            ),
            (
                "number of contact nodes at which the path ends",
                most as f64,
                most as f64 - state.contact.contact_nodes as f64,
            ),
        ];
        let is_passed = |way: f64| way < 0.0 || (goes_on && way == 0.0);
        match targets.into_iter().find(|(.., way)| is_passed(*way)) {
            None => Ok(()),
            Some((quantity, value, _)) => {
                Err(Error::OutOfRange { quantity, value, expected: "beyond the present state" })
            }
        }
    }

    /// Whether there is a limit of load, approach or mean gap.
    pub(super) fn ends_before_full_contact(&self) -> bool {
        self.load < f64::INFINITY || self.approach < f64::INFINITY || self.least_mean_gap > 0.0
    }

    /// The same as targets, on a grid.
    pub(super) fn targets(&self, grid: &Grid) -> Vec<ContactTarget> {
        let most = self.most_nodes();
        let fraction = if self.area_nodes <= self.nodes {
            self.area_fraction
        } else {
            self.nodes as f64 / grid.nodes() as f64
        };
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

    /// About how many of the `nodes` of the grid are in contact at the end, as far as a state tells: rather too many.
    /// Contact grows no faster than the load, and the load by no greater part of itself for each step of the approach,
    /// or of the mean gap, than now.
    pub(super) fn expected_nodes(&self, nodes: usize, state: Option<ContactState>) -> usize {
        let most = self.most_nodes().min(nodes);
        let Some(state) = state.filter(|state| state.load > 0.0) else {
            return most;
        };
        let over = |stiffness: Option<f64>, way: f64| {
            // In full contact the mean gap has no way to go, and its stiffness is infinite.
            let grown =
                stiffness.map_or(f64::INFINITY, |stiffness| (stiffness * way / state.load).exp());
            if grown.is_nan() { f64::INFINITY } else { grown }
        };
        let growth = (self.load / state.load)
            .min(over(state.contact_stiffness, self.approach - state.approach))
            .min(over(state.interfacial_stiffness, state.mean_gap - self.least_mean_gap));
        // Beyond usize it is usize::MAX.
        most.min((state.contact_nodes as f64 * growth.max(1.0)).ceil() as usize)
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
        // What comes next is one more node, or a yield behind the last one.
        let beyond = next.event != ContactEvent::Release;
        if let Some(end) = beyond.then(|| self.enough(last.contact.contact_nodes)).flatten() {
            return Some((end, None));
        }
        let (end, state) = self.first_exceeded(&last.contact, Some(&next.contact))?;
        Some((end, last.at_limit(state)))
    }

    /// The same behind the last event that there is, from where on everything is linear, and no gap closes.
    pub(super) fn behind(&self, last: LoadingState) -> Option<(LoadingEnd, Option<LoadingState>)> {
        let (end, state) = self.first_exceeded(&last.contact, None)?;
        Some((end, last.at_limit(state)))
    }

    /// The first limit of load, approach or mean gap from a state to the next, which may be none.
    fn first_exceeded(
        &self,
        last: &ContactState,
        next: Option<&ContactState>,
    ) -> Option<(LoadingEnd, ContactState)> {
        let is_full = last.contact_area_fraction == 1.0;
        let exceeded = [
            (
                LoadingEnd::Load,
                // On a plateau the load is reached where that begins.
                next.map_or(self.load < f64::INFINITY, |next| next.load > self.load)
                    || (last.load == self.load && last.is_plateau()),
                last.at_load(self.load),
            ),
            (
                LoadingEnd::Approach,
                next.map_or(self.approach < f64::INFINITY, |next| next.approach > self.approach),
                // In full contact mean planes come no closer until a node yields: only errors of states pass the limit.
                last.at_approach(self.approach)
                    .or_else(|| next.map(|_| ContactState { approach: self.approach, ..*last })),
            ),
            (
                LoadingEnd::MeanGap,
                // In full contact there is none left, and nodes may go on to yield.
                next.is_some_and(|next| next.mean_gap < self.least_mean_gap)
                    || (is_full && last.mean_gap == self.least_mean_gap),
                last.at_mean_gap(self.least_mean_gap),
            ),
        ];
        let exceeded = exceeded.into_iter().filter(|(_, exceeded, _)| *exceeded);
        let is_ahead = |state: &ContactState| {
            next.is_some() || (state.load >= last.load && state.approach >= last.approach)
        };
        exceeded
            .filter_map(|(end, _, state)| Some((end, state.filter(is_ahead)?)))
            .min_by(|(_, a), (_, b)| a.order(b))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::ContactState;

    fn grid() -> Result<Grid, Error> {
        Ok(Grid::new(5, 4, 1.0, 2.0)?)
    }

    /// Limits on surfaces that just touch with a mean gap of 3.
    fn limits(targets: &[ContactTarget]) -> Result<Limits, Error> {
        let mut limits = Limits::default();
        for target in targets {
            limits.set(*target, &grid()?, 3.0)?;
        }
        Ok(limits)
    }

    /// A state from which load, approach and mean gap change by 4, 1 and 2 each.
    fn state(contact_nodes: usize, load: f64) -> Result<LoadingState, Error> {
        let contact = ContactState {
            contact_stiffness: Some(4.0),
            interfacial_stiffness: Some(2.0),
            ..ContactState::new(&grid()?, contact_nodes, load / 4.0, load, 3.0 - load / 2.0)
        };
        Ok(LoadingState::new(contact_nodes, ContactEvent::Touch, (0, 0), contact))
    }

    #[test]
    fn limits_that_make_no_sense_are_refused() {
        let mean_gap = |gap| limits(&[ContactTarget::MeanGap(gap)]).is_ok();
        assert_eq!(
            [-0.1, 0.0, 2.9, 3.0, f64::NAN].map(mean_gap),
            [false, true, true, false, false]
        );
        for value in [0.0, -1.0, f64::NAN] {
            assert!(limits(&[ContactTarget::Load(value)]).is_err());
            assert!(limits(&[ContactTarget::Approach(value)]).is_err());
        }
        let mut limits = Limits::default();
        assert!(limits.set_nodes(0).is_err() && limits.set_nodes(1).is_ok());
    }

    #[test]
    fn each_kind_of_limit_counts() -> Result<(), Error> {
        use ContactTarget::{Approach, AreaFraction, Load, MeanGap};
        for (target, is_before_full) in [
            (Load(1.0), true),
            (Approach(1.0), true),
            (MeanGap(1.0), true),
            // Full contact is where the mean gap is nothing.
            (MeanGap(0.0), false),
            (AreaFraction(0.5), false),
        ] {
            let limits = limits(&[target])?;
            assert_eq!(limits.ends_before_full_contact(), is_before_full, "{target:?}");
            assert_eq!(limits.targets(&grid()?), [target]);
        }
        assert!(limits(&[])?.targets(&grid()?).is_empty());
        Ok(())
    }

    /// 0.25 of 20 nodes, and 7 or 3 of them.
    #[test]
    fn the_fewest_nodes_count() -> Result<(), Error> {
        let area = ContactTarget::AreaFraction(0.25);
        for (nodes, most, end) in [
            (7, 5, LoadingEnd::AreaFraction),
            (5, 5, LoadingEnd::AreaFraction),
            (3, 3, LoadingEnd::Nodes),
        ] {
            let mut limits = limits(&[area])?;
            limits.set_nodes(nodes)?;
            limits.set_nodes(9)?;
            assert_eq!(limits.most_nodes(), most);
            assert_eq!([most - 1, most].map(|nodes| limits.enough(nodes)), [None, Some(end)]);
            let fraction = most as f64 / 20.0;
            assert_eq!(limits.targets(&grid()?), [ContactTarget::AreaFraction(fraction)]);
            // Between two states, unless a node leaves.
            let between = |event, nodes| -> Result<_, Error> {
                let next = LoadingState { event, ..state(nodes, 8.0)? };
                Ok(limits.between(Some(state(most, 4.0)?), &next))
            };
            assert_eq!(between(ContactEvent::Touch, most + 1)?, Some((end, None)));
            assert_eq!(between(ContactEvent::Yield, most)?, Some((end, None)));
            assert_eq!(between(ContactEvent::Release, most - 1)?, None);
        }
        let mut whole = Limits::default();
        whole.set_nodes(20)?;
        assert_eq!(whole.targets(&grid()?), [ContactTarget::AreaFraction(1.0)]);
        whole = Limits::default();
        whole.set_nodes(21)?;
        assert!(whole.targets(&grid()?).is_empty());
        Ok(())
    }

    /// Two nodes of twenty under a load of 4, at an approach of 1 with a stiffness of 4, and at a mean gap of 1 with
    /// one of 2.
    #[test]
    fn the_end_is_known_or_bounded() -> Result<(), Error> {
        use ContactTarget::{Approach, AreaFraction, Load, MeanGap};
        let contact = state(2, 4.0)?.contact;
        for (targets, nodes) in [
            (&[][..], 20),
            (&[AreaFraction(0.25)], 5),
            (&[Load(12.0)], 6),
            (&[Load(13.0)], 7),
            (&[Load(4.0)], 2),
            (&[Load(1e300)], 20),
            // 2 exp(4 · 1 / 4) = 5.4, and 2 exp(2 · 1 / 4) = 3.3.
            (&[Approach(2.0)], 6),
            (&[Approach(1e9)], 20),
            (&[MeanGap(0.0)], 4),
            (&[Load(12.0), Approach(2.0), MeanGap(0.0), AreaFraction(0.25)], 4),
            (&[AreaFraction(0.15), Load(12.0)], 3),
        ] {
            let limits = limits(targets)?;
            assert_eq!(limits.expected_nodes(20, Some(contact)), nodes, "{targets:?}");
        }
        // Nothing is known before first touch, or without a stiffness.
        let limits = limits(&[Load(12.0), Approach(2.0)])?;
        let full = ContactState { interfacial_stiffness: Some(f64::INFINITY), ..contact };
        let unknown = ContactState { contact_stiffness: None, load: 0.0, ..contact };
        assert_eq!(limits.expected_nodes(20, None), 20);
        assert_eq!(limits.expected_nodes(20, Some(full)), 6);
        assert_eq!(limits.expected_nodes(20, Some(unknown)), 20);
        Ok(())
    }

    /// From a load of 4 to 8, an approach of 1 to 2 and a mean gap of 1 to −1: what is reached first, at its state.
    #[test]
    fn paths_end_between_two_states() -> Result<(), Error> {
        use ContactTarget::{Approach, Load, MeanGap};
        let (last, next) = (state(1, 4.0)?, state(2, 8.0)?);
        for (targets, end, load) in [
            (&[Load(5.0)][..], LoadingEnd::Load, 5.0),
            (&[Approach(1.5)], LoadingEnd::Approach, 6.0),
            (&[MeanGap(0.5)], LoadingEnd::MeanGap, 5.0),
            (&[Load(7.0), Approach(1.5), MeanGap(0.25)], LoadingEnd::MeanGap, 5.5),
            (&[Load(7.0), Approach(1.5)], LoadingEnd::Approach, 6.0),
        ] {
            let (found, at_limit) = limits(targets)?.between(Some(last), &next).unzip();
            assert_eq!(found, Some(end));
            let at_limit = at_limit.flatten().map(|state| (state.event, state.contact.load));
            assert_eq!(at_limit, Some((ContactEvent::Limit, load)));
        }
        // Enough nodes are there before whatever comes behind them.
        let area = ContactTarget::AreaFraction(0.05);
        let at = limits(&[area, Load(5.0), Approach(1.5)])?.between(Some(last), &next);
        assert_eq!(at, Some((LoadingEnd::AreaFraction, None)));
        // At the limit already, and the next state at it: that one comes.
        let at = limits(&[Load(4.0)])?.between(Some(last), &next);
        assert_eq!(at, Some((LoadingEnd::Load, None)));
        for target in [Load(8.0), Approach(2.0)] {
            assert_eq!(limits(&[target])?.between(Some(last), &next), None);
        }
        assert_eq!(limits(&[MeanGap(0.0)])?.between(Some(last), &state(2, 6.0)?), None);
        assert_eq!(limits(&[Load(5.0)])?.between(None, &next), None);
        Ok(())
    }
}
