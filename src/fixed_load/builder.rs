//! How the solver is set up.

use super::hierarchy::levels;
use super::solver::FixedLoadSolver;
use crate::initial_gap::InitialGap;
use crate::kernel::KernelTable;
use crate::{Error, InfluenceKernel, Surface};

/// Sets up a [`FixedLoadSolver`].
#[derive(Debug, Clone)]
#[must_use = "a builder does nothing until it is built"]
pub struct FixedLoadBuilder<S, K> {
    surface: S,
    kernel: K,
    tolerance: f64,
    max_iterations: usize,
    nested: bool,
    stiffness: bool,
}

impl<S: Surface, K: InfluenceKernel> FixedLoadBuilder<S, K> {
    /// Greatest error that a solution may have, 10⁻⁸ by default: of every gap in contact and of
    /// every overlap, relative to the approach. From 10⁻¹² on rounding begins to matter.
    pub fn tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// Steps of conjugate gradients after which to give up.
    pub fn max_iterations(mut self, iterations: usize) -> Self {
        self.max_iterations = iterations;
        self
    }

    /// Whether to start from coarser grids, as is the default.
    pub fn nested(mut self, nested: bool) -> Self {
        self.nested = nested;
        self
    }

    /// Whether to compute stiffnesses as well, as is the default: about as much work again as the
    /// pressure. See [`FixedLoadSolver::add_stiffness`].
    pub fn stiffness(mut self, stiffness: bool) -> Self {
        self.stiffness = stiffness;
        self
    }

    /// Samples the surface, evaluates the kernel, and prepares all grids.
    ///
    /// # Errors
    ///
    /// Those of the surface and of the kernel; [`Error::HeightNotFinite`];
    /// [`Error::GridMismatch`] if the surface returns heights of another grid; and
    /// [`Error::OutOfRange`] for a tolerance that is not between 0 and 1, both excluded.
    pub fn build(self) -> Result<FixedLoadSolver<S, K>, Error> {
        let grid = self.kernel.grid();
        if !(self.tolerance > 0.0 && self.tolerance < 1.0) {
            return Err(Error::OutOfRange {
                quantity: "tolerance",
                value: self.tolerance,
                expected: "above 0 and below 1",
            });
        }
        let gap = InitialGap::of(&self.surface, &grid)?;
        let table = KernelTable::new(&self.kernel)?;
        Ok(FixedLoadSolver {
            levels: levels(&table, gap.values, self.nested)?,
            surface: self.surface,
            kernel: self.kernel,
            grid,
            tolerance: self.tolerance,
            max_iterations: self.max_iterations,
            stiffness: self.stiffness,
            rms_height: gap.rms_height,
        })
    }
}

impl<S: Surface, K: InfluenceKernel> FixedLoadSolver<S, K> {
    /// A solver for `surface` on the half-space of `kernel` with the default tolerance.
    ///
    /// # Errors
    ///
    /// As [`FixedLoadBuilder::build`].
    pub fn new(surface: S, kernel: K) -> Result<Self, Error> {
        Self::builder(surface, kernel).build()
    }

    /// Sets up a solver for `surface` on the half-space of `kernel`.
    pub fn builder(surface: S, kernel: K) -> FixedLoadBuilder<S, K> {
        FixedLoadBuilder {
            surface,
            kernel,
            tolerance: 1e-8,
            max_iterations: 5000,
            nested: true,
            stiffness: true,
        }
    }
}
