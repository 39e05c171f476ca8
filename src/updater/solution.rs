//! Solutions on the contact.

/// Pressures on the contact nodes, in the order in which they joined: the paper's `y₁ + h₀ y₂` (eq. 5),
/// with the approach δ in place of h₀ and both parts at the approach where they are needed, so that none
/// of their digits cancel.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Solution {
    /// `p = C_II⁻¹ (δ e − g_I)` \[Pa\].
    pub pressure: Vec<f64>,
    /// `y₂ = C_II⁻¹ e` \[Pa/m\], the pressure per unit of approach.
    pub rate: Vec<f64>,
}
