//! Events in windows with a factor: nodes that touch, with a hardness elastic nodes that yield as well, and where nodes
//! may leave the touches before one does.

mod leaving;

use super::contradiction::{Slack, contradiction};
use super::cost::{WITH_FACTOR, automatic_window, watched_for};
use super::factor_log::FactorLog;
use super::plastic::Plastic;
use super::ranking::{Ranking, rank, rank_yields, survey};
use super::run::LoadingRun;
use super::scalars::Rates;
use super::state::ContactEvent;
use super::tolerances::ties_until;
use super::trial::{Trial, of_nodes};
use super::tuning::{
    AS_MANY_AGAIN, FEWEST_BETWEEN_RELEASES, LEAST_RATE, MULTIPLE, OF_RESIDUAL, RECOGNISED, SQUARE,
    TOLERANCE,
};
use super::walk::{Carried, Walk};
use super::window::{Watched, Window};
use crate::clock::Stopwatch;
use crate::contact::ContactSequence;
use crate::updater::{Left, LinearUpdater, SUMS, Solution, join_all};
use crate::{ContactGrowth, Error, Problem, UpdaterError};
use leaving::AtStart;

/// Finds events in windows: what may happen before the *horizon*, the time of the next event of any node that is not
/// watched.
///
/// Where contact only grows and nobody yields, that time is a lower bound if the kernel is convex. Otherwise a window
/// is solved at its end and checked there: gaps only close and pressures only grow, so that what is right at the end
/// was right throughout. Where the end contradicts events, fewer are played. Nodes that yield leave the factor, which
/// cannot be undone: a window with such events is solved with the factor as it was. Where nodes may leave, a window is
/// checked in between as well, and [ends before](leaving) one does.
#[derive(Debug)]
pub(super) struct Exact {
    growth: ContactGrowth,
    /// How many nodes to watch, if the user says so.
    size: Option<usize>,
    window: Window,
    /// The nodes that may touch or yield, by the time at which they would.
    ranking: Ranking,
    /// Whether the present solution is one of the factor before the last nodes yielded.
    is_behind: bool,
}

/// What is known when a window begins.
struct Survey {
    /// When the first node would touch or yield.
    first: f64,
    /// When the first node that is not ranked would yield: after all ranked nodes out of contact have touched.
    beyond: f64,
    rates: Rates,
}

impl Exact {
    pub(super) fn new(growth: ContactGrowth, size: Option<usize>) -> Self {
        Self { growth, size, window: Window::default(), ranking: Ranking::new(), is_behind: false }
    }

    /// Computes a window of states with at most `most_nodes` in contact, which must be more than there are; none if
    /// nothing can happen to any node. Returns what went wrong after them. The log has all windows so far.
    pub(super) fn produce(
        &mut self,
        run: &mut LoadingRun,
        (updater, log): (&mut dyn LinearUpdater, &mut FactorLog),
        most_nodes: usize,
    ) -> Result<Option<Error>, Error> {
        if run.waiting().is_none() {
            return Ok(None);
        }
        let (touches, approach) = (most_nodes - run.contact_nodes(), run.scalars.approach());
        let size = run.affordable(updater, self.next_size(run, log, touches))?;
        if self.is_behind && !run.is_closed_to_rounding() {
            // What a solution behind yields leaves open would grow from window to window.
            run.field.forget();
            self.is_behind = false;
        }
        run.renew_field(updater, approach)?;
        let Survey { first, beyond, rates } = self.survey(run)?;
        if self.ranking.is_empty() {
            return Err(self.growth_stopped(run));
        }
        let start = Stopwatch::start();
        let closing = self.ranking.iter().filter(|(time, _)| time.is_finite());
        let size = size.min(if run.may_leave() { closing.count() } else { self.ranking.len() });
        let (size, horizon) = self.choose(size, self.multiple(), [approach, first]);
        run.timings.choice += start.elapsed();
        let before = Carried::of(run);
        self.watch(run, updater, size, horizon.min(beyond))?;

        let start = Stopwatch::start();
        let bad_pivot = self.window.play_touches(touches);
        run.timings.events += start.elapsed();
        let mut failure = bad_pivot.map(|bad| run.not_positive_definite(bad));
        let played = self.window.events().len();
        if played == 0 {
            return Err(failure.unwrap_or_else(|| self.growth_stopped(run)));
        }
        let at_start = self.before_release(run, updater, size)?;
        self.follow(run, updater, log, at_start.as_ref())?;
        if self.window.events().len() < played {
            failure = None;
        }
        let start = Stopwatch::start();
        let queued = self.enqueue(run, before, rates);
        run.timings.events += start.elapsed();
        if !self.window.is_of_touches() {
            // The updater keeps nothing of what was watched.
            self.window = Window::default();
        }
        Ok(queued.err().or(failure))
    }

