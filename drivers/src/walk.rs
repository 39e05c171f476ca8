//! A walk along the states of a path, each of which is looked at densely.
//!
//! Between two events the set of nodes in contact does not change and all is linear in the approach. So a path is right
//! if at *both* ends of each interval no pressure and no gap is negative, and if the node of an event has neither
//! pressure nor gap there: any other node that touched earlier would overlap at the end of the interval. The solution
//! of a positive definite complementarity problem is the only one, so that this also fixes the order of events, up to
//! nodes that touch at the same approach to rounding.
//!
//! With a hardness no pressure may exceed it, and where a node has yielded the gap must not be above zero. A node of an
//! event comes from out of contact to elastic, or from elastic to yielded.

use asperity::loading::ContactEvent;
use asperity::{Grid, LoadingState};
use nalgebra::DMatrix;

use crate::dense::{ContactSet, Dense, Instant, Node, Norms, Scalars};
use crate::verdict::{Tally, Violation, ensure};

/// Events closer than this, relative to the approach, are simultaneous to the library, the lowest index first.
const TIE: f64 = 1e-13;

/// What may be asked of the states.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Demands {
    /// Gaps in contact that a solution may leave, relative to the approach.
    pub(crate) residual: f64,
    /// Error relative to the pressures from which on a matrix is too ill-conditioned to say anything.
    pub(crate) hopeless: f64,
}

impl Demands {
    /// Exact to rounding.
    pub(crate) const EXACT: Self = Self { residual: 0.0, hopeless: 1e-3 };
}

/// Where a walk stands.
pub(crate) struct Walk<'a> {
    dense: &'a Dense,
    grid: Grid,
    demands: Demands,
    /// Elastic nodes, and yielded ones.
    contact: Vec<usize>,
    yielded: Vec<usize>,
    last: Option<LoadingState>,
    /// The greatest error of a dense gap so far: a mean gap is carried by the closing rates of all contacts before,
    /// whose errors add up to no more than that, since their ways add up to the approach.
    gap_error: f64,
    /// Greatest gap that a node which ties had when it touched, or what was missing of a pressure displaces: of ties
    /// the lowest comes first, and windows carry on what that leaves.
    left_open: f64,
    /// The greatest norms so far, with a hardness.
    norms: Norms,
    tally: Tally,
    /// Whether the matrix of the contact was too ill-conditioned once: nothing was looked at from there on.
    blind: bool,
}

impl<'a> Walk<'a> {
    pub(crate) fn new(dense: &'a Dense, grid: Grid, demands: Demands) -> Self {
        Self {
            dense,
            grid,
            demands,
            contact: Vec::new(),
            yielded: Vec::new(),
            last: None,
            gap_error: 0.0,
            left_open: 0.0,
            norms: Norms::default(),
            tally: Tally::default(),
            blind: false,
        }
    }

    /// Looks at every state, the next of the path each.
    pub(crate) fn follow(&mut self, states: &[LoadingState]) -> Result<(), Violation> {
        for state in states {
            self.step(state).map_err(|violation| violation.during(format!("{state:?}")))?;
        }
        Ok(())
    }

    /// Goes behind states without a check, but with what they leave to later ones: ties, and contacts whose matrix was
    /// too ill-conditioned.
    pub(crate) fn pass(&mut self, states: &[LoadingState]) -> Result<(), Violation> {
        for state in states {
            let before = self.last.and_then(|_| self.solved(state));
            let node = self.take(state)?;
            if let (Some((set, instant)), Some(node)) = (before, node) {
                self.leave_open(state.event, node, (&set, &instant));
            }
            match self.solved(state) {
                Some((set, _)) if self.dense.hardness().is_some() => self.norms = set.norms,
                found => self.blind |= found.is_none(),
            }
            self.last = Some(*state);
        }
        Ok(())
    }

    /// Goes behind states that were looked at before, without looking at them.
    pub(crate) fn skip(&mut self, states: &[LoadingState]) -> Result<(), Violation> {
        for state in states {
            self.take(state)?;
            if self.dense.hardness().is_some()
                && let Some(set) = self.set()
            {
                self.norms = set.norms;
            }
            self.last = Some(*state);
        }
        Ok(())
    }

