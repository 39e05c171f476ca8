//! The paper's procedure: the node with the smallest gap, one at a time.

use super::gap_field::Line;
use super::run::LoadingRun;
use super::scales::Scales;
use super::state::ContactEvent;
use super::window::Window;
use crate::Error;
use crate::updater::LinearUpdater;

/// Adds the node with the smallest gap at present (the paper's step 4), with one convolution and one row of
/// the factor for each. It is not exact: see [`ContactRule::SmallestGap`](super::ContactRule).
#[derive(Debug, Default)]
pub(super) struct Paper {
    window: Window,
}

impl Paper {
    /// Computes one state.
    pub(super) fn produce<U: LinearUpdater>(
        &mut self,
        run: &mut LoadingRun<U>,
    ) -> Result<(), Error> {
        run.affordable(1)?;
        run.renew_field(run.front.approach())?;
        let mut smallest: Option<Line> = None;
        run.survey(false, |line| {
            if smallest.is_none_or(|smallest| line.gap < smallest.gap) {
                smallest = Some(line);
            }
        })?;
        let Some(line) = smallest else {
            return Ok(());
        };
        run.watch(&mut self.window, std::iter::once(line), f64::INFINITY)?;
        // It may go back to an approach at which the node touches.
        let time = line.gap / line.closing;
        if !time.is_finite() {
            return Err(run.not_finite());
        }
        let touched = self.window.touch(0, time);
        touched.map_err(|bad| run.not_positive_definite(bad))?;
        run.join(&self.window)?;
        let contact_nodes = run.contact.len();
        run.front.advance(run.front.approach() + time);
        for event in self.window.events() {
            run.front
                .touch(event.unit_stiffness, event.closing, contact_nodes);
        }
        let (front, event) = (run.front, (run.steps(), ContactEvent::Touch, line.node));
        let error = Scales::of(run).overlap(front.approach()) / line.closing.abs();
        run.enqueue_at(
            &front,
            event,
            contact_nodes,
            front.reported_error(error, 0.0),
        )
    }
}