    /// Gives back what windows take: the factor has been given up.
    pub(super) fn give_up(&mut self) {
        self.window = Window::default();
        self.ranking = Ranking::new();
    }

    /// The present solution where it comes from the factor before the last yields: the factor would find it with other
    /// rounding.
    pub(super) fn solution(&self, run: &LoadingRun) -> Option<Solution> {
        self.is_behind.then(|| run.field.solution().clone())
    }

    /// Goes on behind these windows, from a solution of the factor before the last yields, if there is one. The nodes
    /// of the last window that did not join are watched in the same order.
    pub(super) fn follow_on(&mut self, log: &FactorLog, is_behind: bool) {
        self.window = Window::ended_with(log.untouched());
        self.is_behind = is_behind;
    }

    /// Where nodes may leave: computes a window of states up to the next release, whose first event is a touch. Returns
    /// false, and nothing has happened, with windows of one node and if the updater does not say what nodes that touch
    /// take off the contact.
    pub(super) fn produce_before_release(
        &mut self,
        run: &mut LoadingRun,
        (updater, log): (&mut dyn LinearUpdater, &mut FactorLog),
        most_nodes: usize,
    ) -> Result<bool, Error> {
        if self.size == Some(1) || updater.relief(&run.problem, &run.contact, &[])?.is_none() {
            self.window = Window::default();
            return Ok(false);
        }
        // What went wrong behind these states comes again with the next event.
        self.produce(run, (updater, log), most_nodes)?;
        Ok(true)
    }

    /// Where nodes may leave: takes back the events of the window behind the first that does. Returns what the window
    /// began with, with `size` nodes watched.
    fn before_release(
        &mut self,
        run: &mut LoadingRun,
        updater: &mut dyn LinearUpdater,
        size: usize,
    ) -> Result<Option<AtStart>, Error> {
        if !run.may_leave() {
            return Ok(None);
        }
        let closing = self.window.events().iter().take_while(|event| event.closing > LEAST_RATE);
        let stand = closing.count().max(1);
        self.take_back(run, stand);
        if stand == 1 {
            return Ok(None);
        }
        let touched: Vec<usize> = self.window.touched().collect();
        let relief = updater.relief(&run.problem, &run.contact, &touched)?.unwrap_or_default();
        UpdaterError::check_length("the relief", relief.nrows(), run.contact.len())?;
        UpdaterError::check_length("the relief", relief.ncols(), touched.len())?;
        if !relief.iter().copied().all(f64::is_finite) {
            return Err(run.not_finite());
        }
        let unwatched = self.ranking[size..].iter().map(|&(_, node)| node);
        let at_start = AtStart::of(run, &self.window, relief, unwatched)?;
        let tension = TOLERANCE * run.greatest_pressure(run.scalars.approach() + self.end());
        let stand = at_start.before_release(&*self.window.touched_factor()?, tension);
        self.take_back(run, stand);
        Ok(Some(at_start))
    }

    /// Takes back all but the first events of the window, of which none has joined.
    fn take_back(&mut self, run: &mut LoadingRun, stand: usize) {
        run.timings.taken_back += self.window.events().len() - stand;
        self.window.take_back(stand);
    }

    /// How many nodes to watch.
    fn next_size(&self, run: &LoadingRun, log: &FactorLog, touches: usize) -> usize {
        let (count, nodes) = (run.contact.len(), run.problem.grid().nodes());
        let may_yield = run.may_yield();
        let size = self.size.unwrap_or_else(|| {
            let wanted = watched_for(touches);
            let wanted = if may_yield { wanted.saturating_mul(2) } else { wanted };
            let size = automatic_window(count, nodes, WITH_FACTOR).min(wanted);
            // Where nodes leave often, few of those watched touch before the next one does.
            let likely =
                FEWEST_BETWEEN_RELEASES.max(AS_MANY_AGAIN.saturating_mul(log.last_stayed()));
            if run.may_leave() { size.min(likely) } else { size }
        });
        size.min(if may_yield { nodes } else { nodes - run.contact_nodes() })
    }

