//! The paper's procedure: the node with the smallest gap, one at a time.

use super::gap_field::GapLine;
use super::phase::Phase;
use super::run::LoadingRun;
use super::state::ContactEvent;
use super::tolerances::WindowTolerances;
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
        run: &mut LoadingRun,
        phase: &mut Phase<U>,
    ) -> Result<(), Error> {
        let approach = run.scalars.approach();
        phase.renew_field(run, approach)?;
        let mut smallest: Option<(usize, GapLine)> = None;
        run.survey(false, |node, line| {
            if smallest.is_none_or(|(_, smallest)| line.gap < smallest.gap) {
                smallest = Some((node, line));
            }
        })?;
        let Some((node, line)) = smallest else {
            return Ok(());
        };
        // It may go back to an approach at which the node touches.
        let time = line.gap / line.closing;
        if !time.is_finite() {
            return Err(run.not_finite());
        }
        phase.admit(run, &mut self.window, (node, time))?;
        let contact_nodes = run.contact.len();
        run.scalars.advance(approach + time);
        if let Phase::Factor { .. } = phase {
            for increments in self.window.increments() {
                run.scalars.touch(*increments, contact_nodes);
            }
        } else {
            phase.renew_field(run, approach + time)?;
            run.scalars.renew_stiffness(run.field.solution());
            run.survey(false, |_, _| {})?;
        }
        let (scalars, event) = (run.scalars, (run.steps(), ContactEvent::Touch, node));
        let tolerances = WindowTolerances::of(run, phase.tolerance());
        let error = tolerances.overlap(scalars.approach()) / line.closing.abs();
        let error = scalars.reported_error(error, 0.0);
        run.enqueue_at(&scalars, event, contact_nodes, error)
    }
}
