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
mod periodic;
mod periodic_love;
mod spectral;
mod table;

pub use boundary::Boundary;
pub use boussinesq::Boussinesq;
pub use periodic_love::PeriodicBoussinesq;
pub use spectral::Spectral;
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

    /// Whether contact is known only to grow as the approach does: no node ever leaves it, and a
    /// node's gap closes the slower the more others are in contact. It holds if the influence matrix
    /// is an inverse M-matrix (all off-diagonals of the inverse negative, its row sums positive), as
    /// Love's is.
    ///
    /// If not, which is the default, a path solves afresh for every single state and checks it: it
    /// is still exact, or ends with [`Error::NotMonotone`](crate::Error::NotMonotone), but costs
    /// some n² for each of n nodes in memory traffic. Override it where you know better.
    fn contact_only_grows(&self) -> bool {
        false
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
    fn contact_only_grows(&self) -> bool {
        (**self).contact_only_grows()
    }
}
