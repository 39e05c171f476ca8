//! Events in windows, without a factor: with a matrix that is nearly exact.
//!
//! Gaps change little inside a window, so that a matrix that is nearly right gives nearly the right order of events.
//! The exact solution at the window's end, which the next window needs anyway, then corrects it, and the same events
//! are played a second time. What is still closer than the remaining error is settled by one exact solution each.

pub(super) mod choice;
pub(super) mod leaving;
mod plateau;
pub(super) mod resumed;
mod states;
#[cfg(test)]
mod test_wrong_matrices;
#[cfg(test)]
mod window_tests;

use super::contradiction::{Slack, contradiction};
use super::gap_field::GapLine;
use super::plastic::Plastic;
use super::ranking::{self, Ranking, fill, rank_yields};
use super::run::LoadingRun;
use super::scalars::Rates;
use super::tolerances::WindowTolerances;
use super::trial::{Trial, of_nodes};
use super::walk::Carried;
use super::window::correction::{self, AtEnd, Correction};
use super::window::ties::{self, Beginning, Question, Settled};
use super::window::{Watched, Window, WindowEvent};
use crate::contact::ContactSequence;
use crate::loading::tuning::{
    BEFORE_RELEASE, CERTAIN, FEWEST, LEAST_CONTACT, LEFT_OUT, MOST_CHANGE, MOST_TRIES, OF_RESIDUAL,
    OF_RESIDUAL_BEYOND, REMEMBERED, SLACK_OF_RATE, TRUSTED, WATCHED, WATCHED_UNSETTLED,
};
use crate::updater::{Beside, Iterations, Proposal, Schur, WindowFactor};
use crate::{Boundary, Error, Problem, UpdaterError};
use choice::{Candidates, cut, with_ties};
use leaving::{AtStart, Attempt};
use states::Passed;

/// Finds events in windows that are corrected at their end.
#[derive(Debug)]
pub(super) struct Estimated {
    size: usize,
    /// Whether events that are too close to be told apart get a solution of their own.
    settles: bool,
    /// The nodes that may touch or yield, by the time at which they would from the present approach on if nothing else
    /// came first.
    ranking: Ranking,
    /// The time at which the first node that is not ranked would yield.
    beyond: f64,
    /// Rates at the present approach.
    rates: Rates,
    /// By how much pressures there may be off, times what a unit pressure displaces \[m\].
    left: f64,
    /// The revision of the contact, and the approach, that all these belong to.
    ranked: Option<(u64, f64)>,
    /// How far the last window went, and the span that the rates at hand serve.
    last_span: f64,
    rate_span: f64,
    /// The part of a pivot that matrices were off by lately, at worst.
    left_out: f64,
    /// The nodes of the last window in the order in which its end was solved.
    joined: Vec<usize>,
}

/// How a window ended.
enum Outcome {
    Done,
    /// A solution in it contradicted what was expected: the next one has fewer events. The path is as it was.
    TakenBack,
    /// Only where nodes may leave: the next event needs a solution of its own. The path is as it was.
    Alone,
}

impl Estimated {
    pub(super) fn new(size: Option<usize>, settles: bool) -> Self {
        let watched = if settles { WATCHED } else { WATCHED_UNSETTLED };
        Self {
            size: size.unwrap_or(watched).max(FEWEST),
            settles,
            ranking: Vec::new(),
            beyond: f64::INFINITY,
            rates: Rates { unit_stiffness: 0.0, closing: 0.0, plastic: [0.0; 2] },
            left: 0.0,
            ranked: None,
            last_span: 0.0,
            rate_span: 0.0,
            left_out: 0.0,
            joined: Vec::new(),
        }
    }

