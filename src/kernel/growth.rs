//! How contact is known to grow.

/// How the contact changes while the approach grows, as far as it is known of a kernel for *every*
/// contact set I that can occur.
///
/// Two rates say it: `y₂ = C_II⁻¹ e`, the growth of the pressures with the approach, and
/// `r₂ = 1 − C_:I y₂`, the rate at which the gaps close. Each level promises what those before it do,
/// and makes long paths cheaper. [`check`](super::check()) tests a promise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum ContactGrowth {
    /// Nothing is known: pressures may fall, and nodes may leave the contact. A path computes the events up to the next
    /// release together and checks each of them, and finds the release from a solution of its own.
    #[default]
    Unknown,
    /// `y₂ ≥ 0` and `r₂ ≥ 0`: no node ever leaves the contact, and no gap opens. But nodes that join
    /// may make another gap close faster. A path therefore computes many events together, and gives
    /// up those after the first one that a gap contradicts.
    Monotone,
    /// Moreover gaps are convex in the approach: nodes that join only make the others close more
    /// slowly. It holds if the influence matrix is an inverse M-matrix (no off-diagonal of the inverse
    /// positive, no row sum negative), as Love's is. A path computes many events together, and need not
    /// check them.
    Convex,
}
