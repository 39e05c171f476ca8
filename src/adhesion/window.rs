//! The events of a window: along one parameter, among the nodes that are watched.

use super::board::{Beginning, Board, Change, LAG, Left, Row};
use super::front::{Body, Field, Front};
use super::law::CohesiveLaw;
use super::moment::{Moment, Totals};
use super::rows::Rows;
use super::state::{AdhesiveEvent, Direction, NodeState};
use super::target::{Measured, Targets, force_unit};
use crate::contact::ContactState;
use crate::error::AdhesionError;
use crate::kernel::Gauge;
use crate::tied_events::TiedEvents;
use crate::{Error, Grid};

/// By how much a pressure may be beyond its law at the end of a window, relative to the stress, and what gaps that
/// moves: ten times the lag with which a node that is carried is put on its law, or held at an end of it, which others
/// answer to. Soft nodes near an instability amplify it.
const SLACK: f64 = 10.0 * LAG;
/// The same for rounding of gaps, relative to the greatest length. A pressure in contact is off by what displaces its
/// node by that, which may be 10⁷ times the stress where stiff bodies stick a little.
pub(super) const ROUNDING: f64 = 1e-12;
/// Pressures are off by so many times more, for neighbours that are in contact too.
const AMONG_OTHERS: f64 = 10.0;
/// How often a window is tried, with more nodes or with fewer events each time.
const TRIES: usize = 60;
/// Other nodes that are watched in a window of all soft ones.
const ALONE: usize = 64;
/// How often a window is opened again for nodes that it lacks, before it is played with fewer events instead.
const REOPENED: usize = 3;

/// What a window needs to know of its path.
pub(super) struct View<'a> {
    pub(super) direction: Direction,
    pub(super) targets: &'a Targets,
    pub(super) gauge: Gauge,
    pub(super) totals: Totals,
    pub(super) last_node: usize,
}

/// A window, and where it has led.
pub(super) struct Played {
    pub(super) front: Front,
    pub(super) field: Field,
    /// Event, node, scalars, and how many changes there were up to it.
    pub(super) moments: Vec<(AdhesiveEvent, usize, Moment, usize)>,
    pub(super) changes: Vec<Change>,
    pub(super) totals: Totals,
    /// The node at which a jump has begun.
    pub(super) jump: Option<usize>,
    pub(super) is_at_limit: bool,
    pub(super) taken_back: usize,
    pub(super) shortened: usize,
}

/// Follows events until something may happen to a node that is not watched, until a jump begins or the pull of its next
/// node is carried, or to a target; `None` if nothing happens any more. A window that its end contradicts is tried
/// again: the nodes that are beyond their law are watched as well, and fewer events follow.
pub(super) fn follow(
    body: &mut Body,
    front: &Front,
    field: &Field,
    view: &View<'_>,
    size: usize,
) -> Result<Option<Played>, Error> {
    let mut also = Vec::new();
    let (mut most, mut watched) = (usize::MAX, size);
    let mut known = None;
    for taken_back in 0..TRIES {
        let mut play = Play::open(body, front, field, view, (watched, &also), known.take())?;
        let may_grow = also.len() < size && taken_back < REOPENED;
        let ended = match play.play_out(body, front, field, (most.min(size), may_grow))? {
            Outcome::Nothing => return Ok(None),
            Outcome::Led(ended) => ended,
            Outcome::Lacks(nodes) => {
                also.extend(nodes);
                known = Some(play.rows);
                continue;
            }
            Outcome::LacksSoft => {
                watched = usize::MAX;
                known = Some(play.rows);
                continue;
            }
        };
        play.add_energies(body, field);
        body.follow(&ended)?;
        let found = body.survey(&ended, view.direction.sign());
        let is_least = play.is_least(most.min(size));
        let wrong = match &found {
            Ok(field) => beyond(body, &ended, field),
            Err(Error::FactorizationFailed { .. }) if !is_least => vec![(usize::MAX, 1.0)],
            Err(_) => Vec::new(),
        };
        let field = match (wrong.is_empty(), found) {
            (true, found) => found?,
            (false, _) => {
                body.go_back(front)?;
                let (node, value) = wrong[0];
                let is_new = wrong.iter().any(|(node, _)| !also.contains(node));
                if is_least && !is_new {
                    let (ix, iy) = body.problem.grid().coordinates(node);
                    return Err(AdhesionError::NotOnLaw {
                        ix,
                        iy,
                        approach: ended.approach,
                        value,
                    }
                    .into());
                }
                also.extend(wrong.iter().map(|&(node, _)| node).filter(|&node| node < usize::MAX));
                most = (play.events / 2).max(1);
                continue;
            }
        };
        let lost = play.board.lost_to(|node| [field.pressure[0][node], field.gap[0][node]]);
        play.totals.dissipated += play.area() * lost;
        return Ok(Some(Played {
            front: ended,
            field,
            moments: play.moments,
            changes: play.board.changes,
            totals: play.totals,
            jump: play.jump,
            is_at_limit: play.is_at_limit,
            taken_back,
            shortened: play.shortened,
        }));
    }
    Err(Error::Cycling { approach: front.approach, events: TRIES })
}

