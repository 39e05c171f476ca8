//! Nodes that touch together, too many to be watched: a flat punch, a plateau.

use super::candidates::Candidates;
use super::states::pinned;
use super::{Refined, keeps_growing};
use crate::Error;
use crate::loading::run::LoadingRun;
use crate::loading::state::ContactEvent;
use crate::loading::tolerances::WindowTolerances;
use crate::loading::tuning::{MOST_TIES, PART};
use crate::updater::Iterations;

impl Refined {
    /// Lets all nodes that touch at a time join, and those that are known to, up to `most`, in the order of their indices.
    pub(super) fn enter(
        &mut self,
        run: &mut LoadingRun,
        iterations: &mut dyn Iterations,
        tolerances: &WindowTolerances,
        (time, known): (f64, &[usize]),
        most: usize,
    ) -> Result<(), Error> {
        let mark = run.mark();
        let approach = mark.scalars.approach() + time;
        let tie_of = |node: usize| tolerances.tie_of(run.line(node).closing);
        let together =
            |&&(other, node): &&(f64, usize)| other <= time + tie_of(node) || known.contains(&node);
        let group = self.ranking.iter().filter(together);
        let mut group: Vec<usize> = group.map(|&(_, node)| node).collect();
        // What their times cannot be told apart by.
        let error = group.iter().map(|&node| tie_of(node));
        let error = error.fold(tolerances.tie, f64::max);
        group.sort_unstable();
        group.truncate(most);
        self.last_span = self.last_span.max(time);
        let entered = self.join_all(run, iterations, (&group, approach));
        let entered = entered.and_then(|increments| {
            keeps_growing(run, run.contact.len(), tolerances).map(|()| increments)
        });
        let increments = match entered {
            Ok(increments) => increments,
            Err(error) => {
                let _ = run.roll_back(&mark, |problem, contact| iterations.cut(problem, contact));
                return Err(error);
            }
        };
        let mut walked = mark.scalars;
        walked.advance(approach);
        let [stiffness, _] = walked.missing(&run.scalars);
        let error = walked.reported_error(error, walked.load_of(stiffness, error));
        self.joined.clone_from(&group);
        for (k, (node, increment)) in group.into_iter().zip(increments).enumerate() {
            let contact_nodes = mark.count + k + 1;
            walked.touch(increment, contact_nodes);
            walked.clamp_mean_gap();
            let step = run.releases.steps(contact_nodes);
            let event = (step, ContactEvent::Touch, node);
            run.enqueue_at(&walked, event, contact_nodes, error)?;
        }
        Ok(())
    }

    /// Lets nodes join at an approach, in windows with a solution behind each. Returns what each adds to stiffness and closing rate: as
    /// the pivots say, scaled so that they end where the solution is.
    fn join_all(
        &mut self,
        run: &mut LoadingRun,
        iterations: &mut dyn Iterations,
        (group, approach): (&[usize], f64),
    ) -> Result<Vec<[f64; 2]>, Error> {
        let mut increments = Vec::with_capacity(group.len());
        let mut left = group;
        while !left.is_empty() {
            // Where few gaps are open each counts for much of what is left of the closing rate.
            let open = run.problem.grid().nodes() - run.contact.len();
            let size = (open / PART).clamp(self.size, MOST_TIES * self.size);
            let (nodes, others) = left.split_at(size.min(left.len()));
            left = others;
            let times = nodes.iter().map(|&node| (0.0, node)).collect();
            let candidates = Candidates { nodes: times, horizon: 0.0, group: None };
            let mut window = self.propose(run, iterations, candidates, 0.0)?;
            for (position, &node) in nodes.iter().enumerate() {
                window.happen(position, 0.0).map_err(|bad| run.not_positive_definite(bad))?;
                run.contact.push(node)?;
            }
            // The approach goes on from the last of them only. However little is left open by so many nodes: rates must be exact there.
            self.rate_span = if left.is_empty() { f64::INFINITY } else { 0.0 };
            let before = run.scalars;
            run.advance_field(iterations, approach, self.rate_span)?;
            run.scalars.place_at(approach);
            self.survey(run)?;
            increments.extend(pinned(&window, before.missing(&run.scalars)));
        }
        Ok(increments)
    }
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
        most: usize,
    ) -> Result<(LoadingRun, Refined), Error> {
        let mut gaps = [9.0; 9];
        (gaps[0], gaps[2], gaps[4], gaps[6], gaps[8]) = (0.0, 2.0, 2.0, 2.0, 4.0);
        let mut run = test_chain::surveyed(&gaps, &[0], 1.0)?;
        let mut refined = Refined::new(None, true);
        refined.ranking = vec![(3.0, 8), (times[2], 6), (times[0], 2), (times[1], 4)];
        refined.last_span = 0.5;
        let tolerances = test_chain::tolerances(1.0, 0.0, tie);
        let iterations = &mut Altered::inexact(0.0);
        run.advance_field(iterations, 1.0, 0.0)?;
        refined.enter(&mut run, iterations, &tolerances, (1.0, known), most)?;
        Ok((run, refined))
    }

    /// All that touch within a tie or are known to, in the order of their indices, up to a number of them: each adds a quarter of 2 m² to
    /// the stiffness of 1/2.
    #[test]
    fn nodes_that_touch_together_join_together() -> Result<(), Error> {
        for (times, tie, known, most, order) in [
            ([1.0; 3], 1e-3, &[][..], 9, &[0, 2, 4, 6][..]),
            ([1.0, 1.25, 1.3], 0.25, &[], 9, &[0, 2, 4]),
            ([1.3, 1.0, 0.5], 0.25, &[], 9, &[0, 4, 6]),
            ([1.0; 3], 1e-3, &[4], 2, &[0, 2, 4]),
            // Known to touch, although their times seem to be later.
            ([1.3, 1.0, f64::INFINITY], 0.25, &[6], 9, &[0, 4, 6]),
            ([1.3, 1.3, f64::INFINITY], 0.25, &[2], 9, &[0, 2]),
        ] {
            let (run, refined) = entered(times, tie, known, most)?;
            assert_eq!(run.contact.order(), order);
            assert_eq!(run.scalars.approach(), 2.0);
            assert_eq!((refined.last_span, refined.rate_span), (1.0, f64::INFINITY));
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
