//! The tuned numbers of the path: value, unit, what a wrong one costs, and how it was chosen.
//!
//! Those of paths without a factor were halved and doubled, one at a time, on four paths to full contact:
//!
//! ```text
//! cargo run --release -p asperity-studies --bin without_factor -- --nodes 48 --surface rough
//!     --nodes 40 --surface white --half-space periodic
//!     --nodes 200 --ny 2 --surface strip --half-space periodic
//!     --nodes 32 --surface tiled --half-space spectral
//! ```
//!
//! which take 835, 419, 1899 and 245 convolutions. "No effect" means that these, the windows, the near ties and all
//! errors stayed as they were: such a number guards against what these surfaces do not show, and the comment says
//! against what.

// Windows without a factor

/// Nodes watched at a time. Half: 1.46 times the convolutions. Twice: three times the near ties, loads twice as wrong.
pub(super) const WATCHED: usize = 60;
/// The same if near ties are not settled: the error of the order grows with their number.
pub(super) const WATCHED_UNSETTLED: usize = 128;
/// A window watches one node for so many in contact, as long as that is less. Half: 0.97 of the convolutions. Twice:
/// 1.1 times, and errors closer to their estimates.
pub(super) const PART: usize = 4;
/// So many nodes are watched always: what ties with them is watched too, and told apart. Half: 1.05 times the
/// convolutions. Twice: no fewer convolutions, and errors twice as close to their estimates.
pub(super) const FEWEST: usize = 8;
/// Ties with the last watched node are watched too, up to so many times the window. No effect; plateaus with more of
/// them join at one approach, in windows of as many: on 64² nodes stiffnesses among them are off by 2.2·10⁻⁴. Windows
/// of a third: by 4·10⁻⁵, with 2.5 times the convolutions.
pub(super) const MOST_TIES: usize = 3;
/// The window ends at its widest spacing behind this part of its events. Half: 1.2 times the convolutions. 1: a tenth
/// fewer, but windows are taken back, since more of them end between near ties.
pub(super) const CUT: f64 = 0.85;
/// How many windows are tried where nodes may leave before the next event gets a solution of its own. No effect.
pub(super) const MOST_TRIES: usize = 10;
/// Events of a window times the part of a pivot that its Schur complement leaves out: windows have no more. Schur
/// complements of square domains leave out 10⁻³, so that nothing is limited; those of a periodic strip of two rows 0.5,
/// and each event has a solution of its own. Half: loads of the strip 1.3 times as wrong. Twice: a twentieth fewer
/// convolutions there, windows are taken back, and interfacial stiffnesses three times as wrong.
pub(super) const LEFT_OUT: f64 = 0.2;
/// What was left out counts for the next windows too, each time by this part. Half: windows of the strip are taken back
/// ten times as often. It must be below 1: what was left out once would limit all later windows.
pub(super) const REMEMBERED: f64 = 0.8;
/// What the end of a window may change of the times in it on average, over the mean spacing of events: 0.1 at worst on
/// square domains. A window whose end changes more is taken back. No effect: on strips the limit of events comes first.
pub(super) const MOST_CHANGE: f64 = 0.3;
/// Events that the solution at a window's end determines, whatever its Schur complement is: a matter of counting, not
/// tuned.
pub(super) const CERTAIN: usize = 2;
/// The least determinant of `WᵀV`, relative to the product of its diagonal, with which it is inverted: rounding of
/// these products. No effect. The same for the bounds of gaps between the events of a window with a factor.
pub(super) const LEAST_DETERMINANT: f64 = 1e-6;
/// Newton steps to the root of a cubic that is nearly a line. Half or twice: no effect, for they converge
/// quadratically.
pub(super) const NEWTON: usize = 8;

// Windows without a factor where nodes may leave: halved and doubled one at a time on the paths of
// `tests/paths/stiff_coats.rs` but the fourth, and on 128² nodes to 12 % on a coat of one cell, ten times as stiff. All
// events stayed those of single steps with a factor, and approaches within 0.8 of what states say. The paths took 34890
// and 3228 convolutions.

