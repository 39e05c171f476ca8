//! What a state has to be, from the influence matrix alone.

use asperity::{Boundary, InfluenceKernel, MeanDisplacement};
use asperity_testing::dense::{influence_matrix, initial_gap, restrict};
use nalgebra::{DMatrix, DVector};

use super::rows::Row;

/// The problem of a row.
pub(super) struct Dense {
    pub(super) matrix: DMatrix<f64>,
    gaps: Vec<f64>,
    /// Of each node, infinite without one.
    hardness: Vec<f64>,
    cell_area: f64,
    /// Whether displacements are counted from their mean.
    pub(super) about_mean: bool,
}

/// The scalars of a pressure.
pub(super) struct Scalars {
    pub(super) load: f64,
    /// `None` where no node in contact is elastic.
    pub(super) approach: Option<f64>,
    pub(super) mean_gap: f64,
    pub(super) energy: f64,
    /// Gaps, of those that have yielded 0.
    pub(super) gap: DVector<f64>,
    /// Overlap of nodes that have yielded.
    pub(super) depth: DVector<f64>,
}

impl Dense {
    pub(super) fn of(row: &Row) -> Self {
        let kernel = &*row.kernel;
        let nodes = kernel.grid().nodes();
        Self {
            matrix: influence_matrix(kernel),
            gaps: initial_gap(row.surface.matrix()),
            hardness: row
                .hardness
                .as_ref()
                .map_or(vec![f64::INFINITY; nodes], |map| map.iter().copied().collect()),
            cell_area: kernel.grid().cell_area(),
            about_mean: is_about_mean(kernel),
        }
    }

    /// The same without a hardness, and of other gaps.
    pub(super) fn elastic(mut self, gaps: Vec<f64>) -> Self {
        self.hardness.fill(f64::INFINITY);
        self.gaps = gaps;
        self
    }

    /// A pressure that fulfils all conditions of contact is the only one under its load: contact is a convex problem.
    /// Asserts them within a part of the greatest displacement, and gives the scalars. `approach` is that of a state at
    /// which no node is elastic.
    pub(super) fn scalars(
        &self,
        pressure: &[f64],
        approach: f64,
        tolerance: f64,
        context: &str,
    ) -> Scalars {
        let pressure = DVector::from_column_slice(pressure);
        let mut u = &self.matrix * &pressure;
        let nodes = u.len() as f64;
        let greatest = u.amax();
        if self.about_mean {
            u.add_scalar_mut(-u.mean());
        }
        let total: Vec<f64> = self.gaps.iter().zip(&u).map(|(gap, u)| gap + u).collect();
        let is_elastic = |node: usize| pressure[node] > 0.0 && pressure[node] < self.hardness[node];
        let elastic: Vec<usize> = (0..u.len()).filter(|&node| is_elastic(node)).collect();
        let mean = elastic.iter().map(|&node| total[node]).sum::<f64>() / elastic.len() as f64;
        let level = if elastic.is_empty() { approach } else { mean };
        let scale = tolerance * (greatest + level.abs());
        let (mut gap, mut depth) = (DVector::zeros(u.len()), DVector::zeros(u.len()));
        for node in 0..u.len() {
            let (p, most, open) = (pressure[node], self.hardness[node], total[node] - level);
            let context = format!("{context}, node {node}: pressure {p:e}, gap {open:e}");
            assert!((0.0..=most).contains(&p), "{context}");
            assert!(p > 0.0 || open > -scale, "{context}");
            assert!(p == 0.0 || open < scale, "{context}");
            assert!(!is_elastic(node) || open.abs() < scale, "{context}");
            if p < most {
                gap[node] = open.max(0.0);
            } else {
                depth[node] = (-open).max(0.0);
            }
        }
        Scalars {
            load: self.cell_area * pressure.sum(),
            approach: (!elastic.is_empty()).then_some(level),
            mean_gap: gap.sum() / nodes,
            energy: 0.5 * self.cell_area * pressure.dot(&u),
            gap,
            depth,
        }
    }

    /// dW/dδ and −dW/d(mean gap) of a contact: the first is `None` without a distant point.
    pub(super) fn stiffness(&self, contact: &DMatrix<bool>) -> [Option<f64>; 2] {
        let nodes: Vec<usize> = (0..self.gaps.len()).filter(|&k| contact.as_slice()[k]).collect();
        let ones = DVector::from_element(nodes.len(), 1.0);
        let rate = restrict(&self.matrix, &nodes).lu().solve(&ones).unwrap();
        let mut all = DVector::zeros(self.gaps.len());
        for (&node, rate) in nodes.iter().zip(&rate) {
            all[node] = *rate;
        }
        let sinks = &self.matrix * &all;
        let closing =
            (0..all.len()).map(|k| if contact.as_slice()[k] { 0.0 } else { 1.0 - sinks[k] });
        let closing = closing.sum::<f64>() / self.gaps.len() as f64;
        let stiffness = self.cell_area * rate.sum();
        let is_full = nodes.len() == self.gaps.len();
        let interfacial = if is_full { f64::INFINITY } else { stiffness / closing };
        [(!self.about_mean).then_some(stiffness), Some(interfacial)]
    }
}

/// Whether the mean displacement of a body is a matter of choice.
fn is_about_mean(kernel: &dyn InfluenceKernel) -> bool {
    kernel.boundary() == Boundary::Periodic
        && kernel.mean_displacement() == MeanDisplacement::Arbitrary
}

/// Asserts that numbers agree to a part of a scale.
#[track_caller]
pub(super) fn near(found: f64, expected: f64, allowed: f64, context: &str) {
    assert!(
        found == expected || (found - expected).abs() <= allowed,
        "{context}: {found:e} for {expected:e}, off by {:e} of {allowed:e}",
        (found - expected).abs()
    );
}
