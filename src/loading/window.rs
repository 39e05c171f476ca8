//! The nodes that may touch next, and the events among them.

use super::gap_field::GapLine;
use super::tuning::{EXACT_TIE, NEWTON};
use crate::updater::{Schur, WindowFactor};

/// The course of a gap as long as no watched node touches: a line, `gap − t closing`, and what is known of its curvature,
/// `c₂ t² + c₃ t³`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Course {
    pub(super) line: GapLine,
    pub(super) curve: [f64; 2],
}

impl Course {
    /// The gap at a time.
    pub(super) fn gap(&self, t: f64) -> f64 {
        let [c2, c3] = self.curve;
        self.line.gap - t * (self.line.closing - t * (c2 + t * c3))
    }

    /// How fast it closes.
    pub(super) fn closing(&self, t: f64) -> f64 {
        let [c2, c3] = self.curve;
        self.line.closing - t * (2.0 * c2 + 3.0 * t * c3)
    }

    /// When the gap closes, not before `now`.
    fn closes(&self, now: f64) -> f64 {
        if self.curve == [0.0; 2] {
            return self.line.touches().max(now);
        }
        let mut t = now;
        for _ in 0..NEWTON {
            let closing = self.closing(t);
            if closing.is_nan() || closing <= 0.0 {
                return f64::INFINITY;
            }
            t += self.gap(t) / closing;
        }
        if t.is_nan() { f64::INFINITY } else { t.max(now) }
    }

    /// Subtracts a multiple of another course.
    fn subtract(&mut self, factor: f64, other: &Self) {
        self.line.gap -= factor * other.line.gap;
        self.line.closing -= factor * other.line.closing;
        for (c, other) in self.curve.iter_mut().zip(other.curve) {
            *c -= factor * other;
        }
    }
}

impl From<GapLine> for Course {
    fn from(line: GapLine) -> Self {
        let curve = [0.0; 2];
        Self { line, curve }
    }
}

/// A watched node that touches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct WindowEvent {
    /// Which of the watched nodes.
    pub(super) position: usize,
    /// How much further the approach is then than where the window began.
    pub(super) time: f64,
}

/// A node that cannot touch: its pivot is not positive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BadPivot {
    pub(super) node: usize,
    pub(super) time: f64,
    pub(super) pivot: f64,
}

/// The nodes that may touch before any other, and all that decides among them: the courses of their
/// gaps, and the Schur complement S, by which a node that touches changes the courses of the others.
///
/// Everything here is small and dense; it knows nothing of the grid, the updater, or the path.
#[derive(Debug, Clone, Default)]
pub(super) struct Window {
    /// Where the window began.
    approach: f64,
    /// No other node touches before this time.
    horizon: f64,
    nodes: Vec<usize>,
    /// The course and the reduced row sum of each node, from which the events so far are eliminated.
    courses: Vec<(Course, f64)>,
    schur: Schur,
    open: Vec<bool>,
    factor: WindowFactor,
    events: Vec<WindowEvent>,
    /// What each event adds to `eᵀ C_II⁻¹ e`, and what it takes off the sum of closing rates.
    increments: Vec<[f64; 2]>,
}

impl Window {
    /// Opens a window at an approach on nodes and the lines of their gaps; no other node touches before the time `horizon`. The
    /// caller fills the Schur complement and calls [`Self::begin`].
    pub(super) fn open(
        &mut self,
        (approach, horizon): (f64, f64),
        lines: impl Iterator<Item = (usize, GapLine)>,
    ) -> (&[usize], &mut Schur) {
        self.approach = approach;
        self.horizon = horizon;
        self.nodes.clear();
        self.courses.clear();
        for (node, line) in lines {
            self.nodes.push(node);
            self.courses.push((line.into(), 0.0));
        }
        (&self.nodes, &mut self.schur)
    }

