//! Nodes out of contact by the time at which they would touch.

use std::time::Instant;

use super::run::{LoadingRun, TOLERANCE};
use crate::Error;
use crate::updater::LinearUpdater;

/// (time, node) of the nodes out of contact: when each would touch if no other did.
pub(super) type Ranking = Vec<(f64, usize)>;

/// Ranks the nodes out of contact by the time at which they would touch if no other did, after
/// checking that contact still grows.
pub(super) fn rank<U: LinearUpdater>(
    run: &mut LoadingRun<U>,
    ranking: &mut Ranking,
) -> Result<(), Error> {
    let start = Instant::now();
    let least = -TOLERANCE * run.greatest_rate();
    let rates = run.contact.order().iter().zip(&run.field.solution().rate);
    for (&node, &y2) in rates {
        if y2.is_nan() || y2 < least {
            return Err(run.not_monotone("pressure per unit of approach", node, y2));
        }
    }
    fill(run, ranking, true)?;
    run.timings.choice += start.elapsed();
    Ok(())
}

/// Surveys all gaps at the front, and ranks them. With `check` an overlap is an error.
pub(super) fn fill<U: LinearUpdater>(
    run: &mut LoadingRun<U>,
    ranking: &mut Ranking,
    check: bool,
) -> Result<(), Error> {
    ranking.clear();
    ranking.reserve(run.problem.grid().nodes());
    run.survey(check, |line| ranking.push((line.touches(), line.node)))
}
