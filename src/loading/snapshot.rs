//! The solution at a state, and whether the state lies on the path.

use super::tuning::{ESTIMATED, RECOGNISED, TOLERANCE};
use nalgebra::DMatrix;

use super::phase::Phase;
use super::run::LoadingRun;
use super::state::LoadingState;
use crate::Error;
use crate::contact::Certificate;
use crate::updater::Solution;

/// How far a state may be off to be recognised.
fn allowed(state: &LoadingState) -> f64 {
    if state.approach_error > 0.0 { ESTIMATED } else { RECOGNISED }
}

/// The quantity in which a state differs from the one of this path.
pub(super) fn not_on_path(
    state: &LoadingState,
    quantity: &'static str,
    value: f64,
    expected: &'static str,
) -> Error {
    Error::NotOnPath {
        step: state.step,
        load: state.contact.load,
        approach: state.contact.approach,
        quantity,
        value,
        expected,
    }
}

/// The solution at a state.
pub(super) struct Snapshot {
    /// Nodes in contact that have not yielded.
    nodes: Vec<usize>,
    yielded: Vec<usize>,
    /// In the gauge of the kernel.
    approach: f64,
    /// dW/dδ for that approach.
    stiffness: f64,
    pub(super) pressure: DMatrix<f64>,
}

impl Snapshot {
    /// The solution at a state of this path.
    pub(super) fn of(
        run: &LoadingRun,
        phase: &mut Phase,
        state: &LoadingState,
    ) -> Result<Self, Error> {
        let mut solution = Solution::default();
        let approach = run.scalars.own_approach(&state.contact);
        let nodes = phase.solve_at(run, (state.step, approach), &mut solution)?;
        let grid = run.problem.grid();
        let (nx, ny) = grid.shape();
        let mut pressure = DMatrix::zeros(nx, ny);
        let values = pressure.as_mut_slice();
        for (&node, value) in nodes.iter().zip(&solution.pressure) {
            values[node] = *value;
        }
        let yielded: Vec<usize> = run.releases.yielded_at(state.step).collect();
        if let Some(plastic) = &run.plastic {
            for &node in &yielded {
                values[node] = plastic.hardness().values()[node];
            }
        }
        Ok(Self {
            yielded,
            stiffness: grid.cell_area() * solution.rate.iter().sum::<f64>(),
            nodes,
            approach,
            pressure,
        })
    }

    /// `Ok` if the solution with the nodes and the approach of a state has its load, and pressures and gaps that
    /// a state has.
    pub(super) fn recognise(
        &self,
        run: &mut LoadingRun,
        phase: &Phase,
        state: &LoadingState,
    ) -> Result<(), Error> {
        let refused =
            |quantity, value, expected| Err(not_on_path(state, quantity, value, expected));
        let allowed = allowed(state);
        let cell_area = run.problem.grid().cell_area();
        let load = cell_area * self.pressure.iter().sum::<f64>();
        let scale = load.abs().max(self.stiffness * self.approach);
        // At first touch, and where nodes have yielded under hardly any load, the gaps to which contact is closed are
        // all that counts.
        let rounding = self.rounding(run);
        // NaN is refused as well.
        let same_load = (load - state.contact.load).abs() <= (allowed * scale).max(rounding);
        if !same_load || !state.contact.approach.is_finite() {
            return refused("load", load, "the load of the state");
        }
        self.check_tension(run, phase.tolerance(), state)?;
        self.check_excess(run, phase.tolerance(), state)?;
        let least_gap = self.least_gap_outside(run, state.step)?;
        if least_gap < -self.allowed_gap(run, state) {
            return refused("least gap out of contact", least_gap, "no overlap");
        }
        Ok(())
    }

    /// `Ok` if no node is pulled by more than pressures of a state may be off, with solutions of a tolerance.
    ///
    /// # Errors
    ///
    /// [`Error::NotOnPath`] for more tension than that.
    pub(super) fn check_tension(
        &self,
        run: &LoadingRun,
        tolerance: f64,
        state: &LoadingState,
    ) -> Result<(), Error> {
        let least = self.nodes.iter().map(|&node| self.pressure[node]);
        let least = least.fold(f64::INFINITY, f64::min);
        if least < -self.allowed_pressure(run, tolerance, state) {
            return Err(not_on_path(state, "least pressure in contact", least, "no tension"));
        }
        Ok(())
    }

