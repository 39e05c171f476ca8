//! Events that come together, too many to be watched: a flat punch, a plateau.

use super::choice::Candidates;
use super::states::{Passed, completed, enqueue_together};
use super::{Estimated, closing, go_to, slacks};
use crate::Error;
use crate::loading::contradiction::Slack;
use crate::loading::run::LoadingRun;
use crate::loading::scalars::Rates;
use crate::loading::state::ContactEvent;
use crate::loading::tolerances::WindowTolerances;
use crate::loading::trial::Trial;
use crate::loading::tuning::{MOST_TIES, PART, TOLERANCE};
use crate::loading::walk::Carried;
use crate::updater::{Behind, Iterations};

/// A node, and whether it touches or yields.
type NodeEvent = (usize, ContactEvent);

impl Estimated {
    /// Lets all nodes whose event is at a time touch or yield, and those that are known to, in the order of their
    /// indices.
    pub(super) fn enter(
        &mut self,
        run: &mut LoadingRun,
        iterations: &mut dyn Iterations,
        tolerances: &WindowTolerances,
        (time, known): (f64, &[usize]),
    ) -> Result<(), Error> {
        let places = if run.plastic.is_some() { run.contact.places() } else { Vec::new() };
        let rate_of = |node: usize| closing(run, node, places.get(node).copied().flatten());
        let tie_of = |node: usize| tolerances.tie_of(rate_of(node));
        let together =
            |&&(other, node): &&(f64, usize)| other <= time + tie_of(node) || known.contains(&node);
        let group = self.ranking.iter().filter(together);
        let mut group: Vec<usize> = group.map(|&(_, node)| node).collect();
        // Times closer than this cannot be told apart.
        let error = group.iter().map(|&node| tie_of(node)).fold(tolerances.tie, f64::max);
        // The same with what pressures of the present solution may be off by.
        let open = group.iter().map(|&node| self.left / rate_of(node));
        let most_late = open.fold(error, f64::max);
        group.sort_unstable();
        let kind = |node: usize| match run.contact.contains(node) {
            true => ContactEvent::Yield,
            false => ContactEvent::Touch,
        };
        let events: Vec<NodeEvent> = group.iter().map(|&node| (node, kind(node))).collect();

        let passed = Passed { start: run.scalars, before: Carried::of(run), span: time };
        let before = run.before();
        match self.pass_together(run, iterations, tolerances, (&events, time, most_late)) {
            Ok((rates, late)) => {
                self.last_span = self.last_span.max(time + late);
                let joined = run.contact.order().iter().copied();
                self.joined = joined.filter(|&node| !before.contact.contains(node)).collect();
                enqueue_together(run, &events, passed, (&rates, error.max(late)))
            }
            Err(error) => {
                run.go_back(before);
                let _ = iterations.cut(&run.problem, &run.contact);
                Err(error)
            }
        }
    }

    /// Lets the path follow events that come together after a time, up to `most_late` later: in windows with a solution
    /// behind each. Returns the rates behind each event, and how much later they are.
    fn pass_together(
        &mut self,
        run: &mut LoadingRun,
        iterations: &mut dyn Iterations,
        tolerances: &WindowTolerances,
        (events, time, most_late): (&[NodeEvent], f64, f64),
    ) -> Result<(Vec<Rates>, f64), Error> {
        let approach = run.scalars.approach() + time;
        let mut rates = Vec::with_capacity(events.len());
        let mut left = events;
        loop {
            // Where few gaps are open each counts for much of what is left of the closing rate.
            let open = run.problem.grid().nodes() - run.contact_nodes();
            let size = (open / PART).clamp(self.size, MOST_TIES * self.size);
            let (now, later) = left.split_at(size.min(left.len()));
            left = later;
            let nodes = now.iter().map(|&(node, _)| (0.0, node)).collect();
            let candidates = Candidates { nodes, horizon: 0.0, group: None };
            let mut window = self.propose(run, iterations, candidates, 0.0)?;
            let positions = now.iter().filter_map(|&(node, _)| window.position(node));
            for position in positions.collect::<Vec<_>>() {
                window.happen(position, 0.0).map_err(|bad| run.not_positive_definite(bad))?;
            }
            let trial = Trial::of(run, now)?;
            // The path goes on from the solution of the last window only. Rates must be exact there, even if so many
            // nodes leave few gaps open.
            let is_last = left.is_empty();
            self.rate_span = if is_last { f64::INFINITY } else { 0.0 };
            go_to(run, iterations, &trial, (approach, self.rate_span))?;
            let late = if is_last {
                self.follow_late(run, iterations, tolerances, (&trial, approach, most_late))?
            } else {
                0.0
            };
            trial.adopt(run);
            run.scalars.place_at(approach + late);
            let before = self.rates;
            if is_last {
                self.survey_late(run, tolerances, late)?;
            } else {
                // Events at this approach are still to come: until then their nodes may overlap.
                self.survey_within(run, Slack::ANY)?;
            }
            rates.extend(completed(&before, &window.rates(before), &self.rates));
            if is_last {
                return Ok((rates, late));
            }
        }
    }

