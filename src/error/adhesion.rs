//! Errors of adhesion.

use asperity_surfaces::number::quantity;
use thiserror::Error;

use super::units::with_unit;

/// A law of adhesion that the mesh does not resolve, or a path on which it is not derived.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum AdhesionError {
    /// The slope of the law is too steep for the cells: single nodes would snap where the surface does not.
    #[error(
        "the slope of the cohesive law times the compliance of a cell is {resolution:.3}, and may be {greatest} at \
         most: single nodes would snap. It takes cells of {} instead of {}, or a longer range of adhesion",
        quantity(*cell_needed, "m", 3), quantity(*cell, "m", 3)
    )]
    Unresolved {
        /// Slope times C(0, 0).
        resolution: f64,
        /// The greatest that is allowed.
        greatest: f64,
        /// Long side of a cell \[m\].
        cell: f64,
        /// Long side of a cell that would do \[m\].
        cell_needed: f64,
    },

    /// The outer border of Maugis' law is a slope as wide as the cells need, and there is no room for it.
    #[error(
        "a cohesive stress of {} acts over a range of {} only, and the slope at its end takes {} on cells of {}: it \
         takes cells of {}, or the law without a stress, which is as short as the cells allow",
        quantity(*stress, "Pa", 3), quantity(*range, "m", 3), quantity(*slope, "m", 3), quantity(*cell, "m", 3),
        quantity(*cell_needed, "m", 3)
    )]
    NoRoomForSlope {
        /// The cohesive stress \[Pa\].
        stress: f64,
        /// Work of adhesion over stress \[m\].
        range: f64,
        /// Half the width of the slope, which must not exceed it \[m\].
        slope: f64,
        /// Long side of a cell \[m\].
        cell: f64,
        /// Long side of a cell that would do \[m\].
        cell_needed: f64,
    },

    /// Adhesion on a body of which nothing is known.
    #[error(
        "adhesion needs a body on which contact is known to grow without it: on this one, as under a stiff layer, a \
         pull in one place may open a gap in another, and loading and unloading have no branches that do not depend \
         on the order of nodes"
    )]
    GrowthUnknown,

    /// A branch that was not asked for from a state on it.
    #[error(
        "the {quantity} at which the branch is to end is {}, and the path is at {} already",
        with_unit(quantity, *value), with_unit(quantity, *present)
    )]
    Behind {
        /// Which quantity.
        quantity: &'static str,
        /// Where the branch is to end.
        value: f64,
        /// Where the path is.
        present: f64,
    },

    /// Nodes beyond those that were expected change at once, however few events are followed together.
    #[error(
        "at approach {approach} m node ({ix}, {iy}) is beyond its law by {value} of its range or stress after one \
         event: the kernel is too ill-conditioned, or breaks the growth of contact that it promises"
    )]
    NotOnLaw {
        /// Node index along x.
        ix: usize,
        /// Node index along y.
        iy: usize,
        /// Approach, in the gauge of the kernel.
        approach: f64,
        /// By how much: a gap relative to the range, a pressure in contact to the stress.
        value: f64,
    },

    /// Changes of nodes that no path has: in a record that was changed afterwards.
    #[error("what happens to nodes up to state {step} is not what happens on a path with adhesion")]
    WrongChanges {
        /// Number of the state.
        step: usize,
    },

    /// The record of a path with adhesion in place of one whose contact only grows.
    #[error(
        "{} is the record of a path with adhesion, whose nodes are pulled and part again: patches, leaks, stresses, slip \
         and creep are made of contact that only grows and presses. `AdhesiveRecord` reads it", path.display()
    )]
    Record {
        /// The file.
        path: std::path::PathBuf,
    },
}
