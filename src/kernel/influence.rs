//! The trait of elastic bodies.

use std::sync::Arc;

use super::{Boundary, ContactGrowth, KernelOrigin, MeanDisplacement};
use crate::Grid;

/// Influence coefficients of a translation-invariant elastic body on a grid.
///
/// The displacement at node i under the pressures p is
///
/// ```math
/// u_i = \sum_j C(\mathbf i - \mathbf j)\, p_j ,
/// ```
///
/// with u \[m\] positive into the body, p \[Pa\] positive in compression and C \[m/Pa\].
///
/// A kernel of your own implements this trait, or is a [`KernelTable`](super::KernelTable) made from
/// its coefficients or from its symbol. [`check`](super::check()) tests whether it keeps what it
/// promises.
pub trait InfluenceKernel {
    /// The grid on which the coefficients live.
    fn grid(&self) -> Grid;

    /// The surroundings of the grid. There is no default, because either choice does harm where the other
    /// is meant.
    fn boundary(&self) -> Boundary;

    /// Displacement at an offset of (di, dj) cells from a cell under unit pressure \[m/Pa\].
    ///
    /// Called for |di| < nx and |dj| < ny. By Maxwell-Betti reciprocity `C(−di, −dj) = C(di, dj)`.
    /// A contact path requires the matrix to be positive definite. With [`Boundary::Periodic`] the
    /// coefficients repeat: `C(di ± nx, dj) = C(di, dj ± ny) = C(di, dj)`.
    fn coefficient(&self, di: isize, dj: isize) -> f64;

    /// How contact is known to grow with the approach: [`ContactGrowth::Unknown`], which is
    /// always right, unless a kernel says more.
    ///
    /// It decides what a path costs, and not what it finds: of an unknown kernel every event is
    /// computed by itself, with some n² of memory traffic for each of n nodes. Say more where you know
    /// more. A promise that turns out wrong ends the path with
    /// [`Error::NotMonotone`](crate::Error::NotMonotone) as soon as a rate, a pressure or a gap has the
    /// wrong sign at the beginning or end of a window. That is soon but not certain, so test a promise
    /// with [`check`](super::check()) first.
    fn contact_growth(&self) -> ContactGrowth {
        ContactGrowth::Unknown
    }

    /// Whether the mean displacement under a net load is a property of the body:
    /// [`MeanDisplacement::Arbitrary`], as on a half-space, unless a kernel says otherwise.
    ///
    /// It matters with [`Boundary::Periodic`] only.
    fn mean_displacement(&self) -> MeanDisplacement {
        MeanDisplacement::Arbitrary
    }

    /// The parameters of the kernel, for a record of a path: [`KernelOrigin::Other`] unless it is one of this crate.
    fn origin(&self) -> KernelOrigin {
        KernelOrigin::Other
    }
}

/// Pointers to a kernel are that kernel.
macro_rules! forward {
    ($($pointer:ty),*) => {$(
        impl<K: InfluenceKernel + ?Sized> InfluenceKernel for $pointer {
            fn grid(&self) -> Grid {
                (**self).grid()
            }
            fn boundary(&self) -> Boundary {
                (**self).boundary()
            }
            fn coefficient(&self, di: isize, dj: isize) -> f64 {
                (**self).coefficient(di, dj)
            }
            fn contact_growth(&self) -> ContactGrowth {
                (**self).contact_growth()
            }
            fn mean_displacement(&self) -> MeanDisplacement {
                (**self).mean_displacement()
            }
            fn origin(&self) -> KernelOrigin {
                (**self).origin()
            }
        }
    )*};
}
forward!(&K, Box<K>, Arc<K>);
