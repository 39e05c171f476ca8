//! Events of both kinds in windows, without a factor: with a matrix that is nearly exact.
//!
//! As where nothing yields: the exact solution at a window's end corrects the matrix, the same events are played a second time, and
//! what is still closer than the remaining error is settled by a solution of its own.

mod pinned;
#[cfg(test)]
mod wrong_matrices;

use crate::Error;
use crate::contact::ContactSequence;
use crate::loading::contradiction::{Slack, contradiction};
use crate::loading::gap_field::GapLine;
use crate::loading::plastic::Plastic;
use crate::loading::ranking::{Ranking, survey};
use crate::loading::refined::candidates::{cut, with_ties};
use crate::loading::run::LoadingRun;
use crate::loading::scalars::Rates;
use crate::loading::state::ContactEvent;
use crate::loading::tolerances::WindowTolerances;
use crate::loading::trial::Trial;
use crate::loading::tuning::{
    CERTAIN, FEWEST, LEFT_OUT, MOST_CHANGE, MOST_TIES, OF_RESIDUAL, OF_RESIDUAL_BEYOND, PART,
    REMEMBERED, SLACK_OF_RATE, TOLERANCE, TRUSTED, WATCHED, WATCHED_UNSETTLED,
};
use crate::loading::walk::Carried;
use crate::loading::window::correction::{self, AtEnd};
use crate::loading::window::ties::{self, Beginning, Question, Settled};
use crate::loading::window::{Watched, Window, WindowEvent, of_overlap};
use crate::updater::{Beside, Iterations, Proposal, Schur, WindowFactor};
use crate::{Boundary, Problem, UpdaterError};
use pinned::Passed;

/// Finds events of both kinds in windows that are corrected at their end.
#[derive(Debug)]
pub(super) struct RefinedYielding {
    size: usize,
    /// Whether events that are too close to be told apart get a solution of their own.
    settles: bool,
    /// Nodes by the time of their next event if no other came first, at the present approach, and the rates there.
    ranking: Ranking,
    rates: Rates,
    /// The contact and approach that these belong to.
    ranked: Option<(u64, f64)>,
    /// How far the last window went, and the span that the rates at hand serve.
    last_span: f64,
    rate_span: f64,
    /// The part of a pivot that matrices were off by lately, at worst.
    left_out: f64,
    /// By how much pressures at hand may be off, in terms of what they displace.
    left: f64,
}

/// The nodes to watch.
struct Candidates {
    nodes: Vec<usize>,
    /// The time at which the next of the others would touch or yield.
    horizon: f64,
    /// Set if more nodes have their events at this time than can be watched.
    group: Option<f64>,
}

/// How a window ended.
enum Outcome {
    Done,
    /// Its end, or a solution in it, contradicted it: the next one has fewer events. Nothing has changed.
    TakenBack,
}

impl RefinedYielding {
    pub(super) fn new(size: Option<usize>, settles: bool) -> Self {
        let watched = if settles { WATCHED } else { WATCHED_UNSETTLED };
        Self {
            size: size.unwrap_or(watched).max(FEWEST),
            settles,
            ranking: Vec::new(),
            rates: Rates { unit_stiffness: 0.0, closing: 0.0, plastic: [0.0; 2] },
            ranked: None,
            last_span: 0.0,
            rate_span: 0.0,
            left_out: 0.0,
            left: 0.0,
        }
    }

