//! Without adhesion, w = 0: the states of the elastic path, there and back.

use std::cmp::Ordering;

use super::state::{AdhesiveEvent, Direction};
use crate::contact::{ContactState, ContactTarget};
use crate::loading::{ContactEvent, History, LoadingEnd, LoadingPath, LoadingState};
use crate::{Error, Grid};

/// What happens, at which node, and the contact then.
pub(super) type Happened = (AdhesiveEvent, (usize, usize), ContactState);

/// An elastic path that can turn around: contact goes back through the same states.
#[derive(Debug)]
pub(super) struct Plain {
    path: LoadingPath,
    /// Touches that the path has come to, in their order.
    touches: Vec<LoadingState>,
    /// How many of them are in contact.
    now: usize,
    direction: Direction,
    /// Where the branch ends, once it has turned: before that the path knows.
    targets: Option<Vec<ContactTarget>>,
    is_at_end: bool,
    /// The contact of the last state.
    present: Option<ContactState>,
}

impl Plain {
    pub(super) fn new(path: LoadingPath) -> Self {
        Self {
            path,
            touches: Vec::new(),
            now: 0,
            direction: Direction::Loading,
            targets: None,
            is_at_end: false,
            present: None,
        }
    }

    /// Turns around, or goes on, to the first of some targets.
    pub(super) fn turn(&mut self, direction: Direction, targets: &[ContactTarget]) {
        self.direction = direction;
        self.targets = Some(targets.to_vec());
        self.is_at_end = false;
    }

    /// Goes to a state, of a path on which `most` nodes were in contact before.
    pub(super) fn skip_to(&mut self, state: ContactState, most: usize) -> Result<(), Error> {
        while self.touches.len() < most && self.touch()? {}
        self.now = state.contact_nodes.min(self.touches.len());
        self.present = Some(state);
        Ok(())
    }

    /// The next of what happens on the branch, `None` at its end.
    pub(super) fn next(&mut self) -> Result<Option<Happened>, Error> {
        if self.is_at_end {
            return Ok(None);
        }
        let next = match self.direction {
            Direction::Loading => self.press(),
            Direction::Unloading => self.release(),
        }?;
        self.present = next.map_or(self.present, |(.., contact)| Some(contact));
        Ok(next)
    }

    /// Whether the branch has ended at a target.
    pub(super) fn is_at_target(&self) -> bool {
        self.is_at_end
    }

    /// Lets the path come to one touch more, if there is one.
    fn touch(&mut self) -> Result<bool, Error> {
        let mut goes_on = false;
        loop {
            while let Some(state) = self.path.next().transpose()? {
                if state.event == ContactEvent::Touch {
                    self.touches.push(state);
                    return Ok(true);
                }
            }
            if goes_on || self.touches.len() == self.path.grid().nodes() {
                return Ok(false);
            }
            // The targets of the first branch no longer count, also if it had not come to them.
            self.path.continue_to(ContactTarget::AreaFraction(1.0))?;
            goes_on = true;
        }
    }

    fn press(&mut self) -> Result<Option<Happened>, Error> {
        if self.targets.is_none() {
            let Some(state) = self.path.next().transpose()? else {
                // A path that ends at an area has no state there but the last touch, nor has one whose last touch is
                // at the very target.
                let ends = [
                    LoadingEnd::Load,
                    LoadingEnd::Approach,
                    LoadingEnd::MeanGap,
                    LoadingEnd::AreaFraction,
                ];
                self.is_at_end = self.path.end().is_some_and(|end| ends.contains(&end));
                return Ok(None);
            };
            if state.event != ContactEvent::Touch {
                self.is_at_end = true;
                return Ok(Some((AdhesiveEvent::Limit, state.node, state.contact)));
            }
            self.touches.push(state);
        } else if self.has_area() {
            self.is_at_end = true;
            return Ok(None);
        } else if self.now == self.touches.len() && !self.touch()? {
            return Ok(None);
        }
        let next = self.touches[self.now].contact;
        if let Some(limit) = self.limit(&next, 1.0)? {
            return Ok(Some(limit));
        }
        let state = self.touches[self.now];
        self.now += 1;
        Ok(Some((AdhesiveEvent::Touch, state.node, state.contact)))
    }

