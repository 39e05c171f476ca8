//! Errors of beds of springs.

use thiserror::Error;

use super::units::with_unit;

/// A path that is no bed of springs, or a state that it does not reach.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BedError {
    /// A path without states.
    #[error("the path has no state: it has no increments to make anything of")]
    Empty,

    /// A path that does not begin with first touch.
    #[error(
        "the path begins at the load {load} N and approach {approach} m: its increments are needed from first touch on"
    )]
    NotFromFirstTouch {
        /// Load of the first state \[N\].
        load: f64,
        /// Its approach \[m\].
        approach: f64,
    },

    /// A node leaves the contact, or yields: increments before and after that are not those of elastic contact that
    /// grows.
    #[error(
        "event {event}: node ({ix}, {iy}) {happens}; only the increments of elastic contact that grows can be superposed. {instead}"
    )]
    NotElasticGrowth {
        /// Number of the event, from 1 on.
        event: usize,
        /// Node index along x.
        ix: usize,
        /// Node index along y.
        iy: usize,
        /// What happens to it.
        happens: &'static str,
        /// What is right instead.
        instead: &'static str,
    },

    /// A scalar of a state that is not finite, or changes the wrong way.
    #[error(
        "the {quantity} of state {step} is {} after {}, and should be {expected}",
        with_unit(quantity, *value), with_unit(quantity, *before)
    )]
    NotMonotone {
        /// Number of events up to the state.
        step: usize,
        /// The scalar.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// Its value at the state before.
        before: f64,
        /// What it should be, in words.
        expected: &'static str,
    },

    /// A state of data without a stiffness.
    #[error("state {step} has the stiffness {stiffness:?} N/m, and a positive one is needed")]
    NoStiffness {
        /// Number of events up to the state.
        step: usize,
        /// What there is of it \[N/m\].
        stiffness: Option<f64>,
    },

    /// The path ends before the load or approach asked for.
    #[error(
        "the path ends at the {quantity} {}, before {}",
        with_unit(quantity, *end), with_unit(quantity, *value)
    )]
    PathEndsBefore {
        /// Load or approach.
        quantity: &'static str,
        /// The value asked for.
        value: f64,
        /// The value at the last state.
        end: f64,
    },
}