/// Fewer nodes in contact take a solution an event. Half: 0.70 and 0.83 of the convolutions, and approaches 1.8 times
/// as close to what states say on the larger path. Twice: 1.6 and 1.4 times the convolutions.
pub(super) const LEAST_CONTACT: usize = 100;
/// A window goes to this part of the time at which the first node would leave if none touched. Half: 1.14 and 1.01
/// times the convolutions. 0.99: 0.98 and 1.00 times, approaches 1.6 times as close to what states say. 1 leaves no
/// room for the error of a rate.
pub(super) const BEFORE_RELEASE: f64 = 0.9;
/// Nodes that would touch within so many times the span of a window are looked at between its ends. Half: 0.995 of the
/// convolutions on the larger path. Twice: 1.02 times. No effect on the others.
pub(super) const FURTHEST: f64 = 4.0;
/// What the end of a window shows to be missing of a pressure or a gap may be missing in between as well, up to this
/// many times. Half: 0.99 and 0.88 of the convolutions, and approaches 1.3 and 1.5 times as close to what states say.
/// Twice: 1.02 and 1.10 times the convolutions. Nearly 0: 0.99 and 0.64 of them, nearly as if nothing were looked at
/// between the ends. Then 1 of 320 paths has another event, the fourth.
pub(super) const UNCERTAIN: f64 = 1.0;
/// A pressure that falls below this part of what it was, or of what nodes that touched have taken off it, may have
/// fallen to zero. Half or twice: 1.001 times the convolutions at most.
pub(super) const NEARLY_LEFT: f64 = 0.05;

// Near ties: the error of a time is estimated as the greatest of

/// this many times the difference of the two corrections, by the Schur complement and by cubics. Half: fewer near ties,
/// and errors of the strip closer to their estimates. Twice: on the strip five times the near ties.
pub(super) const BETWEEN_CORRECTIONS: f64 = 2.0;
/// this part of what the correction changed, for this event and on average. Half: a fifth fewer near ties, and errors
/// 1.7 times as close to their estimates. Twice: twice the near ties, a tenth more convolutions.
pub(super) const OF_CHANGE: f64 = 0.1;
/// the same if the Schur complement could not be updated. Half: errors of the strip 1.6 times as close to their
/// estimates. Twice: no effect.
pub(super) const OF_CHANGE_UNCORRECTED: f64 = 0.5;
/// this part of the mean spacing of events. Half: errors up to 1.7 times as close to their estimates. Twice: a third
/// more near ties on the strip.
pub(super) const OF_SPACING: f64 = 1e-3;
/// The same of a window in which nodes yield as well: what pressures of nodes that touched and overlaps of nodes that
/// yielded make of the error of a matrix may cancel at the window's end, and not before. On the four paths of
/// `tests/paths/hardness_without_factor.rs` and on 128² errors come to 0.64 of their estimates; with H = 0.05 E* h′ on
/// 256², 0.2 % of them exceed these, by 2.3 times at worst. Half: to 1.01 of them, a twentieth fewer convolutions.
/// Twice: a twentieth more.
pub(super) const OF_SPACING_OF_BOTH: f64 = 1e-2;
/// To this comes what closing rates may be off by, over the rate. Half or twice: a twentieth of the near ties fewer or
/// more.
pub(super) const RATE_ERROR: f64 = 5e-7;
/// An error above this part of the approach is settled by a solution wherever the neighbours are. Half: five times the
/// near ties on the strip. Twice: a third of them.
pub(super) const POOR: f64 = 1e-3;
/// The first solution of a near tie is solved to this part of the estimated errors. Half: the same number of them, each
/// with more iterations. Twice: a sixth more solutions, since the first one settles less.
pub(super) const OF_ERROR: f64 = 0.04;
/// After a solution, errors grow with the way from it by this part. No effect: runs of near ties are short.
pub(super) const OF_WAY: f64 = 0.05;
/// Closing rates of nodes that symmetry maps to each other differ by less than this part. No effect of this and the
/// next one: they keep nodes apart that touch together by chance.
pub(super) const SAME_RATE: f64 = 2e-5;
/// The same of their pivots.
pub(super) const SAME_PIVOT: f64 = 1e-4;
/// Their gaps differ by less than so many times the tolerance. Half: four times the near ties on tiles. Twice: no
/// effect.
pub(super) const SAME_GAP: f64 = 20.0;
/// A solution that finds an event so many times its estimated error away contradicts the whole window. No effect where
/// windows are as short as [`LEFT_OUT`] makes them; without that, strips had wrong orders.
pub(super) const CONTRADICTED: f64 = 10.0;
/// A corrected Schur complement still leaves out a part of what it left out before. Times between the ends of a window
/// are off by so many times that part of a pivot, of the span of the window: of 33 440 states of strips of 2 to 16 rows
/// that repeat along these, and of 26 073 on layers that keep their volume, 1006 and 310 were beyond their estimates
/// without this, by 11 and 3.6 times at worst, and 2 and 2 are with it, by 1.6 and 1.2 times. Half: 21 and 11. Twice:
/// none. On squares of 64² estimates are 1.5 times as great as without it, and three times what states are off by.
pub(super) const OF_LEFT_OUT: f64 = 0.2;
/// States report so many times what near ties take for the error of a time: up to a hundredth of the events exceed
/// that, by a factor of two. Half: an error of the strip comes to 0.91 of its estimate, others to 0.55.
pub(super) const OF_TIME: f64 = 2.0;
/// Gaps at a window's beginning may be off by so many times the tolerance of solutions, and the times with them: as
/// much as their residuals may be. Only plateaus, whose events are close beside the approach, show it: on 21 × 23 nodes
/// with cells of 44 : 1 an approach was off by 7·10⁻⁸ of itself, fourteen times its estimate without this.
pub(super) const OF_GAP: f64 = 30.0;
/// The error of a load at a given approach is estimated as so many times what its window lacks at the end, and what the
/// errors of events so far make of it. No effect on these paths, where times decide; late on periodic paths loads do.
pub(super) const OF_LOAD: f64 = 3.0;
/// The load at the window's end is that of an approach which is off by this part of the mean spacing of events. No
/// effect, as before.
pub(super) const OF_END: f64 = 1e-5;

