//! Events in windows on a path with a hardness: nodes that touch, and elastic nodes that yield.
//!
//! A node goes from out of contact to elastic to yielded, and never back, on every body whose contact only grows. Nodes that have
//! yielded carry their hardness and take no part in the linear system: `ContactSequence` holds the elastic nodes, and
//! `LoadingRun::problem` is their problem, with the displacement under the yielded ones in its initial gap.
//!
//! Rates rise where a node yields, so that the time at which a node would touch or yield if no other did is no bound. So a window is
//! played, solved at its end, and checked there before the factor learns of it. Gaps only close and pressures only grow: what is right
//! at the end was right throughout. Where the end contradicts events, fewer are played.

//!
//! Without a factor `RefinedYielding` plays such windows of a matrix that is nearly exact, and corrects them at their end.

mod pinned;
mod refined;
#[cfg(test)]
mod wrong_matrices;

use std::sync::Arc;
use std::time::Instant;

use super::cost::{WITH_FACTOR, automatic_window, watched_for};
use super::gap_field::GapLine;
use super::plastic::{Displaced, Plastic};
use super::run::LoadingRun;
use super::scalars::{PlasticScalars, Rates};
use super::state::ContactEvent;
use super::sum::Sum;
use super::tuning::{OF_RESIDUAL, SQUARE, TOLERANCE};
use super::window::{SUMS, Watched, Window};
use crate::contact::ContactSequence;
use crate::updater::{Left, LinearUpdater, Schur, Solution, WindowFactor, join_all};
use crate::{Error, Problem};
pub(super) use refined::RefinedYielding;

/// Finds events of both kinds in windows.
#[derive(Debug, Default)]
pub(super) struct Yielding {
    /// How many nodes to watch, if the user says so.
    size: Option<usize>,
    window: Window,
    schur: Schur,
    /// Nodes out of contact that were watched, in the order of the updater.
    watched_before: Vec<usize>,
    /// Nodes by the time of their next event if no other came first.
    ranking: Vec<(f64, usize)>,
}

/// A window at its end, before the updater learns of it.
struct Trial {
    contact: ContactSequence,
    problem: Problem,
    displaced: Displaced,
    /// Nodes that yielded, in the order in which they did.
    yielded: Vec<usize>,
    /// The same with the number of their event in the window, from 1 on, and their places in the contact then.
    departures: Vec<(usize, Left)>,
}

impl Trial {
    /// Contact and problem behind some events.
    fn of(
        run: &LoadingRun,
        plastic: &Plastic,
        events: impl Iterator<Item = (usize, ContactEvent)>,
    ) -> Result<Self, Error> {
        let (contact, yielded, departures) = contact_behind(run, events)?;
        let displaced = plastic.displaced(&yielded)?;
        let problem = plastic.elastic(&run.problem, &displaced);
        Ok(Self { contact, problem, displaced, yielded, departures })
    }

    /// Lets the path follow, whatever solves on its contact. Returns what has yielded then.
    fn adopt(self, run: &mut LoadingRun, plastic: &Plastic) -> Arc<Plastic> {
        let step = run.steps();
        let Self { contact, problem, displaced, yielded, departures } = self;
        let plastic = Arc::new(plastic.grown(&yielded, &displaced));
        run.plastic = Some(Arc::clone(&plastic));
        run.problem = problem;
        run.contact = contact;
        for (number, left) in departures {
            run.releases.push_yielded(step + number, left);
        }
        plastic
    }
}

/// The contact behind some events, the nodes that yielded, and these with the number of their event and their places then.
#[allow(clippy::type_complexity)]
fn contact_behind(
    run: &LoadingRun,
    events: impl Iterator<Item = (usize, ContactEvent)>,
) -> Result<(ContactSequence, Vec<usize>, Vec<(usize, Left)>), Error> {
    let mut contact = run.contact.clone();
    let (mut yielded, mut departures) = (Vec::new(), Vec::new());
    for (number, (node, kind)) in (1..).zip(events) {
        if kind == ContactEvent::Touch {
            contact.push(node)?;
        } else {
            let position = contact.remove(node)?;
            yielded.push(node);
            departures.push((number, Left { node, position }));
        }
    }
    Ok((contact, yielded, departures))
}

