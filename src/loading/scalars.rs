//! The scalars of the path, kept up to date at every event.

use super::gap_field::GapField;
use super::sum::Sum;
use crate::contact::{ContactSequence, ContactState, PlasticState};
use crate::kernel::Gauge;
use crate::updater::Solution;
use crate::{Grid, Problem};

/// Approach, load, energy, mean gap and stiffnesses where the last event left the path.
///
/// Nothing else knows the gauge of a periodic kernel: the approach here is the one for which
/// `gap = g + C p − δ` holds with the kernel as it is, and [`state`](Self::state) reports it free of the
/// gauge.
#[derive(Debug, Clone, Copy)]
pub(super) struct PathScalars {
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
    /// With a hardness.
    plastic: Option<PlasticScalars>,
}

/// Overlaps of yielded nodes.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct PlasticScalars {
    /// Number of these nodes.
    pub(super) nodes: usize,
    /// Σ v.
    pub(super) depth: f64,
    /// Σ H v.
    pub(super) work: f64,
    /// How fast both grow with the approach.
    pub(super) rates: [f64; 2],
}

/// Rates behind an event, or how it changes them, per unit of approach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rates {
    /// `eᵀ C_II⁻¹ e` of the elastic nodes.
    pub(super) unit_stiffness: f64,
    /// Sum of closing rates.
    pub(super) closing: f64,
    /// Sums of v and H v of yielded nodes.
    pub(super) plastic: [f64; 2],
}

