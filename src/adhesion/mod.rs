//! Surfaces that stick: both branches of a path with adhesion, event by event.

mod board;
mod builder;
mod front;
mod law;
mod path;
mod state;
mod target;
mod window;

pub use builder::AdhesiveBuilder;
pub use law::{Adhesion, CohesiveLaw};
pub use path::{AdhesiveFields, AdhesivePath, AdhesiveTimings, BranchEnd};
pub use state::{AdhesiveEvent, AdhesiveState, Direction, NodeState};