    pub(crate) fn tally(&self) -> Tally {
        self.tally
    }

    /// The nodes in contact where the walk stands that have not yielded.
    pub(crate) fn contact(&self) -> &[usize] {
        &self.contact
    }

    /// Compares fields with those of a state on the contact where the walk stands: pressures, gaps, plastic depths.
    pub(crate) fn compare_fields(
        &mut self,
        state: &LoadingState,
        [pressure, gap, depth]: [&DMatrix<f64>; 3],
    ) -> Result<(), Violation> {
        let found = self.dense.of(state);
        let Some((set, instant)) = self.solved(state) else {
            return Ok(());
        };
        self.check_scalars(&found, &set, &instant)?;
        self.check_signs(&set, &instant)?;
        for node in 0..self.dense.nodes() {
            let own = self.dense.own_pressure(pressure[node]);
            let expected = instant.pressure[node];
            self.tally.close("pressure", own, expected, instant.pressure_error)?;
            let (own, own_depth) =
                (self.dense.own_length(gap[node]), self.dense.own_length(depth[node]));
            let (expected, expected_depth) = match set.states()[node] {
                Node::Yielded => (0.0, -instant.gap[node]),
                _ => (instant.gap[node], 0.0),
            };
            let yields = set.states()[node] == Node::Yielded;
            ensure!(
                if yields { own == 0.0 } else { own_depth == 0.0 },
                "node {node} has a gap of {own:e} and a plastic depth of {own_depth:e}"
            );
            self.tally.close("gap", own, expected, instant.gap_error)?;
            self.tally.close("plastic depth", own_depth, expected_depth, instant.gap_error)?;
        }
        self.tally.checked += 1;
        Ok(())
    }

    /// How many nodes are about to touch or to leave at the last state, as far as rounding lets see: pressures of the
    /// contact and gaps elsewhere that are zero to a hundred times the error they may have. All of them, where nothing
    /// can be said.
    pub(crate) fn on_the_edge(&self) -> usize {
        let Some((set, instant)) = self.last.and_then(|state| self.solved(&state)) else {
            return self.dense.nodes();
        };
        let is_zero = |node: &usize| match set.contains(*node) {
            true => instant.pressure[*node].abs() <= 100.0 * instant.pressure_error,
            false => instant.gap[*node].abs() <= 100.0 * instant.gap_error,
        };
        (0..self.dense.nodes()).filter(is_zero).count()
    }

    /// `Ok` if nothing can happen any more: no gap closes, and no pressure falls.
    pub(crate) fn check_no_more_events(&mut self) -> Result<(), Violation> {
        let Some(set) = self.set() else {
            return Ok(());
        };
        for node in 0..self.dense.nodes() {
            if set.contains(node) {
                let allowed = set.rate_error();
                self.tally.not_negative("least rate of pressure", set.rate[node], allowed)?;
            } else {
                let opening = -set.closing[node];
                self.tally.not_negative("least rate of a gap", opening, set.closing_error)?;
            }
        }
        Ok(())
    }

    /// `Ok` if no node is left that could touch or yield.
    pub(crate) fn check_nothing_is_left(&self) -> Result<(), Violation> {
        let yields = |node: &&usize| {
            self.dense.hardness().is_some_and(|hardness| hardness[**node].is_finite())
        };
        let left = self.contact.iter().find(yields);
        ensure!(
            left.is_none() && self.contact.len() + self.yielded.len() == self.dense.nodes(),
            "node {left:?} may yield, of {} in contact and {} that have yielded",
            self.contact.len(),
            self.yielded.len()
        );
        Ok(())
    }

