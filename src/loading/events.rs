//! Events: nodes that touch, one after the other.

use std::time::Instant;

use super::limits::ContactRule;
use super::solver::LoadingSolver;
use super::state::{ContactEvent, ContactState};
use super::window::Candidate;
use crate::updater::{LinearUpdater, System};
use crate::{Boundary, ContactGrowth, Error, InfluenceKernel, Surface};

/// How far pressures and gaps may lie below zero, relative to the greatest ones, for a window of an
/// updater that is not exact to be accepted: its order of events is then right but for nodes whose
/// contact differs in approach by some 1e-8.
const VERIFIED: f64 = 1e-7;

/// The same for a state of an exact updater: far above rounding, as in a refresh.
pub(super) const CHECKED: f64 = 1e-10;

/// Greatest change of the approach at which a node touches, relative to it, that may rest on a
/// Schur complement that is not exact. Only nodes between others in contact change so much; measured,
/// the states of 256² surfaces then stay within 2e-8.
const MOST_DRIFT: f64 = 3.0;

impl<S: Surface, K: InfluenceKernel, U: LinearUpdater> LoadingSolver<S, K, U> {
    /// Computes at least one more state, unless the path is at its end. Returns what went wrong
    /// after those computed.
    pub(super) fn produce(&mut self) -> Result<Option<Error>, Error> {
        if self.is_stepwise() {
            return self.step().map(|()| None);
        }
        if self.contact.len() >= self.limits.nodes {
            return Ok(None);
        }
        if self.candidate().is_none() {
            self.refresh()?;
            if self.candidate().is_none() {
                return Err(self.growth_stopped());
            }
        }
        self.event()?;
        let exact = self.updater.is_exact();
        if exact && !self.may_take_back() {
            return Ok(None);
        }
        // What changes in a window carries errors of single precision, which must stay small beside
        // what is left of the mean gap and of its rate.
        let start = self.front;
        let little_left = |now: f64, start: f64| now < 0.9 * start;
        let failure = loop {
            let next = self.candidate();
            let drifted = next.is_some_and(|next| self.window.drift(next) > MOST_DRIFT);
            let ended = little_left(self.front.mean_gap, start.mean_gap)
                || little_left(self.front.closing, start.closing);
            if !exact && (drifted || ended) {
                self.window.give_up(0);
            }
            match self.event() {
                Ok(true) => {}
                Ok(false) => break None,
                Err(error) => break Some(error),
            }
        };
        let whole = if exact {
            self.check_gaps()?
        } else {
            self.verify()?
        };
        Ok(failure.filter(|_| whole))
    }

    /// Whether bounds on the approach at which a node touches may fail, so that a window is checked
    /// at its end, and its last events taken back.
    pub(super) fn may_take_back(&self) -> bool {
        self.growth == ContactGrowth::Monotone && self.rule == ContactRule::FirstContact
    }

    /// The next node of the window that touches, if the window still knows.
    fn candidate(&self) -> Option<Candidate> {
        match self.rule {
            ContactRule::FirstContact => self.window.first_contact(),
            ContactRule::SmallestGap => self.window.smallest_gap(self.front.approach),
        }
    }

    /// The next event of the window; false if there is none, or none within the limits.
    fn event(&mut self) -> Result<bool, Error> {
        let start = Instant::now();
        let Some(Candidate { position, approach }) = self.candidate() else {
            return Ok(false);
        };
        let approach = match self.rule {
            // Backward steps are rounding, and ties are intervals of no length.
            ContactRule::FirstContact => approach.max(self.front.approach),
            ContactRule::SmallestGap => approach,
        };
        if self.contact.len() >= self.limits.nodes {
            return Ok(false);
        }
        let Some(load) = self.load_within_limits(approach)? else {
            return Ok(false);
        };
        let [_, unit, sum] = self.touch_watched(position, approach)?;
        self.advance_front(approach, load);
        let nodes = self.grid.nodes();
        let front = &mut self.front;
        front.unit_unit += unit * unit;
        front.closing -= sum * unit / nodes as f64;
        if self.contact.len() == nodes {
            // By identity and not by arithmetic.
            front.mean_gap = 0.0;
            front.closing = 0.0;
        }
        if self.rule == ContactRule::FirstContact {
            // Less than nothing is rounding.
            front.mean_gap = front.mean_gap.max(0.0);
        }
        let node = self.window.nodes()[position];
        match self.state_of(node, ContactEvent::Touch) {
            Ok(state) => self.ahead.push_back(state),
            Err(error) => {
                self.take_back(1);
                return Err(error);
            }
        }
        self.timings.events += start.elapsed();
        Ok(true)
    }