    /// Computes a window of states, with no more than `most_nodes` in contact, which is more than there are; none if no node is left to
    /// touch or to yield.
    pub(super) fn produce(
        &mut self,
        run: &mut LoadingRun,
        iterations: &mut dyn Iterations,
        most_nodes: usize,
    ) -> Result<(), Error> {
        let Some(plastic) = run.plastic.clone() else {
            return Ok(());
        };
        let touches = most_nodes - run.contact.len() - plastic.count();
        loop {
            let tolerances = WindowTolerances::of(run, iterations.tolerance());
            self.begin(run, &plastic, iterations, &tolerances)?;
            if self.ranking.is_empty() {
                return Ok(());
            }
            let mut candidates = self.choose(run, &tolerances);
            self.improve_rates(run, &plastic, iterations, &tolerances, &mut candidates)?;
            if let Some(time) = candidates.group {
                return self.enter(run, &plastic, iterations, &tolerances, (time, &[]), touches);
            }
            let window = self.propose(run, &plastic, iterations, candidates)?;
            match self.follow(run, &plastic, iterations, &tolerances, &window, touches)? {
                Outcome::Done => return Ok(()),
                Outcome::TakenBack => run.timings.taken_back += 1,
            }
        }
    }

    /// Makes solution and ranking those of the present approach.
    fn begin(
        &mut self,
        run: &mut LoadingRun,
        plastic: &Plastic,
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
            self.survey(run, plastic, tolerances)?;
        }
        Ok(())
    }

    /// Takes all scalars from the solution at the present approach, and ranks the nodes.
    fn survey(
        &mut self,
        run: &mut LoadingRun,
        plastic: &Plastic,
        tolerances: &WindowTolerances,
    ) -> Result<(), Error> {
        let approach = run.scalars.approach();
        let [_, slack] = slacks(run, (&run.problem, &run.contact), tolerances, approach);
        self.ranked = None;
        self.left = slack.excess;
        self.rates = survey(run, plastic, &mut self.ranking, slack)?;
        self.ranked = Some((run.contact.revision(), approach));
        Ok(())
    }

    /// Time below which the event of a node may come before or after another one.
    fn tie_of(
        run: &LoadingRun,
        tolerances: &WindowTolerances,
        (node, place): (usize, Option<usize>),
    ) -> f64 {
        tolerances.tie_of(closing(run, node, place))
    }

    /// Chooses the nodes with the smallest times.
    fn choose(&mut self, run: &LoadingRun, tolerances: &WindowTolerances) -> Candidates {
        let order = |a: &(f64, usize), b: &(f64, usize)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        let places = run.contact.places();
        let wanted = self.most_events().min(run.contact.len() / PART);
        let size = self.size.min(wanted.max(FEWEST));
        let ranking = &mut self.ranking;
        let nodes = |chosen: &[(f64, usize)]| chosen.iter().map(|&(_, node)| node).collect();
        if ranking.len() <= size {
            return Candidates { nodes: nodes(ranking), horizon: f64::INFINITY, group: None };
        }
        let tie_of = |node: usize| Self::tie_of(run, tolerances, (node, places[node]));
        let (chosen, &mut next, others) = ranking.select_nth_unstable_by(size, order);
        let first = chosen.iter().map(|(time, _)| *time).fold(f64::INFINITY, f64::min);
        let limit = next.0 + tie_of(next.1);
        let mut candidates = Candidates {
            nodes: nodes(chosen),
            horizon: next.0,
            group: (next.0 <= first + tie_of(next.1)).then_some(first),
        };
        let tied = others.iter().filter(|(time, _)| *time <= limit);
        if tied.clone().count() < MOST_TIES * self.size {
            candidates.nodes.push(next.1);
            candidates.nodes.extend(tied.map(|&(_, node)| node));
            let rest = others.iter().map(|(time, _)| *time).filter(|time| *time > limit);
            candidates.horizon = rest.fold(f64::INFINITY, f64::min);
        }
        candidates
    }

    /// Solves for the rates once more if they have to serve much further than the last window did.
    fn improve_rates(
        &mut self,
        run: &mut LoadingRun,
        plastic: &Plastic,
        iterations: &mut dyn Iterations,
        tolerances: &WindowTolerances,
        candidates: &mut Candidates,
    ) -> Result<(), Error> {
        let furthest = if candidates.horizon < f64::INFINITY {
            candidates.horizon
        } else {
            self.ranking.iter().map(|(time, _)| *time).fold(0.0, f64::max)
        };
        if furthest > 0.0
            && tolerances.rate_tolerance(furthest) < 0.5 * tolerances.rate_tolerance(self.rate_span)
        {
            self.rate_span = furthest;
            run.advance_field(iterations, run.scalars.approach(), furthest)?;
            self.survey(run, plastic, tolerances)?;
            *candidates = self.choose(run, tolerances);
        }
        Ok(())
    }

    /// Opens a window on the candidates, with lines that are better known than those of the gap field.
    fn propose(
        &self,
        run: &mut LoadingRun,
        plastic: &Plastic,
        iterations: &mut dyn Iterations,
        candidates: Candidates,
    ) -> Result<Window, Error> {
        let (approach, count) = (run.scalars.approach(), run.contact.len());
        let (problem, contact) = (&run.problem, &run.contact);
        // One node at least joins.
        let grown = iterations.bytes(problem.grid().nodes(), count + 1);
        run.memory.check(grown.saturating_add(WindowFactor::bytes(1)), count)?;
        let mut nodes = candidates.nodes;
        nodes.sort_unstable_by_key(|&node| (contact.contains(node), node));
        let out = nodes.partition_point(|&node| !contact.contains(node));
        let (outside, inside) = nodes.split_at(out);
        let surface = plastic.surface();
        let is_periodic = surface.boundary() == Boundary::Periodic;
        let beside = Beside {
            unit: plastic.unit(),
            load: plastic.load(),
            hardness: plastic.hardness().uniform(),
            row_sum: surface.row_sums().first().copied().filter(|_| is_periodic),
        };
        let mut schur = Schur::default();
        let Proposal { lines, sums } =
            iterations.propose_both(problem, contact, [outside, inside], &beside, &mut schur)?;
        UpdaterError::check_length("watched displacements", lines.len(), nodes.len())?;
        UpdaterError::check_length("watched sums", sums.len(), nodes.len())?;
        let numbers = lines.as_flattened().iter().chain(sums.as_flattened());
        if !numbers.copied().all(f64::is_finite) {
            return Err(run.not_finite());
        }
        run.check_complement(&nodes, &schur)?;
        let gap = problem.initial_gap();
        let hardness = plastic.hardness().values();
        let watched = nodes.iter().zip(lines.iter().zip(&sums)).enumerate();
        let watched = watched.map(|(k, (&node, (&[value, rate], &of_gap)))| {
            let (is_elastic, hardness) = (k >= out, hardness[node]);
            let (line, sums) = if is_elastic {
                let line = GapLine { gap: value, closing: -rate };
                (line, of_overlap(of_gap, hardness))
            } else {
                (GapLine { gap: gap[node] + value - approach, closing: 1.0 - rate }, of_gap)
            };
            Watched { node, is_elastic, hardness, line, sums }
        });
        let watched: Vec<Watched> = watched.collect();
        let mut window = Window::default();
        let at = (approach, TRUSTED * candidates.horizon);
        *window.schur_mut() = schur;
        window.begin_both(at, &watched, count);
        run.timings.windows += 1;
        Ok(window)
    }

    /// Goes through a window, and queues its states.
    fn follow(
        &mut self,
        run: &mut LoadingRun,
        plastic: &Plastic,
        iterations: &mut dyn Iterations,
        tolerances: &WindowTolerances,
        window: &Window,
        touches: usize,
    ) -> Result<Outcome, Error> {
        let mut first = window.clone();
        let bad = first.play(usize::MAX);
        let events = first.events();
        if events.is_empty() {
            return Err(match bad {
                Some(bad) => run.not_positive_definite(bad),
                None => {
                    let node = window.nodes().iter().min().copied();
                    run.not_monotone("closing rate of the gap", node.unwrap_or_default(), 0.0)
                }
            });
        }
        let most = with_ties(events, self.most_events(), tolerances).min(within(events, touches));
        let (mut kept, mut time) = cut(events, window.horizon(), most, tolerances);
        let start = run.scalars.approach();
        let mut has_moved = false;
        let trial = loop {
            if time <= tolerances.tie {
                // All of them happen at once. Their courses are better known than those of the ranking.
                let node = |event: &WindowEvent| window.node(event.position);
                let known: Vec<usize> = events[..kept].iter().map(node).collect();
                if has_moved {
                    self.begin(run, plastic, iterations, tolerances)?;
                }
                self.enter(run, plastic, iterations, tolerances, (time, &known), touches)?;
                return Ok(Outcome::Done);
            }
            let trial = Trial::of(run, plastic, of_nodes(window, &events[..kept]))?;
            self.rate_span = time.max(self.last_span);
            let at = (start + time, self.rate_span);
            self.go_to(run, plastic, iterations, &trial, at)?;
            has_moved = true;
            let there = (&trial.problem, &trial.contact);
            let [least, most] = slacks(run, there, tolerances, start + time);
            let contradicted = |slack| contradiction(run, trial.set(), (start + time, slack));
            let Some(until) = contradicted(least) else {
                break trial;
            };
            let own = events[kept - 1].time;
            let is_shortest = kept == 1 && time <= own;
            if is_shortest && contradicted(most).is_none() {
                break trial;
            }
            iterations.cut(&run.problem, &run.contact)?;
            run.timings.taken_back += 1;
            if kept > 1 {
                // What joined or yielded without need says nothing of when that was.
                let fewer = if until.is_finite() {
                    events.iter().take_while(|event| event.time <= time + until).count()
                } else {
                    kept / 2
                };
                (kept, time) = cut(events, window.horizon(), fewer.clamp(1, kept - 1), tolerances);
            } else if !is_shortest {
                time = own;
            } else {
                let node = window.node(events[0].position);
                return Err(run.not_monotone("gap or pressure", node, 0.0));
            }
        };
        let events = &events[..kept];
        match self.refine(run, plastic, iterations, tolerances, (window, &trial), (events, time))? {
            Some((window, settled)) => {
                self.finish(run, plastic, trial, (window, &settled), time, tolerances)?;
                Ok(Outcome::Done)
            }
            None => {
                iterations.cut(&run.problem, &run.contact)?;
                Ok(Outcome::TakenBack)
            }
        }
    }

    /// Moves iterations to the state behind a window at an approach, with a rate that serves over a span.
    fn go_to(
        &self,
        run: &mut LoadingRun,
        plastic: &Plastic,
        iterations: &mut dyn Iterations,
        trial: &Trial,
        (approach, span): (f64, f64),
    ) -> Result<(), Error> {
        let yielded = trial.pressures(plastic);
        let behind = trial.behind(&yielded, approach);
        run.field.advance_behind(&behind, iterations, span)
    }

    /// Corrects a window by the solution at its end, and settles the events in it; `None` if the end, or a solution in between,
    /// contradicts what was expected.
    fn refine(
        &mut self,
        run: &mut LoadingRun,
        plastic: &Plastic,
        iterations: &mut dyn Iterations,
        tolerances: &WindowTolerances,
        (window, trial): (&Window, &Trial),
        (first, time): (&[WindowEvent], f64),
    ) -> Result<Option<(Window, Settled)>, Error> {
        let start = run.scalars.approach();
        let ends = at_end(run, plastic, window, (trial, start + time));
        let correction = correction::correct(window, &ends, time);
        let settled = ties::second_pass(&correction, (first, first), time);
        self.left_out = correction.left_out().max(REMEMBERED * self.left_out);
        let change = ties::mean_change(first, &settled.events, time);
        let most_change = MOST_CHANGE * time / first.len() as f64;
        let half = first.len() / 2;
        let is_certain =
            first.len() <= CERTAIN || with_ties(first, half, tolerances) >= first.len();
        let is_poor = !is_certain && (change > most_change || first.len() > 2 * self.most_events());
        let settled = match is_poor {
            true => None,
            false if self.settles => {
                let count = run.contact.len() + plastic.count();
                let beginning = Beginning { approach: start, count, is_certain };
                let solve = |question: Question<'_>, nodes: &[usize]| {
                    let done = of_nodes(window, &question.events[..question.done]);
                    let trial = Trial::of(run, plastic, done)?;
                    let at = (start + question.time(), question.error);
                    values_at(run, plastic, iterations, (&trial, nodes), at)
                };
                ties::settle(&correction.window, tolerances, settled, beginning, solve)?
            }
            false => Some(settled),
        };
        if settled.is_none() {
            self.left_out = self.left_out.max(LEFT_OUT / half.max(1) as f64);
        }
        Ok(settled.map(|settled| (correction.window, settled)))
    }

    /// How many events a window may have: see the same of windows in which nothing yields.
    fn most_events(&self) -> usize {
        ((LEFT_OUT / self.left_out) as usize).max(1)
    }

    /// Queues the states of a corrected window, at whose end the solution is.
    fn finish(
        &mut self,
        run: &mut LoadingRun,
        plastic: &Plastic,
        mut trial: Trial,
        (mut window, settled): (Window, &Settled),
        time: f64,
        tolerances: &WindowTolerances,
    ) -> Result<(), Error> {
        self.last_span = time;
        for event in &settled.events {
            let happened = window.happen(event.position, event.time);
            happened.map_err(|bad| run.not_positive_definite(bad))?;
        }
        let played: Vec<(usize, ContactEvent)> = of_nodes(&window, &settled.events).collect();
        trial.reorder(run, &played)?;
        let before = Carried::of(run);
        let passed = Passed { start: run.scalars, before, span: time };
        let approach = passed.start.approach() + time;
        let plastic = trial.adopt(run, plastic);
        run.scalars.place_at(approach);
        let start = self.rates;
        self.survey(run, &plastic, tolerances)?;
        let rates = [start, self.rates];
        pinned::enqueue(run, &plastic, (&window, settled), passed, (rates, tolerances))
    }

    /// Lets all nodes whose event is at a time touch or yield, and those that are known to, in the order of their indices, up to so many
    /// `touches`. Between them rates change in equal steps.
    fn enter(
        &mut self,
        run: &mut LoadingRun,
        plastic: &Plastic,
        iterations: &mut dyn Iterations,
        tolerances: &WindowTolerances,
        (time, known): (f64, &[usize]),
        touches: usize,
    ) -> Result<(), Error> {
        let places = run.contact.places();
        let tie_of = |node: usize| Self::tie_of(run, tolerances, (node, places[node]));
        let together =
            |&&(other, node): &&(f64, usize)| other <= time + tie_of(node) || known.contains(&node);
        let group = self.ranking.iter().filter(together);
        let mut group: Vec<usize> = group.map(|&(_, node)| node).collect();
        // What their times cannot be told apart by, and what the solution at hand leaves open of them.
        let error = group.iter().map(|&node| tie_of(node)).fold(tolerances.tie, f64::max);
        let open = group.iter().map(|&node| self.left / closing(run, node, places[node]));
        let most_late = open.fold(error, f64::max);
        group.sort_unstable();
        let kind = |node: usize| match run.contact.contains(node) {
            true => ContactEvent::Yield,
            false => ContactEvent::Touch,
        };
        let mut touched = 0;
        let within = |&(_, kind): &(usize, ContactEvent)| {
            let goes_on = touched < touches;
            touched += usize::from(kind == ContactEvent::Touch);
            goes_on
        };
        let events: Vec<(usize, ContactEvent)> =
            group.into_iter().map(|node| (node, kind(node))).take_while(within).collect();
        let approach = run.scalars.approach() + time;
        let trial = Trial::of(run, plastic, events.iter().copied())?;
        // However little is left open by so many nodes: rates must be exact.
        self.rate_span = f64::INFINITY;
        self.go_to(run, plastic, iterations, &trial, (approach, self.rate_span))?;
        // The first of their times is the earliest of so many estimates. Behind the events gaps and depths may change far faster than
        // what these were estimated from, so that depths that are negative then tell the time better: all of them are lines.
        let [_, most] = slacks(run, (&trial.problem, &trial.contact), tolerances, approach);
        let late = lateness(run, plastic, &trial, (approach, most));
        let late = if late <= most_late { late } else { 0.0 };
        let (time, approach, error) = (time + late, approach + late, error.max(late));
        if late > 0.0 {
            let at = [approach, self.rate_span];
            run.field.advance(&trial.problem, &trial.contact, iterations, at)?;
        }
        if let Some((node, pressure)) = pulled(run, &trial, tolerances, approach) {
            iterations.cut(&run.problem, &run.contact)?;
            return Err(run.not_monotone("pressure", node, pressure));
        }
        self.last_span = self.last_span.max(time);
        let before = Carried::of(run);
        let passed = Passed { start: run.scalars, before, span: time };
        let rates = self.rates;
        let plastic = trial.adopt(run, plastic);
        run.scalars.place_at(approach);
        self.survey(run, &plastic, tolerances)?;
        pinned::enqueue_together(run, &plastic, &events, passed, ([rates, self.rates], error))
    }
}

