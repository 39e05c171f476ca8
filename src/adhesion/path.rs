//! The branches of a path with adhesion.

use std::collections::VecDeque;
use std::iter::FusedIterator;

use nalgebra::DMatrix;

use super::board::Change;
use super::branch::AdhesiveBranch;
use super::front::{Body, Field, Front};
use super::law::{Adhesion, CohesiveLaw};
use super::moment::{Moment, Totals};
use super::plain::Plain;
use super::state::{AdhesiveEvent, AdhesiveState, Direction, NodeState};
use super::target::{Targets, force_unit};
use super::trace::Trace;
use super::window::{self, Played, ROUNDING};
use crate::contact::{ContactState, ContactTarget};
use crate::kernel::Gauge;
use crate::tied_events::TiedEvents;
use crate::{Error, Grid, Problem};

/// Nodes that are watched by default: so many, or a quarter of the soft ones if that is more. On 128 × 128 nodes with
/// up to 628 soft ones 128 and 300 are as fast, and 600 take 1.4 times as long.
const WATCHED: usize = 64;
const SOFT_FOR_ONE: usize = 4;
/// How far the load of a state may be from what its nodes carry, relative to the sum of all forces: loads agree to
/// 1e-12 whatever the windows were, or 1e-13 h₂/(h₂ − h₁) where that is more, and another processor rounds otherwise.
const SAME_LOAD: f64 = 1e-9;
/// The same as [`SAME_LOAD`] of a state whose fields are asked for, and of its approach: one of another path is further
/// off.
const RECOGNISED: f64 = 1e-6;

/// Why a branch has ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum AdhesiveEnd {
    /// The state that was asked for; the last state is there.
    Target,
    /// All nodes are in contact, or out of range.
    NoMoreEvents,
    /// The last item was an error.
    Failed,
}

/// The path of a rigid rough surface that sticks to an elastic half-space: the branch of loading, and those of
/// unloading and loading again from wherever it is turned around.
///
/// An iterator of [`AdhesiveState`] as [`LoadingPath`](crate::LoadingPath) is one of its states; see [the
/// module](super).
#[derive(Debug)]
pub struct AdhesivePath {
    pub(super) body: Body,
    adhesion: Adhesion,
    pub(super) front: Front,
    /// Of the front, if it is known.
    field: Option<Field>,
    pub(super) direction: Direction,
    pub(super) targets: Targets,
    window_size: Option<usize>,
    /// Without adhesion.
    plain: Option<Plain>,
    totals: Totals,
    /// Within a jump the node that was unstable.
    jump: Option<usize>,
    tied: TiedEvents,
    queue: VecDeque<AdhesiveState>,
    last: Option<AdhesiveState>,
    end: Option<AdhesiveEnd>,
    trace: Trace,
    timings: AdhesiveTimings,
}

/// How many windows a path took.
#[doc(hidden)] // for the studies of this repository
#[derive(Debug, Clone, Copy, Default)]
#[non_exhaustive]
pub struct AdhesiveTimings {
    /// Windows that were kept.
    pub windows: usize,
    /// Windows that their end contradicted.
    pub taken_back: usize,
    /// Windows that were played again with fewer events, before anything had followed.
    pub shortened: usize,
    /// Events of all kinds, those within jumps included.
    pub events: usize,
}

/// Pressures and gaps of a state.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct AdhesiveFields {
    /// Pressure \[Pa\], negative where the surfaces are pulled.
    pub pressure: DMatrix<f64>,
    /// Gap \[m\].
    pub gap: DMatrix<f64>,
    /// Where the nodes are on their law.
    pub nodes: DMatrix<NodeState>,
}

