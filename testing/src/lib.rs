//! What tests, drivers and benches of this repository have in common. It uses the public interface of the library
//! alone.
//!
//! | module | content |
//! |---|---|
//! | [`altered`] | an updater some of whose answers are changed by closures |
//! | [`bordering`] | an updater with the three verbs that every path needs |
//! | [`dense`] | influence matrices, and dense solutions that share no code with the library |
//! | [`equilibria`] | all equilibria of a few nodes that stick |
//! | [`page`] | tables of pages in Markdown |
//! | [`report`] | what stands in the page of a path |
//! | [`surfaces`] | heights of rough surfaces |
//! | `random` | random surfaces for property tests (feature `proptest`) |
//! | [`table`] | tables of reference data |
//! | [`close`] | differences of numbers and of states |

// A test that cannot go on has failed.
#![allow(clippy::unwrap_used)]

pub mod altered;
pub mod bordering;
pub mod close;
pub mod dense;
pub mod equilibria;
pub mod page;
#[cfg(feature = "proptest")]
pub mod random;
pub mod report;
pub mod surfaces;
pub mod table;

pub use altered::{Altered, Call};
