//! Events: nodes that touch, one after the other.

use std::time::Instant;

use super::limits::ContactRule;
use super::solver::LoadingSolver;
use super::state::ContactState;
use super::window::Candidate;
use crate::updater::LinearUpdater;
use crate::{Boundary, Error, InfluenceKernel, Surface};

/// How far pressures and gaps may lie below zero, relative to the greatest ones, for a window of an
/// updater that is not exact to be accepted: its order of events is then right but for nodes whose
/// contact differs in approach by some 1e-8.
const VERIFIED: f64 = 1e-7;

/// The same for a state of an exact updater: far above rounding, as in a refresh.
const CHECKED: f64 = 1e-10;
/// Greatest change of the approach at which a node touches, relative to it, that may rest on a
/// Schur complement that is not exact. Only nodes between others in contact change so much; measured,
/// the states of a 256² surface then stay within 5e-8.
const MOST_DRIFT: f64 = 1.5;

impl<S: Surface, K: InfluenceKernel, U: LinearUpdater> LoadingSolver<S, K, U> {
    /// Computes at least one more state, unless the path is at its end. Returns what went wrong
    /// after those computed.
    pub(super) fn produce(&mut self) -> Result<Option<Error>, Error> {
        if self.contact.len() >= self.limits.nodes {
            return Ok(None);
        }
        if self.candidate().is_none() {
            self.refresh()?;
            if self.candidate().is_none() {
                return Err(self.growth_stopped());
            }
        }
        self.checked_event()?;
        if self.updater.is_exact() {
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
            if drifted || ended {
                self.window.give_up(0);
            }
            match self.checked_event() {
                Ok(true) => {}
                Ok(false) => break None,
                Err(error) => break Some(error),
            }
        };
        let whole = self.verify()?;
        Ok(failure.filter(|_| whole))
    }

    /// The next node of the window that touches, if the window still knows.
    fn candidate(&self) -> Option<Candidate> {
        match self.rule {
            ContactRule::FirstContact => self.window.first_contact(),
            ContactRule::SmallestGap => self.window.smallest_gap(self.front.approach),
        }
    }

    /// The next event of the window, with its state checked if contact may not only grow.
    fn checked_event(&mut self) -> Result<bool, Error> {
        let more = self.event()?;
        let unsure = self.rule == ContactRule::FirstContact && !self.contact_only_grows;
        if more
            && unsure
            && let Some(error) = self.contradiction(CHECKED)?
        {
            self.drop_events(1);
            return Err(error);
        }
        Ok(more)
    }

