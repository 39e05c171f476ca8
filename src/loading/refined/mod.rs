//! Events in windows, without a factor: with Schur complements that are nearly exact.
//!
//! The order of events inside a window rests on small changes only, so that a Schur complement that is nearly
//! right gives nearly the right order. The exact solution at the window's end, which the next window needs
//! anyway, then corrects it, and the same events are played a second time. What is still closer than the
//! remaining error is settled by one exact solution each.

pub(super) mod candidates;
pub(super) mod leaving;
mod plateau;
pub(super) mod resumed;
mod states;
#[cfg(test)]
mod window_tests;
#[cfg(test)]
mod wrong_complements;

use super::gap_field::GapLine;
use super::ranking::{Ranking, fill};
use super::run::{LoadingRun, Mark};
use super::state::ContactEvent;
use super::tolerances::WindowTolerances;
use super::window::correction::{self, Correction};
use super::window::ties::{self, Beginning, Question, Settled};
use super::window::{Window, WindowEvent};
use crate::loading::tuning::{
    BEFORE_RELEASE, CERTAIN, FEWEST, LEAST_CONTACT, LEFT_OUT, MOST_CHANGE, MOST_TRIES, REMEMBERED,
    SHORTER, WATCHED, WATCHED_UNSETTLED,
};
use crate::updater::{Iterations, Schur, WindowFactor};
use crate::{Error, UpdaterError};
use candidates::{Candidates, cut, with_ties};
use leaving::{Attempt, Before, Between};

/// Finds events in windows that are corrected at their end.
#[derive(Debug)]
pub(super) struct Refined {
    size: usize,
    /// Whether events that are too close to be told apart get a solution of their own.
    settles: bool,
    /// Whether nodes may leave.
    may_leave: bool,
    /// The nodes out of contact, at the present approach.
    ranking: Ranking,
    /// The contact and approach that the ranking belongs to.
    ranked: Option<(u64, f64)>,
    /// How far the last window went, and the span that the rates at hand serve.
    last_span: f64,
    rate_span: f64,
    /// The part of a pivot that Schur complements were off by lately, at worst.
    left_out: f64,
    /// The nodes of the last window in the order in which its end was solved.
    joined: Vec<usize>,
}

/// How a window ended.
enum Outcome {
    /// With states, or with none where no node touches before its end.
    Done,
    /// Its end, or a solution in it, contradicted it: the next one has fewer events. Nothing has changed.
    TakenBack,
    /// Nodes overlap that were not watched: (when they would touch, node), and how long it was. Nothing has changed.
    Overlap { outside: Ranking, time: f64 },
    /// A node may leave after this time. Nothing has changed.
    Leaves { after: f64 },
    /// The next event is to have a solution of its own. Nothing has changed.
    Alone,
}

/// The nodes at which a contact contradicts the conditions of contact at a window's end.
#[derive(Debug, Default)]
struct Contradictions {
    /// Positions of events whose node is under tension.
    tension: Vec<usize>,
    /// Positions of watched nodes that overlap.
    overlap: Vec<usize>,
    /// (when it would touch, node) of nodes that overlap and were not watched.
    outside: Ranking,
}

impl Refined {
    pub(super) fn new(size: Option<usize>, settles: bool) -> Self {
        let watched = if settles { WATCHED } else { WATCHED_UNSETTLED };
        Self {
            size: size.unwrap_or(watched).max(FEWEST),
            settles,
            may_leave: false,
            ranking: Vec::new(),
            ranked: None,
            last_span: 0.0,
            rate_span: 0.0,
            left_out: 0.0,
            joined: Vec::new(),
        }
    }

    /// The same on a body on which nodes may leave.
    pub(super) fn with_releases(size: Option<usize>, settles: bool) -> Self {
        Self { may_leave: true, ..Self::new(size, settles) }
    }

