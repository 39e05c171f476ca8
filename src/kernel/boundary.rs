//! What surrounds the grid.

/// What surrounds the grid: nothing, or itself.
///
/// It is a property of the kernel, which alone knows how far a displacement reaches, and it is
/// never assumed: every [`InfluenceKernel`](super::InfluenceKernel) states it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Boundary {
    /// The grid lies on an unbounded half-space without pressure outside; the displacement at
    /// infinity is zero, and the approach is measured from there.
    Free,
    /// Surface, pressure and displacement repeat with the sides of the grid, and the coefficients
    /// with its nodes: $C(d_i \pm n_x, d_j) = C(d_i, d_j \pm n_y) = C(d_i, d_j)$.
    ///
    /// The mean displacement of a periodic half-space under a net load is arbitrary (it grows
    /// without bound with the depth from which it is counted). A kernel settles it by its *gauge*,
    /// see [`PeriodicBoussinesq`](super::PeriodicBoussinesq).
    Periodic,
}
