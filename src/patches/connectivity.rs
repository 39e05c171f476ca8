//! Which nodes are neighbours.

/// Which nodes are neighbours, and so belong to one patch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Connectivity {
    /// Those whose cells have a side in common.
    Four,
    /// Those whose cells have a side or a corner in common.
    Eight,
}