/// By how much the solution on a contact at an approach may contradict what contact that grows does: where the window can be shorter,
/// and at all. What is left of gaps in contact says how far pressures are off, and gaps elsewhere: by less, for they see all of it
/// from afar.
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

/// The first node in contact that is pulled at an approach by more than a solution may leave, and its pressure.
fn pulled(
    run: &LoadingRun,
    trial: &Trial,
    tolerances: &WindowTolerances,
    approach: f64,
) -> Option<(usize, f64)> {
    let Trial { contact, problem, .. } = trial;
    let [_, slack] = slacks(run, (problem, contact), tolerances, approach);
    // Rounding of heights pulls at nodes that touch together.
    let rounding = TOLERANCE * (problem.greatest_gap() + approach);
    let tension = slack.tension.max(rounding) / problem.table().self_influence();
    run.field.pressures(contact, approach).find(|(_, pressure)| *pressure < -tension)
}

/// How much later than an approach the last plastic depth, or pressure in contact, ceases to be negative, of those that are beyond what
/// a solution may be off by.
fn lateness(
    run: &LoadingRun,
    plastic: &Plastic,
    trial: &Trial,
    (approach, slack): (f64, Slack),
) -> f64 {
    let Trial { contact, problem, .. } = trial;
    let mut has_yielded = vec![false; problem.grid().nodes()];
    trial.yielded.iter().for_each(|&node| has_yielded[node] = true);
    let depths = run.field.lines(problem, contact, approach).filter_map(|(node, line)| {
        let is_short = line.gap > slack.gap && (has_yielded[node] || plastic.has_yielded(node));
        (is_short && line.closing > 0.0).then(|| line.gap / line.closing)
    });
    let tension = slack.tension / problem.table().self_influence();
    let pressures = run.field.pressures(contact, approach).zip(&run.field.solution().rate);
    let pressures = pressures
        .filter(|&((_, pressure), &rate)| pressure < -tension && rate > 0.0)
        .map(|((_, pressure), &rate)| -pressure / rate);
    depths.chain(pressures).fold(0.0, f64::max)
}

