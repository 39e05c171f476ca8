//! Windows on bodies on which nodes may leave: until one does.
//!
//! Nodes only touch in such a window. It ends before the first pressure falls to zero, as far as the lines at its
//! beginning tell, and its end is a solution that is checked as on other bodies, and for tension everywhere. In between
//! pressures and gaps are lines from one event to the next, so that a node that has left or touched and is back at the
//! end is found by looking at each event. There, the pressures on the nodes that have touched so far follow from the
//! corrected Schur complement, what they take off the contact near them from local solutions, and what these leave out
//! at the end is added as a cubic in time. What is too close to zero to be told counts as contradicted: then the window
//! ends before, in the end with single events that have solutions of their own.

use crate::contact::ContactSequence;
use crate::loading::gap_field::GapLine;
use crate::loading::ranking::Ranking;
use crate::loading::run::LoadingRun;
use crate::loading::tolerances::WindowTolerances;
use crate::loading::tuning::{FURTHEST, LEAST_RATE, NEARLY_LEFT, UNCERTAIN};
use crate::loading::window::{Window, WindowEvent};
use crate::updater::{Iterations, Schur, Solution, WindowFactor};

/// What has become of an attempt to make a window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::loading) enum Attempt {
    /// A window of states.
    Made,
    /// None, but the solution is another one than before.
    Failed,
    /// None was begun: the next event takes a solution of its own.
    NotBegun,
}

/// Pressures and gaps when a window begins.
pub(super) struct AtStart {
    /// Pressure and rate of the contact.
    pressures: Vec<[f64; 2]>,
    /// Of nodes that are not watched and that might touch.
    gaps: Vec<(usize, GapLine)>,
}

/// The watched nodes that have touched, by events and at the end of the window.
struct Course {
    /// Where they are among the watched ones.
    positions: Vec<usize>,
    /// Times of the second event, the next ones, and of the end.
    times: Vec<f64>,
    /// Their pressures then, as many as have touched before.
    pressures: Vec<Vec<f64>>,
    /// The rates of their pressures at the end.
    rates: Vec<f64>,
}

/// When the pressure of the first node in contact falls to zero if no node touches before.
pub(super) fn first_release(run: &LoadingRun) -> f64 {
    let slowest = -LEAST_RATE * run.greatest_rate();
    let Solution { pressure, rate } = run.field.solution();
    let falling = pressure.iter().zip(rate).filter(|(_, rate)| **rate < slowest);
    falling.map(|(pressure, rate)| -pressure / rate).fold(f64::INFINITY, f64::min)
}

impl AtStart {
    pub(super) fn of(run: &LoadingRun, ranking: &Ranking, window: &Window) -> Self {
        let Solution { pressure, rate } = run.field.solution();
        let furthest = FURTHEST * window.horizon();
        let near = ranking.iter().filter(|(time, _)| *time <= furthest);
        let near = near.map(|&(_, node)| node).filter(|&node| window.position(node).is_none());
        Self {
            pressures: pressure.iter().zip(rate).map(|(&p, &rate)| [p, rate]).collect(),
            gaps: near.map(|node| (node, run.line(node))).collect(),
        }
    }

    /// The time up to which no pressure was negative, by lines from the start to the solution on a contact at an
    /// approach, which is that after `time`; `None` if none is negative there.
    pub(super) fn sound_until(
        &self,
        run: &LoadingRun,
        tension: f64,
        (contact, approach): (&ContactSequence, f64),
        time: f64,
    ) -> Option<f64> {
        let now = run.field.pressures(contact, approach);
        let pairs = self.pressures.iter().zip(now);
        let negative = pairs.filter(|(_, (_, now))| *now < -tension);
        let times = negative.map(|([before, _], (_, now))| time * before / (before - now));
        times.reduce(f64::min)
    }

    /// Until when nothing contradicts a corrected window and its events between its beginning and its end after `span`,
    /// where the solution on a contact is; `None` if nothing does at all.
    pub(super) fn sound_between(
        &self,
        run: &LoadingRun,
        iterations: &dyn Iterations,
        tolerances: &WindowTolerances,
        (window, events): (&Window, &[WindowEvent]),
        (contact, span): (&ContactSequence, f64),
    ) -> Option<f64> {
        if events.len() < 2 {
            return None;
        }
        let approach = run.scalars.approach() + span;
        let overlap = tolerances.overlap(approach);
        let tension = overlap / run.problem.table().self_influence();
        let Some(course) = Course::of(window, events, span) else {
            return Some(0.5 * span);
        };
        let first = events[0].time;
        let of_watched = course.watched_until(window, (first, overlap), tension);
        let answers = iterations.answers();
        let of_contact = self.contact_until(run, contact, &course, &answers, (first, tension));
        let until = of_watched.min(of_contact);
        if until < span {
            return Some(until);
        }
        self.outside_until(run, approach, &course, &answers, (window, overlap))
    }

