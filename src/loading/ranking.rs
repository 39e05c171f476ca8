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
    ranking.clear();
    ranking.reserve(run.problem.grid().nodes());
    run.survey(true, |line| ranking.push((line.touches(), line.node)))?;
    run.timings.choice += start.elapsed();
    Ok(())
}
