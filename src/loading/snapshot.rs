//! The solution at a state, and whether the state lies on the path.

use nalgebra::DMatrix;

use super::run::LoadingRun;
use super::state::LoadingState;
use crate::Error;
use crate::updater::{LinearUpdater, Solution};

/// How far a state of this path may be off, relative to its load, pressures and lengths, to be recognised.
const RECOGNISED: f64 = 1e-6;
/// The same where the approach of its event is an estimate: loads err by 1e-5 at worst.
const ESTIMATED: f64 = 1e-4;

/// The solution at a state.
pub(super) struct Snapshot {
    nodes: Vec<usize>,
    /// In the gauge of the kernel.
    approach: f64,
    /// dW/dδ for that approach.
    stiffness: f64,
    pub(super) pressure: DMatrix<f64>,
}

impl Snapshot {
    /// The solution at a state of this path.
    pub(super) fn of<U: LinearUpdater>(
        run: &mut LoadingRun<U>,
        state: &LoadingState,
    ) -> Result<Self, Error> {
        let mut solution = Solution::default();
        let approach = run.front.own_approach(state);
        let nodes = run.solve_at(state.step, approach, &mut solution)?;
        let grid = run.problem.grid();
        let (nx, ny) = grid.shape();
        let mut pressure = DMatrix::zeros(nx, ny);
        let values = pressure.as_mut_slice();
        for (&node, value) in nodes.iter().zip(&solution.pressure) {
            values[node] = *value;
        }
        Ok(Self {
            stiffness: grid.cell_area() * solution.rate.iter().sum::<f64>(),
            nodes,
            approach,
            pressure,
        })
    }

    /// `Ok` if the solution with the nodes and the approach of a state has its load, and pressures and gaps that
    /// a state has; the latter only if the path keeps the conditions of contact.
    pub(super) fn recognise<U: LinearUpdater>(
        &self,
        run: &mut LoadingRun<U>,
        state: &LoadingState,
        keeps_conditions: bool,
    ) -> Result<(), Error> {
        let refused = |quantity, value, expected| {
            Err(Error::NotOnPath {
                step: state.step,
                load: state.load,
                approach: state.approach,
                quantity,
                value,
                expected,
            })
        };
        let allowed = if state.approach_error > 0.0 {
            ESTIMATED
        } else {
            RECOGNISED
        };
        let cell_area = run.problem.grid().cell_area();
        let load = cell_area * self.pressure.iter().sum::<f64>();
        let scale = load.abs().max(self.stiffness * self.approach);
        // At first touch nothing is left but the rounding of lengths as long as the greatest gap.
        let rounding = f64::EPSILON * self.stiffness * run.problem.greatest_gap();
        // NaN is refused as well.
        let same_load = (load - state.load).abs() <= (allowed * scale).max(rounding);
        if !same_load || !state.approach.is_finite() {
            return refused("load", load, "the load of the state");
        }
        if !keeps_conditions {
            return Ok(());
        }
        let least = self.nodes.iter().map(|&node| self.pressure[node]);
        let least = least.fold(f64::INFINITY, f64::min);
        let rounding = rounding / cell_area;
        if least < -(allowed * self.pressure.max()).max(rounding) {
            return refused("least pressure in contact", least, "no tension");
        }
        let overlap = self.worst_overlap(run, state.step)?;
        let length = run.problem.greatest_gap() + self.approach.abs();
        if overlap < -allowed * length {
            return refused("least gap out of contact", overlap, "no overlap");
        }
        Ok(())
    }

    /// The gap of the node that touches next, which is the first to overlap; of all nodes out of contact if
    /// the next one is not known.
    fn worst_overlap<U: LinearUpdater>(
        &self,
        run: &mut LoadingRun<U>,
        step: usize,
    ) -> Result<f64, Error> {
        let gap = run.problem.initial_gap();
        if step < run.steps() {
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
        if self.nodes.len() == gap.len() {
            return Ok(0.0);
        }
        let mut in_contact = vec![false; gap.len()];
        for &node in &self.nodes {
            in_contact[node] = true;
        }
        let displacement = run.field.displace(self.pressure.as_slice())?;
        let gaps = gap.iter().zip(displacement).zip(&in_contact);
        let out = gaps.filter(|(_, in_contact)| !**in_contact);
        let least = out.map(|((g, u), _)| g + u - self.approach);
        Ok(least.fold(f64::INFINITY, f64::min))
    }
}