/// Nodes that are beyond the law of their state, and by how much.
fn beyond(body: &Body, front: &Front, field: &Field) -> Vec<(usize, f64)> {
    let law = &body.law;
    let length = body.greatest_length(front.approach);
    let of_gap = (law.gap_of(SLACK) + ROUNDING * length) / law.range() / body.least_pivot();
    // What the stress displaces a node by that it acts on.
    let displaced = law.resolution() * (law.range() - law.flat_range());
    let of_pressure = (SLACK + AMONG_OTHERS * ROUNDING * length / displaced) / body.least_pivot();
    let nodes = front.nodes.iter().enumerate().filter_map(|(node, &state)| {
        let value = excess(law, state, [field.pressure[0][node], field.gap[0][node]]);
        let slack = if state == NodeState::Contact { of_pressure } else { of_gap };
        (value.is_nan() || value > slack).then_some((node, value))
    });
    nodes.collect()
}

/// How far pressure and gap of a node are beyond the law of its state, relative to stress and range; below 0 on the
/// law.
fn excess(law: &CohesiveLaw, state: NodeState, [pressure, gap]: [f64; 2]) -> f64 {
    let (gap, flat) = (gap / law.range(), law.flat_range() / law.range());
    match state {
        NodeState::Open => 1.0 - gap,
        NodeState::Soft => (flat - gap).max(gap - 1.0),
        NodeState::Cohesive => (-gap).max(gap - flat),
        NodeState::Held => -gap,
        NodeState::Contact => -1.0 - pressure / law.stress(),
    }
}

/// Where a window leads before anything follows.
enum Outcome {
    /// Nothing has happened.
    Nothing,
    Led(Front),
    /// Something happens to these nodes, which are not watched.
    Lacks(Vec<usize>),
    /// What happens first needs all soft nodes to be watched.
    LacksSoft,
}

struct Play<'a> {
    view: &'a View<'a>,
    board: Board,
    rows: Rows,
    /// The rows as they began.
    begun: Vec<Row>,
    /// Whether it has begun along the pull of a node, and not along the approach.
    is_in_jump: bool,
    grid: Grid,
    /// The greatest length, of which approaches and gaps are differences.
    length: f64,
    approach: f64,
    /// Until then nothing happens to a node that is not watched, as far as its rate at the beginning tells.
    horizon: f64,
    /// The end of the window: no event but the first comes later.
    end: f64,
    /// Along the parameter that it has begun along.
    time: f64,
    events: usize,
    totals: Totals,
    moments: Vec<(AdhesiveEvent, usize, Moment, usize)>,
    /// For each moment its time, and [what was given](Self::given) of the rows then.
    given: Vec<(f64, Vec<f64>)>,
    jump: Option<usize>,
    is_at_limit: bool,
    has_moved: bool,
    /// Whether the last event came at once, but for rounding.
    stands: bool,
    tied: TiedEvents,
    /// Whether the next event needs soft nodes that are not watched.
    lacks_others: bool,
    /// How often it was played again with fewer events.
    shortened: usize,
}