    /// The next event of the window; false if there is none, or none within the limits.
    fn event(&mut self) -> Result<bool, Error> {
        let start = Instant::now();
        let Some(Candidate { position, approach }) = self.candidate() else {
            return Ok(false);
        };
        let previous = self.front.approach;
        let approach = match self.rule {
            // Backward steps are rounding, and ties are intervals of no length.
            ContactRule::FirstContact => approach.max(previous),
            ContactRule::SmallestGap => approach,
        };
        let stiffness = self.grid.cell_area() * self.front.unit_unit;
        let load = self.front.load + stiffness * (approach - previous);
        let reported = approach - self.gauge * load;
        let beyond = load > self.limits.load || reported > self.limits.approach;
        if beyond || self.contact.len() >= self.limits.nodes {
            return Ok(false);
        }
        if !(approach.is_finite() && load.is_finite()) {
            return Err(Error::NotFinite {
                step: self.contact.len() + 1,
            });
        }
        let node = self.window.nodes()[position];
        let (ix, iy) = self.grid.coordinates(node);
        let [_, unit, sum] =
            self.window
                .touch(position)
                .map_err(|pivot| Error::NotPositiveDefinite {
                    ix,
                    iy,
                    approach,
                    pivot,
                })?;
        self.contact.push(node);
        self.in_contact[node] = true;

        let step = self.contact.len();
        let nodes = self.grid.nodes();
        let front = &mut self.front;
        let change = approach - previous;
        front.approach = approach;
        front.energy += 0.5 * (front.load + load) * change;
        front.load = load;
        front.mean_gap -= front.closing * change;
        front.unit_unit += unit * unit;
        front.closing -= sum * unit / nodes as f64;
        if step == nodes {
            // By identity and not by arithmetic.
            front.mean_gap = 0.0;
            front.closing = 0.0;
        }
        if self.rule == ContactRule::FirstContact {
            // Less than nothing is rounding.
            front.mean_gap = front.mean_gap.max(0.0);
        }
        let stiffness = self.grid.cell_area() * front.unit_unit;
        let interfacial_stiffness = stiffness / front.closing;
        let state = ContactState {
            step,
            node: (ix, iy),
            approach: reported,
            load,
            contact_area: step as f64 * self.grid.cell_area(),
            contact_area_fraction: step as f64 / nodes as f64,
            mean_gap: front.mean_gap,
            contact_stiffness: match self.system.table().boundary() {
                Boundary::Free => Some(stiffness),
                Boundary::Periodic => None,
            },
            interfacial_stiffness,
            energy: front.energy - 0.5 * self.gauge * load * load,
        };
        self.ahead.push_back(state);
        if !(state.is_finite() && stiffness.is_finite() && stiffness > 0.0) {
            self.drop_events(1);
            return Err(Error::NotFinite { step });
        }
        self.timings.events += start.elapsed();
        Ok(true)
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

    /// Takes back the last events, and lets the window know no further ones.
    fn drop_events(&mut self, events: usize) {
        self.ahead.truncate(self.ahead.len() - events);
        for node in self.contact.drain(self.contact.len() - events..) {
            self.in_contact[node] = false;
        }
        self.window.give_up(events);
        let last = self.ahead.back().copied().or(self.state);
        self.front.approach = last.map_or(0.0, |state| self.gauged_approach(&state));
    }

    /// Whose pressure or gap at the front is negative by more than `tolerance`, relative to the
    /// greatest pressure and to the lengths of the problem.
    fn contradiction(&mut self, tolerance: f64) -> Result<Option<Error>, Error> {
        self.solve(self.contact.len())?;
        let approach = self.front.approach;
        let grid = self.grid;
        let contradiction = |quantity, node, value| {
            let (ix, iy) = grid.coordinates(node);
            Ok(Some(Error::NotMonotone {
                quantity,
                ix,
                iy,
                approach,
                value,
            }))
        };
        let solution = self.solution.y1.iter().zip(&self.solution.y2);
        let pressures = solution.map(|(y1, y2)| y1 + approach * y2);
        let greatest = pressures.clone().fold(0.0, f64::max);
        for (&node, pressure) in self.contact.iter().zip(pressures) {
            if pressure < -tolerance * greatest {
                return contradiction("pressure", node, pressure);
            }
        }
        let overlap = -tolerance * (self.greatest_gap + approach);
        let [u1, u2] = self.fields.displacements(&self.contact, &self.solution)?;
        let gaps = self.system.gap().iter().zip(u1).zip(u2);
        for (node, ((gap, u1), u2)) in gaps.enumerate() {
            let gap = gap + u1 - approach * (1.0 - u2);
            if !self.in_contact[node] && gap < overlap {
                return contradiction("gap", node, gap);
            }
        }
        Ok(None)
    }

    /// The path cannot go on although nodes are left: none of their gaps closes.
    fn growth_stopped(&self) -> Error {
        let nodes = self.ranking.iter().map(|&(_, node)| node);
        let (ix, iy) = self.grid.coordinates(nodes.min().unwrap_or_default());
        Error::NotMonotone {
            quantity: "closing rate of the gap",
            ix,
            iy,
            approach: self.front.approach,
            value: 0.0,
        }
    }
}
