//! The inverse of the influence matrix of the contact.
//!
//! With n nodes in contact and their influence matrix `C_II`, a path needs three things again and again of a
//! [`LinearUpdater`]: it *watches* nodes that may touch next, lets those that touched *join*, and *solves* on the
//! contact. An updater knows nothing of windows and events. Further methods of the trait have defaults that refuse: where
//! nodes may leave or yield, a path needs [`truncate`](LinearUpdater::truncate), [`release`](LinearUpdater::release),
//! [`watch_both`](LinearUpdater::watch_both) and [`solve_for`](LinearUpdater::solve_for) as well.
//!
//! | updater | memory for n nodes in contact | |
//! |---|---|---|
//! | [`RecursiveCholesky`] | 4n² bytes | exact to rounding |
//! | [`ConjugateGradient`] | in proportion to the grid | iterations by fast Fourier transform; the same events, and states nearly as exact |
//! | [`Handover`] | a budget | the default: a factor while it pays and fits, iterations afterwards |
//! | [`Dense`] | 16n² bytes | for tests: assembles and factors everything anew |
//!
//! Every updater answers exactly. Iterations also offer cheap Schur complements that are nearly exact: with
//! [`ConjugateGradient`] a path uses these and corrects them ([`loading`](crate::loading)).

mod check;
mod cholesky;
mod conjugate_gradient;
mod dense;
mod handover;
mod iterations;
mod join;
mod kept;
mod schur;
mod solution;
#[cfg(test)]
pub(crate) mod test_altered;
mod tuning;
mod window_factor;

pub use check::{UpdaterReport, check};
#[doc(hidden)] // for the studies and benches of this repository
pub use cholesky::CholeskyTimings;
pub use cholesky::RecursiveCholesky;
pub use conjugate_gradient::ConjugateGradient;
pub use dense::Dense;
pub use handover::Handover;
pub(crate) use iterations::{Behind, Beside, Iterations, Proposal, SUMS, Solved};
pub(crate) use join::join_all;
pub(crate) use kept::{Kept, KeptBeside, KeptField};
pub use schur::Schur;
pub use solution::Solution;
pub(crate) use tuning::JOINED;
pub use window_factor::WindowFactor;

use std::any::Any;
use std::fmt;

use nalgebra::DMatrix;

use crate::contact::ContactSequence;
use crate::{Error, Problem, UpdaterError};

/// A node that left the contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Left {
    /// Its index.
    pub node: usize,
    /// How many nodes were before it in the order of contact.
    pub position: usize,
}