    /// The load at an approach up to the next event, `None` if either is beyond the limits.
    pub(super) fn load_within_limits(&self, approach: f64) -> Result<Option<f64>, Error> {
        let stiffness = self.grid.cell_area() * self.front.unit_unit;
        let load = self.front.load + stiffness * (approach - self.front.approach);
        let reported = approach - self.gauge * load;
        if load > self.limits.load || reported > self.limits.approach {
            return Ok(None);
        }
        if !(approach.is_finite() && load.is_finite()) {
            return Err(Error::NotFinite {
                step: self.steps() + 1,
            });
        }
        Ok(Some(load))
    }

    /// Lets the watched node at `position` touch. Returns the entries it adds to $L^{-1} B$.
    pub(super) fn touch_watched(
        &mut self,
        position: usize,
        approach: f64,
    ) -> Result<[f64; System::RHS], Error> {
        let node = self.window.nodes()[position];
        let entries = self.window.touch(position).map_err(|pivot| {
            let (ix, iy) = self.grid.coordinates(node);
            Error::NotPositiveDefinite {
                ix,
                iy,
                approach,
                pivot,
            }
        })?;
        self.contact.push(node);
        self.in_contact[node] = true;
        Ok(entries)
    }

    /// Takes the front to an approach up to the next event, with the stiffnesses it has had so far.
    pub(super) fn advance_front(&mut self, approach: f64, load: f64) {
        let front = &mut self.front;
        let change = approach - front.approach;
        front.approach = approach;
        front.energy += 0.5 * (front.load + load) * change;
        front.load = load;
        front.mean_gap -= front.closing * change;
    }

    /// The state at the front, after what happened to a node there.
    pub(super) fn state_of(&self, node: usize, event: ContactEvent) -> Result<ContactState, Error> {
        let front = &self.front;
        let (count, nodes) = (self.contact.len(), self.grid.nodes());
        let stiffness = self.grid.cell_area() * front.unit_unit;
        let interfacial_stiffness = stiffness / front.closing;
        let state = ContactState {
            step: self.steps(),
            event,
            node: self.grid.coordinates(node),
            contact_nodes: count,
            approach: front.approach - self.gauge * front.load,
            load: front.load,
            contact_area: count as f64 * self.grid.cell_area(),
            contact_area_fraction: count as f64 / nodes as f64,
            mean_gap: front.mean_gap,
            contact_stiffness: match self.system.table().boundary() {
                Boundary::Free => Some(stiffness),
                Boundary::Periodic => None,
            },
            interfacial_stiffness,
            energy: front.energy - 0.5 * self.gauge * front.load * front.load,
        };
        if state.is_finite() && stiffness.is_finite() && stiffness > 0.0 {
            return Ok(state);
        }
        Err(Error::NotFinite { step: state.step })
    }

    /// Checks all gaps at the end of a window whose bounds may have failed, and takes back the events
    /// after the first overlap. Gaps only close, so that none has overlapped where none does at the
    /// end. Returns whether the whole window stood.
    ///
    /// The next refresh needs the same solution and the same displacements, and finds them.
    fn check_gaps(&mut self) -> Result<bool, Error> {
        let mut whole = true;
        let mut fewest = 1;
        while self.ahead.len() > 1
            && let Some(until) = self.contradiction(CHECKED)?
        {
            whole = false;
            let states = self.ahead.iter().rev();
            let later = states.take_while(|state| self.gauged_approach(state) > until);
            let events = later.count().max(fewest).min(self.ahead.len() - 1);
            self.drop_events(events);
            // An estimate that keeps failing must not make the search long.
            fewest *= 2;
        }
        Ok(whole)
    }

