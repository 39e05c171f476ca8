//! Events in windows, of kernels whose contact only grows, with an updater.

use super::tuning::{MULTIPLE, OF_RESIDUAL, RECOGNISED, TOLERANCE};
use std::time::Instant;

use super::cost::{WITH_FACTOR, automatic_window, watched_for};
use super::factor_log::FactorLog;
use super::ranking::{Ranking, rank};
use super::run::LoadingRun;
use super::state::ContactEvent;
use super::tolerances::ties_until;
use super::window::Window;
use crate::updater::LinearUpdater;
use crate::{ContactGrowth, Error};

/// Finds events in windows: since contact only grows, the approach at which a node would touch if no other
/// did is a lower bound, and only the nodes with the smallest ones need be watched until the *horizon*, the
/// smallest bound among all others.
#[derive(Debug)]
pub(super) struct Windowed {
    growth: ContactGrowth,
    /// How many nodes to watch, if the user says so.
    size: Option<usize>,
    window: Window,
    /// The nodes out of contact by the time at which they would touch.
    ranking: Ranking,
    /// All windows so far.
    log: FactorLog,
}

impl Windowed {
    pub(super) fn new(growth: ContactGrowth, size: Option<usize>) -> Self {
        Self {
            growth,
            size,
            window: Window::default(),
            ranking: Ranking::new(),
            log: FactorLog::default(),
        }
    }

    /// Computes a window of states, with no more than `most_nodes` in contact. Returns what went wrong
    /// after them.
    pub(super) fn produce<U: LinearUpdater>(
        &mut self,
        run: &mut LoadingRun,
        updater: &mut U,
        most_nodes: usize,
    ) -> Result<Option<Error>, Error> {
        let (count, approach) = (run.contact.len(), run.scalars.approach());
        let size = run.affordable(updater, self.next_size(run, most_nodes))?;
        run.renew_field(updater, approach)?;
        let first = rank(run, &mut self.ranking)?;
        let start = Instant::now();
        let (size, horizon) = self.choose(size, self.multiple(), [approach, first]);
        run.timings.choice += start.elapsed();
        let chosen = self.ranking[..size].iter().map(|&(_, node)| node);
        run.watch(updater, &mut self.window, chosen, horizon)?;

        let start = Instant::now();
        let bad_pivot = self.window.play(most_nodes - count);
        run.timings.events += start.elapsed();
        let mut failure = bad_pivot.map(|bad| run.not_positive_definite(bad));
        let played = self.window.events().len();
        if played == 0 {
            return Err(failure.unwrap_or_else(|| self.growth_stopped(run)));
        }
        let mark = run.mark();
        run.join(updater, &self.window)?;
        let joined = self.window.events().iter().map(|event| event.position);
        let joined: Vec<usize> = joined.collect();
        if self.growth == ContactGrowth::Monotone {
            self.verify(run, updater)?;
        }
        if let Some(error) = self.pulled(run, updater)? {
            run.roll_back(&mark, |problem, contact| updater.truncate(problem, contact))?;
            return Err(error);
        }
        self.log.push(self.window.nodes(), joined.into_iter(), self.window.events().len());
        if self.window.events().len() < played {
            failure = None;
        }
        let start = Instant::now();
        let queued = self.enqueue(run, count);
        run.timings.events += start.elapsed();
        Ok(queued.err().or(failure))
    }

    /// All windows so far.
    pub(super) fn log(&self) -> &FactorLog {
        &self.log
    }

    /// Goes on behind these windows. The nodes that the last one left are watched in the same order.
    pub(super) fn follow_on(&mut self, log: FactorLog) {
        self.window = Window::ended_with(log.untouched());
        self.log = log;
    }

    /// How many nodes to watch.
    fn next_size(&self, run: &LoadingRun, most_nodes: usize) -> usize {
        let (count, nodes) = (run.contact.len(), run.problem.grid().nodes());
        let size = self.size.unwrap_or_else(|| {
            automatic_window(count, nodes, WITH_FACTOR).min(watched_for(most_nodes - count))
        });
        size.min(nodes - count)
    }

    /// Nodes that were not watched before come in multiples of this.
    fn multiple(&self) -> usize {
        if self.size.is_some() { 1 } else { MULTIPLE }
    }

