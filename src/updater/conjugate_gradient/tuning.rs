//! The tuned numbers of conjugate gradients on a path: value, unit, what a wrong one costs, and how it was chosen.
//!
//! Each was halved and doubled on the four paths that `src/loading/tuning.rs` names; they take 835 (rough), 419
//! (white), 1899 (strip) and 245 (tiled) convolutions. "No effect" means that convolutions, near ties and errors stayed
//! as they were.

// Local solutions

/// Nodes in contact that a local solution takes into account at least, if there are so many in reach. Half: 1.3 times
/// the convolutions on all four, three times the near ties, states two to five times as wrong. Twice: 0.85 of the
/// convolutions (0.46 on the strip) and states three times as good, but the work of a local solution is eight times as
/// much.
pub(super) const NEAREST: usize = 144;
/// Nodes among which they are looked for: those of a circle of 32 square cells, the centre left out. Half or twice: no
/// effect on these grids; on cells ten times as long as wide loads were wrong by 3·10⁻⁴ with far fewer.
pub(super) const CANDIDATES: usize = 3208;
/// The radius in which the search for them begins \[sides of a square cell of the same area\]: it is doubled until
/// there are enough.
pub(super) const REACH: f64 = 32.0;
/// Squared distances that differ by less, relatively, are those of one shell: rounding of a sum of two squares.
pub(super) const SAME: f64 = 1e-9;
/// Products, and look-ups that take as long, of a local solution.
pub(super) const PRODUCTS: usize = NEAREST * NEAREST * NEAREST;
/// Interpolation points along one side of the box of a source seen from afar.
pub(super) const POINTS: usize = 6;
/// Two sources are far from each other if their centres are more than this times the sum of their radii apart.
/// Interpolation of 1/r then errs by some (1/4)⁴ of what is small already. Half: errors exceed their estimates on
/// tiles, loads there are thirty times as wrong. Twice: no effect.
pub(super) const FAR: f64 = 1.3;
/// Instants of a window whose pressures make starts for near ties: its end, and the last ones before. No effect.
pub(super) const MOST: usize = 3;

// When iterations end

/// Residual of the rate, which is 1 in contact, where the solution itself is wanted: rounding.
pub(super) const LEAST_RATE_TOLERANCE: f64 = 1e-11;
/// The same inside a path: over a window of some fifty events, and with the gaps of watched nodes improved, it puts a
/// time off by some 10⁻⁵ of their spacing. Half or twice: stiffnesses of the strip change by a factor of two, nothing
/// else does.
pub(super) const RATE_TOLERANCE: f64 = 1.5e-5;
/// Error of gaps, relative to the span that the approach will go: 10⁻⁴ of the spacing of events. Half: loads of the
/// strip 0.6 times as wrong. Twice: 1.3 times.
pub(super) const OF_SPAN: f64 = 2e-6;
/// And relative to the approach, on which loads depend: near first touch windows are long beside it. Half: 1.05 times
/// the convolutions, and errors of the white and the strip 0.6 times as great. Twice: 0.95 of the convolutions.
pub(super) const OF_LENGTH: f64 = 1e-8;
/// The residual of the rate, relative to the mean closing rate of the gaps, on which the interfacial stiffness rests.
/// No effect on the four paths, even a thousand times as great: it is a bound for contacts whose gaps hardly close.
pub(super) const OF_OPEN: f64 = 1e-3;
/// So many times the tolerance residuals may be where gaps of watched nodes are all that matters: what is
/// left of a residual r changes the gap of node j by `x_jᵀ r`, of which the local solution knows all but a
/// few per cent. Half: 1.07 times the convolutions. Twice: 0.93 of them, but near ties on tiles go from 2 to 35.
pub(super) const ADJOINT: f64 = 30.0;
/// The same at the ends of windows in which nodes yield, relative to that: what is left of a gap in contact is a
/// pressure there, and of nodes that are not watched nothing more is known when these are compared with the hardness.
/// 1: 0.94 of the convolutions, but pressures are off by a part of what they grow by from event to event. 0.3: 0.97.
pub(super) const OF_PRESSURE: f64 = 0.1;
/// Greatest error of displacements by single precision, as a part of the least residual. Half: 1.03 times the
/// convolutions on the strip, 1.01 elsewhere. Twice: 0.985 of them.
pub(super) const DRIFT: f64 = 0.25;
/// Part of it that comes from the rate in a window: it comes again in each. No effect, but for a fortieth of the
/// convolutions on the strip.
pub(super) const RATE_DRIFT: f64 = 0.1;

/// Displacements that were kept may differ from those of their pressures by so many times what solutions leave at
/// worst. They differ by a part of it; what was damaged differs by more. No effect on a path.
pub(super) const UNSPOILT: f64 = 10.0;

// Row sums, for the rate of the mean gap

/// Residual of the row sums relative to the greatest one: the rate of the mean gap, which depends on them, is exact at
/// the ends of windows anyway, and local solutions know nearly all of what a residual leaves. Half: no effect. Twice:
/// 0.97 of the convolutions.
pub(super) const SUMS_TOLERANCE: f64 = 3e-3;
/// The row sums are solved for when one in so many of the nodes in contact, or of those out of it if these are fewer,
/// is new. Until then local solutions tell what new ones near a watched node make of it. On 512², at 47, 79 and 95 %
/// contact, 20: 1.00, 0.96 and 0.96 of the convolutions, but one interfacial stiffness of a whole path moves by 2·10⁻⁴.
/// 200: 1.05, 1.06 and 1.14 times.
pub(super) const STALE: usize = 50;

// Memory

/// Bytes held at most for each node of the grid. Measured on grids from 20 × 20 to 96 × 96: 315 to 470; see
/// `tests/robustness/memory_peaks.rs`.
pub(super) const BYTES_A_NODE: usize = 480;
/// The same in addition for each node in contact: 390 to 800.
pub(super) const BYTES_A_CONTACT_NODE: usize = 1000;
