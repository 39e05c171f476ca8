//! The leak rate along a path.

use super::{CriticalConstriction, Leak, Seal};
use crate::loading::History;
use crate::patches::{Connectivity, Percolation};
use crate::surface::Axis;
use crate::{ContactEvent, ContactGrowth, Error, LoadingPath, LoadingState};

/// The leak at one state of a path, without its fields.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct LeakPoint {
    /// The state.
    pub state: LoadingState,
    /// Leak rate \[m³/s\].
    pub leak_rate: f64,
    /// Bruggeman's estimate of it \[m³/s\].
    pub mean_field_leak_rate: f64,
    /// Permeability along the flow \[m³/(Pa s)\].
    pub permeability: f64,
    /// Permeability across \[m³/(Pa s)\], on a periodic boundary.
    pub transverse_permeability: Option<f64>,
    /// The narrowest place of the widest channel.
    pub constriction: Option<CriticalConstriction>,
    /// What is lost over the leak rate.
    pub imbalance: f64,
}

impl LeakPoint {
    fn new(state: LoadingState, leak: &Leak) -> Self {
        Self {
            state,
            leak_rate: leak.leak_rate,
            mean_field_leak_rate: leak.mean_field_leak_rate,
            permeability: leak.permeability,
            transverse_permeability: leak.transverse_permeability,
            constriction: leak.constriction,
            imbalance: leak.imbalance,
        }
    }
}

/// The leak rate along a path, at states chosen where it changes.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct LeakCurve {
    /// In the order of loading.
    pub points: Vec<LeakPoint>,
    /// The state at which the last channel closes, from which on nothing leaks. `None` if the path does not reach it,
    /// and if nodes leave the contact, so that it has no order.
    pub closing: Option<LoadingState>,
}

impl Seal {
    /// The leak at some states of a path, up to the one at which the last channel closes: first touch, the last state
    /// that leaks, and then always between the two neighbours that lie furthest apart in the mean pressure and the
    /// logarithm of the leak rate, each over its range.
    ///
    /// `history` are the states of the path from first touch on. Each point takes the gap of one state and one
    /// solution. The first state, the last that leaks and the one at which the last channel closes are always there:
    /// three if only two `states` are asked for.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for fewer than two states; those of [`Self::leak_at`], and of
    /// [`History::contact_sequence`] for states that are no path.
    pub fn curve(
        &self,
        path: &mut LoadingPath,
        history: &History,
        states: usize,
    ) -> Result<LeakCurve, Error> {
        Error::require("number of states", states as f64, states > 1, "two or more")?;
        let events = history.states();
        let by_contact = closing(history, path, self.along())?;
        let at = |place: usize, path: &mut LoadingPath| -> Result<LeakPoint, Error> {
            let state = events[place];
            Ok(LeakPoint::new(state, &self.leak_at(path, &state)?))
        };
        let narrows = path.problem().growth() >= ContactGrowth::Monotone;
        let (closing, last) =
            self.closing_by_gap((events, narrows), by_contact, |place| at(place, path))?;
        let mut points: Vec<Placed> = Vec::new();
        if last.is_some_and(|(place, _)| place > 0) {
            points.push((0, at(0, path)?));
        }
        points.extend(last);
        if let Some(place) = closing {
            points.push((place, at(place, path)?));
        }
        while points.len() < states
            && let Some(before) = widest(&points)
        {
            let place = (points[before].0 + points[before + 1].0) / 2;
            let point = at(place, path)?;
            points.insert(before + 1, (place, point));
        }
        let points = points.into_iter().map(|(_, point)| point).collect();
        Ok(LeakCurve { points, closing: closing.map(|place| events[place]) })
    }
}

/// The place of a state, and its leak.
type Placed = (usize, LeakPoint);

impl Seal {
    /// The place of the first state from which on nothing leaks, up to that which closes by contact, and the last that
    /// does: where gaps only become narrower under load, which a body promises, the first that does not. Nodes that
    /// touch together are closed with the first of them, and where there is a least gap many states do not leak before
    /// contact closes.
    fn closing_by_gap(
        &self,
        (states, narrows): (&[LoadingState], bool),
        by_contact: Option<usize>,
        mut at: impl FnMut(usize) -> Result<LeakPoint, Error>,
    ) -> Result<(Option<usize>, Option<Placed>), Error> {
        let end = by_contact.unwrap_or(states.len());
        // Where nodes leave the contact gaps widen again.
        if states.iter().any(|state| state.event == ContactEvent::Release) {
            let last = end.checked_sub(1);
            let last = last.map(|place| Ok::<_, Error>((place, at(place)?))).transpose()?;
            return Ok((by_contact, last));
        }
        // In strides backwards, each twice as long, and then by halves; one by one where gaps may widen between.
        let mut stride = if self.least_gap() == 0.0 || !narrows { 1 } else { end.div_ceil(2) };
        let (mut closed, mut last) = (end, None::<Placed>);
        loop {
            let open = last.map_or(0, |(place, _)| place + 1);
            if open == closed {
                break;
            }
            let place = match last {
                None => closed.saturating_sub(stride),
                Some(_) => open.midpoint(closed),
            };
            let point = at(place)?;
            if point.leak_rate == 0.0 {
                closed = place;
                stride *= if narrows { 2 } else { 1 };
            } else {
                last = Some((place, point));
            }
        }
        Ok((if closed < end { Some(closed) } else { by_contact }, last))
    }
}

/// The place among the states of that at which the last channel along an axis closes.
fn closing(history: &History, path: &LoadingPath, along: Axis) -> Result<Option<usize>, Error> {
    let contact = match history.contact_sequence(path.grid()) {
        Ok(contact) => contact,
        // A channel may open again: there is no last one.
        Err(Error::NodeLeaves { .. }) => return Ok(None),
        Err(error) => return Err(error),
    };
    // Of the channels alone, whatever joins patches.
    let found = Percolation::of(&contact, path.problem().boundary(), Connectivity::Eight);
    let nodes = match along {
        Axis::X => found.seal_x,
        Axis::Y => found.seal_y,
    };
    let touches =
        history.states().iter().enumerate().filter(|(_, s)| s.event == ContactEvent::Touch);
    let mut places = touches.map(|(place, _)| place);
    Ok(nodes.and_then(|nodes| places.nth(nodes.checked_sub(1)?)))
}

/// The point before the widest interval in which there are more states.
fn widest(points: &[Placed]) -> Option<usize> {
    let position =
        |(_, point): &Placed| (point.state.contact.mean_pressure(), point.leak_rate.ln());
    let range = |of: fn(&(f64, f64)) -> f64| {
        let values = points.iter().map(position).map(|at| of(&at)).filter(|v| v.is_finite());
        let (least, most) =
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        if most > least { most - least } else { 1.0 }
    };
    let (pressures, logarithms) = (range(|at| at.0), range(|at| at.1));
    let mut widest: Option<(f64, usize)> = None;
    for (before, pair) in points.windows(2).enumerate() {
        let ((p, q), (next_p, next_q)) = (position(&pair[0]), position(&pair[1]));
        // Where the last channel closes the logarithm has no end, and the states are neighbours.
        let length = ((next_p - p) / pressures).hypot((next_q - q) / logarithms);
        let is_wider = widest.is_none_or(|(most, _)| length > most);
        if pair[1].0 - pair[0].0 > 1 && is_wider {
            widest = Some((length, before));
        }
    }
    widest.map(|(_, before)| before)
}