    /// Does to the contact what happens at a state; the node, unless nothing happens.
    fn take(&mut self, state: &LoadingState) -> Result<Option<usize>, Violation> {
        let (ix, iy) = state.node;
        let node = self.grid.node(ix, iy);
        let Some(node) = node else {
            return Err(Violation::new("its node is not on the grid"));
        };
        let place = self.contact.iter().position(|&other| other == node);
        match (state.event, place) {
            (ContactEvent::Touch, None) if !self.yielded.contains(&node) => self.contact.push(node),
            (ContactEvent::Release, Some(place)) if self.dense.hardness().is_none() => {
                self.contact.remove(place);
            }
            (ContactEvent::Yield, Some(place)) if self.dense.hardness().is_some() => {
                self.contact.remove(place);
                self.yielded.push(node);
            }
            (ContactEvent::Limit, _) => return Ok(None),
            (event, _) => {
                return Err(Violation::new(format!(
                    "node {node} has the event {event:?} while its place in the contact is {place:?}"
                )));
            }
        }
        Ok(Some(node))
    }

    fn step(&mut self, state: &LoadingState) -> Result<(), Violation> {
        let found = self.dense.of(state);
        let before = self.last.and_then(|_| self.solved(state));
        let last = self.last;
        let node = self.take(state)?;
        self.check_counts(state)?;
        if let (Some((set, instant)), Some(last)) = (&before, last) {
            self.check_scalars(&found, set, instant)?;
            self.check_signs(set, instant)?;
            // Where no node has yielded, both errors are the same.
            if let Some(node) = node {
                self.leave_open(state.event, node, (set, instant));
                let (what, value, allowed) = if state.event == ContactEvent::Yield {
                    let hardness = self.hardness(node);
                    let left = hardness - instant.pressure[node];
                    let allowed = set.norms.inverse * instant.carried_error + TIE * hardness;
                    ("pressure missing where a node yields", left, allowed)
                } else if set.contains(node) {
                    let value = instant.pressure[node];
                    ("pressure of the node that leaves", value, instant.pressure_error)
                } else {
                    let allowed = instant.carried_error + TIE * instant.lengths;
                    ("gap of the node that touches", instant.gap[node].abs(), allowed)
                };
                self.tally.close(what, value, 0.0, allowed)?;
            }
            let allowed = set.sum_error(instant.carried_error);
            let change = found.sum - self.dense.own_sum(last.contact.load);
            self.tally.not_negative("growth of the load", change, allowed)?;
            let change = found.own_approach - self.dense.of(&last).own_approach;
            self.tally.not_negative("growth of the approach", change, instant.carried_error)?;
        } else if last.is_none() {
            let first =
                (state.step, state.contact.approach, state.contact.load, state.contact.energy);
            ensure!(first == (1, 0.0, 0.0, 0.0), "it is no first touch");
            let highest = (0..self.dense.nodes()).find(|&node| self.dense.gap()[node] == 0.0);
            ensure!(node == highest, "the first of the highest nodes is {highest:?}");
        }
        if let Some((set, instant)) = self.solved(state) {
            self.check_scalars(&found, &set, &instant)?;
            set.check_rates(&found, &mut self.tally)?;
            self.check_signs(&set, &instant)?;
            self.tally.checked += 1;
            if self.dense.hardness().is_some() {
                self.norms = set.norms;
            }
        } else {
            self.blind = true;
        }
        self.last = Some(*state);
        Ok(())
    }

    /// Keeps what an event leaves of the gap of its node, or of the pressure that is missing where it yields.
    fn leave_open(
        &mut self,
        event: ContactEvent,
        node: usize,
        (set, instant): (&ContactSet<'_>, &Instant),
    ) {
        let open = match event {
            ContactEvent::Yield => {
                let left = self.hardness(node) - instant.pressure[node];
                self.dense.self_influence() * left.abs()
            }
            _ if set.contains(node) => 0.0,
            _ => instant.gap[node].abs(),
        };
        self.left_open = self.left_open.max(open);
    }

    /// The equations of the contact, solved at the approach of a state; `None` where nothing can be said.
    pub(crate) fn solved(&self, state: &LoadingState) -> Option<(ContactSet<'a>, Instant)> {
        if self.blind {
            return None;
        }
        let set = self.set()?;
        let mut instant = set.at(self.dense.of(state).own_approach);
        instant.carried_error += self.left_open;
        let worst = instant.gap_error.max(set.closing_error);
        (worst <= self.demands.hopeless).then_some((set, instant))
    }

    fn set(&self) -> Option<ContactSet<'a>> {
        let nodes = [&self.contact[..], &self.yielded[..]];
        ContactSet::beside(self.dense, nodes, self.demands.residual, self.norms)
    }