    /// Moves the nodes to watch to the front of the ranking, those watched before first; returns their
    /// number, `size` or a little less, and the horizon: until then none of the others ties with one that is watched. The first
    /// node touches at `first` after an approach.
    fn choose(
        &mut self,
        mut size: usize,
        multiple: usize,
        [approach, first]: [f64; 2],
    ) -> (usize, f64) {
        // So that of more nodes that touch at once than can be watched those of the lowest indices are.
        for (time, _) in &mut self.ranking {
            if *time <= first {
                *time = first;
            }
        }
        let order = |a: &(f64, usize), b: &(f64, usize)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        let mut horizon = f64::INFINITY;
        let mut among = self.ranking.len();
        loop {
            if size < among {
                let ranking = &mut self.ranking[..among];
                horizon = ranking.select_nth_unstable_by(size, order).1.0;
            }
            let chosen = &mut self.ranking[..size];
            chosen.sort_unstable_by_key(|&(_, node)| node);
            let again = |node: &usize| chosen.binary_search_by_key(node, |&(_, node)| node).is_ok();
            let new = size - self.window.untouched().filter(again).count();
            if new <= multiple || new.is_multiple_of(multiple) {
                break;
            }
            among = size;
            size -= new % multiple;
        }
        let chosen = &mut self.ranking[..size];
        let mut front = 0;
        // Nodes watched before keep their order, so that the updater knows them again.
        for node in self.window.untouched() {
            if let Ok(found) = chosen[front..].binary_search_by_key(&node, |&(_, node)| node) {
                chosen[front..=front + found].rotate_right(1);
                front += 1;
            }
        }
        if horizon <= first {
            // The others have higher indices; those that are watched touch here, but for what rounds.
            horizon = ties_until(approach + first) - approach;
        }
        (size, horizon)
    }

    /// Checks the contact after the window from a solution there, and takes back its last events as long as
    /// that contradicts them: those after the first contradiction. Gaps only close, so that none has
    /// overlapped where none does at the end; and the first event follows from a solution, and needs no
    /// check.
    ///
    /// The next window needs the same solution and the same displacements, and finds them.
    fn verify<U: LinearUpdater>(
        &mut self,
        run: &mut LoadingRun,
        updater: &mut U,
    ) -> Result<(), Error> {
        let start = run.scalars.approach();
        // When the first contradiction was is an estimate, which must not make the search long if it keeps
        // failing.
        let mut fewest = 1;
        while let [_, .., last] = self.window.events() {
            let end = start + last.time;
            run.renew_field(updater, end)?;
            let Some(until) = contradiction(run, end) else {
                return Ok(());
            };
            let events = self.window.events();
            let later = events.iter().rev();
            let later = later.take_while(|event| start + event.time > until).count();
            let dropped = later.max(fewest).min(events.len() - 1);
            fewest *= 2;
            self.window.truncate(events.len() - dropped);
            let mark = run.mark().without_last(dropped);
            run.roll_back(&mark, |problem, contact| updater.truncate(problem, contact))?;
            run.timings.taken_back += dropped;
        }
        Ok(())
    }

    /// The error of a window whose end pulls at a node: contact does not grow as the kernel promises. The next window needs the same solution.
    fn pulled<U: LinearUpdater>(
        &self,
        run: &mut LoadingRun,
        updater: &mut U,
    ) -> Result<Option<Error>, Error> {
        let Some(last) = self.window.events().last() else {
            return Ok(None);
        };
        let end = run.scalars.approach() + last.time;
        run.renew_field(updater, end)?;
        let rounding = TOLERANCE * (run.problem.greatest_gap() + end);
        let most = RECOGNISED * run.greatest_pressure(end)
            + rounding / run.problem.table().self_influence();
        let mut pressures = run.field.pressures(&run.contact, end);
        let pulled = pressures.find(|(_, pressure)| *pressure < -most);
        Ok(pulled.map(|(node, pressure)| run.not_monotone("pressure", node, pressure)))
    }

    /// Turns the events of the window, which began with `count` nodes in contact, into states.
    fn enqueue(&self, run: &mut LoadingRun, count: usize) -> Result<(), Error> {
        let start = run.scalars.approach();
        let events = self.window.events().iter();
        for (k, (event, increments)) in events.zip(self.window.increments()).enumerate() {
            let contact_nodes = count + k + 1;
            run.scalars.advance(start + event.time);
            run.scalars.touch(increments, contact_nodes);
            run.scalars.clamp_mean_gap();
            let step = run.releases.steps(contact_nodes);
            let node = self.window.node(event.position);
            run.enqueue(step, ContactEvent::Touch, node, contact_nodes)?;
        }
        Ok(())
    }

    /// The path cannot go on although nodes are left: none of their gaps closes.
    pub(super) fn growth_stopped(&self, run: &LoadingRun) -> Error {
        let node = self.ranking.iter().map(|&(_, node)| node).min();
        run.not_monotone("closing rate of the gap", node.unwrap_or_default(), 0.0)
    }
}

/// Whether a pressure or a gap at an approach is negative, beyond rounding. Returns the approach until which none was, as far as the
/// rates tell.
fn contradiction(run: &LoadingRun, approach: f64) -> Option<f64> {
    if run.negative_pressure(run.contact.len(), (approach, 0.0)).is_some() {
        return Some(f64::NEG_INFINITY);
    }
    let left = run.contact.order().iter();
    let left = left.map(|&node| run.field.left_at(&run.problem, node)[0].abs());
    let least = f64::EPSILON * (run.problem.greatest_gap() + approach);
    let overlap = -OF_RESIDUAL * left.fold(least, f64::max);
    let lines = run.field.lines(&run.problem, &run.contact, approach);
    lines
        .filter(|(_, line)| line.gap < overlap)
        .map(|(_, line)| {
            if line.closing > 0.0 { approach + line.gap / line.closing } else { f64::NEG_INFINITY }
        })
        .reduce(f64::min)
}

#[cfg(test)]
mod tests;