    /// Begins with the Schur complement as it has been filled.
    pub(super) fn begin(&mut self) {
        for ((_, sum), filled) in self.courses.iter_mut().zip(self.schur.row_sums()) {
            *sum = *filled;
        }
        let size = self.nodes.len();
        self.open.clear();
        self.open.resize(size, true);
        self.factor.reset(size, size);
        self.events.clear();
        self.increments.clear();
        // So that no event ever allocates.
        self.events.reserve(size);
        self.increments.reserve(size);
    }

    /// A window that ended with these nodes watched, none of which has touched: what the next one knows of it.
    pub(super) fn ended_with(nodes: Vec<usize>) -> Self {
        Self { open: vec![true; nodes.len()], nodes, ..Self::default() }
    }

    /// The watched nodes.
    pub(super) fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    /// The node at a position.
    pub(super) fn node(&self, position: usize) -> usize {
        self.nodes[position]
    }

    /// Where a node is among the watched ones.
    pub(super) fn position(&self, node: usize) -> Option<usize> {
        self.nodes.iter().position(|other| *other == node)
    }

    /// No other node touches before this time.
    pub(super) fn horizon(&self) -> f64 {
        self.horizon
    }

    /// The courses of the gaps, from which the events so far are eliminated.
    pub(super) fn courses(&self) -> impl ExactSizeIterator<Item = &Course> + Clone {
        self.courses.iter().map(|(course, _)| course)
    }

    /// The course of one gap.
    pub(super) fn course(&self, position: usize) -> &Course {
        &self.courses[position].0
    }

    /// Gives the gaps other courses.
    pub(super) fn set_courses(&mut self, courses: impl Iterator<Item = Course>) {
        for ((course, _), other) in self.courses.iter_mut().zip(courses) {
            *course = other;
        }
    }

    /// The Schur complement, before the first event.
    pub(super) fn schur(&self) -> &Schur {
        &self.schur
    }

    /// The Schur complement to change, before the first event.
    pub(super) fn schur_mut(&mut self) -> &mut Schur {
        &mut self.schur
    }

    /// Watched nodes that have not touched, in the order of the window.
    pub(super) fn untouched(&self) -> impl Iterator<Item = usize> {
        let nodes = self.nodes.iter().zip(&self.open);
        nodes.filter(|(_, open)| **open).map(|(&node, _)| node)
    }

    /// The events, in their order.
    pub(super) fn events(&self) -> &[WindowEvent] {
        &self.events
    }

    /// What each event adds to `eᵀ C_II⁻¹ e`, the stiffness over the cell area, and what it takes off the sum of closing rates.
    pub(super) fn increments(&self) -> &[[f64; 2]] {
        &self.increments
    }

    /// The nodes of the events, in their order.
    pub(super) fn touched(&self) -> impl ExactSizeIterator<Item = usize> {
        self.events.iter().map(|event| self.nodes[event.position])
    }

    /// The factor of the Schur complement of the nodes that touched.
    pub(super) fn factor(&self) -> &WindowFactor {
        &self.factor
    }

    /// Plays up to `most` events: the gap that closes first, again and again, until the horizon. Ties go to
    /// the node of the lowest index. Returns what ended it if that is a pivot.
    ///
    /// The first event always counts: the horizon is the bound of a node that was later, so that anything
    /// else is rounding; and so is a time before that of the last event.
    pub(super) fn play(&mut self, most: usize) -> Option<BadPivot> {
        while self.events.len() < most {
            let (position, time) = self.first_contact()?;
            if time == f64::INFINITY || (time > self.horizon && !self.events.is_empty()) {
                return None;
            }
            if let Err(bad) = self.touch(position, time) {
                return Some(bad);
            }
        }
        None
    }

    /// The same until another horizon.
    pub(super) fn play_until(&mut self, horizon: f64) -> Option<BadPivot> {
        self.horizon = horizon;
        self.play(self.nodes.len())
    }