impl<'a> Play<'a> {
    /// Watches all nodes that are pulled with σ₀ or held, those of `also`, and `size` others, to which something
    /// happens first; all soft nodes if `size` is `usize::MAX`.
    fn open(
        body: &mut Body,
        front: &Front,
        field: &Field,
        view: &'a View<'a>,
        (size, also): (usize, &[usize]),
        known: Option<Rows>,
    ) -> Result<Self, Error> {
        let line =
            |node: usize| [&field.pressure, &field.gap].map(|pair| [pair[0][node], pair[1][node]]);
        let (mut nodes, mut others) = (Vec::new(), Vec::new());
        for (node, &state) in front.nodes.iter().enumerate() {
            if matches!(state, NodeState::Cohesive | NodeState::Held) {
                nodes.push(node);
                continue;
            }
            let [[p, dp], [gap, dgap]] = line(node);
            let left = Left::of(&body.law, state, [p, gap], [dp, dgap]);
            if also.contains(&node) || size == usize::MAX && state == NodeState::Soft {
                others.push((f64::NEG_INFINITY, node));
            } else if let Some(left) = left {
                others.push((left.time(), node));
            }
        }
        let order = |a: &(f64, usize), b: &(f64, usize)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        let count = if size == usize::MAX {
            others.iter().filter(|other| other.0 == f64::NEG_INFINITY).count() + ALONE
        } else {
            size.saturating_add(also.len())
        };
        let mut horizon = f64::INFINITY;
        if count < others.len() {
            others.select_nth_unstable_by(count, order);
            // Those that tie with the last one are watched with it.
            let last = others[..count].iter().map(|other| other.0).fold(0.0, f64::max);
            let is_tied = |&(time, node): &(f64, usize)| {
                let [[p, dp], [gap, dgap]] = line(node);
                let left = Left::of(&body.law, front.nodes[node], [p, gap], [dp, dgap]);
                time <= last || left.is_some_and(|left| left.is_by(last, LAG))
            };
            let rest = others.split_off(count);
            let (tied, rest): (Vec<_>, Vec<_>) = rest.into_iter().partition(is_tied);
            others.extend(tied);
            horizon = rest.iter().map(|other| other.0).fold(f64::INFINITY, f64::min);
        }
        nodes.extend(others.iter().map(|&(_, node)| node));
        nodes.sort_unstable();
        let begun: Vec<Row> = nodes
            .iter()
            .map(|&node| {
                let [[pressure, _], [gap, _]] = line(node);
                Row { node, state: front.nodes[node], pressure, gap }
            })
            .collect();
        let rates = nodes.iter().map(|&node| {
            let [[_, dp], [_, dgap]] = line(node);
            match front.nodes[node] {
                NodeState::Contact => dp,
                _ => dgap,
            }
        });
        let rates = rates.collect();
        let (answers, rows) = body.rows(front, nodes, known)?;
        let soft = begun.iter().filter(|row| row.state == NodeState::Soft).count();
        let board = Board::new(Beginning {
            law: body.law,
            rows: begun.clone(),
            answers,
            rates,
            sums: field.sums(),
            held: front.held.clone(),
            contact_nodes: front.count(NodeState::Contact),
            other_soft: body.soft().len() - soft,
        });
        Ok(Self {
            view,
            board,
            rows,
            begun,
            is_in_jump: !front.held.is_empty(),
            grid: body.problem.grid(),
            length: body.greatest_length(front.approach),
            approach: front.approach,
            horizon,
            end: horizon,
            time: 0.0,
            events: 0,
            totals: view.totals,
            moments: Vec::new(),
            given: Vec::new(),
            jump: None,
            is_at_limit: false,
            has_moved: false,
            stands: true,
            tied: TiedEvents::default(),
            lacks_others: false,
            shortened: 0,
        })
    }

    fn area(&self) -> f64 {
        self.grid.cell_area()
    }

    fn moment(&self) -> Moment {
        let [pressures, gaps] = self.board.sums;
        let [pressure_rate, gap_rate] = self.board.sum_rates();
        Moment {
            approach: self.approach,
            sums: [[pressures, pressure_rate], [gaps, gap_rate]],
            contact_nodes: self.board.contact_nodes,
            pulled: self.board.pulled(),
            energy: self.board.energy(),
            totals: self.totals,
        }
    }

    fn push(&mut self, event: AdhesiveEvent, node: usize, moment: Moment, changes: usize) {
        self.moments.push((event, node, moment, changes));
    }

