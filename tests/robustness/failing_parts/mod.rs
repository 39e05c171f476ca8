//! User-defined parts that work, but for one call: at the k-th call an error, a panic or a wrong answer, for every k of
//! a small path.
//!
//! The oracle of what was yielded before is the same path without a fault, bit for bit. What is yielded after a wrong
//! answer is compared with a solver of the linear complementarity problem that knows nothing of paths.

mod kernels;
mod lies;
mod panics;
mod problems;
mod questions;
mod refusals;
mod updater;
mod yielding;
