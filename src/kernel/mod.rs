//! How the half-space answers: influence coefficients.
//!
//! | kernel | boundary | a cell's displacement |
//! |---|---|---|
//! | [`Boussinesq`] | free | exact for uniform pressure on each cell |
//! | [`PeriodicBoussinesq`] | periodic | exact for uniform pressure on each cell |
//! | [`Spectral`] | periodic | the waves of the grid only, as in spectral codes |

mod boundary;
mod boussinesq;
mod even;
mod gauss;
mod growth;
mod periodic;
mod periodic_love;
mod spectral;
mod table;

pub use boundary::Boundary;
pub use boussinesq::Boussinesq;
pub use growth::ContactGrowth;
pub use periodic_love::PeriodicBoussinesq;
pub use spectral::Spectral;
pub(crate) use table::Blocks;
pub use table::KernelTable;

use crate::Grid;

/// Influence coefficients of a translation-invariant elastic body on a grid.
///
/// The displacement at node i is $u_i = \sum_j C(\mathbf i - \mathbf j)\, p_j$.
pub trait InfluenceKernel {
    /// The grid on which the coefficients live.
    fn grid(&self) -> Grid;

    /// What surrounds the grid: there is no default, since neither choice is harmless where the
    /// other is meant.
    fn boundary(&self) -> Boundary;

    /// Displacement \[m\] at an offset of (di, dj) cells from a cell under unit pressure \[m/Pa\].
    ///
    /// Called for |di| < nx and |dj| < ny. Maxwell-Betti reciprocity requires
    /// C(−di, −dj) = C(di, dj); a contact path requires the matrix to be positive definite. With
    /// [`Boundary::Periodic`] the coefficients repeat: C(di ± nx, dj) = C(di, dj ± ny) = C(di, dj).
    fn coefficient(&self, di: isize, dj: isize) -> f64;

    /// What is known of how contact grows with the approach: [`ContactGrowth::Unknown`], which is
    /// always right, unless a kernel says more.
    ///
    /// It decides what a path costs, and not what it finds: of an unknown kernel every event is
    /// computed by itself, in some n² of memory traffic for each of n nodes. Say more where you know
    /// more. A promise that turns out wrong ends the path with
    /// [`Error::NotMonotone`](crate::Error::NotMonotone) as soon as it shows in a rate, a pressure or
    /// a gap of the wrong sign at the beginning or end of a window, which is soon but not certain.
    fn contact_growth(&self) -> ContactGrowth {
        ContactGrowth::Unknown
    }
}

impl<K: InfluenceKernel + ?Sized> InfluenceKernel for &K {
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
}