impl AdhesivePath {
    pub(super) fn new(
        (body, adhesion): (Body, Adhesion),
        targets: Targets,
        (window_size, plain): (Option<usize>, Option<Plain>),
    ) -> Self {
        let nodes = vec![NodeState::Open; body.problem.initial_gap().len()];
        // Out of range but for rounding: the highest node comes into it first.
        let approach = -body.law.range();
        Self {
            front: Front { nodes, approach, held: Vec::new() },
            body,
            adhesion,
            field: None,
            direction: Direction::Loading,
            targets,
            window_size,
            plain,
            totals: Totals::default(),
            jump: None,
            tied: TiedEvents::default(),
            queue: VecDeque::new(),
            last: None,
            end: None,
            trace: Trace::default(),
            timings: AdhesiveTimings::default(),
        }
    }

    /// Turns around, or goes on, and lets the approach fall from the present state, the last one yielded, until no node
    /// is pulled any more.
    ///
    /// # Errors
    ///
    /// [`Error::CannotContinue`] after an error, and those of the updater.
    pub fn unload(&mut self) -> Result<(), Error> {
        self.turn(Direction::Unloading, Targets::default())
    }

    /// The same until a target.
    ///
    /// # Errors
    ///
    /// [`AdhesionError::Behind`](crate::AdhesionError::Behind) for a target on the other side of the present state, and
    /// those of [`Self::unload`].
    pub fn unload_to(&mut self, target: ContactTarget) -> Result<(), Error> {
        let targets = Targets::of(&[target], &self.grid())?;
        self.turn(Direction::Unloading, targets)
    }

    /// Lets the approach grow from the present state, the last one yielded, to a target.
    ///
    /// # Errors
    ///
    /// As for [`Self::unload_to`].
    pub fn load_to(&mut self, target: ContactTarget) -> Result<(), Error> {
        self.load_to_first_of(&[target])
    }

    /// The same to the first of several targets that is reached; without any to full contact.
    ///
    /// # Errors
    ///
    /// As for [`Self::unload_to`].
    pub fn load_to_first_of(&mut self, targets: &[ContactTarget]) -> Result<(), Error> {
        let targets = Targets::of(targets, &self.grid())?;
        self.turn(Direction::Loading, targets)
    }

    /// All states to come, up to the end of the branch.
    ///
    /// # Errors
    ///
    /// The first error of a state. The states before it are lost then, and [`Self::state`] is the last of them: iterate
    /// to keep them.
    pub fn run(&mut self) -> Result<AdhesiveBranch, Error> {
        self.by_ref().collect()
    }

    fn turn(&mut self, direction: Direction, targets: Targets) -> Result<(), Error> {
        if self.end == Some(AdhesiveEnd::Failed) {
            return Err(Error::CannotContinue { steps: self.last.map_or(0, |state| state.step) });
        }
        let present = self.last.map_or_else(|| self.body.apart(), |state| state.contact);
        let length = self.body.greatest_length(present.approach);
        targets.check_ahead((&self.grid(), &present, length), direction, self.plain.is_none())?;
        self.go_back().inspect_err(|_| self.end = Some(AdhesiveEnd::Failed))?;
        if let Some(plain) = &mut self.plain {
            plain.turn(direction, targets.all());
        }
        self.direction = direction;
        self.targets = targets;
        self.field = None;
        self.tied = TiedEvents::default();
        self.end = None;
        Ok(())
    }

    /// Goes back to the last state yielded, if more are computed.
    fn go_back(&mut self) -> Result<(), Error> {
        if self.queue.is_empty() && self.jump.is_none() {
            return Ok(());
        }
        self.queue.clear();
        (self.jump, self.field) = (None, None);
        let step = self.last.map_or(0, |state| state.step);
        self.front = self.front_at(step);
        self.trace.truncate(step);
        self.totals = self.last.map_or(Totals::default(), |state| self.totals_at(&state));
        self.body.follow(&self.front)
    }

    fn totals_at(&self, state: &AdhesiveState) -> Totals {
        Totals {
            work: self.gauge().work(state.work, state.contact.load),
            dissipated: state.dissipated,
        }
    }

