//! Nodes that may touch and nodes that may yield next, and the events among them.

use crate::loading::scalars::Rates;
use crate::loading::state::ContactEvent;
use crate::loading::tuning::{EXACT_TIE, NEWTON, TOLERANCE};
use crate::loading::window::BadPivot;
use crate::parallel::vectorized;
use crate::updater::Schur;

/// A watched node: the gap of one out of contact, the pressure of an elastic one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Watched {
    pub(super) node: usize,
    pub(super) is_elastic: bool,
    pub(super) hardness: f64,
    /// Gap or pressure when the window begins.
    pub(super) value: f64,
    /// How fast that falls or rises.
    pub(super) rate: f64,
    /// What a pressure on it, or a gap of it, adds to sums over all nodes: of gaps, of plastic depths, and of these times the
    /// hardness.
    pub(super) sums: [f64; SUMS],
}

pub(super) const SUMS: usize = 3;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NodeState {
    Out,
    Elastic,
    Yielded,
}

/// A watched node that touches or yields.
#[derive(Debug, Clone, Copy)]
pub(super) struct Event {
    /// Which of the watched nodes.
    pub(super) position: usize,
    /// How much further the approach is then than where the window began.
    pub(super) time: f64,
    pub(super) kind: ContactEvent,
    /// How fast it came: a gap closes, or a pressure grows times what a pressure displaces, by so much of the approach.
    pub(super) closing: f64,
    /// From then on.
    pub(super) rates: Rates,
}

/// What is known of the watched nodes at a time of the window.
#[derive(Debug, Clone, Default)]
struct Course {
    /// The matrix T, row by row, and below it one row for each sum.
    matrix: Vec<f64>,
    values: Vec<f64>,
    /// Of the values, and of the sums.
    rates: Vec<f64>,
    /// What is known of their curvature from now on, `a t² + b t³`; empty where all are lines.
    curves: Vec<[f64; 2]>,
    states: Vec<NodeState>,
    unit_stiffness: f64,
    time: f64,
}

/// The nodes out of contact and in it that may touch or yield before any other, and how they answer each other:
///
/// ```text
/// (gaps of nodes out, pressures of elastic nodes) = lines + T (pressures of nodes out, gaps of elastic nodes)
/// ```
///
/// An event exchanges an input for its output, a principal pivot of T: the gap of a node that touches stays 0 and its pressure
/// grows; the pressure of a node that yields stays at its hardness, and its gap falls below 0. T stays positive definite.
#[derive(Debug, Clone, Default)]
pub(super) struct Exchange {
    /// Where the window began.
    approach: f64,
    nodes: Vec<usize>,
    hardness: Vec<f64>,
    start: Course,
    now: Course,
    events: Vec<Event>,
    /// Rates of plastic depths that are negative by no more are rounding, or the error of the matrix.
    tolerance: f64,
    /// Whether all elastic nodes are watched: then the stiffness is the sum of their rates. Where few are left of many, what events take
    /// from it is no use.
    is_whole: bool,
}

impl Exchange {
    /// Begins at an approach with the nodes of [`LinearUpdater::watch_both`](crate::updater::LinearUpdater::watch_both), and the
    /// rates of all `elastic` ones there.
    pub(super) fn begin(
        &mut self,
        approach: f64,
        watched: &[Watched],
        complement: &Schur,
        (rates, elastic): (Rates, usize),
    ) {
        let size = watched.len();
        self.approach = approach;
        self.is_whole = watched.iter().filter(|watched| watched.is_elastic).count() == elastic;
        self.nodes.clear();
        self.nodes.extend(watched.iter().map(|watched| watched.node));
        self.hardness.clear();
        self.hardness.extend(watched.iter().map(|watched| watched.hardness));
        self.tolerance = TOLERANCE;
        let start = &mut self.start;
        start.curves.clear();
        start.matrix.clear();
        for i in 0..size {
            // The matrix of the updater is that of overlaps, and inputs are gaps.
            start.matrix.extend(watched.iter().enumerate().map(|(j, watched)| {
                let entry = complement.entry(i, j);
                if watched.is_elastic { -entry } else { entry }
            }));
        }
        for k in 0..SUMS {
            start.matrix.extend(watched.iter().map(|watched| watched.sums[k]));
        }
        start.values.clear();
        start.values.extend(watched.iter().map(|watched| watched.value));
        start.rates.clear();
        start.rates.extend(watched.iter().map(|watched| watched.rate));
        start.rates.extend([-rates.closing, rates.plastic[0], rates.plastic[1]]);
        start.states.clear();
        let state = |watched: &Watched| {
            if watched.is_elastic { NodeState::Elastic } else { NodeState::Out }
        };
        start.states.extend(watched.iter().map(state));
        start.unit_stiffness = rates.unit_stiffness;
        start.time = 0.0;
    }

