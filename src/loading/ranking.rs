//! Nodes by the time at which they would touch, or yield.

use super::contradiction::Slack;
use super::gap_field::GapLine;
use super::plastic::Plastic;
use super::run::LoadingRun;
use super::scalars::{PlasticScalars, Rates};
use super::sum::Sum;
use super::tolerances::ties_from;
use super::tuning::{LEAST_RATE, TOLERANCE};
use crate::Error;
use crate::clock::Stopwatch;

/// (time, node) of the nodes that may touch or yield; whoever fills it says which time that is.
pub(super) type Ranking = Vec<(f64, usize)>;

/// Ranks the nodes out of contact by the time from which on they tie with one that touches, if no other joined, after
/// checking that contact still grows. Where nodes may leave, gaps may open, and those that do not close never touch.
/// Returns when the first would touch.
pub(super) fn rank(run: &mut LoadingRun, ranking: &mut Ranking) -> Result<f64, Error> {
    let start = Stopwatch::start();
    let may_leave = run.may_leave();
    if !may_leave {
        check_growth(run)?;
    }
    let (approach, mut first) = (run.scalars.approach(), f64::INFINITY);
    let sound = -TOLERANCE * (run.problem.greatest_gap() + approach);
    let mut is_sound = true;
    fill(run, ranking, Some(run.inherited_slack()), |line| {
        is_sound &= line.gap >= sound;
        if may_leave && line.closing <= LEAST_RATE {
            return f64::INFINITY;
        }
        first = first.min(line.touches());
        ties_from(approach, *line)
    })?;
    if is_sound {
        run.inherited = 0.0;
    }
    run.timings.choice += start.elapsed();
    Ok(first)
}

/// Checks that the pressure of no node in contact falls.
fn check_growth(run: &LoadingRun) -> Result<(), Error> {
    let least = -TOLERANCE * run.greatest_rate();
    let mut rates = run.contact.order().iter().zip(&run.field.solution().rate);
    match rates.find(|(_, rate)| rate.is_nan() || **rate < least) {
        Some((&node, &rate)) => Err(run.not_monotone("pressure per unit of approach", node, rate)),
        None => Ok(()),
    }
}

/// Looks at all gaps at the present approach, and ranks them by a time. With `allowed`, the overlap that a solution may
/// leave, more than that and than rounding is an error.
pub(super) fn fill(
    run: &mut LoadingRun,
    ranking: &mut Ranking,
    allowed: Option<f64>,
    mut time: impl FnMut(&GapLine) -> f64,
) -> Result<(), Error> {
    ranking.clear();
    ranking.reserve(run.problem.grid().nodes());
    run.survey(allowed, |node, line| ranking.push((time(&line), node)))
}

/// Ranks the nodes in contact that would yield before the last of the ranked ones touches. Returns when the first of
/// them would, and when the first of the others.
pub(super) fn rank_yields(run: &LoadingRun, ranking: &mut Ranking) -> [f64; 2] {
    let (mut first, mut beyond) = (f64::INFINITY, f64::INFINITY);
    let Some(plastic) = &run.plastic else {
        return [first, beyond];
    };
    let times = ranking.iter().map(|&(time, _)| time);
    let last = times.filter(|time| time.is_finite()).fold(f64::NEG_INFINITY, f64::max);
    let hardness = plastic.hardness().values();
    let pressures = run.field.pressures(&run.contact, run.scalars.approach());
    for ((node, pressure), rate) in pressures.zip(&run.field.solution().rate) {
        let time = ((hardness[node] - pressure) / rate).max(0.0);
        if *rate > 0.0 && time < f64::INFINITY {
            if time <= last || last == f64::NEG_INFINITY {
                ranking.push((time, node));
                first = first.min(time);
            } else {
                beyond = beyond.min(time);
            }
        }
    }
    [first, beyond]
}

