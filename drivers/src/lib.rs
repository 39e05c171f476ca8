//! Drivers: arbitrary bytes in, an answer of the library out, and an independent look at it.
//!
//! Each driver makes an input of bytes, hostile or sensible, asks the library, and checks what it says without the
//! library's help. The same drivers serve a fuzzer (`fuzz` in the repository), which looks for bytes that reach new
//! code, and random tests with seeds (`cargo test`), which need no nightly toolchain.
//!
//! | driver | input | compared with |
//! |---|---|---|
//! | [`paths()`] | a surface on a body; how its path is followed | a dense solution at both ends of every interval |
//! | [`yielding()`] | the same with a hardness | the same, single loads, unloading, a record |
//! | [`adhesion()`] | a surface that sticks to a half-space; a walk of approaches | dense displacements, all equilibria of few nodes, loops, energies |
//! | [`large_contacts()`] | a surface on a half-space, on more nodes | without a factor: the path with one; with one: a dense solution |
//! | [`fixed_loads()`] | a surface on a body; loads, approaches, areas, mean gaps | dense gaps, and the path |
//! | [`large_loads()`] | the same on more nodes of a half-space | the same |
//! | [`parsers()`] | files of heights, hostile ones most of all | what is read after it was written again |
//! | [`records()`] | paths on disk, tampered with | the record before it was written, and dense fields |
//! | [`creep()`] | a viscoelastic contact, and steps of load or approach that come back | dense gaps with a memory of each node, and convolutions |
//! | [`slip()`] | a joint, and steps of both loads that come back | springs with sliders from event to event |

mod adhesion;
mod compare;
mod creep;
mod creep_forms;
mod dense;
mod draw;
mod edits;
mod files;
mod fixed_loads;
mod instants;
mod judge;
mod kernels;
mod large_contacts;
mod limits;
mod parsers;
mod paths;
mod problem;
mod records;
mod refusal;
mod scratch;
mod slip;
mod springs;
mod surfaces;
mod variant;
mod verdict;
mod walk;
mod yielding;

pub use adhesion::adhesion;
pub use creep::creep;
pub use fixed_loads::{fixed_loads, large_loads};
pub use large_contacts::large_contacts;
pub use parsers::parsers;
pub use paths::paths;
pub use records::records;
pub use slip::slip;
pub use verdict::{Tally, Verdict, Violation};
pub use yielding::yielding;

use std::panic::{AssertUnwindSafe, catch_unwind};

/// What makes an input of bytes, and looks at the answer of the library.
pub type Driver = fn(&[u8]) -> Verdict;

/// All drivers by their names, which are those of the fuzz targets as well.
pub const DRIVERS: [(&str, Driver); 10] = [
    ("adhesion", adhesion),
    ("creep", creep),
    ("fixed_loads", fixed_loads),
    ("large_contacts", large_contacts),
    ("large_loads", large_loads),
    ("parsers", parsers),
    ("paths", paths),
    ("records", records),
    ("slip", slip),
    ("yielding", yielding),
];

/// The bytes of hexadecimal digits.
///
/// # Errors
///
/// The text is something else.
pub fn from_hex(text: &str) -> Result<Vec<u8>, Violation> {
    let digits = |k: usize| u8::from_str_radix(text.get(k..k + 2)?, 16).ok();
    let bytes = (0..text.len()).step_by(2).map(digits).collect::<Option<_>>();
    bytes.ok_or_else(|| Violation::new(format!("these are no hexadecimal bytes: {text}")))
}

/// One case of a driver; a panic of the library is a violation as well.
///
/// # Errors
///
/// What is wrong.
pub fn case(driver: Driver, bytes: &[u8]) -> Verdict {
    catch_unwind(AssertUnwindSafe(|| driver(bytes)))
        .unwrap_or_else(|_| Err(Violation::new("the library panicked")))
}
