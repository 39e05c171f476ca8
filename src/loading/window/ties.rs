//! The events of a corrected window in their final order: those that are too close to each other to be told apart get a
//! solution of their own.

use std::ops::Range;

use super::correction::Correction;
use super::{Window, WindowEvent};
use crate::Error;
use crate::loading::state::ContactEvent;
use crate::loading::tolerances::WindowTolerances;
use crate::loading::tuning::{
    BETWEEN_CORRECTIONS, CONTRADICTED, OF_CHANGE, OF_CHANGE_UNCORRECTED, OF_ERROR, OF_RESIDUAL,
    OF_SPACING, OF_SPACING_OF_BOTH, OF_WAY, POOR, RATE_ERROR, SAME_GAP, SAME_PIVOT, SAME_RATE,
};

/// The events of a window in their final order.
#[derive(Debug)]
pub(in crate::loading) struct Settled {
    pub(in crate::loading) events: Vec<WindowEvent>,
    /// Estimated error of each time, in the gauge of the kernel.
    pub(in crate::loading) errors: Vec<f64>,
}

/// Where a window begins.
#[derive(Debug, Clone, Copy)]
pub(in crate::loading) struct Beginning {
    pub(in crate::loading) approach: f64,
    /// Nodes in contact.
    pub(in crate::loading) count: usize,
    /// Whether no solution can contradict the window.
    pub(in crate::loading) is_certain: bool,
}

/// A moment that is to be solved for.
#[derive(Debug, Clone, Copy)]
pub(in crate::loading) struct Question<'a> {
    /// All events of the window in the order known so far, of which the first ones are done.
    pub(in crate::loading) events: &'a [WindowEvent],
    pub(in crate::loading) done: usize,
    /// How exactly gaps are to be known \[m\].
    pub(in crate::loading) error: f64,
}

impl Question<'_> {
    /// How much further the approach is than where the window began.
    pub(in crate::loading) fn time(&self) -> f64 {
        self.events[self.done].time
    }
}

/// Plays the events of a window with its corrected matrix, and estimates their errors. `first` is what the events were
/// in the first pass, and it ends after `time`.
pub(in crate::loading) fn second_pass(
    correction: &Correction,
    first: &[WindowEvent],
    time: f64,
) -> Settled {
    let Correction { window, by_courses, is_updated } = correction;
    let end = time * (1.0 + 1e-9);
    let pass = |window: &Window| {
        let mut window = window.clone();
        window.play_until(end);
        window.events().to_vec()
    };
    let mut events = pass(window);
    events.retain(|event| first.iter().any(|other| other.is(event)));
    for event in first {
        if !events.iter().any(|other| other.is(event)) {
            events.push(WindowEvent { time, ..*event });
        }
    }
    let other = pass(by_courses);
    let count = events.len() as f64;
    let change = mean_change(first, &events, time);
    let part = if *is_updated { OF_CHANGE } else { OF_CHANGE_UNCORRECTED };
    let yields = first.iter().any(|event| event.kind == ContactEvent::Yield);
    let of_spacing = if yields { OF_SPACING_OF_BOTH } else { OF_SPACING };
    let error = |event: &WindowEvent| {
        let of_rate = RATE_ERROR * event.time / window.closing(event);
        let changed = part * (distance(first, event, time) + change);
        let between = BETWEEN_CORRECTIONS * distance(&other, event, time);
        // Of a node that the window before did not watch, and that should have had its event there.
        let late = window.own_time(event.position).map_or(0.0, |own| (-own).max(0.0));
        between.max(changed).max(of_spacing * time / count) + of_rate + late
    };
    Settled { errors: events.iter().map(error).collect(), events }
}

/// How far an event is from where a pass has it, in a window that ends after `time`.
fn distance(pass: &[WindowEvent], event: &WindowEvent, time: f64) -> f64 {
    let found = pass.iter().find(|other| other.is(event));
    found.map_or(time, |found| (found.time - event.time).abs())
}

/// The mean distance of some events from where a pass has them.
pub(in crate::loading) fn mean_change(
    pass: &[WindowEvent],
    events: &[WindowEvent],
    time: f64,
) -> f64 {
    let changes = events.iter().map(|event| distance(pass, event, time));
    changes.sum::<f64>() / events.len() as f64
}

