//! Partial slip: against independent solvers, closed forms, and other descriptions of the same joint.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

#[path = "../common/mod.rs"]
mod common;

mod closed_forms;
mod coulomb;
mod elements;
mod histories;
mod joints;
mod reference;
mod refusals;
