//! Exact stiffnesses: the change with a little more load.

use std::borrow::Cow;

use nalgebra::DMatrix;

use super::level::Level;
use super::settings::Settings;
use super::solution::FixedLoadSolution;
use crate::Error;
use crate::kernel::Gauge;
use crate::krylov::{Directions, Equation, Field, LinearSystem, NodeSet, sum_over};
use crate::parallel::inside;

/// The pressure per unit of approach, y₂, and its displacement, both on the whole grid and in the gauge
/// of the level: in the zero gauge full contact is singular. Empty where they are not known.
#[derive(Debug, Clone, Default)]
pub(super) struct Tangent {
    pub(super) rate: Vec<f64>,
    pub(super) displacement: Vec<f64>,
    /// What displacements may be off by: see [`Field`].
    pub(super) drift: f64,
}

/// The result of solving for a tangent.
struct Solved {
    iterations: usize,
    /// `eᵀ C_II⁻¹ e`.
    unit_unit: f64,
}

impl Tangent {
    pub(super) fn is_known(&self) -> bool {
        !self.rate.is_empty()
    }

    /// That of a solution, which costs a convolution; unknown if it has no stiffnesses.
    pub(super) fn of(level: &mut Level, solution: &FixedLoadSolution) -> Result<Self, Error> {
        let state = &solution.contact;
        // On a plateau there is none.
        let has_rate = !state.is_plateau() && !solution.pressure_rate.is_empty();
        let Some(rate) = state.load_rate().filter(|rate| has_rate && *rate > 0.0) else {
            return Ok(Self::default());
        };
        // 1 / K = 1 / K of the mean planes + s / ΔA in the gauge s.
        let gauge = Gauge::new(level.gauge, level.grid.cell_area());
        let stiffness = state.contact_stiffness.unwrap_or_else(|| gauge.stiffness(rate));
        let rates = solution.pressure_rate.iter();
        let rate: Vec<f64> = rates.map(|rate| stiffness * rate).collect();
        let displacement =
            level.in_gauge(|level| Ok(level.operator.apply_field(&rate)?.to_vec()))?;
        Ok(Self { rate, displacement, drift: 0.0 })
    }

    /// Becomes the tangent of `solution`, and adds stiffnesses and pressure rate to it.
    ///
    /// # Errors
    ///
    /// [`Error::NoConvergence`], [`Error::FactorizationFailed`] if the kernel is not positive definite,
    /// [`Error::MemoryBudget`], and [`Error::NotPositive`] if no node is in contact.
    pub(super) fn complete(
        &mut self,
        level: &mut Level,
        settings: &Settings,
        solution: &mut FixedLoadSolution,
    ) -> Result<(), Error> {
        let in_contact = solution.fields.contact_map.as_slice();
        require_contact(in_contact)?;
        level.choose_contact(|node, _, _| solution.is_elastic(node))?;
        if level.iterate.contact.len() == 0 {
            // All that is in contact yields: the load stays what it is.
            *self = Self::default();
            let (nx, ny) = level.grid.shape();
            solution.pressure_rate = DMatrix::zeros(nx, ny);
            solution.contact.contact_stiffness = level.gauge.is_none().then_some(0.0);
            let is_full = in_contact.iter().all(|in_contact| *in_contact);
            let interfacial = if is_full { f64::INFINITY } else { 0.0 };
            solution.contact.interfacial_stiffness = Some(interfacial);
            return Ok(());
        }
        let solved = inside(|| level.in_gauge(|level| self.solve(level, settings)))?;
        let nodes = level.grid.nodes();
        let displacement = &self.displacement;
        let [stiffness, interfacial] = self.stiffnesses(level, &solved, in_contact);
        let (nx, ny) = level.grid.shape();
        let rates = self.rate.iter().map(|rate| rate / stiffness);
        solution.pressure_rate = DMatrix::from_iterator(nx, ny, rates);
        solution.contact.contact_stiffness = match level.gauge {
            None => Some(stiffness),
            Some(_) => None,
        };
        solution.contact.interfacial_stiffness = Some(interfacial);
        if let Some(state) = &mut solution.contact.plastic {
            let yielded = solution.fields.yielded_map.as_slice();
            let sinks = |node: usize| if yielded[node] { 1.0 - displacement[node] } else { 0.0 };
            let pressure = solution.fields.pressure.as_slice();
            state.volume_per_load = sum_over(nodes, sinks) / solved.unit_unit;
            state.work_per_load =
                sum_over(nodes, |node| pressure[node] * sinks(node)) / solved.unit_unit;
        }
        solution.effort.stiffness_iterations = solved.iterations;
        solution.effort.convolutions += level.operator.take_convolutions();
        Ok(())
    }

