//! Events that are too close to each other to be told apart without a solution of their own.

use crate::loading::tuning::{
    BETWEEN_CORRECTIONS, CONTRADICTED, OF_CHANGE, OF_CHANGE_UNCORRECTED, OF_ERROR, OF_SPACING,
    OF_WAY, POOR, RATE_ERROR, SAME_GAP, SAME_PIVOT, SAME_RATE,
};
use std::ops::Range;

use super::correction::Correction;
use crate::loading::gap_field::GapLine;
use crate::loading::run::{LoadingRun, Mark};
use crate::loading::tolerances::WindowTolerances;
use crate::loading::window::{Course, Window, WindowEvent};
use crate::updater::Iterations;
use crate::{Error, UpdaterError};

/// The events of a window in their final order.
#[derive(Debug)]
pub(super) struct Settled {
    pub(super) events: Vec<WindowEvent>,
    /// Estimated error of each time, in the gauge of the kernel.
    pub(super) errors: Vec<f64>,
}

/// Settles what is too close to be told apart in a window, which began at a mark. `None` if a solution is far from
/// what was expected there, unless the window is `is_certain`.
pub(super) fn settle(
    run: &mut LoadingRun,
    iterations: &mut dyn Iterations,
    tolerances: &WindowTolerances,
    (window, correction): (&Window, &Correction),
    settled: Settled,
    (mark, is_certain): (&Mark, bool),
) -> Result<Option<Settled>, Error> {
    let mut ties = NearTies {
        window,
        correction,
        tolerances,
        count: mark.count,
        approach: mark.scalars.approach(),
        settled,
        is_certain,
        asked: None,
    };
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

/// Plays the events that joined under the corrected Schur complement, and estimates their errors. `first` is
/// what they were in the first pass, `joined` the positions of the nodes that joined, and the window ends after
/// `time`.
pub(super) fn second_pass(
    window: &Window,
    correction: &Correction,
    (first, joined, time): (&[WindowEvent], &[usize], f64),
) -> Settled {
    let end = time * (1.0 + 1e-9);
    let pass = |window: &Window| {
        let mut window = window.clone();
        window.play_until(end);
        window.events().to_vec()
    };
    let mut events = pass(&correction.window);
    events.retain(|event| joined.contains(&event.position));
    for &position in joined {
        if !events.iter().any(|event| event.position == position) {
            events.push(WindowEvent { position, time });
        }
    }
    let other = pass(&correction.by_courses);
    let count = events.len() as f64;
    let change = mean_change(first, &events, time);
    let part = if correction.is_updated { OF_CHANGE } else { OF_CHANGE_UNCORRECTED };
    let error = |event: &WindowEvent| {
        let closing = window.course(event.position).line.closing;
        let of_rate = RATE_ERROR * event.time / closing;
        let changed = part * (distance(first, event, time) + change);
        let between = BETWEEN_CORRECTIONS * distance(&other, event, time);
        between.max(changed).max(OF_SPACING * time / count) + of_rate
    };
    Settled { errors: events.iter().map(error).collect(), events }
}

/// How far an event is from where a pass has it, in a window that ends after `time`.
fn distance(pass: &[WindowEvent], event: &WindowEvent, time: f64) -> f64 {
    let found = pass.iter().find(|other| other.position == event.position);
    found.map_or(time, |found| (found.time - event.time).abs())
}

/// The mean distance of some events from where a pass has them.
pub(super) fn mean_change(pass: &[WindowEvent], events: &[WindowEvent], time: f64) -> f64 {
    let changes = events.iter().map(|event| distance(pass, event, time));
    changes.sum::<f64>() / events.len() as f64
}

/// A window whose events are being settled.
struct NearTies<'a> {
    window: &'a Window,
    correction: &'a Correction,
    tolerances: &'a WindowTolerances,
    /// Nodes in contact, and the approach, at the window's beginning.
    count: usize,
    approach: f64,
    settled: Settled,
    /// Whether no solution can contradict it.
    is_certain: bool,
    /// The event that the last solution was for, if it did not settle everything.
    asked: Option<usize>,
}

