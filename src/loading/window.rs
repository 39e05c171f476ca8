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
        if t.is_nan() {
            f64::INFINITY
        } else {
            t.max(now)
        }
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
        let times = courses
            .clone()
            .map(|(position, course)| (position, course.closes(now)));
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
        self.increments
            .push([unit * unit, own_sum * inverse * unit]);
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