/// With a hardness and without a factor a window goes to this part of the time at which the next node that is not
/// watched would touch or yield: rates rise where nodes yield, so that it may come earlier. 1: 1.04 to 1.11 times the
/// convolutions on rough and uncorrelated heights of 64² and 128², a third of the windows is taken back. 0.75: 1.01 to
/// 1.12 times.
pub(super) const TRUSTED: f64 = 0.9;
/// With a hardness and without a factor rates of pressures, relative to the greatest, and of plastic depths may be
/// negative by so much: residuals of rates are up to 1.5·10⁻⁵, and rates where contact does not grow are of the order
/// of 1.
pub(super) const SLACK_OF_RATE: f64 = 1e-3;

// Ties and rounding

/// Events closer than this, relative to the approach, are ties without a factor: the lowest index comes first.
pub(super) const TIE: f64 = 1e-9;
/// The same with a factor, of gaps: when one of them closes, those as small as this part of the approach close with it.
/// Well above the rounding of a gap (3·10⁻¹⁴ on symmetric surfaces of 128 × 128 nodes), and below what a state may be
/// off.
pub(super) const EXACT_TIE: f64 = 1e-13;
/// The same as [`TIE`], relative to the greatest initial gap: rounding of heights.
pub(super) const ROUNDING: f64 = 1e-14;
/// Bounds of the tolerance of rates, relative to their greatest value, 1.
pub(super) const RATE_TOLERANCE: [f64; 2] = [5e-7, 1e-5];
/// Error of the gap of a node that is not watched, over the tolerance of solutions.
pub(super) const UNWATCHED: f64 = 100.0;
/// How far below zero a gap may lie at the end of an exact window before events are taken back, as a multiple of the
/// greatest gap that the solution there leaves in contact, which is rounding. What is taken back without need costs
/// time and changes nothing, so that the bound need not be as wide as that of an error. Without a factor the same of
/// pressures, times what a unit pressure displaces.
pub(super) const OF_RESIDUAL: f64 = 8.0;
/// The same of gaps out of contact and of plastic depths, as a multiple of the greatest gap r that a solution without a
/// factor leaves in contact: they are off by `C_oe C_ee⁻¹ r`. Rows of that are not negative and sum to 1 at most where
/// `C⁻¹` has no positive element beside its diagonal and no negative row sum; for [`Spectral`](crate::Spectral), which
/// lacks the first, their elements came to 1.29 in all on 14 × 14 nodes, with random and smooth contacts of 3 to 97 %.
pub(super) const OF_RESIDUAL_BEYOND: f64 = 2.0;
/// How far below zero a gap may lie, relative to the greatest initial gap and the approach, or a pressure,
/// relative to the greatest one, before it counts as wrong. The displacement comes from an FFT and
/// triangular solves, whose errors stay below 1e-13 of the greatest displacement; the condition of the
/// influence matrix grows with the side of the grid only, so that pressures lose two or three digits.
pub(super) const TOLERANCE: f64 = 1e-10;
/// What a solution behind a window of yields may leave open, relative to the same: some hundred rounding errors. Where
/// it is more the next window begins with a solution of the factor.
pub(super) const LEFT_OPEN: f64 = 1e-14;
/// How many times as long as wide cells may be for that to hold of plastic depths: they are off as the pressures are at
/// which nodes yield, and the condition is some 20 times the ratio of the sides (4 × 8 nodes, 2600 : 1: 5·10⁴, a depth
/// off by 1.1·10⁻¹⁰). On longer cells the tolerance grows with the ratio.
pub(super) const SQUARE: f64 = 250.0;
/// The pressure of a node out of contact is watched if, alone, it could come to its hardness over this number by the
/// end of the window. A node that was left out and comes to its hardness contradicts the window.
pub(super) const BORDERED: f64 = 4.0;
/// How far a state of a path may be off, relative to its load, pressures and lengths, to be recognised: an exact path
/// is right to some 10⁻¹².
pub(super) const RECOGNISED: f64 = 1e-6;
/// The same where the approach of its event is an estimate: loads err by 3·10⁻⁵ at worst.
pub(super) const ESTIMATED: f64 = 1e-4;