/// A contact that grows, and rarely shrinks, and the inverse of its influence matrix.
///
/// The path owns the order of contact and passes it along; an updater keeps whatever it needs to answer
/// quickly. [`ContactSequence::revision`] says whether a cache still belongs to it. An updater starts with
/// no node in contact.
///
/// A path holds its updater as a `dyn LinearUpdater`, and may be sent to another thread with it: so it borrows nothing.
///
/// Here is one that keeps nothing and factors the whole matrix whenever it is asked:
///
/// ```
/// use asperity::contact::ContactSequence;
/// use asperity::updater::{self, LinearUpdater, Schur, Solution, WindowFactor};
/// use asperity::{Boussinesq, Error, Grid, LoadingSolver, Problem, SelfAffine};
/// use asperity::nalgebra::{DMatrix, DVector};
///
/// struct Plain;
///
/// /// C between two sets of nodes.
/// fn influence(problem: &Problem, rows: &[usize], columns: &[usize]) -> DMatrix<f64> {
///     DMatrix::from_fn(rows.len(), columns.len(), |i, j| {
///         problem.coefficient(rows[i], columns[j]).unwrap_or(f64::NAN)
///     })
/// }
///
/// /// C_II⁻¹ times some columns.
/// fn solve(problem: &Problem, contact: &[usize], b: DMatrix<f64>) -> Result<DMatrix<f64>, Error> {
///     let factor = influence(problem, contact, contact).cholesky();
///     let factor = factor.ok_or(Error::FactorizationFailed { nodes: contact.len() })?;
///     Ok(factor.solve(&b))
/// }
///
/// impl LinearUpdater for Plain {
///     fn watch(
///         &mut self,
///         problem: &Problem,
///         contact: &ContactSequence,
///         nodes: &[usize],
///         schur: &mut Schur,
///     ) -> Result<(), Error> {
///         let coupling = influence(problem, contact.order(), nodes);
///         let solved = solve(problem, contact.order(), coupling.clone())?;
///         schur.resize(nodes.len())?;
///         let complement = influence(problem, nodes, nodes) - coupling.transpose() * &solved;
///         schur.matrix_mut().copy_from(&complement);
///         for (j, &node) in nodes.iter().enumerate() {
///             let column = solved.column(j);
///             let inside = contact.order().iter().zip(column.iter());
///             let explained: f64 = inside.map(|(&i, x)| problem.row_sums()[i] * x).sum();
///             schur.row_sums_mut()[j] = problem.row_sums()[node] - explained;
///         }
///         Ok(())
///     }
///
///     fn join(&mut self, _: &Problem, _: &ContactSequence, _: &WindowFactor) -> Result<(), Error> {
///         Ok(())
///     }
///
///     fn solve(
///         &mut self,
///         problem: &Problem,
///         contact: &ContactSequence,
///         count: usize,
///         approach: f64,
///         solution: &mut Solution,
///     ) -> Result<(), Error> {
///         let contact = &contact.order()[..count];
///         let gap = contact.iter().map(|&node| problem.initial_gap()[node]);
///         let overlap = DVector::from_iterator(contact.len(), gap.map(|gap| approach - gap));
///         let rhs = [overlap, DVector::from_element(contact.len(), 1.0)];
///         let solved = solve(problem, contact, DMatrix::from_columns(&rhs))?;
///         solution.pressure = solved.column(0).iter().copied().collect();
///         solution.rate = solved.column(1).iter().copied().collect();
///         Ok(())
///     }
/// }
///
/// # fn main() -> Result<(), Error> {
/// let half_space = Boussinesq::new(Grid::square(16, 1e-2)?, 1.0)?;
/// let surface = SelfAffine::new(
///     0.8,
///     5e-3,
///     2.5e-3,
///     asperity::surface::Amplitude::RmsHeight(1e-4),
///     1,
/// )?;
/// // The checker first, which compares every verb with a dense solution; then a path.
/// updater::check(&mut Plain, &Problem::new(&surface, &half_space)?)?;
/// let path = LoadingSolver::builder(&surface, &half_space).updater(Plain).max_nodes(40).build()?;
/// assert_eq!(path.count(), 40);
/// # Ok(())
/// # }
/// ```
pub trait LinearUpdater: Any + Send + Sync {
    /// Eliminates the contact I from the system bordered by the watched nodes P, none of them in contact:
    ///
    /// ```math
    /// S = C_{PP} - C_{PI} C_{II}^{-1} C_{IP}, \qquad
    /// \sigma = s_P - C_{PI} C_{II}^{-1} s_I
    /// ```
    ///
    /// with the row sums s of [`Problem::row_sums`]. Only the lower triangle of S need be written.
    ///
    /// The first window of a path has no node in contact: S is $`C_{PP}`$ then, and σ is $`s_P`$.
    ///
    /// # Errors
    ///
    /// Whatever keeps the updater from answering.
    fn watch(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error>;

    /// Takes note of the nodes that joined, the last ones of `contact`. They are among the nodes of the
    /// last call of [`watch`](Self::watch); `factor` is the Cholesky factor of their part of its Schur complement.
    ///
    /// # Errors
    ///
    /// Whatever keeps the updater from growing.
    fn join(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        factor: &WindowFactor,
    ) -> Result<(), Error>;

    /// Solves on the first `count` nodes of `contact` at an approach δ \[m\], in the gauge of the kernel: on all nodes
    /// while the path advances, on fewer for an earlier state. Later answers must not depend on such a call. A path
    /// begins with a solution on no node, a `count` of 0: pressures and rates are empty then.
    ///
    /// A path checks the answer: if it does not close the gaps in contact to rounding, the path ends with
    /// [`UpdaterError::ContactNotClosed`].
    ///
    /// # Errors
    ///
    /// Whatever keeps the updater from answering.
    fn solve(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        count: usize,
        approach: f64,
        solution: &mut Solution,
    ) -> Result<(), Error>;

    /// Forgets the last nodes: `contact` has been cut. Called only if the end of a window contradicts its
    /// last events, which takes a hardness or a kernel whose growth is not convex, or not as it states, or if the
    /// updater could not let them join.
    ///
    /// # Errors
    ///
    /// Whatever keeps the updater from shrinking; by default [`UpdaterError::TruncateNotSupported`].
    fn truncate(&mut self, problem: &Problem, contact: &ContactSequence) -> Result<(), Error> {
        let _ = problem;
        let nodes = contact.len();
        Err(UpdaterError::TruncateNotSupported { nodes }.into())
    }

    /// Forgets nodes that left the contact, by their positions in it, ascending: `contact` is without them already, and
    /// initial gap and row sums of `problem` may be others than before. No node is watched afterwards. Called only if a
    /// pressure falls to zero, which takes a kernel of unknown growth, or rises to a hardness: then also with none of
    /// its nodes, where only others yield and the problem has changed.
    ///
    /// # Errors
    ///
    /// Whatever keeps the updater from shrinking; by default [`UpdaterError::ReleaseNotSupported`].
    fn release(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        left: &[Left],
    ) -> Result<(), Error> {
        let _ = contact;
        let Some(&Left { node, .. }) = left.first() else {
            return Ok(());
        };
        problem.check_nodes(&[node])?;
        let (ix, iy) = problem.grid().coordinates(node);
        Err(UpdaterError::ReleaseNotSupported { ix, iy }.into())
    }

    /// Eliminates the contact I from the system bordered by nodes P out of contact and by the nodes Q at some positions
    /// of it, ascending, which may yield:
    ///
    /// ```math
    /// M = \begin{pmatrix} C_{PP} & 0 \\ 0 & 0 \end{pmatrix} -
    ///     \begin{pmatrix} C_{PI} \\ E_Q^T \end{pmatrix} C_{II}^{-1} \begin{pmatrix} C_{IP} & E_Q \end{pmatrix}
    /// ```
    ///
    /// with the unit vectors $`E_Q`$ of these positions. M gives the changes of the gaps of P and of the pressures of Q
    /// under pressures on P and overlaps of Q. Only its lower triangle need be written, and no row sums. Called only on
    /// paths with a hardness. [`join`](Self::join) may follow, for some of P.
    ///
    /// # Errors
    ///
    /// Whatever keeps the updater from answering; by default [`UpdaterError::HardnessNotSupported`].
    fn watch_both(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        positions: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        let _ = (problem, contact, nodes, positions, schur);
        Err(UpdaterError::HardnessNotSupported.into())
    }

    /// What a pressure on each of some nodes J takes off the contact: $`C_{II}^{-1} C_{IJ}`$, a row for each node in
    /// contact and a column for each of `nodes`, which are among those of the last call of [`watch`](Self::watch);
    /// nothing has joined since. Called only on bodies on which nodes may leave, where a window ends before one does.
    ///
    /// # Errors
    ///
    /// Whatever keeps the updater from answering; by default `None`: each event has a solution of its own then.
    fn relief(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
    ) -> Result<Option<DMatrix<f64>>, Error> {
        let _ = (problem, contact, nodes);
        Ok(None)
    }

    /// Makes right-hand sides b, two for each node in contact, into $`C_{II}^{-1} b`$. Called only on paths with a
    /// hardness.
    ///
    /// # Errors
    ///
    /// Whatever keeps the updater from answering; by default [`UpdaterError::HardnessNotSupported`].
    fn solve_for(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        rhs: &mut [[f64; 2]],
    ) -> Result<(), Error> {
        let _ = (problem, contact, rhs);
        Err(UpdaterError::HardnessNotSupported.into())
    }

    /// Bytes this updater holds when `contact` nodes are in contact and `watched` are watched.
    fn bytes(&self, contact: usize, watched: usize) -> usize {
        let _ = (contact, watched);
        0
    }

    /// Tells the updater how many bytes are left for it on a problem, before the first node is in contact and
    /// before it allocates anything. The path holds what [`bytes`](Self::bytes) says to that; an updater
    /// need not do anything.
    ///
    /// # Errors
    ///
    /// [`Error::MemoryBudget`] if the updater needs more for the grid alone.
    fn make_room(&mut self, problem: &Problem, bytes: usize) -> Result<(), Error> {
        let _ = (problem, bytes);
        Ok(())
    }
}

impl fmt::Debug for dyn LinearUpdater {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("LinearUpdater")
    }
}

