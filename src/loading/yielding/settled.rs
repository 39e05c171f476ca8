//! The events of a corrected window in their final order: those that are too close to each other to be told apart get a solution of
//! their own.

use std::ops::Range;

use super::Trial;
use super::exchange::{Event, Exchange};
use crate::loading::plastic::Plastic;
use crate::loading::run::LoadingRun;
use crate::loading::state::ContactEvent;
use crate::loading::tolerances::WindowTolerances;
use crate::loading::tuning::{
    BETWEEN_CORRECTIONS, CONTRADICTED, OF_CHANGE, OF_CHANGE_UNCORRECTED, OF_ERROR, OF_SPACING,
    OF_SPACING_OF_BOTH, OF_WAY, POOR, RATE_ERROR, SAME_GAP, SAME_PIVOT, SAME_RATE,
};
use crate::updater::Iterations;
use crate::{Error, UpdaterError};

/// An event of a window, as far as it is settled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Moment {
    /// Which of the watched nodes.
    pub(super) position: usize,
    pub(super) kind: ContactEvent,
    pub(super) time: f64,
    /// See [`Event::closing`].
    pub(super) closing: f64,
}

impl From<&Event> for Moment {
    fn from(event: &Event) -> Self {
        let &Event { position, kind, time, closing, .. } = event;
        Self { position, kind, time, closing }
    }
}

/// The events of a window in their final order.
#[derive(Debug)]
pub(super) struct Settled {
    pub(super) events: Vec<Moment>,
    /// Estimated error of each time, in the gauge of the kernel.
    pub(super) errors: Vec<f64>,
}

/// Where a window begins.
#[derive(Clone, Copy)]
pub(super) struct Beginning<'a> {
    pub(super) plastic: &'a Plastic,
    pub(super) approach: f64,
    /// Nodes in contact.
    pub(super) count: usize,
    /// Whether no solution can contradict the window.
    pub(super) is_certain: bool,
}

/// Plays the events of a window with its corrected matrix, and estimates their errors. `other` is corrected by its courses alone;
/// `first` is what the events were in the first pass, and the window ends after `time`.
pub(super) fn second_pass(
    (corrected, other, is_updated): (&Exchange, &Exchange, bool),
    (first, time): (&[Event], f64),
) -> Settled {
    let end = time * (1.0 + 1e-9);
    let pass = |window: &Exchange| -> Vec<Moment> {
        let mut window = window.clone();
        window.play(end, usize::MAX, usize::MAX);
        window.events().iter().map(Moment::from).collect()
    };
    let is_same = |a: &Moment, b: &Event| (a.position, a.kind) == (b.position, b.kind);
    let mut events = pass(corrected);
    events.retain(|event| first.iter().any(|other| is_same(event, other)));
    for event in first {
        if !events.iter().any(|other| is_same(other, event)) {
            events.push(Moment { time, ..event.into() });
        }
    }
    let other = pass(other);
    let count = events.len() as f64;
    let change = mean_change(first, &events, time);
    let part = if is_updated { OF_CHANGE } else { OF_CHANGE_UNCORRECTED };
    let yields = first.iter().any(|event| event.kind == ContactEvent::Yield);
    let of_spacing = if yields { OF_SPACING_OF_BOTH } else { OF_SPACING };
    let first: Vec<Moment> = first.iter().map(Moment::from).collect();
    let error = |event: &Moment| {
        let of_rate = RATE_ERROR * event.time / event.closing;
        let changed = part * (distance(&first, event, time) + change);
        let between = BETWEEN_CORRECTIONS * distance(&other, event, time);
        // Of a node that the window before did not watch, and that should have had its event there.
        let late = corrected.own_time(event.position).map_or(0.0, |own| (-own).max(0.0));
        between.max(changed).max(of_spacing * time / count) + of_rate + late
    };
    Settled { errors: events.iter().map(error).collect(), events }
}

/// How far an event is from where a pass has it, in a window that ends after `time`.
fn distance(pass: &[Moment], event: &Moment, time: f64) -> f64 {
    let is_it = |other: &&Moment| (other.position, other.kind) == (event.position, event.kind);
    pass.iter().find(is_it).map_or(time, |found| (found.time - event.time).abs())
}

/// The mean distance of some events from where a pass has them.
pub(super) fn mean_change(pass: &[Event], events: &[Moment], time: f64) -> f64 {
    let pass: Vec<Moment> = pass.iter().map(Moment::from).collect();
    let changes = events.iter().map(|event| distance(&pass, event, time));
    changes.sum::<f64>() / events.len() as f64
}

