//! The memory budget of a solver.

use super::tuning::COARSEST;
use crate::convolution::Convolution;
use crate::kernel::Blocks;
use crate::krylov::Preconditioner;
use crate::{Boundary, Error, Grid, Problem};

/// Numbers for each node of a grid besides its convolution, whatever the load: initial gap (1), influence
/// coefficients of a coarser grid (4), preconditioner (4), iterate and buffers (7), and solution (6).
const VALUES: usize = 22;
/// Bytes for each node along the sides of a grid that the plans of its transforms take: 240 were measured on 1 × 9000
/// nodes.
const PLANS: usize = 256;
/// Bytes of plans and working memory on the smallest grids, where they count: 100 kB were measured on 3 × 3 nodes.
const WORKSPACE: usize = 256 << 10;
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
    /// [`Error::MemoryBudget`] if the grids alone exceed it, and those of [`Grid::new`].
    pub(super) fn new(
        budget: usize,
        grid: &Grid,
        boundary: Boundary,
        nested: bool,
    ) -> Result<Self, Error> {
        let mut level = *grid;
        let finest = Problem::bytes_on(grid, boundary).saturating_add(on_level(&level, boundary));
        let mut grids = finest.saturating_add(WORKSPACE);
        while nested && level.nx().max(level.ny()) > COARSEST {
            level = Blocks::new(level, boundary)?.grid();
            grids = grids.saturating_add(on_level(&level, boundary));
        }
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
        let needed = self.grids.saturating_add(contact_nodes.saturating_mul(each));
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

/// Bytes that a level holds on its grid.
fn on_level(grid: &Grid, boundary: Boundary) -> usize {
    let convolution = Convolution::bytes_on(grid, boundary);
    // In single precision as well.
    let convolutions = convolution.saturating_add(convolution / 2);
    let values = grid.nodes().saturating_mul(VALUES * size_of::<f64>());
    values.saturating_add(convolutions).saturating_add((grid.nx() + grid.ny()) * PLANS)
}
