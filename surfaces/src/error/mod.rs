//! Every way in which this crate can refuse an input or fail to answer.

mod file;

use thiserror::Error;

pub use file::FileError;

/// What went wrong, with the numbers that say so.
///
/// Nodes are given by their grid indices `(ix, iy)`; quantities carry the units of the input.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// A grid needs at least one node in each direction.
    #[error("a grid of {nx} x {ny} nodes is empty")]
    EmptyGrid {
        /// Nodes along x.
        nx: usize,
        /// Nodes along y.
        ny: usize,
    },

    /// The grid is larger than any this crate can index.
    #[error("a grid of {nx} x {ny} nodes is too large: at most {max_side} nodes a side")]
    GridTooLarge {
        /// Nodes along x.
        nx: usize,
        /// Nodes along y.
        ny: usize,
        /// Greatest number of nodes along either side.
        max_side: usize,
    },

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

    /// Heights that are NaN or infinite: missing data of a measurement, or an overflow.
    #[error(
        "{}, the first at node ({ix}, {iy}); missing data of a measurement can be filled by `surface::fill_missing`",
        not_finite(*value, *count)
    )]
    HeightNotFinite {
        /// Index of the first along x, in storage order.
        ix: usize,
        /// Its index along y.
        iy: usize,
        /// Its value.
        value: f64,
        /// How many there are.
        count: usize,
    },

    /// A map without a single height that is finite: nothing to fill the others from.
    #[error("none of the {nx} x {ny} heights is finite: there is no surface in them")]
    NothingMeasured {
        /// Nodes along x.
        nx: usize,
        /// Nodes along y.
        ny: usize,
    },

    /// A piece of a map that reaches beyond it.
    #[error("nodes {start} to {end} along {axis} are no part of {nodes} nodes")]
    CropOutOfGrid {
        /// The direction, x or y.
        axis: char,
        /// First node of the piece.
        start: usize,
        /// The node after its last.
        end: usize,
        /// Nodes of the map.
        nodes: usize,
    },

    /// A short cut-off wavelength has less than two nodes on the grid.
    #[error(
        "the short cut-off wavelength {wavelength} is shorter than {shortest}, \
         two cells of the grid"
    )]
    CutoffBelowGrid {
        /// The short cut-off wavelength.
        wavelength: f64,
        /// Shortest wavelength that has two nodes along x and along y.
        shortest: f64,
    },

    /// No wave that is periodic on the grid lies between the cut-offs of a spectrum.
    #[error("no wave of this grid has a wavelength between {shortest} and {longest}")]
    NoWaves {
        /// Short cut-off wavelength.
        shortest: f64,
        /// Long cut-off wavelength, infinite if there is none.
        longest: f64,
    },

    /// A map with too few waves to fit a spectrum to.
    #[error(
        "a fit of the spectrum needs waves of {needed} lengths at least, but there are {found}"
    )]
    TooFewWaves {
        /// Different wavelengths that the map has in the band.
        found: usize,
        /// How many are needed.
        needed: usize,
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

    /// Two grids with as many nodes have different cells.
    #[error(
        "expected cells of {} m x {} m, but found {} m x {} m",
        expected.0, expected.1, found.0, found.1
    )]
    CellMismatch {
        /// Cell sides along x and y that were expected \[m\].
        expected: (f64, f64),
        /// Cell sides along x and y that were found \[m\].
        found: (f64, f64),
    },

    /// A fraction of the nominal area is smaller than a node.
    #[error("an area fraction of {fraction} is less than one node, which is {least}")]
    LessThanOneNode {
        /// The fraction given.
        fraction: f64,
        /// The fraction of one node.
        least: f64,
    },

    /// An iteration did not reach its tolerance.
    #[error(
        "no convergence: relative residual {residual} after {}, tolerance {tolerance}",
        crate::number::counted(iterations, "iteration")
    )]
    NoConvergence {
        /// Smallest relative residual reached.
        residual: f64,
        /// Tolerance asked for.
        tolerance: f64,
        /// Iterations spent.
        iterations: usize,
    },

    /// A file that could not be read or written, or does not say what it should.
    #[error(transparent)]
    File(#[from] FileError),
}

/// What heights are that are no numbers: missing, or infinite, by the first of them.
fn not_finite(first: f64, count: usize) -> String {
    match (first.is_nan(), count) {
        (true, 1) => "1 height is missing".to_string(),
        (true, _) => format!("{count} heights are missing"),
        (false, 1) => format!("1 height is {first}"),
        (false, _) => format!("{count} heights are not finite but {first}"),
    }
}

impl Error {
    /// `Ok(value)` if `value` is positive and finite, the typed error otherwise.
    #[doc(hidden)]
    pub fn require_positive(quantity: &'static str, value: f64) -> Result<f64, Self> {
        let is_positive = value > 0.0 && value.is_finite();
        is_positive.then_some(value).ok_or(Self::NotPositive { quantity, value })
    }

    /// `Ok(value)` if it is as `expected`, the typed error otherwise.
    #[doc(hidden)]
    pub fn require(
        quantity: &'static str,
        value: f64,
        is_so: bool,
        expected: &'static str,
    ) -> Result<f64, Self> {
        is_so.then_some(value).ok_or(Self::OutOfRange { quantity, value, expected })
    }

    /// `Ok(value)` if `value` is finite, the typed error otherwise.
    pub(crate) fn require_finite(quantity: &'static str, value: f64) -> Result<f64, Self> {
        Self::require(quantity, value, value.is_finite(), "finite")
    }
}
