//! A finished path as a record that can be read at any load, approach, area or mean gap.

use std::sync::Arc;

use super::limits::{Limits, LoadingEnd};
use super::window_end::WindowEnd;
use super::{ContactEvent, LoadingState};
use crate::contact::{ContactSequence, ContactState, ContactTarget, node_of};
use crate::kernel::Layering;
use crate::{Error, Grid};

/// The states of a path in the order of loading, to be read at any instant between them.
///
/// Between two events a path is linear in the approach, so that every reading is as exact as the states beside it. The
/// pressure that goes with it is [`LoadingPath::fields_at`](super::LoadingPath::fields_at).
///
/// ```
/// use asperity::{Boussinesq, ContactTarget, Grid, LoadingSolver, SelfAffine};
///
/// # fn main() -> Result<(), asperity::Error> {
/// let half_space = Boussinesq::new(Grid::square(32, 1.25e-3)?, 115e9)?;
/// let mut path = LoadingSolver::builder(&SelfAffine::zhang2020(1), &half_space)
///     .max_load(1000.0)
///     .build()?;
/// let history = path.run()?;
/// // Up to and at the limit:
/// for load in [10.0, 500.0, 1000.0] {
///     let state = history.at(ContactTarget::Load(load))?;
///     assert_eq!(state.contact.load, load);
///     let pressure = path.fields_at(&state)?.pressure;
///     assert!((pressure.sum() * path.grid().cell_area() / load - 1.0).abs() < 1e-12);
/// }
/// assert!(history.at_load(1001.0).is_none());
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Default)]
pub struct History {
    states: Vec<LoadingState>,
    /// What the path goes on with behind the last state, if it is of a record that knows.
    window_end: Option<Arc<WindowEnd>>,
    /// What the body is made of, if the states tell.
    layering: Layering,
}

/// Histories are equal if their states are.
impl PartialEq for History {
    fn eq(&self, other: &Self) -> bool {
        self.states == other.states
    }
}

impl FromIterator<LoadingState> for History {
    fn from_iter<I: IntoIterator<Item = LoadingState>>(states: I) -> Self {
        Self { states: states.into_iter().collect(), ..Self::default() }
    }
}

/// The state at a limit with which a path ended is left out where others follow: it is no event.
impl Extend<LoadingState> for History {
    fn extend<I: IntoIterator<Item = LoadingState>>(&mut self, states: I) {
        let mut states = states.into_iter().peekable();
        if states.peek().is_some() {
            self.states.pop_if(|last| last.event == ContactEvent::Limit);
        }
        self.states.extend(states);
        self.window_end = None;
    }
}

impl History {
    /// The states, one for each event, and the one at the limit if the path ended at one.
    #[must_use]
    pub fn states(&self) -> &[LoadingState] {
        &self.states
    }

    /// The same states, with what the body is made of; the history of a record knows it, and that of
    /// [`LoadingPath::run`](crate::LoadingPath::run), and of states alone nothing is known. Conductance, slip and creep
    /// are refused where the body has layers for which their theories do not hold; where nothing is known they are
    /// computed as on a half-space.
    #[must_use]
    pub fn on(mut self, layering: Layering) -> Self {
        self.layering = layering;
        self
    }

    /// What the body is made of, as far as it is known.
    #[must_use]
    pub fn layering(&self) -> Layering {
        self.layering
    }

    /// The same states, behind which the path goes on from the end of a window.
    pub(crate) fn with_window_end(mut self, end: Option<WindowEnd>) -> Self {
        self.window_end = end.map(Arc::new);
        self
    }

    /// Where the path goes on behind its last state.
    pub(crate) fn window_end(&self) -> Option<&WindowEnd> {
        self.window_end.as_deref()
    }

    /// The states without the one at a limit, if there is one.
    #[must_use]
    pub fn events(&self) -> &[LoadingState] {
        match self.states.split_last() {
            Some((last, events)) if last.event == ContactEvent::Limit => events,
            _ => &self.states,
        }
    }

    /// The nodes of a grid in the order in which they touched. Begin with first touch: nodes whose event is missing
    /// count as out of contact.
    ///
    /// # Errors
    ///
    /// [`Error::NodeLeaves`] if one leaves, with the number of the state, from 1 on; [`Error::NodeOutOfGrid`], and
    /// [`Error::AlreadyInContact`].
    pub fn contact_sequence(&self, grid: Grid) -> Result<ContactSequence, Error> {
        let mut contact = ContactSequence::new(grid);
        for (state, number) in self.states.iter().zip(1..) {
            match state.event {
                ContactEvent::Touch => contact.push(node_of(&grid, state.node)?)?,
                ContactEvent::Release => {
                    let (ix, iy) = state.node;
                    return Err(Error::NodeLeaves { ix, iy, event: number });
                }
                ContactEvent::Yield | ContactEvent::Limit => (),
            }
        }
        Ok(contact)
    }

