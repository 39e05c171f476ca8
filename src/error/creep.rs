//! Errors of viscoelastic contact.

use thiserror::Error;

/// Why a viscoelastic contact has no answer.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CreepError {
    /// The contact recedes, and no state of the elastic path is that of a later time. `ViscoelasticBed` steps through
    /// such a history.
    #[error(
        "contact recedes from t = {time} s on: the effective load falls from {effective_load} N, and the elastic path has no state \
         for what follows; step the bed through it"
    )]
    ContactRecedes {
        /// When the effective load begins to fall \[s\].
        time: f64,
        /// The effective load there \[N\].
        effective_load: f64,
    },

    /// After it has receded the contact grows again, which the theory of a single unloading does not cover.
    #[error(
        "contact recedes once and grows again from t = {time} s on: this is no single unloading; step the bed through it"
    )]
    ContactReturns {
        /// When it begins to grow \[s\].
        time: f64,
    },

    /// The effective load is beyond the last state of the path.
    #[error(
        "at t = {time} s the effective load is {effective_load} N, but the path ends at {path_ends} N, which is enough until t = {until} s"
    )]
    PathEnds {
        /// The time asked for \[s\].
        time: f64,
        /// The effective load there \[N\].
        effective_load: f64,
        /// The load of the last state of the path \[N\].
        path_ends: f64,
        /// When the effective load reaches it \[s\].
        until: f64,
    },

    /// A bed under a load or at an approach that the path has not reached.
    #[error(
        "at t = {time} s the contact would be larger than that of the last state of the path, whose load is {path_ends} N"
    )]
    BedEnds {
        /// The time of the step \[s\].
        time: f64,
        /// The load of the last state of the path \[N\].
        path_ends: f64,
    },

    /// However short a step of the bed was made, pressures came out negative.
    #[error(
        "the step of the bed from t = {time} s on does not become sound, however short: at {step} s it is not"
    )]
    StepFails {
        /// Where the step begins \[s\].
        time: f64,
        /// The shortest that was tried \[s\].
        step: f64,
    },

    /// The most cycles that were allowed did not lead to the steady one.
    #[error(
        "after {} it is an estimated {distance} to the steady one, relative to the amplitudes, where at most \
         {tolerance} was asked for",
        crate::number::counted(cycles, "cycle")
    )]
    NotSteady {
        /// How many cycles were run.
        cycles: usize,
        /// Estimated [distance](crate::creep::Cycle::distance) from the steady cycle.
        distance: f64,
        /// The distance that was asked for.
        tolerance: f64,
    },

    /// Bodies that flow have no steady cycles: under any mean load the contact grows without end.
    #[error(
        "bodies that flow (fluidity {fluidity} 1/(Pa s)) have no steady cycle: the contact grows for ever"
    )]
    NoSteadyCycle {
        /// Their fluidity \[1/(Pa s)\].
        fluidity: f64,
    },
}
