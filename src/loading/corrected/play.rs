//! Events among watched nodes, from a Schur complement and the courses of their gaps.

use nalgebra::DMatrix;

use crate::loading::window::BadPivot;

/// The course of a gap as long as no watched node touches: `c₀ − c₁ t + c₂ t² + c₃ t³`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Course(pub(super) [f64; 4]);

/// A watched node that touches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Played {
    /// Which of the watched nodes.
    pub(super) position: usize,
    /// From the window's beginning.
    pub(super) time: f64,
}

/// Newton steps to the root of a cubic that is nearly a line.
const NEWTON: usize = 8;

impl Course {
    /// The gap at a time.
    pub(super) fn gap(&self, t: f64) -> f64 {
        let Self([c0, c1, c2, c3]) = self;
        c0 - t * (c1 - t * (c2 + t * c3))
    }

    /// How fast it closes.
    pub(super) fn closing(&self, t: f64) -> f64 {
        let Self([_, c1, c2, c3]) = self;
        c1 - t * (2.0 * c2 + 3.0 * t * c3)
    }

    /// When the gap closes, not before `now`.
    fn closes(&self, now: f64) -> f64 {
        let Self([c0, c1, c2, c3]) = *self;
        if c2 == 0.0 && c3 == 0.0 {
            return if c1 > 0.0 {
                (c0 / c1).max(now)
            } else {
                f64::INFINITY
            };
        }
        let mut t = now;
        for _ in 0..NEWTON {
            let closing = self.closing(t);
            if closing.is_nan() || closing <= 0.0 {
                return f64::INFINITY;
            }
            t += self.gap(t) / closing;
        }
        if t.is_nan() {
            f64::INFINITY
        } else {
            t.max(now)
        }
    }
}

/// Plays up to `most` events until the time `horizon`: the gap that closes first, again and again; of ties
/// the first of the watched nodes. `bad` says what ended it if that was a pivot.
pub(super) fn play(
    schur: &DMatrix<f64>,
    courses: &[Course],
    horizon: f64,
    most: usize,
) -> (Vec<Played>, Option<BadPivot>) {
    let size = courses.len();
    let (mut schur, mut courses) = (schur.clone(), courses.to_vec());
    let mut open: Vec<usize> = (0..size).collect();
    let mut events = Vec::with_capacity(size);
    let mut now = 0.0;
    while events.len() < most {
        let times = open.iter().map(|&i| (courses[i].closes(now), i));
        let Some((time, position)) = times.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
        else {
            break;
        };
        // The first one always counts: the horizon is the time of a node that was later, so that anything else is
        // rounding.
        let is_late = time > horizon && !events.is_empty();
        if is_late || time == f64::INFINITY {
            break;
        }
        let pivot = schur[(position, position)];
        if pivot.is_nan() || pivot <= 0.0 {
            let bad = BadPivot {
                node: position,
                time,
                pivot,
            };
            return (events, Some(bad));
        }
        now = time;
        events.push(Played { position, time });
        let Course(own) = courses[position];
        eliminate(&mut schur, &mut open, position, |i, factor| {
            for (c, own) in courses[i].0.iter_mut().zip(own) {
                *c -= factor * own;
            }
        });
    }
    (events, None)
}

/// What each event of an order adds to stiffness and takes off the sum of closing rates, over the cell area:
/// `b²/S` and `b σ/S` with all events before it eliminated.
pub(super) fn increments(
    schur: &DMatrix<f64>,
    closing: &[f64],
    row_sums: &[f64],
    order: impl Iterator<Item = usize>,
) -> Vec<[f64; 2]> {
    let mut schur = schur.clone();
    let (mut b, mut sigma) = (closing.to_vec(), row_sums.to_vec());
    let mut open: Vec<usize> = (0..b.len()).collect();
    let mut increments = Vec::with_capacity(b.len());
    for position in order {
        let pivot = schur[(position, position)];
        increments.push([
            b[position] * b[position] / pivot,
            b[position] * sigma[position] / pivot,
        ]);
        let (own_b, own_sigma) = (b[position], sigma[position]);
        eliminate(&mut schur, &mut open, position, |i, factor| {
            b[i] -= factor * own_b;
            sigma[i] -= factor * own_sigma;
        });
    }
    increments
}