    /// Where nodes may leave: computes a window of states before the next one does. If none is made, the path is as it
    /// was.
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
        let mut attempt = Attempt::NotBegun;
        for _ in 0..MOST_TRIES {
            let tolerances = WindowTolerances::of(run, iterations.tolerance());
            let candidates = self.prepare(run, iterations, &tolerances)?;
            let longest = BEFORE_RELEASE * leaving::first_release(run);
            let first = candidates.nodes.first().map_or(f64::INFINITY, |(time, _)| *time);
            if candidates.group.is_some() || first.is_nan() || first >= longest {
                return Ok(attempt);
            }
            attempt = Attempt::Failed;
            let window = self.propose(run, iterations, candidates, longest)?;
            if iterations.answers().len() != window.nodes().len() {
                return Ok(attempt);
            }
            match self.follow(run, iterations, &tolerances, &window)? {
                Outcome::Done => return Ok(Attempt::Made),
                Outcome::TakenBack => run.timings.taken_back += 1,
                Outcome::Alone => return Ok(attempt),
            }
        }
        Ok(attempt)
    }

    /// Where nodes may not leave: computes a window of states; none if no node is left to touch or to yield. The window
    /// does not depend on where the path is to end, so that a path continued beyond that has the same windows.
    pub(super) fn produce(
        &mut self,
        run: &mut LoadingRun,
        iterations: &mut dyn Iterations,
    ) -> Result<(), Error> {
        loop {
            let tolerances = WindowTolerances::of(run, iterations.tolerance());
            let candidates = self.prepare(run, iterations, &tolerances)?;
            if self.ranking.is_empty() {
                return Ok(());
            }
            if let Some(time) = candidates.group {
                return self.enter(run, iterations, &tolerances, (time, &[]));
            }
            let window = self.propose(run, iterations, candidates, f64::INFINITY)?;
            match self.follow(run, iterations, &tolerances, &window)? {
                Outcome::Done => return Ok(()),
                // `Alone` comes only where nodes may leave, which is not here.
                Outcome::TakenBack | Outcome::Alone => run.timings.taken_back += 1,
            }
        }
    }

    /// Solution, ranking and the nodes to watch at the present approach.
    fn prepare(
        &mut self,
        run: &mut LoadingRun,
        iterations: &mut dyn Iterations,
        tolerances: &WindowTolerances,
    ) -> Result<Candidates, Error> {
        self.begin(run, iterations, tolerances)?;
        let candidates = self.choose(run, tolerances);
        // Rates that have to serve much further than the last window went are solved for once more.
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
            self.survey(run, tolerances)?;
            return Ok(self.choose(run, tolerances));
        }
        Ok(candidates)
    }

    /// Makes solution and ranking those of the present approach.
    fn begin(
        &mut self,
        run: &mut LoadingRun,
        iterations: &mut dyn Iterations,
        tolerances: &WindowTolerances,
    ) -> Result<(), Error> {
        let approach = run.scalars.approach();
        if !run.field.belongs_to(&run.contact, approach) {
            if self.rate_span == 0.0 {
                self.rate_span = f64::INFINITY;
            }
            run.advance_field(iterations, approach, self.rate_span)?;
        }
        if self.ranked != Some((run.contact.revision(), approach)) {
            self.survey(run, tolerances)?;
        }
        Ok(())
    }

    /// Takes all scalars from the solution at the present approach, and ranks the nodes.
    fn survey(&mut self, run: &mut LoadingRun, tolerances: &WindowTolerances) -> Result<(), Error> {
        self.survey_late(run, tolerances, 0.0)
    }

    /// The same after the approach has advanced by `late` without events: gaps may overlap by as much.
    fn survey_late(
        &mut self,
        run: &mut LoadingRun,
        tolerances: &WindowTolerances,
        late: f64,
    ) -> Result<(), Error> {
        if run.plastic.is_none() {
            return self.survey_within(run, Slack::ANY);
        }
        let approach = run.scalars.approach();
        let [_, slack] = slacks(run, (&run.problem, &run.contact), tolerances, approach);
        self.left = slack.excess;
        let gap = (slack.gap + late).max(run.inherited_slack());
        self.survey_within(run, Slack { gap, ..slack })
    }

    /// The same with these bounds for what contradicts contact that grows.
    fn survey_within(&mut self, run: &mut LoadingRun, slack: Slack) -> Result<(), Error> {
        self.ranked = None;
        self.beyond = f64::INFINITY;
        match run.plastic.clone().filter(|plastic| plastic.count() > 0) {
            Some(plastic) => {
                self.rates = ranking::survey(run, &plastic, &mut self.ranking, slack)?;
            }
            None => {
                let (problem, contact, field) = (&run.problem, &run.contact, &run.field);
                run.scalars.renew_load(problem, contact, field);
                fill(run, &mut self.ranking, None, GapLine::touches)?;
                [_, self.beyond] = rank_yields(run, &mut self.ranking);
                self.rates = run.scalars.rates();
            }
        }
        self.ranked = Some((run.contact.revision(), run.scalars.approach()));
        Ok(())
    }

    /// Opens a window on the candidates, no longer than a time. Its lines are better than those of the gap field: the
    /// iterations correct them by the residual of the solution.
    fn propose(
        &self,
        run: &mut LoadingRun,
        iterations: &mut dyn Iterations,
        candidates: Candidates,
        longest: f64,
    ) -> Result<Window, Error> {
        let (approach, count) = (run.scalars.approach(), run.contact.len());
        let (problem, contact) = (&run.problem, &run.contact);
        // One node at least joins.
        let grown = iterations.bytes(problem.grid().nodes(), count + 1);
        run.memory.check(grown.saturating_add(WindowFactor::bytes(1)), count)?;
        let nodes = candidates.nodes.iter().map(|&(_, node)| node);
        let (inside, outside): (Vec<usize>, Vec<usize>) =
            nodes.partition(|&node| contact.contains(node));
        let plastic = run.plastic.as_deref();
        let has_yielded = plastic.is_some_and(|plastic| plastic.count() > 0);
        let beside = plastic.filter(|_| has_yielded || !inside.is_empty()).map(beside);
        let is_of_touches = beside.is_none();
        let mut schur = Schur::default();
        let parts = [&outside[..], &inside];
        let Proposal { lines, sums } =
            iterations.propose(problem, contact, parts, beside.as_ref(), &mut schur)?;
        let nodes = [&outside[..], &inside].concat();
        UpdaterError::check_length("watched displacements", lines.len(), nodes.len())?;
        UpdaterError::check_length("watched sums", sums.len(), nodes.len())?;
        let numbers = lines.as_flattened().iter().chain(sums.as_flattened());
        if !numbers.copied().all(f64::is_finite) {
            return Err(run.not_finite());
        }
        run.check_complement(&nodes, &schur)?;
        let gap = problem.initial_gap();
        let watched = nodes.iter().zip(lines.iter().zip(&sums)).enumerate();
        let watched = watched.map(|(k, (&node, (&[value, rate], &of_gap)))| {
            let of = (node, run.hardness(node));
            if k >= outside.len() {
                return Watched::pressed(of, [value, rate], of_gap);
            }
            let line = GapLine { gap: gap[node] + value - approach, closing: 1.0 - rate };
            Watched::apart(of, line, of_gap)
        });
        let mut watched: Vec<Watched> = watched.collect();
        let horizon = candidates.horizon.min(self.beyond);
        if is_of_touches {
            Watched::leave_out_pressures(&mut watched, &schur, horizon);
        }
        // Beside nodes that yield others touch or yield sooner than their lines tell.
        let may_yield = watched.iter().any(|watched| watched.hardness.is_finite());
        let trusted = if has_yielded || may_yield { TRUSTED * horizon } else { horizon };
        let horizon = trusted.min(longest);
        let mut window = Window::default();
        *window.schur_mut() = schur;
        window.begin_both((approach, horizon), &watched, count);
        run.timings.windows += 1;
        Ok(window)
    }

    /// Goes through a window, and queues its states. Where its end contradicts events, fewer are tried.
    fn follow(
        &mut self,
        run: &mut LoadingRun,
        iterations: &mut dyn Iterations,
        tolerances: &WindowTolerances,
        window: &Window,
    ) -> Result<Outcome, Error> {
        let mut first = window.clone();
        let bad = first.play(usize::MAX);
        let events = first.events();
        if events.is_empty() && run.may_leave() {
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
        let most = with_ties(events, self.most_events(), tolerances);
        let horizon = (window.horizon(), window.nodes().len() == self.ranking.len());
        let (mut kept, mut time) = cut(events, horizon, most, tolerances);
        let start = run.scalars.approach();
        let at_start = run.may_leave().then(|| AtStart::of(run, &self.ranking, window));
        let mut has_moved = false;
        loop {
            if time <= tolerances.tie {
                if run.may_leave() {
                    return Ok(Outcome::Alone);
                }
                // All of them happen at once. Their courses are better known than those of the ranking.
                let node = |event: &WindowEvent| window.node(event.position);
                let known: Vec<usize> = events[..kept].iter().map(node).collect();
                if has_moved {
                    self.begin(run, iterations, tolerances)?;
                }
                self.enter(run, iterations, tolerances, (time, &known))?;
                return Ok(Outcome::Done);
            }
            let trial = Trial::of(run, &of_nodes(window, &events[..kept]))?;
            self.rate_span = time.max(self.last_span);
            has_moved = true;
            if let Err(error) = go_to(run, iterations, &trial, (start + time, self.rate_span)) {
                let _ = iterations.cut(&run.problem, &run.contact);
                return Err(error);
            }
            let own = events[kept - 1].time;
            let is_shortest = kept == 1 && time <= own;
            let at = (time, is_shortest);
            let mut until = Self::contradicted(run, &trial, tolerances, at_start.as_ref(), at);
            if until.is_none() {
                let of_window = (window, &trial, &events[..kept]);
                let passed = self.refine(run, iterations, tolerances, of_window, time)?;
                let Some((correction, settled)) = passed else {
                    iterations.cut(&run.problem, &run.contact)?;
                    return Ok(Outcome::TakenBack);
                };
                let events = (&correction.window, &settled.events[..]);
                let sound = at_start.as_ref().and_then(|at_start| {
                    at_start.sound_between(
                        run,
                        iterations,
                        tolerances,
                        events,
                        (&trial.contact, time),
                    )
                });
                let Some(sound) = sound else {
                    self.finish(run, trial, (correction.window, &settled, time), tolerances)?;
                    return Ok(Outcome::Done);
                };
                until = Some(sound - time);
            }
            iterations.cut(&run.problem, &run.contact)?;
            run.timings.taken_back += 1;
            let sooner = until.filter(|until| until.is_finite()).map_or(kept / 2, |until| {
                events.iter().take_while(|event| event.time <= time + until).count()
            });
            if run.may_leave() && sooner == 0 {
                return Ok(Outcome::Alone);
            }
            if kept > 1 {
                // The rates may not tell when the contradiction began: at least one event fewer, but the first one
                // stays.
                let fewer = sooner.clamp(1, kept - 1);
                (kept, time) = cut(events, horizon, fewer, tolerances);
            } else if !is_shortest {
                time = own;
            } else {
                let node = window.node(events[0].position);
                return Err(run.not_monotone("gap or pressure", node, 0.0));
            }
        }
    }

    /// The time, from the end of a window after `time` on, at which the first contradiction of the solution there
    /// began, as far as rates tell: not after 0; `None` if there is none. A window that cannot be shorter may be off by
    /// more.
    fn contradicted(
        run: &LoadingRun,
        trial: &Trial,
        tolerances: &WindowTolerances,
        at_start: Option<&AtStart>,
        (time, is_shortest): (f64, bool),
    ) -> Option<f64> {
        let approach = run.scalars.approach() + time;
        let (problem, contact, _) = trial.set(run);
        if let Some(at_start) = at_start {
            let tension = tolerances.overlap(approach) / problem.table().self_influence();
            if let Some(after) = at_start.sound_until(run, tension, (contact, approach), time) {
                return Some(BEFORE_RELEASE * after - time);
            }
        }
        let [least, most] = slacks(run, (problem, contact), tolerances, approach);
        let found = |slack| contradiction(run, trial.set(run), (approach, slack));
        if !run.has_yielded() && trial.yielded.is_empty() {
            // The second pass corrects the overlaps that are left between touches.
            return found(most);
        }
        let until = found(least)?;
        if is_shortest {
            found(most)?;
        }
        Some(until)
    }

    /// Corrects a window by the solution at its end, and settles the events in it; `None` if the end, or a solution in
    /// between, contradicts what was expected.
    fn refine(
        &mut self,
        run: &mut LoadingRun,
        iterations: &mut dyn Iterations,
        tolerances: &WindowTolerances,
        (window, trial, first): (&Window, &Trial, &[WindowEvent]),
        time: f64,
    ) -> Result<Option<(Correction, Settled)>, Error> {
        let start = run.scalars.approach();
        let ends = at_end(run, window, (trial, start + time));
        let correction = correction::correct(window, &ends, time);
        let settled = ties::second_pass(&correction, first, time);
        self.left_out = correction.left_out().max(REMEMBERED * self.left_out);
        let change = ties::mean_change(first, &settled.events, time);
        let most_change = MOST_CHANGE * time / first.len() as f64;
        // A window cannot be halved if half of its events tie with all others: what is found then counts.
        let half = first.len() / 2;
        let is_certain =
            first.len() <= CERTAIN || with_ties(first, half, tolerances) >= first.len();
        let is_poor = !is_certain
            && (change > most_change || first.len() > self.most_events().saturating_mul(2));
        let settled = match is_poor {
            true => None,
            false if self.settles => {
                let count = run.contact_nodes();
                let beginning = Beginning { approach: start, count, is_certain };
                let solve = |question: Question<'_>, nodes: &[usize]| {
                    values_before(run, iterations, (window, question, nodes), start)
                };
                ties::settle(&correction.window, tolerances, settled, beginning, solve)?
            }
            false => Some(settled),
        };
        if settled.is_none() {
            self.left_out = self.left_out.max(LEFT_OUT / half.max(1) as f64);
        }
        Ok(settled.map(|mut settled| {
            let times = settled.events.iter().map(|event| event.time);
            correction::widen(&mut settled.errors, times, (self.left_out, time));
            (correction, settled)
        }))
    }

    /// How many events a window may have. Their times are off by what matrices leave out of pivots, which grows with
    /// their number.
    fn most_events(&self) -> usize {
        ((LEFT_OUT / self.left_out) as usize).max(1)
    }

    /// Queues the states of a corrected window, at whose end the solution is.
    fn finish(
        &mut self,
        run: &mut LoadingRun,
        mut trial: Trial,
        (window, settled, time): (Window, &Settled, f64),
        tolerances: &WindowTolerances,
    ) -> Result<(), Error> {
        self.last_span = time;
        let joined = trial.joined(run);
        trial.reorder(run, &of_nodes(&window, &settled.events))?;
        let passed = Passed { start: run.scalars, before: Carried::of(run), span: time };
        let approach = passed.start.approach() + time;
        trial.adopt(run);
        self.joined = joined;
        run.scalars.place_at(approach);
        let start = self.rates;
        self.survey(run, tolerances)?;
        states::enqueue(run, (window, settled), passed, ([start, self.rates], tolerances))
    }
}