    /// Checks the states ahead against the conditions of contact, from a solution in double
    /// precision; as long as that contradicts them, gives up the second half of the window. The
    /// first event of a window follows from such a solution, and needs no check. Returns whether
    /// the whole window stood.
    fn verify(&mut self) -> Result<bool, Error> {
        let mut whole = true;
        while self.ahead.len() > 1 && self.contradiction(VERIFIED)?.is_some() {
            whole = false;
            self.drop_events(self.ahead.len().div_ceil(2));
        }
        Ok(whole)
    }

    /// Takes back the last events and their states.
    fn drop_events(&mut self, events: usize) {
        self.ahead.truncate(self.ahead.len() - events);
        self.timings.taken_back += events;
        self.take_back(events);
    }

    /// Takes back the last events, whose states are not ahead any more, and lets the window know no
    /// further ones. What remains of the front follows from the solution at the next refresh.
    fn take_back(&mut self, events: usize) {
        for node in self.contact.drain(self.contact.len() - events..) {
            self.in_contact[node] = false;
        }
        self.solved = None;
        self.window.give_up(events);
        let last = self.ahead.back().copied().or(self.state);
        let (approach, load, energy) = last.map_or((0.0, 0.0, 0.0), |state| {
            let in_gauge = 0.5 * self.gauge * state.load * state.load;
            let approach = self.gauged_approach(&state);
            (approach, state.load, state.energy + in_gauge)
        });
        self.front.approach = approach;
        self.front.load = load;
        self.front.energy = energy;
    }

    /// Whether a pressure or a gap at the front is negative by more than `tolerance`, relative to the
    /// greatest pressure and to the lengths of the problem. Returns the approach until which none was,
    /// as far as the rates at the front tell.
    fn contradiction(&mut self, tolerance: f64) -> Result<Option<f64>, Error> {
        self.solve(self.contact.len())?;
        if self.negative_pressure(tolerance).is_some() {
            return Ok(Some(f64::NEG_INFINITY));
        }
        let approach = self.front.approach;
        let overlap = -tolerance * (self.greatest_gap + approach);
        let start = Instant::now();
        let [u1, u2] = self.fields.displacements(&self.contact, &self.solution)?;
        self.timings.convolution += start.elapsed();
        let gaps = self.system.gap().iter().zip(u1).zip(u2);
        let mut until: Option<f64> = None;
        for (((gap, u1), u2), in_contact) in gaps.zip(&self.in_contact) {
            let (r1, r2) = (gap + u1, 1.0 - u2);
            if !in_contact && r1 - approach * r2 < overlap {
                let closed = if r2 > 0.0 { r1 / r2 } else { f64::NEG_INFINITY };
                until = Some(until.map_or(closed, |until| until.min(closed)));
            }
        }
        Ok(until)
    }

    /// The first node in contact whose pressure at the front is negative by more than `tolerance`
    /// relative to the greatest, or not a number.
    pub(super) fn negative_pressure(&self, tolerance: f64) -> Option<(usize, f64)> {
        let approach = self.front.approach;
        let solution = self.solution.y1.iter().zip(&self.solution.y2);
        let pressures = solution.map(|(y1, y2)| y1 + approach * y2);
        let least = -tolerance * pressures.clone().fold(0.0, f64::max);
        let mut nodes = self.contact.iter().copied().zip(pressures);
        nodes.find(|(_, pressure)| pressure.is_nan() || *pressure < least)
    }

    /// That a quantity of a node has the wrong sign at the front.
    pub(super) fn not_monotone(&self, quantity: &'static str, node: usize, value: f64) -> Error {
        let (ix, iy) = self.grid.coordinates(node);
        Error::NotMonotone {
            quantity,
            ix,
            iy,
            approach: self.front.approach,
            value,
        }
    }

    /// The path cannot go on although nodes are left: none of their gaps closes.
    fn growth_stopped(&self) -> Error {
        let node = self.ranking.iter().map(|&(_, node)| node).min();
        self.not_monotone("closing rate of the gap", node.unwrap_or_default(), 0.0)
    }
}