/// By how much a solution may contradict what contact that grows does.
#[derive(Debug, Clone, Copy)]
struct Slack {
    /// Overlap \[m\].
    gap: f64,
    /// What a tension, or a pressure beyond the hardness, would displace alone \[m\].
    pressure: f64,
    /// Rates of pressures, relative to the greatest, and of plastic depths.
    rate: f64,
}

/// Nodes in contact where a window begins.
#[derive(Debug, Clone, Copy)]
struct Carried {
    /// How many are elastic, and how many have yielded.
    nodes: [usize; 2],
    /// The sum of pressures of those that have yielded, and what all could carry: a load beyond these is rounding.
    sum: f64,
    most: f64,
}

impl Carried {
    fn of(run: &LoadingRun, plastic: &Plastic) -> Self {
        let hardness = plastic.hardness().values();
        let elastic: f64 = run.contact.order().iter().map(|&node| hardness[node]).sum();
        Self {
            nodes: [run.contact.len(), plastic.count()],
            sum: plastic.sum(),
            most: plastic.sum() + elastic,
        }
    }
}

impl Yielding {
    pub(super) fn new(size: Option<usize>) -> Self {
        Self { size, ..Self::default() }
    }

    /// Computes a window of states, with no more than `most_nodes` in contact, which is more than there are; none if no node is left to touch or to yield.
    /// Returns what went wrong after them.
    pub(super) fn produce<U: LinearUpdater>(
        &mut self,
        run: &mut LoadingRun,
        updater: &mut U,
        most_nodes: usize,
    ) -> Result<Option<Error>, Error> {
        let Some(plastic) = run.plastic.clone() else {
            return Ok(None);
        };
        let approach = run.scalars.approach();
        run.renew_field(updater, approach)?;
        let tolerance = TOLERANCE * (run.problem.grid().cell_aspect() / SQUARE).max(1.0);
        let gap = tolerance * (run.problem.greatest_gap() + approach);
        let slack = Slack { gap, pressure: gap, rate: TOLERANCE };
        let rates = survey(run, &plastic, &mut self.ranking, slack)?;
        if self.ranking.is_empty() {
            return Ok(None);
        }
        let touches = most_nodes - run.contact.len() - plastic.count();
        let size = run.affordable(updater, self.next_size(run, touches))?;
        let start = Instant::now();
        let horizon = self.choose(run, size);
        run.timings.choice += start.elapsed();
        self.watch(run, &plastic, updater, horizon)?;

        let start = Instant::now();
        let mut bad_pivot = self.window.play_touches(touches);
        run.timings.events += start.elapsed();
        if self.window.events().is_empty() {
            let stopped = || self.growth_stopped(run);
            return Err(bad_pivot.map_or_else(stopped, |bad| run.not_positive_definite(bad)));
        }
        let trial = loop {
            let (trial, until) = self.try_end(run, &plastic, updater)?;
            let events = self.window.events();
            let Some(until) = until.filter(|_| events.len() > 1) else {
                break trial;
            };
            let kept = events.iter().take_while(|event| event.time <= until).count();
            let kept = kept.clamp(1, events.len() - 1);
            run.timings.taken_back += events.len() - kept;
            self.window.truncate(kept);
            bad_pivot = None;
        };
        let before = Carried::of(run, &plastic);
        let plastic = self.commit(run, &plastic, updater, trial)?;
        let start = Instant::now();
        let queued = self.enqueue(run, &plastic, (before, rates));
        run.timings.events += start.elapsed();
        Ok(queued.err().or_else(|| bad_pivot.map(|bad| run.not_positive_definite(bad))))
    }