/// Forwards all methods to another updater but `bytes`, which borrows it without `mut`.
macro_rules! forward_verbs {
    ($inner:ident) => {
        fn watch(
            &mut self,
            problem: &Problem,
            contact: &ContactSequence,
            nodes: &[usize],
            schur: &mut Schur,
        ) -> Result<(), Error> {
            self.$inner().watch(problem, contact, nodes, schur)
        }

        fn join(
            &mut self,
            problem: &Problem,
            contact: &ContactSequence,
            factor: &WindowFactor,
        ) -> Result<(), Error> {
            self.$inner().join(problem, contact, factor)
        }

        fn solve(
            &mut self,
            problem: &Problem,
            contact: &ContactSequence,
            count: usize,
            approach: f64,
            solution: &mut Solution,
        ) -> Result<(), Error> {
            self.$inner().solve(problem, contact, count, approach, solution)
        }

        fn truncate(&mut self, problem: &Problem, contact: &ContactSequence) -> Result<(), Error> {
            self.$inner().truncate(problem, contact)
        }

        fn release(
            &mut self,
            problem: &Problem,
            contact: &ContactSequence,
            left: &[Left],
        ) -> Result<(), Error> {
            self.$inner().release(problem, contact, left)
        }

        fn watch_both(
            &mut self,
            problem: &Problem,
            contact: &ContactSequence,
            nodes: &[usize],
            positions: &[usize],
            schur: &mut Schur,
        ) -> Result<(), Error> {
            self.$inner().watch_both(problem, contact, nodes, positions, schur)
        }

        fn relief(
            &mut self,
            problem: &Problem,
            contact: &ContactSequence,
            nodes: &[usize],
        ) -> Result<Option<DMatrix<f64>>, Error> {
            self.$inner().relief(problem, contact, nodes)
        }

        fn solve_for(
            &mut self,
            problem: &Problem,
            contact: &ContactSequence,
            rhs: &mut [[f64; 2]],
        ) -> Result<(), Error> {
            self.$inner().solve_for(problem, contact, rhs)
        }

        fn make_room(&mut self, problem: &Problem, bytes: usize) -> Result<(), Error> {
            self.$inner().make_room(problem, bytes)
        }
    };
}
use forward_verbs;

impl LinearUpdater for Box<dyn LinearUpdater> {
    forward_verbs!(as_mut);

    fn bytes(&self, contact: usize, watched: usize) -> usize {
        (**self).bytes(contact, watched)
    }
}

/// What an updater is, without the boxes around it.
pub(crate) fn innermost(updater: &dyn LinearUpdater) -> &dyn Any {
    let mut own: &dyn Any = updater;
    while let Some(boxed) = own.downcast_ref::<Box<dyn LinearUpdater>>() {
        own = &**boxed;
    }
    own
}

/// `Ok` if an updater that holds `held` nodes is asked about a contact of `found`.
fn check_count(held: usize, found: usize) -> Result<(), Error> {
    if held == found {
        return Ok(());
    }
    Err(Error::LengthMismatch { expected: held, found })
}

/// A symmetric matrix whose rows are dominated by their diagonals.
#[cfg(test)]
fn dominant(i: usize, j: usize) -> f64 {
    let (i, j) = (i.min(j) as f64, i.max(j) as f64);
    if i == j { 400.0 } else { libm::sin(3.0 * i + 7.0 * j * j) }
}