    /// Computes a window of states before the next node leaves, where nodes may. Without one nothing has happened to the path.
    pub(super) fn attempt(
        &mut self,
        run: &mut LoadingRun,
        iterations: &mut dyn Iterations,
    ) -> Result<Attempt, Error> {
        let (count, nodes) = (run.contact.len(), run.problem.grid().nodes());
        if count < LEAST_CONTACT || count == nodes || iterations.check_cells(&run.problem).is_err()
        {
            return Ok(Attempt::NotBegun);
        }
        let (mut extra, mut longest) = (Vec::new(), f64::INFINITY);
        let mut attempt = Attempt::NotBegun;
        for _ in 0..MOST_TRIES {
            let tolerances = WindowTolerances::of(run, iterations.tolerance());
            self.begin(run, iterations)?;
            let mut candidates = self.choose(run, &tolerances, &extra);
            self.improve_rates(run, iterations, &tolerances, &mut candidates, &extra)?;
            longest = longest.min(BEFORE_RELEASE * leaving::first_release(run));
            let first = candidates.nodes.first().map_or(f64::INFINITY, |(time, _)| *time);
            if candidates.group.is_some() || first.is_nan() || first >= longest {
                return Ok(attempt);
            }
            attempt = Attempt::Failed;
            let window = self.propose(run, iterations, candidates, longest)?;
            if iterations.answers().len() != window.nodes().len() {
                return Ok(attempt);
            }
            match self.follow(run, iterations, &tolerances, &window, nodes - count)? {
                Outcome::Done if !run.queue.is_empty() => return Ok(Attempt::Made),
                Outcome::Done => {
                    longest = f64::INFINITY;
                    extra.clear();
                }
                Outcome::TakenBack => longest = f64::INFINITY,
                Outcome::Overlap { outside, time } => {
                    longest = SHORTER * time;
                    let room = self.size.saturating_sub(extra.len()).max(1);
                    extra.extend(outside.into_iter().take(room).map(|(_, node)| node));
                }
                Outcome::Leaves { after } => longest = after,
                Outcome::Alone => return Ok(attempt),
            }
            run.timings.taken_back += usize::from(run.queue.is_empty());
        }
        Ok(attempt)
    }

    /// Computes a window of states, with no more than `most_nodes` in contact.
    pub(super) fn produce(
        &mut self,
        run: &mut LoadingRun,
        iterations: &mut dyn Iterations,
        most_nodes: usize,
    ) -> Result<(), Error> {
        let most = most_nodes - run.contact.len();
        let (mut extra, mut longest) = (Vec::new(), f64::INFINITY);
        let mut without_events = 0;
        loop {
            let tolerances = WindowTolerances::of(run, iterations.tolerance());
            self.begin(run, iterations)?;
            let mut candidates = self.choose(run, &tolerances, &extra);
            self.improve_rates(run, iterations, &tolerances, &mut candidates, &extra)?;
            if let Some(time) = candidates.group {
                return self.enter(run, iterations, &tolerances, (time, &[]), most);
            }
            let window = self.propose(run, iterations, candidates, longest)?;
            match self.follow(run, iterations, &tolerances, &window, most)? {
                Outcome::Done if !run.queue.is_empty() => return Ok(()),
                // Its nodes touch later than they seemed to: the next window begins where this one ends.
                Outcome::Done if without_events < MOST_TRIES => {
                    without_events += 1;
                    longest = f64::INFINITY;
                    extra.clear();
                }
                Outcome::Done => {
                    return Err(run.not_monotone("gap or pressure", window.node(0), 0.0));
                }
                Outcome::TakenBack => {
                    longest = f64::INFINITY;
                    run.timings.taken_back += 1;
                }
                // No node leaves.
                Outcome::Leaves { .. } | Outcome::Alone => {
                    return Err(run.not_monotone("gap or pressure", window.node(0), 0.0));
                }
                // The horizon was wrong: watch what overlapped as well, and not so far.
                Outcome::Overlap { outside, time } => {
                    longest = SHORTER * time;
                    let room = self.size.saturating_sub(extra.len()).max(1);
                    extra.extend(outside.into_iter().take(room).map(|(_, node)| node));
                    run.timings.taken_back += 1;
                }
            }
        }
    }

    /// Makes solution and ranking those of the present approach.
    fn begin(
        &mut self,
        run: &mut LoadingRun,
        iterations: &mut dyn Iterations,
    ) -> Result<(), Error> {
        let approach = run.scalars.approach();
        if !run.field.belongs_to(&run.contact, approach) {
            if self.rate_span == 0.0 {
                self.rate_span = f64::INFINITY;
            }
            run.advance_field(iterations, approach, self.rate_span)?;
        }
        if self.ranked != Some((run.contact.revision(), approach)) {
            // The first window of this kind.
            self.survey(run)?;
        }
        Ok(())
    }