impl PathScalars {
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
            plastic: None,
        }
    }

    /// The approach in the gauge of the kernel.
    pub(super) fn approach(&self) -> f64 {
        self.approach
    }

    /// Approach, load, energy, mean gap, stiffness and closing rate as they are: sums over all events so far.
    pub(super) fn numbers(&self) -> [f64; 6] {
        let Self { approach, load, energy, mean_gap, unit_stiffness, closing, .. } = *self;
        [approach, load, energy, mean_gap, unit_stiffness, closing]
    }

    /// Takes these numbers over.
    pub(super) fn take_over(&mut self, numbers: [f64; 6]) {
        let [approach, load, energy, mean_gap, unit_stiffness, closing] = numbers;
        *self = Self { approach, load, energy, mean_gap, unit_stiffness, closing, ..*self };
    }

    /// Advances to an approach up to the next event.
    pub(super) fn advance(&mut self, approach: f64) {
        let change = approach - self.approach;
        let load = self.load + self.grid.cell_area() * self.unit_stiffness * change;
        self.approach = approach;
        self.energy += 0.5 * (self.load + load) * change;
        self.load = load;
        if let Some(plastic) = &mut self.plastic {
            let [depth, work] = plastic.rates;
            plastic.depth += depth * change;
            plastic.work += work * change;
            self.energy -= self.grid.cell_area() * work * change;
        }
        self.mean_gap -= self.closing * change;
    }

    /// By how much the load is greater than that of other scalars.
    pub(super) fn load_beyond(&self, other: &Self) -> f64 {
        self.load - other.load
    }

    /// The load that a change of the approach takes.
    pub(super) fn load_over(&self, approach: f64) -> f64 {
        self.load_of(self.unit_stiffness, approach)
    }

    /// The load that a part of the stiffness takes over a change of the approach.
    pub(super) fn load_of(&self, unit_stiffness: f64, approach: f64) -> f64 {
        self.grid.cell_area() * unit_stiffness * approach
    }

    /// Goes to another approach, with scalars that are yet to be renewed.
    pub(super) fn place_at(&mut self, approach: f64) {
        self.approach = approach;
    }

    /// Adds to load, mean gap, energy and plastic sums what they lack at the end of a window, where the window came to
    /// `walked` and `end` is exact: by the way of the load, the way of the rest, and those of both plastic sums. What
    /// the energy lacks is work of the load, by the square of the way, less plastic work, by its own.
    pub(super) fn pin(
        &mut self,
        walked: &Self,
        end: &Self,
        [way_of_load, way, way_of_depth, way_of_work]: [f64; 4],
    ) {
        let plastic = |scalars: &Self| scalars.plastic.unwrap_or_default();
        let [depth, work] =
            [plastic(end).depth - plastic(walked).depth, plastic(end).work - plastic(walked).work];
        let lost = self.grid.cell_area() * work;
        self.load += way_of_load * (end.load - walked.load);
        self.mean_gap += way * (end.mean_gap - walked.mean_gap);
        self.energy += way * way * (end.energy - walked.energy + lost) - way_of_work * lost;
        if let Some(own) = &mut self.plastic {
            own.depth += way_of_depth * depth;
            own.work += way_of_work * work;
        }
    }

    /// The approach, and both plastic sums.
    pub(super) fn lengths(&self) -> [f64; 3] {
        let plastic = self.plastic.unwrap_or_default();
        [self.approach, plastic.depth, plastic.work]
    }

    /// What the reported approach may be off by, if the one in the gauge of the kernel is by `approach`, and the load
    /// at a given one by `load`.
    pub(super) fn reported_error(&self, approach: f64, load: f64) -> f64 {
        let stiffness = self.grid.cell_area() * self.unit_stiffness;
        let open = 1.0 - self.gauge.displacement(stiffness);
        open.abs() * approach + self.gauge.displacement(load)
    }

    /// Lets a node join that adds to stiffness and closing rate; `contact_nodes` are in contact then.
    pub(super) fn touch(&mut self, [unit_stiffness, closing]: [f64; 2], contact_nodes: usize) {
        self.unit_stiffness += unit_stiffness;
        self.closing -= closing / self.grid.nodes() as f64;
        if contact_nodes == self.grid.nodes() {
            self.close();
        }
    }

    /// The same of a path on which nodes may yield.
    pub(super) fn with_hardness(self) -> Self {
        Self { plastic: Some(PlasticScalars::default()), ..self }
    }

    /// So many nodes have yielded; what follows from a solution is yet to be renewed.
    pub(super) fn place_yielded(&mut self, nodes: usize) {
        self.plastic.get_or_insert_default().nodes = nodes;
    }

    /// Stiffness, and sums of closing rates and of plastic rates.
    pub(super) fn rates(&self) -> Rates {
        Rates {
            unit_stiffness: self.unit_stiffness,
            closing: self.closing * self.grid.nodes() as f64,
            plastic: self.plastic.unwrap_or_default().rates,
        }
    }

    /// Takes over the rates behind an event, with `elastic` and `yielded` nodes in contact; the sum of the pressures of
    /// the latter is the load on a plateau, where no node is elastic.
    pub(super) fn change_rates(&mut self, rates: Rates, [elastic, yielded]: [usize; 2], sum: f64) {
        self.unit_stiffness = rates.unit_stiffness;
        self.closing = rates.closing / self.grid.nodes() as f64;
        if let Some(plastic) = &mut self.plastic {
            plastic.nodes = yielded;
            // On a plateau by identity.
            plastic.rates = if elastic == 0 { [yielded as f64, sum] } else { rates.plastic };
        }
        if elastic == 0 {
            self.unit_stiffness = 0.0;
            self.load = self.grid.cell_area() * sum;
            self.closing = (self.grid.nodes() - yielded) as f64 / self.grid.nodes() as f64;
        }
        if elastic + yielded == self.grid.nodes() {
            self.close();
        }
    }

    /// Keeps the load between what pressures of these sums carry: beyond, it is rounding.
    pub(super) fn clamp_load(&mut self, [least, most]: [f64; 2]) {
        let area = self.grid.cell_area();
        self.load = self.load.max(area * least).min(area * most);
    }

    /// Takes load, elastic energy and plastic sums at the present approach from a solution.
    pub(super) fn renew_plastic(&mut self, [load, energy]: [Sum; 2], plastic: PlasticScalars) {
        self.load = self.grid.cell_area() * load.total();
        self.energy = 0.5 * self.grid.cell_area() * energy.total();
        self.plastic = Some(plastic);
    }

    /// Full contact, by identity and not by arithmetic.
    pub(super) fn close(&mut self) {
        self.mean_gap = 0.0;
        self.closing = 0.0;
    }

    /// A mean gap below nothing is rounding.
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
            interfacial_stiffness: Some(if self.closing == 0.0 {
                f64::INFINITY
            } else {
                stiffness / self.closing
            }),
            plastic: self.plastic.map(|plastic| self.plastic_state(&plastic)),
            energy: self.gauge.reported_energy(self.energy, self.load),
            ..ContactState::new(&self.grid, contact_nodes, approach, self.load, self.mean_gap)
        }
    }

    fn plastic_state(&self, plastic: &PlasticScalars) -> PlasticState {
        let area = self.grid.cell_area();
        let per_load = |rate: f64| {
            if self.unit_stiffness > 0.0 { rate / self.unit_stiffness } else { 0.0 }
        };
        let [volume_per_load, work_per_load] = plastic.rates.map(per_load);
        PlasticState {
            yielded_nodes: plastic.nodes,
            yielded_area_fraction: plastic.nodes as f64 / self.grid.nodes() as f64,
            volume: area * plastic.depth,
            work: area * plastic.work,
            volume_per_load,
            work_per_load,
            ..PlasticState::default()
        }
    }

    /// Whether the state is one: everything finite, the stiffness positive unless all nodes in contact have yielded.
    pub(super) fn is_sound(&self, state: &ContactState) -> bool {
        let is_stiff = self.unit_stiffness > 0.0 || state.is_plateau();
        state.is_finite() && is_stiff && self.unit_stiffness.is_finite()
    }

    /// The approach of a state in the gauge of the kernel.
    pub(super) fn own_approach(&self, state: &ContactState) -> f64 {
        self.gauge.approach(state.approach, state.load)
    }

    /// The mean displacement in the gauge of the kernel, which displacements are reported without.
    pub(super) fn uniform_displacement(&self, load: f64) -> f64 {
        self.gauge.displacement(load)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::loading::test_chain;
    use crate::{Boussinesq, Error, HeightMap, PeriodicBoussinesq};

    fn sum(terms: &[f64]) -> Sum {
        let mut sum = Sum::default();
        terms.iter().for_each(|term| sum.add(*term));
        sum
    }

    /// Four cells of 2 m² whose gaps of 8 m in all close as the approach grows; then one node touches that adds 1/4 to
    /// `eᵀ C⁻¹ e`, and takes 1 off the closing rates.
    fn touched() -> Result<PathScalars, Error> {
        let problem = crate::test_chain::problem(&[0.0, 1.0, 2.0, 5.0])?;
        let mut scalars = PathScalars::new(&problem);
        scalars.renew_gap(sum(&[0.0, 1.0, 2.0, 5.0]), sum(&[1.0; 4]));
        scalars.touch([0.25, 1.0], 1);
        Ok(scalars)
    }

    /// Load and energy are integrals of the stiffness 2/4 and of the load, mean gap of the rate 3/4.
    #[test]
    fn scalars_follow_the_approach() -> Result<(), Error> {
        let mut scalars = touched()?;
        assert_eq!(scalars.state(0).mean_gap, 2.0);
        scalars.advance(2.0);
        let state = scalars.state(1);
        assert_eq!(
            (state.approach, state.load, state.energy, state.mean_gap),
            (2.0, 1.0, 1.0, 0.5)
        );
        assert_eq!(state.contact_stiffness, Some(0.5));
        assert_eq!(state.interfacial_stiffness, Some(0.5 / 0.75));
        scalars.advance(3.0);
        let state = scalars.state(1);
        // 1 + (1 + 1.5)/2.
        assert_eq!((state.load, state.energy, state.mean_gap), (1.5, 2.25, -0.25));
        scalars.clamp_mean_gap();
        assert_eq!(scalars.state(1).mean_gap, 0.0);
        // And back again.
        scalars.advance(2.0);
        assert_eq!((scalars.approach(), scalars.state(1).energy), (2.0, 1.0));
        // Full contact by identity; before it by arithmetic.
        for (nodes, closing) in [(3, true), (4, false)] {
            let mut scalars = touched()?;
            scalars.touch([0.25, 1.0], nodes);
            assert_eq!(scalars.closing > 0.0, closing);
            assert_eq!(scalars.state(nodes).mean_gap > 0.0, closing);
        }
        Ok(())
    }

    /// What a window lacks at its end comes in proportion to the way, of the energy to its square.
    #[test]
    fn windows_are_pinned_to_their_ends() -> Result<(), Error> {
        let start = touched()?;
        let mut walked = start;
        walked.advance(2.0);
        let mut end = walked;
        end.touch([0.125, 0.5], 2);
        (end.load, end.mean_gap, end.energy) = (1.5, 0.25, 3.0);
        let mut scalars = start;
        scalars.pin(&walked, &end, [0.5, 0.5, 0.0, 0.0]);
        // Half of 0.5 and of −0.25, a quarter of 2.
        assert_eq!((scalars.load, scalars.mean_gap, scalars.energy), (0.25, 1.875, 0.5));
        Ok(())
    }

    /// What plastic sums lack comes in parts, of 1 and of 2; and the energy falls by what the work grows.
    #[test]
    fn plastic_sums_are_pinned_to_their_ends() -> Result<(), Error> {
        let with = |depth: f64, energy: f64| -> Result<PathScalars, Error> {
            let plastic = PlasticScalars { nodes: 1, depth, work: 2.0 * depth, rates: [0.0; 2] };
            Ok(PathScalars { plastic: Some(plastic), energy, ..touched()? })
        };
        let mut scalars = with(2.5, 7.0)?;
        let area = scalars.grid.cell_area();
        scalars.pin(&with(3.0, 9.0)?, &with(4.0, 10.0)?, [0.0, 0.5, 0.5, 0.25]);
        assert_eq!(scalars.lengths(), [0.0, 3.0, 5.5]);
        // A quarter of 1 and of the work that is lacking, less a quarter of that.
        let energy = 7.0 + 0.25 * (1.0 + 2.0 * area) - 0.25 * 2.0 * area;
        assert!((scalars.energy - energy).abs() < 1e-15, "{scalars:?}");
        Ok(())
    }

    #[test]
    fn states_without_a_stiffness_are_none() -> Result<(), Error> {
        let mut scalars = touched()?;
        assert!(scalars.is_sound(&scalars.state(1)));
        for stiffness in [0.0, -1.0, f64::INFINITY, f64::NAN] {
            let state = scalars.state(1);
            scalars.unit_stiffness = stiffness;
            assert!(!scalars.is_sound(&state), "{stiffness}");
        }
        scalars = touched()?;
        scalars.load = f64::NAN;
        assert!(!scalars.is_sound(&scalars.state(1)));
        Ok(())
    }

    /// Nodes 0 and 2 carry 3/4 and 1/2 at the approach 3: W = 2 (3/4 + 1/2), and U = (3/4 · 3 + 1/2 · 2) 2/2; half a
    /// metre further an eighth more each.
    #[test]
    fn a_solution_renews_load_and_energy() -> Result<(), Error> {
        let mut run = test_chain::solved(&[0.0, 4.0, 1.0, 8.0], &[0, 2], 3.0)?;
        for (approach, load, energy) in [(3.0, 2.5, 3.25), (3.5, 3.0, 0.875 * 3.5 + 0.625 * 2.5)] {
            run.scalars.place_at(approach);
            run.scalars.renew_load(&run.problem, &run.contact, &run.field);
            let scalars = &run.scalars;
            for (found, expected) in
                [(scalars.load, load), (scalars.energy, energy), (scalars.unit_stiffness, 0.5)]
            {
                // Rounding errors of numbers up to 5.
                assert!((found - expected).abs() < 1e-14, "{found} {expected}");
            }
        }
        Ok(())
    }

    /// With a mean displacement of s W / ΔA the approach is that much more than that of the mean planes, and the energy
    /// half of it times W.
    #[test]
    fn states_are_free_of_the_gauge() -> Result<(), Error> {
        let grid = Grid::new(4, 4, 0.5, 0.5)?;
        let surface = HeightMap::new(nalgebra::DMatrix::from_fn(4, 4, |ix, iy| (ix * iy) as f64))?;
        let problem = Problem::new(&surface, &PeriodicBoussinesq::new(grid, 1.0)?)?;
        let per_load = problem.table().gauge().unwrap_or_default() / 0.25;
        assert!(per_load > 0.0);
        let mut scalars = PathScalars::new(&problem);
        scalars.touch([1.0, 1.0], 1);
        scalars.advance(8.0);
        // W = 8/4, U = 8.
        let state = scalars.state(1);
        let expected = [
            (state.approach, 8.0 - 2.0 * per_load),
            (state.energy, 8.0 - 2.0 * per_load),
            (scalars.own_approach(&state), 8.0),
            (scalars.uniform_displacement(3.0), 3.0 * per_load),
        ];
        for (found, expected) in expected {
            assert!((found - expected).abs() < 1e-13 * (8.0 + per_load), "{found} {expected}");
        }
        assert_eq!(state.contact_stiffness, None);
        // K = 1/4 N/m: of an approach 1 − s K / ΔA is that of the mean planes, and all of what a load is off by.
        let of_approach = (1.0 - 0.25 * per_load).abs() * 1e-3;
        for (load, expected) in [(0.0, of_approach), (2e-3, of_approach + 2e-3 * per_load)] {
            let found = scalars.reported_error(1e-3, load);
            assert!((found / expected - 1.0).abs() < 1e-13, "{found} {expected}");
        }
        let free = Problem::new(&surface, &Boussinesq::new(grid, 1.0)?)?;
        assert_eq!(PathScalars::new(&free).uniform_displacement(3.0), 0.0);
        assert_eq!(PathScalars::new(&free).reported_error(1e-3, 1.0), 1e-3);
        Ok(())
    }
}