    /// The same for pressures above the hardness of their nodes.
    fn check_excess(
        &self,
        run: &LoadingRun,
        tolerance: f64,
        state: &LoadingState,
    ) -> Result<(), Error> {
        let Some(plastic) = &run.plastic else { return Ok(()) };
        let hardness = plastic.hardness().values();
        let excess = self.nodes.iter().map(|&node| self.pressure[node] - hardness[node]);
        let greatest = excess.fold(f64::NEG_INFINITY, f64::max);
        if greatest > self.allowed_pressure(run, tolerance, state) {
            return Err(not_on_path(
                state,
                "greatest pressure above the hardness",
                greatest,
                "none",
            ));
        }
        Ok(())
    }

    /// How far pressures of a state may be off, with solutions of a tolerance.
    fn allowed_pressure(&self, run: &LoadingRun, tolerance: f64, state: &LoadingState) -> f64 {
        (allowed(state) * self.pressure.max())
            .max(self.rounding(run) / run.problem.grid().cell_area())
            .max(self.pressure_error(run, tolerance))
    }

    /// The load that goes with the gaps to which contact is closed, by the stiffness.
    fn rounding(&self, run: &LoadingRun) -> f64 {
        TOLERANCE * self.stiffness * self.lengths(run)
    }

    /// `Ok` if the gaps that a certificate of the state was made of are closed in contact, and not negative elsewhere:
    /// [`recognise`](Self::recognise) looks at the node that touches next alone.
    pub(super) fn check_gaps(
        &self,
        run: &LoadingRun,
        state: &LoadingState,
        certificate: &Certificate,
    ) -> Result<(), Error> {
        let allowed = self.allowed_gap(run, state);
        let [left, least] = [certificate.greatest_contact_gap, certificate.least_gap]
            .map(|gap| gap * certificate.length);
        // NaN is refused as well.
        let is_closed = left <= allowed;
        let is_clear = least >= -allowed;
        if !is_closed {
            let quantity = "greatest gap in contact";
            return Err(not_on_path(state, quantity, left, "no gap"));
        }
        if !is_clear {
            let quantity = "least gap out of contact";
            return Err(not_on_path(state, quantity, least, "no overlap"));
        }
        Ok(())
    }

    /// What cancels in a gap: the greatest initial one, the approach, and displacements under nodes that have yielded.
    fn lengths(&self, run: &LoadingRun) -> f64 {
        let yielded: f64 = self.yielded.iter().map(|&node| self.pressure[node]).sum();
        let displaced = run.problem.table().self_influence() * yielded;
        run.problem.greatest_gap() + self.approach.abs() + displaced
    }

    /// Greatest error of gaps at a state.
    fn allowed_gap(&self, run: &LoadingRun, state: &LoadingState) -> f64 {
        allowed(state) * (run.problem.greatest_gap() + self.approach.abs())
    }

    /// Greatest error of pressures where gaps in contact are closed to a tolerance τ of the approach only: `|C⁻¹r| ≤ √n
    /// τ δ / λ`, with the least eigenvalue λ. On long cells in a large gauge that is far more than τ of the pressure. 0
    /// with a factor, and where λ is not known.
    fn pressure_error(&self, run: &LoadingRun, tolerance: f64) -> f64 {
        let least = run.field.least_eigenvalue();
        if tolerance == 0.0 || least <= 0.0 {
            return 0.0;
        }
        let length = self.approach.max(run.problem.least_length());
        (self.nodes.len() as f64).sqrt() * tolerance * length / least
    }