    /// Takes all scalars from the solution at the present approach, and ranks the nodes out of contact.
    fn survey(&mut self, run: &mut LoadingRun) -> Result<(), Error> {
        let (problem, contact, field) = (&run.problem, &run.contact, &run.field);
        run.scalars.renew_load(problem, contact, field);
        fill(run, &mut self.ranking, None, GapLine::touches)?;
        self.ranked = Some((run.contact.revision(), run.scalars.approach()));
        Ok(())
    }

    /// Solves for the rates once more if they have to serve much further than the last window did.
    fn improve_rates(
        &mut self,
        run: &mut LoadingRun,
        iterations: &mut dyn Iterations,
        tolerances: &WindowTolerances,
        candidates: &mut Candidates,
        extra: &[usize],
    ) -> Result<(), Error> {
        let furthest = if candidates.horizon < f64::INFINITY {
            candidates.horizon
        } else {
            let times = candidates.nodes.iter().map(|(time, _)| *time);
            times.filter(|time| time.is_finite()).fold(0.0, f64::max)
        };
        if furthest > 0.0
            && tolerances.rate_tolerance(furthest) < 0.5 * tolerances.rate_tolerance(self.rate_span)
        {
            self.rate_span = furthest;
            run.advance_field(iterations, run.scalars.approach(), furthest)?;
            self.survey(run)?;
            *candidates = self.choose(run, tolerances, extra);
        }
        Ok(())
    }

    /// Opens a window on the candidates, with lines that are better known than those of the gap field.
    fn propose(
        &self,
        run: &mut LoadingRun,
        iterations: &mut dyn Iterations,
        candidates: Candidates,
        longest: f64,
    ) -> Result<Window, Error> {
        let nodes: Vec<usize> = candidates.nodes.iter().map(|&(_, node)| node).collect();
        let (approach, count) = (run.scalars.approach(), run.contact.len());
        let (problem, contact) = (&run.problem, &run.contact);
        // One node at least joins.
        let grown = iterations.bytes(problem.grid().nodes(), count + 1);
        let needed = grown.saturating_add(WindowFactor::bytes(1));
        run.memory.check(needed, count)?;
        let mut schur = Schur::default();
        let displacements = iterations.propose(problem, contact, &nodes, &mut schur)?;
        UpdaterError::check_length("watched displacements", displacements.len(), nodes.len())?;
        if !displacements.as_flattened().iter().copied().all(f64::is_finite) {
            return Err(run.not_finite());
        }
        let gap = problem.initial_gap();
        let lines = nodes.iter().zip(displacements).map(|(&node, [u, rate])| {
            let (gap, closing) = (gap[node] + u - approach, 1.0 - rate);
            (node, GapLine { gap, closing })
        });
        let mut window = Window::default();
        let (_, own) = window.open((approach, candidates.horizon.min(longest)), lines);
        *own = schur;
        run.check_complement(window.nodes(), window.schur())?;
        window.begin();
        run.timings.windows += 1;
        Ok(window)
    }