/// Settles what is too close to be told apart in a window. `solve` answers with the gap of each node out of contact and
/// the pressure of each in it. `None` if a solution is far from what was expected there, unless the window is certain.
pub(in crate::loading) fn settle(
    window: &Window,
    tolerances: &WindowTolerances,
    settled: Settled,
    beginning: Beginning,
    mut solve: impl FnMut(Question<'_>, &[usize]) -> Result<Vec<f64>, Error>,
) -> Result<Option<Settled>, Error> {
    let mut ties = Ties { window, tolerances, beginning, settled, asked: None };
    let mut next = 0;
    ties.make_orbits_equal(0..ties.settled.events.len());
    while next < ties.settled.events.len() {
        next = match ties.run_from(next) {
            Some(last) if ties.is_orbit(next, last) => last + 1,
            Some(last) => match ties.resolve(next, last, &mut solve)? {
                Some(next) => next,
                None => return Ok(None),
            },
            None => next + 1,
        };
    }
    Ok(Some(ties.settled))
}

/// A corrected window whose events are being settled.
struct Ties<'a> {
    window: &'a Window,
    tolerances: &'a WindowTolerances,
    beginning: Beginning,
    settled: Settled,
    /// The event that the last solution was for, if it did not settle everything.
    asked: Option<usize>,
}

