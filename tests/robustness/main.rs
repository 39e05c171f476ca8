//! What must never go wrong: bad input, bad kernels, extreme numbers, too little memory.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

#[path = "../common/mod.rs"]
mod common;

mod bad_input;
mod bad_kernels;
mod dropped;
mod extreme_numbers;
mod failing_parts;
mod hostile_calls;
mod limits;
mod lying_updaters;
mod memory_budget;
#[cfg(feature = "rayon")]
mod memory_peaks;
mod periodic_kernels;
mod small_and_tied;