    /// Until when no node that was in contact has lost its pressure; infinity if none does.
    fn contact_until(
        &self,
        run: &LoadingRun,
        contact: &ContactSequence,
        course: &Course,
        answers: &[(&[u32], &[f64])],
        (first, tension): (f64, f64),
    ) -> f64 {
        // What unit pressures on nodes that touched take off the contact, by its nodes.
        let mut places = vec![usize::MAX; run.problem.grid().nodes()];
        let before = &contact.order()[..self.pressures.len()];
        for (place, &node) in before.iter().enumerate() {
            places[node] = place;
        }
        let mut taken: Vec<(usize, usize, f64)> = Vec::new();
        for (event, &position) in course.positions.iter().enumerate() {
            let (nodes, weights) = answers.get(position).copied().unwrap_or_default();
            for (&node, &weight) in nodes.iter().zip(weights) {
                taken.push((places[node as usize], event, -weight));
            }
        }
        taken.sort_unstable_by_key(|&(place, event, _)| (place, event));
        let Solution { pressure, rate } = run.field.solution();
        let mut until = f64::INFINITY;
        for of_node in taken.chunk_by(|a, b| a.0 == b.0) {
            let place = of_node[0].0;
            let Some(&[value, slope]) = self.pressures.get(place) else {
                continue;
            };
            let terms: Vec<(usize, f64)> =
                of_node.iter().map(|&(_, event, w)| (event, w)).collect();
            let end = [pressure[place], rate[place]];
            let time = course.sound_until(([value, slope], end), &terms, (first, tension));
            until = until.min(time);
        }
        until
    }

    /// When the first node touches that was not watched, before the solution at an approach; `None` if none does.
    fn outside_until(
        &self,
        run: &LoadingRun,
        approach: f64,
        course: &Course,
        answers: &[(&[u32], &[f64])],
        (window, overlap): (&Window, f64),
    ) -> Option<f64> {
        let table = run.problem.table();
        let bounds = course.bounds(window.schur(), table.self_influence());
        let span = course.span();
        let mut until = None;
        for &(node, GapLine { gap, closing }) in &self.gaps {
            let end = run.field.line(&run.problem, node, approach);
            let is_safe = course.times.iter().zip(&bounds).all(|(time, bound)| {
                let way = time / span;
                gap + way * (end.gap - gap) > bound + overlap
            });
            if is_safe {
                continue;
            }
            let own = table.place(node);
            let acts = |&position: &usize| {
                let (nodes, weights) = answers.get(position).copied().unwrap_or_default();
                let answer = nodes.iter().zip(weights);
                let answer = answer
                    .map(|(&other, x)| x * table.between(own, table.place(other as usize)))
                    .sum::<f64>();
                table.between(own, table.place(window.node(position))) - answer
            };
            let terms: Vec<(usize, f64)> = course.positions.iter().map(acts).enumerate().collect();
            let ends = ([gap, -closing], [end.gap, -end.closing]);
            let time = course.sound_until(ends, &terms, (0.0, -overlap));
            if time < span {
                until = Some(until.map_or(time, |until: f64| until.min(time)));
            }
        }
        until
    }
}

impl Course {
    /// `None` if a pivot is not positive.
    fn of(window: &Window, events: &[WindowEvent], span: f64) -> Option<Self> {
        let positions: Vec<usize> = events.iter().map(|event| event.position).collect();
        let factor = WindowFactor::of(window.schur().clone(), &positions).ok()?;
        let times: Vec<f64> = events[1..].iter().map(|event| event.time).chain([span]).collect();
        let at = |(count, &time): (usize, &f64)| {
            let overlap = |&position: &usize| [-window.course(position).gap(time)];
            let mut pressures: Vec<[f64; 1]> = positions[..count].iter().map(overlap).collect();
            factor.solve_both(&mut pressures);
            pressures.into_iter().flatten().collect()
        };
        let pressures = (1..).zip(&times).map(at).collect();
        let mut rates: Vec<[f64; 1]> =
            positions.iter().map(|&position| [window.course(position).closing(span)]).collect();
        factor.solve_both(&mut rates);
        let rates = rates.into_iter().flatten().collect();
        Some(Self { positions, times, pressures, rates })
    }