    /// The path that a grid would have had with these targets as limits: its states up to the first of them, with the
    /// state there as its last, and why it ends. Of a path that has passed none of them all states, and `None`:
    /// [`LoadingBuilder::resume`](super::LoadingBuilder::resume) goes on from there.
    ///
    /// # Errors
    ///
    /// Those of [`LoadingBuilder::build`](super::LoadingBuilder::build) for limits that make no sense.
    pub fn ending_at(
        &self,
        grid: &Grid,
        targets: &[ContactTarget],
    ) -> Result<(Self, Option<LoadingEnd>), Error> {
        let unloaded = self.states.first().map_or(f64::INFINITY, |s| s.contact.mean_gap);
        let mut limits = Limits::default();
        for &target in targets {
            limits.set(target, grid, unloaded)?;
        }
        for (k, next) in self.states.iter().enumerate().skip(1) {
            if let Some((end, at_limit)) = limits.between(Some(self.states[k - 1]), next) {
                let states = self.states[..k].iter().copied().chain(at_limit);
                return Ok((states.collect::<Self>().on(self.layering), Some(end)));
            }
        }
        Ok((self.clone(), None))
    }

    /// The state at a target, or an error that says what the path has not reached: [`Self::at_load`] and its like for a
    /// caller who has nothing to do without it.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for what lies outside the path.
    pub fn at(&self, target: ContactTarget) -> Result<LoadingState, Error> {
        let (quantity, value, state) = match target {
            ContactTarget::Load(load) => ("load of a state", load, self.at_load(load)),
            ContactTarget::MeanPressure(mean_pressure) => {
                let last = self.states.last().map(|state| state.contact);
                let load = last.map(|last| mean_pressure * last.nominal_area);
                let state = load.and_then(|load| self.at_load(load));
                ("mean pressure of a state", mean_pressure, state)
            }
            ContactTarget::Approach(approach) => {
                ("approach of a state", approach, self.at_approach(approach))
            }
            ContactTarget::AreaFraction(fraction) => {
                ("area fraction of a state", fraction, self.at_area_fraction(fraction))
            }
            ContactTarget::MeanGap(mean_gap) => {
                ("mean gap of a state", mean_gap, self.at_mean_gap(mean_gap))
            }
        };
        let expected = if self.states.is_empty() {
            "asked for after a state has been yielded"
        } else {
            "one that the path has had"
        };
        state.ok_or(Error::OutOfRange { quantity, value, expected })
    }

    /// The state at a load \[N\], `None` outside the path. Beyond the last state only a path that ended in full contact
    /// can be read, with a hardness if all nodes have yielded, as far as all of a state is finite.
    #[must_use]
    pub fn at_load(&self, load: f64) -> Option<LoadingState> {
        let after = self.states.partition_point(|state| state.contact.load <= load);
        // A plateau has this load from its beginning on.
        let first = self.states.partition_point(|state| state.contact.load < load);
        if let Some(state) =
            self.states[first..after].iter().find(|state| state.contact.is_plateau())
        {
            return Some(*state);
        }
        self.read(load, after, |state| state.contact.load, ContactState::at_load)
    }

    /// The history with one more state, that at a load \[N\] behind full contact, if the path ended before it.
    #[doc(hidden)] // for the program and the package of Python, which unload from there
    #[must_use]
    pub fn up_to_load(mut self, load: f64) -> Self {
        let is_before = self.states.last().is_some_and(|state| state.contact.load < load);
        if let Some(state) = self.at_load(load).filter(|_| is_before) {
            self.extend([LoadingState { event: ContactEvent::Limit, ..state }]);
        }
        self
    }

    /// The state at an approach \[m\]; see [`Self::at_load`].
    #[must_use]
    pub fn at_approach(&self, approach: f64) -> Option<LoadingState> {
        let after = self.states.partition_point(|state| state.contact.approach <= approach);
        self.read(approach, after, |state| state.contact.approach, ContactState::at_approach)
    }

    /// The state at a mean gap \[m\]; see [`Self::at_load`]. On a body of which nothing is known the mean gap may
    /// rise again: the first state there.
    #[must_use]
    pub fn at_mean_gap(&self, mean_gap: f64) -> Option<LoadingState> {
        // In full contact nodes may go on to yield: there is none left from its beginning on.
        let is_full = |state: &&LoadingState| state.contact.contact_area_fraction == 1.0;
        let mut full = self.states.iter().filter(is_full);
        if let Some(state) = full.find(|state| state.contact.mean_gap == mean_gap) {
            return Some(*state);
        }
        let mut states = self.states.iter();
        let after = states.position(|state| state.contact.mean_gap < mean_gap);
        self.read(
            mean_gap,
            after.unwrap_or(self.states.len()),
            |state| state.contact.mean_gap,
            ContactState::at_mean_gap,
        )
    }

