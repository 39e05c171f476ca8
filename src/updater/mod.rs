//! The contact set and the inverse of its influence matrix.
//!
//! With the contact set I (n nodes) and its influence matrix $C_{II}$, the path needs three things
//! again and again, and they are the three verbs of [`LinearUpdater`]: the Schur complement of
//! nodes that may touch next, adding those that did touch, and the solution on the present set.
//! The window and the event loop of [`LoadingSolver`](crate::LoadingSolver) know nothing else, so
//! updaters are interchangeable.

mod cholesky;
mod columns;
mod conjugate_gradient;
mod dense;
mod factor;
mod handover;
mod mixed;
mod panels;
mod precision;
mod products;
mod residual;
mod schur;
mod substitution;
mod system;
mod touched;

pub use cholesky::RecursiveCholesky;
pub use conjugate_gradient::ConjugateGradient;
pub use dense::Dense;
pub use factor::CholeskyTimings;
pub use handover::Handover;
pub use mixed::MixedCholesky;
pub use schur::Schur;
pub use system::System;
pub use touched::Touched;

use crate::Error;

/// Pressures on the contact nodes, in the order in which they touched:
/// $p = y_1 + \delta\, y_2$ (paper, eq. 5 with $\delta$ in place of $h_0$).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Solution {
    /// $y_1 = -C_{II}^{-1} g_I$ \[Pa\].
    pub y1: Vec<f64>,
    /// $y_2 = C_{II}^{-1} e$ \[Pa/m\], the pressure per unit of approach.
    pub y2: Vec<f64>,
}

/// What the work of a window costs, in nanoseconds: from it the path chooses how many nodes to watch.
///
/// Constants and not measurements, so that the same input gives the same windows, and the same bits,
/// on every run. A wrong one costs time and nothing else, and the optimum is flat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WindowCost {
    /// A solution on n contact nodes, per n².
    pub solve: f64,
    /// A Schur complement of k nodes, per k² n.
    pub schur: f64,
    /// Convolutions, per node of the grid.
    pub convolution: f64,
    /// Greatest number of watched nodes, as a fraction of the contact nodes: their columns must stay
    /// small beside the factor.
    pub most_watched: f64,
    /// Nodes that were not watched before come in multiples of this if there are more: widths that
    /// suit the matrix product.
    pub multiple: usize,
}

impl Default for WindowCost {
    /// A factor in double precision: a solution reads its 4n² bytes, a Schur complement runs at the
    /// speed of a matrix product, and a refresh needs the displacements of two fields.
    fn default() -> Self {
        Self {
            solve: 0.3,
            schur: 0.01,
            convolution: 50.0,
            most_watched: 0.05,
            multiple: 96,
        }
    }
}

/// A contact set that grows, and rarely shrinks, and the inverse of its influence matrix.
///
/// An updater starts with an empty contact set. It is told of nodes in the order in which they
/// touch, in two stages: first they are *watched* ([`schur`](Self::schur)), then those that
/// *touched* are committed. Between two commits the updater's own contact set does not change;
/// nodes that touched since are passed along as [`Touched`].
pub trait LinearUpdater {
    /// Eliminates the contact set from the system bordered by `nodes`:
    ///
    /// $$ S = C_{PP} - C_{PI} C_{II}^{-1} C_{IP}, \qquad
    ///    R = B_P - C_{PI} C_{II}^{-1} B_I $$
    ///
    /// with P the given nodes, none of them in contact, and B the right-hand sides of `system`.
    /// Only the lower triangle of S need be written.
    ///
    /// # Errors
    ///
    /// Whatever keeps the updater from answering.
    fn schur(&mut self, system: &System, nodes: &[usize], schur: &mut Schur) -> Result<(), Error>;

    /// Adds the nodes that touched, in that order. They are among the nodes of the last call of
    /// [`schur`](Self::schur), of whose Schur complement `touched` holds the Cholesky factor.
    ///
    /// # Errors
    ///
    /// Whatever keeps the updater from growing.
    fn commit(&mut self, system: &System, touched: &Touched) -> Result<(), Error>;

    /// Takes a committed node out of the contact set: those after it move up by one. No node is
    /// watched afterwards. Called only if the pressure of a node falls to zero, which some kernels
    /// never let happen.
    ///
    /// # Errors
    ///
    /// [`Error::NotInContact`], and whatever keeps the updater from shrinking; then nothing has
    /// changed. By default [`Error::ReleaseNotSupported`].
    fn release(&mut self, system: &System, node: usize) -> Result<(), Error> {
        system.check_nodes(&[node])?;
        let (ix, iy) = system.table().grid().coordinates(node);
        Err(Error::ReleaseNotSupported { ix, iy })
    }

    /// Solves for the first `count` nodes of the sequence that consists of the committed nodes and,
    /// after them, those of `touched` (which are not committed yet).
    ///
    /// # Errors
    ///
    /// Whatever keeps the updater from answering.
    fn solve(
        &mut self,
        system: &System,
        touched: &Touched,
        count: usize,
        solution: &mut Solution,
    ) -> Result<(), Error>;

    /// What a window costs with this updater.
    fn window_cost(&self) -> WindowCost {
        WindowCost::default()
    }

    /// Whether Schur complements are exact but for rounding in double precision. If not, solutions
    /// and right-hand sides must still be; the path then verifies every window before it yields
    /// its states, and takes its sums from the solution at every refresh.
    fn is_exact(&self) -> bool {
        true
    }

    /// Bytes this updater holds when `contact` nodes are in contact and `watched` are watched.
    fn bytes(&self, contact: usize, watched: usize) -> usize {
        let _ = (contact, watched);
        0
    }

    /// Tells the updater how many bytes are left for it, before the first node is in contact. What
    /// [`bytes`](Self::bytes) says is held to that by the path; an updater need not do anything.
    fn set_memory_budget(&mut self, bytes: usize) {
        let _ = bytes;
    }
}

/// A symmetric matrix whose rows are dominated by their diagonals.
#[cfg(test)]
fn dominant(i: usize, j: usize) -> f64 {
    let (i, j) = (i.min(j) as f64, i.max(j) as f64);
    if i == j {
        400.0
    } else {
        libm::sin(3.0 * i + 7.0 * j * j)
    }
}