/// Eliminates an open node from a Schur complement; `follow(i, factor)` is told by which factor its own
/// equation is subtracted from that of each other open node.
fn eliminate(
    schur: &mut DMatrix<f64>,
    open: &mut Vec<usize>,
    position: usize,
    mut follow: impl FnMut(usize, f64),
) {
    open.retain(|&i| i != position);
    let pivot = schur[(position, position)];
    let column: Vec<f64> = schur.column(position).iter().copied().collect();
    for &i in open.iter() {
        let factor = column[i] / pivot;
        follow(i, factor);
        for (value, other) in schur.column_mut(i).iter_mut().zip(&column) {
            *value -= factor * other;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `3 − 2 t + t²/2 + t³/4` and its slope, in numbers that are short in binary.
    #[test]
    fn courses_are_cubics() {
        let course = Course([3.0, 2.0, 0.5, 0.25]);
        assert_eq!([course.gap(0.0), course.gap(2.0)], [3.0, 3.0]);
        assert_eq!([course.closing(0.0), course.closing(2.0)], [2.0, -3.0]);
    }

    /// The root of `(1 − t) (1 + t²/10)`, which Newton's steps find to rounding, and that of a line; none of a
    /// gap that opens; and none before the present.
    #[test]
    fn gaps_close_at_their_roots() {
        let cubic = Course([1.0, 1.0, 0.1, -0.1]);
        assert!((cubic.closes(0.0) - 1.0).abs() < 1e-15);
        assert_eq!(cubic.closes(1.25), 1.25);
        // `1.1 − t − t³/10`, and `(1 − t)(1 − t/4)`: one of both powers alone.
        let of_one_power = [[1.1, 1.0, 0.0, -0.1], [1.0, 1.25, 0.25, 0.0]];
        for course in of_one_power {
            assert!((Course(course).closes(0.0) - 1.0).abs() < 1e-15);
        }
        assert_eq!(Course([f64::NAN, 1.0, 0.1, 0.0]).closes(0.0), f64::INFINITY);
        assert_eq!(Course([3.0, 2.0, 0.0, 0.0]).closes(0.0), 1.5);
        assert_eq!(Course([3.0, 2.0, 0.0, 0.0]).closes(2.0), 2.0);
        for opening in [
            [1.0, -1.0, 0.0, 0.0],
            [1.0, 0.0, 0.0, 0.0],
            [1.0, -1.0, 0.5, 0.0],
        ] {
            assert_eq!(Course(opening).closes(0.0), f64::INFINITY);
        }
    }

    /// Three nodes of which the second feels half of what the first carries, and the third nothing:
    /// `2 − t + (t − 1)/2` closes at t = 3.
    #[test]
    fn a_node_that_carries_holds_its_neighbours_back() {
        let schur = DMatrix::from_row_slice(3, 3, &[1.0, 0.5, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0, 1.0]);
        let courses = [[1.0, 1.0], [2.0, 1.0], [2.5, 1.0]].map(|[a, b]| Course([a, b, 0.0, 0.0]));
        let order = |events: &[Played]| -> Vec<(usize, f64)> {
            events
                .iter()
                .map(|event| (event.position, event.time))
                .collect()
        };
        let (events, bad) = play(&schur, &courses, f64::INFINITY, 9);
        assert_eq!(order(&events), [(0, 1.0), (2, 2.5), (1, 3.0)]);
        assert!(bad.is_none());
        // Up to the horizon, that included, and up to a number; the first is played in any case.
        for (horizon, most, count) in [(2.5, 9, 2), (2.4, 9, 1), (0.5, 9, 1), (9.0, 2, 2)] {
            assert_eq!(play(&schur, &courses, horizon, most).0.len(), count);
        }
        // 1 / (1 − 1/4) of what is left of closing rate and row sum, 1/2 and 2 − 3/2.
        let closing = [1.0, 1.0, 1.0];
        let found = increments(&schur, &closing, &[3.0, 2.0, 5.0], [0, 1].into_iter());
        assert_eq!(found, [[1.0, 3.0], [0.25 / 0.75, 0.25 / 0.75]]);
    }

    /// A pivot that is not positive names its node and when it would have touched.
    #[test]
    fn bad_pivots_are_named() {
        let schur = DMatrix::from_row_slice(2, 2, &[1.0, -2.0, -2.0, 1.0]);
        let courses = [[1.0, 1.0], [4.0, 1.0]].map(|[a, b]| Course([a, b, 0.0, 0.0]));
        // 4 − t − 2 (t − 1) closes at t = 2, with the pivot 1 − 4.
        let (events, bad) = play(&schur, &courses, f64::INFINITY, 9);
        assert_eq!(events.len(), 1);
        let bad = bad.map(|bad| (bad.node, bad.time, bad.pivot));
        assert_eq!(bad, Some((1, 2.0, -3.0)));
        // 4 − 2 t and what the first one carries, t − 1, closes at t = 3: with nothing left of its pivot, or NaN.
        for own in [1.0, f64::NAN] {
            let schur = DMatrix::from_row_slice(2, 2, &[1.0, 1.0, 1.0, own]);
            let courses = [[1.0, 1.0], [4.0, 2.0]].map(|[a, b]| Course([a, b, 0.0, 0.0]));
            let (events, bad) = play(&schur, &courses, f64::INFINITY, 9);
            assert_eq!(events.len(), 1);
            assert!(bad.is_some_and(|bad| (bad.node, bad.time) == (1, 3.0)));
            assert!(bad.is_some_and(|bad| bad.pivot == own - 1.0 || bad.pivot.is_nan()));
        }
    }

    /// Of nodes that touch at once the first of the watched ones comes first.
    #[test]
    fn ties_go_to_the_first() {
        let courses = [[2.0, 1.0], [1.0, 1.0], [1.0, 1.0]].map(|[a, b]| Course([a, b, 0.0, 0.0]));
        let (events, _) = play(&DMatrix::identity(3, 3), &courses, f64::INFINITY, 9);
        let order: Vec<usize> = events.iter().map(|event| event.position).collect();
        assert_eq!(order, [1, 2, 0]);
    }
}
