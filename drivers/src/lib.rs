//! Drivers: arbitrary bytes in, an answer of the library out, and an independent look at it.
//!
//! Each driver makes an input of bytes, hostile or sensible, asks the library, and checks what it says without the
//! library's help. The same drivers serve a fuzzer (`fuzz` in the repository), which looks for bytes that reach new code,
//! and random tests with seeds (`cargo test`), which need no nightly toolchain.
//!
//! | driver | input | compared with |
//! |---|---|---|
//! | [`paths()`] | a surface on a body; how its path is followed | a dense solution at both ends of every interval |
//! | [`fixed_loads()`] | a surface on a body; loads, approaches, areas, mean gaps | dense gaps, and the path |

mod compare;
mod dense;
mod draw;
mod fixed_loads;
mod kernels;
mod limits;
mod paths;
mod problem;
mod refusal;
mod surfaces;
mod variant;
mod verdict;
mod walk;

pub use fixed_loads::fixed_loads;
pub use paths::paths;
pub use verdict::{Tally, Verdict, Violation};