/// How many of some events it takes until so many `touches` nodes have touched; all, if these are fewer.
fn within(events: &[WindowEvent], touches: usize) -> usize {
    let touching = |(_, event): &(usize, &WindowEvent)| event.kind == ContactEvent::Touch;
    let last = events.iter().enumerate().filter(touching).nth(touches.saturating_sub(1));
    last.map_or(events.len(), |(place, _)| place + 1)
}

/// How fast the event of a node comes, relative to the approach: how fast its gap closes, or its pressure rises times what a pressure
/// displaces.
fn closing(run: &LoadingRun, node: usize, place: Option<usize>) -> f64 {
    match place {
        Some(place) => run.field.solution().rate[place] * run.problem.table().self_influence(),
        None => run.line(node).closing,
    }
}

/// The nodes of events, and what happens to them.
fn of_nodes<'a>(
    window: &'a Window,
    events: &'a [WindowEvent],
) -> impl Iterator<Item = (usize, ContactEvent)> + 'a {
    events.iter().map(|event| (window.node(event.position), event.kind))
}

/// Gaps of nodes out of contact and pressures of those in it, behind a trial at an approach, to an error.
fn values_at(
    run: &mut LoadingRun,
    plastic: &Plastic,
    iterations: &mut dyn Iterations,
    (trial, nodes): (&Trial, &[usize]),
    (approach, error): (f64, f64),
) -> Result<Vec<f64>, Error> {
    run.timings.ties += 1;
    let yielded = trial.pressures(plastic);
    let solved = iterations.probe_behind(&trial.behind(&yielded, approach), error)?;
    let (pressure, [displacement, _]) = (&solved.solution.pressure, &solved.displacement);
    UpdaterError::check_length("displacements", displacement.len(), run.problem.grid().nodes())?;
    UpdaterError::check_length("pressures", pressure.len(), trial.contact.len())?;
    if !displacement.iter().chain(pressure).copied().all(f64::is_finite) {
        return Err(run.not_finite());
    }
    let gap = trial.problem.initial_gap();
    let value = |&node: &usize| match trial.contact.order().iter().position(|&other| other == node)
    {
        Some(place) => pressure[place],
        None => gap[node] + displacement[node] - approach,
    };
    Ok(nodes.iter().map(value).collect())
}

