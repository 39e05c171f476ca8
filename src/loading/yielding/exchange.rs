//! Nodes that may touch and nodes that may yield next, and the events among them.

use crate::loading::scalars::Rates;
use crate::loading::state::ContactEvent;
use crate::loading::tuning::{EXACT_TIE, TOLERANCE};
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
#[derive(Debug, Default)]
pub(super) struct Exchange {
    /// Where the window began.
    approach: f64,
    nodes: Vec<usize>,
    hardness: Vec<f64>,
    start: Course,
    now: Course,
    events: Vec<Event>,
}

impl Exchange {
    /// Begins at an approach with the nodes of [`LinearUpdater::watch_both`](crate::updater::LinearUpdater::watch_both), and the
    /// rates of all there.
    pub(super) fn begin(
        &mut self,
        approach: f64,
        watched: &[Watched],
        complement: &Schur,
        rates: Rates,
    ) {
        let size = watched.len();
        self.approach = approach;
        self.nodes.clear();
        self.nodes.extend(watched.iter().map(|watched| watched.node));
        self.hardness.clear();
        self.hardness.extend(watched.iter().map(|watched| watched.hardness));
        let start = &mut self.start;
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

    /// The next event: of those that happen at once the one of the node of lowest index.
    fn next(&self) -> Option<(usize, f64)> {
        let Course { values, rates, states, time: now, .. } = &self.now;
        let course = |k: usize| match states[k] {
            NodeState::Out => Some((values[k], -rates[k])),
            NodeState::Elastic => Some((self.hardness[k] - values[k], rates[k])),
            NodeState::Yielded => None,
        };
        // A hardness may be infinite.
        let comes = |(left, rate): &(f64, f64)| *rate > 0.0 && left.is_finite();
        let (mut first, mut earliest) = (None, f64::INFINITY);
        for k in 0..self.nodes.len() {
            if let Some((left, rate)) = course(k).filter(comes) {
                let time = (left / rate).max(0.0);
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
            course.is_some_and(|(left, rate)| left - earliest * rate <= tie)
        };
        let tied = (0..self.nodes.len()).filter(ties);
        let lowest = tied.chain([first]).min_by_key(|&k| self.nodes[k])?;
        Some((lowest, now + earliest))
    }

    /// Whether the plastic depth of a node falls.
    fn recovers(&self) -> bool {
        let nodes = self.now.states.iter().zip(&self.now.rates);
        nodes.into_iter().any(|(state, rate)| *state == NodeState::Yielded && *rate > TOLERANCE)
    }

    /// Lets the node at a position touch or yield.
    fn happen(&mut self, position: usize, time: f64) -> Result<(), f64> {
        let size = self.nodes.len();
        let course = &mut self.now;
        let pivot = course.matrix[position * size + position];
        if pivot.is_nan() || pivot <= 0.0 {
            return Err(pivot);
        }
        let passed = time - course.time;
        for (value, rate) in course.values.iter_mut().zip(&course.rates) {
            *value += rate * passed;
        }
        course.time = time;
        let touches = course.states[position] == NodeState::Out;
        let own = course.rates[position];
        course.unit_stiffness += if touches { own * own / pivot } else { -(own * own / pivot) };
        course.exchange(position, size, pivot);
        course.values[position] = 0.0;
        course.states[position] = if touches { NodeState::Elastic } else { NodeState::Yielded };
        // Nodes that yielded since the beginning are counted among the gaps, with their own sign.
        let mut yielded = [0.0; 2];
        for k in 0..size {
            if course.states[k] == NodeState::Yielded {
                yielded[0] += course.rates[k];
                yielded[1] += self.hardness[k] * course.rates[k];
            }
        }
        let [gaps, depth, work] = [0, 1, 2].map(|k| course.rates[size + k]);
        let rates = Rates {
            unit_stiffness: course.unit_stiffness,
            closing: yielded[0] - gaps,
            plastic: [depth - yielded[0], work - yielded[1]],
        };
        let kind = if touches { ContactEvent::Touch } else { ContactEvent::Yield };
        self.events.push(Event { position, time, kind, rates });
        Ok(())
    }
}

impl Course {
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
        window.begin(0.0, &watched, &schur, rates);
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
        window.begin(1.0, &watched, &schur, rates);
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
        window.begin(0.0, &[watched], &schur, rates);
        let bad = window.play(f64::INFINITY, 1, 9);
        assert_eq!(bad, Some(BadPivot { node: 3, time: 2.0, pivot: -1.0 }));
        assert!(window.events().is_empty());
        Ok(())
    }
}
