//! Errors of updaters.

use thiserror::Error;

/// An error of an updater, one of this crate or of the user's.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum UpdaterError {
    /// An updater written outside this crate, or inside, returned something malformed.
    #[error("the updater returned {found} values for {quantity}, but {expected} were expected")]
    UpdaterMismatch {
        /// The quantity returned.
        quantity: &'static str,
        /// Expected number of values.
        expected: usize,
        /// Number of values found.
        found: usize,
    },

    /// An updater answered something else than a dense solution: what `updater::check` reports.
    #[error(
        "the updater is wrong: with {} in contact {quantity} differs from the dense \
         answer by {error}, more than {tolerance}",
        crate::number::counted(contact_nodes, "node")
    )]
    UpdaterWrong {
        /// The quantity compared.
        quantity: &'static str,
        /// Nodes in contact.
        contact_nodes: usize,
        /// Relative difference.
        error: f64,
        /// Greatest difference that is accepted.
        tolerance: f64,
    },

    /// A solution that does not close the contact: its pressures are not those of the nodes in contact. So it is if an
    /// updater is wrong, or has been given wrong events before, and if the kernel is too badly conditioned for it.
    #[error(
        "the updater's solution leaves a {quantity} of {value} at node ({ix}, {iy}) in contact, where rounding \
         is {tolerance} at most"
    )]
    ContactNotClosed {
        /// A gap \[m\], or what is left of its rate.
        quantity: &'static str,
        /// Node index along x.
        ix: usize,
        /// Node index along y.
        iy: usize,
        /// The value, which should be zero.
        value: f64,
        /// Greatest value that counts as rounding.
        tolerance: f64,
    },

    /// More nodes are to be watched than there is memory for.
    #[error("no memory is to be had for the Schur complement of {nodes} watched nodes")]
    TooManyWatched {
        /// Number of nodes.
        nodes: usize,
    },

    /// A node is to leave the contact, and the updater cannot remove nodes.
    #[error("node ({ix}, {iy}) leaves the contact, and this updater cannot remove nodes")]
    ReleaseNotSupported {
        /// Node index along x.
        ix: usize,
        /// Node index along y.
        iy: usize,
    },

    /// The path has a hardness, and the updater does not serve nodes that yield.
    #[error(
        "this updater does not serve a path with a hardness: it takes one that has `watch_both` and `solve_for`"
    )]
    HardnessNotSupported,

    /// The end of a window contradicts its last events, and the updater cannot take nodes back.
    #[error("the last events after {nodes} nodes have to be taken back, and this updater cannot")]
    TruncateNotSupported {
        /// Number of nodes that remain in contact.
        nodes: usize,
    },
}

impl UpdaterError {
    /// `Ok` if an answer has as many values as were asked for.
    pub(crate) fn check_length(
        quantity: &'static str,
        found: usize,
        expected: usize,
    ) -> Result<(), crate::Error> {
        if found == expected {
            return Ok(());
        }
        Err(crate::Error::Updater(Self::UpdaterMismatch { quantity, expected, found }))
    }
}