    fn span(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    /// The sum of some terms (event, factor) at the time number k.
    fn sum(&self, k: usize, terms: &[(usize, f64)]) -> f64 {
        let pressures = &self.pressures[k];
        terms.iter().map(|&(event, factor)| factor * pressures.get(event).unwrap_or(&0.0)).sum()
    }

    /// Until when a value stays above `least` that begins and ends with values and slopes, and that pressures on nodes
    /// that touched change by some terms; infinity if it does throughout. The first event is at `first`.
    fn sound_until(
        &self,
        ([value, slope], end): ([f64; 2], [f64; 2]),
        terms: &[(usize, f64)],
        (first, least): (f64, f64),
    ) -> f64 {
        let (span, last) = (self.span(), self.times.len() - 1);
        let rate: f64 = terms.iter().map(|&(event, factor)| factor * self.rates[event]).sum();
        let missing = end[0] - (value + span * slope + self.sum(last, terms));
        let missing_slope = (end[1] - slope - rate) * span;
        let (a, b) = (3.0 * missing - missing_slope, missing_slope - 2.0 * missing);
        let most = UNCERTAIN * missing.abs().max(missing_slope.abs());
        let mut before = (first, f64::INFINITY);
        for (k, &time) in self.times[..last].iter().enumerate() {
            let way = time / span;
            let change = self.sum(k, terms);
            let found = value + time * slope + change + way * way * (a + b * way);
            let left = found - most * 4.0 * way * (1.0 - way) - NEARLY_LEFT * change.abs() - least;
            if left < 0.0 {
                let part = if before.1.is_finite() { before.1 / (before.1 - left) } else { 1.0 };
                return before.0 + 0.5 * part * (time - before.0);
            }
            before = (time, left);
        }
        f64::INFINITY
    }

    /// Until when the nodes that touched keep their pressures, and the other watched ones stay open.
    fn watched_until(&self, window: &Window, (first, overlap): (f64, f64), tension: f64) -> f64 {
        let last = self.times.len() - 1;
        let mut greatest = vec![0.0_f64; self.positions.len()];
        let open = |position: &usize| !self.positions.contains(position);
        let open: Vec<usize> = (0..window.nodes().len()).filter(open).collect();
        let mut before = first;
        for (k, &time) in self.times[..last].iter().enumerate() {
            let pressures = &self.pressures[k];
            let is_kept = pressures.iter().zip(&mut greatest).all(|(&pressure, greatest)| {
                *greatest = greatest.max(pressure);
                pressure >= NEARLY_LEFT * *greatest - tension
            });
            let schur = window.schur();
            let gap = |position: usize| {
                let joined = self.positions.iter().zip(pressures);
                let carried = joined.map(|(&other, p)| schur.entry(position, other) * p);
                window.course(position).gap(time) + carried.sum::<f64>()
            };
            if !is_kept || open.iter().any(|&position| gap(position) < -overlap) {
                return 0.5 * (before + time);
            }
            before = time;
        }
        f64::INFINITY
    }

    /// By how much the gap of any node may be below the chord from the beginning to the end, at each time. With δp, the
    /// pressures less the chord of theirs, it is `|S_oj δp_j| ≤ √(S_oo δpᵀ S δp)` at most, for S is positive definite,
    /// and S_oo is no greater than C(0, 0).
    fn bounds(&self, schur: &Schur, self_influence: f64) -> Vec<f64> {
        let (span, end) = (self.span(), &self.pressures[self.times.len() - 1]);
        let bound = |(time, pressures): (&f64, &Vec<f64>)| {
            let off = end
                .iter()
                .enumerate()
                .map(|(event, end)| pressures.get(event).unwrap_or(&0.0) - time / span * end);
            let off: Vec<f64> = off.collect();
            let energy: f64 = (0..off.len())
                .map(|i| {
                    let row = (0..off.len())
                        .map(|j| schur.entry(self.positions[i], self.positions[j]) * off[j]);
                    off[i] * row.sum::<f64>()
                })
                .sum();
            (self_influence * energy.max(0.0)).sqrt()
        };
        self.times.iter().zip(&self.pressures).map(bound).collect()
    }
}
