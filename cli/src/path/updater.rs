//! What solves on the contact of a path.

use asperity::updater::{ConjugateGradient, Handover, LinearUpdater, RecursiveCholesky};
use asperity::{Boundary, Error, LoadingSolver};
use clap::ValueEnum;

use crate::room;
use asperity_cli::outcome::Failure;

/// The updater on the command line.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum Updater {
    /// A Cholesky factor while it is faster, then iterations
    Auto,
    /// A Cholesky factor: states are exact to rounding; memory grows with the square of the number of nodes in contact
    Cholesky,
    /// Iterations from the first node on; memory is proportional to the grid
    Iterative,
}

impl Updater {
    pub(super) fn make(self) -> Box<dyn LinearUpdater> {
        match self {
            Self::Auto => Box::new(Handover::new()),
            Self::Cholesky => Box::new(RecursiveCholesky::new()),
            Self::Iterative => Box::new(ConjugateGradient::new()),
        }
    }
}

/// What there is no room for, with the largest grid for which there is; with a factor alone that depends on where the
/// path ends.
pub(super) fn no_room(
    what: String,
    error: Error,
    (updater, boundary, budget): (Updater, Boundary, Option<usize>),
) -> Failure {
    match updater {
        Updater::Cholesky => Failure::new(what, error),
        Updater::Auto | Updater::Iterative => room::failure(what, error, |grid| {
            LoadingSolver::check_room_to_full_contact(grid, boundary, budget)
        }),
    }
}