    /// Adds the stiffnesses of all nodes in contact, on unloading, to a solution with a hardness.
    ///
    /// # Errors
    ///
    /// Those of [`Self::complete`].
    pub(super) fn add_unloading(
        &mut self,
        level: &mut Level,
        settings: &Settings,
        solution: &mut FixedLoadSolution,
    ) -> Result<(), Error> {
        let in_contact = solution.fields.contact_map.as_slice();
        require_contact(in_contact)?;
        let Some(plastic) = &mut solution.contact.plastic else {
            return Ok(());
        };
        level.choose_contact(|node, _, _| in_contact[node])?;
        let solved = inside(|| level.in_gauge(|level| self.solve(level, settings)))?;
        let [stiffness, interfacial] = self.stiffnesses(level, &solved, in_contact);
        plastic.contact_unloading_stiffness = level.gauge.is_none().then_some(stiffness);
        plastic.interfacial_unloading_stiffness = Some(interfacial);
        solution.effort.stiffness_iterations += solved.iterations;
        solution.effort.convolutions += level.operator.take_convolutions();
        Ok(())
    }

    /// dW/dδ in the gauge of the level, and −dW/dḡ.
    fn stiffnesses(&self, level: &Level, solved: &Solved, in_contact: &[bool]) -> [f64; 2] {
        let (nodes, displacement) = (level.grid.nodes(), &self.displacement);
        // Nodes in contact are left out: then full contact is exact.
        let closing =
            sum_over(nodes, |node| if in_contact[node] { 0.0 } else { 1.0 - displacement[node] });
        let stiffness = level.grid.cell_area() * solved.unit_unit;
        [stiffness, stiffness / (closing / nodes as f64)]
    }

    /// Solves `C_II y₂ = e` on the contact set, from the tangent of another one if it is known.
    fn solve(&mut self, level: &mut Level, settings: &Settings) -> Result<Solved, Error> {
        let contact = &level.iterate.contact;
        // Nodes that have left take their displacements with them.
        let places = contact.places();
        let mut rates = self.rate.iter().zip(places);
        let lost = rates.any(|(rate, place)| *rate != 0.0 && *place == NodeSet::NONE);
        let known = std::mem::take(self);
        let (mut y, mut base) = (Vec::new(), Field::default());
        if known.is_known() {
            contact.gather(&known.rate, &mut y);
            if !lost {
                base = Field {
                    pressure: known.rate,
                    displacement: known.displacement,
                    drift: known.drift,
                };
            }
        } else {
            let ones = vec![1.0; contact.len()];
            level.preconditioner.apply(&ones, &mut y);
        }
        let mut start = vec![0.0; level.gap.len()];
        contact.scatter(&y, &mut start);
        let equation = Equation {
            rhs: |_| 1.0,
            tolerance: settings.tolerance,
            most_drift: f64::INFINITY,
            max_iterations: settings.max_iterations,
        };
        let mut system = LinearSystem {
            operator: &mut level.operator,
            preconditioner: &mut level.preconditioner,
            contact,
        };
        let (solved, iterations) =
            system.solve(&equation, start, Cow::Owned(base), &mut Directions::default())?;
        let nodes = contact.nodes();
        let left = |i: usize| {
            let node = nodes[i] as usize;
            solved.pressure[node] * (2.0 - solved.displacement[node])
        };
        // With the residual r, eᵀ C⁻¹ e = eᵀ y + yᵀ r up to the square of the error.
        let unit_unit = sum_over(nodes.len(), left);
        let Field { pressure, displacement, drift } = solved;
        *self = Self { rate: pressure, displacement, drift };
        Ok(Solved { iterations, unit_unit })
    }
}

/// `Ok` if a node is in contact.
fn require_contact(in_contact: &[bool]) -> Result<(), Error> {
    let count = in_contact.iter().filter(|is_in| **is_in).count();
    Error::require_positive("number of nodes in contact", count as f64)?;
    Ok(())
}