    /// Which way the branch goes and where it is to end, as long as it has not come there.
    pub(crate) fn pending(&self) -> Option<(Direction, &[ContactTarget])> {
        let goes_on = matches!(self.end(), None | Some(AdhesiveEnd::Failed));
        goes_on.then(|| (self.direction, self.targets.all()))
    }

    /// What has happened up to the present state.
    pub(crate) fn trace(&self) -> Trace {
        let mut trace = self.trace.clone();
        trace.truncate(self.last.map_or(0, |state| state.step));
        trace
    }

    /// Puts a path that has not begun behind the last state of another one of the same problem: it goes on to the first
    /// of the targets that it had before it, on the same branch; without them it has ended, and can turn around or go on.
    ///
    /// # Errors
    ///
    /// Those of [`Trace::follow`] and of the updater, and [`Error::Inconsistent`] if the nodes do not carry the load of
    /// the state.
    pub(crate) fn restore(
        &mut self,
        trace: Trace,
        last: AdhesiveState,
        pending: Option<(Direction, &[ContactTarget])>,
    ) -> Result<(), Error> {
        let mut most = 0;
        let nodes = trace.follow(self.grid().nodes(), |_, [.., in_contact]| {
            most = most.max(in_contact);
            Ok(())
        })?;
        if let Some(plain) = &mut self.plain {
            plain.skip_to(last.contact, most)?;
        }
        let approach = trace.marks.last().map_or(-self.body.law.range(), |mark| mark.1);
        self.front = Front { nodes, approach, held: Vec::new() };
        self.body.follow(&self.front)?;
        let field = self.body.survey(&self.front, last.direction.sign())?;
        if let Some(found) = self.other_load(&field, &last.contact, SAME_LOAD) {
            return Err(Error::Inconsistent {
                step: last.step,
                quantity: "load",
                value: last.contact.load,
                expected: found,
                reason: "is what its nodes carry",
            });
        }
        self.totals = self.totals_at(&last);
        let (direction, targets) = pending.unwrap_or((last.direction, &[]));
        self.direction = direction;
        self.trace = trace;
        self.last = Some(last);
        self.targets = Targets::of(targets, &self.grid())?;
        if let Some(plain) = &mut self.plain {
            plain.turn(direction, self.targets.all());
        }
        self.end = pending.is_none().then_some(AdhesiveEnd::Target);
        Ok(())
    }

    /// The load that the pressures of a field carry, if it differs from that of a state by more than a part of the sum
    /// of all forces.
    fn other_load(&self, field: &Field, state: &ContactState, part: f64) -> Option<f64> {
        let [[pressures, _], _] = field.sums();
        // Pressures differ in sign: rounding goes with the sum of their absolute values. A window may have begun at far
        // greater ones, and knows all of them to rounding of what presses every node down by the greatest length.
        let size: f64 = field.pressure[0].iter().map(|p| p.abs()).sum();
        let pressed = self.body.greatest_length(state.approach) / self.body.law.compliance();
        let greatest = self.grid().nodes() as f64 * pressed;
        let area = self.grid().cell_area();
        let (found, allowed) = (area * pressures, area * (part * size + ROUNDING * greatest));
        let error = (found - state.load).abs();
        (error.is_nan() || error > allowed).then_some(found)
    }

    /// Where the path was after so many states.
    fn front_at(&self, step: usize) -> Front {
        let start = (0, -self.body.law.range());
        let (changes, approach) = step.checked_sub(1).map_or(start, |last| self.trace.marks[last]);
        let mut nodes = self.front.nodes.clone();
        for change in self.trace.changes[changes..].iter().rev() {
            nodes[change.node] = change.from;
        }
        Front { nodes, approach, held: Vec::new() }
    }

