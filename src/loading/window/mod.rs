//! The nodes that may touch or yield next, and the events among them.

pub(super) mod correction;
pub(super) mod ties;

use std::borrow::Cow;

use super::gap_field::GapLine;
use super::scalars::Rates;
use super::state::ContactEvent;
use super::tuning::{EXACT_TIE, NEWTON};
use crate::updater::{Schur, WindowFactor};

/// The course of a gap, or of the pressure of a node in contact, as long as nothing happens to a watched node: a line,
/// `gap − t closing`, and what is known of its curvature, `c₂ t² + c₃ t³`.
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

    /// What is left up to a limit that it rises to.
    fn below(&self, limit: f64) -> Self {
        let Self { line: GapLine { gap, closing }, curve } = *self;
        let line = GapLine { gap: limit - gap, closing: -closing };
        Self { line, curve: curve.map(|c| -c) }
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

/// A node to watch where nodes may yield.
#[derive(Debug, Clone, Copy)]
pub(super) struct Watched {
    pub(super) node: usize,
    pub(super) is_elastic: bool,
    pub(super) hardness: f64,
    /// Gap of a node out of contact, or pressure of one in it.
    pub(super) line: GapLine,
    /// What a pressure on it, or an overlap of it, adds to sums over all nodes: of gaps that are not closed, of plastic depths, and of
    /// these times the hardness.
    pub(super) sums: [f64; SUMS],
}

pub(super) const SUMS: usize = 3;

/// What an overlap of a node in contact adds to the sums of [`Watched`], from what a gap of it adds to the same over all nodes: its own
/// is the depth of a node that has yielded.
pub(super) fn of_overlap(of_gap: [f64; SUMS], hardness: f64) -> [f64; SUMS] {
    [1.0 - of_gap[0], 1.0 - of_gap[1], hardness - of_gap[2]]
}

/// What happens to a watched node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct WindowEvent {
    /// Which of the watched nodes.
    pub(super) position: usize,
    /// Touch or yield.
    pub(super) kind: ContactEvent,
    /// How much further the approach is then than where the window began.
    pub(super) time: f64,
    /// How fast it came: a gap closes, or a pressure grows times what a pressure displaces, by so much of the approach.
    pub(super) closing: f64,
}

impl WindowEvent {
    /// Whether both are the same event, at whatever time.
    pub(super) fn is(&self, other: &Self) -> bool {
        (self.position, self.kind) == (other.position, other.kind)
    }
}

/// A node that cannot touch or yield: its pivot has the wrong sign.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BadPivot {
    pub(super) node: usize,
    pub(super) time: f64,
    pub(super) pivot: f64,
}

/// A condition that a watched node may come to: its gap to nothing, or its pressure to its hardness.
#[derive(Debug, Clone, Copy)]
struct Row {
    position: usize,
    kind: ContactEvent,
    /// Value that its course comes to.
    limit: f64,
    /// Gap or pressure, from which the events so far are eliminated; and so from the sums.
    course: Course,
    sums: [f64; SUMS],
    /// Whether it has yet to come to it, and is in the state to do so.
    is_open: bool,
}

impl Row {
    /// What is left until the event.
    fn left(&self) -> Course {
        match self.kind {
            ContactEvent::Touch => self.course,
            _ => self.course.below(self.limit),
        }
    }
}