    /// The gap of the node that touches next, which is the first to overlap; the least gap of all nodes out of contact
    /// if the next one is not known. Below zero it is an overlap.
    fn least_gap_outside(&self, run: &mut LoadingRun, step: usize) -> Result<f64, Error> {
        if step < run.steps() && run.plastic.is_none() {
            let gap = run.problem.initial_gap();
            let next = run.releases.contact_at(run.contact.order(), step + 1);
            let Some(&node) = next.last().filter(|_| next.len() > self.nodes.len()) else {
                // One that leaves: its pressure has been looked at.
                return Ok(0.0);
            };
            let table = run.problem.table();
            let place = table.place(node);
            let terms = self.nodes.iter();
            let terms =
                terms.map(|&other| table.between(place, table.place(other)) * self.pressure[other]);
            return Ok(gap[node] + terms.sum::<f64>() - self.approach);
        }
        let all = self.pressure.len();
        if self.nodes.len() + self.yielded.len() == all {
            return Ok(0.0);
        }
        let mut in_contact = vec![false; all];
        for &node in self.nodes.iter().chain(&self.yielded) {
            in_contact[node] = true;
        }
        let displacement = run.field.displace(self.pressure.as_slice())?;
        let gap = match &run.plastic {
            Some(plastic) => plastic.surface().initial_gap(),
            None => run.problem.initial_gap(),
        };
        let gaps = gap.iter().zip(displacement).zip(&in_contact);
        let out = gaps.filter(|(_, in_contact)| !**in_contact);
        let least = out.map(|((g, u), _)| g + u - self.approach);
        Ok(least.fold(f64::INFINITY, f64::min))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::ContactState;
    use crate::loading::state::ContactEvent;
    use crate::loading::test_chain;
    use crate::updater::Dense;

    /// A snapshot of nodes in a row with these pressures, and whether it is that of a state under `load`; `contact` is
    /// what the path has got to, which is at the first of its events or at the last.
    struct Case<'a> {
        gaps: &'a [f64],
        contact: &'a [usize],
        step: usize,
        pressures: &'a [(usize, f64)],
        approach: f64,
        stiffness: f64,
        load: f64,
        error: f64,
    }