    /// Pressures, gaps and nodes on their law at a state of this path, the present one or an earlier one. Each call
    /// makes a factor of its contact: n³/3 flops for n nodes.
    ///
    /// # Errors
    ///
    /// [`Error::StateNotReached`] for a state that this path has not had, or has gone back behind,
    /// [`Error::NotOnPath`] for one of another path, and those of the updater.
    pub fn fields_at(&self, state: &AdhesiveState) -> Result<AdhesiveFields, Error> {
        let present = self.last.map_or(0, |last| last.step);
        if state.step == 0 || state.step > present {
            return Err(Error::StateNotReached { step: state.step, present });
        }
        let ContactState { approach, load, .. } = state.contact;
        let not_on_path = |quantity, value| {
            let (step, expected) = (state.step, "that of the state");
            Error::NotOnPath { step, load, approach, quantity, value, expected }
        };
        let front = self.front_at(state.step);
        let of_mark = self.gauge().0.reported_approach(front.approach, load);
        let error = (of_mark - approach).abs();
        if error.is_nan() || error > RECOGNISED * self.body.greatest_length(approach) {
            return Err(not_on_path("approach", of_mark));
        }
        let mut body = self.body.beside();
        body.follow(&front)?;
        let field = body.survey(&front, self.direction.sign())?;
        if let Some(found) = self.other_load(&field, &state.contact, RECOGNISED) {
            return Err(not_on_path("load", found));
        }
        let (nx, ny) = self.grid().shape();
        let [[pressure, _], [gap, _]] = [field.pressure, field.gap];
        Ok(AdhesiveFields {
            pressure: DMatrix::from_vec(nx, ny, pressure),
            gap: DMatrix::from_vec(nx, ny, gap),
            nodes: DMatrix::from_vec(nx, ny, front.nodes),
        })
    }

    /// The contact problem.
    #[must_use]
    pub fn problem(&self) -> &Problem {
        &self.body.problem
    }

    /// The law of adhesion on these cells.
    #[must_use]
    pub fn law(&self) -> CohesiveLaw {
        self.body.law
    }

    /// The adhesion that was asked for.
    #[must_use]
    pub fn adhesion(&self) -> Adhesion {
        self.adhesion
    }

    /// The grid.
    #[must_use]
    pub fn grid(&self) -> Grid {
        self.body.problem.grid()
    }

    /// The present state: the last one yielded, `None` before the first.
    #[must_use]
    pub fn state(&self) -> Option<AdhesiveState> {
        self.last
    }

    /// Why the branch has ended; `None` while there is more to come.
    #[must_use]
    pub fn end(&self) -> Option<AdhesiveEnd> {
        self.end.filter(|_| self.queue.is_empty())
    }

    /// How many windows and events the path took.
    #[doc(hidden)] // for the studies of this repository
    #[must_use]
    pub fn timings(&self) -> AdhesiveTimings {
        self.timings
    }

    pub(super) fn gauge(&self) -> GaugeOfPath {
        GaugeOfPath(self.body.problem.table().gauge_per_load())
    }

