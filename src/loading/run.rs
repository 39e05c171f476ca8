//! A path under way: what its procedures share.

use super::tuning::{LEFT_OPEN, SHALLOW, TOLERANCE};
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

use super::gap_field::{GapField, GapLine};
use super::plastic::Plastic;
use super::releases::Releases;
use super::scalars::PathScalars;
use super::state::{ContactEvent, LoadingState};
use super::sum::Sum;
use super::window::{BadPivot, Window};
use crate::contact::{ContactSequence, ContactState};
use crate::memory::Memory;
use crate::updater::{Behind, Iterations, LinearUpdater, Schur, Solution, WindowFactor};
use crate::{Boundary, ContactGrowth, Error, Grid, Problem, UpdaterError};

/// Where a path spent its time, besides its updater.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct LoadingTimings {
    /// Number of windows.
    pub windows: usize,
    /// With a factor how many events were computed and then taken back, because a state did not stand the check at the
    /// end of its window; without one how many windows.
    pub taken_back: usize,
    /// Number of solutions inside windows, to settle the order of events that were too close to be told
    /// apart otherwise.
    pub ties: usize,
    /// Displacements of all nodes at the ends of windows.
    pub convolution: Duration,
    /// Choice of the nodes to watch, once all displacements are known.
    pub choice: Duration,
    /// Events inside the windows.
    pub events: Duration,
}

/// A path under way, apart from what solves on its contact.
#[derive(Debug)]
pub(super) struct LoadingRun {
    /// The problem of the nodes that have not yielded: that of the surface where there is no hardness.
    pub(super) problem: Problem,
    /// The nodes in contact that have not yielded.
    pub(super) contact: ContactSequence,
    /// With a hardness.
    pub(super) plastic: Option<Arc<Plastic>>,
    pub(super) releases: Releases,
    pub(super) field: GapField,
    pub(super) scalars: PathScalars,
    /// States that are computed and not yielded yet.
    pub(super) queue: VecDeque<LoadingState>,
    pub(super) memory: Memory,
    /// The last state computed, behind which no other falls; `None` where contact need not grow.
    pub(super) last: Option<ContactState>,
    /// The error of the state that the path goes on from, if that is an estimate and no solution has been without
    /// tension and overlap since.
    pub(super) inherited: f64,
    pub(super) timings: LoadingTimings,
}

/// Where a path was before trials that it followed.
#[derive(Debug)]
pub(super) struct Before {
    problem: Problem,
    pub(super) contact: ContactSequence,
    plastic: Option<Arc<Plastic>>,
    releases: Releases,
    scalars: PathScalars,
}

impl LoadingRun {
    /// Number of events so far, those in the queue included.
    pub(super) fn steps(&self) -> usize {
        self.releases.steps(self.contact.len())
    }

    /// The problem of the surface.
    pub(super) fn surface(&self) -> &Problem {
        self.plastic.as_ref().map_or(&self.problem, |plastic| plastic.surface())
    }

    /// Number of nodes in contact, with those that have yielded.
    pub(super) fn contact_nodes(&self) -> usize {
        self.contact.len() + self.plastic.as_ref().map_or(0, |plastic| plastic.count())
    }

    /// The pressure at which a node yields.
    pub(super) fn hardness(&self, node: usize) -> f64 {
        self.plastic.as_ref().map_or(f64::INFINITY, |plastic| plastic.hardness().values()[node])
    }

    /// Whether any node has yielded.
    pub(super) fn has_yielded(&self) -> bool {
        self.plastic.as_ref().is_some_and(|plastic| plastic.count() > 0)
    }

    /// Whether nothing is known of the kernel, so that nodes may leave the contact.
    pub(super) fn may_leave(&self) -> bool {
        self.problem.growth() == ContactGrowth::Unknown
    }

    /// Whether a node in contact has a hardness that it can come to.
    pub(super) fn may_yield(&self) -> bool {
        self.plastic.as_ref().is_some_and(|plastic| {
            let hardness = plastic.hardness().values();
            self.contact.order().iter().any(|&node| hardness[node].is_finite())
        })
    }

    /// The first node that has yet to touch, or to come to its hardness; `None` at the end of the path.
    pub(super) fn waiting(&self) -> Option<usize> {
        let mut nodes = 0..self.problem.grid().nodes();
        nodes.find(|&node| {
            let plastic = self.plastic.as_ref();
            if self.contact.contains(node) {
                return plastic.is_some_and(|p| p.hardness().values()[node].is_finite());
            }
            !plastic.is_some_and(|plastic| plastic.has_yielded(node))
        })
    }