    /// How many nodes to watch.
    fn next_size(&self, run: &LoadingRun, touches: usize) -> usize {
        let (count, nodes) = (run.contact.len(), run.problem.grid().nodes());
        let size = self.size.unwrap_or_else(|| {
            // Nodes that yield are not counted: without any a window has no more touches than are left.
            automatic_window(count, nodes, WITH_FACTOR).min(watched_for(touches).saturating_mul(2))
        });
        size.min(self.ranking.len())
    }

    /// Keeps the nodes to watch in the ranking, those out of contact first, in the order in which they were watched before; returns
    /// the time of the next of the others.
    fn choose(&mut self, run: &LoadingRun, size: usize) -> f64 {
        let order = |a: &(f64, usize), b: &(f64, usize)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        let mut horizon = f64::INFINITY;
        if size < self.ranking.len() {
            horizon = self.ranking.select_nth_unstable_by(size, order).1.0;
            self.ranking.truncate(size);
        }
        self.ranking.sort_unstable_by_key(|&(_, node)| (run.contact.contains(node), node));
        let out = self.ranking.partition_point(|&(_, node)| !run.contact.contains(node));
        let mut front = 0;
        for node in self.watched_before.drain(..) {
            let rest = &mut self.ranking[front..out];
            if let Ok(found) = rest.binary_search_by_key(&node, |&(_, node)| node) {
                rest[..=found].rotate_right(1);
                front += 1;
            }
        }
        horizon
    }

    /// Opens the window on the nodes that have been chosen.
    fn watch<U: LinearUpdater>(
        &mut self,
        run: &mut LoadingRun,
        plastic: &Plastic,
        updater: &mut U,
        horizon: f64,
    ) -> Result<(), Error> {
        let approach = run.scalars.approach();
        let order = run.contact.order();
        let places = places(order, run.problem.grid().nodes());
        let chosen = self.ranking.iter().map(|&(_, node)| node);
        let (inside, outside): (Vec<_>, Vec<_>) = chosen.partition(|&n| run.contact.contains(n));
        let mut positions: Vec<usize> = inside.iter().map(|&node| places[node]).collect();
        positions.sort_unstable();
        updater.watch_both(&run.problem, &run.contact, &outside, &positions, &mut self.schur)?;
        let inside = positions.iter().map(|&position| order[position]);
        let watched: Vec<usize> = outside.iter().copied().chain(inside).collect();
        run.check_complement(&watched, &self.schur)?;

        // Sums over nodes out of contact and over yielded ones, by reciprocity: what right-hand sides of the same sums answer.
        let row_sums = run.problem.row_sums();
        let sums = |node: usize| -> [f64; SUMS] {
            [row_sums[node], -plastic.unit()[node], -plastic.load()[node]]
        };
        let mut solved: Vec<[f64; 2]> =
            order.iter().map(|&node| [sums(node)[0], sums(node)[1]]).collect();
        let mut last: Vec<[f64; 2]> = order.iter().map(|&node| [sums(node)[2], 0.0]).collect();
        updater.solve_for(&run.problem, &run.contact, &mut solved)?;
        updater.solve_for(&run.problem, &run.contact, &mut last)?;
        let table = run.problem.table();
        let places_outside: Vec<usize> = outside.iter().map(|&node| table.place(node)).collect();
        let mut outer: Vec<[f64; SUMS]> = outside.iter().map(|&node| sums(node)).collect();
        let mut coefficients = vec![0.0; outside.len()];
        for ((&node, [first, second]), [third, _]) in order.iter().zip(&solved).zip(&last) {
            table.fill_column(table.place(node), &places_outside, &mut coefficients);
            for (sums, coefficient) in outer.iter_mut().zip(&coefficients) {
                sums[0] -= coefficient * first;
                sums[1] -= coefficient * second;
                sums[2] -= coefficient * third;
            }
        }
        let pressures: Vec<(usize, f64)> = run.field.pressures(&run.contact, approach).collect();
        let hardness = plastic.hardness().values();
        let watched: Vec<Watched> = watched
            .into_iter()
            .enumerate()
            .map(|(k, node)| {
                let hardness = hardness[node];
                if let Some(q) = k.checked_sub(outside.len()) {
                    let position = positions[q];
                    let [first, second] = solved[position];
                    let sums = of_overlap([first, second, last[position][0]], hardness);
                    let (gap, closing) =
                        (pressures[position].1, -run.field.solution().rate[position]);
                    let line = GapLine { gap, closing };
                    return Watched { node, is_elastic: true, hardness, line, sums };
                }
                let line = run.field.line(&run.problem, node, approach);
                Watched { node, is_elastic: false, hardness, line, sums: outer[k] }
            })
            .collect();
        self.window.begin_both((approach, horizon), &watched, &self.schur, order.len());
        self.watched_before.clear();
        self.watched_before.extend(outside);
        run.timings.windows += 1;
        Ok(())
    }