    /// The first state with as many nodes in contact as fit into this fraction of the nominal area (see
    /// [`Grid::nodes_in`](crate::Grid::nodes_in)); `None` if the path has not got so far.
    #[must_use]
    pub fn at_area_fraction(&self, fraction: f64) -> Option<LoadingState> {
        // The same rounding as there: a fraction such as 0.1 of 10 nodes means one node.
        let limit = fraction * (1.0 + 4.0 * f64::EPSILON);
        let with_one_more = |state: &LoadingState| {
            let nodes = state.contact.contact_nodes as f64;
            state.contact.contact_area_fraction * ((nodes + 1.0) / nodes)
        };
        // Not a search by halves: area shrinks where a node leaves.
        let mut states = self.states.iter();
        let found = states.find(|state| with_one_more(state) > limit)?;
        (found.contact.contact_area_fraction <= limit).then_some(*found)
    }

    /// The state at a target, from the one before the first that is beyond it.
    fn read(
        &self,
        target: f64,
        after: usize,
        quantity: impl Fn(&LoadingState) -> f64,
        at: impl Fn(&ContactState, f64) -> Option<ContactState>,
    ) -> Option<LoadingState> {
        if target.is_nan() {
            return None;
        }
        let last = self.states.get(after.checked_sub(1)?)?;
        let is_there = after < self.states.len()
            || (last.contact.contact_area_fraction == 1.0
                && last.contact.plastic.is_none_or(|plastic| plastic.yielded_area_fraction == 1.0))
            || quantity(last) == target;
        let contact = is_there.then(|| at(&last.contact, target))??;
        contact.is_finite().then(|| last.with(contact))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_gap_that_rises_again_is_read_where_it_is_first() {
        let state = |step: usize, mean_gap: f64| {
            let contact = ContactState {
                contact_nodes: step,
                approach: step as f64,
                load: step as f64,
                contact_area: step as f64,
                contact_area_fraction: 0.1 * step as f64,
                nominal_area: 10.0,
                mean_gap,
                contact_stiffness: Some(1.0),
                interfacial_stiffness: Some(10.0),
                energy: step as f64,
                plastic: None,
            };
            LoadingState::new(step, ContactEvent::Touch, (step, 0), contact)
        };
        let gaps = [1.0, 0.9, 0.8, 0.95, 0.7];
        let history: History = (1..).zip(gaps).map(|(k, gap)| state(k, gap)).collect();
        let step_at = |gap| history.at_mean_gap(gap).map(|state| state.step);
        assert_eq!(step_at(0.85), Some(2));
        assert_eq!(step_at(0.9), Some(2));
        assert_eq!(step_at(0.75), Some(4));
        assert_eq!(step_at(0.7), Some(5));
        for outside in [1.1, 0.6, f64::NAN] {
            assert_eq!(step_at(outside), None);
        }
    }

    #[test]
    fn a_path_with_nodes_that_leave_has_no_order() -> Result<(), Error> {
        use ContactEvent::{Limit, Release, Touch};
        let grid = Grid::new(3, 2, 1.0, 1.0)?;
        let contact = history().states()[0].contact;
        let order = |events: &[(ContactEvent, (usize, usize))]| {
            let states =
                events.iter().map(|&(event, node)| LoadingState::new(1, event, node, contact));
            states.collect::<History>().contact_sequence(grid)
        };
        let contact = order(&[(Touch, (1, 1)), (Touch, (2, 0)), (Limit, (2, 0))])?;
        assert_eq!(contact.order(), [4, 2]);
        let left = order(&[(Touch, (1, 1)), (Touch, (2, 0)), (Release, (1, 1))]);
        assert!(matches!(left, Err(Error::NodeLeaves { ix: 1, iy: 1, event: 3 })));
        let twice = order(&[(Touch, (1, 1)), (Touch, (1, 1))]);
        assert!(matches!(twice, Err(Error::AlreadyInContact { ix: 1, iy: 1 })));
        for node in [(3, 0), (0, 2), (usize::MAX, 0), (0, usize::MAX)] {
            assert!(matches!(order(&[(Touch, node)]), Err(Error::NodeOutOfGrid { .. })));
        }
        Ok(())
    }

    /// Three states of 1, 2 and 4 of ten nodes, at loads of 1, 2 and 4, from which approach and mean gap change by 1/2
    /// and 1/4 for each newton.
    fn history() -> History {
        let state = |nodes: usize| {
            let load = nodes as f64;
            let contact = ContactState {
                contact_nodes: nodes,
                approach: 0.5 * load,
                load,
                contact_area: load,
                contact_area_fraction: load / 10.0,
                nominal_area: 10.0,
                mean_gap: 2.0 - 0.25 * load,
                contact_stiffness: Some(2.0),
                interfacial_stiffness: Some(4.0),
                energy: 0.25 * load * load,
                plastic: None,
            };
            LoadingState::new(nodes, ContactEvent::Touch, (nodes, 0), contact)
        };
        [1, 2, 4].map(state).into_iter().collect()
    }

    #[test]
    fn states_between_events_are_those_of_the_earlier_one() {
        let history = history();
        for (load, nodes) in [(1.0, 1), (1.5, 1), (2.0, 2), (3.0, 2), (4.0, 4)] {
            let readings = [
                history.at_load(load),
                history.at_approach(0.5 * load),
                history.at_mean_gap(2.0 - 0.25 * load),
            ];
            for reading in readings {
                let found = reading.map(|state| {
                    (state.contact.contact_nodes, state.contact.load, state.contact.energy)
                });
                assert_eq!(found, Some((nodes, load, 0.25 * load * load)));
            }
        }
        for (target, nodes) in [
            (ContactTarget::Load(3.0), 2),
            (ContactTarget::MeanPressure(0.3), 2),
            (ContactTarget::Approach(1.5), 2),
            (ContactTarget::MeanGap(1.25), 2),
            (ContactTarget::AreaFraction(0.4), 4),
        ] {
            let found = history.at(target).ok();
            assert_eq!(found.map(|state| state.contact.contact_nodes), Some(nodes));
        }
        for outside in [0.5, 4.5, f64::NAN, f64::INFINITY] {
            assert_eq!(history.at_load(outside), None);
            assert_eq!(history.at_approach(0.5 * outside), None);
            assert_eq!(history.at_mean_gap(2.0 - 0.25 * outside), None);
        }
    }

    /// What a path has not had is an error that says so, in the words of the target.
    #[test]
    fn readings_outside_the_path_say_what_is_wrong() {
        let told = |history: &History, target| history.at(target).err().map(|e| e.to_string());
        for (target, quantity, value) in [
            (ContactTarget::Load(4.5), "load", "4.5"),
            (ContactTarget::Approach(0.25), "approach", "0.25"),
            (ContactTarget::MeanGap(0.5), "mean gap", "0.5"),
            (ContactTarget::AreaFraction(0.5), "area fraction", "0.5"),
        ] {
            let expected =
                format!("{quantity} of a state must be one that the path has had, but is {value}");
            assert_eq!(told(&history(), target), Some(expected));
        }
        let empty = told(&History::default(), ContactTarget::Load(1.0)).unwrap_or_default();
        assert!(empty.contains("after a state has been yielded"), "{empty}");
    }

    /// Behind full contact everything is linear in the load.
    #[test]
    fn a_path_that_ends_in_full_contact_goes_on() {
        let mut states = history().states().to_vec();
        states[2].contact.contact_area_fraction = 1.0;
        let history: History = states.into_iter().collect();
        let mut later = History::default();
        later.extend(history.states().iter().copied());
        assert_eq!(later, history);
        let found =
            later.at_load(6.0).map(|state| (state.contact.contact_nodes, state.contact.approach));
        assert_eq!(found, Some((4, 3.0)));
    }

    /// As many of ten nodes as fit; between 2 and 4 of them there are none but the 2.
    #[test]
    fn the_state_of_an_area_is_the_last_that_fits() {
        let history = history();
        let nodes =
            |fraction| history.at_area_fraction(fraction).map(|state| state.contact.contact_nodes);
        for (fraction, expected) in [
            (0.05, None),
            (0.1, Some(1)),
            (0.19, Some(1)),
            (0.2, Some(2)),
            (0.29, Some(2)),
            (0.35, None),
            (0.4, Some(4)),
            (0.49, Some(4)),
            (0.5, None),
        ] {
            assert_eq!(nodes(fraction), expected, "{fraction}");
        }
    }

    #[test]
    fn a_limit_is_no_event() {
        let mut states = history().states().to_vec();
        assert_eq!(history().events().len(), 3);
        states[2].event = ContactEvent::Limit;
        let history: History = states.into_iter().collect();
        assert_eq!((history.events().len(), history.states().len()), (2, 3));
    }
}
