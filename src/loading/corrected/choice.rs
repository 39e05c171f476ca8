//! Which nodes to watch.

use super::Corrected;
use crate::loading::ranking::Ranking;
use crate::loading::run::LoadingRun;
use crate::loading::scales::Scales;
use crate::updater::LinearUpdater;

/// A window watches this part of the contact at most, as long as that is small.
const PART: usize = 4;
/// And so many nodes always: what ties with them is watched too, and told apart.
pub(super) const FEWEST: usize = 8;
/// Ties with the last watched node are watched too, up to so many times the window.
const MOST_TIES: usize = 3;

/// The nodes to watch.
#[derive(Debug)]
pub(super) struct Choice {
    /// (time, node), in this order.
    pub(super) watched: Ranking,
    pub(super) horizon: f64,
    /// Set if more nodes touch at this time than can be watched.
    pub(super) group: Option<f64>,
}

impl Corrected {
    /// Chooses the nodes with the smallest times, and `extra` ones.
    pub(super) fn choose<U: LinearUpdater>(
        &mut self,
        run: &LoadingRun<U>,
        scales: &Scales,
        extra: &[usize],
    ) -> Choice {
        let order = |a: &(f64, usize), b: &(f64, usize)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        let ranking = &mut self.ranking;
        let size = self.size.min((run.contact.len() / PART).max(FEWEST));
        if ranking.len() <= size {
            let mut watched = ranking.clone();
            watched.sort_by(order);
            return Choice {
                watched,
                horizon: f64::INFINITY,
                group: None,
            };
        }
        let (watched, next, others) = ranking.select_nth_unstable_by(size, order);
        let mut watched = watched.to_vec();
        let approach = run.front.approach();
        let tie_of = |node: usize| {
            let line = run.field.line(&run.problem, node, approach);
            scales.tie_of(line.closing)
        };
        let first = watched
            .iter()
            .map(|(time, _)| *time)
            .fold(f64::INFINITY, f64::min);
        let limit = next.0 + tie_of(next.1);
        let mut choice = Choice {
            watched: Vec::new(),
            horizon: next.0,
            group: (next.0 <= first.max(0.0) + tie_of(next.1)).then_some(first.max(0.0)),
        };
        let tied = others.iter().filter(|(time, _)| *time <= limit);
        if tied.clone().count() < MOST_TIES * self.size {
            watched.push(*next);
            watched.extend(tied);
            let rest = others.iter().map(|(time, _)| *time);
            let rest = rest.filter(|time| *time > limit);
            choice.horizon = rest.fold(f64::INFINITY, f64::min);
        }
        if !extra.is_empty() {
            let is_new = |node: &usize| !watched.iter().any(|(_, other)| other == node);
            let new: Vec<usize> = extra.iter().copied().filter(is_new).collect();
            watched.extend(ranking.iter().filter(|(_, node)| new.contains(node)));
            let rest = ranking
                .iter()
                .filter(|(_, node)| !watched.iter().any(|(_, other)| other == node));
            choice.horizon = rest.map(|(time, _)| *time).fold(f64::INFINITY, f64::min);
        }
        watched.sort_by(order);
        choice.watched = watched;
        choice
    }
}
