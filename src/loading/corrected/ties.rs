//! Events that are too close to each other to be told apart without a solution of their own.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::correction::Correction;
use super::play::{Course, Played, play};
use super::watched::Watched;
use crate::Error;
use crate::loading::front::Front;
use crate::loading::gap_field;
use crate::loading::run::LoadingRun;
use crate::loading::scales::Scales;
use crate::updater::{LinearUpdater, Solution, SolveRequest};

/// The error of a time is estimated as the greatest of
/// * this many times the difference of the two corrections, by the Schur complement and by cubics,
const BETWEEN_CORRECTIONS: f64 = 2.0;
/// * this part of what the correction changed, for this event and on average,
const OF_CHANGE: f64 = 0.1;
/// * the same if the Schur complement could not be updated,
const OF_CHANGE_UNCORRECTED: f64 = 0.5;
/// * this part of the mean spacing of events.
const OF_SPACING: f64 = 1e-3;
/// To this comes what closing rates may be off by, over the rate.
const RATE_ERROR: f64 = 5e-7;
/// An error above this part of the approach is settled by a solution wherever the neighbours are.
const POOR: f64 = 1e-3;
/// A solution first leaves this part of the errors.
const OF_ERROR: f64 = 0.04;
/// After a solution, errors grow with the way from it by this part.
const OF_WAY: f64 = 0.05;
/// Closing rates and pivots of nodes that symmetry maps to each other differ by less, relatively, and their gaps and the
/// ways to their contact by so many times the tolerance; so do no others that touch at nearly the same time.
const SAME_RATE: f64 = 2e-5;
const SAME_PIVOT: f64 = 1e-4;
const SAME_GAP: f64 = 20.0;
/// A solution that finds an event so many times its estimated error away contradicts the whole window.
const CONTRADICTED: f64 = 10.0;

/// The events of a window in their final order.
#[derive(Debug)]
pub(super) struct Settled {
    pub(super) events: Vec<Played>,
    /// Estimated error of each time, in the gauge of the kernel.
    pub(super) errors: Vec<f64>,
}

/// Settles what is too close to be told apart in a window, which began at the front `start`. `None` if a solution is far from
/// what was expected there, unless the window is `certain`.
pub(super) fn settle<U: LinearUpdater>(
    run: &mut LoadingRun<U>,
    scales: &Scales,
    watched: &Watched,
    correction: &Correction,
    settled: Settled,
    (start, certain): (&Front, bool),
) -> Result<Option<Settled>, Error> {
    let mut ties = Ties {
        watched,
        correction,
        scales,
        count: run.contact.len() - settled.events.len(),
        approach: start.approach(),
        settled,
        certain,
        asked: None,
    };
    let mut next = 0;
    ties.make_orbits_equal(0..ties.settled.events.len());
    while next < ties.settled.events.len() {
        next = match ties.run_from(next) {
            Some(last) if ties.is_orbit(next, last) => last + 1,
            Some(last) => match ties.resolve(run, next, last)? {
                Some(next) => next,
                None => return Ok(None),
            },
            None => next + 1,
        };
    }
    Ok(Some(ties.settled))
}

/// Plays the events that joined under the corrected Schur complement, and estimates their errors. `first` is
/// what they were in the first pass, `joined` the positions of the nodes that joined, and the window ends after
/// `time`.
pub(super) fn second_pass(
    watched: &Watched,
    correction: &Correction,
    (first, joined, time): (&[Played], &[usize], f64),
) -> Settled {
    let end = time * (1.0 + 1e-9);
    let at_most = watched.nodes.len();
    let (mut events, _) = play(&correction.schur, &correction.courses, end, at_most);
    events.retain(|event| joined.contains(&event.position));
    for &position in joined {
        if !events.iter().any(|event| event.position == position) {
            events.push(Played { position, time });
        }
    }
    let (other, _) = play(&watched.schur, &correction.hermite, end, at_most);
    let count = events.len() as f64;
    let change = mean_change(first, &events, time);
    let part = if correction.updated {
        OF_CHANGE
    } else {
        OF_CHANGE_UNCORRECTED
    };
    let error = |event: &Played| {
        let [_, closing] = watched.lines[event.position];
        let of_rate = RATE_ERROR * event.time / closing;
        let changed = part * (distance(first, event, time) + change);
        let between = BETWEEN_CORRECTIONS * distance(&other, event, time);
        between.max(changed).max(OF_SPACING * time / count) + of_rate
    };
    Settled {
        errors: events.iter().map(error).collect(),
        events,
    }
}

