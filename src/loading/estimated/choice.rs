//! Which nodes to watch, and how far their window goes.

use super::{Estimated, closing};
use crate::loading::ranking::Ranking;
use crate::loading::run::LoadingRun;
use crate::loading::tolerances::WindowTolerances;
use crate::loading::tuning::{CUT, FEWEST, MOST_TIES, PART};
use crate::loading::window::WindowEvent;

/// The nodes to watch.
#[derive(Debug)]
pub(super) struct Candidates {
    /// (time, node), in this order.
    pub(super) nodes: Ranking,
    /// Nothing happens to another node before this time.
    pub(super) horizon: f64,
    /// The first time, if more nodes have their events then than were to be watched.
    pub(super) group: Option<f64>,
}

impl Estimated {
    /// Chooses the nodes with the smallest times.
    pub(super) fn choose(&mut self, run: &LoadingRun, tolerances: &WindowTolerances) -> Candidates {
        let order = |a: &(f64, usize), b: &(f64, usize)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        let wanted = self.most_events().min(run.contact.len() / PART);
        let size = self.size.min(wanted.max(FEWEST));
        let ranking = &mut self.ranking;
        if ranking.len() <= size {
            let mut watched = ranking.clone();
            watched.sort_by(order);
            return Candidates { nodes: watched, horizon: f64::INFINITY, group: None };
        }
        let places = if run.plastic.is_some() { run.contact.places() } else { Vec::new() };
        let tie_of = |node: usize| {
            tolerances.tie_of(closing(run, node, places.get(node).copied().flatten()))
        };
        let (watched, next, others) = ranking.select_nth_unstable_by(size, order);
        let mut watched = watched.to_vec();
        let first = watched.iter().map(|(time, _)| *time).fold(f64::INFINITY, f64::min);
        let limit = next.0 + tie_of(next.1);
        let mut candidates = Candidates {
            nodes: Vec::new(),
            horizon: next.0,
            group: (first.is_finite() && next.0 <= first.max(0.0) + tie_of(next.1))
                .then_some(first.max(0.0)),
        };
        let tied = others.iter().filter(|(time, _)| *time <= limit);
        if tied.clone().count() < MOST_TIES * self.size {
            watched.push(*next);
            watched.extend(tied);
            let rest = others.iter().map(|(time, _)| *time).filter(|time| *time > limit);
            candidates.horizon = rest.fold(f64::INFINITY, f64::min);
        }
        watched.sort_by(order);
        candidates.nodes = watched;
        candidates
    }
}

/// How many events a window keeps, up to `most`, and where it ends: in the middle of the widest spacing behind
/// most of them; a little behind the last one where that is the last of all that are ranked.
pub(super) fn cut(
    events: &[WindowEvent],
    (horizon, is_last): (f64, bool),
    most: usize,
    tolerances: &WindowTolerances,
) -> (usize, f64) {
    let count = events.len().min(most);
    let next = |events_kept: usize| {
        let last = events[events_kept - 1].time;
        match events.get(events_kept) {
            Some(event) => event.time,
            None if is_last || horizon == f64::INFINITY => {
                horizon.max(last).min(1.05 * last + 1e-12 * tolerances.length)
            }
            None => horizon.max(last),
        }
    };
    let spacing = |kept: &usize| next(*kept) - events[*kept - 1].time;
    let widest = |range: std::ops::RangeInclusive<usize>| {
        range.rev().max_by(|a, b| spacing(a).total_cmp(&spacing(b))).unwrap_or(1)
    };
    let least = ((CUT * count as f64) as usize).clamp(1, count);
    let mut kept = widest(least..=count);
    if spacing(&kept) <= tolerances.tie {
        kept = widest(1..=count);
    }
    (kept, 0.5 * (events[kept - 1].time + next(kept)))
}