    /// Lets the nodes that the log says had yielded after `step` events have done so.
    pub(super) fn yield_at(&mut self, step: usize) -> Result<(), Error> {
        let yielded: Vec<usize> = self.releases.yielded_at(step).collect();
        match &self.plastic {
            Some(plastic) => {
                let (plastic, problem) = plastic.beside(&yielded)?;
                (self.plastic, self.problem) = (Some(Arc::new(plastic)), problem);
                Ok(())
            }
            None if yielded.is_empty() => Ok(()),
            None => Err(Error::OutOfRange {
                quantity: "hardness",
                value: f64::INFINITY,
                expected: "that of a path on which nodes have yielded",
            }),
        }
    }

    /// Takes all but the first `count` nodes back out of the contact, before anything else has followed them.
    pub(super) fn cut(
        &mut self,
        updater: &mut dyn LinearUpdater,
        count: usize,
    ) -> Result<(), Error> {
        self.contact.truncate(count);
        updater.truncate(&self.problem, &self.contact)
    }

    /// All that a trial changes.
    pub(super) fn before(&self) -> Before {
        Before {
            problem: self.problem.clone(),
            contact: self.contact.clone(),
            plastic: self.plastic.clone(),
            releases: self.releases.clone(),
            scalars: self.scalars,
        }
    }

    /// Takes back all trials since.
    pub(super) fn go_back(&mut self, before: Before) {
        let Before { problem, contact, plastic, releases, scalars } = before;
        self.problem = problem;
        self.contact = contact;
        self.plastic = plastic;
        self.releases = releases;
        self.scalars = scalars;
        self.field.forget();
    }

    /// Makes the gap field that of the present contact at an approach.
    pub(super) fn renew_field(
        &mut self,
        updater: &mut dyn LinearUpdater,
        approach: f64,
    ) -> Result<(), Error> {
        if self.field.belongs_to(&self.contact, approach) {
            return Ok(());
        }
        self.field.solve(&self.problem, &self.contact, updater, approach)?;
        self.timings.convolution = self.field.time();
        self.check_closed(&self.problem, &self.contact, approach)
    }

    /// Moves iterations to the present contact at an approach, with a rate that serves over a span.
    pub(super) fn advance_field(
        &mut self,
        iterations: &mut dyn Iterations,
        approach: f64,
        span: f64,
    ) -> Result<(), Error> {
        self.field.advance(&Behind::on(&self.problem, &self.contact, approach), iterations, span)
    }

    /// Whether the present solution leaves gaps in contact that are rounding.
    pub(super) fn is_closed_to_rounding(&self) -> bool {
        let most = LEFT_OPEN * (self.problem.greatest_gap() + self.scalars.approach());
        let mut left =
            self.contact.order().iter().map(|node| self.field.left_at(&self.problem, *node));
        left.all(|[gap, _]| gap.abs() <= most)
    }

    /// `Ok` if the solution of an exact updater closes the contact, to rounding: its residual is n rounding errors of
    /// `Σⱼ |Cᵢⱼ pⱼ|` at most, which C(0, 0) Σ |p| bounds, for no coefficient is greater; and so is that of the
    /// displacements. Those under nodes that have yielded are part of the initial gap.
    pub(super) fn check_closed(
        &self,
        problem: &Problem,
        contact: &ContactSequence,
        approach: f64,
    ) -> Result<(), Error> {
        let own = problem.table().self_influence();
        let sum = |values: &[f64]| own * values.iter().map(|value| value.abs()).sum::<f64>();
        let Solution { pressure, rate } = self.field.solution();
        let gaps = contact.order().iter().map(|&node| problem.initial_gap()[node].abs());
        let greatest_gap = gaps.fold(problem.greatest_gap(), f64::max);
        let lengths = [greatest_gap + approach.abs() + sum(pressure), 1.0 + sum(rate)];
        for &node in contact.order() {
            let left = self.field.left_at(problem, node);
            for (k, quantity) in ["gap", "rate of the gap"].into_iter().enumerate() {
                let (value, tolerance) = (left[k], TOLERANCE * lengths[k]);
                // NaN is none either.
                let is_closed = value.abs() <= tolerance && tolerance.is_finite();
                if !is_closed {
                    let (ix, iy) = problem.grid().coordinates(node);
                    return Err(Error::Updater(UpdaterError::ContactNotClosed {
                        quantity,
                        ix,
                        iy,
                        value,
                        tolerance,
                    }));
                }
            }
        }
        Ok(())
    }