    impl Case<'_> {
        /// What it is refused for.
        fn refused(&self) -> Result<Option<&'static str>, Error> {
            self.refused_with(Phase::new(Dense, None))
        }

        fn refused_with(&self, phase: Phase) -> Result<Option<&'static str>, Error> {
            let mut run = test_chain::run(self.gaps)?;
            for &node in self.contact {
                run.contact.push(node)?;
            }
            let mut pressure = DMatrix::zeros(self.gaps.len(), 1);
            for &(node, value) in self.pressures {
                pressure[node] = value;
            }
            let snapshot = Snapshot {
                nodes: self.pressures.iter().map(|(node, _)| *node).collect(),
                yielded: Vec::new(),
                approach: self.approach,
                stiffness: self.stiffness,
                pressure,
            };
            let grid = run.problem.grid();
            let contact =
                ContactState::new(&grid, self.pressures.len(), self.approach, self.load, 0.0);
            let mut state = LoadingState::new(self.step, ContactEvent::Touch, (0, 0), contact);
            state.approach_error = self.error;
            match snapshot.recognise(&mut run, &phase, &state) {
                Err(Error::NotOnPath { quantity, .. }) => Ok(Some(quantity)),
                done => done.map(|()| None),
            }
        }
    }

    /// Node 0 carries 1 at the approach 4, which is a load of 2 on its cell; no other node is near.
    const ALONE: Case<'_> = Case {
        gaps: &[0.0, 8.0, 8.0],
        contact: &[0],
        step: 1,
        pressures: &[(0, 1.0)],
        approach: 4.0,
        stiffness: 0.5,
        load: 2.0,
        error: 0.0,
    };

    #[test]
    fn loads_are_compared() -> Result<(), Error> {
        for (error, stiffness, off, refused) in [
            // A millionth of the load of 2, or of the stiffness times the approach if that is more.
            (0.0, 0.5, 1.9e-6, false),
            (0.0, 0.5, -1.9e-6, false),
            (0.0, 0.5, 2.1e-6, true),
            (0.0, 0.5, -2.1e-6, true),
            (0.0, 1.0, 3.9e-6, false),
            (0.0, 1.0, 4.1e-6, true),
            // A hundred times as much where the approach is an estimate.
            (1e-12, 0.5, 1.9e-4, false),
            (1e-12, 0.5, 2.1e-4, true),
            (0.0, 0.5, f64::NAN, true),
        ] {
            let case = Case { load: 2.0 + off, stiffness, error, ..ALONE };
            assert_eq!(case.refused()?, refused.then_some("load"), "{off}");
        }
        // At first touch half of what 8 m are closed to, 10⁻¹⁰ of them.
        for (load, refused) in [(3.9e-10, false), (-3.9e-10, false), (4.1e-10, true)] {
            let case = Case { pressures: &[(0, 0.0)], approach: 0.0, load, ..ALONE };
            assert_eq!(case.refused()?, refused.then_some("load"), "{load}");
        }
        Ok(())
    }

    /// Node 2 has just touched, and is pulled a little.
    fn pulled(pressures: &[(usize, f64); 2]) -> Case<'_> {
        Case {
            gaps: &[0.0, 8.0, 4.0],
            contact: &[0, 2],
            step: 2,
            pressures,
            load: 2.0 * (pressures[0].1 + pressures[1].1),
            ..ALONE
        }
    }

    #[test]
    fn tension_is_refused() -> Result<(), Error> {
        let refused = Some("least pressure in contact");
        // A hundred times as much where the approach is an estimate.
        for (least, error, refused) in
            [(0.9e-6, 0.0, None), (1.1e-6, 0.0, refused), (1.1e-6, 1e-12, None)]
        {
            let pressures = [(0, 1.0), (2, -least)];
            let case = Case { error, ..pulled(&pressures) };
            assert_eq!(case.refused()?, refused, "{least:e}");
        }
        // At first touch what the load may be off by, 4·10⁻¹⁰, over the cell area.
        for (least, refused) in [(1.9e-10, None), (2.1e-10, refused)] {
            let case = Case {
                gaps: &[0.0, 8.0, 0.0],
                contact: &[0, 2],
                step: 2,
                pressures: &[(0, least), (2, -least)],
                approach: 0.0,
                load: 0.0,
                ..ALONE
            };
            assert_eq!(case.refused()?, refused, "{least}");
        }
        Ok(())
    }

    /// Gaps that are closed to a thousandth of the approach of 4 leave √2 · 4e-3 / 2 of the pressures of two nodes
    /// open: waves from node to node have the least symbol, 4 − 2.
    #[test]
    fn tension_that_iterations_leave_is_none() -> Result<(), Error> {
        let refused = Some("least pressure in contact");
        for (least, refused) in [(2.8e-3, None), (2.9e-3, refused)] {
            let pressures = [(0, 1.0), (2, -least)];
            let case = pulled(&pressures);
            let found =
                case.refused_with(Phase::Iterations(Box::new(test_chain::Altered::inexact(1e-3))))?;
            assert_eq!(found, refused, "{least:e}");
        }
        Ok(())
    }

    /// The neighbour of node 0 sinks by 1, and may overlap by a millionth of 8 + 4.
    #[test]
    fn overlap_is_refused() -> Result<(), Error> {
        for (overlap, refused) in [(11e-6, None), (13e-6, Some("least gap out of contact"))] {
            let neighbour = 3.0 - overlap;
            // At the last state that of all nodes counts, at earlier ones that of the node that touches next alone.
            for (contact, far, refused) in
                [(&[0][..], 8.0, refused), (&[0, 1], 8.0, refused), (&[0, 2], 8.0, None)]
            {
                let case = Case { gaps: &[0.0, neighbour, far], contact, ..ALONE };
                assert_eq!(case.refused()?, refused, "{overlap:e} {contact:?}");
            }
            // With no node out of contact there is no overlap: a fifth of 5 each.
            let full = Case {
                gaps: &[0.0, 0.0],
                contact: &[0, 1],
                step: 2,
                pressures: &[(0, 1.0), (1, 1.0)],
                approach: 5.0,
                load: 4.0,
                ..ALONE
            };
            assert_eq!(full.refused()?, None);
        }
        Ok(())
    }

    /// Pressures by node, the approach, and the stiffness 2 · (1/4 + 1/4).
    #[test]
    fn snapshots_are_solutions() -> Result<(), Error> {
        let run = test_chain::solved(&[0.0, 4.0, 1.0, 8.0], &[0, 2], 3.0)?;
        let contact = ContactState::new(&run.problem.grid(), 2, 3.0, 2.5, 0.0);
        let state = LoadingState::new(2, ContactEvent::Touch, (2, 0), contact);
        let found = Snapshot::of(&run, &mut Phase::new(Dense, None), &state)?;
        assert_eq!((&found.nodes[..], found.approach), (&[0, 2][..], 3.0));
        for (found, expected) in found.pressure.iter().zip([0.75, 0.0, 0.5, 0.0]) {
            assert!((found - expected).abs() < 1e-15);
        }
        assert!((found.stiffness - 1.0).abs() < 1e-15);
        Ok(())
    }
}
