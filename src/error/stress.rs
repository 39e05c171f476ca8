//! Errors of stresses below the surface.

use thiserror::Error;

/// Stresses that are not to be had.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum StressError {
    /// Nothing presses on the surface, or no depth is asked for.
    #[error(
        "there is no stress to survey: nothing presses on the surface, or no depth is asked for"
    )]
    NoLoad,
}