    fn hardness(&self, node: usize) -> f64 {
        self.dense.hardness().map_or(f64::INFINITY, |hardness| hardness[node])
    }

    fn check_counts(&self, state: &LoadingState) -> Result<(), Violation> {
        let nodes = self.contact.len() + self.yielded.len();
        let events = self.last.map_or(0, |last| last.step);
        let expected = match state.event {
            ContactEvent::Limit => events,
            _ => events + 1,
        };
        ensure!(
            state.contact.contact_nodes == nodes && state.step == expected,
            "{nodes} nodes are in contact after {expected} events"
        );
        // Products of two numbers, in whichever order.
        let area = nodes as f64 * self.grid.cell_area();
        let fraction = nodes as f64 / self.grid.nodes() as f64;
        ensure!(
            (state.contact.contact_area - area).abs() <= 4.0 * f64::EPSILON * area
                && (state.contact.contact_area_fraction - fraction).abs() <= f64::EPSILON,
            "the area is {area:e}, a fraction of {fraction:e}"
        );
        let yielded = self.yielded.len();
        let fraction = yielded as f64 / self.grid.nodes() as f64;
        let is_right = match state.contact.plastic {
            None => self.dense.hardness().is_none(),
            Some(plastic) => {
                self.dense.hardness().is_some()
                    && plastic.yielded_nodes == yielded
                    && (plastic.yielded_area_fraction - fraction).abs() <= f64::EPSILON
            }
        };
        ensure!(is_right, "{yielded} nodes have yielded, a fraction of {fraction:e}");
        Ok(())
    }

    fn check_scalars(
        &mut self,
        found: &Scalars,
        set: &ContactSet<'_>,
        instant: &Instant,
    ) -> Result<(), Violation> {
        let tally = &mut self.tally;
        let sum = instant.pressure.sum();
        let allowed = set.sum_error(instant.carried_error);
        tally.close("load", found.sum, sum, allowed)?;
        let overlap: f64 = set.all(Node::Yielded).map(|node| instant.gap[node]).sum();
        let gap = instant.gap.mean() - overlap / self.dense.nodes() as f64;
        self.gap_error = self.gap_error.max(instant.carried_error);
        let allowed = self.gap_error + instant.carried_error;
        tally.close("mean gap", found.mean_gap, gap, allowed)?;
        if let Some(plastic) = found.plastic {
            let [expected, errors] = set.plastic_sums(instant, allowed);
            for (k, what) in ["plastic volume", "plastic work"].into_iter().enumerate() {
                tally.close(what, plastic.sums[k], expected[k], errors[k])?;
            }
        }
        let (energy, allowed) = set.energy(instant);
        tally.close("energy", found.energy, energy, allowed)
    }

    /// At the approach of a state that may have come through a window.
    fn check_signs(&mut self, set: &ContactSet<'_>, instant: &Instant) -> Result<(), Violation> {
        let length = instant.carried_error + TIE * instant.lengths;
        for (node, state) in set.states().iter().enumerate() {
            let (pressure, gap) = (instant.pressure[node], instant.gap[node]);
            match state {
                Node::Out => self.tally.not_negative("a gap", gap, length)?,
                Node::Yielded => self.tally.not_negative("a plastic depth", -gap, length)?,
                Node::Elastic => {
                    let error = set.norms.inverse * instant.carried_error;
                    let hardness = self.hardness(node);
                    self.tally.not_negative("a pressure", pressure, error)?;
                    if hardness.is_finite() {
                        let error = error + TIE * hardness;
                        self.tally.not_negative("what a node bears", hardness - pressure, error)?;
                    }
                }
            }
        }
        Ok(())
    }
}
