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

    /// A depth in a rigid base, which has no stress of its own.
    #[error("a depth of {depth} m is in the rigid base, below layers of {thickness} m")]
    InRigidBase {
        /// The depth \[m\].
        depth: f64,
        /// Thickness of all layers \[m\].
        thickness: f64,
    },

    /// Behind the first node that yields at its hardness stresses do not grow steadily, and at the end of the path they
    /// are below the yield stress.
    #[error(
        "von Mises' stress is {reached} Pa at the load of {load} N, where the first node yields at its hardness, and below \
         {yield_stress} Pa at the end of the path. In between it may have been above: look at stresses of single states"
    )]
    BehindHardness {
        /// The yield stress that was asked for \[Pa\].
        yield_stress: f64,
        /// The load at which the first node yields \[N\].
        load: f64,
        /// The greatest von Mises stress there \[Pa\].
        reached: f64,
    },

    /// Not one yield stress for each layer and the base.
    #[error(
        "the body has {materials} materials from the uppermost layer to the base, and {given} yield stresses are given"
    )]
    YieldStresses {
        /// How many are given.
        given: usize,
        /// How many there should be.
        materials: usize,
    },
}