    /// Bends the courses of the values by `a t² + b t³`, from the beginning on.
    pub(super) fn bend(&mut self, curves: impl Iterator<Item = [f64; 2]>) {
        let start = &mut self.start;
        start.curves.clear();
        start.curves.extend(curves);
        start.curves.resize(start.rates.len(), [0.0; 2]);
    }

    /// Sets by how much rates of plastic depths may be wrong.
    pub(super) fn tolerate(&mut self, tolerance: f64) {
        self.tolerance = tolerance;
    }

    /// The number of watched nodes.
    pub(super) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// The node at a position.
    pub(super) fn node(&self, position: usize) -> usize {
        self.nodes[position]
    }

    /// A value of the matrix on its diagonal, at the beginning: what a pressure displaces where the node is out of contact, or what a
    /// gap takes of a pressure.
    pub(super) fn pivot(&self, position: usize) -> f64 {
        self.start.matrix[position * self.nodes.len() + position]
    }

    /// The course of a node at the beginning: value and rate, and whether it is elastic.
    pub(super) fn line(&self, position: usize) -> ([f64; 2], bool) {
        let Course { values, rates, states, .. } = &self.start;
        ([values[position], rates[position]], states[position] == NodeState::Elastic)
    }

    /// When a node touches or yields by its own course at the beginning, which may lie behind; `None` if it does not.
    pub(super) fn own_time(&self, position: usize) -> Option<f64> {
        let Course { values, rates, states, .. } = &self.start;
        let (left, rate) = match states[position] {
            NodeState::Out => (values[position], -rates[position]),
            NodeState::Elastic => (self.hardness[position] - values[position], rates[position]),
            NodeState::Yielded => return None,
        };
        (rate > 0.0 && left.is_finite()).then_some(left / rate)
    }

    /// The rates at the beginning.
    pub(super) fn start_rates(&self) -> Rates {
        let Course { rates, unit_stiffness, .. } = &self.start;
        let sums = &rates[self.nodes.len()..];
        Rates { unit_stiffness: *unit_stiffness, closing: -sums[0], plastic: [sums[1], sums[2]] }
    }

    /// The events, in their order.
    pub(super) fn events(&self) -> &[Event] {
        &self.events
    }

    /// The watched nodes as the last event has left them: node, state, value and rate; the value of one that has touched is its
    /// pressure, and that of one that has yielded its gap.
    pub(super) fn nodes(&self) -> impl Iterator<Item = (usize, NodeState, [f64; 2])> {
        let Course { values, rates, states, .. } = &self.now;
        let nodes = self.nodes.iter().zip(states).zip(values.iter().zip(rates));
        nodes.map(|((&node, &state), (&value, &rate))| (node, state, [value, rate]))
    }

    /// Plays up to `most` events, and up to `touches` of nodes that touch, from the beginning until the horizon. The first event
    /// always counts. Returns what ended it if that is a pivot.
    pub(super) fn play(&mut self, horizon: f64, touches: usize, most: usize) -> Option<BadPivot> {
        self.now.clone_from(&self.start);
        self.events.clear();
        let mut touched = 0;
        while self.events.len() < most && touched < touches {
            let (position, time) = self.next()?;
            if time > horizon && !self.events.is_empty() {
                return None;
            }
            if let Err(pivot) = self.happen(position, time) {
                return Some(BadPivot { node: self.nodes[position], time, pivot });
            }
            touched += usize::from(self.now.states[position] == NodeState::Elastic);
            if self.recovers() {
                // Not on a body whose contact grows: the end of the window shows it.
                return None;
            }
        }
        None
    }