    /// When the first gap of the open nodes closes, and of the nodes that touch with it the one of the lowest index: those whose
    /// gaps are within a tie of nothing then.
    fn first_contact(&self) -> Option<(usize, f64)> {
        let now = self.events.last().map_or(0.0, |event| event.time);
        let open = self.courses.iter().zip(&self.open).enumerate();
        let open = open.filter(|(_, (_, open))| **open);
        let courses = open.map(|(position, ((course, _), _))| (position, course));
        let times = courses.clone().map(|(position, course)| (position, course.closes(now)));
        let (first, earliest) = times.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let tie = EXACT_TIE * (self.approach + earliest);
        let tied = courses
            .filter(|(_, course)| course.gap(earliest) <= tie && course.closing(earliest) > 0.0);
        let tied = tied.map(|(position, _)| position);
        let lowest = tied.chain([first]).min_by_key(|&k| self.nodes[k])?;
        Some((lowest, earliest))
    }

    /// Lets the node at `position` touch at `time`.
    ///
    /// # Errors
    ///
    /// Its pivot, if that is not positive; then nothing has changed.
    pub(super) fn touch(&mut self, position: usize, time: f64) -> Result<(), BadPivot> {
        let column = match self.factor.push(&mut self.schur, position) {
            Ok(column) => column,
            Err(pivot) => {
                let node = self.nodes[position];
                return Err(BadPivot { node, time, pivot });
            }
        };
        let inverse = column[position].recip();
        let (own, own_sum) = self.courses[position];
        for ((course, sum), entry) in self.courses.iter_mut().zip(column) {
            let factor = entry * inverse;
            course.subtract(factor, &own);
            *sum -= factor * own_sum;
        }
        self.open[position] = false;
        let unit = own.line.closing * inverse;
        self.events.push(WindowEvent { position, time });
        self.increments.push([unit * unit, own_sum * inverse * unit]);
        Ok(())
    }

    /// Forgets all but the first events. Their nodes are not watched any more.
    pub(super) fn truncate(&mut self, events: usize) {
        self.events.truncate(events);
        self.increments.truncate(events);
        self.factor.truncate(events);
    }