/// Checks that contact grows, ranks all nodes that may touch or yield, and takes the scalars from the solution. Returns
/// the rates.
pub(super) fn survey(
    run: &mut LoadingRun,
    plastic: &Plastic,
    ranking: &mut Ranking,
    slack: Slack,
) -> Result<Rates, Error> {
    let start = Stopwatch::start();
    let approach = run.scalars.approach();
    let hardness = plastic.hardness().values();
    let gaps = plastic.surface().initial_gap();
    let least_gap = -slack.gap;
    let least_rate = -slack.rate * run.greatest_rate();
    ranking.clear();
    let [mut load, mut energy, mut mean_gap, mut closing] = [Sum::default(); 4];
    let [mut depth, mut work, mut depth_rate, mut work_rate] = [Sum::default(); 4];
    let mut unit_stiffness = Sum::default();
    let rates = &run.field.solution().rate;
    for ((node, pressure), &rate) in run.field.pressures(&run.contact, approach).zip(rates) {
        if rate.is_nan() || rate < least_rate {
            return Err(run.not_monotone("pressure per unit of approach", node, rate));
        }
        load.add(pressure);
        energy.add(pressure * (approach - gaps[node]));
        unit_stiffness.add(rate);
        let left = hardness[node] - pressure;
        let time = (left / rate).max(0.0);
        if rate > 0.0 && time < f64::INFINITY {
            ranking.push((time, node));
        }
    }
    for (node, line) in run.field.lines(&run.problem, &run.contact, approach) {
        if line.gap.is_nan() {
            return Err(run.not_finite());
        }
        let grows = line.closing >= -slack.rate;
        if plastic.has_yielded(node) {
            if !grows {
                let quantity = "rate of the plastic depth";
                return Err(run.not_monotone(quantity, node, line.closing));
            }
            if line.gap > -least_gap {
                return Err(run.not_monotone("plastic depth", node, -line.gap));
            }
            let hardness = hardness[node];
            load.add(hardness);
            energy.add(hardness * (approach - gaps[node] + line.gap));
            depth.add(-line.gap);
            work.add(-(hardness * line.gap));
            depth_rate.add(line.closing);
            work_rate.add(hardness * line.closing);
        } else {
            if line.gap < least_gap {
                return Err(run.not_monotone("gap", node, line.gap));
            }
            mean_gap.add(line.gap);
            closing.add(line.closing);
            if line.closing > 0.0 {
                ranking.push((line.touches().max(0.0), node));
            }
        }
    }
    let rates = Rates {
        unit_stiffness: unit_stiffness.total(),
        closing: closing.total(),
        plastic: [depth_rate.total(), work_rate.total()],
    };
    run.scalars.renew_gap(mean_gap, closing);
    run.scalars.renew_plastic(
        [load, energy],
        PlasticScalars {
            nodes: plastic.count(),
            depth: depth.total(),
            work: work.total(),
            rates: rates.plastic,
        },
    );
    run.scalars.change_rates(rates, [run.contact.len(), plastic.count()], plastic.sum());
    run.timings.choice += start.elapsed();
    Ok(rates)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::loading::test_chain;

    /// Nodes 0 and 2 are in contact, with rates of 1/2 and another one.
    fn ranked(rate: f64) -> Result<Ranking, Error> {
        let mut given = test_chain::Altered::given(vec![1.0; 2], vec![0.5, rate]);
        let mut run = test_chain::run(&[0.0, 4.0, 0.0, 9.0, 3.0])?;
        run.contact.push(0)?;
        run.contact.push(2)?;
        run.advance_field(&mut given, 2.0, 1.0)?;
        run.scalars.place_at(2.0);
        let mut ranking = Ranking::new();
        let first = rank(&mut run, &mut ranking)?;
        assert!(rate != 0.25 || (first - 1.0).abs() < 1e-12, "{first}");
        Ok(ranking)
    }

    /// Node 1 has sunk by 2 and sinks by 3/4 for each metre, node 3 by 1 and 1/4, and node 4 not at all: gaps of 4, 8
    /// and 1 over what is left of 1. They tie from when on their gaps are 10⁻¹³ of the approach.
    #[test]
    fn nodes_are_ranked_by_their_times() -> Result<(), Error> {
        let ranking = ranked(0.25)?;
        let expected = [(16.0, 0.25, 1), (8.0 / 0.75, 0.75, 3), (1.0, 1.0, 4)];
        for ((found, node), (touches, closing, expected)) in ranking.into_iter().zip(expected) {
            let time = touches - 1e-13 * (2.0 + touches) / closing;
            assert!((found - time).abs() < 1e-13 && node == expected, "{found} {node}");
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
                assert!(matches!(found, Err(Error::NotMonotone { ix: 2, iy: 0, .. })));
            }
        }
    }
}