    /// Checks that contact grows, and ranks what may happen next.
    fn survey(&mut self, run: &mut LoadingRun) -> Result<Survey, Error> {
        if let Some(plastic) = run.plastic.clone().filter(|plastic| plastic.count() > 0) {
            let tolerance = TOLERANCE * (run.problem.grid().cell_aspect() / SQUARE).max(1.0);
            let length = run.problem.greatest_gap() + run.scalars.approach();
            let gap = (tolerance * length).max(run.inherited_slack());
            let slack = Slack { gap, tension: gap, excess: gap, rate: TOLERANCE };
            let rates = survey(run, &plastic, &mut self.ranking, slack)?;
            let times = self.ranking.iter().map(|&(time, _)| time);
            let first = times.fold(f64::INFINITY, f64::min);
            return Ok(Survey { first, beyond: f64::INFINITY, rates });
        }
        let touches = rank(run, &mut self.ranking)?;
        let [yields, beyond] = rank_yields(run, &mut self.ranking);
        let first = touches.min(yields);
        Ok(Survey { first, beyond, rates: run.scalars.rates() })
    }

    /// Nodes that were not watched before come in multiples of this.
    fn multiple(&self) -> usize {
        if self.size.is_some() { 1 } else { MULTIPLE }
    }

    /// Moves the nodes to watch to the front of the ranking, those watched before first; returns their number, `size`
    /// or a little less, and the horizon: until then none of the others ties with one that is watched. The first node
    /// touches at `first` after an approach.
    fn choose(
        &mut self,
        mut size: usize,
        multiple: usize,
        [approach, first]: [f64; 2],
    ) -> (usize, f64) {
        // If more nodes touch at once than can be watched, those of the lowest indices are.
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
            // The others have higher indices. Those that are watched touch at `first`, to rounding.
            horizon = ties_until(approach + first) - approach;
        }
        (size, horizon)
    }

    /// Opens the window on the first `size` nodes of the ranking.
    fn watch(
        &mut self,
        run: &mut LoadingRun,
        updater: &mut dyn LinearUpdater,
        size: usize,
        horizon: f64,
    ) -> Result<(), Error> {
        let (approach, order) = (run.scalars.approach(), run.contact.order());
        let chosen = self.ranking[..size].iter().map(|&(_, node)| node);
        let (inside, outside): (Vec<_>, Vec<_>) = chosen.partition(|&n| run.contact.contains(n));
        let mut positions = Vec::with_capacity(inside.len());
        if !inside.is_empty() {
            let places = run.contact.places();
            positions.extend(inside.iter().filter_map(|&node| places[node]));
            positions.sort_unstable();
        }
        let schur = self.window.schur_mut();
        if positions.is_empty() {
            updater.watch(&run.problem, &run.contact, &outside, schur)?;
        } else {
            updater.watch_both(&run.problem, &run.contact, &outside, &positions, schur)?;
        }
        let inside = positions.iter().map(|&position| order[position]);
        let nodes: Vec<usize> = outside.iter().copied().chain(inside).collect();
        run.check_complement(&nodes, schur)?;
        let plastic = run.plastic.as_deref();
        let has_yielded = plastic.is_some_and(|plastic| plastic.count() > 0);
        let sums = match plastic {
            Some(plastic) if has_yielded || !positions.is_empty() => {
                plastic_sums(run, plastic, updater, (&outside, &positions))?
            }
            _ => schur.row_sums().iter().map(|&sum| [sum, 0.0, 0.0]).collect(),
        };
        let (sums_outside, sums_inside) = sums.split_at(outside.len());
        let apart = outside.iter().zip(sums_outside);
        let apart = apart
            .map(|(&node, &sums)| Watched::apart((node, run.hardness(node)), run.line(node), sums));
        let Solution { pressure, rate } = run.field.solution();
        let pressed = positions.iter().zip(sums_inside).map(|(&place, &of_gap)| {
            let node = order[place];
            let pressure = [pressure[place], rate[place]];
            Watched::pressed((node, run.hardness(node)), pressure, of_gap)
        });
        let mut watched: Vec<Watched> = apart.chain(pressed).collect();
        if positions.is_empty() && !has_yielded {
            Watched::leave_out_pressures(&mut watched, schur, horizon);
        }
        self.window.begin_both((approach, horizon), &watched, order.len());
        run.timings.windows += 1;
        Ok(())
    }

    /// Lets path and updater follow to the end of the window, after taking back its last events as long as that
    /// contradicts them. The first event follows from a solution, and needs no check.
    fn follow(
        &mut self,
        run: &mut LoadingRun,
        updater: &mut dyn LinearUpdater,
        log: &mut FactorLog,
        at_start: Option<&AtStart>,
    ) -> Result<(), Error> {
        // The time of the first contradiction is an estimate. If it keeps being too late, twice as many events are
        // dropped each time, so that the search is short.
        let mut fewest = 1;
        while !self.window.is_of_touches() {
            let (trial, until) = self.try_end(run, updater)?;
            let stand = self.before(until, &mut fewest);
            if stand == self.window.events().len() {
                return self.commit(run, updater, log, trial);
            }
            self.take_back(run, stand);
        }
        let count = run.contact.len();
        run.join(updater, &self.window)?;
        let joined = self.window.events().iter().map(|event| event.position);
        let joined: Vec<usize> = joined.collect();
        let may_fail = self.growth != ContactGrowth::Convex || run.plastic.is_some();
        while may_fail && self.window.events().len() > 1 {
            // The next window needs the same solution and the same displacements, and finds them.
            let end = run.scalars.approach() + self.end();
            run.renew_field(updater, end)?;
            let there = (&run.problem, &run.contact, &[][..]);
            let until = contradiction(run, there, (end, slack_at(run, there, end)));
            let stand = self.before(until, &mut fewest);
            if stand == self.window.events().len() {
                break;
            }
            self.truncate(run, stand);
            run.cut(updater, count + stand)?;
        }
        if let Some(at_start) = at_start.filter(|_| self.window.events().len() > 1) {
            let end = run.scalars.approach() + self.end();
            run.renew_field(updater, end)?;
            let overlap = TOLERANCE * (run.problem.greatest_gap() + end);
            let events = self.window.events().len();
            let stand = at_start.before_others(run, (&self.window, events), overlap);
            if stand < events {
                self.truncate(run, stand);
                run.cut(updater, count + stand)?;
            }
        }
        if let Some(error) = self.pulled(run, updater)? {
            run.cut(updater, count)?;
            return Err(error);
        }
        log.push(self.window.nodes(), joined.into_iter(), self.window.events().len());
        self.is_behind = false;
        Ok(())
    }

    /// Keeps the first events of the window only.
    fn truncate(&mut self, run: &mut LoadingRun, stand: usize) {
        run.timings.taken_back += self.window.events().len() - stand;
        self.window.truncate(stand);
    }

    /// The time of the last event.
    fn end(&self) -> f64 {
        self.window.events().last().map_or(0.0, |event| event.time)
    }

    /// How many events stand where the first contradiction began at `until` from the end of the window on: those up to
    /// there, without the last `fewest` at least.
    fn before(&self, until: Option<f64>, fewest: &mut usize) -> usize {
        let events = self.window.events();
        let Some(until) = until.filter(|_| events.len() > 1) else {
            return events.len();
        };
        let until = self.end() + until;
        let later = events.iter().rev().take_while(|event| event.time > until).count();
        let dropped = later.max(*fewest).min(events.len() - 1);
        *fewest *= 2;
        events.len() - dropped
    }

    /// Solves at the end of the window, with the contact as the updater has it, and computes all gaps there. Returns
    /// the trial, and when the first contradiction began, from the end on, as far as rates tell.
    fn try_end(
        &mut self,
        run: &mut LoadingRun,
        updater: &mut dyn LinearUpdater,
    ) -> Result<(Trial, Option<f64>), Error> {
        let end = self.end();
        let approach = run.scalars.approach() + end;
        let order = run.contact.order();
        let nodes = run.problem.grid().nodes();
        let table = run.problem.table();
        // Pressures and rates of nodes that touched, gaps and their rates of nodes that yielded.
        let mut pressed: Vec<(usize, [f64; 2])> = Vec::new();
        let mut values = vec![[0.0; 2]; nodes];
        for (event, answer) in self.window.events().iter().zip(self.window.answers(usize::MAX, end))
        {
            let node = self.window.node(event.position);
            if event.kind == ContactEvent::Touch {
                let yields = self.window.events().iter().any(|other| {
                    (other.position, other.kind) == (event.position, ContactEvent::Yield)
                });
                pressed.push((node, if yields { [run.hardness(node), 0.0] } else { answer }));
            } else if run.contact.contains(node) {
                values[node] = answer.map(|overlap| -overlap);
            }
        }
        let pressed_places: Vec<usize> =
            pressed.iter().map(|&(node, _)| table.place(node)).collect();
        let mut coefficients = vec![0.0; pressed.len()];
        let gaps = run.problem.initial_gap();
        let mut solved: Vec<[f64; 2]> = order
            .iter()
            .map(|&node| {
                let [gap, rate] = values[node];
                let mut rhs = [approach - gaps[node] + gap, 1.0 + rate];
                table.fill_column(table.place(node), &pressed_places, &mut coefficients);
                for ((_, [pressure, rate]), coefficient) in pressed.iter().zip(&coefficients) {
                    rhs[0] -= coefficient * pressure;
                    rhs[1] -= coefficient * rate;
                }
                rhs
            })
            .collect();
        updater.solve_for(&run.problem, &run.contact, &mut solved)?;
        for (&node, solved) in order.iter().zip(&solved) {
            values[node] = *solved;
        }
        for (node, value) in pressed {
            values[node] = value;
        }
        let trial = Trial::of(run, &of_nodes(&self.window, self.window.events()))?;
        let after = trial.contact.order();
        let solution = Solution {
            pressure: after.iter().map(|&node| values[node][0]).collect(),
            rate: after.iter().map(|&node| values[node][1]).collect(),
        };
        run.field.place(&trial.contact, solution, approach)?;
        run.timings.convolution = run.field.time();
        run.check_closed(trial.problem(&run.problem), &trial.contact, approach)?;
        let slack = slack_at(run, trial.set(run), approach);
        let until = contradiction(run, trial.set(run), (approach, slack));
        Ok((trial, until))
    }

    /// Lets path and updater follow to the end of a window in which nodes have yielded.
    fn commit(
        &mut self,
        run: &mut LoadingRun,
        updater: &mut dyn LinearUpdater,
        log: &mut FactorLog,
        trial: Trial,
    ) -> Result<(), Error> {
        let step = run.steps();
        let (problem, contact) = (trial.problem(&run.problem), &trial.contact);
        // If the updater fails or panics half-way, the fields of the states so far must not be read from it.
        let known = run.releases.forget(step);
        let before = run.contact.order();
        let has_left = |&(_, &node): &(usize, &usize)| !contact.contains(node);
        let left = before.iter().enumerate().filter(has_left);
        let left: Vec<Left> = left.map(|(position, &node)| Left { node, position }).collect();
        let (kept, joined): (Vec<_>, Vec<_>) =
            contact.order().iter().partition(|&&node| run.contact.contains(node));
        let kept = ContactSequence::with_order(problem.grid(), kept);
        let followed = kept.and_then(|mut kept| {
            updater.release(problem, &kept, &left)?;
            join_all(updater, problem, &mut kept, &joined, run.memory.left())
        });
        followed.map_err(|error| run.memory.in_all(error))?;
        run.releases.remember(known);
        let places = left.iter().map(|left| left.position);
        log.push_yielded(trial.yielded.len(), places, &joined);
        self.is_behind = true;
        trial.adopt(run);
        Ok(())
    }

    /// The error of a window whose end pulls at a node: contact does not grow as the kernel promises. The next window
    /// needs the same solution.
    fn pulled(
        &self,
        run: &mut LoadingRun,
        updater: &mut dyn LinearUpdater,
    ) -> Result<Option<Error>, Error> {
        let end = run.scalars.approach() + self.end();
        run.renew_field(updater, end)?;
        let rounding = TOLERANCE * (run.problem.greatest_gap() + end);
        let most = RECOGNISED * run.greatest_pressure(end)
            + rounding / run.problem.table().self_influence();
        let mut pressures = run.field.pressures(&run.contact, end);
        let pulled = pressures.find(|(_, pressure)| *pressure < -most);
        Ok(pulled.map(|(node, pressure)| run.not_monotone("pressure", node, pressure)))
    }

    /// Turns the events of the window, which began with these nodes in contact and these rates, into states.
    fn enqueue(&self, run: &mut LoadingRun, before: Carried, rates: Rates) -> Result<(), Error> {
        let start = run.scalars.approach();
        let only_touches = before.nodes[1] == 0 && self.window.is_of_touches();
        let plastic = run.plastic.clone();
        let mut walk = Walk::new(plastic.as_deref(), before);
        let behind = self.window.increments().zip(self.window.rates(rates));
        for (event, (increments, rates)) in self.window.events().iter().zip(behind) {
            let node = self.window.node(event.position);
            run.scalars.advance(start + event.time);
            let bounds = walk.pass(node, event.kind);
            if only_touches {
                run.scalars.touch(increments, walk.contact_nodes());
            } else {
                run.scalars.clamp_load(bounds);
            }
            run.scalars.clamp_mean_gap();
            if !only_touches {
                walk.take(&mut run.scalars, rates);
            }
            run.enqueue(walk.step, event.kind, node, walk.contact_nodes())?;
        }
        Ok(())
    }

    /// The path cannot go on although nodes are left: none of their gaps closes.
    pub(super) fn growth_stopped(&self, run: &LoadingRun) -> Error {
        let node = self.ranking.iter().map(|&(_, node)| node).min();
        run.not_monotone("closing rate of the gap", node.unwrap_or_default(), 0.0)
    }
}