/// The number of the first events, up to `most`, and of those that tie with the last of them.
pub(super) fn with_ties(
    events: &[WindowEvent],
    most: usize,
    tolerances: &WindowTolerances,
) -> usize {
    let few = most.clamp(1, events.len());
    let tied = events[few - 1..].windows(2);
    few + tied.take_while(|pair| pair[1].time - pair[0].time <= tolerances.tie).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Error;
    use crate::loading::test_chain;

    /// What is chosen of nodes that touch at `times`, the last node first, with `contact` nodes in contact. Ties alone
    /// matter: all gaps close at the rate 1.
    fn choose(
        (size, contact): (usize, usize),
        times: &[f64],
        tie: f64,
    ) -> Result<Candidates, Error> {
        let mut run = test_chain::run(&[0.0; 100])?;
        for node in 60..60 + contact {
            run.contact.push(node)?;
        }
        let mut estimated = Estimated::new(Some(size), true);
        estimated.ranking = times.iter().copied().zip(0..).collect();
        estimated.ranking.reverse();
        Ok(estimated.choose(&run, &test_chain::tolerances(1.0, 0.0, tie)))
    }

    fn nodes(candidates: &Candidates) -> Vec<usize> {
        candidates.nodes.iter().map(|&(_, node)| node).collect()
    }

    /// One time a metre: node k touches at k.
    fn times(count: usize) -> Vec<f64> {
        (0..count).map(|k| k as f64).collect()
    }

    #[test]
    fn the_next_nodes_are_watched() -> Result<(), Error> {
        // Eight at least and all there are, without a horizon then; with more the next one as well, and no
        // other node touches before the one behind it.
        for (count, watched, horizon) in
            [(7, 7, f64::INFINITY), (8, 8, f64::INFINITY), (9, 9, f64::INFINITY), (12, 9, 9.0)]
        {
            let candidates = choose((60, 0), &times(count), 1e-9)?;
            assert_eq!(nodes(&candidates), (0..watched).collect::<Vec<_>>());
            assert_eq!((candidates.horizon, candidates.group), (horizon, None), "{count}");
        }
        // A quarter of 40 nodes in contact, and of 38, but no more than the size.
        for (contact, size, watched) in [(40, 60, 11), (38, 60, 10), (40, 9, 10)] {
            let candidates = choose((size, contact), &times(30), 1e-9)?;
            assert_eq!(nodes(&candidates).len(), watched, "{contact}");
        }
        Ok(())
    }

    #[test]
    fn ties_with_the_last_are_watched_too() -> Result<(), Error> {
        // At 8.5, as far as a tie behind the next one, which is at 8; not at 8.75.
        let mut near = times(9);
        near.extend([8.75, 8.5, 20.0, 8.25]);
        let candidates = choose((8, 0), &near, 0.5)?;
        assert_eq!(nodes(&candidates), [0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 10]);
        assert_eq!((candidates.horizon, candidates.group), (8.75, None));
        // Up to three times the window: 23 of them, not 24.
        for (ties, watched, horizon) in [(23, 32, 20.0), (24, 8, 8.0)] {
            let mut tied = times(9);
            tied.extend(vec![8.0; ties]);
            tied.push(20.0);
            let candidates = choose((8, 0), &tied, 1e-9)?;
            assert_eq!((nodes(&candidates).len(), candidates.horizon), (watched, horizon));
            assert_eq!(candidates.group, None);
        }
        Ok(())
    }

    #[test]
    fn too_many_at_once_are_a_group() -> Result<(), Error> {
        for (first, others, tie, group) in [
            (5.0, 5.0, 1e-9, Some(5.0)),
            // As far as a tie behind the first, that included.
            (5.0, 5.5, 0.5, Some(5.0)),
            (5.0, 5.75, 0.5, None),
            // What should have touched already touches now.
            (-1.0, -1.0, 1e-9, Some(0.0)),
            (-1.0, 0.25, 0.5, Some(0.0)),
            // What does not touch at all is none.
            (f64::INFINITY, f64::INFINITY, 1e-9, None),
        ] {
            let mut times = vec![others; 40];
            times[0] = first;
            let candidates = choose((8, 0), &times, tie)?;
            assert_eq!(candidates.group, group, "{first} {others}");
            assert_eq!((nodes(&candidates).len(), candidates.horizon), (8, others));
        }
        Ok(())
    }

    fn cut_of(times: &[f64], horizon: f64, most: usize) -> (usize, f64) {
        let events: Vec<(usize, f64)> = times.iter().copied().enumerate().collect();
        let tolerances = test_chain::tolerances(1e9, 0.0, 0.25);
        let is_last = horizon == f64::INFINITY;
        cut(&test_chain::events(&events), (horizon, is_last), most, &tolerances)
    }

    /// Ends in the middle of the widest spacing behind 85 of 100 events, the first of the widest.
    #[test]
    fn windows_end_where_events_are_far_apart() {
        let all = usize::MAX;
        // Ten events: behind the eighth, ninth or tenth.
        let even: Vec<f64> = (1..=10).map(f64::from).collect();
        assert_eq!(cut_of(&even, 11.0, all), (8, 8.5));
        assert_eq!(cut_of(&even, 13.0, all), (10, 11.5));
        // No other node touches before the last event: the horizon is rounding.
        assert_eq!(cut_of(&even, 9.5, all), (8, 8.5));
        let mut wide = even.clone();
        wide[9] = 12.0;
        assert_eq!(cut_of(&wide, 13.0, all), (9, 10.5));
        // A wider spacing in front of them is none of the window's end.
        wide = even.iter().map(|time| if *time > 3.0 { time + 5.0 } else { *time }).collect();
        assert_eq!(cut_of(&wide, 16.0, all), (8, 13.5));
        // No more than are wanted: behind the fourth or fifth.
        assert_eq!(cut_of(&even, 11.0, 5), (4, 4.5));
        // Where these are ties, the widest of all; where all are, the window goes to its first event.
        let ties = [1.0, 2.0, 4.0, 4.25, 4.5, 4.75];
        assert_eq!(cut_of(&ties, 5.0, all), (2, 3.0));
        assert_eq!(cut_of(&ties[2..], 5.0, all), (1, 4.125));
    }

    /// Without a horizon a window goes on by a twentieth, and 10⁻¹² of the length, here 10⁻³.
    #[test]
    fn windows_without_a_horizon_end_a_little_behind() {
        let (kept, end) = cut_of(&[2.0, 16.0], f64::INFINITY, usize::MAX);
        // (16 + 16.8 + 0.001) / 2, rounded; the spacing of 14 is the wider one.
        assert_eq!((kept, end), (1, 9.0));
        let (kept, end) = cut_of(&[16.0], f64::INFINITY, usize::MAX);
        assert!(kept == 1 && (end - 16.4005).abs() < 1e-12, "{end}");
    }

    #[test]
    fn ties_stay_together() {
        let events = test_chain::events(&[(0, 0.5), (0, 1.0), (0, 1.0 + 1e-10), (0, 2.0)]);
        let tolerances = test_chain::tolerances(1.0, 0.0, 1e-9);
        for (most, kept) in [(0, 1), (1, 1), (2, 3), (3, 3), (4, 4), (9, 4)] {
            assert_eq!(with_ties(&events, most, &tolerances), kept, "{most}");
        }
    }
}
