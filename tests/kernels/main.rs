//! The kernels of the crate through the public interface.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, missing_docs)]

mod layers;
mod love;
mod periodic;
mod semi_periodic;
