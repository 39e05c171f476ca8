//! States of a window, pinned to the exact ones at both ends.

use super::correction::Correction;
use super::play::increments;
use super::ties::Settled;
use super::watched::Watched;
use crate::Error;
use crate::loading::front::Front;
use crate::loading::run::LoadingRun;
use crate::loading::state::ContactEvent;
use crate::updater::LinearUpdater;

/// Queues the states of the events of a window from `start` to the front.
///
/// Stiffness and closing rate grow as the pivots say, all of them scaled so that they end where they should;
/// load, mean gap and energy follow by integration, and what they lack at the end, a few parts in a million,
/// is spread along the way.
pub(super) fn enqueue<U: LinearUpdater>(
    run: &mut LoadingRun<U>,
    watched: &Watched,
    correction: &Correction,
    settled: &Settled,
    (start, time): (&Front, f64),
) -> Result<(), Error> {
    let closing: Vec<f64> = watched.lines.iter().map(|[_, b]| *b).collect();
    let order = settled.events.iter().map(|event| event.position);
    let steps = increments(&correction.schur, &closing, &watched.row_sums, order);
    let missing = start.missing(&run.front);
    let total = |k: usize| steps.iter().map(|step| step[k]).sum::<f64>();
    let scaled = [0, 1].map(|k| {
        if total(k) == 0.0 {
            0.0
        } else {
            missing[k] / total(k)
        }
    });
    let count = run.contact.len() - settled.events.len();
    let mut walked = *start;
    let mut fronts = Vec::with_capacity(settled.events.len());
    for (k, (event, step)) in settled.events.iter().zip(&steps).enumerate() {
        walked.advance(start.approach() + event.time);
        walked.touch(scaled[0] * step[0], scaled[1] * step[1], count + k + 1);
        fronts.push(walked);
    }
    walked.advance(run.front.approach());
    for (k, (mut front, event)) in fronts.into_iter().zip(&settled.events).enumerate() {
        let contact_nodes = count + k + 1;
        front.pin(&walked, &run.front, event.time / time);
        front.clamp_mean_gap();
        if contact_nodes == run.problem.grid().nodes() {
            front.close();
        }
        let step = run.releases.steps(contact_nodes);
        let node = watched.nodes[event.position];
        let error = settled.errors[k];
        run.enqueue_at(
            &front,
            (step, ContactEvent::Touch, node),
            contact_nodes,
            error,
        )?;
    }
    Ok(())
}
