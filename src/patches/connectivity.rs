//! Which nodes are neighbours.

/// Which nodes are neighbours, and so belong to one patch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Connectivity {
    /// Those whose cells have a side in common.
    Four,
    /// Those whose cells have a side or a corner in common.
    Eight,
}

impl Connectivity {
    /// What holds between the nodes out of contact if this holds between those in contact: of two diagonals that
    /// cross, one is closed to the other.
    ///
    /// Four for eight, and eight for four. With any other pair a corner could join both, or neither.
    #[must_use]
    pub fn dual(self) -> Self {
        match self {
            Self::Four => Self::Eight,
            Self::Eight => Self::Four,
        }
    }
}
