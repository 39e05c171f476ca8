//! What a solver may hold in memory.

use crate::krylov::Preconditioner;
use crate::{Error, Grid};

/// Numbers for each node of a grid, whatever the load: initial gap and influence coefficients (6), the
/// convolution in both precisions with its buffers (18), search directions (2), preconditioner (4), iterate (3)
/// and solution (5).
const VALUES: usize = 38;
/// Bytes of the transforms' plans and working memory on small grids, where they count: 0.5 MB were measured on
/// 400 × 4 nodes.
const WORKSPACE: usize = 640 << 10;
/// Numbers for each node in contact that conjugate gradients take with their preconditioner.
const CONTACT_VALUES: usize = 14;

/// Bytes that may be held, and those that the grids take of them.
#[derive(Debug, Clone, Copy)]
pub(super) struct MemoryBudget {
    budget: usize,
    grids: usize,
}

impl MemoryBudget {
    /// A budget of so many bytes for a problem on `grid`, with coarser grids if it is nested.
    ///
    /// # Errors
    ///
    /// [`Error::MemoryBudget`] if the grids alone exceed it.
    pub(super) fn new(budget: usize, grid: &Grid, nested: bool) -> Result<Self, Error> {
        let finest = grid.nodes() * VALUES * size_of::<f64>();
        // A quarter as many nodes on each coarser grid.
        let grids = if nested { finest + finest / 3 } else { finest };
        let grids = WORKSPACE + grids;
        let memory = Self { budget, grids };
        memory.check(0)?;
        Ok(memory)
    }

    /// `Ok` if so many nodes can be in contact.
    ///
    /// # Errors
    ///
    /// [`Error::MemoryBudget`] otherwise.
    pub(super) fn check(&self, contact_nodes: usize) -> Result<(), Error> {
        let each = Preconditioner::BYTES_A_NODE + CONTACT_VALUES * size_of::<f64>();
        let needed = self.grids.saturating_add(contact_nodes * each);
        if needed <= self.budget {
            return Ok(());
        }
        Err(Error::MemoryBudget {
            needed,
            budget: self.budget,
            nodes_that_fit: self.budget.saturating_sub(self.grids) / each,
        })
    }
}
