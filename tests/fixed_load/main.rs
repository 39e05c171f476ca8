//! The fixed-load solver against other solvers' results, against the path, against closed forms, and
//! at extremes.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

#[path = "../common/mod.rs"]
mod common;

mod along_the_path;
#[cfg(feature = "io")]
mod as_data;
mod closed_forms;
mod extremes;
mod hardness;
mod plateaus;
mod problems;
mod references;
mod refusals;
mod sweeps;
mod targets;
mod variants;