/// What nodes that have yielded displace.
fn beside(plastic: &Plastic) -> Beside<'_> {
    let surface = plastic.surface();
    let is_periodic = surface.boundary() == Boundary::Periodic;
    Beside {
        unit: plastic.unit(),
        load: plastic.load(),
        hardness: plastic.hardness().uniform(),
        row_sum: surface.row_sums().first().copied().filter(|_| is_periodic),
    }
}

/// Moves iterations to the state behind a trial at an approach, with a rate that serves over a span.
fn go_to(
    run: &mut LoadingRun,
    iterations: &mut dyn Iterations,
    trial: &Trial,
    (approach, span): (f64, f64),
) -> Result<(), Error> {
    let yielded = trial.pressures(run);
    let behind = trial.behind(&run.problem, &yielded, approach);
    run.field.advance(&behind, iterations, span)
}

/// How far the solution on a contact at an approach may be from what contact that grows does: in a window that can be
/// shorter, and in one that cannot. The gaps that it leaves in contact tell how far pressures are off. Gaps elsewhere
/// are off by less, for errors of pressures average out there.
fn slacks(
    run: &LoadingRun,
    (problem, contact): (&Problem, &ContactSequence),
    tolerances: &WindowTolerances,
    approach: f64,
) -> [Slack; 2] {
    let left = contact.order().iter().map(|&node| run.field.left_at(problem, node)[0].abs());
    let left = left.fold(0.0, f64::max);
    let of = |left: f64, gap: f64| {
        let pressure = OF_RESIDUAL * left.max(gap);
        let gap = gap.max(OF_RESIDUAL_BEYOND * left);
        Slack { gap, tension: pressure, excess: pressure, rate: SLACK_OF_RATE }
    };
    let solved = tolerances.tolerance * tolerances.length.max(approach);
    [of(left, solved), of(left, tolerances.overlap(approach))]
}

