//! The tuned numbers of fixed loads: value, unit, what a wrong one costs, and how it was chosen.
//!
//! Each was halved and doubled, one at a time, on
//!
//! ```text
//! cargo run --release -p asperity-studies --bin fixed_load_times -- --nodes 128 --nodes 256 --out DIR
//! cargo run --release -p asperity-studies --bin sweep -- --nodes 128 --loads 60
//! ```
//!
//! that is on 16 cold solutions, which take 373 convolutions, and 21.4 on coarser grids in units of those on the
//! finest; and on 60 loads one after the other, which take 1227 with stiffnesses. "No effect" means that these stayed
//! as they were: such a number guards against what these surfaces do not show, and the comment says against what.

// The active set

/// Inner iterations stop when the residual on the contact set is below this part of the worst
/// error in the set itself. Half: no effect. Twice: 1.03 times the convolutions.
pub(super) const INNER: f64 = 0.5;
/// The same where the energy must fall by more than that leaves. No effect.
pub(super) const INNER_DOWNHILL: f64 = 0.01;
/// How often a way down is halved before it ends where the first pressure vanishes. No effect.
pub(super) const MOST_HALVINGS: usize = 10;
/// After so many answers that a fresh convolution does not confirm, the tolerance is below rounding. No effect.
pub(super) const UNCONFIRMED: usize = 10;
/// Rounding, or tension that was cut off, can spoil an answer so that it is not confirmed: it is asked
/// for again with this part of the tolerance. No effect.
pub(super) const STRICTER: f64 = 0.5;
/// Down to this part of the tolerance. No effect.
pub(super) const STRICTEST: f64 = 0.125;
/// Nodes join for overlaps above this part of the tolerance: what is smaller is rounding, and nodes
/// would come and go without end. No effect: it must be well below 1, and is above rounding.
pub(super) const DEAD_BAND: f64 = 0.1;
/// Rounds without a smaller error in the set after which the energy must fall. Half-spaces never have three. On stiff
/// coats whole groups of nodes may come and go without end; 12 loads each on 256² nodes, coats of 8 cells, 30 times as
/// stiff, and of 16, ten times: 2, 5, 10 and 20 rounds take 646, 698, 687 and 642 convolutions, and 324, 322, 325 and 325.
pub(super) const PATIENCE: usize = 20;

// Nodes under tension

/// Steps of conjugate gradients for the correction where nodes under tension are set free. A third: no effect. One
/// step, or the accuracy of one: 1.02 times the convolutions. No correction at all: 1.07 times, and half as many again
/// on coarser grids.
pub(super) const STEPS: usize = 6;
/// Relative tolerance of the correction: it only has to be as good as the preconditioner. Half or twice: no effect.
pub(super) const ACCURACY: f64 = 0.03;

// Grids and loads before

/// Tolerance on the coarser grids, whose solutions are only starts, relative to the approach. Half: 1.16 times the
/// convolutions on coarser grids, none fewer on the finest. Twice: 0.83 of them.
pub(super) const COARSE_TOLERANCE: f64 = 1e-2;
/// Or to so many rms heights: long waves that are wrong by more are costly on the finest grid. Half: 1.08 times the
/// convolutions on coarser grids. Twice: 0.96 of them, two more on the finest.
pub(super) const COARSE_RMS_HEIGHTS: f64 = 10.0;
/// Sides of at most so many nodes are not coarsened further. Half or twice: one convolution in 400.
pub(super) const COARSEST: usize = 16;
/// Greatest change of the load, as a factor, for which the last state is a better start than the coarser grids. Those
/// begin with an error of 3 % of the approach, a step of 7 % of the load with 0.8 % (512 × 512 nodes, 12 % in contact).
/// Half, so that none is: 1.3 times the convolutions of a sweep. Twice: no effect, for its steps are of 12 %.
pub(super) const GREATEST_STEP: f64 = 1.25;

// Nodes that yield

/// Rounds in which nodes are elastic again after which to give up. On random surfaces of few nodes none took more than
/// one.
pub(super) const MOST_RECOVERIES: usize = 100;
/// Where a tolerance does not decide which nodes yield, this part of it may, again and again. Of 20 000 loads and area
/// fractions on random surfaces of 64 to 1024 nodes, within 0.1 to 10⁻⁴ of the approach, ten were not decided at first.
pub(super) const DECIDED: f64 = 0.01;
/// As long as it is looser than this: rounding has a say in the end.
pub(super) const LOOSEST_DECIDED: f64 = 1e-8;

/// The loosest tolerance with which nodes in contact are counted. Within four hundredths of the approach the pressures of
/// the last load, scaled, are a solution under any greater one, and no more nodes touch.
pub(super) const LOOSEST_COUNT: f64 = 1e-3;

/// The part of a load that is rounding: where elastic nodes carry no more, the load is that of a plateau. Sums of 10⁶
/// pressures err by 10⁻¹³.
pub(super) const NO_REST: f64 = 1e-12;

// A load that is looked for

/// Steps after which to give up; bisection alone would halve the bracket so often.
pub(super) const MOST_STEPS: usize = 100;
/// Steps within a bracket after which one halves it, if neither it nor the distance to what is sought has halved: of
/// bodies in full contact that have not begun to yield the approach does not change with the load.
pub(super) const MOST_LAME: usize = 3;
/// Longest step as the logarithm of a load, as long as there is a bound on one side only.
pub(super) const LONGEST: f64 = 1.5;
/// A bracket of loads that is narrower, relative to the load, holds nothing more.
pub(super) const NARROWEST: f64 = 1e-13;
/// Contact area fraction from which to look for a mean gap.
pub(super) const TYPICAL: f64 = 0.05;

// Rounding

/// Rounding of a mean gap, relative to the one without load: of gaps, displacements and their sum.
pub(super) const ROUNDING: f64 = 1e-14;
/// Residuals up to so many units in the last place of the approach are none.
pub(super) const ULPS: f64 = 4.0;
/// Least unit of length of a tolerance, relative to the approach: a hundredth of it is still above rounding.
pub(super) const FINEST: f64 = 1e-12;