    /// Goes through a window, and queues its states.
    fn follow(
        &mut self,
        run: &mut LoadingRun,
        iterations: &mut dyn Iterations,
        tolerances: &WindowTolerances,
        window: &Window,
        most: usize,
    ) -> Result<Outcome, Error> {
        let mut first = window.clone();
        let bad = first.play(usize::MAX);
        let events = first.events();
        if events.is_empty() && self.may_leave {
            return Ok(Outcome::Alone);
        }
        if events.is_empty() {
            return Err(match bad {
                Some(bad) => run.not_positive_definite(bad),
                None => {
                    let node = window.nodes().iter().min().copied();
                    run.not_monotone("closing rate of the gap", node.unwrap_or_default(), 0.0)
                }
            });
        }
        let kept = most.min(with_ties(events, self.most_events(), tolerances));
        let (cut, time) = cut(events, window.horizon(), kept, tolerances);
        let first = &events[..cut];
        if time <= tolerances.tie && self.may_leave {
            return Ok(Outcome::Alone);
        }
        if time <= tolerances.tie {
            // All of them touch at once. Their gaps are better known than those of the ranking.
            let known: Vec<usize> = first.iter().map(|event| window.node(event.position)).collect();
            self.enter(run, iterations, tolerances, (time, &known), most)?;
            return Ok(Outcome::Done);
        }
        let mark = run.mark();
        let before = self.may_leave.then(|| Before::of(run, self, window));
        let mut joined: Vec<usize> = first.iter().map(|event| event.position).collect();
        for _ in 0..MOST_TRIES {
            let found = match self.go_to_end(run, iterations, tolerances, window, &joined, time) {
                Ok(found) => found,
                Err(error) => {
                    let _ =
                        run.roll_back(&mark, |problem, contact| iterations.cut(problem, contact));
                    return Err(error);
                }
            };
            let mut contradicted = None;
            if let Some(before) = &before {
                let tension = tolerances.tension(run);
                let at = (run.scalars.approach(), time);
                let after =
                    before.sound_until(run, tension, at).map(|after| BEFORE_RELEASE * after);
                let after = after.or_else(|| (!found.tension.is_empty()).then_some(0.5 * time));
                contradicted = after.map(|after| Outcome::Leaves { after });
            }
            if found.is_empty() && contradicted.is_none() {
                if joined.is_empty() {
                    self.last_span = time;
                    return Ok(Outcome::Done);
                }
                let at = (&mark, time);
                let passed =
                    self.refine(run, iterations, tolerances, window, (first, &joined), at)?;
                if let (Some(before), Some((correction, settled))) = (&before, &passed) {
                    let events = (&correction.window, &settled.events[..]);
                    let found = before.look_between(run, iterations, tolerances, events, time);
                    contradicted = match found {
                        Between::Nothing => None,
                        Between::Until(after) => Some(Outcome::Leaves { after }),
                        Between::Outside(outside) => Some(Outcome::Overlap { outside, time }),
                    };
                }
                if let Some((correction, settled)) = passed.filter(|_| contradicted.is_none()) {
                    self.finish(run, correction, &settled, at, tolerances)?;
                    return Ok(Outcome::Done);
                }
            }
            run.roll_back(&mark, |problem, contact| iterations.cut(problem, contact))?;
            if let Some(contradicted) = contradicted {
                return Ok(contradicted);
            }
            if found.is_empty() {
                return Ok(Outcome::TakenBack);
            }
            if !found.outside.is_empty() {
                self.begin(run, iterations)?;
                let outside = found.outside;
                return Ok(Outcome::Overlap { outside, time });
            }
            joined.retain(|position| !found.tension.contains(position));
            joined.extend(found.overlap);
            run.timings.taken_back += 1;
        }
        if self.may_leave {
            return Ok(Outcome::Alone);
        }
        let node = window.node(first[0].position);
        Err(run.not_monotone("gap or pressure", node, 0.0))
    }