    /// Goes on to where nothing contradicts events at an approach, up to `most_late`. Returns how far that is.
    fn follow_late(
        &self,
        run: &mut LoadingRun,
        iterations: &mut dyn Iterations,
        tolerances: &WindowTolerances,
        (trial, approach, most_late): (&Trial, f64, f64),
    ) -> Result<f64, Error> {
        // The time of the group is the first of many estimates, and rather too early. Behind the events gaps and depths
        // may change far faster than they did before, on lines: those that are negative tell the time better, by where
        // they pass zero.
        let [_, most] =
            slacks(run, (trial.problem(&run.problem), &trial.contact), tolerances, approach);
        let late = lateness(run, trial, (approach, most));
        let late = if late <= most_late { late } else { 0.0 };
        let approach = approach + late;
        if late > 0.0 {
            let here = Behind::on(trial.problem(&run.problem), &trial.contact, approach);
            run.field.advance(&here, iterations, self.rate_span)?;
        }
        match pulled(run, trial, tolerances, approach) {
            Some((node, pressure)) => Err(run.not_monotone("pressure", node, pressure)),
            None => Ok(late),
        }
    }
}

/// The first node in contact that is pulled at an approach by more than a solution may leave, and its pressure.
fn pulled(
    run: &LoadingRun,
    trial: &Trial,
    tolerances: &WindowTolerances,
    approach: f64,
) -> Option<(usize, f64)> {
    let (problem, contact, _) = trial.set(run);
    let [_, slack] = slacks(run, (problem, contact), tolerances, approach);
    // Rounding of heights pulls at nodes that touch together.
    let rounding = TOLERANCE * (problem.greatest_gap() + approach);
    let tension = slack.tension.max(rounding) / problem.table().self_influence();
    run.field.pressures(contact, approach).find(|(_, pressure)| *pressure < -tension)
}

/// How much later than an approach the last plastic depth, or pressure in contact, ceases to be negative, of those that
/// are beyond what a solution may be off by.
fn lateness(run: &LoadingRun, trial: &Trial, (approach, slack): (f64, Slack)) -> f64 {
    let (problem, contact, _) = trial.set(run);
    let plastic = run.plastic.as_deref();
    let mut yields = vec![false; problem.grid().nodes()];
    trial.yielded.iter().for_each(|&node| yields[node] = true);
    let has_yielded = |node: usize| yields[node] || plastic.is_some_and(|p| p.has_yielded(node));
    let depths = run.field.lines(problem, contact, approach).filter_map(|(node, line)| {
        let is_short = line.gap > slack.gap && has_yielded(node);
        (is_short && line.closing > 0.0).then(|| line.gap / line.closing)
    });
    let tension = slack.tension / problem.table().self_influence();
    let pressures = run.field.pressures(contact, approach).zip(&run.field.solution().rate);
    let pressures = pressures
        .filter(|&((_, pressure), &rate)| pressure < -tension && rate > 0.0)
        .map(|((_, pressure), &rate)| -pressure / rate);
    depths.chain(pressures).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::loading::test_chain::{self, Altered};

    /// Node 0 is in contact at the approach 1, and nodes 2, 4 and 6 touch after one metre, nearly; node 8 after three.
    fn entered(
        times: [f64; 3],
        tie: f64,
        known: &[usize],
    ) -> Result<(LoadingRun, Estimated), Error> {
        let mut gaps = [9.0; 9];
        (gaps[0], gaps[2], gaps[4], gaps[6], gaps[8]) = (0.0, 2.0, 2.0, 2.0, 4.0);
        let mut run = test_chain::surveyed(&gaps, &[0], 1.0)?;
        let mut estimated = Estimated::new(None, true);
        estimated.ranking = vec![(3.0, 8), (times[2], 6), (times[0], 2), (times[1], 4)];
        estimated.rates = run.scalars.rates();
        estimated.last_span = 0.5;
        let tolerances = test_chain::tolerances(1.0, 0.0, tie);
        let iterations = &mut Altered::inexact(0.0);
        run.advance_field(iterations, 1.0, 0.0)?;
        estimated.enter(&mut run, iterations, &tolerances, (1.0, known))?;
        Ok((run, estimated))
    }

    /// All that touch within a tie or are known to, in the order of their indices: each adds a quarter of 2 m² to
    /// the stiffness of 1/2.
    #[test]
    fn nodes_that_touch_together_join_together() -> Result<(), Error> {
        for (times, tie, known, order) in [
            ([1.0; 3], 1e-3, &[][..], &[0, 2, 4, 6][..]),
            ([1.0, 1.25, 1.3], 0.25, &[], &[0, 2, 4]),
            ([1.3, 1.0, 0.5], 0.25, &[], &[0, 4, 6]),
            // Known to touch, although their times seem to be later.
            ([1.3, 1.0, f64::INFINITY], 0.25, &[6], &[0, 4, 6]),
            ([1.3, 1.3, f64::INFINITY], 0.25, &[2], &[0, 2]),
        ] {
            let (run, estimated) = entered(times, tie, known)?;
            assert_eq!(run.contact.order(), order);
            assert_eq!(run.scalars.approach(), 2.0);
            assert_eq!((estimated.last_span, estimated.rate_span), (1.0, f64::INFINITY));
            assert_eq!(run.queue.len(), order.len() - 1);
            for (k, state) in run.queue.iter().enumerate() {
                assert_eq!((state.step, state.contact.contact_nodes), (k + 2, k + 2));
                assert_eq!(state.node, (order[k + 1], 0));
                // 1/2 N and 1/2 N more on the way.
                assert_eq!(
                    (state.contact.approach, state.contact.load, state.approach_error),
                    (2.0, 1.0, tie)
                );
                let stiffness = state.contact.contact_stiffness.unwrap_or_default();
                assert!((stiffness - (1.0 + 0.5 * k as f64)).abs() < 1e-14, "{stiffness}");
            }
        }
        Ok(())
    }
}
