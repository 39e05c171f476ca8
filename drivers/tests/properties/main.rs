//! What must not matter to a path, and what must always hold along one: random surfaces on every kernel.
//!
//! Here two answers of the library are compared; [`asperity_drivers::paths`] compares one with dense solutions.
//! Properties of single states on the free half-space are those of `tests/paths/path_properties.rs` of the library.
//!
//! `PROPTEST_RNG_SEED` draws other cases.

#![allow(missing_docs)]

mod along;
mod case;
mod invariances;
mod same;