    /// Corrects a window by the solution at its end, and settles the events in it; `None` if the end, or a solution in between,
    /// contradicts what was expected.
    fn refine(
        &mut self,
        run: &mut LoadingRun,
        iterations: &mut dyn Iterations,
        tolerances: &WindowTolerances,
        window: &Window,
        (first, joined): (&[WindowEvent], &[usize]),
        (mark, time): (&Mark, f64),
    ) -> Result<Option<(Correction, Settled)>, Error> {
        let ends = correction::at_end(window, run);
        let correction = correction::correct(window, &ends, time);
        let event = |&position: &usize| {
            let found = first.iter().find(|event| event.position == position);
            let closing = window.course(position).line.closing;
            let touch = WindowEvent { position, kind: ContactEvent::Touch, time, closing };
            found.copied().unwrap_or(touch)
        };
        let happened: Vec<WindowEvent> = joined.iter().map(event).collect();
        let settled = ties::second_pass(&correction, (first, &happened), time);
        self.left_out = correction.left_out().max(REMEMBERED * self.left_out);
        let change = ties::mean_change(first, &settled.events, time);
        let most_change = MOST_CHANGE * time / joined.len() as f64;
        // Half of it, which may be all of it where events tie.
        let half = joined.len() / 2;
        let is_certain =
            joined.len() <= CERTAIN || with_ties(first, half, tolerances) >= first.len();
        let is_poor =
            !is_certain && (change > most_change || joined.len() > 2 * self.most_events());
        let settled = match is_poor {
            true => None,
            false if self.settles => {
                let (approach, count) = (mark.scalars.approach(), mark.count);
                let beginning = Beginning { approach, count, is_certain };
                let at = (count, approach);
                let solve = |question: Question<'_>, nodes: &[usize]| {
                    gaps_before(run, iterations, (window, question, nodes), at)
                };
                ties::settle(&correction.window, tolerances, settled, beginning, solve)?
            }
            false => Some(settled),
        };
        if settled.is_none() {
            self.left_out = self.left_out.max(LEFT_OUT / half as f64);
        }
        Ok(settled.map(|mut settled| {
            let times = settled.events.iter().map(|event| event.time);
            correction::widen(&mut settled.errors, times, (self.left_out, time));
            (correction, settled)
        }))
    }

    /// How many events a window may have. Their times are off by what Schur complements leave out of pivots, which grows with
    /// their number.
    fn most_events(&self) -> usize {
        ((LEFT_OUT / self.left_out) as usize).max(1)
    }

    /// Lets nodes join, solves at the window's end, and looks for what contradicts them there.
    fn go_to_end(
        &mut self,
        run: &mut LoadingRun,
        iterations: &mut dyn Iterations,
        tolerances: &WindowTolerances,
        window: &Window,
        joined: &[usize],
        time: f64,
    ) -> Result<Contradictions, Error> {
        for &position in joined {
            run.contact.push(window.node(position))?;
        }
        let approach = run.scalars.approach() + time;
        self.rate_span = time.max(self.last_span);
        run.advance_field(iterations, approach, self.rate_span)?;
        run.scalars.place_at(approach);
        self.survey(run)?;
        let first = run.contact.len() - joined.len();
        if !self.may_leave {
            keeps_growing(run, first, tolerances)?;
        }
        let overlap = -tolerances.overlap(approach);
        let mut found = Contradictions::default();
        let pressures = run.field.pressures(&run.contact, approach);
        for (&position, (_, pressure)) in joined.iter().zip(pressures.skip(first)) {
            if pressure * window.schur().entry(position, position) < overlap {
                found.tension.push(position);
            }
        }
        for &(time, node) in &self.ranking {
            // A gap that has closed may open again, where nodes may leave.
            let may_overlap = time < 0.0 || time == f64::INFINITY;
            if may_overlap && run.line(node).gap < overlap {
                match window.position(node) {
                    Some(position) if !joined.contains(&position) => found.overlap.push(position),
                    Some(_) => {}
                    None => found.outside.push((time, node)),
                }
            }
        }
        found.outside.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        Ok(found)
    }

    /// Queues the states of a corrected window that ends at the present approach.
    fn finish(
        &mut self,
        run: &mut LoadingRun,
        correction: Correction,
        settled: &Settled,
        (mark, time): (&Mark, f64),
        tolerances: &WindowTolerances,
    ) -> Result<(), Error> {
        self.last_span = time;
        let events = settled.events.iter();
        let window = correction.window;
        let order: Vec<usize> = events.map(|event| window.node(event.position)).collect();
        self.joined = run.contact.order()[mark.count..].to_vec();
        run.rearrange(mark.count, &order)?;
        self.ranked = Some((run.contact.revision(), run.scalars.approach()));
        states::enqueue(run, window, settled, (mark, time), tolerances)
    }
}

/// Gaps of some nodes at a moment of a window, which began at an approach with so many nodes in contact.
pub(super) fn gaps_before(
    run: &mut LoadingRun,
    iterations: &mut dyn Iterations,
    (window, question, nodes): (&Window, Question<'_>, &[usize]),
    (count, approach): (usize, f64),
) -> Result<Vec<f64>, Error> {
    run.timings.ties += 1;
    let order = question.events.iter().map(|event| window.node(event.position));
    run.rearrange(count, &order.collect::<Vec<usize>>())?;
    let (count, approach) = (count + question.done, approach + question.time());
    let (problem, contact) = (&run.problem, &run.contact);
    let displacement = iterations.probe(problem, contact, count, approach, question.error)?;
    UpdaterError::check_length("displacements", displacement.len(), problem.grid().nodes())?;
    if !displacement.iter().copied().all(f64::is_finite) {
        return Err(run.not_finite());
    }
    let gap = |&node: &usize| problem.initial_gap()[node] + displacement[node] - approach;
    Ok(nodes.iter().map(gap).collect())
}

/// `Ok` if none of the first `count` nodes in contact is pulled at the present solution: where contact grows they keep what they carry.
fn keeps_growing(
    run: &LoadingRun,
    count: usize,
    tolerances: &WindowTolerances,
) -> Result<(), Error> {
    let approach = run.scalars.approach();
    match run.negative_pressure(count, (approach, tolerances.overlap(approach))) {
        Some((node, value)) => Err(run.not_monotone("pressure", node, value)),
        None => Ok(()),
    }
}

impl Contradictions {
    fn is_empty(&self) -> bool {
        self.tension.is_empty() && self.overlap.is_empty() && self.outside.is_empty()
    }
}

#[cfg(test)]
mod tests;
