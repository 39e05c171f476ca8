//! The tuned numbers of fixed loads.

// The active set

/// Inner iterations stop when the residual on the contact set is below this part of the worst
/// error in the set itself.
pub(super) const INNER: f64 = 0.5;
/// Where a round has not halved that error, long waves are wrong, which the next round must not
/// leave to the one after it: it has to be so much more exact, down to the least part.
pub(super) const TIGHTENING: f64 = 0.25;
pub(super) const LEAST_INNER: f64 = 0.01;
/// After so many answers that a fresh convolution does not confirm, the tolerance is below rounding.
pub(super) const UNCONFIRMED: usize = 10;
/// Rounding, or tension that was cut off, can spoil an answer so that it is not confirmed: it is asked
/// for again with this part of the tolerance, down to the least part.
pub(super) const STRICTER: f64 = 0.5;
pub(super) const STRICTEST: f64 = 0.125;
/// Nodes join for overlaps above this part of the tolerance: what is smaller is rounding, and nodes
/// would come and go without end.
pub(super) const DEAD_BAND: f64 = 0.1;
/// Rounds without a smaller error in the set after which nodes join one by one. Where contact grows with the load that
/// does not happen; on other bodies whole groups of nodes may come and go without end.
pub(super) const PATIENCE: usize = 20;

// Nodes under tension

/// How often nodes that the correction of others has pulled into tension are set free as well.
pub(super) const PASSES: usize = 3;
/// Steps of conjugate gradients for each correction, and their relative tolerance: it only has to
/// be as good as the preconditioner.
pub(super) const STEPS: usize = 6;
pub(super) const ACCURACY: f64 = 0.03;

// Grids and loads before

/// Tolerance on the coarser grids, whose solutions are only starts, relative to the approach ...
pub(super) const COARSE_TOLERANCE: f64 = 1e-2;
/// ... or to so many rms heights: long waves that are wrong by more are costly on the finest grid.
pub(super) const COARSE_RMS_HEIGHTS: f64 = 10.0;
/// Sides of at most so many nodes are not coarsened further.
pub(super) const COARSEST: usize = 16;
/// Greatest change of the load, as a factor, for which the last state is a better start than the
/// coarser grids. Those begin with an error of 3 % of the approach, a step of 7 % of the load with
/// 0.8 % (512 × 512 nodes, 12 % in contact).
pub(super) const GREATEST_STEP: f64 = 1.25;

// A load that is looked for

/// Steps after which to give up; bisection alone would halve the bracket so often.
pub(super) const MOST_STEPS: usize = 100;
/// Longest step as the logarithm of a load, as long as there is a bound on one side only.
pub(super) const LONGEST: f64 = 1.5;
/// A bracket of loads that is narrower, relative to the load, holds nothing more.
pub(super) const NARROWEST: f64 = 1e-13;
/// Contact area fraction from which to look for a mean gap.
pub(super) const TYPICAL: f64 = 0.05;

// Rounding

/// Rounding of a mean gap, relative to the one without load: of gaps, displacements and their sum.
pub(super) const ROUNDING: f64 = 1e-14;
/// Residuals up to so many roundings of the approach are none.
pub(super) const ROUNDINGS: f64 = 4.0;
/// Least unit of length of a tolerance, relative to the approach: a hundredth of it is still above rounding.
pub(super) const FINEST: f64 = 1e-12;
