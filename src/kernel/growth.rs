//! What is known of how contact grows.

/// How the contact changes while the approach grows, as far as it is known of a kernel for *every*
/// contact set I that can occur.
///
/// With $y_2 = C_{II}^{-1} e$ the growth of pressure and $r_2 = 1 - C_{:,I}\, y_2$ the rate at which
/// gaps close, each level promises what those before it do, and makes long paths cheaper.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum ContactGrowth {
    /// Nothing is known: pressures may fall, and nodes leave the contact. A path finds every event,
    /// touch or release, from a solution of its own.
    #[default]
    Unknown,
    /// $y_2 \ge 0$ and $r_2 \ge 0$: no node ever leaves the contact, and no gap opens; but a gap may
    /// close the faster the more other nodes are in contact. Many events are computed together, and
    /// given up from the first one on that a gap contradicts afterwards.
    Monotone,
    /// Moreover gaps are convex in the approach: each closes the slower the more others are in
    /// contact. It holds if the influence matrix is an inverse M-matrix (no off-diagonal of the
    /// inverse positive, no row sum negative), as Love's is. Many events are computed together, and
    /// need no check.
    Convex,
}
