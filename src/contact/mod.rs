//! Contact: its state, the order in which nodes joined it, how exact it is, and what can be asked of it.
//!
//! The path ([`LoadingSolver`](crate::LoadingSolver)) and the solver for one load
//! ([`FixedLoadSolver`](crate::FixedLoadSolver)) speak of contact in these words, with the same names
//! and the same scales.

mod certificate;
mod fields;
mod sequence;
mod state;
mod target;

pub use certificate::Certificate;
pub(crate) use certificate::{Conditions, ErrorLength};
pub use fields::ContactFields;
pub use sequence::ContactSequence;
pub(crate) use sequence::node_of;
pub use state::{ContactState, PlasticState};
pub use target::ContactTarget;
