//! Events that are too close to each other to be told apart without a solution of their own.

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

/// The events of a window in their final order.
#[derive(Debug)]
pub(super) struct Settled {
    pub(super) events: Vec<Played>,
    /// Estimated error of each time.
    pub(super) errors: Vec<f64>,
}

/// Settles what is too close to be told apart in a window, which began at the front `start`.
pub(super) fn settle<U: LinearUpdater>(
    run: &mut LoadingRun<U>,
    scales: &Scales,
    watched: &Watched,
    correction: &Correction,
    settled: Settled,
    start: &Front,
) -> Result<Settled, Error> {
    let mut ties = Ties {
        watched,
        correction,
        scales,
        count: run.contact.len() - settled.events.len(),
        approach: start.approach(),
        settled,
        asked: None,
    };
    let mut next = 0;
    while next < ties.settled.events.len() {
        next = match ties.run_from(next) {
            Some(last) if ties.is_orbit(next, last) => {
                ties.make_equal(next, last);
                last + 1
            }
            Some(last) => ties.resolve(run, next, last)?,
            None => next + 1,
        };
    }
    Ok(ties.settled)
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
    let distance = |events: &[Played], event: &Played| {
        let found = events.iter().find(|other| other.position == event.position);
        found.map_or(time, |found| (found.time - event.time).abs())
    };
    let count = events.len() as f64;
    let change: f64 = events.iter().map(|event| distance(first, event)).sum();
    let part = if correction.updated {
        OF_CHANGE
    } else {
        OF_CHANGE_UNCORRECTED
    };
    let error = |event: &Played| {
        let [_, closing] = watched.lines[event.position];
        let of_rate = RATE_ERROR * event.time / closing;
        let changed = part * (distance(first, event) + change / count);
        let between = BETWEEN_CORRECTIONS * distance(&other, event);
        between.max(changed).max(OF_SPACING * time / count) + of_rate
    };
    Settled {
        errors: events.iter().map(error).collect(),
        events,
    }
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

    /// Whether events are those of nodes that symmetry maps to each other: the same gap and the same closing
    /// rate when the window began, and the same time. Before first touch all nodes close at the same rate, and
    /// what joins first tells them apart.
    fn is_orbit(&self, first: usize, last: usize) -> bool {
        let line = |event: usize| self.watched.lines[self.settled.events[event].position];
        let scales = self.scales;
        let rate = 10.0 * scales.rate_tolerance(scales.length).max(1e-7);
        (first..=last).all(|event| !self.is_poor(event))
            && first < last
            && (first..last).all(|event| {
                let ([a, b], [other_a, other_b]) = (line(event), line(event + 1));
                let events = &self.settled.events;
                events[event + 1].time - events[event].time <= scales.tie
                    && (a - other_a).abs() < 10.0 * scales.tolerance * scales.length
                    && (b - other_b).abs() < rate * b.max(1e-3)
            })
    }

    /// Events at their mean time, in the order of the nodes.
    fn make_equal(&mut self, first: usize, last: usize) {
        let nodes = &self.watched.nodes;
        let events = &mut self.settled.events[first..=last];
        let mean = events.iter().map(|event| event.time).sum::<f64>() / events.len() as f64;
        events.sort_by_key(|event| nodes[event.position]);
        for event in events {
            event.time = mean;
        }
    }

    /// Settles a run of events by the exact gaps just before it, and returns from which event to go on.
    fn resolve<U: LinearUpdater>(
        &mut self,
        run: &mut LoadingRun<U>,
        first: usize,
        last: usize,
    ) -> Result<usize, Error> {
        let time = self.settled.events[first].time;
        let gap_error = self.sufficient_error(first, last);
        let gaps = self.exact_gaps(run, first, last, gap_error)?;
        run.timings.ties += 1;
        let Some((schur, rates)) = self.eliminated(first, last) else {
            return Ok(last + 1);
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
            return Ok(last + 1);
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
        // Far behind the solution it may not be enough, or the solution was not exact enough.
        let again = (first + usize::from(exact)..last).find(|&event| {
            let spacing = self.settled.events[event + 1].time - self.settled.events[event].time;
            (spacing > self.scales.tie || !exact) && self.is_close(event)
        });
        self.asked = again;
        Ok(again.unwrap_or(last + 1))
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
