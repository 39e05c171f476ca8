//! The contact problem on one grid, with all the memory that solving it takes.

use std::borrow::Cow;

use super::iterate::Iterate;
use crate::convolution::Convolution;
use crate::kernel::KernelTable;
use crate::krylov::{Operator, SparseInverse};
use crate::{Boundary, Error, Grid};

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
    pub(super) boundary: Boundary,
    /// Initial gap, zero at the highest node of the finest grid.
    pub(super) gap: Vec<f64>,
    /// In the zero gauge if the half-space is periodic.
    pub(super) operator: Operator,
    /// That of the matrix in the gauge `gauge`.
    pub(super) inverse: SparseInverse,
    /// A gauge of its own to compute in, where the zero gauge is singular; zero if the half-space
    /// is free.
    pub(super) gauge: f64,
    /// C(0, 0), in that gauge.
    pub(super) self_influence: f64,
    pub(super) iterate: Iterate,
}

impl Level {
    pub(super) fn new(table: &KernelTable, gap: Vec<f64>) -> Result<Self, Error> {
        let gauge = table.computing_gauge();
        let [zero, own] = match gauge {
            Some(gauge) => [0.0, gauge].map(|gauge| Cow::Owned(table.in_gauge(gauge))),
            None => [Cow::Borrowed(table), Cow::Borrowed(table)],
        };
        Ok(Self {
            grid: table.grid(),
            boundary: table.boundary(),
            iterate: Iterate::new(gap.len()),
            gap,
            operator: Operator::new(Convolution::from_table(&zero)?),
            inverse: SparseInverse::new(&own),
            gauge: gauge.unwrap_or_default(),
            self_influence: own.self_influence(),
        })
    }

    /// Errors of gaps are measured by no less than this length: far beyond full contact of a periodic
    /// half-space the approach stays what it is, whereas rounding grows with the pressure.
    pub(super) fn least_length(&self, target: Target) -> f64 {
        match target {
            Target::Sum(sum) if self.boundary == Boundary::Periodic => {
                self.self_influence * (sum / self.gap.len() as f64)
            }
            Target::Sum(_) | Target::Approach(_) => 0.0,
        }
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.gap[..])
            + self.operator.bytes()
            + self.inverse.bytes()
            + self.iterate.bytes()
    }
}
