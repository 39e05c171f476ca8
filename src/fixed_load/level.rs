//! The contact problem on one grid, with all the memory that solving it takes.

use super::iterate::Iterate;
use crate::convolution::Convolution;
use crate::iterative::{Operator, SparseInverse};
use crate::kernel::KernelTable;
use crate::{Error, Grid};

/// What is prescribed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Target {
    /// The sum of all pressures.
    Sum(f64),
    /// The approach.
    Approach(f64),
}

/// The contact problem on one grid.
#[derive(Debug, Clone)]
pub(super) struct Level {
    pub(super) grid: Grid,
    /// Initial gap, zero at the highest node of the finest grid.
    pub(super) gap: Vec<f64>,
    pub(super) operator: Operator,
    pub(super) inverse: SparseInverse,
    /// C(0, 0).
    pub(super) self_influence: f64,
    pub(super) iterate: Iterate,
}

impl Level {
    pub(super) fn new(table: &KernelTable, gap: Vec<f64>) -> Result<Self, Error> {
        Ok(Self {
            grid: table.grid(),
            iterate: Iterate::new(gap.len()),
            gap,
            operator: Operator::new(Convolution::from_table(table)?),
            inverse: SparseInverse::new(table),
            self_influence: table.self_influence(),
        })
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.gap[..])
            + self.operator.bytes()
            + self.inverse.bytes()
            + self.iterate.bytes()
    }
}
