//! How a path with adhesion is set up.

use std::sync::Arc;

use super::front::Body;
use super::law::Adhesion;
use super::path::AdhesivePath;
use super::plain::Plain;
use super::state::Direction;
use super::target::Targets;
use crate::contact::ContactTarget;
use crate::convolution::Convolution;
use crate::error::AdhesionError;
use crate::memory::{self, Memory};
use crate::{ContactGrowth, Error, InfluenceKernel, LoadingSolver, Problem, Surface};

/// Fields of the grid that a path holds.
const FIELDS: usize = 24;

/// Over the height of a surface, a range beside which six digits of heights are left.
const LONGEST: f64 = 1e9;

/// The settings of an [`AdhesivePath`]; see [`AdhesivePath::builder`].
#[must_use]
pub struct AdhesiveBuilder<'a> {
    surface: &'a dyn Surface,
    kernel: &'a dyn InfluenceKernel,
    law: Adhesion,
    targets: Vec<ContactTarget>,
    window_size: Option<usize>,
    memory_budget: Option<usize>,
}

impl std::fmt::Debug for AdhesiveBuilder<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("AdhesiveBuilder")
            .field("grid", &self.kernel.grid())
            .field("law", &self.law)
            .field("targets", &self.targets)
            .field("window_size", &self.window_size)
            .field("memory_budget", &self.memory_budget)
            .finish_non_exhaustive()
    }
}

impl AdhesivePath {
    /// Sets up the path of `surface` on the half-space of `kernel` with a law of adhesion.
    pub fn builder<'a>(
        surface: &'a dyn Surface,
        kernel: &'a dyn InfluenceKernel,
        law: Adhesion,
    ) -> AdhesiveBuilder<'a> {
        AdhesiveBuilder {
            surface,
            kernel,
            law,
            targets: Vec::new(),
            window_size: None,
            memory_budget: None,
        }
    }
}

impl AdhesiveBuilder<'_> {
    /// Ends the branch of loading at a target, the first time that it is there: at exactly this load, approach or mean
    /// gap, which may be negative for the first two; or with as many nodes in contact as fit into this fraction of the
    /// area, or behind the jump that goes past it. Of several targets the first one reached counts. Without any it ends
    /// in full contact.
    pub fn until(mut self, target: ContactTarget) -> Self {
        self.targets.push(target);
        self
    }

    /// How many nodes to watch beside those that are pulled with the greatest stress, and those that tie with them: as
    /// many events at most follow from one solution, and what happens at the instant of the last one. By default 64, or
    /// a quarter of the soft nodes. States do not depend on it, except by rounding. With 1 every event has a solution
    /// of its own, unless it ties with others.
    pub fn window_size(mut self, nodes: usize) -> Self {
        self.window_size = Some(nodes);
        self
    }

    /// Ends the path with an error before it holds more than this many bytes; by default three quarters of the
    /// memory that the process may use, where the system tells it.
    pub fn memory_budget(mut self, bytes: usize) -> Self {
        self.memory_budget = Some(bytes);
        self
    }

    /// The path without adhesion.
    fn plain(&self, targets: &Targets, budget: usize) -> Result<Plain, Error> {
        let builder = LoadingSolver::builder(self.surface, self.kernel).memory_budget(budget);
        let builder = targets.nearest().fold(builder, |builder, target| builder.until(target));
        Ok(Plain::new(builder.build()?.into_path()))
    }

    /// Samples the surface, tabulates the kernel, and prepares the path before its first state.
    ///
    /// # Errors
    ///
    /// Those of [`Problem::new`] and of [`Adhesion::on`]; [`AdhesionError::GrowthUnknown`] for a kernel of
    /// [`ContactGrowth::Unknown`]; [`Error::OutOfRange`] for a range beside which heights are rounding, and, as
    /// [`AdhesionError::Behind`], for targets that make no sense; [`Error::MemoryBudget`] if not even the grid fits.
    pub fn build(self) -> Result<AdhesivePath, Error> {
        if self.window_size == Some(0) {
            let (quantity, expected) = ("window size", "at least 1");
            return Err(Error::OutOfRange { quantity, value: 0.0, expected });
        }
        let (grid, boundary) = (self.kernel.grid(), self.kernel.boundary());
        let budget = self.memory_budget.unwrap_or_else(memory::default_budget);
        let fixed = Problem::bytes_on(&grid, boundary)
            .saturating_add(Convolution::bytes_on(&grid, boundary))
            .saturating_add(FIELDS * size_of::<f64>() * grid.nodes());
        let memory = Memory { budget, fixed };
        memory.check(0, 0)?;
        let problem = Problem::new(self.surface, self.kernel)?;
        if problem.growth() == ContactGrowth::Unknown {
            return Err(AdhesionError::GrowthUnknown.into());
        }
        let law = self.law.of(problem.table())?;
        // Gaps are differences of lengths as great as the range.
        let longest = LONGEST * problem.greatest_gap().max(law.resolution() * law.range());
        let expected = "at most 10⁹ times the height of the surface, or what the pull displaces";
        Error::require("range of adhesion", law.range(), law.range() <= longest, expected)?;
        let targets = Targets::of(&self.targets, &grid)?;
        let body = Body::new(Arc::new(problem), law, memory);
        let apart = body.apart();
        let length = body.greatest_length(apart.approach);
        targets.check_ahead((&grid, &apart, length), Direction::Loading, law.work() > 0.0)?;
        let plain = (law.work() == 0.0).then(|| self.plain(&targets, memory.left())).transpose()?;
        let window_size = self.window_size.map(|size| size.min(grid.nodes()));
        Ok(AdhesivePath::new((body, self.law), targets, (window_size, plain)))
    }
}
