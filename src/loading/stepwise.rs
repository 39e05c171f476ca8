//! One event at a time: nodes that touch and nodes that leave, for kernels of which nothing is
//! known.

use std::time::Instant;

use super::events::CHECKED;
use super::solver::LoadingSolver;
use super::state::ContactEvent;
use crate::updater::{LinearUpdater, RecursiveCholesky, Solution, Touched};
use crate::{ContactGrowth, ContactRule, Error, InfluenceKernel, Surface};

/// Events closer than this in approach, relative to it, are taken to be simultaneous: well above the
/// rounding errors of a ratio of two solutions, and below what a state may be off.
const TIE: f64 = 1e-13;
/// Events at a single approach, for each node of the grid, after which no end of them is expected.
/// Nodes that touch and leave together are sorted out by the least index among them, which comes to
/// an end (Murty 1974), in practice after one or two events a node.
const TIED_EVENTS: usize = 20;

/// What happens next if nothing else does.
#[derive(Debug, Clone, Copy)]
pub(super) struct Upcoming {
    approach: f64,
    node: usize,
    event: ContactEvent,
}

/// A node that left the contact.
#[derive(Debug, Clone, Copy)]
pub(super) struct Release {
    /// The number of the event.
    step: usize,
    node: usize,
    /// Where it was in the order of contact.
    position: usize,
}

/// What a path that goes one event at a time keeps beside its front.
#[derive(Debug, Default)]
pub(super) struct Stepwise {
    upcoming: Option<Upcoming>,
    /// All nodes that left, in the order in which they did.
    releases: Vec<Release>,
    /// The contact of this and all later steps is a prefix of what the updater holds.
    updater_since: usize,
    /// Events so far at the approach of the front.
    tied: usize,
}

impl<S: Surface, K: InfluenceKernel, U: LinearUpdater> LoadingSolver<S, K, U> {
    /// Whether nodes may leave the contact, so that every event needs a solution of its own.
    pub(super) fn is_stepwise(&self) -> bool {
        self.growth == ContactGrowth::Unknown && self.rule == ContactRule::FirstContact
    }

    /// Number of events up to the front.
    pub(super) fn steps(&self) -> usize {
        // A node that touched and left is two events, and not in contact.
        self.contact.len() + 2 * self.stepwise.releases.len()
    }

    /// Computes the next state, unless the path is at its end.
    pub(super) fn step(&mut self) -> Result<(), Error> {
        if self.steps() == 0 {
            self.survey()?;
        }
        let Some(next) = self.stepwise.upcoming.take() else {
            return Ok(());
        };
        let approach = next.approach.max(self.front.approach);
        let touches = next.event == ContactEvent::Touch;
        if touches && self.contact.len() >= self.limits.nodes {
            return Ok(());
        }
        let Some(load) = self.load_within_limits(approach)? else {
            return Ok(());
        };
        self.count_tie(approach)?;
        if touches {
            self.touch(next.node, approach)?;
        } else {
            self.release(next.node)?;
        }
        self.advance_front(approach, load);
        let checked = self
            .survey()
            .and_then(|()| self.state_of(next.node, next.event));
        match checked {
            Ok(state) => self.ahead.push_back(state),
            Err(error) => {
                self.undo(next.event);
                return Err(error);
            }
        }
        Ok(())
    }

    /// Refuses to go on for ever at one approach.
    fn count_tie(&mut self, approach: f64) -> Result<(), Error> {
        if approach > self.front.approach {
            self.stepwise.tied = 0;
        }
        self.stepwise.tied += 1;
        let events = self.stepwise.tied;
        if events > TIED_EVENTS * (self.grid.nodes() + 1) {
            return Err(Error::Cycling { approach, events });
        }
        Ok(())
    }

    /// Adds a node to the contact and to the updater.
    fn touch(&mut self, node: usize, approach: f64) -> Result<(), Error> {
        self.affordable(self.contact.len(), 1)?;
        self.ranking.clear();
        self.ranking.push((approach, node));
        self.watch(1, f64::INFINITY)?;
        self.touch_watched(0, approach)?;
        self.commit()
    }