impl Ties<'_> {
    /// Whether an event and the next one are closer than their errors.
    fn is_close(&self, event: usize) -> bool {
        let Settled { events, errors } = &self.settled;
        events
            .get(event + 1)
            .is_some_and(|next| next.time - events[event].time < errors[event] + errors[event + 1])
    }

    /// Whether an event's error is too great in itself.
    fn is_poor(&self, event: usize) -> bool {
        self.settled.errors[event] > self.greatest_error(event)
    }

    /// The greatest error that an event may have in itself.
    fn greatest_error(&self, event: usize) -> f64 {
        POOR * (self.beginning.approach + self.settled.events[event].time)
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

    /// Whether symmetry maps the nodes of two events to each other: they had the same gap or pressure and the same rate
    /// when the window began, they give way alike, and their times are not told apart. Before first touch all nodes
    /// close at the same rate, and what joins first tells them apart: only ties count.
    fn are_images(&self, event: usize, other: usize) -> bool {
        let Settled { events, errors } = &self.settled;
        let (window, tolerances) = (self.window, self.tolerances);
        let (one, two) = (&events[event], &events[other]);
        let places = [one.position, two.position];
        let [line, other_line] = places.map(|place| window.course(place).line);
        let [own, other_own] = places.map(|place| window.pivot(place).abs());
        // Pressures in terms of what they displace.
        let is_elastic = window.is_elastic(places[0]);
        let unit = if is_elastic { own.recip() } else { 1.0 };
        let closing = (unit * line.closing).abs();
        let gap = SAME_GAP * tolerances.tolerance * tolerances.length;
        let way = (gap / closing).min(errors[event] + errors[other]);
        let apart = if self.beginning.count == 0 { 0.0 } else { way };
        (one.kind, is_elastic) == (two.kind, window.is_elastic(places[1]))
            && (event == other || places[0] != places[1])
            && (one.time - two.time).abs() <= apart.max(tolerances.tie)
            && unit * (line.gap - other_line.gap).abs() <= gap
            && unit * (line.closing - other_line.closing).abs() < SAME_RATE * closing.max(1e-3)
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

    /// Gives nodes that symmetry maps to each other their mean time, and the greatest of their errors, in the order of
    /// the nodes.
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
        // Where images yield apart, the mean time of their touches may lie behind the yield of one.
        let yields_first = equal.iter().enumerate().any(|(k, (event, _))| {
            event.kind == ContactEvent::Yield
                && equal[k + 1..].iter().any(|(later, _)| later.position == event.position)
        });
        if yields_first {
            return;
        }
        for (place, (event, error)) in range.zip(equal) {
            (events[place], errors[place]) = (event, error);
        }
    }

    /// Settles a run of events by the exact gaps and pressures just before it, and returns from which event to go on;
    /// `None` if these contradict what was expected.
    fn resolve(
        &mut self,
        first: usize,
        last: usize,
        solve: &mut impl FnMut(Question<'_>, &[usize]) -> Result<Vec<f64>, Error>,
    ) -> Result<Option<usize>, Error> {
        let error = self.sufficient_error(first, last);
        let question = Question { events: &self.settled.events, done: first, error };
        let time = question.time();
        let in_run = &self.settled.events[first..=last];
        let mut positions: Vec<usize> = Vec::with_capacity(in_run.len());
        for event in in_run {
            // A node may touch and yield.
            if !positions.contains(&event.position) {
                positions.push(event.position);
            }
        }
        let nodes: Vec<usize> = positions.iter().map(|&place| self.window.node(place)).collect();
        let values = solve(question, &nodes)?;
        let Some(mut here) = self.eliminated(first, &positions, &values)? else {
            return Ok(Some(last + 1));
        };
        // Some gaps may have closed a little before.
        let own = (0..positions.len()).filter_map(|place| here.own_time(place));
        let back = 2.0 * own.fold(0.0, f64::min);
        here.move_back(-back);
        let begun = here.clone();
        here.play(in_run.len());
        if here.events().len() < in_run.len() {
            return Ok(Some(last + 1));
        }
        let found = here.events().iter().map(|event| WindowEvent {
            position: positions[event.position],
            time: time + back + event.time,
            ..*event
        });
        let mut events: Vec<WindowEvent> = found.collect();
        let is_certain = self.beginning.is_certain;
        if !events.iter().all(|event| in_run.iter().any(|other| other.is(event))) {
            return Ok(is_certain.then_some(last + 1));
        }
        let is_open = !is_certain && self.asked != Some(first);
        if is_open && (first..=last).any(|event| self.is_contradicted(event, &events)) {
            return Ok(None);
        }
        let exact = error == 0.0;
        if exact {
            self.order_ties(&mut events);
        }
        let start = events[0].time;
        let solved = self.tolerances.tolerance * (self.beginning.approach + time);
        for (k, event) in events.iter().enumerate() {
            let closing = match positions.iter().position(|&place| place == event.position) {
                Some(place) => begun.closing(&WindowEvent { position: place, ..*event }),
                None => event.closing,
            };
            // A pressure is off by more of what is left of gaps than a gap is.
            let part = if event.kind == ContactEvent::Yield { OF_RESIDUAL } else { 2.0 };
            let left = error + part * solved;
            self.settled.errors[first + k] = OF_WAY * (event.time - start) + left / closing;
        }
        self.settled.events[first..=last].copy_from_slice(&events);
        self.make_orbits_equal(first..last + 1);
        // Far behind the solution its errors may be too great to settle the rest, or it was not exact enough.
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
        let Settled { events, errors } = &self.settled;
        // Errors may be those of events far behind: the first one must not stay poor.
        let least = errors[first..=last].iter().copied().fold(f64::INFINITY, f64::min);
        let least = least.min(self.greatest_error(first));
        let rates = events[first..=last].iter().map(|event| self.window.closing(event));
        OF_ERROR * least * rates.fold(f64::INFINITY, f64::min)
    }

    /// Events that are ties get the time of the first, and come in the order of their nodes.
    fn order_ties(&self, events: &mut [WindowEvent]) {
        let (nodes, tie) = (self.window.nodes(), self.tolerances.tie);
        for tied in events.chunk_by_mut(|a, b| b.time - a.time < tie) {
            let first = tied[0].time;
            // A node touches before it yields.
            tied.sort_by_key(|event| (nodes[event.position], event.kind == ContactEvent::Yield));
            for event in tied {
                event.time = first;
            }
        }
    }

    /// The window of some nodes, all events before the one at `first` eliminated, at the time of that, when their gaps
    /// or pressures are `values`; `None` if a pivot has the wrong sign.
    fn eliminated(
        &self,
        first: usize,
        positions: &[usize],
        values: &[f64],
    ) -> Result<Option<Window>, Error> {
        let mut window = self.window.clone();
        for event in &self.settled.events[..first] {
            if window.happen(event.position, event.time).is_err() {
                return Ok(None);
            }
        }
        let time = self.settled.events[first].time;
        window.remaining(positions, time, values).map(Some)
    }
}

#[cfg(test)]
mod tests;
