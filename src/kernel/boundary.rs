//! The surroundings of the grid.

/// The surroundings of the grid: nothing, or its own repetition.
///
/// It belongs to the kernel, which alone knows how far a displacement reaches, and it has no default:
/// every [`InfluenceKernel`](super::InfluenceKernel) states it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Boundary {
    /// The grid lies on an unbounded half-space without pressure outside; the displacement at
    /// infinity is zero, and the approach is measured from there.
    Free,
    /// Surface, pressure and displacement repeat with the sides of the grid, and the coefficients
    /// with its nodes: `C(di ± nx, dj) = C(di, dj ± ny) = C(di, dj)`.
    ///
    /// The mean displacement of a periodic half-space under a net load is arbitrary, that of a layer
    /// on a rigid base is not: see [`MeanDisplacement`](super::MeanDisplacement).
    Periodic,
}
