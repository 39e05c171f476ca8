//! The front of the path: all scalars of a state, kept up to date at every event.

use super::gap_field::GapField;
use super::sum::Sum;
use crate::contact::{ContactSequence, ContactState};
use crate::kernel::Gauge;
use crate::updater::Solution;
use crate::{Grid, Problem};

/// Where the last event left the path.
///
/// Nothing else knows the gauge of a periodic kernel: the approach here is the one for which
/// `gap = g + C p − δ` holds with the kernel as it is, and [`state`](Self::state) reports it free of the
/// gauge.
#[derive(Debug, Clone, Copy)]
pub(super) struct Front {
    grid: Grid,
    gauge: Gauge,
    /// Whether the approach is that of a distant point of the half-space.
    has_distant_point: bool,
    approach: f64,
    load: f64,
    energy: f64,
    mean_gap: f64,
    /// `eᵀ C_II⁻¹ e`: stiffness over cell area.
    unit_stiffness: f64,
    /// Mean of r₂ over the grid: how fast the mean gap closes with the approach.
    closing: f64,
}

impl Front {
    pub(super) fn new(problem: &Problem) -> Self {
        Self {
            grid: problem.grid(),
            gauge: problem.table().gauge_per_load(),
            has_distant_point: problem.table().gauge().is_none(),
            approach: 0.0,
            load: 0.0,
            energy: 0.0,
            mean_gap: 0.0,
            unit_stiffness: 0.0,
            closing: 0.0,
        }
    }

    /// The approach in the gauge of the kernel.
    pub(super) fn approach(&self) -> f64 {
        self.approach
    }

    /// Advances to an approach up to the next event, or, under the paper's rule, back to one.
    pub(super) fn advance(&mut self, approach: f64) {
        let change = approach - self.approach;
        let load = self.load + self.grid.cell_area() * self.unit_stiffness * change;
        self.approach = approach;
        self.energy += 0.5 * (self.load + load) * change;
        self.load = load;
        self.mean_gap -= self.closing * change;
    }

    /// Goes to another approach, with scalars that are yet to be renewed.
    pub(super) fn place_at(&mut self, approach: f64) {
        self.approach = approach;
    }

    /// What must be added to stiffness and closing rate for them to be those of another front.
    pub(super) fn missing(&self, other: &Self) -> [f64; 2] {
        let closing = (self.closing - other.closing) * self.grid.nodes() as f64;
        [other.unit_stiffness - self.unit_stiffness, closing]
    }

    /// Adds to load, mean gap and energy what they lack at the end of a window, in proportion to the way there,
    /// for the energy to its square: `walked` got there from this one's window, `end` is exact.
    pub(super) fn pin(&mut self, walked: &Self, end: &Self, way: f64) {
        self.load += way * (end.load - walked.load);
        self.mean_gap += way * (end.mean_gap - walked.mean_gap);
        self.energy += way * way * (end.energy - walked.energy);
    }

    /// Lets a node join that adds to stiffness and closing rate; `contact_nodes` are in contact then.
    pub(super) fn touch(&mut self, unit_stiffness: f64, closing: f64, contact_nodes: usize) {
        self.unit_stiffness += unit_stiffness;
        self.closing -= closing / self.grid.nodes() as f64;
        if contact_nodes == self.grid.nodes() {
            self.close();
        }
    }

    /// Full contact, by identity and not by arithmetic.
    pub(super) fn close(&mut self) {
        self.mean_gap = 0.0;
        self.closing = 0.0;
    }

    /// A mean gap below nothing is rounding, unless the paper's rule lets surfaces overlap.
    pub(super) fn clamp_mean_gap(&mut self) {
        self.mean_gap = self.mean_gap.max(0.0);
    }

    /// Takes mean gap and its rate from the gaps out of contact: sums without cancellation, unlike the
    /// running ones. Close to full contact only they are exact.
    pub(super) fn renew_gap(&mut self, mean_gap: Sum, closing: Sum) {
        let nodes = self.grid.nodes() as f64;
        self.mean_gap = mean_gap.total() / nodes;
        self.closing = closing.total() / nodes;
    }

    /// Takes the stiffness from the solution on the contact.
    pub(super) fn renew_stiffness(&mut self, solution: &Solution) {
        let mut stiffness = Sum::default();
        solution.rate.iter().for_each(|y2| stiffness.add(*y2));
        self.unit_stiffness = stiffness.total();
    }

    /// Takes load, energy and stiffness from the solution on the contact.
    pub(super) fn renew_load(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        field: &GapField,
    ) {
        self.renew_stiffness(field.solution());
        let (mut load, mut work) = (Sum::default(), Sum::default());
        for (node, pressure) in field.pressures(contact, self.approach) {
            load.add(pressure);
            work.add(pressure * (self.approach - problem.initial_gap()[node]));
        }
        self.load = self.grid.cell_area() * load.total();
        self.energy = 0.5 * self.grid.cell_area() * work.total();
    }

    /// The state with so many nodes in contact.
    pub(super) fn state(&self, contact_nodes: usize) -> ContactState {
        let stiffness = self.grid.cell_area() * self.unit_stiffness;
        let approach = self.gauge.reported_approach(self.approach, self.load);
        ContactState {
            contact_stiffness: self.has_distant_point.then_some(stiffness),
            interfacial_stiffness: Some(stiffness / self.closing),
            energy: self.gauge.reported_energy(self.energy, self.load),
            ..ContactState::new(
                &self.grid,
                contact_nodes,
                approach,
                self.load,
                self.mean_gap,
            )
        }
    }

    /// Whether the state is one: everything finite, the stiffness positive.
    pub(super) fn is_sound(&self, state: &ContactState) -> bool {
        state.is_finite() && self.unit_stiffness > 0.0 && self.unit_stiffness.is_finite()
    }

    /// The approach of a state in the gauge of the kernel.
    pub(super) fn own_approach(&self, state: &ContactState) -> f64 {
        self.gauge.approach(state.approach, state.load)
    }

    /// What to take off displacements in the gauge of the kernel.
    pub(super) fn uniform_displacement(&self, load: f64) -> f64 {
        self.gauge.displacement(load)
    }
}