/// How far an event is from where a pass has it, in a window that ends after `time`.
fn distance(pass: &[Played], event: &Played, time: f64) -> f64 {
    let found = pass.iter().find(|other| other.position == event.position);
    found.map_or(time, |found| (found.time - event.time).abs())
}

/// The mean distance of some events from where a pass has them.
pub(super) fn mean_change(pass: &[Played], events: &[Played], time: f64) -> f64 {
    let changes = events.iter().map(|event| distance(pass, event, time));
    changes.sum::<f64>() / events.len() as f64
}

/// A window whose events are being settled.
struct Ties<'a> {
    watched: &'a Watched,
    correction: &'a Correction,
    scales: &'a Scales,
    /// Nodes in contact, and the approach, at the window's beginning.
    count: usize,
    approach: f64,
    settled: Settled,
    /// Whether no solution can contradict it.
    certain: bool,
    /// The event that the last solution was for, if it did not settle everything.
    asked: Option<usize>,
}

impl Ties<'_> {
    /// The node of an event.
    fn node(&self, event: usize) -> usize {
        self.watched.nodes[self.settled.events[event].position]
    }

    /// Whether an event and the next one are closer than their errors.
    fn is_close(&self, event: usize) -> bool {
        let Settled { events, errors } = &self.settled;
        events
            .get(event + 1)
            .is_some_and(|next| next.time - events[event].time < errors[event] + errors[event + 1])
    }

    /// Whether an event's error is too great in itself.
    fn is_poor(&self, event: usize) -> bool {
        let Settled { events, errors } = &self.settled;
        errors[event] > POOR * (self.approach + events[event].time)
    }

    /// The last event of the run of close neighbours that begins here, if there is anything to settle.
    fn run_from(&self, first: usize) -> Option<usize> {
        if !self.is_close(first) && !self.is_poor(first) {
            return None;
        }
        let mut last = first;
        while self.is_close(last) {
            last += 1;
        }
        Some(last)
    }

    /// Whether symmetry maps the nodes of two events to each other: they had the same gap and the same closing rate when the
    /// window began, they give way alike, and their times are not told apart. Before first touch all nodes close at the same
    /// rate, and what joins first tells them apart: only ties count.
    fn are_images(&self, event: usize, other: usize) -> bool {
        let Settled { events, errors } = &self.settled;
        let (watched, scales) = (self.watched, self.scales);
        let [p, q] = [event, other].map(|event| events[event].position);
        let ([a, b], [other_a, other_b]) = (watched.lines[p], watched.lines[q]);
        let [own, other_own] = [p, q].map(|p| self.correction.schur[(p, p)]);
        let gap = SAME_GAP * scales.tolerance * scales.length;
        let way = (gap / b).min(errors[event] + errors[other]);
        let apart = if self.count == 0 { 0.0 } else { way };
        (events[event].time - events[other].time).abs() <= apart.max(scales.tie)
            && (a - other_a).abs() <= gap
            && (b - other_b).abs() < SAME_RATE * b.max(1e-3)
            && (own - other_own).abs() < SAME_PIVOT * own
    }

    /// Whether events are those of nodes that symmetry maps to each other, all of them.
    fn is_orbit(&self, first: usize, last: usize) -> bool {
        let events = &self.settled.events;
        first < last
            && (first..=last).all(|event| !self.is_poor(event))
            && (first..=last).all(|event| {
                events[event].time == events[first].time && self.are_images(first, event)
            })
    }

    /// Gives nodes that symmetry maps to each other their mean time, and the greatest of their errors, in the order of the
    /// nodes.
    fn make_orbits_equal(&mut self, range: Range<usize>) {
        let mut orbits: Vec<Vec<usize>> = Vec::new();
        for event in range.clone() {
            match orbits
                .iter_mut()
                .find(|orbit| self.are_images(orbit[0], event))
            {
                Some(orbit) => orbit.push(event),
                None => orbits.push(vec![event]),
            }
        }
        if orbits.len() == range.len() {
            return;
        }
        let Settled { events, errors } = &mut self.settled;
        let mut equal = Vec::with_capacity(range.len());
        for orbit in orbits {
            let times = orbit.iter().map(|&event| events[event].time);
            let time = times.sum::<f64>() / orbit.len() as f64;
            let error = orbit.iter().map(|&event| errors[event]).fold(0.0, f64::max);
            let alike = |event| Played {
                time,
                ..events[event]
            };
            equal.extend(orbit.into_iter().map(|event| (alike(event), error)));
        }
        let nodes = &self.watched.nodes;
        equal.sort_by(|(a, _), (b, _)| {
            let by_node = nodes[a.position].cmp(&nodes[b.position]);
            a.time.total_cmp(&b.time).then(by_node)
        });
        for (place, (event, error)) in range.zip(equal) {
            (events[place], errors[place]) = (event, error);
        }
    }

    /// Settles a run of events by the exact gaps just before it, and returns from which event to go on; `None` if these gaps
    /// contradict what was expected.
    fn resolve<U: LinearUpdater>(
        &mut self,
        run: &mut LoadingRun<U>,
        first: usize,
        last: usize,
    ) -> Result<Option<usize>, Error> {
        let time = self.settled.events[first].time;
        let gap_error = self.sufficient_error(first, last);
        let gaps = self.exact_gaps(run, first, last, gap_error)?;
        run.timings.ties += 1;
        let Some((schur, rates)) = self.eliminated(first, last) else {
            return Ok(Some(last + 1));
        };
        // Some may lie a little behind.
        let lines = gaps.iter().zip(rates.iter());
        let earliest = lines.clone().map(|(gap, rate)| gap / rate);
        let back = 2.0 * earliest.fold(0.0, f64::min);
        let courses: Vec<Course> = lines
            .map(|(gap, rate)| Course([gap - back * rate, *rate, 0.0, 0.0]))
            .collect();
        let (played, _) = play(&schur, &courses, f64::INFINITY, courses.len());
        if played.len() < courses.len() {
            return Ok(Some(last + 1));
        }
        let before: Vec<usize> = (first..=last)
            .map(|event| self.settled.events[event].position)
            .collect();
        let mut events: Vec<Played> = played
            .iter()
            .map(|event| Played {
                position: before[event.position],
                time: time + back + event.time,
            })
            .collect();
        let exact = gap_error == 0.0;
        let is_open = !self.certain && self.asked != Some(first);
        if is_open && (first..=last).any(|event| self.is_contradicted(event, &events)) {
            return Ok(None);
        }
        if exact {
            self.order_ties(&mut events);
        }
        let start = events[0].time;
        let left = gap_error + 2.0 * self.scales.tolerance * (self.approach + time);
        for (k, event) in events.iter().enumerate() {
            let place = before
                .iter()
                .position(|position| *position == event.position);
            let rate = rates[place.unwrap_or_default()];
            self.settled.errors[first + k] = OF_WAY * (event.time - start) + left / rate;
        }
        self.settled.events[first..=last].copy_from_slice(&events);
        self.make_orbits_equal(first..last + 1);
        // Far behind the solution it may not be enough, or the solution was not exact enough.
        let again = (first + usize::from(exact)..last).find(|&event| {
            let spacing = self.settled.events[event + 1].time - self.settled.events[event].time;
            (spacing > self.scales.tie || !exact) && self.is_close(event)
        });
        self.asked = again;
        Ok(Some(again.unwrap_or(last + 1)))
    }

    /// Whether an event was expected far from where it is among those that were found.
    fn is_contradicted(&self, event: usize, found: &[Played]) -> bool {
        let Settled { events, errors } = &self.settled;
        let most = CONTRADICTED * (errors[event] + self.scales.tie);
        distance(found, &events[event], f64::INFINITY) > most
    }

    /// The error of gaps with which most runs of events are settled, and after that none.
    fn sufficient_error(&self, first: usize, last: usize) -> f64 {
        if self.asked == Some(first) {
            return 0.0;
        }
        let errors = &self.settled.errors[first..=last];
        let least = errors.iter().copied().fold(f64::INFINITY, f64::min);
        let lines = &self.watched.lines;
        let events = &self.settled.events[first..=last];
        let rates = events.iter().map(|event| lines[event.position][1]);
        OF_ERROR * least * rates.fold(f64::INFINITY, f64::min)
    }

    /// Events that are ties get the time of the first, and come in the order of their nodes.
    fn order_ties(&self, events: &mut [Played]) {
        let (nodes, tie) = (&self.watched.nodes, self.scales.tie);
        for tied in events.chunk_by_mut(|a, b| b.time - a.time < tie) {
            let first = tied[0].time;
            tied.sort_by_key(|event| nodes[event.position]);
            for event in tied {
                event.time = first;
            }
        }
    }

    /// The gaps of some events, all events before them done, at the time of the first.
    fn exact_gaps<U: LinearUpdater>(
        &self,
        run: &mut LoadingRun<U>,
        first: usize,
        last: usize,
        gap_error: f64,
    ) -> Result<Vec<f64>, Error> {
        let events = 0..self.settled.events.len();
        let order: Vec<usize> = events.map(|event| self.node(event)).collect();
        run.rearrange(self.count, &order)?;
        let approach = self.approach + self.settled.events[first].time;
        let request = SolveRequest {
            count: self.count + first,
            approach,
            span: 0.0,
            gap_error,
        };
        let mut solution = Solution::default();
        let (problem, contact) = (&run.problem, &run.contact);
        gap_field::solve(problem, contact, request, &mut run.updater, &mut solution)?;
        let displacement = |node: usize| match solution.displacement[0].get(node) {
            Some(displacement) => *displacement,
            None => {
                let table = problem.table();
                let place = table.place(node);
                let pressures = contact.order().iter().zip(&solution.pressure);
                pressures
                    .map(|(&other, p)| table.between(place, table.place(other)) * p)
                    .sum()
            }
        };
        let gap = |event: usize| {
            let node = self.node(event);
            problem.initial_gap()[node] + displacement(node) - approach
        };
        Ok((first..=last).map(gap).collect())
    }

    /// Schur complement and closing rates of some events, all events before them eliminated.
    fn eliminated(&self, first: usize, last: usize) -> Option<(DMatrix<f64>, DVector<f64>)> {
        let Correction { schur, courses, .. } = self.correction;
        let events = &self.settled.events;
        let time = events[first].time;
        let (done, open) = (&events[..first], &events[first..=last]);
        let between = |rows: &[Played], columns: &[Played]| {
            DMatrix::from_fn(rows.len(), columns.len(), |i, j| {
                schur[(rows[i].position, columns[j].position)]
            })
        };
        let closing = |events: &[Played]| {
            let rates = events
                .iter()
                .map(|event| courses[event.position].closing(time));
            DVector::from_iterator(events.len(), rates)
        };
        if done.is_empty() {
            return Some((between(open, open), closing(open)));
        }
        let factor = between(done, done).cholesky()?;
        let coupling = between(done, open);
        let eliminated = between(open, open) - coupling.transpose() * factor.solve(&coupling);
        let rates = closing(open) - coupling.transpose() * factor.solve(&closing(done));
        Some((eliminated, rates))
    }
}

#[cfg(test)]
mod tests;
