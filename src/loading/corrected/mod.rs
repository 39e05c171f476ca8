//! Events in windows, with an updater whose Schur complements are not exact.
//!
//! The order of events inside a window rests on small changes only, so that a Schur complement that is nearly
//! right gives nearly the right order. The exact solution at the window's end, which the next window needs
//! anyway, then corrects it, and the same events are played a second time. What is still closer than the
//! remaining error is settled by one exact solution each.

mod choice;
mod correction;
mod group;
mod play;
mod states;
mod ties;
mod watched;
#[cfg(test)]
mod window_tests;

use nalgebra::DMatrix;

use super::front::Front;
use super::gap_field::Line;
use super::ranking::{Ranking, fill};
use super::run::LoadingRun;
use super::scales::Scales;
use crate::Error;
use crate::updater::{LinearUpdater, Schur, Touched};
use choice::{Choice, FEWEST};
use correction::{Correction, correct};
use play::{Course, Played, play};
use ties::Settled;
use watched::{Watched, cut};

/// Nodes watched at a time: the error of the order grows with their number.
const WATCHED: usize = 60;
/// The same if near ties are not settled.
const WATCHED_UNSETTLED: usize = 128;
/// How often a contact that contradicts the conditions of contact is mended before the path gives up.
const MOST_TRIES: usize = 10;
/// What is left of a window that let a node overlap that was not watched.
const SHORTER: f64 = 0.7;
/// Events of a window times the part of a pivot that its Schur complement leaves out: windows have no more. Schur complements of
/// square domains leave out 10⁻³, so that nothing is limited; those of a periodic strip of two rows 0.5, and each event has a
/// solution of its own.
const LEFT_OUT: f64 = 0.2;
/// What was left out counts for the next windows too, each time by this part.
const REMEMBERED: f64 = 0.8;
/// What the end of a window may change of the times in it on average, over the mean spacing of events: 0.1 at worst on square domains.
/// A window whose end changes more is taken back.
const MOST_CHANGE: f64 = 0.3;
/// Events that the solution at a window's end determines, whatever its Schur complement is.
const CERTAIN: usize = 2;

/// Finds events in windows that are corrected at their end.
#[derive(Debug)]
pub(super) struct Corrected {
    size: usize,
    /// Whether events that are too close to be told apart get a solution of their own.
    settles: bool,
    /// The nodes out of contact, at the front.
    ranking: Ranking,
    /// The contact and approach that the ranking belongs to.
    ranked: Option<(u64, f64)>,
    /// How far the last window went, and the span that the rates at hand serve.
    last_span: f64,
    rate_span: f64,
    /// The part of a pivot that Schur complements were off by lately, at worst.
    left_out: f64,
}

/// What a contact at a window's end contradicts.
#[derive(Debug, Default)]
struct Contradictions {
    /// Positions of events whose node is under tension.
    tension: Vec<usize>,
    /// Positions of watched nodes that overlap.
    overlap: Vec<usize>,
    /// (when it would touch, node) of nodes that overlap and were not watched.
    outside: Ranking,
}

impl Corrected {
    pub(super) fn new(size: Option<usize>, settles: bool) -> Self {
        let watched = if settles { WATCHED } else { WATCHED_UNSETTLED };
        Self {
            size: size.unwrap_or(watched).max(FEWEST),
            settles,
            ranking: Vec::new(),
            ranked: None,
            last_span: 0.0,
            rate_span: 0.0,
            left_out: 0.0,
        }
    }

    /// Computes a window of states, with no more than `most_nodes` in contact.
    pub(super) fn produce<U: LinearUpdater>(
        &mut self,
        run: &mut LoadingRun<U>,
        most_nodes: usize,
    ) -> Result<Option<Error>, Error> {
        let most = most_nodes - run.contact.len();
        let (mut extra, mut longest) = (Vec::new(), f64::INFINITY);
        let mut without_events = 0;
        loop {
            let scales = Scales::of(run);
            self.begin(run)?;
            let mut choice = self.choose(run, &scales, &extra);
            self.refine(run, &scales, &mut choice, &extra)?;
            if let Some(time) = choice.group {
                self.enter(run, &scales, (time, &[]), most)?;
                return Ok(None);
            }
            let watched = self.watch(run, choice, longest)?;
            match self.advance(run, &scales, &watched, most)? {
                Ok(()) if !run.queue.is_empty() => return Ok(None),
                // Its nodes touch later than they seemed to: the next window begins where this one ends.
                Ok(()) if without_events < MOST_TRIES => {
                    without_events += 1;
                    longest = f64::INFINITY;
                    extra.clear();
                }
                Ok(()) => return Err(run.not_monotone("gap or pressure", watched.nodes[0], 0.0)),
                // The horizon was wrong: watch what overlapped as well, and not so far.
                Err((outside, time)) => {
                    longest = SHORTER * time;
                    let room = self.size.saturating_sub(extra.len()).max(1);
                    extra.extend(outside.into_iter().take(room).map(|(_, node)| node));
                    run.timings.taken_back += 1;
                }
            }
        }
    }

