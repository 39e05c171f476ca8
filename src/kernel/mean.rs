//! Whether the mean displacement of a periodic body means anything.

/// Whether the mean displacement of a periodic body under a net load is a property of the body.
///
/// Of a body with a [free boundary](crate::Boundary::Free) this says nothing: its displacement
/// vanishes at infinity, and so nothing about it is arbitrary.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum MeanDisplacement {
    /// The mean displacement depends on the depth from which it is counted, as on a periodic
    /// half-space, where it grows with that depth without bound. The mean of the coefficients is then
    /// a matter of choice, the *gauge* of the kernel (see
    /// [`PeriodicBoussinesq`](super::PeriodicBoussinesq#gauge)). What is reported is the approach
    /// of the mean planes, without the mean displacement, and so nothing that is reported depends on the
    /// gauge.
    #[default]
    Arbitrary,
    /// The mean displacement is real, like the compression of a layer on a rigid base. Approach,
    /// displacement and energy are reported with the mean in them, as on a body with a free boundary.
    Physical,
}
