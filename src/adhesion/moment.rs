//! Scalars at an instant of a path.

use super::front::{Field, Front};
use super::law::CohesiveLaw;
use super::state::NodeState;

/// Energies so far.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Totals {
    /// ∫ W dδ in the gauge of the kernel.
    pub(super) work: f64,
    pub(super) dissipated: f64,
}

/// Scalars at an instant.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moment {
    /// In the gauge of the kernel.
    pub(super) approach: f64,
    /// Of all pressures and of all gaps, with their rates along the approach in the direction of the branch.
    pub(super) sums: [[f64; 2]; 2],
    pub(super) contact_nodes: usize,
    /// Soft nodes, and cohesive ones.
    pub(super) pulled: [usize; 2],
    /// Energy of adhesion over the area of a cell.
    pub(super) energy: f64,
    pub(super) totals: Totals,
}

impl Moment {
    /// At a front of which all is known.
    pub(super) fn of(law: &CohesiveLaw, front: &Front, field: &Field, totals: Totals) -> Self {
        let gaps = front.nodes.iter().zip(&field.gap[0]);
        let energy = gaps.map(|(state, &gap)| match state {
            NodeState::Open => 0.0,
            NodeState::Contact => -law.work(),
            _ => law.energy(gap),
        });
        Self {
            approach: front.approach,
            sums: field.sums(),
            contact_nodes: front.count(NodeState::Contact),
            pulled: [NodeState::Soft, NodeState::Cohesive].map(|state| front.count(state)),
            energy: energy.sum(),
            totals,
        }
    }
}