    /// Visits all gaps out of contact, and takes the mean gap from them. With `allowed`, the overlap that a solution
    /// may leave, more than that and than rounding is an error.
    pub(super) fn survey(
        &mut self,
        allowed: Option<f64>,
        mut visit: impl FnMut(usize, GapLine),
    ) -> Result<(), Error> {
        let approach = self.scalars.approach();
        let rounding = TOLERANCE * (self.problem.greatest_gap() + approach);
        let least = -allowed.map_or(f64::INFINITY, |overlap| rounding.max(overlap));
        let (mut mean_gap, mut closing) = (Sum::default(), Sum::default());
        for (node, line) in self.field.lines(&self.problem, &self.contact, approach) {
            if line.gap.is_nan() {
                return Err(self.not_finite());
            }
            if line.gap < least {
                return Err(self.not_monotone("gap", node, line.gap));
            }
            closing.add(line.closing);
            mean_gap.add(line.gap);
            visit(node, line);
        }
        self.scalars.renew_gap(mean_gap, closing);
        Ok(())
    }

    /// The gap of a node from the present approach on.
    pub(super) fn line(&self, node: usize) -> GapLine {
        self.field.line(&self.problem, node, self.scalars.approach())
    }

    /// Opens a window on nodes at the present approach.
    pub(super) fn watch(
        &mut self,
        updater: &mut dyn LinearUpdater,
        window: &mut Window,
        nodes: impl Iterator<Item = usize>,
        horizon: f64,
    ) -> Result<(), Error> {
        let lines = nodes.map(|node| (node, self.line(node)));
        let (nodes, schur) = window.open((self.scalars.approach(), horizon), lines);
        updater.watch(&self.problem, &self.contact, nodes, schur)?;
        self.check_complement(nodes, schur)?;
        window.begin();
        self.timings.windows += 1;
        Ok(())
    }

    /// `Ok` if a Schur complement is one of so many nodes, and finite.
    pub(super) fn check_complement(&self, nodes: &[usize], schur: &Schur) -> Result<(), Error> {
        UpdaterError::check_length("the Schur complement", schur.size(), nodes.len())?;
        let matrix = schur.matrix();
        let lower = (0..nodes.len()).flat_map(|j| (j..nodes.len()).map(move |i| (i, j)));
        let numbers = lower.map(|place| matrix[place]);
        if !numbers.chain(schur.row_sums().iter().copied()).all(f64::is_finite) {
            return Err(self.not_finite());
        }
        Ok(())
    }

    /// Lets the nodes of a window's events join the contact.
    pub(super) fn join(
        &mut self,
        updater: &mut dyn LinearUpdater,
        window: &Window,
    ) -> Result<(), Error> {
        let count = self.contact.len();
        let joined = window
            .touched()
            .try_for_each(|node| self.contact.push(node))
            .and_then(|()| window.touched_factor())
            .and_then(|factor| updater.join(&self.problem, &self.contact, &factor));
        joined.map_err(|error| {
            // The updater may have taken them in: both go back, for the fields of the states up to there. One that
            // cannot says so when it is asked for them.
            let _ = self.cut(updater, count);
            self.memory.in_all(error)
        })
    }

    /// Puts the node that left last back to where it was. What the updater holds is another contact.
    pub(super) fn take_back_release(&mut self) -> Result<(), Error> {
        match self.releases.pop() {
            Some((position, node)) => self.contact.insert(position, node),
            None => Ok(()),
        }
    }

    /// Puts the present state into the queue, after something happened to a node there.
    pub(super) fn enqueue(
        &mut self,
        step: usize,
        event: ContactEvent,
        node: usize,
        contact_nodes: usize,
    ) -> Result<(), Error> {
        let scalars = self.scalars;
        self.enqueue_at(&scalars, (step, event, node), contact_nodes, 0.0)
    }