    /// Lets events happen at given positions and times, from the beginning, in whatever order that is.
    pub(super) fn go_through(
        &mut self,
        events: impl Iterator<Item = (usize, f64)>,
    ) -> Result<(), BadPivot> {
        self.now.clone_from(&self.start);
        self.events.clear();
        for (position, time) in events {
            let node = self.nodes[position];
            self.happen(position, time).map_err(|pivot| BadPivot { node, time, pivot })?;
        }
        Ok(())
    }

    /// A window of some of the nodes, that begins at a time behind the last event and with other values then.
    pub(super) fn remaining(&self, positions: &[usize], time: f64, values: &[f64]) -> Self {
        let size = self.nodes.len();
        let mut now = self.now.clone();
        now.pass(time);
        let pick = |position: &usize| now.rates[*position];
        let mut start = Course {
            values: values.to_vec(),
            rates: positions.iter().map(pick).chain([0.0; SUMS]).collect(),
            states: positions.iter().map(|&position| now.states[position]).collect(),
            ..Course::default()
        };
        for &row in positions {
            let row = &now.matrix[row * size..][..size];
            start.matrix.extend(positions.iter().map(|&position| row[position]));
        }
        start.matrix.resize(start.rates.len() * positions.len(), 0.0);
        if !now.curves.is_empty() {
            start.curves = positions.iter().map(|&position| now.curves[position]).collect();
            start.curves.resize(start.rates.len(), [0.0; 2]);
        }
        Self {
            approach: self.approach + time,
            nodes: positions.iter().map(|&position| self.nodes[position]).collect(),
            hardness: positions.iter().map(|&position| self.hardness[position]).collect(),
            start,
            now: Course::default(),
            events: Vec::new(),
            tolerance: self.tolerance,
            is_whole: false,
        }
    }

    /// Moves the beginning by a time, forwards or backwards.
    pub(super) fn shift(&mut self, time: f64) {
        self.approach += time;
        self.start.pass(time);
        self.start.time = 0.0;
    }

    /// The next event: of those that happen at once the one of the node of lowest index.
    fn next(&self) -> Option<(usize, f64)> {
        let Course { values, rates, curves, states, time: now, .. } = &self.now;
        let course = |k: usize| match states[k] {
            NodeState::Out => Some((values[k], -rates[k])),
            NodeState::Elastic => Some((self.hardness[k] - values[k], rates[k])),
            NodeState::Yielded => None,
        };
        // A hardness may be infinite.
        let comes = |(left, rate): &(f64, f64)| *rate > 0.0 && left.is_finite();
        let curve = |k: usize| {
            let sign = if states[k] == NodeState::Out { 1.0 } else { -1.0 };
            curves.get(k).map_or([0.0; 2], |curve| curve.map(|c| sign * c))
        };
        let (mut first, mut earliest) = (None, f64::INFINITY);
        for k in 0..self.nodes.len() {
            if let Some((left, rate)) = course(k).filter(comes) {
                let time = comes_at(left, rate, curve(k));
                if time < earliest {
                    (first, earliest) = (Some(k), time);
                }
            }
        }
        let first = first?;
        let length = EXACT_TIE * (self.approach + now + earliest);
        let ties = |&k: &usize| {
            let tie =
                if states[k] == NodeState::Elastic { EXACT_TIE * self.hardness[k] } else { length };
            let course = course(k).filter(comes);
            let [a, b] = curve(k);
            let bent = earliest * earliest * (a + b * earliest);
            course.is_some_and(|(left, rate)| left - earliest * rate + bent <= tie)
        };
        let tied = (0..self.nodes.len()).filter(ties);
        let lowest = tied.chain([first]).min_by_key(|&k| self.nodes[k])?;
        Some((lowest, now + earliest))
    }

    /// Whether the plastic depth of a node falls.
    fn recovers(&self) -> bool {
        let nodes = self.now.states.iter().zip(&self.now.rates);
        nodes
            .into_iter()
            .any(|(state, rate)| *state == NodeState::Yielded && *rate > self.tolerance)
    }

