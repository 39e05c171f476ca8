//! Errors of tangential loading.

use thiserror::Error;

/// A tangential load that friction does not bear, or one that leaves the displacement unknown.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SlipError {
    /// The tangential load exceeds what friction bears.
    #[error(
        "the joint slides: friction bears a tangential load of {limit} N under the load {load} N, and {tangential_load} N is asked for"
    )]
    JointSlides {
        /// Tangential load asked for \[N\].
        tangential_load: f64,
        /// Load P \[N\].
        load: f64,
        /// `μP` \[N\].
        limit: f64,
    },

    /// The tangential load stays at the limit of friction while the load changes: any displacement is possible.
    #[error(
        "the joint slides all the way from the load {from} N to {to} N: the tangential load stays at the limit of friction, and the \
         displacement is not determined"
    )]
    StaysAtLimit {
        /// Load at the beginning of the step \[N\].
        from: f64,
        /// Load at its end \[N\].
        to: f64,
    },

    /// The change of the approach over the slip zone is not far above the error of the path.
    #[error(
        "the approach changes by {change} m over the slip zone, and the path has it with an error of {approach_error} m: that is \
         too much for the dissipation"
    )]
    WithinPathError {
        /// Change of the approach \[m\].
        change: f64,
        /// Estimated error of the approach \[m\].
        approach_error: f64,
    },
}
