//! The linear system of the contact problem, before any node is in contact.

use crate::Error;
use crate::kernel::KernelTable;

/// The influence matrix C of all nodes and the right-hand sides B that every updater eliminates.
///
/// The right-hand sides are, column by column: the initial gap g, the unit vector e, and the row
/// sums $s_i = \sum_j C_{ij}$, whose products give the mean displacement.
#[derive(Debug, Clone)]
pub struct System {
    table: KernelTable,
    gap: Vec<f64>,
    row_sums: Vec<f64>,
}

impl System {
    /// Number of right-hand sides.
    pub const RHS: usize = 3;

    /// A system of the given influence coefficients, initial gaps and row sums of C, the latter
    /// two in the order of the node indices.
    ///
    /// # Errors
    ///
    /// [`Error::LengthMismatch`] if there is not one gap and one row sum for each node.
    pub fn new(table: KernelTable, gap: Vec<f64>, row_sums: Vec<f64>) -> Result<Self, Error> {
        let expected = table.grid().nodes();
        for found in [gap.len(), row_sums.len()] {
            if found != expected {
                return Err(Error::LengthMismatch { expected, found });
            }
        }
        Ok(Self {
            table,
            gap,
            row_sums,
        })
    }

    /// The influence coefficients.
    #[must_use]
    pub fn table(&self) -> &KernelTable {
        &self.table
    }

    /// Initial gaps \[m\] by node index.
    #[must_use]
    pub fn gap(&self) -> &[f64] {
        &self.gap
    }

    /// The influence coefficient between two nodes, `None` if either lies outside the grid.
    #[must_use]
    pub fn coefficient(&self, node: usize, other: usize) -> Option<f64> {
        let nodes = self.gap.len();
        (node < nodes && other < nodes).then(|| {
            self.table
                .between(self.table.place(node), self.table.place(other))
        })
    }

    /// The right-hand sides (g, 1, s) at a node, `None` if it lies outside the grid.
    #[must_use]
    pub fn rhs(&self, node: usize) -> Option<[f64; Self::RHS]> {
        Some([*self.gap.get(node)?, 1.0, *self.row_sums.get(node)?])
    }

    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        (self.gap.len() + self.row_sums.len()) * size_of::<f64>() + self.table.bytes()
    }

    /// [`Self::rhs`] of a node known to be in the grid.
    pub(crate) fn rhs_at(&self, node: usize) -> [f64; Self::RHS] {
        [self.gap[node], 1.0, self.row_sums[node]]
    }

    /// That a node was to leave the contact without being in it.
    pub(crate) fn not_in_contact(&self, node: usize) -> Error {
        let (ix, iy) = self.table.grid().coordinates(node);
        Error::NotInContact { ix, iy }
    }

    /// `Ok` if all nodes lie in the grid.
    pub(crate) fn check_nodes(&self, nodes: &[usize]) -> Result<(), Error> {
        let limit = self.gap.len();
        match nodes.iter().find(|&&node| node >= limit) {
            Some(&node) => Err(Error::NodeOutOfGrid { node, nodes: limit }),
            None => Ok(()),
        }
    }
}
