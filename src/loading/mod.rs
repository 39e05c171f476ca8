//! The loading path: one exact contact state per node that joins, or leaves.
//!
//! Between two events everything is linear in the approach δ:
//!
//! $$ p = y_1 + \delta\, y_2 \quad (\text{contact}), \qquad
//!    \text{gap} = r_1 - \delta\, r_2 \quad (\text{everywhere}) $$
//!
//! and node j touches at $\delta_j = r_{1j} / r_{2j}$. A path is the sequence of these events,
//! found in *windows*: since contact only ever grows, a $\delta_j$ computed earlier is a lower
//! bound, and only the nodes with the smallest ones need be watched until the *horizon*, the
//! smallest bound among all others, is reached. What a kernel promises of its contact decides
//! whether that holds ([`ContactGrowth`](crate::ContactGrowth)): windows are checked at their ends
//! if bounds may fail, and events are found one at a time, nodes that *leave* among them, if nothing
//! is known.

mod builder;
mod certificate;
mod cost;
mod events;
mod fields;
mod history;
mod limits;
mod query;
mod refresh;
mod solver;
mod state;
mod stepwise;
mod sum;
mod window;

pub use builder::LoadingBuilder;
pub use certificate::Certificate;
pub use history::History;
pub use limits::ContactRule;
pub use solver::{LoadingSolver, LoadingTimings};
pub use state::{ContactEvent, ContactState};