/// Beside lengths, by how much nodes that have yielded on a path without a factor may not be as deep yet as one with a
/// factor finds them: a hundred times the default tolerance of the pressures that it found, whose yields it is.
pub(super) const SHALLOW: f64 = 1e-6;

// Events one at a time

/// Rates below this, relative to the greatest, are nothing but rounding where either sign is possible:
/// otherwise nodes that neither gain nor lose pressure could touch and leave without end.
pub(super) const LEAST_RATE: f64 = 1e-12;

// The work of a window with a factor, and of an event: only time depends on these (study `scale`, bench `updater`)

// They are constants and not measurements, so that the same input gives the same windows, and the same bits, on every
// run.

/// Nanoseconds of a solution on n contact nodes, per n²: it reads the 4n² bytes of the factor.
pub(super) const SOLVE: f64 = 0.3;
/// Nanoseconds of a Schur complement of k nodes, per k² n: a matrix product.
pub(super) const SCHUR: f64 = 0.01;
/// Nanoseconds of the convolutions of two fields at a window's end, per node of the grid.
pub(super) const CONVOLUTION: f64 = 50.0;
/// Greatest number of watched nodes, as a fraction of the contact nodes: their columns must stay small beside the
/// factor.
pub(super) const MOST_WATCHED: f64 = 0.05;
/// Where nodes may leave, no more nodes are watched than this,
pub(super) const FEWEST_BETWEEN_RELEASES: usize = 16;
/// or than this many times those that joined in the window before, if that is more.
pub(super) const AS_MANY_AGAIN: usize = 3;
/// Nodes that were not watched before come in multiples of this if there are more: widths that suit the matrix product.
pub(super) const MULTIPLE: usize = 96;
/// Nanoseconds for one product of the events inside a window.
pub(super) const EVENT_PRODUCT: f64 = 0.08;
/// Fraction of the watched nodes that touch before the horizon.
pub(super) const YIELD: f64 = 0.85;
/// The same, of almost all windows.
pub(super) const LEAST_YIELD: f64 = 0.75;
/// Watched nodes that are always worth it.
pub(super) const WORTH_IT: f64 = 16.0;
/// Watched nodes whose columns cost little however few nodes are in contact.
pub(super) const NEGLIGIBLE: f64 = 320.0;
/// Watched nodes for which a factor must have room, or it is given up. With fewer, its solutions would be shared by
/// so few events that iterations are no slower.
pub(super) const LEAST_WINDOW: usize = 64;
/// Seconds of an event with a factor of n nodes, per n²: a matrix product. With the next two it decides when a factor
/// is given up.
pub(super) const FACTOR: f64 = 1.0e-11;
/// So many times that where windows are checked at each event, since nodes may leave.
pub(super) const CHECKED: f64 = 2.5;
/// Seconds of a node that leaves: per n², two solutions, for a window ends before it, and the rotations of the factor,
/// and per node of the grid two convolutions of two fields.
pub(super) const RELEASE_WITH_FACTOR: [f64; 2] = [2.0e-9, 1.0e-7];
/// Seconds that a node that leaves takes by iterations, per node of the grid: windows end before it, and it has a
/// solution of its own.
pub(super) const RELEASE_BY_ITERATIONS: f64 = 2.0e-6;
/// Seconds of an event by iterations, per node of the grid and per node in contact: convolutions, and what goes with
/// them on the contact. Where an event took 1.5 times [`FACTOR`] n² with a factor, it took 0.43, 0.73 and 1.67 ms
/// without on 128², 256² and 512², on paths to 100, 30 and 5 %. A third of the first number: the path to 5 % of 512²
/// takes 1.2 to 1.3 times as long. With a factor the path needs the most memory where it is given up.
pub(super) const ITERATIONS: [f64; 2] = [3.5e-9, 4.0e-9];
/// The same for any grid: local solutions and events.
pub(super) const WINDOW: f64 = 2.0e-4;
/// Seconds that giving a factor up takes, per node of the grid and per node in contact: the first solutions without it,
/// which begin with nothing. Paths that end right behind it took 0.12, 0.10 and 0.40 s more on 128², 256² and 512² with
/// 5900, 6400 and 8000 nodes.
pub(super) const HANDOVER: [f64; 2] = [1.3e-6, 8.0e-6];
/// A factor is given up only if that saves this part of the time that the rest of the path takes with it: states are
/// estimates then.
pub(super) const SAVED: f64 = 0.2;