    fn push(&mut self, event: AdhesiveEvent, node: usize, moment: &Moment, changes: usize) {
        let area = self.grid().cell_area();
        let is_apart = moment.contact_nodes == 0 && moment.pulled == [0, 0];
        let has_distant_point = self.body.problem.table().gauge().is_none();
        let [[pressures, pressure_rate], [gaps, gap_rate]] = moment.sums;
        // Exactly 0, where sums would leave rounding.
        let [pressures, pressure_rate] =
            if is_apart { [0.0; 2] } else { [pressures, pressure_rate] };
        let is_full = moment.contact_nodes == self.grid().nodes();
        let [gaps, gap_rate] = if is_full { [0.0; 2] } else { [gaps, gap_rate] };
        let (nodes, load) = (self.grid().nodes() as f64, area * pressures);
        let gauge = self.gauge();
        let adhesive_energy = area * moment.energy;
        let Totals { work, dissipated } = moment.totals;
        let elastic = work - dissipated - adhesive_energy;
        let approach = gauge.0.reported_approach(moment.approach, load);
        // Per unit of approach, whichever way that goes; and 0 rather than −0.
        let stiffness = area * pressure_rate * self.direction.sign() + 0.0;
        let interfacial = -area * pressure_rate / (gap_rate / nodes) + 0.0;
        let contact = ContactState {
            contact_stiffness: Some(stiffness).filter(|_| has_distant_point),
            interfacial_stiffness: Some(if is_full { f64::INFINITY } else { interfacial }),
            energy: gauge.0.reported_energy(elastic, load),
            ..ContactState::new(&self.grid(), moment.contact_nodes, approach, load, gaps / nodes)
        };
        let [soft_nodes, cohesive_nodes] = moment.pulled;
        self.trace.marks.push((changes, moment.approach));
        let mut state = AdhesiveState {
            step: self.trace.marks.len(),
            direction: self.direction,
            event,
            node: self.grid().coordinates(node),
            contact,
            soft_nodes,
            cohesive_nodes,
            adhesive_energy,
            dissipated,
            work: gauge.0.reported_energy(work, load),
        };
        if event == AdhesiveEvent::Limit {
            let pull = area * self.body.law.stress() * (soft_nodes + cohesive_nodes) as f64;
            let length = self.body.greatest_length(approach);
            let force = force_unit(pull, load, stiffness, length);
            self.targets.place(&mut state.contact, [force, length]);
        }
        self.queue.push_back(state);
    }

    /// The next state without adhesion.
    fn advance_plain(&mut self) -> Result<Option<AdhesiveState>, Error> {
        let Some(plain) = &mut self.plain else { return Ok(None) };
        let next = plain.next()?;
        let is_at_target = plain.is_at_target();
        let Some((event, node, contact)) = next else {
            self.end = Some(if is_at_target { AdhesiveEnd::Target } else { self.last_end() });
            return Ok(None);
        };
        let grid = self.grid();
        let (from, to) = match event {
            AdhesiveEvent::Touch => (NodeState::Open, NodeState::Contact),
            _ => (NodeState::Contact, NodeState::Open),
        };
        if event != AdhesiveEvent::Limit {
            let node = grid.index(node.0, node.1);
            self.trace.changes.push(Change { node, from, to });
            self.front.nodes[node] = to;
        }
        self.front.approach = contact.approach + self.gauge().0.displacement(contact.load);
        self.trace.marks.push((self.trace.changes.len(), self.front.approach));
        let state = AdhesiveState {
            step: self.trace.marks.len(),
            direction: self.direction,
            event,
            node,
            contact,
            soft_nodes: 0,
            cohesive_nodes: 0,
            adhesive_energy: 0.0,
            dissipated: 0.0,
            work: contact.energy,
        };
        self.last = Some(state);
        self.end = is_at_target.then_some(AdhesiveEnd::Target);
        Ok(self.last)
    }

    /// Works for some time towards the next state, and says whether that, or the end of the branch, is there: then
    /// [`next`](Iterator::next) returns at once. A jump of a soft surface takes minutes and has no state in between: a
    /// program that may be asked to stop calls this until it is `true`.
    ///
    /// # Errors
    ///
    /// As the next item of the path, which ends with it.
    pub fn prepare(&mut self) -> Result<bool, Error> {
        if self.is_prepared() {
            return Ok(true);
        }
        self.window().inspect_err(|_| self.end = Some(AdhesiveEnd::Failed))?;
        Ok(self.is_prepared())
    }

    fn is_prepared(&self) -> bool {
        self.end.is_some() || self.plain.is_some() || !self.queue.is_empty()
    }

