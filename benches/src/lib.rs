//! What the benches share.

use std::fmt::Display;

/// The value of a result. Criterion takes no errors, and what fails must not be reported as fast.
///
/// # Panics
///
/// On an error, with its words.
pub fn succeed<T, E: Display>(result: Result<T, E>) -> T {
    result.unwrap_or_else(|error| unreachable!("{error}"))
}
