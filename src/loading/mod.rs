//! The loading path: one exact contact state per node that joins, or leaves.
//!
//! Between two events everything is linear in the approach δ: the pressure is `p = y₁ + δ y₂` on the
//! contact, every gap is `r₁ − δ r₂`, and node j touches at `δⱼ = r₁ⱼ / r₂ⱼ`. A path is the sequence of
//! these events. What a kernel promises of its contact ([`ContactGrowth`](crate::ContactGrowth)) decides how
//! they are found:
//!
//! * In *windows*, if contact only ever grows: a δⱼ computed earlier is then a lower bound, and only the nodes
//!   with the smallest ones need be watched until the *horizon*, the smallest bound among all others, is
//!   reached. If bounds may fail, a window is checked at its end.
//! * If nothing is known of the kernel, nodes may *leave*. Windows then end before one does, and are checked at their
//!   ends and at each event; a release has a solution of its own. Every event has one without a factor, as long as
//!   fewer than a hundred nodes are in contact, and with an updater that does not say [what nodes that touch take off
//!   the others](crate::updater::LinearUpdater::relief).
//!
//! With a [hardness](LoadingBuilder::hardness) elastic nodes *yield* as well. `Exact` then watches nodes of both kinds,
//! and checks a window in which nodes yield at its end before the updater learns of it.
//!
//! # How a window is made
//!
//! | | who | what |
//! |---|---|---|
//! | 1 | `Phase` | decides whether the path goes on with its updater, or gives up a factor for iterations |
//! | 2 | `GapField` | solves on the contact and computes all gaps as lines `a − t b` |
//! | 3 | `Exact` | checks them, and chooses the nodes to watch and the horizon |
//! | 4 | [`LinearUpdater`](crate::updater::LinearUpdater) | gives the Schur complement of the watched nodes |
//! | 5 | `Window` | plays the events among them |
//! | 6 | [`ContactSequence`](crate::contact::ContactSequence), the updater | take in the nodes that touched |
//! | 7 | `Exact` | where that is needed, checks the contact at the end, and takes the last events back |
//! | 8 | `PathScalars` | turns the events into states, which wait in a queue |
//! | 9 | [`LoadingSolver`] | yields them up to the limits |
//!
//! # Without a factor
//!
//! With [`ConjugateGradient`](crate::updater::ConjugateGradient), and once the default updater costs more than
//! iterations, Schur complements are nearly exact. `Estimated` then takes the place of `Exact`: it plays a `Window` of
//! such a complement, solves at its end, plays fewer events where that contradicts them, corrects it by that solution,
//! plays the same events a second time, and settles neighbours that are still too close by a solution of their own
//! (`docs/theory.md`, section 11).
//!
//! * *The same events*: the order is that of a factor but for ties, events closer than 10⁻⁹ of the approach or 10⁻¹⁴
//!   of the deepest gap at first touch. On a periodic half-space it is the approach in the gauge that is computed with,
//!   which contains the mean displacement under the load. Nodes that touch together as a window begins join in the
//!   order of their indices at one approach, and are ties as far as the solutions there tell them apart: 10⁻⁸ of that
//!   approach over the rate at which their gaps close.
//! * *The ends of windows*, some fifty events apart, are certified: they are solutions of the contact problem, checked
//!   for tension and overlap. The end of a window also shows how far its Schur complement was from exact. On a periodic
//!   strip of a few rows, where distant contacts matter as much as near ones, windows become shorter, down to one
//!   event. A window whose end, or a solution in it, contradicts what was expected is taken back.
//! * *Between them* states are estimated: [`LoadingState::approach_error`] says how far the approach of an event may be
//!   off; on a periodic half-space this is the approach of the mean planes, as it is reported. Of 196 608 errors
//!   measured on 128 × 128 nodes none exceeds its estimate. On strips of four rows and on incompressible sheets up to
//!   three cells thick one to four in a thousand do, 2.2 times at worst. On square cells loads are wrong by some 10⁻⁷
//!   as a rule and by 10⁻⁵ at worst (on uncorrelated heights 3·10⁻⁵), interfacial stiffnesses by 2·10⁻⁶ and 2·10⁻⁴,
//!   mean gaps by 10⁻⁶ of the initial one. Interfacial stiffnesses are less exact where few nodes are open, whose gaps
//!   hardly close: with one of 441 by 2 %. On cells 10 times as long as wide loads of a periodic half-space are off by
//!   up to 10⁻⁴, and longer ones [are refused](crate::updater::ConjugateGradient::MAX_ASPECT); on a free half-space
//!   cells may be of any shape.
//!
//! With a hardness it does the same with events of both kinds, once a node may yield: its matrices are those of
//! [`LinearUpdater::watch_both`](crate::updater::LinearUpdater::watch_both), from local solutions for nodes that may
//! touch and for nodes that may yield. All that is said above holds for its states, but their estimates are ten times
//! as great, a fiftieth of the mean spacing of events at least: an error of a matrix acts on nodes that touch and on
//! nodes that yield, and at the end of a window both effects may cancel. Nodes that yield together get the approach at
//! which their plastic depths begin, by the solution behind them. Even so estimates are no bounds where few nodes are
//! elastic: with H = 0.05 E\* h′ on 256 × 256 nodes, to the yield of the last, 217 of 131 072 approaches were off by
//! more, 2.3 times at worst; all events were those of the factor, 18 of them in another order within ties.
//!
//! [`ContactRule::ApproximateOrder`] does not settle neighbours that are too close, for speed.
//!
//! # Ties
//!
//! Nodes that touch at once join one by one, in the order of their indices, with a factor and without: so do the nodes
//! that symmetry maps to each other. With a factor nodes touch at once if their gaps are below 10⁻¹³ of the approach
//! when the first of them closes; without one, if their events lie within 10⁻⁹ of the approach.

mod builder;
mod contradiction;
mod cost;
mod estimated;
mod event_cost;
mod exact;
mod factor_log;
mod fields;
mod gap_field;
mod history;
mod limits;
mod path;
mod phase;
mod plastic;
mod ranking;
mod releases;
mod resume;
mod rule;
mod run;
mod scalars;
mod single;
mod snapshot;
mod solver;
mod state;
mod sum;
#[cfg(test)]
mod test_chain;
#[cfg(test)]
#[allow(clippy::panic)]
mod test_complementary;
#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod test_failing_iterations;
mod tolerances;
mod trial;
mod tuning;
mod unloading;
mod walk;
mod window;
mod window_end;

#[doc(hidden)] // for the programs of this repository
pub use crate::memory::default_budget;
pub use builder::LoadingBuilder;
#[cfg(feature = "io")]
pub(crate) use estimated::resumed::EstimatedEnd;
#[doc(hidden)] // for the program and the tests of this repository
pub use event_cost::{factor_seconds, greatest_factor, iteration_seconds, last_factor};
#[cfg(feature = "io")]
pub(crate) use factor_log::FactorLog;
pub use history::History;
pub use limits::LoadingEnd;
pub use path::LoadingPath;
pub(crate) use resume::{Replayed, replay};
pub use rule::ContactRule;
#[doc(hidden)] // for the studies of this repository
pub use run::LoadingTimings;
pub use solver::LoadingSolver;
pub use state::{ContactEvent, LoadingState};
#[cfg(feature = "io")]
pub(crate) use window_end::FactorEnd;
pub(crate) use window_end::NextWindow;
#[cfg(any(test, feature = "io"))]
pub(crate) use window_end::WindowEnd;
