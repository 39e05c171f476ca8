//! Where a path is in its windows: what a record keeps besides states, so that a path that goes on is the one that was not
//! interrupted.

use super::phase::Phase;
use super::refined::resumed::RefinedEnd;
use super::snapshot::{Snapshot, not_on_path};
use super::solver::{LoadingSolver, Procedure};
use super::state::{ContactEvent, LoadingState};
use crate::Error;
use crate::updater::LinearUpdater;

/// The end of the last window that a path has computed, which lies ahead of the state that it has yielded.
///
/// What later windows depend on, besides surface, kernel, settings and the states up to here:
///
/// | | with a factor | without |
/// |---|---|---|
/// | `ahead` | the states of the window that are yet to come: the contact at its end | the same |
/// | `handed_over_at` | | when the factor was given up, which memory may have decided |
/// | `next` | the nodes that were watched and have not touched, whose order the next window keeps | [`RefinedEnd`] and [`Kept`](crate::updater::Kept) |
///
/// A factor is made again of the contact, in other blocks than before: its numbers differ by rounding, the windows do not. Nothing else
/// is remembered from window to window. Timings are not kept.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct WindowEnd {
    pub(crate) ahead: Vec<LoadingState>,
    pub(crate) handed_over_at: Option<usize>,
    pub(crate) next: NextWindow,
}

/// What the next window begins with.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum NextWindow {
    /// The nodes that were watched and have not touched.
    Factor(Vec<usize>),
    Iterations(Box<RefinedEnd>),
}

impl<U: LinearUpdater> LoadingSolver<U> {
    /// The end of the last window behind the state that was yielded last; `None` before the first one, behind an error, and for paths of
    /// which it is not known: nodes that leave or yield.
    pub(crate) fn window_end(&self) -> Option<WindowEnd> {
        if self.state.is_none() || self.failure.is_some() {
            return None;
        }
        let Procedure::Windows(windowed, refined) = &self.procedure else {
            return None;
        };
        let next = match &self.phase {
            Phase::Factor { .. } => NextWindow::Factor(windowed.untouched()),
            Phase::Iterations(iterations) => {
                NextWindow::Iterations(Box::new(refined.end(&self.run, &**iterations)?))
            }
        };
        let ahead = self.run.queue.iter().copied().collect();
        Some(WindowEnd { ahead, handed_over_at: self.handed_over_at, next })
    }

    /// Goes on at the end of a window behind the last of the states that were restored. Returns false, and nothing has changed, if
    /// this path does not go on so: with another updater or rule, or with too little memory for it.
    pub(super) fn follow_on(&mut self, end: &WindowEnd) -> Result<bool, Error> {
        let (Some(last), Procedure::Windows(windowed, refined)) = (self.state, &mut self.procedure)
        else {
            return Ok(false);
        };
        let (run, phase) = (&mut self.run, &mut self.phase);
        let mut contact = run.contact.clone();
        for (state, step) in end.ahead.iter().zip(last.step + 1..) {
            let nodes = contact.len() + 1;
            let is_next = state.step == step
                && state.event == ContactEvent::Touch
                && state.contact.contact_nodes == nodes;
            if !is_next || !state.contact.is_finite() || state.approach_error.is_nan() {
                let number = state.step as f64;
                return Err(not_on_path(
                    state,
                    "number of the event",
                    number,
                    "one more than before",
                ));
            }
            let (ix, iy) = state.node;
            contact.push(run.problem.grid().node(ix, iy).unwrap_or(usize::MAX))?;
        }
        let restored = match &end.next {
            NextWindow::Factor(_) => phase.restore_factor(run, &contact)?,
            NextWindow::Iterations(end) if refined.can_follow(end) => {
                phase.restore_iterations(run, &contact, end)?
            }
            NextWindow::Iterations(_) => false,
        };
        if !restored {
            return Ok(false);
        }
        run.contact = contact;
        let snapshot = Snapshot::of(run, phase, &last)?;
        snapshot.recognise(run, phase, &last)?;
        let front = end.ahead.last().unwrap_or(&last);
        match (&end.next, phase) {
            (NextWindow::Factor(untouched), phase) => {
                run.problem.check_nodes(untouched)?;
                windowed.follow_on(untouched);
                run.scalars.place_at(run.scalars.own_approach(&front.contact));
                phase.renew_field(run, run.scalars.approach())?;
                run.scalars.renew_load(&run.problem, &run.contact, &run.field);
            }
            (NextWindow::Iterations(end), Phase::Iterations(iterations)) => {
                refined.follow_on(run, &mut **iterations, end)?;
            }
            _ => {}
        }
        run.last = run.last.map(|_| front.contact);
        run.queue = end.ahead.iter().copied().collect();
        self.handed_over_at = end.handed_over_at;
        Ok(true)
    }
}
