//! The surroundings of the grid.

/// The surroundings of the grid: nothing, or its own repetition, in both directions or in one.
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
    /// The same along x only: surface, pressure and displacement repeat with the side of the grid along x, `C(di ± nx,
    /// dj) = C(di, dj)`, and nothing is pressed beyond the edges along y.
    ///
    /// A row of images that never ends displaces any point without bound, and all points alike but for a logarithm of
    /// the distance: what the approach is counted from is the kernel's to say, as
    /// [`SemiPeriodicBoussinesq`](super::SemiPeriodicBoussinesq) does.
    PeriodicX,
    /// The same along y only, `C(di, dj ± ny) = C(di, dj)`.
    PeriodicY,
}

impl Boundary {
    /// Whether the grid repeats along x and along y.
    #[must_use]
    pub fn repeats(self) -> [bool; 2] {
        match self {
            Self::Free => [false, false],
            Self::Periodic => [true, true],
            Self::PeriodicX => [true, false],
            Self::PeriodicY => [false, true],
        }
    }
}