impl NearTies<'_> {
    /// The node of an event.
    fn node(&self, event: usize) -> usize {
        self.window.node(self.settled.events[event].position)
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
        let tolerances = self.tolerances;
        let places = [event, other].map(|event| events[event].position);
        let [line, other_line] = places.map(|place| self.window.course(place).line);
        let [own, other_own] = places.map(|p| self.correction.window.schur().entry(p, p));
        let gap = SAME_GAP * tolerances.tolerance * tolerances.length;
        let way = (gap / line.closing).min(errors[event] + errors[other]);
        let apart = if self.count == 0 { 0.0 } else { way };
        (events[event].time - events[other].time).abs() <= apart.max(tolerances.tie)
            && (line.gap - other_line.gap).abs() <= gap
            && (line.closing - other_line.closing).abs() < SAME_RATE * line.closing.max(1e-3)
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
            let alike = |event: usize| WindowEvent { time, ..events[event] };
            equal.extend(orbit.into_iter().map(|event| (alike(event), error)));
        }
        let nodes = self.window.nodes();
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
        let gaps = self.exact_gaps(run, iterations, first, gap_error)?;
        let before: Vec<usize> =
            (first..=last).map(|event| self.settled.events[event].position).collect();
        let gaps: Vec<f64> = before.iter().map(|&p| gaps(self.window.node(p))).collect();
        let Some(mut here) = self.eliminated(first, &before, &gaps)? else {
            return Ok(Some(last + 1));
        };
        let rates: Vec<f64> = here.courses().map(|course| course.line.closing).collect();
        // Some may lie a little behind.
        let lines = gaps.iter().zip(&rates);
        let earliest = lines.map(|(gap, rate)| gap / rate);
        let back = 2.0 * earliest.fold(0.0, f64::min);
        let moved: Vec<Course> = here
            .courses()
            .map(|Course { line, .. }| {
                let gap = line.gap - back * line.closing;
                GapLine { gap, ..*line }.into()
            })
            .collect();
        here.set_courses(moved.into_iter());
        here.play(before.len());
        if here.events().len() < before.len() {
            return Ok(Some(last + 1));
        }
        let mut events: Vec<WindowEvent> = here
            .events()
            .iter()
            .map(|event| WindowEvent {
                position: before[event.position],
                time: time + back + event.time,
            })
            .collect();
        let exact = gap_error == 0.0;
        let is_open = !self.is_certain && self.asked != Some(first);
        if is_open && (first..=last).any(|event| self.is_contradicted(event, &events)) {
            return Ok(None);
        }
        if exact {
            self.order_ties(&mut events);
        }
        let start = events[0].time;
        let left = gap_error + 2.0 * self.tolerances.tolerance * (self.approach + time);
        for (k, event) in events.iter().enumerate() {
            let place = before.iter().position(|position| *position == event.position);
            let rate = rates[place.unwrap_or_default()];
            self.settled.errors[first + k] = OF_WAY * (event.time - start) + left / rate;
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
    fn is_contradicted(&self, event: usize, found: &[WindowEvent]) -> bool {
        let Settled { events, errors } = &self.settled;
        let most = CONTRADICTED * (errors[event] + self.tolerances.tie);
        distance(found, &events[event], f64::INFINITY) > most
    }

    /// The error of gaps with which most runs of events are settled, and after that none.
    fn sufficient_error(&self, first: usize, last: usize) -> f64 {
        if self.asked == Some(first) {
            return 0.0;
        }
        let errors = &self.settled.errors[first..=last];
        let least = errors.iter().copied().fold(f64::INFINITY, f64::min);
        let events = &self.settled.events[first..=last];
        let line = |event: &WindowEvent| self.window.course(event.position).line;
        let rates = events.iter().map(|event| line(event).closing);
        OF_ERROR * least * rates.fold(f64::INFINITY, f64::min)
    }

    /// Events that are ties get the time of the first, and come in the order of their nodes.
    fn order_ties(&self, events: &mut [WindowEvent]) {
        let (nodes, tie) = (self.window.nodes(), self.tolerances.tie);
        for tied in events.chunk_by_mut(|a, b| b.time - a.time < tie) {
            let first = tied[0].time;
            tied.sort_by_key(|event| nodes[event.position]);
            for event in tied {
                event.time = first;
            }
        }
    }

    /// The gaps of all nodes, all events before one done, at the time of that.
    fn exact_gaps<'r>(
        &self,
        run: &'r mut LoadingRun,
        iterations: &mut dyn Iterations,
        first: usize,
        gap_error: f64,
    ) -> Result<impl Fn(usize) -> f64 + 'r, Error> {
        let events = 0..self.settled.events.len();
        let order: Vec<usize> = events.map(|event| self.node(event)).collect();
        run.rearrange(self.count, &order)?;
        let approach = self.approach + self.settled.events[first].time;
        let (problem, contact) = (&run.problem, &run.contact);
        let count = self.count + first;
        let displacement = iterations.probe(problem, contact, count, approach, gap_error)?;
        let nodes = problem.grid().nodes();
        UpdaterError::check_length("displacements", displacement.len(), nodes)?;
        if !displacement.iter().copied().all(f64::is_finite) {
            return Err(run.not_finite());
        }
        Ok(move |node: usize| problem.initial_gap()[node] + displacement[node] - approach)
    }

    /// The window of some nodes, all events before the one at `first` eliminated, at the time of that, when their gaps are `gaps`;
    /// `None` if a pivot is not positive.
    fn eliminated(
        &self,
        first: usize,
        positions: &[usize],
        gaps: &[f64],
    ) -> Result<Option<Window>, Error> {
        let mut window = self.correction.window.clone();
        for event in &self.settled.events[..first] {
            if window.touch(event.position, event.time).is_err() {
                return Ok(None);
            }
        }
        let time = self.settled.events[first].time;
        window.remaining(positions, time, gaps).map(Some)
    }
}

#[cfg(test)]
mod tests;