    /// By how much the given quantity of each row has changed since the beginning.
    fn given(&self) -> Vec<f64> {
        let slope = self.board.law().slope();
        let rows = self.begun.iter().zip(&self.board.rows);
        let given = rows.map(|(begun, now)| match begun.state {
            NodeState::Soft => (now.pressure - begun.pressure) - slope * (now.gap - begun.gap),
            NodeState::Contact => now.gap,
            _ => now.pressure - begun.pressure,
        });
        given.collect()
    }

    /// Notes it for the moment that is pushed next.
    fn note(&mut self) {
        self.given.push((self.time, self.given()));
    }

    /// Plays `most` events at most, fewer if something would happen to other nodes before; or returns these nodes, if
    /// the window may grow.
    fn play_out(
        &mut self,
        body: &mut Body,
        front: &Front,
        field: &Field,
        (most, may_grow): (usize, bool),
    ) -> Result<Outcome, Error> {
        let begun = self.board.clone();
        let (mut most, mut until) = (most, f64::INFINITY);
        loop {
            self.run(most, until)?;
            // A window that ends between events of the instant at which it begins would leave the rest of them late,
            // and near an instability that grows.
            if self.lacks_others && (self.events == 0 || !self.has_moved) {
                return Ok(Outcome::LacksSoft);
            }
            let Some(ended) = self.ended(front) else { return Ok(Outcome::Nothing) };
            if self.events == 0 {
                return Ok(Outcome::Led(ended));
            }
            // Along the pull of a row, soft nodes change by what is given of that row and by nothing else.
            let alone = if self.is_in_jump { 0.0 } else { self.time };
            let rows = self.board.rows.iter().map(|row| (row.node, [row.pressure, row.gap]));
            let rows: Vec<_> = rows.collect();
            let found = body.preview(&ended, (field, alone), &self.rows, (&rows, self.given()))?;
            let wrong = beyond(body, &ended, &found);
            if wrong.is_empty() {
                return Ok(Outcome::Led(ended));
            }
            let lacks: Vec<usize> =
                wrong.iter().map(|&(node, _)| node).filter(|&node| !self.is_row(node)).collect();
            if may_grow && !lacks.is_empty() {
                return Ok(Outcome::Lacks(lacks));
            }
            if self.is_least(most) {
                return Ok(Outcome::Led(ended));
            }
            // On loading gaps fall faster and faster: a straight line from the beginning to the end is beyond the law
            // before the gap is.
            let crossings = wrong.iter().map(|&(node, after)| {
                let line = [field.pressure[0][node], field.gap[0][node]];
                let before = excess(&body.law, front.nodes[node], line).min(0.0);
                self.time * before / (before - after)
            });
            let first = crossings.fold(f64::INFINITY, f64::min);
            // If that time was not early enough, half of the events.
            most = if until.is_finite() { self.events / 2 } else { self.events - 1 };
            most = most.max(1);
            until = until.min(first);
            self.restart(&begun, front);
        }
    }

    /// Whether the window cannot have fewer events. Where one was asked for there may be two: behind it a carried node
    /// may be found on its law, which counts as well.
    fn is_least(&self, most: usize) -> bool {
        self.events <= 1 || most <= 1
    }

    /// Back to where it has begun.
    fn restart(&mut self, begun: &Board, front: &Front) {
        self.board = begun.clone();
        self.approach = front.approach;
        self.totals = self.view.totals;
        self.moments.clear();
        self.given.clear();
        (self.time, self.events, self.jump) = (0.0, 0, None);
        (self.is_at_limit, self.has_moved, self.lacks_others) = (false, false, false);
        self.tied = TiedEvents::default();
        self.shortened += 1;
    }

    fn is_row(&self, node: usize) -> bool {
        self.begun.binary_search_by_key(&node, |row| row.node).is_ok()
    }

    /// Adds the energies of soft nodes that were not watched.
    fn add_energies(&mut self, body: &Body, field: &Field) {
        let squares = body.squares(&self.rows, |node| self.is_row(node), field, &self.given);
        let slope = self.board.law().slope();
        for ((.., moment, _), squares) in self.moments.iter_mut().zip(squares) {
            moment.energy -= 0.5 * squares / slope;
        }
    }