/// Settles what is too close to be told apart in a window. `None` if a solution is far from what was expected there, unless the window
/// is certain.
pub(super) fn settle(
    run: &mut LoadingRun,
    iterations: &mut dyn Iterations,
    tolerances: &WindowTolerances,
    window: &Exchange,
    settled: Settled,
    beginning: Beginning<'_>,
) -> Result<Option<Settled>, Error> {
    let mut ties = NearTies { window, tolerances, beginning, settled, asked: None };
    let mut next = 0;
    ties.make_orbits_equal(0..ties.settled.events.len());
    while next < ties.settled.events.len() {
        next = match ties.run_from(next) {
            Some(last) if ties.is_orbit(next, last) => last + 1,
            Some(last) => match ties.resolve(run, iterations, next, last)? {
                Some(next) => next,
                None => return Ok(None),
            },
            None => next + 1,
        };
    }
    Ok(Some(ties.settled))
}

/// A window whose events are being settled.
struct NearTies<'a> {
    window: &'a Exchange,
    tolerances: &'a WindowTolerances,
    beginning: Beginning<'a>,
    settled: Settled,
    /// The event that the last solution was for, if it did not settle everything.
    asked: Option<usize>,
}

impl NearTies<'_> {
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
        errors[event] > POOR * (self.beginning.approach + events[event].time)
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

    /// Whether symmetry maps the nodes of two events to each other: they had the same gap or pressure and the same rate when the window
    /// began, they give way alike, and their times are not told apart. Before first touch all nodes close at the same rate, and what
    /// joins first tells them apart: only ties count.
    fn are_images(&self, event: usize, other: usize) -> bool {
        let Settled { events, errors } = &self.settled;
        let tolerances = self.tolerances;
        let (one, two) = (&events[event], &events[other]);
        let places = [one.position, two.position];
        let [(line, is_elastic), (other_line, is_other_elastic)] =
            places.map(|place| self.window.line(place));
        let [own, other_own] = places.map(|place| self.window.pivot(place));
        // Pressures in terms of what they displace.
        let unit = if is_elastic { own.recip() } else { 1.0 };
        let closing = (unit * line[1]).abs();
        let gap = SAME_GAP * tolerances.tolerance * tolerances.length;
        let way = (gap / closing).min(errors[event] + errors[other]);
        let apart = if self.beginning.count == 0 { 0.0 } else { way };
        (one.kind, is_elastic) == (two.kind, is_other_elastic)
            && places[0] != places[1]
            && (one.time - two.time).abs() <= apart.max(tolerances.tie)
            && unit * (line[0] - other_line[0]).abs() <= gap
            && unit * (line[1] - other_line[1]).abs() < SAME_RATE * closing.max(1e-3)
            && (own - other_own).abs() < SAME_PIVOT * own
    }

    /// Whether events are those of nodes that symmetry maps to each other, all of them.
    fn is_orbit(&self, first: usize, last: usize) -> bool {
        let events = &self.settled.events;
        first < last
            && (first..=last).all(|event| !self.is_poor(event))
            && (first + 1..=last).all(|event| {
                events[event].time == events[first].time && self.are_images(first, event)
            })
    }

    /// Gives nodes that symmetry maps to each other their mean time, and the greatest of their errors, in the order of the
    /// nodes.
    fn make_orbits_equal(&mut self, range: Range<usize>) {
        let mut orbits: Vec<Vec<usize>> = Vec::new();
        for event in range.clone() {
            match orbits.iter_mut().find(|orbit| self.are_images(orbit[0], event)) {
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
            let alike = |event: usize| Moment { time, ..events[event] };
            equal.extend(orbit.into_iter().map(|event| (alike(event), error)));
        }
        equal.sort_by(|(a, _), (b, _)| {
            let node = |event: &Moment| self.window.node(event.position);
            a.time.total_cmp(&b.time).then(node(a).cmp(&node(b)))
        });
        for (place, (event, error)) in range.zip(equal) {
            (events[place], errors[place]) = (event, error);
        }
    }

    /// Settles a run of events by the exact gaps and pressures just before it, and returns from which event to go on; `None` if these
    /// contradict what was expected.
    fn resolve(
        &mut self,
        run: &mut LoadingRun,
        iterations: &mut dyn Iterations,
        first: usize,
        last: usize,
    ) -> Result<Option<usize>, Error> {
        let time = self.settled.events[first].time;
        let gap_error = self.sufficient_error(first, last);
        run.timings.ties += 1;
        let count = last + 1 - first;
        let mut positions: Vec<usize> = Vec::with_capacity(count);
        for event in &self.settled.events[first..=last] {
            if !positions.contains(&event.position) {
                positions.push(event.position);
            }
        }
        let values = self.exact_values(run, iterations, (first, &positions), gap_error)?;
        let mut before = self.window.clone();
        let earlier = self.settled.events[..first].iter();
        if before.go_through(earlier.map(|event| (event.position, event.time))).is_err() {
            return Ok(Some(last + 1));
        }
        let mut here = before.remaining(&positions, time, &values);
        // Some may lie a little behind.
        let back = 2.0 * here.earliest().min(0.0);
        here.shift(back);
        here.play(f64::INFINITY, usize::MAX, count);
        if here.events().len() < count {
            return Ok(Some(last + 1));
        }
        let mut events: Vec<Moment> = here
            .events()
            .iter()
            .map(|event| Moment {
                position: positions[event.position],
                time: time + back + event.time,
                ..event.into()
            })
            .collect();
        let is_same = |event: &Moment| {
            let mut of_run = self.settled.events[first..=last].iter();
            of_run.any(|other| (other.position, other.kind) == (event.position, event.kind))
        };
        if !events.iter().all(is_same) {
            return Ok(if self.beginning.is_certain { Some(last + 1) } else { None });
        }
        let exact = gap_error == 0.0;
        let is_open = !self.beginning.is_certain && self.asked != Some(first);
        if is_open && (first..=last).any(|event| self.is_contradicted(event, &events)) {
            return Ok(None);
        }
        if exact {
            self.order_ties(&mut events);
        }
        let start = events[0].time;
        let left = gap_error + 2.0 * self.tolerances.tolerance * (self.beginning.approach + time);
        for (k, event) in events.iter().enumerate() {
            self.settled.errors[first + k] = OF_WAY * (event.time - start) + left / event.closing;
        }
        self.settled.events[first..=last].copy_from_slice(&events);
        self.make_orbits_equal(first..last + 1);
        // Far behind the solution it may not be enough, or the solution was not exact enough.
        let again = (first + usize::from(exact)..last).find(|&event| {
            let spacing = self.settled.events[event + 1].time - self.settled.events[event].time;
            (spacing > self.tolerances.tie || !exact) && self.is_close(event)
        });
        self.asked = again;
        Ok(Some(again.unwrap_or(last + 1)))
    }

    /// Whether an event was expected far from where it is among those that were found.
    fn is_contradicted(&self, event: usize, found: &[Moment]) -> bool {
        let Settled { events, errors } = &self.settled;
        let most = CONTRADICTED * (errors[event] + self.tolerances.tie);
        distance(found, &events[event], f64::INFINITY) > most
    }

    /// The error of gaps with which most runs of events are settled, and after that none.
    fn sufficient_error(&self, first: usize, last: usize) -> f64 {
        if self.asked == Some(first) {
            return 0.0;
        }
        let Settled { events, errors } = &self.settled;
        let least = errors[first..=last].iter().copied().fold(f64::INFINITY, f64::min);
        let rates = events[first..=last].iter().map(|event| event.closing);
        OF_ERROR * least * rates.fold(f64::INFINITY, f64::min)
    }

    /// Events that are ties get the time of the first, and come in the order of their nodes.
    fn order_ties(&self, events: &mut [Moment]) {
        let tie = self.tolerances.tie;
        for tied in events.chunk_by_mut(|a, b| b.time - a.time < tie) {
            let first = tied[0].time;
            // A node touches before it yields.
            tied.sort_by_key(|event| {
                (self.window.node(event.position), event.kind == ContactEvent::Yield)
            });
            for event in tied {
                event.time = first;
            }
        }
    }

    /// Gaps of nodes out of contact and pressures of those in it, all events before one done, at the time of that.
    fn exact_values(
        &self,
        run: &LoadingRun,
        iterations: &mut dyn Iterations,
        (first, positions): (usize, &[usize]),
        gap_error: f64,
    ) -> Result<Vec<f64>, Error> {
        let Beginning { plastic, approach, .. } = self.beginning;
        let events = self.settled.events[..first].iter();
        let events = events.map(|event| (self.window.node(event.position), event.kind));
        let trial = Trial::of(run, plastic, events)?;
        let approach = approach + self.settled.events[first].time;
        let yielded = trial.pressures(plastic);
        let behind = trial.behind(&yielded, approach);
        let solved = iterations.probe_behind(&behind, gap_error)?;
        let (pressure, [displacement, _]) = (&solved.solution.pressure, &solved.displacement);
        let nodes = run.problem.grid().nodes();
        UpdaterError::check_length("displacements", displacement.len(), nodes)?;
        UpdaterError::check_length("pressures", pressure.len(), trial.contact.len())?;
        if !displacement.iter().chain(pressure).copied().all(f64::is_finite) {
            return Err(run.not_finite());
        }
        let gap = trial.problem.initial_gap();
        let value = |&position: &usize| {
            let node = self.window.node(position);
            match trial.contact.order().iter().position(|&other| other == node) {
                Some(place) => pressure[place],
                None => gap[node] + displacement[node] - approach,
            }
        };
        Ok(positions.iter().map(value).collect())
    }
}

impl Exchange {
    /// When the first of the nodes touches or yields by its own course, from the beginning on; it may lie behind.
    fn earliest(&self) -> f64 {
        let times = (0..self.len()).filter_map(|position| self.own_time(position));
        times.fold(f64::INFINITY, f64::min)
    }
}