    /// Makes solution and ranking those of the front.
    fn begin<U: LinearUpdater>(&mut self, run: &mut LoadingRun<U>) -> Result<(), Error> {
        let approach = run.front.approach();
        if !run.field.belongs_to(&run.contact, approach) {
            if self.rate_span == 0.0 {
                self.rate_span = f64::INFINITY;
            }
            run.solve_field(approach, self.rate_span)?;
        }
        if self.ranked != Some((run.contact.revision(), approach)) {
            // The first window of this kind.
            self.survey(run)?;
        }
        Ok(())
    }

    /// Takes everything at the front from the solution there, and ranks the nodes out of contact.
    fn survey<U: LinearUpdater>(&mut self, run: &mut LoadingRun<U>) -> Result<(), Error> {
        let (problem, contact, field) = (&run.problem, &run.contact, &run.field);
        run.front.renew_load(problem, contact, field);
        fill(run, &mut self.ranking, false, Line::touches)?;
        self.ranked = Some((run.contact.revision(), run.front.approach()));
        Ok(())
    }

    /// Solves for the rates once more if they have to serve much further than the last window did.
    fn refine<U: LinearUpdater>(
        &mut self,
        run: &mut LoadingRun<U>,
        scales: &Scales,
        choice: &mut Choice,
        extra: &[usize],
    ) -> Result<(), Error> {
        let furthest = if choice.horizon < f64::INFINITY {
            choice.horizon
        } else {
            let times = choice.watched.iter().map(|(time, _)| *time);
            times.filter(|time| time.is_finite()).fold(0.0, f64::max)
        };
        if furthest > 0.0
            && scales.rate_tolerance(furthest) < 0.5 * scales.rate_tolerance(self.rate_span)
        {
            self.rate_span = furthest;
            run.solve_field(run.front.approach(), furthest)?;
            self.survey(run)?;
            *choice = self.choose(run, scales, extra);
        }
        Ok(())
    }

    /// Opens a window on the chosen nodes.
    fn watch<U: LinearUpdater>(
        &self,
        run: &mut LoadingRun<U>,
        choice: Choice,
        longest: f64,
    ) -> Result<Watched, Error> {
        let nodes: Vec<usize> = choice.watched.iter().map(|&(_, node)| node).collect();
        let approach = run.front.approach();
        let line = |&node: &usize| {
            let line = run.field.line(&run.problem, node, approach);
            [line.gap, line.closing]
        };
        let mut lines: Vec<[f64; 2]> = nodes.iter().map(line).collect();
        run.affordable(nodes.len())?;
        let mut schur = Schur::default();
        run.watch_nodes(&nodes, &mut schur)?;
        if let Some(displacements) = schur.displacements() {
            let gap = run.problem.initial_gap();
            let known = nodes.iter().zip(displacements);
            let improved = known.map(|(&node, [u, rate])| [gap[node] + u - approach, 1.0 - rate]);
            lines = improved.collect();
        }
        let size = nodes.len();
        let matrix = schur.matrix();
        Ok(Watched {
            schur: DMatrix::from_fn(size, size, |i, j| matrix[(i.max(j), i.min(j))]),
            row_sums: schur.row_sums().to_vec(),
            nodes,
            lines,
            horizon: choice.horizon.min(longest),
        })
    }