    /// Plays so many events at most, but for the first one until a time.
    ///
    /// # Errors
    ///
    /// [`Error::Cycling`] for events of one instant without end.
    fn run(&mut self, most: usize, until: f64) -> Result<(), Error> {
        self.end = self.horizon.min(until);
        loop {
            let events = self.events;
            self.stands = true;
            let goes_on = if self.board.carries() { self.carry(most) } else { self.step(most) };
            let place = (self.approach, self.grid.nodes());
            self.tied.add(self.events - events, !self.stands, place)?;
            if !goes_on || !self.turn(most) {
                return Ok(());
            }
        }
    }

    /// From the approach to the pull of a node that is held, or on to the next one, or back; false once the window
    /// ends.
    fn turn(&mut self, most: usize) -> bool {
        if self.board.carries() {
            return true;
        }
        if !self.board.held.is_empty() {
            if self.events >= most {
                return false;
            }
            self.board.carry_next();
            return true;
        }
        if self.is_in_jump {
            // Rates along the approach are not known.
            return false;
        }
        self.board.end_carrying();
        let Some(node) = self.jump.take() else { return true };
        let moment = self.moment();
        self.note();
        self.push(AdhesiveEvent::JumpEnd, node, moment, self.board.changes.len());
        let [[pressures, _], [gaps, _]] = moment.sums;
        let load = self.area() * pressures;
        let approach = self.view.gauge.reported_approach(self.approach, load);
        let mean_gap = gaps / self.grid.nodes() as f64;
        let state = ContactState::new(&self.grid, moment.contact_nodes, approach, load, mean_gap);
        !self.view.targets.is_past(&state, self.view.direction)
    }

    /// One event along the approach; false once the window ends.
    fn step(&mut self, most: usize) -> bool {
        let next = self.board.next();
        let until = next.map_or(f64::INFINITY, |(time, _)| time);
        let limit = self.limit();
        let first = until.min(limit);
        let is_enough = self.is_enough(most, next);
        let View { targets, direction, .. } = *self.view;
        // Where a branch of unloading begins with as few nodes as are asked for, others may be about to part.
        let is_there = targets.is_reached(self.board.contact_nodes, direction);
        if first == f64::INFINITY || self.events > 0 && (self.time + first > self.end || is_enough)
        {
            return false;
        }
        self.advance(first);
        let place = next.filter(|_| until <= limit && !is_there).map(|(_, place)| place);
        let place = place.filter(|&place| !self.is_too_many(place));
        // Behind a jump the target would be passed: where it ties with the beginning of one, it comes first.
        let ties = limit - until <= ROUNDING * self.length;
        let is_before_jump = ties
            && place.is_some_and(|place| {
                !self.board.lacks_others(place) && self.board.begins_jump(place)
            });
        let place = match place {
            Some(place) if !is_before_jump => place,
            _ => {
                if is_before_jump {
                    self.advance(limit - first);
                }
                let node = self.board.changes.last().map_or(self.view.last_node, |last| last.node);
                self.note();
                self.push(AdhesiveEvent::Limit, node, self.moment(), self.board.changes.len());
                self.is_at_limit = true;
                return false;
            }
        };
        if self.board.lacks_others(place) {
            self.lacks_others = true;
            return false;
        }
        let (before, changes) = (self.moment(), self.board.changes.len());
        let Row { node, state: from, .. } = self.board.rows[place];
        self.note();
        self.board.happen(place);
        self.events += 1;
        if !self.board.held.is_empty() {
            self.push(AdhesiveEvent::JumpStart, node, before, changes);
            self.jump = Some(node);
            return !self.board.is_worn;
        }
        let event = match (from, self.board.rows[place].state) {
            (NodeState::Open, _) => AdhesiveEvent::Near,
            (NodeState::Contact, _) => AdhesiveEvent::Part,
            (_, NodeState::Contact) => AdhesiveEvent::Touch,
            (_, NodeState::Cohesive) => AdhesiveEvent::Pull,
            (_, NodeState::Open) => AdhesiveEvent::Far,
            _ => AdhesiveEvent::Soften,
        };
        self.push(event, node, self.moment(), self.board.changes.len());
        let is_few = event == AdhesiveEvent::Part
            && self.view.targets.is_reached(self.board.contact_nodes, self.view.direction);
        !is_few && !self.board.is_worn
    }

