//! Paths against closed forms of the continuum, and the orders in which they converge.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

mod formulas;
mod plane;
mod shapes;
mod westergaard;
