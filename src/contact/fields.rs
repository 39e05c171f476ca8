//! Fields of a contact.

use nalgebra::DMatrix;

/// Fields of a contact, nx × ny: at a state of a path ([`LoadingPath::fields`](crate::LoadingPath::fields)), or under
/// one load ([`FixedLoadSolution::fields`](crate::FixedLoadSolution::fields)).
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ContactFields {
    /// Pressure `p ≥ 0` \[Pa\].
    pub pressure: DMatrix<f64>,
    /// Gap `g + u − δ` \[m\]: zero in contact, to rounding or to the tolerance of a solution, and zero where nodes have
    /// yielded.
    pub gap: DMatrix<f64>,
    /// Displacement of the half-space `u = C p` \[m\], positive into it; about its mean if the
    /// half-space is periodic and its mean displacement arbitrary.
    pub displacement: DMatrix<f64>,
    /// Which nodes are in contact, those that have yielded among them.
    pub contact_map: DMatrix<bool>,
    /// Which nodes have yielded: none without a hardness.
    pub yielded_map: DMatrix<bool>,
    /// Plastic depth \[m\]: by how much yielded nodes would overlap, 0 elsewhere. Less it, the surface presses into the
    /// half-space elastically on unloading and reloading, up to this state.
    pub plastic_depth: DMatrix<f64>,
}

impl ContactFields {
    /// Greatest pressure \[Pa\].
    #[must_use]
    pub fn max_pressure(&self) -> f64 {
        self.pressure.iter().copied().fold(0.0, f64::max)
    }
}
