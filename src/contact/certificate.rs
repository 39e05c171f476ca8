//! How exact a state is.

use super::ContactState;
use crate::{Boundary, Problem};

/// How well a state fulfils the conditions of contact, `gap ≥ 0`, `p ≥ 0` and `p · gap = 0`, computed
/// afresh from its pressure with one convolution.
///
/// All figures are dimensionless: pressures relative to the mean pressure on the contact, loads to the
/// load, gaps to [`length`](Self::length). Zero would be exact.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Certificate {
    /// Least pressure in contact: zero at a node that just touches, negative by rounding.
    pub least_pressure: f64,
    /// Least gap out of contact; infinite in full contact.
    pub least_gap: f64,
    /// Greatest absolute gap in contact.
    pub greatest_contact_gap: f64,
    /// `Σ p |gap| / Σ p`.
    pub complementarity: f64,
    /// Difference between `ΔA Σ p` and the load.
    pub load_error: f64,
    /// What gaps are relative to \[m\]: the greatest of the rms height Sq, the approach δ and, on a
    /// periodic half-space, `C(0, 0) p̄`, since far beyond full contact rounding grows with the pressure
    /// while the approach stays what it is.
    pub length: f64,
}

/// What a certificate needs to know beside the fields.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Conditions {
    /// Sum of pressures that belongs to the load.
    pub(crate) sum: f64,
    /// See [`Certificate::length`].
    pub(crate) length: f64,
}

impl Conditions {
    /// For a state of a problem; `None` before first touch.
    pub(crate) fn of(problem: &Problem, state: Option<&ContactState>) -> Self {
        let grid = problem.grid();
        let (load, approach) = state.map_or((0.0, 0.0), |state| (state.load, state.approach));
        let pressed = match problem.boundary() {
            Boundary::Free => 0.0,
            Boundary::Periodic => problem.table().self_influence() * load / grid.nominal_area(),
        };
        Self {
            sum: load / grid.cell_area(),
            length: problem.rms_height().max(approach).max(pressed),
        }
    }

    /// From (pressure, gap, in contact) of every node.
    pub(crate) fn check(self, nodes: impl Iterator<Item = (f64, f64, bool)>) -> Certificate {
        let (mut count, mut sum, mut work) = (0_usize, 0.0, 0.0);
        let (mut least_pressure, mut least_gap) = (f64::INFINITY, f64::INFINITY);
        let mut contact_gap = 0.0_f64;
        for (pressure, gap, in_contact) in nodes {
            if in_contact {
                count += 1;
                sum += pressure;
                work += pressure * gap.abs();
                least_pressure = least_pressure.min(pressure);
                contact_gap = contact_gap.max(gap.abs());
            } else {
                least_gap = least_gap.min(gap);
            }
        }
        if count == 0 {
            least_pressure = 0.0;
        }
        let length = if self.length > 0.0 { self.length } else { 1.0 };
        Certificate {
            least_pressure: relative(least_pressure, relative(sum, count as f64)),
            least_gap: least_gap / length,
            greatest_contact_gap: contact_gap / length,
            complementarity: relative(work, sum * length),
            load_error: relative(sum - self.sum, self.sum),
            length,
        }
    }
}

/// value / scale, zero for nothing out of nothing.
fn relative(value: f64, scale: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value / scale }
}