    /// Lets the node at a position touch or yield.
    fn happen(&mut self, position: usize, time: f64) -> Result<(), f64> {
        let size = self.nodes.len();
        let course = &mut self.now;
        let pivot = course.matrix[position * size + position];
        if pivot.is_nan() || pivot <= 0.0 {
            return Err(pivot);
        }
        course.pass(time);
        let touches = course.states[position] == NodeState::Out;
        let own = course.rates[position];
        course.unit_stiffness += if touches { own * own / pivot } else { -(own * own / pivot) };
        course.exchange(position, size, pivot);
        course.values[position] = 0.0;
        course.states[position] = if touches { NodeState::Elastic } else { NodeState::Yielded };
        // Nodes that yielded since the beginning are counted among the gaps, with their own sign.
        let mut yielded = [0.0; 2];
        let mut elastic = 0.0;
        for k in 0..size {
            match course.states[k] {
                NodeState::Out => {}
                NodeState::Elastic => elastic += course.rates[k],
                NodeState::Yielded => {
                    yielded[0] += course.rates[k];
                    yielded[1] += self.hardness[k] * course.rates[k];
                }
            }
        }
        if self.is_whole {
            course.unit_stiffness = elastic;
        }
        let [gaps, depth, work] = [0, 1, 2].map(|k| course.rates[size + k]);
        let rates = Rates {
            unit_stiffness: course.unit_stiffness,
            closing: yielded[0] - gaps,
            plastic: [depth - yielded[0], work - yielded[1]],
        };
        let kind = if touches { ContactEvent::Touch } else { ContactEvent::Yield };
        let closing = if touches { -own } else { own / pivot };
        self.events.push(Event { position, time, kind, closing, rates });
        Ok(())
    }
}

/// When what is left, `left − rate t + a t² + b t³`, is nothing: not before now.
fn comes_at(left: f64, rate: f64, [a, b]: [f64; 2]) -> f64 {
    if [a, b] == [0.0; 2] {
        return (left / rate).max(0.0);
    }
    let mut time = 0.0;
    for _ in 0..NEWTON {
        let slope = rate - time * (2.0 * a + 3.0 * b * time);
        if slope.is_nan() || slope <= 0.0 {
            return f64::INFINITY;
        }
        time += (left - time * (rate - time * (a + b * time))) / slope;
    }
    if time.is_nan() { f64::INFINITY } else { time.max(0.0) }
}

impl Course {
    /// Goes to a time.
    fn pass(&mut self, time: f64) {
        let passed = time - self.time;
        for (value, rate) in self.values.iter_mut().zip(&self.rates) {
            *value += rate * passed;
        }
        for (k, [a, b]) in self.curves.iter_mut().enumerate() {
            if let Some(value) = self.values.get_mut(k) {
                *value += passed * passed * (*a + *b * passed);
            }
            self.rates[k] += passed * (2.0 * *a + 3.0 * *b * passed);
            *a += 3.0 * *b * passed;
        }
        self.time = time;
    }