/// How fast the event of a node comes, relative to the approach: how fast its gap closes, or its pressure rises times
/// what a pressure displaces. `place` is where it is in the contact.
fn closing(run: &LoadingRun, node: usize, place: Option<usize>) -> f64 {
    match place {
        Some(place) => run.field.solution().rate[place] * run.problem.table().self_influence(),
        None => run.line(node).closing,
    }
}

/// Gaps of nodes out of contact and pressures of those in it, at a moment of a window that began at an approach.
pub(super) fn values_before(
    run: &mut LoadingRun,
    iterations: &mut dyn Iterations,
    (window, question, nodes): (&Window, Question<'_>, &[usize]),
    start: f64,
) -> Result<Vec<f64>, Error> {
    run.timings.ties += 1;
    let trial = Trial::of(run, &of_nodes(window, &question.events[..question.done]))?;
    let approach = start + question.time();
    let yielded = trial.pressures(run);
    let behind = trial.behind(&run.problem, &yielded, approach);
    let solved = iterations.probe(&behind, question.error)?;
    let (pressure, [displacement, _]) = (&solved.solution.pressure, &solved.displacement);
    UpdaterError::check_length("displacements", displacement.len(), run.problem.grid().nodes())?;
    UpdaterError::check_length("pressures", pressure.len(), trial.contact.len())?;
    if !displacement.iter().chain(pressure).copied().all(f64::is_finite) {
        return Err(run.not_finite());
    }
    let gap = trial.problem(&run.problem).initial_gap();
    let order = trial.contact.order();
    let value = |&node: &usize| match order.iter().position(|&other| other == node) {
        Some(place) => pressure[place],
        None => gap[node] + displacement[node] - approach,
    };
    Ok(nodes.iter().map(value).collect())
}

/// What has become of the watched nodes by the solution at the window's end: pressures, or overlaps of nodes that were
/// elastic; and gaps, or pressures of those.
fn at_end(run: &LoadingRun, window: &Window, (trial, approach): (&Trial, f64)) -> Vec<AtEnd> {
    let places = trial.contact.places();
    let solution = run.field.solution();
    let at = |(position, &node): (usize, &usize)| {
        let line = run.field.line(trial.problem(&run.problem), node, approach);
        let gap = [line.gap, -line.closing];
        let has_yielded = trial.yielded.contains(&node);
        match (window.is_elastic(position), places[node]) {
            (false, Some(place)) => {
                AtEnd { pressure: [solution.pressure[place], solution.rate[place]], gap: [0.0; 2] }
            }
            (false, None) if has_yielded => AtEnd { pressure: [run.hardness(node), 0.0], gap },
            (false, None) => AtEnd { pressure: [0.0; 2], gap },
            (true, Some(place)) => {
                AtEnd { pressure: [0.0; 2], gap: [solution.pressure[place], solution.rate[place]] }
            }
            (true, None) => {
                AtEnd { pressure: gap.map(|value| -value), gap: [run.hardness(node), 0.0] }
            }
        }
    };
    window.nodes().iter().enumerate().map(at).collect()
}

#[cfg(test)]
mod tests;
