//! A state of a branch, and what happened there.

use crate::contact::ContactState;

/// Where a node is on the law of adhesion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum NodeState {
    /// Out of range: gap ≥ h₂, and no pull.
    Open,
    /// On the slope of the law: h₁ ≤ gap ≤ h₂, and a pull k (h₂ − gap).
    Soft,
    /// Pulled with σ₀: 0 ≤ gap ≤ h₁.
    Cohesive,
    /// In contact: gap = 0, and a pressure of −σ₀ or more.
    Contact,
    /// Within a jump only: the traction is held, and not on the law.
    Held,
}

/// The event at a state of a branch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum AdhesiveEvent {
    /// A node comes into range, and is pulled.
    Near,
    /// The pull on a node has grown to σ₀, with a gap of h₁; only where h₁ is not 0.
    Pull,
    /// A node touches.
    Touch,
    /// The pressure of a node has fallen to −σ₀, and its gap opens.
    Part,
    /// The gap of a node that is pulled with σ₀ has opened to h₁; only where h₁ is not 0.
    Soften,
    /// A node goes out of range.
    Far,
    /// The last state before a jump: it is about to become unstable at the node. Extremes of the load are here.
    JumpStart,
    /// The state behind a jump, at the same approach in the gauge of the kernel.
    JumpEnd,
    /// Nothing: the branch has reached the state at which it was to end.
    Limit,
}

impl AdhesiveEvent {
    /// Its name in files and tables: `jump_start` for [`Self::JumpStart`].
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Near => "near",
            Self::Pull => "pull",
            Self::Touch => "touch",
            Self::Part => "part",
            Self::Soften => "soften",
            Self::Far => "far",
            Self::JumpStart => "jump_start",
            Self::JumpEnd => "jump_end",
            Self::Limit => "limit",
        }
    }
}

/// The way of the approach.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Direction {
    /// It grows.
    Loading,
    /// It falls.
    Unloading,
}

impl Direction {
    /// Its name in files and tables: `loading` or `unloading`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Loading => "loading",
            Self::Unloading => "unloading",
        }
    }
}

impl Direction {
    /// 1 or −1.
    pub(super) fn sign(self) -> f64 {
        match self {
            Self::Loading => 1.0,
            Self::Unloading => -1.0,
        }
    }
}

/// A state of a branch of an [`AdhesivePath`](super::AdhesivePath): the instant of an event, with the event already
/// done, but for [`AdhesiveEvent::JumpStart`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct AdhesiveState {
    /// Number of states up to here, on all branches of the path.
    pub step: usize,
    /// Whether the approach grew or fell on the way here.
    pub direction: Direction,
    /// The event.
    pub event: AdhesiveEvent,
    /// The node to which it happens, (ix, iy); at a jump the one that was unstable, at a limit that of the last event.
    pub node: (usize, usize),
    /// Scalars: approach (from first touch of surfaces that do not pull: negative at first), load (negative where the
    /// surfaces are pulled), area of nodes whose gap is 0, mean gap, elastic energy. Stiffnesses are derivatives on the
    /// way of the branch, and may be negative.
    pub contact: ContactState,
    /// Nodes on the slope of the law.
    pub soft_nodes: usize,
    /// Nodes pulled with σ₀ and not in contact.
    pub cohesive_nodes: usize,
    /// Energy of adhesion `ΔA Σ φ(gap)` \[J\], 0 for surfaces out of range and negative otherwise.
    pub adhesive_energy: f64,
    /// Energy lost in all jumps so far \[J\].
    pub dissipated: f64,
    /// `∫ W dδ` so far \[J\]: elastic, adhesive and dissipated energy.
    pub work: f64,
}
