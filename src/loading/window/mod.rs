//! The nodes that may touch or yield next, and the events among them.

pub(super) mod correction;
mod course;
pub(super) mod ties;

use std::borrow::Cow;

use super::gap_field::GapLine;
use super::scalars::Rates;
use super::state::ContactEvent;
use super::tuning::{BORDERED, EXACT_TIE};
use crate::updater::{SUMS, Schur, WindowFactor};
pub(super) use course::Course;

/// A node to watch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Watched {
    pub(super) node: usize,
    pub(super) is_elastic: bool,
    pub(super) hardness: f64,
    /// Gap of a node out of contact, or pressure of one in it.
    pub(super) line: GapLine,
    /// What a pressure on it, or an overlap of it, adds to sums over all nodes: of gaps that are not closed, of plastic
    /// depths, and of these times the hardness.
    pub(super) sums: [f64; SUMS],
}

impl Watched {
    /// A node out of contact, with its hardness.
    pub(super) fn apart((node, hardness): (usize, f64), line: GapLine, sums: [f64; SUMS]) -> Self {
        Self { node, is_elastic: false, hardness, line, sums }
    }

    /// A node in contact that has not yielded, with its pressure and how fast that grows, and what a gap of it adds to
    /// the sums over all nodes. An overlap of it adds the opposite, and its own is the depth of a node that has yielded.
    pub(super) fn pressed(
        (node, hardness): (usize, f64),
        [pressure, rate]: [f64; 2],
        of_gap: [f64; SUMS],
    ) -> Self {
        let own = [1.0, 1.0, hardness];
        Self {
            node,
            is_elastic: true,
            hardness,
            line: GapLine { gap: pressure, closing: -rate },
            sums: std::array::from_fn(|k| own[k] - of_gap[k]),
        }
    }

    /// Leaves the pressures of nodes out of contact unwatched that cannot come to their hardness in a window in which
    /// nodes only touch.
    pub(super) fn leave_out_pressures(watched: &mut [Self], schur: &Schur, horizon: f64) {
        let touches = watched.iter().map(|watched| watched.line.touches());
        let last = touches.filter(|time| time.is_finite()).fold(0.0, f64::max);
        let end = if horizon < f64::INFINITY { horizon } else { last };
        for (position, watched) in watched.iter_mut().enumerate() {
            let GapLine { gap, closing } = watched.line;
            let most = BORDERED * (end * closing - gap) / schur.entry(position, position);
            if most < watched.hardness {
                watched.hardness = f64::INFINITY;
            }
        }
    }
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

/// The condition of an event: the gap of a watched node falls to zero, or its pressure rises to its hardness.
#[derive(Debug, Clone, Copy)]
struct Row {
    position: usize,
    kind: ContactEvent,
    /// The value of its course at the event.
    limit: f64,
    /// Gap or pressure, from which the events so far are eliminated; and so from the sums.
    course: Course,
    sums: [f64; SUMS],
    /// Whether the event may still happen: a node yields only once it has touched.
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

/// The nodes that may touch, or yield, before any other, and all that decides among them: the courses of their gaps and
/// pressures, and the matrix M by which an event changes the courses of the others,
///
/// ```text
/// (gaps of nodes out of contact, pressures of elastic nodes) = courses + M (pressures of the former, overlaps of the latter)
/// ```
///
/// M is symmetric, and the Schur complement S where nodes only touch. A touch is a positive pivot, a yield a negative
/// one, in any order: M is quasi-definite. A node that touches and may yield later has a second row, that of its
/// pressure, whose only entry is 1 in the column of its touch.
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
    /// What each event adds to `eᵀ C_II⁻¹ e`, takes off the sum of closing rates, and adds to the rates of plastic
    /// sums.
    increments: Vec<Rates>,
    /// The stiffness behind each event where all elastic nodes are watched: the sum of their rates. Where few of many
    /// nodes are left, the stiffness less what events take from it would be rounding.
    stiffnesses: Option<Vec<f64>>,
}

impl Window {
    /// Opens a window at an approach on nodes and the lines of their gaps; no other node touches before the time
    /// `horizon`. The caller fills the Schur complement and calls [`Self::begin`].
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