    /// Goes through a window, and queues its states. The inner error is what overlapped outside of it, and
    /// how long it was: then nothing has changed.
    fn advance<U: LinearUpdater>(
        &mut self,
        run: &mut LoadingRun<U>,
        scales: &Scales,
        watched: &Watched,
        most: usize,
    ) -> Result<Result<(), (Ranking, f64)>, Error> {
        let courses: Vec<Course> = watched.courses();
        let (events, bad) = play(&watched.schur, &courses, watched.horizon, usize::MAX);
        if events.is_empty() {
            return Err(match bad {
                Some(mut bad) => {
                    bad.node = watched.nodes[bad.node];
                    run.not_positive_definite(bad)
                }
                None => {
                    let node = watched.nodes.iter().min().copied();
                    run.not_monotone("closing rate of the gap", node.unwrap_or_default(), 0.0)
                }
            });
        }
        let kept = most.min(with_ties(&events, self.most_events(), scales));
        let (cut, time) = cut(&events, watched.horizon, kept, scales);
        if time <= scales.tie {
            // All of them touch at once. Their gaps are better known than those of the ranking.
            let known: Vec<usize> = events[..cut]
                .iter()
                .map(|event| watched.nodes[event.position])
                .collect();
            return self.enter(run, scales, (time, &known), most).map(Ok);
        }
        let start = run.front;
        let (first, count) = (&events[..cut], run.contact.len());
        let mut joined: Vec<usize> = first.iter().map(|event| event.position).collect();
        for _ in 0..MOST_TRIES {
            let checked = self.go_to_end(run, scales, watched, &joined, time);
            let found = match checked {
                Ok(found) => found,
                Err(error) => {
                    run.contact.truncate(count);
                    run.front = start;
                    return Err(error);
                }
            };
            if found.is_empty() && joined.is_empty() {
                self.last_span = time;
                return Ok(Ok(()));
            }
            if found.is_empty() {
                let ends = watched.at_end(run);
                let correction = correct(&watched.schur, &watched.lines, &ends, time);
                let played = (first, &joined[..], time);
                let settled = ties::second_pass(watched, &correction, played);
                let left_out = correction.left_out(&watched.schur);
                self.left_out = left_out.max(REMEMBERED * self.left_out);
                let change = ties::mean_change(first, &settled.events, time);
                let most_change = MOST_CHANGE * time / joined.len() as f64;
                // Half of it, which may be all of it where events tie.
                let half = joined.len() / 2;
                let certain = joined.len() <= CERTAIN || with_ties(&events, half, scales) >= cut;
                let is_poor =
                    !certain && (change > most_change || joined.len() > 2 * self.most_events());
                let settled = match is_poor {
                    true => None,
                    false if self.settles => {
                        let end = (&start, certain);
                        ties::settle(run, scales, watched, &correction, settled, end)?
                    }
                    false => Some(settled),
                };
                let Some(settled) = settled else {
                    run.truncate(count)?;
                    run.front = start;
                    self.left_out = self.left_out.max(LEFT_OUT / half as f64);
                    run.timings.taken_back += 1;
                    return Ok(Err((Ranking::new(), f64::INFINITY)));
                };
                return self
                    .finish(run, watched, &correction, &settled, (&start, time))
                    .map(Ok);
            }
            run.truncate(count)?;
            run.front = start;
            if !found.outside.is_empty() {
                self.begin(run)?;
                return Ok(Err((found.outside, time)));
            }
            joined.retain(|position| !found.tension.contains(position));
            joined.extend(found.overlap);
            run.timings.taken_back += 1;
        }
        let node = watched.nodes[first[0].position];
        Err(run.not_monotone("gap or pressure", node, 0.0))
    }

    /// How many events a window may have. Their times are off by what Schur complements leave out of pivots, which grows with
    /// their number.
    fn most_events(&self) -> usize {
        ((LEFT_OUT / self.left_out) as usize).max(1)
    }

    /// Lets nodes join, solves at the window's end, and looks for what contradicts them there.
    fn go_to_end<U: LinearUpdater>(
        &mut self,
        run: &mut LoadingRun<U>,
        scales: &Scales,
        watched: &Watched,
        joined: &[usize],
        time: f64,
    ) -> Result<Contradictions, Error> {
        for &position in joined {
            run.contact.push(watched.nodes[position])?;
        }
        let touched = Touched::of(watched.complement()?, joined)?;
        run.updater.join(&run.problem, &run.contact, &touched)?;
        let approach = run.front.approach() + time;
        self.rate_span = time.max(self.last_span);
        run.solve_field(approach, self.rate_span)?;
        run.front.place_at(approach);
        self.survey(run)?;
        let overlap = -scales.overlap(approach);
        let mut found = Contradictions::default();
        let pressures = run.field.pressures(&run.contact, approach);
        let first = run.contact.len() - joined.len();
        for (&position, (_, pressure)) in joined.iter().zip(pressures.skip(first)) {
            if pressure * watched.schur[(position, position)] < overlap {
                found.tension.push(position);
            }
        }
        for &(time, node) in &self.ranking {
            if time >= 0.0 {
                continue;
            }
            let line = run.field.line(&run.problem, node, approach);
            if line.gap < overlap {
                match watched.nodes.iter().position(|other| *other == node) {
                    Some(position) if !joined.contains(&position) => found.overlap.push(position),
                    Some(_) => {}
                    None => found.outside.push((time, node)),
                }
            }
        }
        found
            .outside
            .sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        Ok(found)
    }

    /// Queues the states of a window that ends at the front.
    fn finish<U: LinearUpdater>(
        &mut self,
        run: &mut LoadingRun<U>,
        watched: &Watched,
        correction: &Correction,
        settled: &Settled,
        (start, time): (&Front, f64),
    ) -> Result<(), Error> {
        self.last_span = time;
        let count = run.contact.len() - settled.events.len();
        let order = settled
            .events
            .iter()
            .map(|event| watched.nodes[event.position]);
        run.rearrange(count, &order.collect::<Vec<_>>())?;
        self.ranked = Some((run.contact.revision(), run.front.approach()));
        states::enqueue(run, watched, correction, settled, (start, time))
    }
}

/// So many events, and what ties with the last of them.
fn with_ties(events: &[Played], most: usize, scales: &Scales) -> usize {
    let few = most.clamp(1, events.len());
    let tied = events[few - 1..].windows(2);
    few + tied
        .take_while(|pair| pair[1].time - pair[0].time <= scales.tie)
        .count()
}

impl Contradictions {
    fn is_empty(&self) -> bool {
        self.tension.is_empty() && self.overlap.is_empty() && self.outside.is_empty()
    }
}

#[cfg(test)]
mod tests;