/// What has become of the watched nodes by the solution at the window's end: pressures, or overlaps of nodes that were elastic; and
/// gaps, or pressures of those.
fn at_end(
    run: &LoadingRun,
    plastic: &Plastic,
    window: &Window,
    (trial, approach): (&Trial, f64),
) -> Vec<AtEnd> {
    let places = trial.contact.places();
    let solution = run.field.solution();
    let hardness = plastic.hardness().values();
    let at = |(position, &node): (usize, &usize)| {
        let line = run.field.line(&trial.problem, node, approach);
        let gap = [line.gap, -line.closing];
        let has_yielded = trial.yielded.contains(&node);
        match (window.is_elastic(position), places[node]) {
            (false, Some(place)) => {
                AtEnd { pressure: [solution.pressure[place], solution.rate[place]], gap: [0.0; 2] }
            }
            (false, None) if has_yielded => AtEnd { pressure: [hardness[node], 0.0], gap },
            (false, None) => AtEnd { pressure: [0.0; 2], gap },
            (true, Some(place)) => {
                AtEnd { pressure: [0.0; 2], gap: [solution.pressure[place], solution.rate[place]] }
            }
            (true, None) => AtEnd { pressure: gap.map(|value| -value), gap: [hardness[node], 0.0] },
        }
    };
    window.nodes().iter().enumerate().map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Touches and yields that alternate: what comes up to a number of touches.
    #[test]
    fn a_path_ends_with_its_last_touch() {
        use ContactEvent::{Touch, Yield};
        let event = |kind| WindowEvent { position: 0, time: 1.0, kind, closing: 1.0 };
        let events = [Touch, Yield, Yield, Touch, Yield].map(event);
        let found = [1, 2, 3, 9].map(|touches| within(&events, touches));
        assert_eq!(found, [1, 4, 5, 5]);
        assert_eq!(within(&events[1..3], 1), 2);
    }
}