    /// Opens a window on nodes that may touch or yield, and begins, with the matrix M of
    /// [`LinearUpdater::watch_both`](crate::updater::LinearUpdater::watch_both) as it has been filled. `elastic` nodes
    /// are in contact. Of nodes out of contact that have a finite hardness pressures are watched as well.
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

    /// Whether pressures of nodes out of contact are watched.
    fn has_borders(&self) -> bool {
        self.rows.len() > self.nodes.len()
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

    /// When a node touches or yields by the line at the beginning of the window, which may lie behind; `None` if it
    /// does not.
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

    /// A pivot before the first event: what a pressure displaces where the node is out of contact, or minus what an
    /// overlap takes of a pressure.
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

    /// What each event adds to `eᵀ C_II⁻¹ e`, the stiffness over the cell area, and what it takes off the sum of
    /// closing rates.
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
        if !self.has_borders() {
            return Ok(Cow::Borrowed(&self.factor));
        }
        let positions: Vec<usize> = self.events.iter().map(|event| event.position).collect();
        WindowFactor::of(self.schur.clone(), &positions).map(Cow::Owned)
    }

    /// What the nodes of the first `count` events have come to at a time behind these and before the next, and how fast
    /// that grows: pressures of those that touched, and overlaps of those that yielded.
    pub(super) fn answers(&self, count: usize, time: f64) -> Vec<[f64; 2]> {
        let mut answers = self.reduced(count, time);
        self.factor.solve_back(&mut answers);
        answers
    }

    /// The same times the transposed factor: where nodes only touch, products of two of these are those of the
    /// pressures by the Schur complement.
    pub(super) fn reduced(&self, count: usize, time: f64) -> Vec<[f64; 2]> {
        let own = self.eliminated.iter().zip(self.factor.positions()).enumerate().take(count);
        let own = own.map(|(event, (course, &row))| {
            let root = self.factor.column(event)[row];
            [-course.gap(time) / root, course.closing(time) / root]
        });
        own.collect()
    }

    /// Plays up to `most` events: what comes first, again and again, until the horizon. Ties go to the node of the
    /// lowest index. Returns what ended it if that is a pivot.
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

    /// When something happens next, and of the nodes that it happens to then the one of the lowest index: those that
    /// are within a tie of it.
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
        let has_borders = self.has_borders();
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

    /// Forgets all but the first events, of which none has joined: their nodes stay watched.
    pub(super) fn take_back(&mut self, events: usize) {
        let taken_back: Vec<usize> =
            self.events.iter().skip(events).map(|event| event.position).collect();
        self.truncate(events);
        for position in taken_back {
            let has_happened = self.events.iter().any(|event| event.position == position);
            self.rows[position].is_open = !has_happened;
        }
    }

    /// Forgets all but the first events. The nodes of the others are not watched any more.
    pub(super) fn truncate(&mut self, events: usize) {
        self.events.truncate(events);
        self.eliminated.truncate(events);
        self.increments.truncate(events);
        self.factor.truncate(events);
    }

    /// The window of some nodes to which more may happen, with the events so far eliminated, from a time on at which
    /// their gaps or pressures are `values`. It has no horizon, and its sums are not those of all nodes.
    pub(super) fn remaining(
        mut self,
        positions: &[usize],
        time: f64,
        values: &[f64],
    ) -> Result<Self, crate::Error> {
        let has_borders = self.has_borders() && !self.events.is_empty();
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
        let watched = places.iter().zip(values).map(|(&place, &gap)| {
            let row = &self.rows[place];
            Watched {
                node: self.nodes[row.position],
                is_elastic: row.kind == ContactEvent::Yield,
                hardness: self.hardness(row.position),
                line: GapLine { gap, closing: row.course.closing(time) },
                sums: row.sums,
            }
        });
        let watched: Vec<Watched> = watched.collect();
        for (sum, watched) in remaining.row_sums_mut().iter_mut().zip(&watched) {
            *sum = watched.sums[0];
        }
        let mut window = Self { schur: remaining, ..Self::default() };
        window.begin_both((self.approach + time, f64::INFINITY), &watched, usize::MAX);
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
mod tests;