    fn advance(&mut self) -> Result<Option<AdhesiveState>, Error> {
        if self.end.is_none() && self.plain.is_some() {
            return self.advance_plain();
        }
        while !self.prepare()? {}
        let Some(state) = self.queue.pop_front() else { return Ok(None) };
        let has_jumped = matches!(state.event, AdhesiveEvent::JumpEnd | AdhesiveEvent::Part);
        if self.queue.is_empty()
            && has_jumped
            && self.targets.is_past(&state.contact, self.direction)
        {
            self.end = Some(AdhesiveEnd::Target);
        }
        self.last = Some(state);
        Ok(self.last)
    }

    /// How a branch ends on which nothing more happens.
    fn last_end(&self) -> AdhesiveEnd {
        match self.last {
            Some(last) if self.targets.are_met(&last.contact, self.direction) => {
                AdhesiveEnd::Target
            }
            _ => AdhesiveEnd::NoMoreEvents,
        }
    }

    /// Follows the events of one window.
    fn window(&mut self) -> Result<(), Error> {
        let sign = self.direction.sign();
        let field = match self.field.take() {
            Some(field) => field,
            None => self.body.survey(&self.front, sign)?,
        };
        if self.front.held.is_empty()
            && let Some(node) = self.jump.take()
        {
            let moment = Moment::of(&self.body.law, &self.front, &field, self.totals);
            self.push(AdhesiveEvent::JumpEnd, node, &moment, self.trace.changes.len());
            self.field = Some(field);
            return Ok(());
        }
        let view = window::View {
            direction: self.direction,
            targets: &self.targets,
            gauge: self.body.problem.table().gauge_per_load(),
            totals: self.totals,
            last_node: self.trace.changes.last().map_or(0, |change| change.node),
        };
        // What a window costs grows with the soft nodes.
        let automatic = WATCHED.max(self.body.soft().len() / SOFT_FOR_ONE);
        let size = self.window_size.unwrap_or(automatic);
        let found = window::follow(&mut self.body, &self.front, &field, &view, size)?;
        let Some(played) = found else {
            self.end = Some(self.last_end());
            return Ok(());
        };
        let Played { front, field, moments, changes, totals, jump, is_at_limit, .. } = played;
        self.timings.windows += 1;
        self.timings.shortened += played.shortened;
        self.timings.taken_back += played.taken_back;
        self.timings.events += changes.len();
        let has_moved = front.approach != self.front.approach;
        let place = (front.approach, self.grid().nodes());
        self.tied.add(changes.len().max(1), has_moved, place)?;
        let before = self.trace.changes.len();
        self.trace.changes.extend(changes);
        // Behind the beginning of a jump this one is the first event again.
        let again = self.last.filter(|last| {
            last.event == AdhesiveEvent::JumpStart
                && last.direction == self.direction
                && self.jump.is_none()
        });
        let again = again.map(|last| self.grid().index(last.node.0, last.node.1));
        for (k, (event, node, moment, changes)) in moments.iter().enumerate() {
            if k == 0 && *event == AdhesiveEvent::JumpStart && again == Some(*node) {
                continue;
            }
            self.push(*event, *node, moment, before + changes);
        }
        self.front = front;
        self.field = Some(field);
        self.totals = totals;
        self.jump = self.jump.or(jump);
        if is_at_limit {
            self.end = Some(AdhesiveEnd::Target);
        }
        Ok(())
    }
}

/// The gauge of a periodic kernel, with the way back from work about the mean planes.
pub(super) struct GaugeOfPath(Gauge);

impl GaugeOfPath {
    /// ∫ W dδ in the gauge of the kernel, from that about the mean planes.
    fn work(&self, reported: f64, load: f64) -> f64 {
        reported + (reported - self.0.reported_energy(reported, load))
    }
}

impl Iterator for AdhesivePath {
    type Item = Result<AdhesiveState, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.end == Some(AdhesiveEnd::Failed) {
            return None;
        }
        let item = self.advance();
        if item.is_err() {
            self.end = Some(AdhesiveEnd::Failed);
        }
        item.transpose()
    }
}

impl FusedIterator for AdhesivePath {}