/// How far a solution on a contact at an approach may be from what contact that grows does: by rounding.
fn slack_at(
    run: &LoadingRun,
    (problem, contact, _): (&Problem, &ContactSequence, &[usize]),
    approach: f64,
) -> Slack {
    let left = contact.order().iter().map(|&node| run.field.left_at(problem, node)[0].abs());
    let least = f64::EPSILON * (problem.greatest_gap() + approach);
    let gap = OF_RESIDUAL * left.fold(least, f64::max);
    let pressures = run.field.pressures(contact, approach).map(|(_, pressure)| pressure);
    let greatest = pressures.fold(0.0, f64::max) * problem.table().self_influence();
    Slack { gap, tension: gap.max(TOLERANCE * greatest), excess: gap, rate: TOLERANCE }
}

/// What a pressure on nodes out of contact, and a gap of nodes in it at some positions, adds to sums over all nodes: of
/// gaps, of plastic depths, and of these times the hardness. By reciprocity it is what right-hand sides of the same
/// sums answer.
fn plastic_sums(
    run: &LoadingRun,
    plastic: &Plastic,
    updater: &mut dyn LinearUpdater,
    (outside, positions): (&[usize], &[usize]),
) -> Result<Vec<[f64; SUMS]>, Error> {
    let (order, table) = (run.contact.order(), run.problem.table());
    let row_sums = run.problem.row_sums();
    let sums = |node: usize| -> [f64; SUMS] {
        [row_sums[node], -plastic.unit()[node], -plastic.load()[node]]
    };
    let mut solved: Vec<[f64; 2]> =
        order.iter().map(|&node| [sums(node)[0], sums(node)[1]]).collect();
    let mut last: Vec<[f64; 2]> = order.iter().map(|&node| [sums(node)[2], 0.0]).collect();
    updater.solve_for(&run.problem, &run.contact, &mut solved)?;
    updater.solve_for(&run.problem, &run.contact, &mut last)?;
    let places: Vec<usize> = outside.iter().map(|&node| table.place(node)).collect();
    let mut answered: Vec<[f64; SUMS]> = outside.iter().map(|&node| sums(node)).collect();
    let mut coefficients = vec![0.0; outside.len()];
    for ((&node, [first, second]), [third, _]) in order.iter().zip(&solved).zip(&last) {
        table.fill_column(table.place(node), &places, &mut coefficients);
        for (sums, coefficient) in answered.iter_mut().zip(&coefficients) {
            sums[0] -= coefficient * first;
            sums[1] -= coefficient * second;
            sums[2] -= coefficient * third;
        }
    }
    answered.extend(
        positions.iter().map(|&place| [solved[place][0], solved[place][1], last[place][0]]),
    );
    Ok(answered)
}

#[cfg(test)]
mod tests;
