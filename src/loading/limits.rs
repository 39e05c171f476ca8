//! Where a path ends, and which node touches next.

use crate::{Error, Grid};

/// Which node is taken to touch next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ContactRule {
    /// The node whose gap closes first as the approach grows: the smallest ratio
    /// $r_{1j} / r_{2j}$. Exact.
    #[default]
    FirstContact,
    /// The node with the smallest gap at present: the paper's rule (its step 4). Not exact: it
    /// gives negative pressures, overlaps, and an approach that goes backwards; it is here so that
    /// the paper can be reproduced. Implies a window of one node.
    SmallestGap,
}

/// Where a path ends: before the first state that exceeds any of these.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Limits {
    pub(super) nodes: usize,
    pub(super) load: f64,
    pub(super) approach: f64,
}

impl Limits {
    /// None but the grid's own.
    pub(super) fn none(grid: &Grid) -> Self {
        Self {
            nodes: grid.nodes(),
            load: f64::INFINITY,
            approach: f64::INFINITY,
        }
    }

    /// At most this fraction of the nominal area in contact.
    pub(super) fn area_fraction(&mut self, grid: &Grid, fraction: f64) -> Result<(), Error> {
        if !(0.0..=1.0).contains(&fraction) {
            return Err(Error::OutOfRange {
                quantity: "greatest contact area fraction",
                value: fraction,
                expected: "between 0 and 1",
            });
        }
        // A fraction such as 0.1 of 10 nodes means one node, whatever its last bit.
        let nodes = (fraction * grid.nodes() as f64 * (1.0 + 4.0 * f64::EPSILON)).floor();
        self.nodes = self.nodes.min(nodes as usize);
        Ok(())
    }
}
