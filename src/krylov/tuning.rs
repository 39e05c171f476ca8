//! The tuned numbers of operators, preconditioners and conjugate gradients on a contact set: value, unit, what a wrong
//! one costs, and how it was chosen.
//!
//! Each was halved and doubled, one at a time, on the cold solutions that `src/fixed_load/tuning.rs` names (172 + 105
//! iterations for pressures and stiffnesses), on its sweep (1227 convolutions), and on the four paths that
//! `src/loading/tuning.rs` names (835, 419, 1899 and 245 convolutions). "No effect" means that these stayed as they
//! were.

// Conjugate gradients

/// Error of a displacement in single precision, relative to the greatest, and to the noise that rounding errors of the
/// spectrum come to. Those of several steps are independent of each other, and add up in the square. It is an error,
/// not a choice: a test compares it with that of convolutions.
pub(crate) const SINGLE: f64 = 2e-7;
/// Iterations go on to this part of the tolerance, and displacements are computed afresh once single precision
/// may have spoilt as much of them: together they stay within it. Half: 1.06 times the convolutions of paths.
pub(crate) const MARGIN: f64 = 0.5;
/// Earlier directions to which a new one is made conjugate. One would do in exact arithmetic, and does above rounding:
/// as many convolutions. Below it, where steps in single precision lead nowhere, a solution that is asked for 10⁻¹⁸
/// takes up to ten times the iterations to say so. Four: 1.03 times the iterations for stiffnesses.
pub(crate) const MEMORY: usize = 2;
/// Directions that are kept if they are to serve another right-hand side: the first ones hold the long waves, which
/// right-hand sides have in common. None: 1.2 times the convolutions of paths. Half: 1.02 times. Twice: no effect.
pub(crate) const KEPT: usize = 12;

// The sparse inverse

/// Neighbours on which a node conditions, chosen by time and not by count.
///
/// Without the coarse level of the preconditioner, with which there are fewer iterations: one cold solve to 1e-8 on a
/// 512 × 512 self-affine surface (λ_s = 4 cells), at 3.4, 12.6 and 47 % contact: iterations for the pressure + for the
/// stiffness, all convolutions, and seconds of one thread with everything (some 0.1 s of it synthesis of the surface).
///
/// |  k | 3.4 %               | 12.6 %              | 47 %                |
/// |---:|---------------------|---------------------|---------------------|
/// |  4 | 23 + 23, 55, 0.41 s | 34 + 30, 74, 0.67 s | 56 + 42, 111, 1.39 s |
/// |  8 | 18 + 19, 46, 0.43 s | 25 + 25, 60, 0.62 s | 38 + 36, 85, 1.26 s |
/// | 12 | 16 + 17, 41, 0.40 s | 24 + 23, 56, 0.60 s | 35 + 31, 77, 1.58 s |
/// | 16 | 14 + 15, 37, 0.38 s | 21 + 21, 51, 0.66 s | 30 + 29, 69, 1.65 s |
/// | 32 | 12 + 12, 32, 0.44 s | 17 + 17, 43, 0.99 s | 28 + 24, 62, 3.06 s |
pub(crate) const NEIGHBOURS: usize = 8;
/// If more than one node of so many changes, neighbours are looked for anew at all nodes: only time depends on it.
pub(crate) const MANY: usize = 128;
/// The same if there are so many times as many patterns as when that was last done, and `FEW` more: only memory depends
/// on these.
pub(crate) const GROWTH: usize = 2;
pub(crate) const FEW: usize = 1024;
/// Influences that differ by less may be the same, relative to C(0, 0): well above rounding in single precision.
pub(crate) const SAME_INFLUENCE: f32 = 1e-5;
/// Neighbours are looked for up to so many lattice steps along x and y.
pub(crate) const REACH: isize = 16;

// The coarse space

/// Cells between the knots of hat functions, where cells are square. Half: 0.97 of the iterations for stiffnesses up to
/// 256², and 1.4 times as many on 512² at 1.5 % of full load, where [`MOST`] makes blocks wide. Twice: 1.2 times the
/// iterations.
pub(crate) const SPACING: f64 = 32.0;
/// Hat functions along the longer side at most: the inverse of E is dense. Half: 1.1 times the iterations on 512².
/// Twice: no effect up to there.
pub(crate) const MOST: f64 = 24.0;
/// Hat functions below which there is nothing to be gained. Half: no effect. Twice, so that 128² has none: 1.1 times
/// the iterations.
pub(crate) const FEWEST: usize = 9;
/// Nodes in contact for each hat function below which nothing is gained either. Half: 1.03 times the convolutions of a
/// sweep on 128². Twice: 0.97 of them.
pub(crate) const SPARSE: usize = 16;
/// The diagonal of E is multiplied by the first of these, since hat functions are not the long waves themselves;
/// by the next where E, a sum over aggregates, is not positive definite.
pub(crate) const RIDGES: [f64; 3] = [1.3, 2.0, 4.0];
/// Part of the contact that may change before E is computed anew: at 512 × 512 nodes and 5 to 95 % contact, E of a set
/// without three tenths of the nodes takes as many steps, give or take two. Twice: 1.01 times the convolutions of a
/// sweep.
pub(crate) const STALE: f64 = 0.1;
/// Aggregates that are summed over at the same time, and values of a row that are.
pub(crate) const LANES: usize = 8;
/// Cells of an aggregate a side, on grids of at most `SMALL` nodes and on larger ones: sums over pairs of
/// nodes and over pairs of aggregates take about as long.
pub(crate) const SIDE: usize = LANES;
pub(crate) const LARGE_SIDE: usize = 2 * LANES;
pub(crate) const SMALL: usize = 1 << 19;

// Threads: only time depends on these

/// Values a thread takes at a time: 64 KiB of two vectors.
pub(crate) const CHUNK: usize = 4096;
/// Up to so many values a thread does them alone: sharing would take longer.
pub(crate) const ALONE: usize = 8 * CHUNK;
/// Parts of the grid whose rows are applied at the same time, and of the sums over aggregates.
pub(crate) const PARTS: usize = 8;
/// Nodes in contact that a thread takes at a time, to look for neighbours.
pub(crate) const SEARCH: usize = 256;
/// Nodes whose neighbours are looked for before their patterns are.
pub(crate) const SEARCHED: usize = 1 << 15;
/// Rows that a thread takes at a time: of the grid, to sum over hat functions, and of the inverse of E.
pub(crate) const ROWS: usize = 64;
