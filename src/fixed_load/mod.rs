//! One load, or one approach, without the path to it.
//!
//! The contact of a rigid rough surface with an elastic half-space under the load W minimises the
//! energy
//!
//! ```math
//! \tfrac12 \, p^T C p + g^T p \qquad\text{over}\qquad p \ge 0, \quad \Delta A \sum p = W,
//! ```
//!
//! with the initial gap `g ≥ 0` \[m\], pressures p \[Pa\] and the influence matrix C \[m/Pa\]. Its
//! multiplier is the approach δ: at the solution `g + C p = δ` in contact and `≥ δ` elsewhere.
//! [`FixedLoadSolver`] finds it in O(grid) memory and a few convolutions, to any tolerance that double
//! precision carries, from a single node to full contact.
//!
//! # Method
//!
//! * **Active set, inexact inside.** On the set I of nodes with pressure or overlap, the equations
//!   `C_II p = δ − g` are solved with `Σ p` fixed by projected conjugate gradients, one convolution a
//!   step, only until what is left is smaller than the worst error in I itself.
//! * **Preconditioner** of two levels: a sparse inverse Cholesky factor of `C_II`, and a bilinear coarse
//!   space for the long waves that it misses.
//! * **Release**: nodes with tension are set free, their neighbours corrected by the
//!   preconditioner alone, and the step goes only as far as the energy falls, unless there was tension
//!   at its start already.
//! * **Precision**: search directions go through a convolution in single precision, residuals are
//!   computed afresh in double precision before the errors of these steps matter.
//! * **Nested grids**: the start comes from a grid of half as many nodes a side, recursively, with
//!   the Galerkin kernel (pressures uniform on blocks of 2 × 2), which any kernel has.
//!
//! # Metals that yield
//!
//! With [`FixedLoadBuilder::hardness`] no pressure exceeds the hardness H (Almqvist et al., Tribology International 40
//! (2007) 574: elastic–perfectly plastic contact): the bounds are `0 ≤ p ≤ H`, and where `p = H` the surfaces overlap
//! elastically by the plastic depth, which stays in the surface. Nodes that yield are a load on the others, whose
//! problem is the elastic one with the initial gap `g + C H`; rounds of elastic solutions, each with the nodes above H
//! yielded, end at the solution. The model has no hardening, does not conserve volume, and knows of no stress below the
//! surface: the pressure of a cell is at most H, nothing else.
//!
//! # Periodic half-spaces
//!
//! The mean displacement of a periodic half-space is arbitrary unless its kernel says otherwise. With
//! the load prescribed every search direction has the sum zero, so that this gauge drops out: the zero
//! gauge is used, and what is reported does not depend on that of the kernel. The approach is that of
//! the mean planes, displacements are about their mean, and of the stiffnesses only the interfacial one
//! exists. Up to full contact an approach can be prescribed as well; from there on it stays the mean
//! initial gap, whatever the load, but for the error of the gaps.
//!
//! # Many states
//!
//! [`FixedLoadSolver::sweep`] goes from state to state, each given by a load, an approach, a contact
//! area or a mean gap ([`ContactTarget`](crate::ContactTarget)), and each as exact as if it were alone. Pressures,
//! displacements and approach are predicted together from the last states and their tangents.
//!
//! # Errors of the solution
//!
//! Every solution is checked afresh with one convolution in double precision: its
//! [`Certificate`](crate::Certificate) says what is left.
//!
//! # Layout
//!
//! A solver consists of its settings and of a hierarchy of levels, each the contact problem on one
//! grid. On a level an active set is searched for, with a descent by conjugate gradients on each. From
//! state to state goes a stepper, with a continuation of tangents; searches and sweeps use it.
//!
//! # References
//!
//! * I. A. Polonsky and L. M. Keer, Wear 231 (1999) 206: conjugate gradients with a growing and
//!   shrinking contact.
//! * E. A. H. Vollebregt, J. Optim. Theory Appl. 162 (2014) 931: preconditioning, bounds.
//! * F. Schäfer, M. Katzfuss and H. Owhadi, SIAM J. Sci. Comput. 43 (2021) A2019: the sparse
//!   inverse Cholesky factor.
//! * J. Allwood, J. Tribol. 127 (2005) 10: a survey of solvers with active sets.

mod active_set;
mod budget;
mod builder;
mod continuation;
mod descent;
mod hardness;
mod hierarchy;
mod iterate;
mod level;
mod plateau;
mod release;
mod search;
mod settings;
mod solution;
mod solver;
mod stepper;
mod sweep;
mod tangent;
mod tuning;

pub use builder::FixedLoadBuilder;
pub use solution::{FixedLoadSolution, SolverEffort};
pub use solver::FixedLoadSolver;
pub use sweep::LoadSweep;
