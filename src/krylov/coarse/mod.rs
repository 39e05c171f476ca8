//! The bilinear coarse space: long waves of pressures and displacements of a contact.

mod aggregates;
mod bilinear;

use nalgebra::DMatrix;

use crate::kernel::KernelTable;
use crate::krylov::NodeSet;
use crate::krylov::single::product;
use crate::krylov::tuning::{FEWEST, MOST, RIDGES, ROWS, SPACING, SPARSE, STALE};
use crate::parallel::{for_each_chunk, vectorized};
use aggregates::{Aggregates, CoarseInfluence};
use bilinear::BilinearBasis;

/// The coarse space of a contact set I. With `W` the values of the hat functions at its nodes and `N` the sums of
/// its columns,
///
/// ```math
/// P = W N^{-1} W^T, \qquad Q = W N^{-1} E^{-1} N^{-1} W^T, \qquad
/// E \approx N^{-1} W^T C_{II} W N^{-1} .
/// ```
///
/// P takes means over hat functions: it is symmetric, keeps uniform fields, and has eigenvalues from 0 to 1.
#[derive(Debug, Clone)]
pub(super) struct CoarseSpace {
    basis: BilinearBasis,
    aggregates: Aggregates,
    /// 1 / C(0, 0).
    unit: f64,
    /// N, and 1 / N or zero where a hat function has no contact.
    masses: Vec<f64>,
    per_mass: Vec<f64>,
    /// E⁻¹ times C(0, 0), empty where there is none, and N when it was computed.
    inverse: Vec<f32>,
    inverse_masses: Vec<f64>,
    /// The contact that E was computed for.
    inverted: Vec<u32>,
    /// Means over hat functions, also in single precision, and what E⁻¹ makes of them.
    means: Vec<f64>,
    scaled: Vec<f32>,
    solved: Vec<f32>,
}

impl CoarseSpace {
    /// That of an empty contact; `None` if the grid has room for few hat functions only.
    pub(super) fn new(table: &KernelTable) -> Option<Self> {
        let grid = table.grid();
        let (lx, ly) = grid.sides();
        let length = (SPACING * grid.cell_area().sqrt()).max(lx.max(ly) / MOST);
        let along = |side: f64, nodes: usize| ((side / length).round() as usize).clamp(1, nodes);
        let counts = (along(lx, grid.nx()), along(ly, grid.ny()));
        if counts.0 * counts.1 < FEWEST {
            return None;
        }
        let wraps = table.boundary().repeats();
        Some(Self {
            basis: BilinearBasis::new(grid.shape(), counts, wraps),
            aggregates: Aggregates::new(table),
            unit: 1.0 / table.self_influence(),
            masses: Vec::new(),
            per_mass: Vec::new(),
            inverse: Vec::new(),
            inverse_masses: Vec::new(),
            inverted: Vec::new(),
            means: Vec::new(),
            scaled: Vec::new(),
            solved: Vec::new(),
        })
    }

    /// Whether the contact has enough nodes for long waves to matter.
    pub(super) fn is_useful(&self) -> bool {
        !self.inverse.is_empty()
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        let inverse = size_of_val(&self.inverse[..]) + size_of_val(&self.inverted[..]);
        self.basis.bytes() + self.aggregates.bytes() + inverse
    }

    /// Makes it that of another contact. N is exact; E is left alone until enough has changed.
    pub(super) fn update(&mut self, contact: &NodeSet) {
        if contact.len() < SPARSE * self.basis.len() {
            self.inverse.clear();
            self.inverse_masses.clear();
            self.inverted.clear();
            return;
        }
        self.basis.restrict(contact, &vec![1.0; contact.len()], &mut self.masses);
        let inverse = |&mass: &f64| if mass > 0.0 { 1.0 / mass } else { 0.0 };
        self.per_mass.clear();
        self.per_mass.extend(self.masses.iter().map(inverse));
        let masses = self.masses.iter().zip(&self.inverse_masses);
        let moved: f64 = masses.map(|(now, then)| (now - then).abs()).sum();
        if self.inverse_masses.is_empty() || moved > STALE * contact.len() as f64 {
            self.invert(contact);
        }
    }

    /// Computes E and its inverse.
    fn invert(&mut self, contact: &NodeSet) {
        let size = self.basis.len();
        let CoarseInfluence { half, masses } = self.aggregates.influence(&self.basis, contact);
        let mean = DMatrix::from_fn(size, size, |i, j| {
            let product = masses[i] * masses[j];
            if product > 0.0 {
                (half[i + size * j] + half[j + size * i]) / product
            } else if i == j {
                // A hat function of which no aggregate knows stands alone.
                1.0
            } else {
                0.0
            }
        });
        self.inverse.clear();
        for ridge in RIDGES {
            let mut matrix = mean.clone();
            for i in 0..size {
                matrix[(i, i)] *= ridge;
            }
            if let Some(factor) = matrix.cholesky() {
                let inverse = factor.inverse();
                self.inverse.extend(inverse.iter().map(|&value| value as f32));
                break;
            }
        }
        self.inverse_masses.clone_from(&self.masses);
        self.inverted.clear();
        self.inverted.extend_from_slice(contact.nodes());
    }

    /// The contact that E was computed for; empty where there is none.
    pub(super) fn inverted(&self) -> &[u32] {
        &self.inverted
    }

    /// Makes it that of a contact, and computes E for it whatever there was.
    pub(super) fn invert_anew(&mut self, contact: &NodeSet) {
        self.inverse.clear();
        self.inverse_masses.clear();
        self.inverted.clear();
        self.update(contact);
    }

    /// `rest = r − P r`.
    pub(super) fn project_out(&mut self, contact: &NodeSet, r: &[f64], rest: &mut Vec<f64>) {
        self.basis.restrict(contact, r, &mut self.means);
        for (mean, per_mass) in self.means.iter_mut().zip(&self.per_mass) {
            *mean *= -per_mass;
        }
        rest.clear();
        rest.extend_from_slice(r);
        self.basis.spread(contact, &self.means, rest);
    }

    /// `z ← z − P z + Q r`, with r what was last given to [`Self::project_out`].
    pub(super) fn complete(&mut self, contact: &NodeSet, z: &mut [f64]) {
        let scale = self.solve();
        self.basis.restrict(contact, z, &mut self.means);
        let hats = self.solved.iter().zip(&self.per_mass);
        for (mean, (solved, per_mass)) in self.means.iter_mut().zip(hats) {
            *mean = (scale * f64::from(*solved) - *mean) * per_mass;
        }
        self.basis.spread(contact, &self.means, z);
    }

    /// Applies E⁻¹ to minus the means. Returns what the result is in units of.
    fn solve(&mut self) -> f64 {
        let most = self.means.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        let scale = if most > 0.0 { most } else { 1.0 };
        self.scaled.clear();
        let scaled = self.means.iter().map(|mean| (-mean / scale) as f32);
        self.scaled.extend(scaled);
        self.solved.resize(self.scaled.len(), 0.0);
        let (inverse, scaled) = (&self.inverse, &self.scaled);
        for_each_chunk(&mut self.solved, ROWS, |chunk, solved| {
            let rows = inverse.chunks_exact(scaled.len()).skip(chunk * ROWS);
            vectorized(
                #[inline(always)]
                || {
                    for (solved, row) in solved.iter_mut().zip(rows) {
                        *solved = product(row, scaled);
                    }
                },
            );
        });
        scale * self.unit
    }
}

#[cfg(test)]
mod tests;