/// The nodes that may touch, or yield, before any other, and all that decides among them: the courses of their gaps and pressures, and
/// the matrix M by which an event changes the courses of the others,
///
/// ```text
/// (gaps of nodes out of contact, pressures of elastic nodes) = courses + M (pressures of the former, overlaps of the latter)
/// ```
///
/// M is symmetric, and the Schur complement S where nodes only touch. A touch is a positive pivot, a yield a negative one, in any order:
/// M is quasi-definite. A node that touches and may yield later has a second row, that of its pressure, whose only entry is 1 in the column
/// of its touch.
///
/// Everything here is small and dense; it knows nothing of the grid, the updater, or the path.
#[derive(Debug, Clone, Default)]
pub(super) struct Window {
    /// Where the window began.
    approach: f64,
    /// Nothing happens to another node before this time.
    horizon: f64,
    nodes: Vec<usize>,
    /// A row for each node, and behind them those of the pressures of nodes out of contact, where these may yield.
    rows: Vec<Row>,
    schur: Schur,
    /// M with the rows of these pressures, once there are events.
    bordered: Schur,
    factor: WindowFactor,
    events: Vec<WindowEvent>,
    /// The courses of these rows when they were eliminated, less the limit.
    eliminated: Vec<Course>,
    /// What each event adds to `eᵀ C_II⁻¹ e`, takes off the sum of closing rates, and adds to the rates of plastic sums.
    increments: Vec<Rates>,
    /// The stiffness behind each event where all elastic nodes are watched: the sum of their rates. Where few are left of many, what
    /// events take from it is no use.
    stiffnesses: Option<Vec<f64>>,
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
        self.rows.clear();
        for (position, (node, line)) in lines.enumerate() {
            self.nodes.push(node);
            self.rows.push(Row {
                position,
                kind: ContactEvent::Touch,
                limit: 0.0,
                course: line.into(),
                sums: [0.0; SUMS],
                is_open: true,
            });
        }
        (&self.nodes, &mut self.schur)
    }

    /// Begins with the Schur complement as it has been filled.
    pub(super) fn begin(&mut self) {
        for (row, filled) in self.rows.iter_mut().zip(self.schur.row_sums()) {
            row.sums[0] = *filled;
        }
        let size = self.nodes.len();
        self.reset();
        self.stiffnesses = None;
        self.factor.reset(size, size);
        // So that no event ever allocates.
        self.events.reserve(size);
        self.eliminated.reserve(size);
        self.increments.reserve(size);
    }

    /// Opens a window on nodes that may yield, and begins, with the matrix M of
    /// [`LinearUpdater::watch_both`](crate::updater::LinearUpdater::watch_both) as it has been filled. `elastic` nodes are in contact. Of
    /// nodes out of contact that have a finite hardness pressures are watched as well.
    pub(super) fn begin_both(&mut self, at: (f64, f64), watched: &[Watched], elastic: usize) {
        let lines = watched.iter().map(|watched| (watched.node, watched.line));
        self.open(at, lines);
        let mut pressures = Vec::new();
        for (row, watched) in self.rows.iter_mut().zip(watched) {
            row.sums = watched.sums;
            let yields = Row { kind: ContactEvent::Yield, limit: watched.hardness, ..*row };
            if watched.is_elastic {
                *row = yields;
            } else if watched.hardness.is_finite() {
                let course = GapLine { gap: 0.0, closing: 0.0 }.into();
                let sums = [1.0, 1.0, watched.hardness];
                pressures.push(Row { course, sums, is_open: false, ..yields });
            }
        }
        let inside = watched.iter().filter(|watched| watched.is_elastic).count();
        let is_whole = inside == elastic && inside + pressures.len() == watched.len();
        self.rows.extend(pressures);
        self.reset();
        self.stiffnesses = is_whole.then(Vec::new);
        self.factor.reset(self.rows.len(), self.nodes.len());
    }

    /// Forgets all events.
    fn reset(&mut self) {
        self.bordered = Schur::default();
        self.events.clear();
        self.eliminated.clear();
        self.increments.clear();
    }

    /// A window that ended with these nodes watched, none of which has touched: what the next one knows of it.
    pub(super) fn ended_with(nodes: Vec<usize>) -> Self {
        let mut ended = Self::default();
        let line = GapLine { gap: 0.0, closing: 0.0 };
        ended.open((0.0, 0.0), nodes.into_iter().map(|node| (node, line)));
        ended
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

    /// Nothing happens to another node before this time.
    pub(super) fn horizon(&self) -> f64 {
        self.horizon
    }

    /// Whether the node at a position was in contact when the window began.
    pub(super) fn is_elastic(&self, position: usize) -> bool {
        self.rows[position].kind == ContactEvent::Yield
    }

    /// The courses of the watched nodes, from which the events so far are eliminated.
    pub(super) fn courses(&self) -> impl ExactSizeIterator<Item = &Course> + Clone {
        self.rows[..self.nodes.len()].iter().map(|row| &row.course)
    }

    /// The course of one of them.
    pub(super) fn course(&self, position: usize) -> &Course {
        &self.rows[position].course
    }

    /// Gives the watched nodes other courses.
    pub(super) fn set_courses(&mut self, courses: impl Iterator<Item = Course>) {
        for (row, course) in self.rows[..self.nodes.len()].iter_mut().zip(courses) {
            row.course = course;
        }
    }

    /// When a node touches or yields by the line at the beginning of the window, which may lie behind; `None` if it does not.
    pub(super) fn own_time(&self, position: usize) -> Option<f64> {
        let GapLine { gap, closing } = self.rows[position].left().line;
        (closing > 0.0 && gap.is_finite()).then_some(gap / closing)
    }

    /// How fast an event comes, by the line at the beginning of the window where there is one.
    pub(super) fn closing(&self, event: &WindowEvent) -> f64 {
        let row = &self.rows[event.position];
        match (row.kind, event.kind) {
            (ContactEvent::Touch, ContactEvent::Touch) => row.course.line.closing,
            (ContactEvent::Yield, _) => row.course.line.closing / self.pivot(event.position),
            _ => event.closing,
        }
    }

    /// A pivot before the first event: what a pressure displaces where the node is out of contact, or minus what an overlap takes of a
    /// pressure.
    pub(super) fn pivot(&self, position: usize) -> f64 {
        self.schur.entry(position, position)
    }

    /// The matrix M, before the first event.
    pub(super) fn schur(&self) -> &Schur {
        &self.schur
    }

    /// The matrix M to change, before the first event.
    pub(super) fn schur_mut(&mut self) -> &mut Schur {
        &mut self.schur
    }

    /// Moves the beginning back by a time, before the first event.
    pub(super) fn move_back(&mut self, time: f64) {
        self.approach -= time;
        for row in &mut self.rows {
            row.course.line.gap += time * row.course.line.closing;
        }
    }

    /// Whether every pivot of M has the right sign, whatever the order of events.
    pub(super) fn is_sound(&self) -> bool {
        let mut parts = self.schur.clone();
        let size = parts.size();
        let mut matrix = parts.matrix_mut();
        for j in 0..size {
            for i in j..size {
                matrix[(i, j)] *= match (self.is_elastic(i), self.is_elastic(j)) {
                    (false, false) => 1.0,
                    (true, true) => -1.0,
                    _ => 0.0,
                };
            }
        }
        let all: Vec<usize> = (0..size).collect();
        WindowFactor::of(parts, &all).is_ok()
    }

    /// Watched nodes that have not touched, in the order of the window.
    pub(super) fn untouched(&self) -> impl Iterator<Item = usize> {
        let rows = self.nodes.iter().zip(&self.rows);
        rows.filter(|(_, row)| row.is_open).map(|(&node, _)| node)
    }

    /// The events, in their order.
    pub(super) fn events(&self) -> &[WindowEvent] {
        &self.events
    }

    /// What each event adds to `eᵀ C_II⁻¹ e`, the stiffness over the cell area, and what it takes off the sum of closing rates.
    pub(super) fn increments(&self) -> impl ExactSizeIterator<Item = [f64; 2]> {
        self.increments.iter().map(|rates| [rates.unit_stiffness, rates.closing])
    }

    /// The rates behind each event.
    pub(super) fn rates(&self, start: Rates) -> Vec<Rates> {
        let mut rates = start;
        let behind = |(k, more): (usize, &Rates)| {
            rates.unit_stiffness += more.unit_stiffness;
            rates.closing -= more.closing;
            (0..2).for_each(|k| rates.plastic[k] += more.plastic[k]);
            let stiffness = self.stiffnesses.as_ref().and_then(|all| all.get(k)).copied();
            Rates { unit_stiffness: stiffness.unwrap_or(rates.unit_stiffness), ..rates }
        };
        self.increments.iter().enumerate().map(behind).collect()
    }

    /// Whether nodes only touch in all events.
    pub(super) fn is_of_touches(&self) -> bool {
        self.events.iter().all(|event| event.kind == ContactEvent::Touch)
    }

    /// The nodes of the events, in their order.
    pub(super) fn touched(&self) -> impl ExactSizeIterator<Item = usize> {
        self.events.iter().map(|event| self.nodes[event.position])
    }

    /// The factor of the Schur complement of nodes that touched, where all events are touches.
    pub(super) fn touched_factor(&self) -> Result<Cow<'_, WindowFactor>, crate::Error> {
        if self.rows.len() == self.nodes.len() {
            return Ok(Cow::Borrowed(&self.factor));
        }
        let positions: Vec<usize> = self.events.iter().map(|event| event.position).collect();
        WindowFactor::of(self.schur.clone(), &positions).map(Cow::Owned)
    }

    /// What the nodes of the events have come to at a time behind them, and how fast that grows: pressures of those that touched, and
    /// overlaps of those that yielded.
    pub(super) fn answers(&self, time: f64) -> Vec<[f64; 2]> {
        let own = self.eliminated.iter().zip(self.factor.positions()).enumerate();
        let own = own.map(|(event, (course, &row))| {
            let root = self.factor.column(event)[row];
            [-course.gap(time) / root, course.closing(time) / root]
        });
        let mut answers: Vec<[f64; 2]> = own.collect();
        self.factor.solve_back(&mut answers);
        answers
    }

    /// Plays up to `most` events: what comes first, again and again, until the horizon. Ties go to the node of the lowest index. Returns
    /// what ended it if that is a pivot.
    ///
    /// The first event always counts: the horizon is the bound of a node that was later, so that anything
    /// else is rounding; and so is a time before that of the last event.
    pub(super) fn play(&mut self, most: usize) -> Option<BadPivot> {
        self.play_while(|events| events.len() < most)
    }

    /// The same until so many nodes have touched.
    pub(super) fn play_touches(&mut self, most: usize) -> Option<BadPivot> {
        let touches = |events: &[WindowEvent]| {
            events.iter().filter(|event| event.kind == ContactEvent::Touch).count()
        };
        self.play_while(|events| events.len() < most || touches(events) < most)
    }

    fn play_while(&mut self, goes_on: impl Fn(&[WindowEvent]) -> bool) -> Option<BadPivot> {
        while goes_on(&self.events) {
            let (row, time) = self.next()?;
            if time == f64::INFINITY || (time > self.horizon && !self.events.is_empty()) {
                return None;
            }
            if let Err(bad) = self.eliminate(row, time) {
                return Some(bad);
            }
        }
        None
    }

    /// The same until another horizon.
    pub(super) fn play_until(&mut self, horizon: f64) -> Option<BadPivot> {
        self.horizon = horizon;
        self.play(usize::MAX)
    }

    /// When something happens next, and of the nodes that it happens to then the one of the lowest index: those that are within a tie of
    /// it.
    fn next(&self) -> Option<(usize, f64)> {
        let now = self.events.last().map_or(0.0, |event| event.time);
        let open = self.rows.iter().enumerate();
        let open = open.filter(|(_, row)| row.is_open && row.limit.is_finite());
        let times = open.clone().map(|(place, row)| (place, row.left().closes(now)));
        let (first, earliest) = times.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let length = EXACT_TIE * (self.approach + earliest);
        let tied = open.filter(|(_, row)| {
            let tie = if row.kind == ContactEvent::Touch { length } else { EXACT_TIE * row.limit };
            let left = row.left();
            left.gap(earliest) <= tie && left.closing(earliest) > 0.0
        });
        let tied = tied.map(|(place, _)| place);
        let lowest = tied.chain([first]).min_by_key(|&place| self.nodes[self.rows[place].position]);
        Some((lowest?, earliest))
    }

    /// The row of the pressure of a node that has touched in the window, where that is watched.
    fn pressure_row(&self, position: usize) -> Option<usize> {
        let mut pressures = self.nodes.len()..self.rows.len();
        pressures.find(|&row| self.rows[row].position == position)
    }

    /// The row of what can happen to the node at `position`.
    fn open_row(&self, position: usize) -> usize {
        let touched = Some(position).filter(|&position| !self.rows[position].is_open);
        touched.and_then(|position| self.pressure_row(position)).unwrap_or(position)
    }

    /// Lets the node at `position` touch, or yield if it has, at `time`.
    ///
    /// # Errors
    ///
    /// Its pivot, if that has the wrong sign; then nothing has changed.
    pub(super) fn happen(&mut self, position: usize, time: f64) -> Result<(), BadPivot> {
        self.eliminate(self.open_row(position), time)
    }

    fn eliminate(&mut self, place: usize, time: f64) -> Result<(), BadPivot> {
        let Row { position, kind, limit, course, sums: own_sums, .. } = self.rows[place];
        let sign = if kind == ContactEvent::Touch { 1.0 } else { -1.0 };
        let has_borders = self.rows.len() > self.nodes.len();
        if has_borders && self.events.is_empty() {
            let borders = self.rows[self.nodes.len()..].iter().map(|row| row.position);
            self.bordered = self.schur.bordered(borders);
        }
        let matrix = if has_borders { &mut self.bordered } else { &mut self.schur };
        let column = self.factor.push(matrix, place, sign).map_err(|pivot| {
            let node = self.nodes[position];
            BadPivot { node, time, pivot }
        })?;
        let inverse = column[place].recip();
        let mut own = course;
        own.line.gap -= limit;
        for (row, entry) in self.rows.iter_mut().zip(column) {
            let factor = entry * inverse;
            row.course.subtract(factor, &own);
            for (sum, own) in row.sums.iter_mut().zip(own_sums) {
                *sum -= factor * own;
            }
        }
        self.rows[place].is_open = false;
        if let Some(pressure) = self.pressure_row(position).filter(|&row| row != place) {
            self.rows[pressure].is_open = true;
        }
        let unit = own.line.closing * inverse;
        let [gaps, depths, work] = own_sums.map(|sum| sign * (sum * inverse * unit));
        let unit_stiffness = sign * (unit * unit);
        self.increments.push(Rates { unit_stiffness, closing: gaps, plastic: [depths, work] });
        let closing = own.closing(time) * if sign > 0.0 { 1.0 } else { -inverse * inverse };
        self.events.push(WindowEvent { position, kind, time, closing });
        self.eliminated.push(own);
        if let Some(stiffnesses) = &mut self.stiffnesses {
            let elastic =
                self.rows.iter().filter(|row| row.is_open && row.kind != ContactEvent::Touch);
            stiffnesses.push(elastic.map(|row| -row.course.closing(time)).sum());
        }
        Ok(())
    }

    /// Forgets all but the first events. Their nodes are not watched any more.
    pub(super) fn truncate(&mut self, events: usize) {
        self.events.truncate(events);
        self.eliminated.truncate(events);
        self.increments.truncate(events);
        self.factor.truncate(events);
    }

    /// The window of some nodes to which more may happen, with the events so far eliminated, from a time on at which their gaps or
    /// pressures are `values`. It has no horizon, and its sums are not those of all nodes.
    pub(super) fn remaining(
        mut self,
        positions: &[usize],
        time: f64,
        values: &[f64],
    ) -> Result<Self, crate::Error> {
        let has_borders = self.rows.len() > self.nodes.len() && !self.events.is_empty();
        let matrix = if has_borders { &mut self.bordered } else { &mut self.schur };
        self.factor.finish(matrix);
        let places: Vec<usize> =
            positions.iter().map(|&position| self.open_row(position)).collect();
        let matrix = if has_borders { &self.bordered } else { &self.schur };
        let mut remaining = Schur::default();
        remaining.resize(places.len())?;
        for (j, &column) in places.iter().enumerate() {
            for (i, &row) in places.iter().enumerate().skip(j) {
                remaining.matrix_mut()[(i, j)] = matrix.entry(row, column);
            }
        }
        let rows = places.iter().zip(values).map(|(&place, &gap)| {
            let row = &self.rows[place];
            let line = GapLine { gap, closing: row.course.closing(time) };
            (self.nodes[row.position], line, row)
        });
        let mut window = Self::default();
        let at = (self.approach + time, f64::INFINITY);
        if self.rows.len() == self.nodes.len()
            && !rows.clone().any(|(.., row)| row.kind != ContactEvent::Touch)
        {
            let lines = rows.clone().map(|(node, line, _)| (node, line));
            let (_, schur) = window.open(at, lines);
            *schur = remaining;
            for (sum, (.., row)) in schur.row_sums_mut().iter_mut().zip(rows) {
                *sum = row.sums[0];
            }
            window.begin();
            return Ok(window);
        }
        let watched = rows.map(|(node, line, row)| {
            let is_elastic = row.kind == ContactEvent::Yield;
            let hardness = self.hardness(row.position);
            Watched { node, is_elastic, hardness, line, sums: row.sums }
        });
        let watched: Vec<Watched> = watched.collect();
        window.schur = remaining;
        window.begin_both(at, &watched, usize::MAX);
        Ok(window)
    }

    /// The pressure at which the node at a position yields.
    fn hardness(&self, position: usize) -> f64 {
        let rows = self.rows.iter().filter(|row| row.position == position);
        let mut yields = rows.filter(|row| row.kind == ContactEvent::Yield);
        yields.next().map_or(f64::INFINITY, |row| row.limit)
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
        let added: Vec<f64> = window.increments().map(|[stiffness, _]| stiffness).collect();
        let [first, second] = added[..] else {
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
            assert_eq!(two.happen(position, time), Ok(()));
        }
        let expected = [1.0, 3.0, 0.25 / 0.75, 0.25 / 0.75];
        for (found, expected) in two.increments().flatten().zip(expected) {
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
            assert_eq!((window.events().len(), window.factor.len()), (1, 1));
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
        assert_eq!((window.events().len(), window.factor.len()), (1, 1));
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
        assert_eq!(window.happen(0, 1.0), Ok(()));
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

    /// Two nodes with C = (2, 1; 1, 2), gaps 0 and 1 and these hardnesses, of which none is in contact.
    fn two(hardness: [f64; 2], horizon: f64) -> Result<Window, crate::Error> {
        let mut schur = Schur::default();
        schur.resize(2)?;
        schur.as_mut_slice().copy_from_slice(&[2.0, 1.0, f64::NAN, 2.0]);
        let watched = [0, 1].map(|k| Watched {
            node: 7 + k,
            is_elastic: false,
            hardness: hardness[k],
            line: test_chain::gap_line([k as f64, 1.0]),
            sums: [3.0, 0.0, 0.0],
        });
        let mut window = Window { schur, ..Window::default() };
        window.begin_both((0.0, horizon), &watched, 0);
        Ok(window)
    }

    const NOTHING: Rates = Rates { unit_stiffness: 0.0, closing: 2.0, plastic: [0.0; 2] };

    /// (kind, place, time) of the events.
    fn kinds(window: &Window) -> Vec<(ContactEvent, usize, f64)> {
        window.events().iter().map(|event| (event.kind, event.position, event.time)).collect()
    }

    /// Touch at 0, yield at 3/2, touch at 7/4, yield at 13/4. With one node elastic the other sinks half as fast as the approach;
    /// with none all gaps close, and overlaps grow, as fast as that.
    #[test]
    fn both_kinds_of_events() -> Result<(), crate::Error> {
        use ContactEvent::{Touch, Yield};
        let expected = [
            (Touch, 0, 0.0, 0.5, 0.5, [0.0, 0.0]),
            (Yield, 0, 1.5, 0.0, 1.0, [1.0, 0.75]),
            (Touch, 1, 1.75, 0.5, 0.0, [0.5, 0.375]),
            (Yield, 1, 3.25, 0.0, 0.0, [2.0, 1.5]),
        ];
        for most in [4, 2, 9] {
            let mut window = two([0.75; 2], f64::INFINITY)?;
            assert_eq!(window.play(most), None);
            assert_eq!(window.events().len(), most.min(4));
            let rates = window.rates(NOTHING);
            for ((event, rates), (kind, position, time, unit, closing, plastic)) in
                window.events().iter().zip(rates).zip(expected)
            {
                assert_eq!((event.kind, event.position), (kind, position));
                let found = [event.time, rates.unit_stiffness, rates.closing];
                let found = found.into_iter().chain(rates.plastic);
                for (found, expected) in found.zip([time, unit, closing, plastic[0], plastic[1]]) {
                    // A few rounding errors of numbers near 1.
                    assert!((found - expected).abs() < 1e-14, "{kind:?}: {found} {expected}");
                }
            }
            if most < 4 {
                continue;
            }
            // Pressures are at the hardness. One has yielded by 7/4 − 3/4, and the other has only just; both overlap as fast as
            // the approach grows.
            let found = window.answers(3.25);
            let expected = [[0.75, 0.0], [1.0, 1.0], [0.75, 0.0], [0.0, 1.0]];
            for (found, expected) in found.iter().flatten().zip(expected.as_flattened()) {
                assert!((found - expected).abs() < 1e-14, "{found} {expected}");
            }
        }
        Ok(())
    }

    /// Until a horizon, though the first event always counts; not beyond so many that touch; and an infinite hardness is never
    /// reached.
    #[test]
    fn windows_end() -> Result<(), crate::Error> {
        for (horizon, touches, events) in
            [(1.6, 2, 2), (-1.0, 2, 1), (f64::INFINITY, 1, 1), (f64::INFINITY, 0, 0)]
        {
            let mut window = two([0.75; 2], horizon)?;
            assert_eq!(window.play_touches(touches), None);
            assert_eq!(window.events().len(), events, "{horizon} {touches}");
        }
        let mut hard = two([f64::INFINITY; 2], f64::INFINITY)?;
        assert_eq!(hard.play(9), None);
        let [(ContactEvent::Touch, 0, first), (ContactEvent::Touch, 1, second)] = kinds(&hard)[..]
        else {
            unreachable!("two touch");
        };
        // A few rounding errors.
        assert!(first == 0.0 && (second - 2.0).abs() < 1e-14);
        Ok(())
    }

    /// Elastic nodes at equal pressures yield in the order of their indices, and the stiffness is what is left of their rates.
    #[test]
    fn nodes_that_yield_at_once_are_in_order() -> Result<(), crate::Error> {
        let mut schur = Schur::default();
        schur.resize(2)?;
        // C⁻¹ = (2, −1; −1, 2)/3, of overlaps.
        schur.as_mut_slice().copy_from_slice(&[-2.0 / 3.0, 1.0 / 3.0, f64::NAN, -2.0 / 3.0]);
        let watched = [9, 4].map(|node| Watched {
            node,
            is_elastic: true,
            hardness: 1.0,
            line: test_chain::gap_line([0.5, -1.0 / 3.0]),
            sums: [0.0; SUMS],
        });
        let mut window = Window { schur, ..Window::default() };
        window.begin_both((1.0, f64::INFINITY), &watched, 2);
        assert_eq!(window.play_touches(0), None);
        assert!(window.events().is_empty());
        assert_eq!(window.play(9), None);
        assert_eq!(kinds(&window).iter().map(|event| event.1).collect::<Vec<_>>(), [1, 0]);
        assert!((kinds(&window)[0].2 - 1.5).abs() < 1e-15);
        // 2/3 of both, then 1/2 of one alone, then nothing.
        let rates = window.rates(Rates { unit_stiffness: 2.0 / 3.0, ..NOTHING });
        for (rates, expected) in rates.iter().zip([0.5, 0.0]) {
            assert!((rates.unit_stiffness - expected).abs() < 1e-15, "{rates:?}");
        }
        Ok(())
    }

    /// What remains of a window is one of its own: both nodes alone at 8/5, when node 7 has yielded and node 8 has been found 1/16
    /// away from the surface. It touches that much later, and yields 3/2 after that.
    #[test]
    fn what_remains_may_yield() -> Result<(), crate::Error> {
        use ContactEvent::{Touch, Yield};
        let mut window = two([0.75; 2], f64::INFINITY)?;
        for time in [0.0, 1.5] {
            assert_eq!(window.happen(0, time), Ok(()));
        }
        assert_eq!(kinds(&window), [(Touch, 0, 0.0), (Yield, 0, 1.5)]);
        let mut remaining = window.remaining(&[1], 1.625, &[0.0625])?;
        assert_eq!((remaining.nodes(), remaining.own_time(0)), (&[8][..], Some(0.0625)));
        // Moved back, all of it comes later.
        remaining.move_back(0.25);
        assert_eq!(remaining.own_time(0), Some(0.3125));
        assert_eq!(remaining.play(9), None);
        let events = kinds(&remaining);
        assert_eq!(events[0], (Touch, 0, 0.3125));
        // S of node 8 alone is 2, so that 3/4 take 3/2 of approach.
        assert!(events[1].0 == Yield && (events[1].2 - 1.8125).abs() < 1e-14, "{events:?}");
        Ok(())
    }

    /// Of what is elastic when it remains, the pressure is known: 1/2 of 3/4, which takes as much approach again as 2 · 1/4.
    #[test]
    fn what_remains_may_be_elastic() -> Result<(), crate::Error> {
        let mut window = two([0.75; 2], f64::INFINITY)?;
        assert_eq!(window.happen(0, 0.0), Ok(()));
        let mut remaining = window.remaining(&[0], 1.0, &[0.5])?;
        assert!(remaining.is_elastic(0));
        assert_eq!(remaining.play(9), None);
        let [(ContactEvent::Yield, 0, time)] = kinds(&remaining)[..] else {
            unreachable!("one yields");
        };
        assert!((time - 0.5).abs() < 1e-14, "{time}");
        Ok(())
    }
}
