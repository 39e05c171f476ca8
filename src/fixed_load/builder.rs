//! How the solver is set up.

use super::budget::MemoryBudget;
use super::hierarchy::Hierarchy;
use super::settings::Settings;
use super::solver::FixedLoadSolver;
use nalgebra::DMatrix;

use crate::hardness::Limit;
use crate::krylov::check_cells;
use crate::{Boundary, Error, Grid, InfluenceKernel, PeriodicBoussinesq, Problem, Surface, memory};

/// Greatest ratio of the sides of periodic cells, and what is expected of it.
const LONGEST_CELLS: (f64, &str) = (
    PeriodicBoussinesq::MAX_ASPECT,
    "at most 1000 for a single load; a path with a factor takes any",
);

/// Sets up a [`FixedLoadSolver`].
#[derive(Clone, Copy)]
#[must_use = "a builder does nothing until it is built"]
pub struct FixedLoadBuilder<'a> {
    surface: &'a dyn Surface,
    kernel: &'a dyn InfluenceKernel,
    settings: Settings,
    hardness: Limit<'a>,
}

impl<'a> FixedLoadBuilder<'a> {
    /// Greatest pressure H \[Pa\]: nodes that reach it yield, and
    /// [`FixedLoadSolution::fields`](super::FixedLoadSolution::fields) has what stays of them. Infinity, as by default,
    /// is elastic contact.
    ///
    /// A solution takes some ten elastic ones. A load of H times the nominal area or more is an
    /// [`Error::BeyondHardness`]: all nodes yield below it.
    pub fn hardness(mut self, hardness: f64) -> Self {
        self.hardness = Limit::Uniform(hardness);
        self
    }

    /// The same, with a hardness for each node \[Pa\], nx × ny.
    pub fn hardness_map(mut self, hardness: &'a DMatrix<f64>) -> Self {
        self.hardness = Limit::Map(hardness);
        self
    }

    /// Greatest error that a solution may have, 10⁻⁸ by default: of every gap in contact and of every
    /// overlap, relative to the approach, or to C(0, 0) p̄ if that is larger on a periodic half-space
    /// of arbitrary mean displacement. From 10⁻¹² on rounding begins to matter. Nodes in contact are counted
    /// ([`ContactTarget::AreaFraction`](crate::ContactTarget::AreaFraction)) within 10⁻³ at most.
    pub fn tolerance(mut self, tolerance: f64) -> Self {
        self.settings.tolerance = tolerance;
        self
    }

    /// Steps of conjugate gradients after which to give up, 5000 by default, in each of the elastic solutions that a
    /// solution with a hardness, or of a load that is searched for, is made of.
    pub fn max_iterations(mut self, iterations: usize) -> Self {
        self.settings.max_iterations = iterations;
        self
    }

    /// Whether to start from coarser grids, as is the default.
    #[doc(hidden)]
    pub fn nested(mut self, nested: bool) -> Self {
        self.settings.nested = nested;
        self
    }

    /// Whether to compute stiffnesses as well, as is the default: about as much work again as the
    /// pressure. See [`FixedLoadSolver::add_stiffness`].
    pub fn stiffness(mut self, stiffness: bool) -> Self {
        self.settings.stiffness = stiffness;
        self
    }

    /// Bytes that may be held at most, by default three quarters of the memory that the process may use, where the
    /// system says how much that is: some 500 for each node of a square grid, several times as many on thin ones, and
    /// some 350 for each node in contact. More is an [`Error::MemoryBudget`], before it is allocated.
    pub fn memory_budget(mut self, bytes: usize) -> Self {
        self.settings.memory_budget = Some(bytes);
        self
    }

    /// Samples the surface, evaluates the kernel, and prepares all grids.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a tolerance that is not between 0 and 1, both excluded, and for a periodic kernel with
    /// cells more than [`MAX_ASPECT`](PeriodicBoussinesq::MAX_ASPECT) times as long as wide: from ten times that on,
    /// iterations on [`Spectral`](crate::Spectral) were found to end without an answer. A path with a factor, a single
    /// row of nodes and a free boundary know no such limit. [`Error::NotPositive`] for a hardness,
    /// [`Error::GridMismatch`] for a map of another grid, and
    /// [`KernelError::GrowthUnknown`](crate::KernelError::GrowthUnknown) for a hardness with a kernel that may let
    /// nodes leave. [`Error::MemoryBudget`] if the grid is too large for the budget; and those of [`Problem::new`].
    pub fn build(self) -> Result<FixedLoadSolver, Error> {
        let settings = self.settings;
        settings.check()?;
        let budget = settings.memory_budget.unwrap_or_else(memory::default_budget);
        let grid = self.kernel.grid();
        let boundary = self.kernel.boundary();
        check_cells(&grid, boundary, LONGEST_CELLS)?;
        let memory = MemoryBudget::new(budget, &grid, boundary, settings.nested)?;
        let problem = Problem::new(self.surface, self.kernel)?;
        // A user-defined kernel may say something else when it is asked again.
        grid.check_shape(problem.grid().shape())?;
        let hardness = self.hardness.resolve(&problem)?;
        let hierarchy = Hierarchy::new(&problem, settings.nested, memory)?;
        Ok(FixedLoadSolver::with(settings, hierarchy, hardness))
    }
}

impl std::fmt::Debug for FixedLoadBuilder<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("FixedLoadBuilder")
            .field("grid", &self.kernel.grid())
            .field("settings", &self.settings)
            .finish_non_exhaustive()
    }
}

impl FixedLoadSolver {
    /// A solver for `surface` on the half-space of `kernel` with default settings.
    ///
    /// # Errors
    ///
    /// As [`FixedLoadBuilder::build`].
    pub fn new(surface: &dyn Surface, kernel: &dyn InfluenceKernel) -> Result<Self, Error> {
        Self::builder(surface, kernel).build()
    }

    /// `Ok` if a solver on a grid has room within a memory budget, by default that of
    /// [`FixedLoadBuilder::memory_budget`], whatever the load: with all nodes in contact.
    ///
    /// # Errors
    ///
    /// [`Error::MemoryBudget`] if they do not fit.
    #[doc(hidden)]
    pub fn check_room(grid: &Grid, boundary: Boundary, budget: Option<usize>) -> Result<(), Error> {
        let budget = budget.unwrap_or_else(memory::default_budget);
        let nested = Settings::default().nested;
        MemoryBudget::new(budget, grid, boundary, nested)?.check(grid.nodes())
    }

    /// Sets up a solver for `surface` on the half-space of `kernel`.
    pub fn builder<'a>(
        surface: &'a dyn Surface,
        kernel: &'a dyn InfluenceKernel,
    ) -> FixedLoadBuilder<'a> {
        FixedLoadBuilder { surface, kernel, settings: Settings::default(), hardness: Limit::None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::Paraboloid;
    use crate::{Boussinesq, Grid};

    #[test]
    fn a_builder_shows_its_grid_and_settings() -> Result<(), Error> {
        let kernel = Boussinesq::new(Grid::new(7, 5, 0.5, 0.25)?, 1.0)?;
        let surface = Paraboloid::new(1.0)?;
        let builder =
            FixedLoadSolver::builder(&surface, &kernel).tolerance(3e-7).max_iterations(123);
        let shown = format!("{builder:?}");
        assert!(shown.contains(&format!("{:?}", kernel.grid())), "{shown}");
        assert!(shown.contains("tolerance: 3e-7"), "{shown}");
        assert!(shown.contains("max_iterations: 123"), "{shown}");
        Ok(())
    }
}