    /// Whether what comes next to a row is a node more in contact than a target has.
    fn is_too_many(&self, place: usize) -> bool {
        let state = self.board.rows[place].state;
        let touches = state == NodeState::Cohesive
            || state == NodeState::Soft && self.board.law().flat_range() == 0.0;
        touches
            && self.board.closes(place)
            && self.view.targets.is_full(self.board.contact_nodes, self.view.direction)
    }

    /// When a target is reached, as long as nothing happens.
    fn limit(&self) -> f64 {
        let View { targets, gauge, direction, .. } = *self.view;
        if targets.is_reached(self.board.contact_nodes, direction) {
            return 0.0;
        }
        let Moment { sums: [[pressures, pressure_rate], [gaps, gap_rate]], pulled, .. } =
            self.moment();
        let load = [pressures, pressure_rate].map(|sum| self.area() * sum);
        let pull = self.area() * self.board.law().stress() * pulled.iter().sum::<usize>() as f64;
        let measured = Measured {
            approach: self.approach,
            load,
            mean_gap: [gaps, gap_rate].map(|sum| sum / self.grid.nodes() as f64),
            stiffness: self.area() * self.board.law().slope(),
            units: [force_unit(pull, load[0], load[1], self.length), self.length],
            contact_nodes: self.board.contact_nodes,
            is_full: self.board.contact_nodes == self.grid.nodes(),
        };
        targets.time(gauge, &measured, direction)
    }

    /// Whether there have been `most` events and the next one does not come at once. Events of one instant belong in
    /// one window: with a solution between them rounding would grow from node to node.
    fn is_enough(&self, most: usize, next: Option<(f64, usize)>) -> bool {
        self.events >= most && !next.is_some_and(|(_, place)| self.board.is_due(place))
    }

    /// One event along the pull of a node; false once the window ends.
    fn carry(&mut self, most: usize) -> bool {
        let Some(carry) = self.board.carry() else {
            self.events += 1;
            return !self.board.is_worn;
        };
        let next = self.board.next();
        let event = next.map_or(f64::INFINITY, |(time, _)| time);
        let step = event.min(carry.corner).min(carry.law).min(carry.end);
        let is_beyond = self.is_in_jump && self.time + step > self.end;
        let is_enough = self.is_enough(most, next);
        if step == f64::INFINITY || self.events > 0 && (is_beyond || is_enough) {
            return false;
        }
        self.advance(step);
        match next {
            Some((time, place)) if time <= step => {
                if self.board.lacks_others(place) {
                    self.lacks_others = true;
                    return false;
                }
                self.board.happen(place);
                self.events += 1;
            }
            _ if carry.end <= step
                && carry.law > step * (1.0 + 1e-9) + 1e-12 * self.board.law().stress()
                && carry.corner > step =>
            {
                self.board.let_go();
                self.events += 1;
            }
            _ => {}
        }
        !self.board.is_worn
    }

    fn advance(&mut self, step: f64) {
        let [before, _] = self.board.sums;
        let lost = self.board.advance(step);
        let [after, _] = self.board.sums;
        self.has_moved |= step > 0.0;
        let carries = self.board.carries();
        let unit = if carries { self.board.law().stress() } else { self.length };
        self.stands &= step <= f64::EPSILON * unit;
        if carries == self.is_in_jump {
            self.time += step;
        }
        if carries {
            self.totals.dissipated += self.area() * lost;
        } else {
            let step = self.view.direction.sign() * step;
            self.approach += step;
            self.totals.work += 0.5 * self.area() * (before + after) * step;
        }
    }

    /// Where it has led; `None` if nothing has happened.
    fn ended(&self, start: &Front) -> Option<Front> {
        if self.events == 0 && !self.has_moved && !self.is_at_limit {
            return None;
        }
        let mut nodes = start.nodes.clone();
        for change in &self.board.changes {
            nodes[change.node] = change.to;
        }
        Some(Front { nodes, approach: self.approach, held: self.board.held.clone() })
    }
}
