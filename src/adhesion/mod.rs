//! Surfaces that stick: what force pulls them apart, and what does a loop of loading and unloading cost?
//!
//! A gap that is short enough is pulled shut by a traction that depends on it, the law of an [`Adhesion`]. An
//! [`AdhesivePath`] follows the contact event by event: nodes come near, touch, part and go out of range. Between two
//! events everything is linear in the approach, as on a path without adhesion, and every state is exact. There are two
//! *branches*, since a contact that sticks is not that of loading when it is unloaded: loading has the equilibrium of
//! the greatest gaps, unloading that of the least, on bodies of [convex](crate::ContactGrowth::Convex) gaps.
//!
//! ```
//! use asperity::adhesion::{Adhesion, AdhesivePath};
//! use asperity::surface::{Amplitude, SelfAffine};
//! use asperity::{Boussinesq, ContactTarget, Grid};
//!
//! # fn main() -> Result<(), asperity::Error> {
//! let half_space = Boussinesq::new(Grid::square(32, 1e-6)?, 10e6)?; // a soft body, E* = 10 MPa
//! let surface = SelfAffine::new(0.8, 5e-7, 2.5e-7, Amplitude::RmsHeight(1e-8), 1)?;
//! let builder = AdhesivePath::builder(&surface, &half_space, Adhesion::work(0.02)); // 20 mJ/m²
//! let mut path = builder.until(ContactTarget::Load(1e-6)).build()?;
//! let loading = path.run()?;
//! path.unload()?; // from there; `load_to` and `unload_to` turn around anywhere
//! let unloading = path.run()?;
//! assert!(unloading.pull_off() >= loading.pull_off());
//! # Ok(())
//! # }
//! ```
//!
//! # What is exact
//!
//! * *The branches*, on kernels of [`ContactGrowth::Convex`](crate::ContactGrowth::Convex): no gap opens on loading and
//!   none closes on unloading, also within jumps; where a jump ends does not depend on which node goes first; and a
//!   closed loop within the path restores its state. On kernels of
//!   [`ContactGrowth::Monotone`](crate::ContactGrowth::Monotone), `Spectral`, states are minima and energies balance
//!   all the same, but the order of events within a jump is that of this program, and nodes of one height that take
//!   turns without end are [`Error::Cycling`](crate::Error::Cycling). Kernels of unknown growth are refused.
//! * *Energies*: `∫ W dδ` is the sum of elastic, adhesive and dissipated energy. What a jump costs has a closed form.
//! * *Pull-off*: the branch under a dead load is that of the approach where the load is at its greatest so far on
//!   loading, or its least on unloading. So [`AdhesiveBranch::pull_off`] holds for machines of any compliance. What a
//!   loop costs depends on the machine.
//!
//! # What the mesh has to resolve
//!
//! The slope of the law times the compliance of a cell, [`CohesiveLaw::resolution`], has to be 0.5 at most: then a
//! front crosses the cells without a loop that the mesh makes. Up to 0.8 a path is followed, with a
//! [warning](crate::Warning::of_adhesion).
//! [`Adhesion::work`] without a range takes the shortest range that the cells resolve, `dx ≈ 0.2 E* h₂²/w`, which comes
//! to the limit of JKR as the cells get finer: with 10 cells in the contact radius of a summit at pull-off the force is
//! 4 % too great, with 20 cells 2.5 %, with 40 cells 1.5 %.
//!
//! # How
//!
//! A path needs a factor: 4n² bytes for n nodes in contact, as [`RecursiveCholesky`](crate::RecursiveCholesky) has it,
//! and as many columns as nodes are on the slope of the law; paths without one are not offered. Events are followed in
//! windows, as on other paths. The matrix of the soft nodes is kept from window to window, with the columns of the
//! factor that it is made of; a window has the matrix of the nodes to which something happens next, which all soft
//! nodes answer to. Before the factor follows a window, a solution shows whether something would have happened to other
//! nodes first; afterwards another one checks the end. Nodes go back and forth here and jumps have another parameter,
//! the pull of a node, so that windows keep the inverse of their matrix and not its factor. `docs/theory.md` has the
//! derivation.

mod answers;
mod board;
mod branch;
mod builder;
mod front;
mod law;
mod moment;
mod path;
mod plain;
mod rows;
mod soft;
mod state;
mod target;
mod trace;
mod window;

#[cfg(feature = "io")]
pub(crate) use board::Change;
pub use branch::AdhesiveBranch;
pub use builder::AdhesiveBuilder;
pub use law::{Adhesion, CohesiveLaw};
#[doc(hidden)] // for the studies of this repository
pub use path::AdhesiveTimings;
pub use path::{AdhesiveEnd, AdhesiveFields, AdhesivePath};
pub use state::{AdhesiveEvent, AdhesiveState, Direction, NodeState};
pub(crate) use trace::Trace;