    /// Puts a state into the queue, after something happened to a node there; the approach that it reports may be off
    /// by `error`.
    pub(super) fn enqueue_at(
        &mut self,
        scalars: &PathScalars,
        (step, event, node): (usize, ContactEvent, usize),
        contact_nodes: usize,
        error: f64,
    ) -> Result<(), Error> {
        let mut contact = scalars.state(contact_nodes);
        if !scalars.is_sound(&contact) {
            return Err(Error::NotFinite { step });
        }
        if let Some(last) = &mut self.last {
            contact.keep_growing(last);
            *last = contact;
        }
        self.queue.push_back(LoadingState {
            step,
            event,
            node: self.problem.grid().coordinates(node),
            approach_error: error,
            contact,
        });
        Ok(())
    }

    /// Bytes that a path on a grid holds whatever the number of nodes in contact.
    pub(super) fn bytes_on(grid: &Grid, boundary: Boundary) -> usize {
        let ranking = grid.nodes() * size_of::<(f64, usize)>();
        ranking
            + ContactSequence::bytes_on(grid)
            + Problem::bytes_on(grid, boundary)
            + GapField::bytes_on(grid, boundary)
    }

    /// Bytes that it holds besides where nodes may leave: the touches of single nodes, and gaps at the start of a window.
    pub(super) fn bytes_where_nodes_leave(grid: &Grid) -> usize {
        grid.nodes() * (size_of::<(f64, usize)>() + size_of::<(usize, GapLine)>())
    }

    /// The greatest window up to `size` that stays within the memory budget beside an updater.
    pub(super) fn affordable(
        &self,
        updater: &dyn LinearUpdater,
        mut size: usize,
    ) -> Result<usize, Error> {
        let count = self.contact.len();
        loop {
            // Where nodes may yield, a row for each of their pressures as well.
            let rows = if self.plastic.is_some() { 2 * size } else { size };
            let relief = if self.may_leave() { count.saturating_mul(8 * size) } else { 0 };
            let needed = updater.bytes(count + size, size);
            let needed = needed.saturating_add(relief).saturating_add(WindowFactor::bytes(rows));
            match self.memory.check(needed, count) {
                Err(_) if size > 1 => size /= 2,
                checked => return checked.map(|()| size),
            }
        }
    }

    /// The first node in contact whose pressure at an approach is not a number, or below zero by more than
    /// rounding and what goes with an overlap that the solution may leave.
    pub(super) fn negative_pressure(&self, approach: f64, overlap: f64) -> Option<(usize, f64)> {
        let greatest = self.greatest_pressure(approach);
        let most = TOLERANCE * greatest + overlap / self.problem.table().self_influence();
        let mut pressures = self.field.pressures(&self.contact, approach);
        pressures.find(|(_, p)| p.is_nan() || *p < -most)
    }

    pub(super) fn greatest_pressure(&self, approach: f64) -> f64 {
        let pressures = self.field.pressures(&self.contact, approach);
        pressures.map(|(_, pressure)| pressure).fold(0.0, f64::max)
    }

    /// The greatest y₂.
    pub(super) fn greatest_rate(&self) -> f64 {
        let rates = self.field.solution().rate.iter();
        rates.copied().fold(0.0, f64::max)
    }

    /// How far gaps of the state that the path goes on from may be off, if that is an estimate: a node that has touched
    /// or yielded by it may lie beyond where a factor, or another solution, has it.
    pub(super) fn inherited_slack(&self) -> f64 {
        if self.inherited > 0.0 {
            let length = self.problem.greatest_gap() + self.scalars.approach();
            self.inherited.max(SHALLOW * length)
        } else {
            0.0
        }
    }

    /// The error of a quantity of a node with the wrong sign at the present approach.
    pub(super) fn not_monotone(&self, quantity: &'static str, node: usize, value: f64) -> Error {
        let (ix, iy) = self.problem.grid().coordinates(node);
        Error::NotMonotone { quantity, ix, iy, approach: self.scalars.approach(), value }
    }

    /// That a node cannot touch, in a window that began at the present approach.
    pub(super) fn not_positive_definite(&self, bad: BadPivot) -> Error {
        let (ix, iy) = self.problem.grid().coordinates(bad.node);
        Error::NotPositiveDefinite {
            ix,
            iy,
            approach: self.scalars.approach() + bad.time,
            pivot: bad.pivot,
        }
    }

    /// The error of a next state that would not be finite.
    pub(super) fn not_finite(&self) -> Error {
        Error::NotFinite { step: self.steps() + 1 }
    }
}

#[cfg(test)]
mod tests;