    /// The window of some nodes that have not touched, with the events so far eliminated, from a time on at which their gaps are
    /// `gaps`. It has no horizon.
    pub(super) fn remaining(
        mut self,
        positions: &[usize],
        time: f64,
        gaps: &[f64],
    ) -> Result<Self, crate::Error> {
        self.factor.finish(&mut self.schur);
        let mut remaining = Self::default();
        let lines = positions.iter().zip(gaps).map(|(&position, &gap)| {
            let closing = self.courses[position].0.closing(time);
            (self.nodes[position], GapLine { gap, closing })
        });
        let at = (self.approach + time, f64::INFINITY);
        let (_, schur) = remaining.open(at, lines);
        schur.resize(positions.len())?;
        let mut matrix = schur.matrix_mut();
        for (j, &column) in positions.iter().enumerate() {
            for (i, &row) in positions.iter().enumerate().skip(j) {
                matrix[(i, j)] = self.schur.entry(row, column);
            }
        }
        for (sum, &position) in schur.row_sums_mut().iter_mut().zip(positions) {
            *sum = self.courses[position].1;
        }
        remaining.begin();
        Ok(remaining)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::loading::test_chain::{self, course, pairs};

    /// Nodes 7, 8 and 9 with S = C and σ = row sums of C, before any contact and from the approach 0 on.
    fn window(c: [[f64; 3]; 3], lines: [[f64; 2]; 3], horizon: f64) -> Window {
        let matrix = DMatrix::from_fn(3, 3, |i, j| c[i][j]);
        let sums = c.map(|row| row.iter().sum());
        let lines = [0, 1, 2].map(|k| (7 + k, lines[k]));
        let mut window = test_chain::window(&lines, &matrix, &sums, horizon);
        window.approach = 0.0;
        window
    }

    /// (node, time) of the events.
    fn found(window: &Window) -> Vec<(usize, f64)> {
        let times = window.events().iter().map(|event| event.time);
        window.touched().zip(times).collect()
    }

    const C: [[f64; 3]; 3] = [[2.0, 1.0, 0.0], [1.0, 2.0, 1.0], [0.0, 1.0, 2.0]];
    /// Nodes that do not act on each other.
    const ALONE: [[f64; 3]; 3] = [[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]];

    /// `3 − 2 t + t²/2 + t³/4` and its slope, in numbers that are short in binary.
    #[test]
    fn courses_are_cubics() {
        let course = course([3.0, 2.0, 0.5, 0.25]);
        assert_eq!([course.gap(0.0), course.gap(2.0)], [3.0, 3.0]);
        assert_eq!([course.closing(0.0), course.closing(2.0)], [2.0, -3.0]);
    }

    /// The root of `(1 − t) (1 + t²/10)`, which Newton's steps find to rounding, and that of a line; none of a
    /// gap that opens; and none before the present.
    #[test]
    fn gaps_close_at_their_roots() {
        let cubic = course([1.0, 1.0, 0.1, -0.1]);
        assert!((cubic.closes(0.0) - 1.0).abs() < 1e-15);
        assert_eq!(cubic.closes(1.25), 1.25);
        // `1.1 − t − t³/10`, and `(1 − t)(1 − t/4)`: one of both powers alone.
        for of_one_power in [[1.1, 1.0, 0.0, -0.1], [1.0, 1.25, 0.25, 0.0]] {
            assert!((course(of_one_power).closes(0.0) - 1.0).abs() < 1e-15);
        }
        let line = course([3.0, 2.0, 0.0, 0.0]);
        assert_eq!([line.closes(0.0), line.closes(2.0)], [1.5, 2.0]);
        for opening in [
            [1.0, -1.0, 0.0, 0.0],
            [1.0, 0.0, 0.0, 0.0],
            [1.0, -1.0, 0.5, 0.0],
            [f64::NAN, 1.0, 0.1, 0.0],
        ] {
            assert_eq!(course(opening).closes(0.0), f64::INFINITY);
        }
    }

    #[test]
    fn a_node_that_touches_delays_its_neighbour() {
        // Node 7 touches at 0; then node 8 rises by half of the approach, and touches at 2 instead of 1.
        let mut window = window(C, [[0.0, 1.0], [1.0, 1.0], [5.0, 1.0]], 10.0);
        assert_eq!(window.nodes(), [7, 8, 9]);
        assert_eq!(window.play(2), None);
        let found = found(&window);
        assert_eq!(found[0], (7, 0.0));
        // A few rounding errors of numbers near 1.
        assert!(found[1].0 == 8 && (found[1].1 - 2.0).abs() < 1e-14, "{found:?}");
        let [[first, _], [second, _]] = *window.increments() else {
            unreachable!("two were asked for");
        };
        // eᵀ C⁻¹ e of the first node alone, and of the first two: 1/2 and 2/3.
        assert!((first - 0.5).abs() < 1e-15);
        assert!((first + second - 2.0 / 3.0).abs() < 1e-15);
        assert_eq!(window.untouched().collect::<Vec<_>>(), [9]);
    }

    /// Three nodes of which the second feels half of what the first carries, and the third nothing:
    /// `2 − t + (t − 1)/2` closes at t = 3.
    #[test]
    fn a_node_that_carries_holds_its_neighbours_back() {
        let schur = DMatrix::from_row_slice(3, 3, &[1.0, 0.5, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0, 1.0]);
        let lines = [(7, [1.0, 1.0]), (8, [2.0, 1.0]), (9, [2.5, 1.0])];
        let window = test_chain::window(&lines, &schur, &[3.0, 2.0, 5.0], f64::INFINITY);
        let mut all = window.clone();
        assert!(all.play(9).is_none());
        assert_eq!(pairs(all.events()), [(0, 1.0), (2, 2.5), (1, 3.0)]);
        // Up to the horizon, that included, and up to a number; the first is played in any case.
        for (horizon, count) in [(2.5, 2), (2.4, 1), (0.5, 1)] {
            let [mut until, mut other] = [window.clone(), window.clone()];
            until.horizon = horizon;
            assert_eq!([until.play(9), other.play_until(horizon)], [None; 2]);
            assert_eq!([until.events().len(), other.events().len()], [count; 2]);
            assert_eq!(other.horizon(), horizon);
        }
        let mut few = window.clone();
        assert_eq!((few.play(2), few.events().len()), (None, 2));
        // 1 / (1 − 1/4) of what is left of closing rate and row sum, 1/2 and 2 − 3/2.
        let mut two = window;
        for (position, time) in [(0, 1.0), (1, 3.0)] {
            assert_eq!(two.touch(position, time), Ok(()));
        }
        let expected = [1.0, 3.0, 0.25 / 0.75, 0.25 / 0.75];
        for (found, expected) in two.increments().iter().flatten().zip(expected) {
            assert!((found - expected).abs() < 1e-15, "{found} {expected}");
        }
    }

    #[test]
    fn the_horizon_ends_a_window_but_not_before_its_first_event() {
        let mut early = window(C, [[0.5, 1.0], [1.0, 1.0], [5.0, 1.0]], 0.1);
        assert_eq!(early.play(3), None);
        assert_eq!(early.events().len(), 1);
        // Until the horizon, and at it.
        let lines = [[0.0, 1.0], [1.0, 1.0], [9.0, 1.0]];
        let mut free = window(C, lines, 100.0);
        free.play(2);
        let second = free.events()[1].time;
        for (horizon, events) in [(second, 2), (second * (1.0 - 1e-12), 1)] {
            let mut until = window(C, lines, horizon);
            assert_eq!(until.play(3), None);
            assert_eq!(until.events().len(), events, "horizon {horizon}");
        }
        let mut late = window(C, [[0.5, 1.0], [1.0, 1.0], [5.0, 1.0]], 100.0);
        assert_eq!(late.play(3), None);
        assert_eq!(late.events().len(), 3);
    }

    /// A gap that is nothing and does not close is no contact, and keeps no other one from being found.
    #[test]
    fn gaps_that_do_not_close_never_touch() {
        let mut window = window(C, [[0.0, 0.0], [1.0, 1.0], [5.0, -1.0]], 100.0);
        assert_eq!(window.play(3), None);
        assert_eq!(found(&window), [(8, 1.0)]);
    }

    #[test]
    fn ties_go_to_the_lowest_index_and_times_never_fall() {
        let (near, far) = ([0.0, 1.0], [1.0, 1.0]);
        for (c, lines, order) in [
            (C, [far, near, near], [8, 9, 7]),
            (ALONE, [[2.0, 1.0], far, far], [8, 9, 7]),
            (ALONE, [far, [2.0, 1.0], far], [7, 9, 8]),
        ] {
            let mut window = window(c, lines, 100.0);
            assert_eq!(window.play(3), None);
            assert!(window.touched().eq(order));
            assert!(window.events().is_sorted_by(|a, b| a.time <= b.time));
        }
        // Wherever they are among the watched ones.
        let mut window = test_chain::apart(&[(9, 1.0), (8, 2.0), (7, 1.0)], 100.0);
        assert_eq!(window.play(3), None);
        assert!(window.touched().eq([7, 9, 8]));
    }

    /// Node 9 seems to touch first, by less than a tie: node 8 comes first all the same, and both at times that do not fall.
    /// However slowly they close, it is their gaps that tell.
    #[test]
    fn rounding_does_not_order_ties() {
        let fast = [[5.0, 1.0], [1.0, 1.0], [1.0 - 1e-12, 1.0]];
        let slow = [[5.0, 1.0], [1e-3, 1e-3], [1e-3 - 1e-12, 1e-3]];
        // 10⁻¹³ of the approach, 1 and 21.
        for (approach, lines, order) in
            [(0.0, fast, [9, 8]), (20.0, fast, [8, 9]), (0.0, slow, [9, 8]), (20.0, slow, [8, 9])]
        {
            let mut window = window(ALONE, lines, 4.0);
            window.approach = approach;
            assert_eq!(window.play(3), None);
            assert!(window.touched().eq(order));
            assert!(window.events().is_sorted_by(|a, b| a.time <= b.time));
        }
    }

    /// A pivot that is not positive names its node and when it would have touched, and ends the window. Then nothing has changed.
    #[test]
    fn bad_pivots_are_named() {
        for (matrix, second, time, pivot) in [
            // 4 − t − 2 (t − 1) closes at t = 2, with the pivot 1 − 4.
            ([1.0, -2.0, -2.0, 1.0], [4.0, 1.0], 2.0, -3.0),
            // 4 − 2 t and what the first one carries, t − 1, closes at t = 3: with nothing left of its pivot, or NaN.
            ([1.0, 1.0, 1.0, 1.0], [4.0, 2.0], 3.0, 0.0),
            ([1.0, 1.0, 1.0, f64::NAN], [4.0, 2.0], 3.0, f64::NAN),
        ] {
            let matrix = DMatrix::from_row_slice(2, 2, &matrix);
            let lines = [(7, [1.0, 1.0]), (8, second)];
            let mut window = test_chain::window(&lines, &matrix, &[0.0; 2], f64::INFINITY);
            let bad = window.play(9);
            assert!(bad.is_some_and(|bad| (bad.node, bad.time) == (8, time)));
            assert!(
                bad.is_some_and(|bad| bad.pivot == pivot || pivot.is_nan() && bad.pivot.is_nan())
            );
            assert_eq!((window.events().len(), window.factor().len()), (1, 1));
            assert_eq!(window.untouched().collect::<Vec<_>>(), [8]);
        }
        let singular = [[1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let mut window = window(singular, [[0.0, 1.0], [0.0, 2.0], [9.0, 1.0]], 100.0);
        let bad = window.play(3);
        assert!(bad.is_some_and(|bad| (bad.node, bad.pivot) == (8, 0.0)), "{bad:?}");
        assert_eq!(window.events().len(), 1);
    }

    #[test]
    fn nodes_of_forgotten_events_are_not_watched_any_more() {
        let mut window = window(C, [[0.0, 1.0], [1.0, 1.0], [5.0, 1.0]], 100.0);
        window.play(2);
        window.truncate(1);
        assert_eq!((window.events().len(), window.factor().len()), (1, 1));
        assert_eq!((window.increments().len(), window.touched().len()), (1, 1));
        assert_eq!(window.untouched().collect::<Vec<_>>(), [9]);
    }

    /// Node 7 has touched at 1: of C it leaves (3/2, 1; 1, 2), of row sums 4 − 3/2 and 3, of rates 1 − 1/2 and 1 − 1/4.
    #[test]
    fn what_remains_is_a_window() -> Result<(), crate::Error> {
        let mut window = window(C, [[1.0, 1.0], [2.0, 1.0], [5.0, 1.0]], 100.0);
        window.set_courses(
            [[1.0, 1.0, 0.0, 0.0], [2.0, 1.0, 0.0, 0.0], [5.0, 1.0, 0.125, 0.0]]
                .map(course)
                .into_iter(),
        );
        assert_eq!(window.touch(0, 1.0), Ok(()));
        let remaining = window.remaining(&[2, 1], 1.0, &[0.25, 0.5])?;
        assert_eq!(remaining.nodes(), [9, 8]);
        assert_eq!((remaining.approach, remaining.horizon), (1.0, f64::INFINITY));
        assert_eq!((remaining.position(8), remaining.position(7)), (Some(1), None));
        let schur = remaining.schur();
        let found = [
            schur.entry(0, 0),
            schur.entry(0, 1),
            schur.entry(1, 1),
            schur.row_sums()[0],
            schur.row_sums()[1],
        ];
        let lines = remaining.courses().map(|course| [course.line.gap, course.line.closing]);
        let lines: Vec<f64> = lines.flatten().collect();
        let expected = [2.0, 1.0, 1.5, 3.0, 2.5, 0.25, 0.75, 0.5, 0.5];
        for (found, expected) in found.iter().chain(&lines).zip(expected) {
            assert!((found - expected).abs() < 1e-15, "{found} {expected}");
        }
        let mut remaining = remaining;
        // Node 9 after 1/3; node 8 rises by half of that rate then: 1/2 − t/2 + (3/4) (t − 1/3)/2.
        assert_eq!(remaining.play(9), None);
        assert_eq!(remaining.touched().collect::<Vec<_>>(), [9, 8]);
        Ok(())
    }
}