    /// Solves at the end of the window, with the contact as the updater has it, and computes all gaps there. Returns with it the
    /// approach of the first contradiction in terms of the time of the window, as far as rates tell.
    fn try_end<U: LinearUpdater>(
        &mut self,
        run: &mut LoadingRun,
        plastic: &Plastic,
        updater: &mut U,
    ) -> Result<(Trial, Option<f64>), Error> {
        let end = self.window.events().last().map_or(0.0, |event| event.time);
        let approach = run.scalars.approach() + end;
        let order = run.contact.order();
        let nodes = run.problem.grid().nodes();
        let table = run.problem.table();
        // Pressures and rates of nodes that touched, gaps and their rates of nodes that yielded.
        let mut pressed: Vec<(usize, [f64; 2])> = Vec::new();
        let mut values = vec![[0.0; 2]; nodes];
        let hardness = plastic.hardness().values();
        for (event, answer) in self.window.events().iter().zip(self.window.answers(end)) {
            let node = self.window.node(event.position);
            if event.kind == ContactEvent::Touch {
                let yields = self.window.events().iter().any(|other| {
                    (other.position, other.kind) == (event.position, ContactEvent::Yield)
                });
                pressed.push((node, if yields { [hardness[node], 0.0] } else { answer }));
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
        let events = self.window.events().iter();
        let events = events.map(|event| (self.window.node(event.position), event.kind));
        let trial = Trial::of(run, plastic, events)?;
        let after = trial.contact.order();
        let solution = Solution {
            pressure: after.iter().map(|&node| values[node][0]).collect(),
            rate: after.iter().map(|&node| values[node][1]).collect(),
        };
        run.field.place(&trial.contact, solution, approach)?;
        run.timings.convolution = run.field.time();
        run.check_closed(&trial.problem, &trial.contact, approach)?;
        let left = trial.contact.order().iter();
        let left = left.map(|&node| run.field.left_at(&trial.problem, node)[0].abs());
        let least = f64::EPSILON * (trial.problem.greatest_gap() + approach);
        let gap = OF_RESIDUAL * left.fold(least, f64::max);
        let slack = Slack { gap, pressure: gap, rate: TOLERANCE };
        let until = contradiction(run, plastic, &trial, (approach, slack));
        Ok((trial, until.map(|until| end + until)))
    }

    /// Lets the updater follow to the end of the window.
    fn commit<U: LinearUpdater>(
        &mut self,
        run: &mut LoadingRun,
        plastic: &Plastic,
        updater: &mut U,
        trial: Trial,
    ) -> Result<Arc<Plastic>, Error> {
        let step = run.steps();
        let Trial { contact, problem, yielded, .. } = &trial;
        // Whatever becomes of the updater, also by a panic: the states so far are known without it.
        let known = run.releases.forget(step);
        let before = run.contact.order();
        let old = |node: usize| run.contact.contains(node);
        let followed = if yielded.is_empty() {
            let joined = contact.order()[before.len()..].iter();
            let place = |node: &usize| self.window.position(*node);
            let positions: Vec<usize> = joined.filter_map(place).collect();
            self.watched_before.retain(|&node| !contact.contains(node));
            WindowFactor::of(self.schur.clone(), &positions)
                .and_then(|factor| updater.join(problem, contact, &factor))
        } else {
            self.watched_before.clear();
            let has_left = |&(_, &node): &(usize, &usize)| !contact.contains(node);
            let left = before.iter().enumerate().filter(has_left);
            let left: Vec<Left> = left.map(|(position, &node)| Left { node, position }).collect();
            let (kept, joined): (Vec<_>, Vec<_>) =
                contact.order().iter().partition(|&&node| old(node));
            ContactSequence::with_order(problem.grid(), kept).and_then(|mut kept| {
                updater.release(problem, &kept, &left)?;
                join_all(updater, problem, &mut kept, &joined, run.memory.left())
            })
        };
        followed.map_err(|error| run.memory.in_all(error))?;
        run.releases.remember(known);
        Ok(trial.adopt(run, plastic))
    }

    /// Turns the events of the window, which began with these nodes in contact, into states.
    fn enqueue(
        &self,
        run: &mut LoadingRun,
        plastic: &Plastic,
        (before, rates): (Carried, Rates),
    ) -> Result<(), Error> {
        let Carried { nodes: [mut elastic, mut yielded], mut sum, mut most } = before;
        let start = run.scalars.approach();
        let mut step = elastic + 2 * yielded;
        let hardness = plastic.hardness().values();
        for (event, rates) in self.window.events().iter().zip(self.window.rates(rates)) {
            let node = self.window.node(event.position);
            run.scalars.advance(start + event.time);
            run.scalars.clamp_load([sum, most]);
            run.scalars.clamp_mean_gap();
            if event.kind == ContactEvent::Touch {
                elastic += 1;
                most += hardness[node];
            } else {
                elastic -= 1;
                yielded += 1;
                sum += hardness[node];
            }
            run.scalars.change_rates(rates, [elastic, yielded], sum);
            step += 1;
            run.enqueue(step, event.kind, node, elastic + yielded)?;
        }
        Ok(())
    }

    /// The path cannot go on although nodes are left.
    fn growth_stopped(&self, run: &LoadingRun) -> Error {
        let node = self.ranking.iter().map(|&(_, node)| node).min();
        run.not_monotone("closing rate of the gap", node.unwrap_or_default(), 0.0)
    }
}

/// Checks that contact grows, ranks all nodes that may touch or yield, and takes the scalars from the solution. Returns the
/// rates.
fn survey(
    run: &mut LoadingRun,
    plastic: &Plastic,
    ranking: &mut Vec<(f64, usize)>,
    slack: Slack,
) -> Result<Rates, Error> {
    let start = Instant::now();
    let approach = run.scalars.approach();
    let hardness = plastic.hardness().values();
    let gaps = plastic.surface().initial_gap();
    let least_gap = -slack.gap;
    let least_rate = -slack.rate * run.greatest_rate();
    ranking.clear();
    let [mut load, mut energy, mut mean_gap, mut closing] = [Sum::default(); 4];
    let [mut depth, mut work, mut depth_rate, mut work_rate] = [Sum::default(); 4];
    let mut unit_stiffness = Sum::default();
    let rates = &run.field.solution().rate;
    for ((node, pressure), &rate) in run.field.pressures(&run.contact, approach).zip(rates) {
        if rate.is_nan() || rate < least_rate {
            return Err(run.not_monotone("pressure per unit of approach", node, rate));
        }
        load.add(pressure);
        energy.add(pressure * (approach - gaps[node]));
        unit_stiffness.add(rate);
        let left = hardness[node] - pressure;
        let time = (left / rate).max(0.0);
        if rate > 0.0 && time < f64::INFINITY {
            ranking.push((time, node));
        }
    }
    for (node, line) in run.field.lines(&run.problem, &run.contact, approach) {
        if line.gap.is_nan() {
            return Err(run.not_finite());
        }
        let grows = line.closing >= -slack.rate;
        if plastic.has_yielded(node) {
            if !grows {
                let quantity = "rate of the plastic depth";
                return Err(run.not_monotone(quantity, node, line.closing));
            }
            if line.gap > -least_gap {
                return Err(run.not_monotone("plastic depth", node, -line.gap));
            }
            let hardness = hardness[node];
            load.add(hardness);
            energy.add(hardness * (approach - gaps[node] + line.gap));
            depth.add(-line.gap);
            work.add(-(hardness * line.gap));
            depth_rate.add(line.closing);
            work_rate.add(hardness * line.closing);
        } else {
            if line.gap < least_gap {
                return Err(run.not_monotone("gap", node, line.gap));
            }
            mean_gap.add(line.gap);
            closing.add(line.closing);
            if line.closing > 0.0 {
                ranking.push((line.touches().max(0.0), node));
            }
        }
    }
    let rates = Rates {
        unit_stiffness: unit_stiffness.total(),
        closing: closing.total(),
        plastic: [depth_rate.total(), work_rate.total()],
    };
    run.scalars.renew_gap(mean_gap, closing);
    run.scalars.renew_plastic(
        [load, energy],
        PlasticScalars {
            nodes: plastic.count(),
            depth: depth.total(),
            work: work.total(),
            rates: rates.plastic,
        },
    );
    run.scalars.change_rates(rates, [run.contact.len(), plastic.count()], plastic.sum());
    run.timings.choice += start.elapsed();
    Ok(rates)
}

/// What an overlap of a node in contact adds to the sums of [`Watched`], from what a gap of it adds to the same over all nodes: its own is
/// the depth of a node that has yielded.
fn of_overlap(of_gap: [f64; SUMS], hardness: f64) -> [f64; SUMS] {
    [1.0 - of_gap[0], 1.0 - of_gap[1], hardness - of_gap[2]]
}

/// The place of each node in an order; of nodes that are not there it means nothing.
fn places(order: &[usize], nodes: usize) -> Vec<usize> {
    let mut places = vec![0; nodes];
    for (place, &node) in order.iter().enumerate() {
        places[node] = place;
    }
    places
}

/// Whether a gap at the end of a window is negative, or a pressure greater than the hardness, beyond rounding. Returns how much
/// earlier the first was not yet, as far as the rates tell: not after 0.
fn contradiction(
    run: &LoadingRun,
    plastic: &Plastic,
    trial: &Trial,
    (approach, slack): (f64, Slack),
) -> Option<f64> {
    let Trial { contact, problem, .. } = trial;
    let length = slack.gap;
    let pressure = slack.pressure / problem.table().self_influence();
    let has_yielded = |node: usize| plastic.has_yielded(node) || trial.yielded.contains(&node);
    let before = |left: f64, rate: f64| if rate > 0.0 { left / rate } else { f64::NEG_INFINITY };
    let lines = run.field.lines(problem, contact, approach);
    let outside = lines.filter_map(|(node, line)| {
        if !has_yielded(node) {
            return (line.gap < -length).then(|| before(line.gap, line.closing));
        }
        // Plastic depth neither is negative nor falls.
        let recovers = line.gap > length || line.closing < -slack.rate;
        recovers.then_some(f64::NEG_INFINITY)
    });
    let hardness = plastic.hardness().values();
    let rates = &run.field.solution().rate;
    let pressures = run.field.pressures(contact, approach).zip(rates);
    let inside = pressures.filter_map(|((node, value), &rate)| {
        let left = hardness[node] - value;
        let pulls = (value < -pressure).then_some(f64::NEG_INFINITY);
        pulls.or_else(|| (left < -pressure).then(|| before(left, rate)))
    });
    outside.chain(inside).reduce(f64::min)
}
