//! What iterations go on from at the end of a window, as plain numbers.

/// Everything on which later answers of iterations depend, besides the problem and the contact: whoever
/// [restores](super::Iterations::restore) it gets the same answers, bit for bit.
///
/// Left out is what follows from this: the sparse part of the preconditioner and the local solutions, which are
/// functions of the contact; displacements of search directions; and what a window makes for itself alone, the solution
/// where it began and its instants.
///
/// Values on the contact are in the order of the indices of its nodes.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Kept {
    /// Greatest gap in contact that solutions leave, relative to the approach.
    pub tolerance: f64,
    /// The approach of the solution, and how far the approach may go on with its rate \[m\].
    pub approach: f64,
    pub serves: f64,
    /// Pressures \[Pa\], and their rates.
    pub load: KeptField,
    pub rate: KeptField,
    /// The nodes that were proposed last, how many of those in contact then are left, and what that left of their row
    /// sums: with them the path follows row sums, and improves solutions.
    pub proposed: Vec<usize>,
    pub proposed_beside: usize,
    pub row_sums: Vec<f64>,
    /// Row sums with the contact eliminated, unless the half-space is periodic: for how many nodes they were solved,
    /// the solution, and the start of the next one on the contact. They are solved for when they are stale, so that
    /// they depend on the windows before.
    pub sums_of: usize,
    pub sums: KeptField,
    pub sums_start: Vec<f64>,
    /// The search directions of the last solution, which serve the row sums as well; with the number of those that are
    /// kept for that, and of those that are not looked back at.
    pub directions: Vec<Vec<f32>>,
    pub marks: [usize; 2],
    /// The contact for which the coarse matrix of the preconditioner was computed: it serves until enough has changed.
    pub coarse: Vec<usize>,
    /// Where nodes in contact were proposed as well, or nodes have yielded.
    pub beside: Option<KeptBeside>,
}

/// What iterations go on from beside nodes that have yielded.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct KeptBeside {
    /// How many of the proposed nodes, the first ones, were out of contact.
    pub outside: usize,
    /// The nodes that have yielded since they were proposed, and their pressures \[Pa\].
    pub yielded: Vec<usize>,
    pub pressures: Vec<f64>,
    /// What sums over all nodes answer on the contact and these nodes, by node index: gaps out of contact, plastic
    /// depths, and these times the hardness.
    pub sums: [KeptField; 3],
    /// The displacements that these belong to: under a pressure of 1 on all nodes that had yielded then \[m/Pa\], and
    /// under their hardness \[m\].
    pub under: [Vec<f64>; 2],
}

/// Pressures on the contact, the displacements of all nodes, and their error by single precision.
///
/// Displacements do not follow from pressures bit for bit: they have been followed from one solution to the next.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct KeptField {
    pub pressure: Vec<f64>,
    /// Empty if it is not known.
    pub displacement: Vec<f64>,
    pub drift: f64,
}
