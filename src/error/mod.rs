//! Every way in which this crate can refuse an input or fail to answer.

mod adhesion;
mod bed;
mod creep;
mod joint;
mod kernel;
mod slip;
mod stress;
mod units;
mod updater;

use asperity_surfaces::number::{counted, quantity};
use asperity_surfaces::{Error as SurfaceError, FileError};
use thiserror::Error;

pub use adhesion::AdhesionError;
pub use bed::BedError;
pub use creep::CreepError;
pub use joint::JointError;
pub use kernel::KernelError;
pub use slip::SlipError;
pub use stress::StressError;
use units::with_unit;
pub use updater::UpdaterError;

/// What went wrong, with the numbers that say so.
///
/// Nodes are given by their grid indices `(ix, iy)`, quantities in SI units.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// A quantity that must be positive and finite is not.
    #[error("{quantity} must be positive and finite, but is {value}")]
    NotPositive {
        /// Name of the quantity.
        quantity: &'static str,
        /// The value given.
        value: f64,
    },

    /// A quantity lies outside its admissible range.
    #[error("{quantity} must be {expected}, but is {value}")]
    OutOfRange {
        /// Name of the quantity.
        quantity: &'static str,
        /// The value given.
        value: f64,
        /// The admissible range, in words.
        expected: &'static str,
    },

    /// A pressure or another field given by the caller is NaN or infinite.
    #[error("the {field} at node ({ix}, {iy}) is {value}, which is not finite")]
    FieldNotFinite {
        /// Which field.
        field: &'static str,
        /// Node index along x.
        ix: usize,
        /// Node index along y.
        iy: usize,
        /// The value.
        value: f64,
    },

    /// Two fields that belong together have different numbers of nodes.
    #[error(
        "expected {} x {} nodes, but found {} x {}",
        expected.0, expected.1, found.0, found.1
    )]
    GridMismatch {
        /// Nodes along x and y that were expected.
        expected: (usize, usize),
        /// Nodes along x and y that were found.
        found: (usize, usize),
    },

    /// A buffer has the wrong length.
    #[error("expected {expected} values, but found {found}")]
    LengthMismatch {
        /// Expected number of values.
        expected: usize,
        /// Number of values found.
        found: usize,
    },

    /// A node index lies outside the grid.
    #[error("node {node} lies outside a grid of {nodes} nodes")]
    NodeOutOfGrid {
        /// The node index.
        node: usize,
        /// Number of nodes in the grid.
        nodes: usize,
    },

    /// Influence coefficients that no elastic body has.
    #[error(transparent)]
    Kernel(#[from] KernelError),

    /// The kernel is not positive definite on the contact: no elastic body answers like this.
    #[error(
        "the kernel is not positive definite: at approach {approach} m node ({ix}, {iy}) would give \
         the pivot {pivot} m/Pa"
    )]
    NotPositiveDefinite {
        /// Node index along x.
        ix: usize,
        /// Node index along y.
        iy: usize,
        /// Approach at which the node would have joined \[m\].
        approach: f64,
        /// The pivot (a Schur complement), which must be positive \[m/Pa\].
        pivot: f64,
    },

    /// A quantity of a state over- or underflows: the units of the input are too far apart.
    #[error(
        "state {step} is not finite: heights, cells and modulus are too far apart for double \
         precision; choose other units"
    )]
    NotFinite {
        /// Number of the state.
        step: usize,
    },

    /// A number of a state that was read or handed over is missing or infinite.
    #[error("at step {step} the {quantity} is {value}, which no state has")]
    RecordNotFinite {
        /// Number of events up to the state.
        step: usize,
        /// The quantity.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },

    /// A number of a state does not follow from the states before, so that it was changed afterwards.
    #[error("at step {step} the {quantity} is {value:e}, but {expected:e} {reason}")]
    Inconsistent {
        /// Number of events up to the state.
        step: usize,
        /// The quantity.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// The value that it should have, or may have at most or at least.
        expected: f64,
        /// Why it should.
        reason: &'static str,
    },

    /// A state that does not lie on the path: one of another path, or one that was extrapolated beyond the
    /// interval between two events in which it would be a state.
    #[error(
        "the state of load {load} N at approach {approach} m does not lie on this path: at step {step} the \
         {quantity} there is {}, but should be {expected}",
        with_unit(quantity, *value)
    )]
    NotOnPath {
        /// Number of events up to the state.
        step: usize,
        /// Load of the state \[N\].
        load: f64,
        /// Approach of the state \[m\].
        approach: f64,
        /// The quantity that contradicts.
        quantity: &'static str,
        /// Its value on this path.
        value: f64,
        /// The value that a state has.
        expected: &'static str,
    },

    /// A load under which all nodes would have yielded.
    #[error(
        "a mean pressure of {} ({}) is beyond what the surface bears: all nodes yield at their hardness, {} on average, and the mean \
         pressure stays below it",
        quantity(*mean_pressure, "Pa", 4),
        quantity(*load, "N", 4),
        quantity(*hardness, "Pa", 4)
    )]
    BeyondHardness {
        /// Load asked for \[N\].
        load: f64,
        /// The same over the nominal area \[Pa\].
        mean_pressure: f64,
        /// Mean hardness of the nodes \[Pa\].
        hardness: f64,
    },

    /// A record of a path on a kernel that is not one of this crate.
    #[error("the path was on a kernel that is not one of this crate: it has to be given")]
    ForeignKernel,

    /// A kernel that is not the one of a record.
    #[error(
        "this is not the kernel of the record: one of its coefficients is {found} and not {expected} m/Pa"
    )]
    WrongKernel {
        /// The coefficient on record \[m/Pa\].
        expected: f64,
        /// That of the kernel given \[m/Pa\].
        found: f64,
    },

    /// A record with other surroundings of the grid than its kernel has.
    #[error("the record says that its boundary is {found}, but that of its kernel is {expected}")]
    WrongBoundary {
        /// The name of that of the kernel.
        expected: String,
        /// That on record.
        found: String,
    },

    /// A path that ended with an error cannot go on.
    #[error("the path ended with an error after {}, and cannot go on", counted(steps, "event"))]
    CannotContinue {
        /// Number of events up to there.
        steps: usize,
    },

    /// A state was asked for that the path has not reached.
    #[error("state {step} was asked for, but the path has reached {present}")]
    StateNotReached {
        /// Number of the state asked for.
        step: usize,
        /// Number of the present state.
        present: usize,
    },

    /// The influence matrix of the contact set could not be factored.
    #[error("the influence matrix of {nodes} contact nodes is not numerically positive definite")]
    FactorizationFailed {
        /// Number of contact nodes.
        nodes: usize,
    },

    /// A pressure, a gap or one of their rates has a sign that it cannot have: the kernel breaks what it promises of the
    /// growth of contact, or it is too ill-conditioned.
    #[error(
        "contact cannot go on with this kernel: at approach {approach} m the {quantity} of node ({ix}, {iy}) is {}",
        with_unit(quantity, *value)
    )]
    NotMonotone {
        /// The quantity with the wrong sign.
        quantity: &'static str,
        /// Node index along x.
        ix: usize,
        /// Node index along y.
        iy: usize,
        /// Approach at which it was noticed \[m\].
        approach: f64,
        /// The offending value.
        value: f64,
    },

    /// A node was to join the contact while being in it.
    #[error("node ({ix}, {iy}) is in contact already")]
    AlreadyInContact {
        /// Node index along x.
        ix: usize,
        /// Node index along y.
        iy: usize,
    },

    /// A node was to leave the contact without being in it.
    #[error("node ({ix}, {iy}) is not in contact, and cannot leave it")]
    NotInContact {
        /// Node index along x.
        ix: usize,
        /// Node index along y.
        iy: usize,
    },

    /// An order of contact was asked for, and a node leaves: from there on nodes have none.
    #[error(
        "event {event}: node ({ix}, {iy}) leaves the contact, which then has no order of contact; \
         look at single states instead"
    )]
    NodeLeaves {
        /// Node index along x.
        ix: usize,
        /// Node index along y.
        iy: usize,
        /// Number of the event, from 1 on.
        event: usize,
    },

    /// Nodes touch and leave at one approach without end: they do so together, and what tells them
    /// apart lies below the rounding errors.
    #[error("{events} events at the approach {approach} m, and no end of them")]
    Cycling {
        /// The approach \[m\].
        approach: f64,
        /// Number of events there.
        events: usize,
    },

    /// An approach that a periodic half-space takes at no load, or at any large enough one: its mean
    /// planes approach by no more than the mean initial gap.
    #[error(
        "the mean planes of a periodic half-space approach by less than the mean initial gap of \
         {mean_gap} m before full contact and by no more after it, not by {approach} m"
    )]
    ApproachNotReached {
        /// The approach asked for \[m\].
        approach: f64,
        /// The mean initial gap \[m\], which is that of full contact.
        mean_gap: f64,
    },

    /// The memory budget would be exceeded by going on.
    #[error(
        "{} of memory are needed, but the budget is {}, which is enough for {} in contact",
        bytes(*needed, *budget), bytes(*budget, *needed), counted(nodes_that_fit, "node")
    )]
    MemoryBudget {
        /// Bytes needed to go on.
        needed: usize,
        /// Bytes allowed.
        budget: usize,
        /// Contact nodes for which the budget is enough.
        nodes_that_fit: usize,
    },

    /// An iteration did not reach its tolerance.
    #[error(
        "no convergence: relative residual {residual} after {}, tolerance {tolerance}",
        counted(iterations, "iteration")
    )]
    NoConvergence {
        /// Smallest relative residual reached.
        residual: f64,
        /// Tolerance asked for.
        tolerance: f64,
        /// Iterations spent.
        iterations: usize,
    },

    /// An updater that cannot do what the path needs, or answers something else.
    #[error(transparent)]
    Updater(#[from] UpdaterError),

    /// A path whose increments cannot be superposed, or that ends before what is asked of it.
    #[error(transparent)]
    Bed(#[from] BedError),

    /// Adhesion that the mesh does not resolve, or that is not derived.
    #[error(transparent)]
    Adhesion(#[from] AdhesionError),

    /// A viscoelastic contact that has no answer.
    #[error(transparent)]
    Creep(#[from] CreepError),

    /// A tangential load that friction does not bear.
    #[error(transparent)]
    Slip(#[from] SlipError),

    /// Stresses below the surface that are not to be had.
    #[error(transparent)]
    Stress(#[from] StressError),

    /// A theory of homogeneous half-spaces on a body with layers.
    #[error("{asked} is asked for of a body with layers, and {reason}")]
    NotHomogeneous {
        /// What was asked for.
        asked: &'static str,
        /// Why it is none there, and what would be right.
        reason: &'static str,
    },

    /// A joint without a conductance, a stiffness or a table.
    #[error(transparent)]
    Joint(#[from] JointError),

    /// A surface, a grid or a map that is not what it should be.
    #[error(transparent)]
    Surface(SurfaceError),

    /// A file that could not be read or written, or does not say what it should.
    #[error(transparent)]
    File(#[from] FileError),
}

/// Arguments that both crates check are refused alike, whichever of them does it; files are [`Error::File`] here too.
impl From<SurfaceError> for Error {
    fn from(error: SurfaceError) -> Self {
        match error {
            SurfaceError::NotPositive { quantity, value } => Self::NotPositive { quantity, value },
            SurfaceError::OutOfRange { quantity, value, expected } => {
                Self::OutOfRange { quantity, value, expected }
            }
            SurfaceError::FieldNotFinite { field, ix, iy, value } => {
                Self::FieldNotFinite { field, ix, iy, value }
            }
            SurfaceError::GridMismatch { expected, found } => {
                Self::GridMismatch { expected, found }
            }
            SurfaceError::File(error) => Self::File(error),
            error => Self::Surface(error),
        }
    }
}

/// A number of bytes with a prefix and one digit behind the point, with more if another number would look the same.
fn bytes(bytes: usize, other: usize) -> String {
    let short = |bytes: usize, digits: usize| {
        let units = ["bytes", "kB", "MB", "GB", "TB", "PB", "EB"];
        let mut thousands = 0;
        let mut value = bytes as f64;
        while value >= 999.95 && thousands + 1 < units.len() {
            value /= 1000.0;
            thousands += 1;
        }
        let text = format!("{value:.digits$}");
        let text = text.trim_end_matches('0').trim_end_matches('.');
        format!("{text} {}", units[thousands])
    };
    let digits = (1..9).find(|&digits| short(bytes, digits) != short(other, digits));
    short(bytes, digits.unwrap_or(1))
}

impl Error {
    /// `Ok(value)` if `value` is positive and finite, the typed error otherwise.
    pub(crate) fn require_positive(quantity: &'static str, value: f64) -> Result<f64, Self> {
        Ok(SurfaceError::require_positive(quantity, value)?)
    }

    /// `Ok(value)` if it is as `expected`, the typed error otherwise.
    pub(crate) fn require(
        quantity: &'static str,
        value: f64,
        is_so: bool,
        expected: &'static str,
    ) -> Result<f64, Self> {
        Ok(SurfaceError::require(quantity, value, is_so, expected)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_told_in_numbers_that_can_be_read() {
        let told = |needed, budget| {
            let nodes_that_fit = 3;
            let error = Error::MemoryBudget { needed, budget, nodes_that_fit };
            let told = error.to_string();
            let told = told.replace(" of memory are needed, but the budget is ", " > ");
            told.replace(", which is enough for 3 nodes in contact", "")
        };
        for (needed, budget, expected) in [
            (2, 1, "2 bytes > 1 bytes"),
            (8_076_320, 5_000_000, "8.1 MB > 5 MB"),
            (10_049_329, 10_000_000, "10.05 MB > 10 MB"),
            (999_949, 999, "999.9 kB > 999 bytes"),
            (999_950, 0, "1 MB > 0 bytes"),
            (42_949_672_960, 12_345_678_901, "42.9 GB > 12.3 GB"),
            (5_000_001, 5_000_000, "5.000001 MB > 5 MB"),
            (usize::MAX, 1_000_000_000_000, "18.4 EB > 1 TB"),
        ] {
            assert_eq!(told(needed, budget), expected);
        }
    }
}
