//! Errors of kernels.

use thiserror::Error;

/// Influence coefficients that no elastic body has, or that are not what the kernel promises.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum KernelError {
    /// An influence coefficient is NaN or infinite.
    #[error("the influence coefficient at offset ({di}, {dj}) is {value}, which is not finite")]
    NotFinite {
        /// Offset along x in cells.
        di: isize,
        /// Offset along y in cells.
        dj: isize,
        /// The coefficient.
        value: f64,
    },

    /// Maxwell-Betti reciprocity is broken: C(d) differs from C(-d).
    #[error(
        "the influence coefficients at offset ({di}, {dj}) and at its opposite differ: \
         {value} and {opposite}"
    )]
    NotSymmetric {
        /// Offset along x in cells.
        di: isize,
        /// Offset along y in cells.
        dj: isize,
        /// The coefficient there.
        value: f64,
        /// The coefficient at (-di, -dj).
        opposite: f64,
    },

    /// A kernel that says it is periodic does not repeat with the grid.
    #[error(
        "the kernel is said to be periodic, but the influence coefficients at offset ({di}, {dj}) \
         and one period further, at ({image_di}, {image_dj}), differ: {value} and {repeated}"
    )]
    NotPeriodic {
        /// Offset along x in cells.
        di: isize,
        /// Offset along y in cells.
        dj: isize,
        /// The coefficient there.
        value: f64,
        /// Offset along x one period further.
        image_di: isize,
        /// Offset along y one period further.
        image_dj: isize,
        /// The coefficient there.
        repeated: f64,
    },

    /// The symbol of a kernel is not positive and finite: no elastic body answers a wave like this.
    #[error("the symbol at the wavevector {q:?} rad/m is {value}, not positive and finite")]
    SymbolNotPositive {
        /// Wavevector along x and y \[rad/m\].
        q: (f64, f64),
        /// The symbol \[m/Pa\].
        value: f64,
    },

    /// Maxwell-Betti reciprocity is broken: the symbol at q differs from that at −q.
    #[error(
        "the symbols at the wavevector {q:?} rad/m and at its opposite differ: \
         {value} and {opposite}"
    )]
    SymbolNotEven {
        /// Wavevector along x and y \[rad/m\].
        q: (f64, f64),
        /// The symbol there \[m/Pa\].
        value: f64,
        /// The symbol at -q \[m/Pa\].
        opposite: f64,
    },

    /// A hardness was given for a kernel of [`ContactGrowth::Unknown`](crate::ContactGrowth): where pressures may fall
    /// as the approach grows, yielded nodes may unload, and a hardness does not determine the contact.
    #[error(
        "a hardness needs a body on which contact is known to grow: on this one, as under a stiff layer, yielded nodes may unload while the \
         load grows, and a hardness does not determine the contact. Without one it has its path"
    )]
    GrowthUnknown,

    /// A kernel does not keep a promise, as [`kernel::check`](crate::kernel::check()) has found.
    #[error(
        "the kernel is not what it promises to be, {promise}: with {} in contact the \
         {quantity} at node {node:?} is {value}",
        crate::number::counted(contact.len(), "node")
    )]
    BrokenPromise {
        /// The promise.
        promise: &'static str,
        /// The quantity with the wrong sign.
        quantity: &'static str,
        /// Indices of the nodes in contact, as by [`Grid::coordinates`](crate::Grid::coordinates).
        contact: Vec<usize>,
        /// The node at which it shows, (ix, iy).
        node: (usize, usize),
        /// The offending value.
        value: f64,
    },
}
