//! Adhesion: against other solvers, by all equilibria of small grids, and by what holds of every path.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

mod closed_forms;
mod equilibria;
mod met_exactly;
mod reference_branches;
mod resumed;
mod special;
mod targets;
mod walks;
mod waves;