    /// Whether an area that is asked for is there: with its last touch, as on a path that has not turned.
    fn has_area(&self) -> bool {
        let nodes = self.present.map_or(0, |present| present.contact_nodes);
        let grid = self.path.grid();
        self.targets.iter().flatten().any(|target| match *target {
            ContactTarget::AreaFraction(fraction) => {
                grid.nodes_in(fraction).is_ok_and(|fit| nodes >= fit)
            }
            _ => false,
        })
    }

    fn release(&mut self) -> Result<Option<Happened>, Error> {
        let Some(last) = self.now.checked_sub(1) else { return Ok(None) };
        // A branch may turn around behind the last touch, and end before that.
        if self.now == self.touches.len() && self.targets.iter().flatten().next().is_some() {
            self.touch()?;
        }
        let state = self.touches[last];
        if let Some(limit) = self.limit(&state.contact, -1.0)? {
            return Ok(Some(limit));
        }
        self.now = last;
        // It parts where it touched, with a pressure of 0: the state is the one of its touch, without this node among
        // those in contact, and with the stiffnesses before it touched.
        Ok(Some((AdhesiveEvent::Part, state.node, self.with_nodes(last, state.contact))))
    }

    /// A state at which only the first `nodes` are in contact, of those that touch there.
    fn with_nodes(&self, nodes: usize, state: ContactState) -> ContactState {
        let ContactState { approach, load, mean_gap, energy, .. } = state;
        let since = nodes.checked_sub(1).map(|last| self.touches[last].contact);
        ContactState {
            // A periodic half-space has none, with nodes or without.
            contact_stiffness: since
                .map_or(state.contact_stiffness.map(|_| 0.0), |since| since.contact_stiffness),
            interfacial_stiffness: since.map_or(Some(0.0), |since| since.interfacial_stiffness),
            energy,
            ..ContactState::new(&self.path.grid(), nodes, approach, load, mean_gap)
        }
    }

    /// Ends the branch at the first target on the way to a state, 1 or −1, if there is one.
    fn limit(&mut self, next: &ContactState, way: f64) -> Result<Option<Happened>, Error> {
        let grid = self.path.grid();
        let targets = self.targets.iter().flatten();
        let passed: Vec<ContactTarget> =
            targets.copied().filter(|target| is_beyond(next, target, &grid, way)).collect();
        if passed.is_empty() {
            return Ok(None);
        }
        self.is_at_end = true;
        let history: History = self.touches.iter().copied().collect();
        let states = passed.into_iter().map(|target| history.at(target));
        let states = states.collect::<Result<Vec<LoadingState>, Error>>()?;
        let first = states.into_iter().min_by(|a, b| {
            let order = a.contact.order(&b.contact);
            if way > 0.0 { order } else { order.reverse() }
        });
        let Some(first) = first else { return Ok(None) };
        let node = first.node;
        // What is reached already is where the path is.
        let passed = self.present.filter(|present| {
            let order = first.contact.order(present);
            if way > 0.0 { order == Ordering::Less } else { order == Ordering::Greater }
        });
        let found = passed.unwrap_or(first.contact);
        // Of nodes that touch together some may be in contact, and have to stay.
        let contact = match found.contact_nodes == self.now {
            true => found,
            false => self.with_nodes(self.now, found),
        };
        Ok(Some((AdhesiveEvent::Limit, node, contact)))
    }
}

/// Whether a target lies before a state on the way of a branch, 1 or −1; on the way back also if it lies at it: the
/// node that touched there is in contact still.
fn is_beyond(state: &ContactState, target: &ContactTarget, grid: &Grid, way: f64) -> bool {
    let is_past = |left: f64| left > 0.0 || way < 0.0 && left == 0.0;
    match *target {
        ContactTarget::Load(load) => is_past(way * (state.load - load)),
        ContactTarget::MeanPressure(p) => is_past(way * (state.load - p * grid.nominal_area())),
        ContactTarget::Approach(approach) => is_past(way * (state.approach - approach)),
        ContactTarget::MeanGap(gap) => is_past(way * (gap - state.mean_gap)),
        // On the way down the end is where the last of these nodes touched: its pressure is 0 there.
        ContactTarget::AreaFraction(fraction) => {
            way < 0.0 && grid.nodes_in(fraction).is_ok_and(|nodes| state.contact_nodes <= nodes)
        }
    }
}
