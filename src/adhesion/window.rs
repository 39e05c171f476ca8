//! The events of a window: along one parameter, among the nodes that are watched.

use super::board::{Beginning, Board, Change, LAG, Left, Row};
use super::front::{Body, Field, Front, Parameter};
use super::moment::{Moment, Totals};
use super::state::{AdhesiveEvent, Direction, NodeState};
use super::target::{Measured, Targets};
use crate::Error;
use crate::error::AdhesionError;
use crate::kernel::Gauge;
use crate::updater::Schur;

/// By how much a node may be beyond its law at the end of a window, in pressures relative to the stress, in gaps to the
/// range: ten times the lag with which a node that is carried is put on its law, which others answer to. Of gaps there is
/// rounding of the greatest length besides, which soft nodes near an instability amplify.
const SLACK: f64 = 10.0 * LAG;
const ROUNDING: f64 = 1e-12;
/// A window that its end contradicts is tried again so often, with fewer events and more nodes.
const TRIES: usize = 60;

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
}

/// Follows events until something may happen to a node that is not watched, until a jump begins or the pull of its next
/// node is carried, or to a target; `None` if nothing happens any more. What the end contradicts is tried again with
/// the nodes that do, and with fewer events.
pub(super) fn follow(
    body: &mut Body,
    front: &Front,
    field: &Field,
    view: &View<'_>,
    size: usize,
) -> Result<Option<Played>, Error> {
    let mut also = Vec::new();
    let mut most = usize::MAX;
    for taken_back in 0..TRIES {
        let Some(mut play) = Play::open(body, front, field, view, (size, &also))? else {
            return Ok(None);
        };
        play.run(most.min(size));
        let Some(ended) = play.end(front) else {
            return Ok(None);
        };
        body.follow(&ended)?;
        let found = body.survey(&ended, view.direction.sign());
        let wrong = match &found {
            Ok(field) => beyond(body, &ended, field),
            Err(Error::FactorizationFailed { .. }) if play.events > 1 => vec![(usize::MAX, 1.0)],
            Err(_) => Vec::new(),
        };
        let field = match (wrong.is_empty(), found) {
            (true, found) => found?,
            (false, _) => {
                body.follow(front)?;
                let (node, value) = wrong[0];
                let is_new = wrong.iter().any(|(node, _)| !also.contains(node));
                if play.events <= 1 && !is_new {
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
        return Ok(Some(Played {
            front: ended,
            field,
            moments: play.moments,
            changes: play.board.changes,
            totals: play.totals,
            jump: play.jump,
            is_at_limit: play.is_at_limit,
            taken_back,
        }));
    }
    Err(Error::Cycling { approach: front.approach, events: TRIES })
}

/// Nodes that are beyond the law of their state, and by how much.
fn beyond(body: &Body, front: &Front, field: &Field) -> Vec<(usize, f64)> {
    let law = &body.law;
    let length = body.problem.greatest_gap() + front.approach.abs();
    let slack = SLACK + ROUNDING * length / (law.range() * body.least_pivot());
    let nodes = front.nodes.iter().enumerate().filter_map(|(node, state)| {
        let gap = field.gap[0][node] / law.range();
        let flat = law.flat_range() / law.range();
        let value = match state {
            NodeState::Open => 1.0 - gap,
            NodeState::Soft => (flat - gap).max(gap - 1.0),
            NodeState::Cohesive => (-gap).max(gap - flat),
            NodeState::Held => -gap,
            NodeState::Contact => -1.0 - field.pressure[0][node] / law.stress(),
        };
        (value.is_nan() || value > slack).then_some((node, value))
    });
    nodes.collect()
}

struct Play<'a> {
    view: &'a View<'a>,
    board: Board,
    parameter: Parameter,
    area: f64,
    nodes: f64,
    approach: f64,
    /// Until then nothing happens to a node that is not watched, as far as its rate at the beginning tells.
    horizon: f64,
    time: f64,
    events: usize,
    totals: Totals,
    moments: Vec<(AdhesiveEvent, usize, Moment, usize)>,
    jump: Option<usize>,
    is_at_limit: bool,
    has_moved: bool,
}

impl<'a> Play<'a> {
    /// Watches all nodes that are pulled, those of `also`, and of the others so many that something happens to first.
    fn open(
        body: &mut Body,
        front: &Front,
        field: &Field,
        view: &'a View<'a>,
        (size, also): (usize, &[usize]),
    ) -> Result<Option<Self>, Error> {
        let line =
            |node: usize| [&field.pressure, &field.gap].map(|pair| [pair[0][node], pair[1][node]]);
        let mut others = Vec::new();
        let mut watched: Vec<usize> = body.soft().to_vec();
        for (node, &state) in front.nodes.iter().enumerate() {
            match state {
                NodeState::Soft => {}
                NodeState::Cohesive | NodeState::Held => watched.push(node),
                NodeState::Open | NodeState::Contact => {
                    let [[p, dp], [gap, dgap]] = line(node);
                    let left = Left::of(&body.law, state, [p, gap], [dp, dgap]);
                    if also.contains(&node) {
                        others.push((f64::NEG_INFINITY, node));
                    } else if let Some(left) = left {
                        others.push((left.time(), node));
                    }
                }
            }
        }
        let order = |a: &(f64, usize), b: &(f64, usize)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        let count = size + also.len();
        let mut horizon = f64::INFINITY;
        if count < others.len() {
            horizon = others.select_nth_unstable_by(count, order).1.0;
            others.truncate(count);
        }
        let (inside, outside): (Vec<usize>, Vec<usize>) = others
            .iter()
            .map(|&(_, node)| node)
            .partition(|&node| front.nodes[node] == NodeState::Contact);
        // Those whose columns are known first, in their order.
        let mut place = vec![usize::MAX; front.nodes.len()];
        body.known().iter().enumerate().for_each(|(k, &node)| place[node] = k);
        let soft = watched.partition_point(|&node| front.nodes[node] == NodeState::Soft);
        watched.extend(outside);
        watched[soft..].sort_by_key(|&node| place[node]);
        let places = body.contact().places();
        let mut positions: Vec<usize> = inside.iter().filter_map(|&node| places[node]).collect();
        positions.sort_unstable();
        let order = body.contact().order();
        let nodes: Vec<usize> =
            watched.iter().copied().chain(positions.iter().map(|&place| order[place])).collect();
        let mut schur = Schur::default();
        body.watch(&watched, &positions, &mut schur)?;
        let [of_pressures, of_gaps] = body.sums_by_node()?;
        let rows = nodes.iter().map(|&node| {
            let [[pressure, _], [gap, _]] = line(node);
            Row { node, state: front.nodes[node], pressure, gap }
        });
        let rates = nodes.iter().map(|&node| {
            let [[_, dp], [_, dgap]] = line(node);
            match front.nodes[node] {
                NodeState::Soft | NodeState::Contact => dp,
                _ => dgap,
            }
        });
        let parameter = front.parameter();
        let sums = field.sums();
        let board = Board::new(Beginning {
            law: body.law,
            sign: view.direction.sign(),
            rows: rows.collect(),
            schur: &schur,
            sums_by_row: nodes.iter().map(|&node| [of_pressures[node], of_gaps[node]]).collect(),
            rates: rates.collect(),
            sums,
            held: front.held.clone(),
            is_carried: parameter != Parameter::Approach,
            contact_nodes: front.count(NodeState::Contact),
        });
        body.keep(watched, schur);
        let grid = body.problem.grid();
        Ok(Some(Self {
            view,
            board,
            parameter,
            area: grid.cell_area(),
            nodes: grid.nodes() as f64,
            approach: front.approach,
            horizon,
            time: 0.0,
            events: 0,
            totals: view.totals,
            moments: Vec::new(),
            jump: None,
            is_at_limit: false,
            has_moved: false,
        }))
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

    /// Plays so many events at most.
    fn run(&mut self, most: usize) {
        match self.parameter {
            Parameter::Approach => while self.step(most) {},
            Parameter::Pull(_) => while self.carry(most) {},
        }
    }

    /// One event along the approach; false once the window ends.
    fn step(&mut self, most: usize) -> bool {
        let next = self.board.next();
        let until = next.map_or(f64::INFINITY, |(time, _)| time);
        let [[pressures, pressure_rate], [gaps, gap_rate]] = self.moment().sums;
        let measured = Measured {
            approach: self.approach,
            load: [pressures, pressure_rate].map(|sum| self.area * sum),
            mean_gap: [gaps, gap_rate].map(|sum| sum / self.nodes),
            stiffness: self.area * self.board.law().slope(),
        };
        let limit = self.view.targets.time(self.view.gauge, &measured, self.view.direction);
        let first = until.min(limit);
        if first == f64::INFINITY
            || self.events > 0 && (self.time + first > self.horizon || self.events >= most)
        {
            return false;
        }
        self.advance(first);
        let is_full = |place: usize| {
            let state = self.board.rows[place].state;
            let touches = state == NodeState::Cohesive
                || state == NodeState::Soft && self.board.law().flat_range() == 0.0;
            touches
                && self.board.closes(place)
                && self.view.targets.is_full(self.board.contact_nodes, self.view.direction)
        };
        let place = match next {
            Some((_, place)) if until <= limit && !is_full(place) => place,
            _ => {
                let node = self.board.changes.last().map_or(self.view.last_node, |last| last.node);
                self.push(AdhesiveEvent::Limit, node, self.moment(), self.board.changes.len());
                self.is_at_limit = true;
                return false;
            }
        };
        let (before, changes) = (self.moment(), self.board.changes.len());
        let Row { node, state: from, .. } = self.board.rows[place];
        self.board.happen(place);
        self.events += 1;
        if !self.board.held.is_empty() {
            self.push(AdhesiveEvent::JumpStart, node, before, changes);
            self.jump = Some(node);
            return false;
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

    /// One event along the pull of a node; false once the window ends.
    fn carry(&mut self, most: usize) -> bool {
        if !self.board.carries() {
            return false;
        }
        let Some(carry) = self.board.carry() else {
            self.events += 1;
            return false;
        };
        let next = self.board.next();
        let event = next.map_or(f64::INFINITY, |(time, _)| time);
        let step = event.min(carry.corner).min(carry.law).min(carry.end);
        if step == f64::INFINITY
            || self.events > 0 && (self.time + step > self.horizon || self.events >= most)
        {
            return false;
        }
        self.advance(step);
        match next {
            Some((time, place)) if time <= step => {
                self.board.happen(place);
                self.events += 1;
            }
            _ if carry.end <= step
                && carry.law > step * (1.0 + 1e-9) + 1e-12 * self.board.law().stress()
                && carry.corner > step =>
            {
                self.board.let_go();
                self.events += 1;
                return false;
            }
            _ => {}
        }
        !self.board.is_worn
    }

    fn advance(&mut self, step: f64) {
        let [before, _] = self.board.sums;
        let lost = self.board.advance(step);
        let [after, _] = self.board.sums;
        self.time += step;
        self.has_moved |= step > 0.0;
        match self.parameter {
            Parameter::Approach => {
                let step = self.view.direction.sign() * step;
                self.approach += step;
                self.totals.work += 0.5 * self.area * (before + after) * step;
            }
            Parameter::Pull(_) => self.totals.dissipated += self.area * lost,
        }
    }

    /// Where it has led; `None` if nothing has happened.
    fn end(&self, start: &Front) -> Option<Front> {
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
