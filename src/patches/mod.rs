//! Contact patches, and what the order of contact tells of them: percolation, leakage, activation, distributions.
//!
//! A *patch* is a set of nodes in contact that hang together, across the sides of cells or across corners too
//! ([`Connectivity`]), and across the border of the grid if that is periodic. Nodes join the contact
//! one by one, so that the order in which they do holds the patches of *every* state:
//!
//! | question | answer |
//! |---|---|
//! | how many patches, how large, how long their edges, at every state | [`PatchHistory`] |
//! | the contact area without the error of whole cells | [`Perimeter::corrected_area`], [`ContactEdge`] |
//! | when does contact percolate, when does the gap seal | [`Percolation`] |
//! | where is a channel through one state narrowest | [`constriction`] |
//! | which patch came from where, and merged into which | [`MergeTree`] |
//! | each patch of one state: place, area, load, pressures | [`Patches`] |
//! | at which load did each node touch | [`activation_map`] |
//! | how many patches of an area or load | [`Histogram`] |
//! | how often does a pressure or a gap occur | [`pressure_distribution`], [`gap_distribution`] |
//!
//! ```
//! use asperity::loading::History;
//! use asperity::patches::{Connectivity, PatchHistory, Percolation};
//! use asperity::{Grid, InfluenceKernel, LoadingSolver, PeriodicBoussinesq, SelfAffine};
//!
//! # fn main() -> Result<(), asperity::Error> {
//! let half_space = PeriodicBoussinesq::new(Grid::square(32, 1.25e-3)?, 115e9)?;
//! let mut path = LoadingSolver::builder(&SelfAffine::zhang2020(1), &half_space).build()?;
//! let history = path.run()?;
//! let contact = history.contact_sequence(path.grid())?;
//!
//! let boundary = half_space.boundary();
//! for (patches, state) in PatchHistory::new(&contact, boundary, Connectivity::Four).zip(history.states()) {
//!     println!("{} patches under {} N", patches.patches, state.contact.load);
//! }
//! let percolation = Percolation::of(&contact, boundary, Connectivity::Eight);
//! println!("no channel along x from {:?} nodes on", percolation.seal_x);
//! # assert!(percolation.seal_x.is_some());
//! # Ok(())
//! # }
//! ```
//!
//! # Nodes that leave
//!
//! With a kernel that lets nodes leave the contact there is no order of contact: a patch that loses a node may fall
//! into several, which neither disjoint sets nor a tree of mergers can follow, and a channel that was closed may open
//! again. [`History::contact_sequence`](crate::loading::History::contact_sequence) refuses such a path rather than give half an answer. Single states are answered all
//! the same: [`Patches`] takes any contact map, and [`ContactEdge`] follows nodes that leave.
//!
//! # Cost
//!
//! Everything that follows a path does so in O(n α(n)), with α the inverse Ackermann function, at most 4.
//! On a grid of 512 × 512 nodes, in random order to full contact, each of [`PatchHistory`], [`Percolation`] and
//! [`MergeTree`] takes 0.1 to 0.2 s.

mod activation;
mod connectivity;
mod constriction;
mod distribution;
mod edge;
mod forest;
mod histogram;
mod history;
mod labels;
mod lattice;
mod merge_tree;
mod percolation;
mod perimeter;
#[cfg(test)]
mod tests;

pub use activation::activation_map;
pub use connectivity::Connectivity;
pub use constriction::{Constriction, constriction};
pub use distribution::{FieldDistribution, gap_distribution, pressure_distribution};
pub use edge::ContactEdge;
pub use histogram::{Bins, Histogram};
pub use history::{PatchEvent, PatchHistory, PatchState};
pub use labels::{Patch, PatchLoad, Patches};
pub use merge_tree::{Branch, MergeTree, Merger};
pub use percolation::Percolation;
pub use perimeter::Perimeter;
