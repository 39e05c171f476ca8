//! Solutions on the contact, and what is asked of them.

/// What a solution is asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolveRequest {
    /// The contact: so many nodes, the first ones of the sequence.
    pub count: usize,
    /// The approach δ \[m\], in the gauge of the kernel.
    pub approach: f64,
    /// How much further the approach will go with these pressures \[m\]: the rate must be so exact that an
    /// updater keeps its tolerance over this span. Infinite where the solution itself is wanted, and 0 where
    /// the rate is not.
    pub span: f64,
    /// Error that gaps of watched nodes may have \[m\], if that is more than the updater's tolerance.
    pub gap_error: f64,
}

impl SolveRequest {
    /// The solution on the first `count` nodes at an approach, as exact as the updater goes.
    #[must_use]
    pub fn exact(count: usize, approach: f64) -> Self {
        Self {
            count,
            approach,
            span: f64::INFINITY,
            gap_error: 0.0,
        }
    }
}

/// Pressures on the contact nodes, in the order in which they joined: the paper's `y₁ + h₀ y₂` (eq. 5),
/// with the approach δ in place of h₀ and both parts at the approach where they are needed, so that none
/// of their digits cancel.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Solution {
    /// `p = C_II⁻¹ (δ e − g_I)` \[Pa\].
    pub pressure: Vec<f64>,
    /// `y₂ = C_II⁻¹ e` \[Pa/m\], the pressure per unit of approach.
    pub rate: Vec<f64>,
    /// Displacements of all nodes of the grid under `pressure` \[m\] and under `rate`, if the updater has
    /// them; empty otherwise.
    pub displacement: [Vec<f64>; 2],
}
