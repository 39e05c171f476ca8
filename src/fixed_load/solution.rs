//! The answer, and how exact it is.

use nalgebra::DMatrix;

/// Contact under one load: fields and scalars.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FixedLoadSolution {
    /// Scalars of the state.
    pub state: FixedLoadState,
    /// Pressure p ≥ 0 \[Pa\], nx × ny.
    pub pressure: DMatrix<f64>,
    /// Gap $g + u - \delta$ \[m\]: zero in contact but for the tolerance.
    pub gap: DMatrix<f64>,
    /// Displacement of the half-space u = C p \[m\], positive into it; about its mean if the
    /// half-space is periodic.
    pub displacement: DMatrix<f64>,
    /// Which nodes carry pressure.
    pub contact: DMatrix<bool>,
    /// Pressure per unit of load \[1/m²\], the exact derivative on further loading
    /// $\mathrm dp / \mathrm dW = y_2 / (\Delta A \sum y_2)$ with $y_2 = C_{II}^{-1} e$ on the
    /// contact set. Empty if stiffnesses were not asked for.
    pub pressure_rate: DMatrix<f64>,
    /// How well the conditions of contact are met.
    pub certificate: FixedLoadCertificate,
    /// Steps of conjugate gradients on the finest grid, for the pressure.
    pub iterations: usize,
    /// The same for the stiffness.
    pub stiffness_iterations: usize,
    /// Convolutions on the finest grid, all told.
    pub convolutions: usize,
    /// Convolutions on coarser grids, each counted as its part of the nodes of the finest.
    pub coarse_convolutions: f64,
}

/// Scalars of a state of contact, in the units of the input; SI is given here.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct FixedLoadState {
    /// Number of nodes that carry pressure.
    pub contact_nodes: usize,
    /// Normal approach δ from first touch \[m\]; of the mean planes if the half-space is periodic.
    pub approach: f64,
    /// Normal load $W = \Delta A \sum p$ \[N\].
    pub load: f64,
    /// Contact area \[m²\].
    pub contact_area: f64,
    /// Contact area over nominal area, between 0 and 1.
    pub contact_area_fraction: f64,
    /// Gap averaged over the nominal area \[m\].
    pub mean_gap: f64,
    /// Normal contact stiffness $K = dW/d\delta$ \[N/m\] with the approach of a distant point of the
    /// half-space; `None` if the half-space is periodic, which has none, or if it was not asked for.
    pub contact_stiffness: Option<f64>,
    /// Interfacial stiffness $K_i = -dW/d\bar g$ \[N/m\]: infinite in full contact, `None` if it was
    /// not asked for.
    pub interfacial_stiffness: Option<f64>,
    /// Elastic energy $U = \tfrac12 \Delta A \sum p\\, u$ \[J\].
    pub energy: f64,
    /// Greatest pressure \[Pa\].
    pub max_pressure: f64,
}

/// How well the conditions of contact, gap ≥ 0, p ≥ 0 and p · gap = 0, are met: computed afresh
/// from the pressure with one convolution, nothing carried over from the iteration.
///
/// All figures are relative and dimensionless: gaps to the approach, loads to the load. Pressures
/// are never negative. Zero would be exact.
///
/// Far beyond full contact of a periodic half-space, where the approach stays what it is and rounding
/// grows with the pressure, gaps are relative to C(0, 0) p̄ once that is larger.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct FixedLoadCertificate {
    /// $\sum p\\, |\text{gap}| / (\delta \sum p)$.
    pub complementarity: f64,
    /// Least gap where there is no pressure; infinite in full contact.
    pub least_gap: f64,
    /// Greatest absolute gap where there is pressure.
    pub greatest_contact_gap: f64,
    /// Difference between $\Delta A \sum p$ and the load asked for; zero if an approach was.
    pub load_error: f64,
}