    /// Takes a node out of the contact and out of the updater.
    fn release(&mut self, node: usize) -> Result<(), Error> {
        let Some(position) = self.contact.iter().position(|&other| other == node) else {
            return Ok(());
        };
        let step = self.steps() + 1;
        self.updater.release(&self.system, node)?;
        self.contact.remove(position);
        self.in_contact[node] = false;
        self.committed -= 1;
        self.solved = None;
        self.stepwise.updater_since = step;
        self.stepwise.releases.push(Release {
            step,
            node,
            position,
        });
        Ok(())
    }

    /// Takes a node that left back into the order of contact, so that states before are found there.
    /// The updater stays without it. A node that touched may stay where it is: behind all others.
    fn undo(&mut self, event: ContactEvent) {
        if event == ContactEvent::Release
            && let Some(Release { node, position, .. }) = self.stepwise.releases.pop()
        {
            self.contact.insert(position, node);
            self.in_contact[node] = true;
        }
    }

    /// Solves at the front, checks the conditions of contact there, and finds the next event.
    fn survey(&mut self) -> Result<(), Error> {
        self.solve(self.contact.len())?;
        if let Some((node, value)) = self.negative_pressure(CHECKED) {
            return Err(self.not_monotone("pressure", node, value));
        }
        self.renew_stiffness();
        self.rank()?;
        let start = Instant::now();
        self.stepwise.upcoming = self.first_event();
        self.timings.choice += start.elapsed();
        self.timings.windows += 1;
        Ok(())
    }

    /// The next event: of all that would come first, or within rounding of it, that of the node of
    /// lowest index.
    fn first_event(&self) -> Option<Upcoming> {
        let front = self.front.approach;
        let upcoming = |event, node, approach: f64| Upcoming {
            approach: approach.max(front),
            node,
            event,
        };
        let touches = self.ranking.iter();
        let touches = touches.map(|&(key, node)| upcoming(ContactEvent::Touch, node, key));
        let Solution { y1, y2 } = &self.solution;
        let slowest = self.slowest_release();
        let releases = self.contact.iter().zip(y1).zip(y2);
        let releases = releases
            .filter(|(_, y2)| **y2 < slowest)
            .map(|((&node, y1), y2)| upcoming(ContactEvent::Release, node, -y1 / y2));
        let events = touches.chain(releases);
        let first = events
            .clone()
            .map(|event| event.approach)
            .fold(f64::INFINITY, f64::min);
        let tied = first + TIE * first;
        events
            .filter(|event| event.approach <= tied && event.approach < f64::INFINITY)
            .min_by_key(|event| event.node)
    }

    /// The contact nodes at a step up to the front, in the order in which they touched.
    fn contact_at(&self, step: usize) -> Vec<usize> {
        let mut contact = self.contact.clone();
        let mut last = self.steps();
        let releases = self.stepwise.releases.iter().rev();
        for release in releases.take_while(|release| release.step > step) {
            // Those that touched after it.
            contact.truncate(contact.len() + release.step - last);
            contact.insert(release.position, release.node);
            last = release.step - 1;
        }
        contact.truncate((contact.len() + step).saturating_sub(last));
        contact
    }

    /// Solves at a step up to the front; returns the nodes in contact there.
    pub(super) fn solve_at(&mut self, step: usize) -> Result<Vec<usize>, Error> {
        let contact = self.contact_at(step);
        if step >= self.stepwise.updater_since {
            self.solve(contact.len())?;
            return Ok(contact);
        }
        // Nodes of that contact have left the updater since.
        self.solved = None;
        let count = contact.len();
        let own = self.updater.bytes(self.contact.len(), 0);
        let rebuilt = RecursiveCholesky::bytes_of(count);
        let needed = self.fixed_bytes().saturating_add(own);
        let needed = needed.saturating_add(rebuilt);
        if needed > self.memory_budget {
            return Err(Error::MemoryBudget {
                needed,
                budget: self.memory_budget,
                nodes_that_fit: self.contact.len(),
            });
        }
        let mut updater = RecursiveCholesky::of(&self.system, &contact)?;
        let none = Touched::default();
        updater.solve(&self.system, &none, count, &mut self.solution)?;
        Ok(contact)
    }
}
