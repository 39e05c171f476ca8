//! Errors of joints.

use thiserror::Error;

/// Why a joint has no conductance, no stiffness or no table.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum JointError {
    /// The stiffness on further loading is that of the elastic nodes alone, and those that have yielded conduct as
    /// well.
    #[error(
        "{yielded_nodes} of {contact_nodes} nodes in contact have yielded, and the stiffness on unloading, of all nodes in contact, is not \
         known: `add_unloading_stiffness` of the path or of the solver of single loads adds it"
    )]
    NoUnloadingStiffness {
        /// Number of nodes that have yielded.
        yielded_nodes: usize,
        /// Number of nodes in contact.
        contact_nodes: usize,
    },

    /// Bounds follow from the approach as a function of the load on one elastic shape.
    #[error(
        "bounds of the conductance need an elastic path, and nodes have yielded by state {step}: follow the elastic path of the residual \
         surface, to a load beyond that of interest"
    )]
    BoundsWithYielding {
        /// Number of events up to the first state at which a node has yielded.
        step: usize,
    },

    /// The pressure is no function of the overclosure.
    #[error(
        "at state {step} the {quantity} is {value}, and the table has {interpolated}: the overclosure falls there, under a greater load, by \
         more than the tolerance of {tolerance} allows, so that the law of the interface is no function of it. A path that ends before may have a \
         table"
    )]
    NoFunction {
        /// Number of events up to the state.
        step: usize,
        /// Which column.
        quantity: &'static str,
        /// Its value at the state.
        value: f64,
        /// The value between two rows of the table.
        interpolated: f64,
        /// The tolerance of the table.
        tolerance: f64,
    },
}
