//! User-defined parts, and parts chosen at run time, by the public interface alone.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

mod parts;
mod paths;
mod run_time;
