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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::loading::row;

    /// Nodes 0 and 2 are in contact, with rates of 1/2 and another one.
    fn ranked(rate: f64) -> Result<Ranking, Error> {
        let given = row::Altered::given(vec![1.0; 2], vec![0.5, rate]);
        let mut run = row::run(&[0.0, 4.0, 0.0, 9.0, 3.0], given)?;
        run.contact.push(0)?;
        run.contact.push(2)?;
        run.solve_field(2.0, 1.0)?;
        run.front.place_at(2.0);
        let mut ranking = Ranking::new();
        rank(&mut run, &mut ranking)?;
        Ok(ranking)
    }

    /// Node 1 has sunk by 2 and sinks by 3/4 for each metre, node 3 by 1 and 1/4, and node 4 not at all: gaps of 4, 8 and 1 over
    /// what is left of 1.
    #[test]
    fn nodes_are_ranked_by_their_times() -> Result<(), Error> {
        let ranking = ranked(0.25)?;
        for ((found, node), expected) in
            ranking
                .into_iter()
                .zip([(16.0, 1), (8.0 / 0.75, 3), (1.0, 4)])
        {
            assert!(
                (found - expected.0).abs() < 1e-12 && node == expected.1,
                "{found} {node}"
            );
        }
        Ok(())
    }

    /// Rates of contact that grows are not below nothing by more than rounding, 10⁻¹⁰ of the greatest.
    #[test]
    fn contact_that_shrinks_is_refused() {
        for (rate, is_refused) in [(-4.9e-11, false), (-5.1e-11, true), (f64::NAN, true)] {
            let found = ranked(rate);
            assert_eq!(found.is_err(), is_refused, "{rate:e}");
            if is_refused {
                assert!(matches!(
                    found,
                    Err(Error::NotMonotone { ix: 2, iy: 0, .. })
                ));
            }
        }
    }
}
