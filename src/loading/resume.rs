//! A path that goes on where an earlier one stopped.

use super::history::History;
use super::path::LoadingPath;
use super::snapshot::{Snapshot, not_on_path};
use super::state::{ContactEvent, LoadingState};
use crate::contact::{ContactSequence, node_of};
use crate::updater::Left;
use crate::{Error, Grid};

impl LoadingPath {
    /// All states to come, up to the end of the path, with what the body is made of ([`History::on`]).
    ///
    /// # Errors
    ///
    /// The first error of a state. The states before it are lost then, and [`Self::state`] is the last of them: iterate
    /// to keep them.
    pub fn run(&mut self) -> Result<History, Error> {
        let layering = self.layering();
        self.by_ref().collect::<Result<History, Error>>().map(|states| states.on(layering))
    }

    /// Goes on behind states that this path yielded before.
    pub(super) fn go_on(&mut self, history: &History) -> Result<(), Error> {
        self.restore(history)?;
        if let Some(state) = &self.state {
            self.limits.check_ahead(state, false)?;
        }
        match history.window_end() {
            Some(end) if self.follow_on(end)? => Ok(()),
            _ => self.rebuild(),
        }
    }

    /// Puts a path that has not begun behind the states of an earlier one, of the same surface and kernel:
    /// contact and order are taken from them, and nothing is solved yet.
    pub(crate) fn restore(&mut self, history: &History) -> Result<(), Error> {
        let run = &mut self.run;
        let releases = &mut run.releases;
        let Replayed { elastic, .. } =
            replay(&run.problem.grid(), history, |step, event, left| {
                releases.push_event(step, event, left);
            })?;
        run.yield_at(history.states().last().map_or(0, |state| state.step))?;
        // A limit is no event: it comes again if the path is still to end there.
        let events = history.events().iter();
        self.state = events.last().copied();
        if let Some(state) = &self.state {
            run.scalars.place_at(run.scalars.own_approach(&state.contact));
            run.last = run.last.map(|_| state.contact);
        }
        run.contact = elastic;
        Ok(())
    }

    /// Makes the updater that of the restored contact, solves there, and compares the solution with the last
    /// state.
    pub(super) fn rebuild(&mut self) -> Result<(), Error> {
        let Some(last) = self.state else {
            return Ok(());
        };
        let (run, phase) = (&mut self.run, &mut self.phase);
        let order = run.contact.order().to_vec();
        let end = self.limits.expected_nodes(run.problem.grid().nodes(), Some(last.contact));
        if phase.restore(run, &order, end)? {
            self.handed_over_at = Some(order.len());
        }
        run.inherited = last.approach_error;
        phase.renew_field(run, run.scalars.approach())?;
        run.scalars.renew_load(&run.problem, &run.contact, &run.field);
        let snapshot = Snapshot::of(run, phase, &last)?;
        snapshot.recognise(run, phase, &last)?;
        self.rebuilt_at = Some(last.step);
        Ok(())
    }
}

/// The contact after the states of a path.
pub(crate) struct Replayed {
    /// All nodes in contact.
    pub(crate) contact: ContactSequence,
    /// Those that have not yielded.
    elastic: ContactSequence,
}

/// The contact after the states of a path, which are checked to be in an order that a path may have; `left` is told of
/// each node that leaves or yields: the number of the event, which it is, and the node's place among those that have
/// done neither.
pub(crate) fn replay(
    grid: &Grid,
    history: &History,
    mut left: impl FnMut(usize, ContactEvent, Left),
) -> Result<Replayed, Error> {
    let mut contact = ContactSequence::new(*grid);
    let mut elastic = contact.clone();
    let mut step = 0;
    let states = history.states();
    for (k, state) in states.iter().enumerate() {
        let is_last = k + 1 == states.len();
        let node = node_of(grid, state.node)?;
        if state.event != ContactEvent::Limit {
            step += 1;
            match state.event {
                ContactEvent::Release => {
                    contact.remove(node)?;
                    left(step, state.event, Left { node, position: elastic.remove(node)? });
                }
                ContactEvent::Yield => {
                    left(step, state.event, Left { node, position: elastic.remove(node)? });
                }
                _ => {
                    contact.push(node)?;
                    elastic.push(node)?;
                }
            }
        } else if !is_last || step == 0 {
            return Err(not_a_path(
                state,
                ("number of the event", state.step),
                "no limit but the last state",
            ));
        }
        if state.step != step {
            return Err(not_a_path(
                state,
                ("number of the event", state.step),
                "one more than before",
            ));
        }
        if state.contact.contact_nodes != contact.len() {
            return Err(not_a_path(
                state,
                ("number of nodes in contact", state.contact.contact_nodes),
                "that of the events",
            ));
        }
        let yielded = contact.len() - elastic.len();
        let said = state.contact.yielded_nodes();
        if said != yielded {
            return Err(not_a_path(
                state,
                ("number of nodes that have yielded", said),
                "that of the events",
            ));
        }
    }
    Ok(Replayed { contact, elastic })
}

/// States that no path has yielded in this order.
fn not_a_path(
    state: &LoadingState,
    (quantity, value): (&'static str, usize),
    expected: &'static str,
) -> Error {
    not_on_path(state, quantity, value as f64, expected)
}