    /// Makes the output at a position an input.
    fn exchange(&mut self, position: usize, size: usize, pivot: f64) {
        let own: Vec<f64> = self.matrix[position * size..][..size].to_vec();
        let input = -self.rates[position] / pivot;
        let rows = self.matrix.chunks_exact_mut(size).zip(&mut self.rates).enumerate();
        vectorized(
            #[inline(always)]
            || {
                for (i, (row, rate)) in rows {
                    if i == position {
                        for value in &mut *row {
                            *value /= -pivot;
                        }
                        row[position] = pivot.recip();
                        *rate = input;
                        continue;
                    }
                    let factor = row[position] / pivot;
                    *rate += row[position] * input;
                    for (value, own) in row.iter_mut().zip(&own) {
                        *value -= factor * own;
                    }
                    row[position] = factor;
                }
            },
        );
        let Some(own) = self.curves.get(position).copied() else {
            return;
        };
        for (k, curve) in self.curves.iter_mut().enumerate() {
            // The matrix has been divided by the pivot.
            let factor = if k == position { 1.0 / pivot } else { self.matrix[k * size + position] };
            let kept = if k == position { 0.0 } else { 1.0 };
            for (c, own) in curve.iter_mut().zip(own) {
                *c = kept * *c - factor * own;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Error;

    /// Two nodes with C = (2, 1; 1, 2), gaps 0 and 1 and these hardnesses, of which none is in contact.
    fn two(hardness: [f64; 2]) -> Result<Exchange, Error> {
        let mut schur = Schur::default();
        schur.resize(2)?;
        schur.as_mut_slice().copy_from_slice(&[2.0, 1.0, f64::NAN, 2.0]);
        let watched = [0, 1].map(|k| Watched {
            node: 7 + k,
            is_elastic: false,
            hardness: hardness[k],
            value: k as f64,
            rate: -1.0,
            sums: [3.0, 0.0, 0.0],
        });
        let mut window = Exchange::default();
        let rates = Rates { unit_stiffness: 0.0, closing: 2.0, plastic: [0.0; 2] };
        window.begin(0.0, &watched, &schur, (rates, 0));
        Ok(window)
    }

    /// (kind, place, time) of the events.
    fn found(window: &Exchange) -> Vec<(ContactEvent, usize, f64)> {
        window.events().iter().map(|event| (event.kind, event.position, event.time)).collect()
    }

    /// Touch at 0, yield at 3/2, touch at 7/4, yield at 13/4. With one node elastic the other sinks half as fast as the approach;
    /// with none all gaps close, and overlaps grow, as fast as that.
    #[test]
    fn both_kinds_of_events() -> Result<(), Error> {
        use ContactEvent::{Touch, Yield};
        let mut window = two([0.75; 2])?;
        let expected = [
            (Touch, 0, 0.0, 0.5, 0.5, [0.0, 0.0]),
            (Yield, 0, 1.5, 0.0, 1.0, [1.0, 0.75]),
            (Touch, 1, 1.75, 0.5, 0.0, [0.5, 0.375]),
            (Yield, 1, 3.25, 0.0, 0.0, [2.0, 1.5]),
        ];
        for most in [4, 2, 9] {
            assert_eq!(window.play(f64::INFINITY, 3, most), None);
            assert_eq!(window.events().len(), most.min(4));
            for (event, (kind, position, time, unit, closing, plastic)) in
                window.events().iter().zip(expected)
            {
                assert_eq!((event.kind, event.position), (kind, position));
                let rates = event.rates;
                let found = [event.time, rates.unit_stiffness, rates.closing];
                let found = found.into_iter().chain(rates.plastic);
                for (found, expected) in found.zip([time, unit, closing, plastic[0], plastic[1]]) {
                    // A few rounding errors of numbers near 1.
                    assert!((found - expected).abs() < 1e-14, "{kind:?}: {found} {expected}");
                }
            }
        }
        // One has yielded by 7/4 more, and the other has only just.
        let gaps: Vec<f64> = window.nodes().map(|(.., [value, _])| value).collect();
        assert!((gaps[0] + 1.0).abs() < 1e-14 && gaps[1] == 0.0, "{gaps:?}");
        Ok(())
    }

    /// Until a horizon, though the first event always counts; not beyond so many that touch; and an infinite hardness is never reached.
    #[test]
    fn windows_end() -> Result<(), Error> {
        let mut window = two([0.75; 2])?;
        for (horizon, touches, events) in
            [(1.6, 2, 2), (-1.0, 2, 1), (f64::INFINITY, 1, 1), (f64::INFINITY, 0, 0)]
        {
            assert_eq!(window.play(horizon, touches, 9), None);
            assert_eq!(window.events().len(), events, "{horizon} {touches}");
        }
        let mut hard = two([f64::INFINITY; 2])?;
        assert_eq!(hard.play(f64::INFINITY, 2, 9), None);
        let touch = ContactEvent::Touch;
        assert_eq!(found(&hard), [(touch, 0, 0.0), (touch, 1, 2.0)]);
        Ok(())
    }

    /// Elastic nodes at equal pressures yield in the order of their indices.
    #[test]
    fn ties_are_in_order() -> Result<(), Error> {
        let mut schur = Schur::default();
        schur.resize(2)?;
        // C⁻¹ = (2, −1; −1, 2)/3, of overlaps.
        schur.as_mut_slice().copy_from_slice(&[-2.0 / 3.0, 1.0 / 3.0, f64::NAN, -2.0 / 3.0]);
        let watched = [9, 4].map(|node| Watched {
            node,
            is_elastic: true,
            hardness: 1.0,
            value: 0.5,
            rate: 0.25,
            sums: [0.0; SUMS],
        });
        let mut window = Exchange::default();
        let rates = Rates { unit_stiffness: 0.5, closing: 0.0, plastic: [0.0; 2] };
        window.begin(1.0, &watched, &schur, (rates, 2));
        assert_eq!(window.play(f64::INFINITY, 0, 9), None);
        assert!(window.events().is_empty());
        assert_eq!(window.play(f64::INFINITY, 1, 9), None);
        let places: Vec<usize> = window.events().iter().map(|event| event.position).collect();
        assert_eq!(places, [1, 0]);
        assert_eq!(found(&window)[0].2, 2.0);
        Ok(())
    }

    /// A node whose pivot is not positive cannot touch.
    #[test]
    fn bad_pivots_are_told() -> Result<(), Error> {
        let mut schur = Schur::default();
        schur.resize(1)?;
        schur.as_mut_slice()[0] = -1.0;
        let watched = Watched {
            node: 3,
            is_elastic: false,
            hardness: 1.0,
            value: 2.0,
            rate: -1.0,
            sums: [0.0; SUMS],
        };
        let mut window = Exchange::default();
        let rates = Rates { unit_stiffness: 0.0, closing: 1.0, plastic: [0.0; 2] };
        window.begin(0.0, &[watched], &schur, (rates, 0));
        let bad = window.play(f64::INFINITY, 1, 9);
        assert_eq!(bad, Some(BadPivot { node: 3, time: 2.0, pivot: -1.0 }));
        assert!(window.events().is_empty());
        Ok(())
    }

    /// Node 7 is in contact from the beginning on, so that half of the approach is left of what node 8 sinks by: its gap is
    /// `1 − t/2 + c₂ t² + c₃ t³` with −1/8 and 1/16 of bent courses, and closes at the root of that. From then on its pressure grows as the
    /// rest of that cubic falls, over the pivot of 3/2.
    #[test]
    fn courses_are_cubics() -> Result<(), Error> {
        let mut window = two([f64::INFINITY; 2])?;
        window.bend([[0.0; 2], [-0.125, 0.0625]].into_iter());
        assert_eq!(window.play(f64::INFINITY, 2, 9), None);
        assert_eq!(found(&window)[0], (ContactEvent::Touch, 0, 0.0));
        let gap = |t: f64| 1.0 - 0.5 * t - 0.125 * t * t + 0.0625 * t.powi(3);
        let t = window.events()[1].time;
        // Newton's steps converge to rounding.
        assert!(
            gap(t).abs() < 1e-15
                && (window.events()[1].closing - 0.5 - 0.25 * t + 0.1875 * t * t).abs() < 1e-14
        );
        // Another tenth of a metre on.
        window.now.pass(t + 0.1);
        let pressure = window.now.values[1];
        assert!((pressure + gap(t + 0.1) / 1.5).abs() < 1e-15, "{pressure}");
        // Node 7 feels half of that node less, and no more than the approach otherwise: C p is what they sink by.
        let other = window.now.values[0];
        assert!((2.0 * other + pressure - (t + 0.1)).abs() < 1e-14, "{other}");
        Ok(())
    }

    /// What remains of a window is one of its own: both nodes alone at 8/5, when node 7 has yielded and node 8 has been found 1/16 away
    /// from the surface. It touches that much later, and yields 3/2 after that.
    #[test]
    fn what_remains_is_a_window() -> Result<(), Error> {
        use ContactEvent::{Touch, Yield};
        let mut window = two([0.75; 2])?;
        assert_eq!(window.go_through([(0, 0.0), (0, 1.5)].into_iter()), Ok(()));
        assert_eq!(found(&window), [(Touch, 0, 0.0), (Yield, 0, 1.5)]);
        let mut remaining = window.remaining(&[1], 1.625, &[0.0625]);
        assert_eq!(
            (remaining.len(), remaining.node(0), remaining.own_time(0)),
            (1, 8, Some(0.0625))
        );
        assert_eq!(remaining.play(f64::INFINITY, 9, 9), None);
        let events = found(&remaining);
        assert_eq!(events[0], (Touch, 0, 0.0625));
        // S of node 8 alone is 2, so that 3/4 take 3/2 of approach.
        assert!(events[1].0 == Yield && (events[1].2 - 1.5625).abs() < 1e-14, "{events:?}");
        // Moved back, all of it comes later.
        remaining.shift(-0.25);
        assert_eq!(remaining.own_time(0), Some(0.3125));
        // A pivot that is not positive is told, with the node and the time.
        window.start.matrix[0] = -1.0;
        let bad = window.go_through([(0, 0.5)].into_iter());
        assert_eq!(bad, Err(BadPivot { node: 7, time: 0.5, pivot: -1.0 }));
        Ok(())
    }
}
