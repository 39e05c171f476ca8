//! A factor as long as it fits, iterations after.

use super::{
    ConjugateGradient, LinearUpdater, RecursiveCholesky, Schur, Solution, System, Touched,
    WindowCost,
};
use crate::Error;

/// Watched nodes for which the factor must have room. With fewer, its solutions would be shared by
/// so few events that iterations are no slower.
const LEAST_WINDOW: usize = 64;

/// [`RecursiveCholesky`] while its factor fits the memory budget of the path, [`ConjugateGradient`]
/// from then on: no path ends for want of memory for n² numbers.
///
/// The budget is that of [`LoadingBuilder::memory_budget`](crate::loading::LoadingBuilder::memory_budget).
/// States are the same on both sides of the seam, to the tolerance of the iterations (10⁻¹² of the
/// right-hand sides); only the time of an event changes. A message of the level `info` goes to the
/// crate `log`, and [`handed_over_at`](Self::handed_over_at) says where it was.
///
/// The factor is given back to the system, to make room for the columns of the iterations.
///
/// ```
/// use asperity::surface::Paraboloid;
/// use asperity::updater::Handover;
/// use asperity::{Boussinesq, Grid, LoadingSolver};
///
/// # fn main() -> Result<(), asperity::Error> {
/// let kernel = Boussinesq::new(Grid::square(32, 1.0)?, 1.0)?;
/// let mut path = LoadingSolver::builder(Paraboloid::new(10.0)?, kernel)
///     .updater(Handover::new())
///     .memory_budget(2_000_000)
///     .max_nodes(400)
///     .build()?;
/// for state in path.by_ref() {
///     state?;
/// }
/// assert!(path.updater().handed_over_at().is_some());
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct Handover {
    stage: Stage,
    /// What the updater may hold, in bytes.
    budget: usize,
    /// Committed nodes of the factor.
    order: Vec<usize>,
    handed_over_at: Option<usize>,
}

#[derive(Debug, Clone)]
enum Stage {
    Factor(RecursiveCholesky),
    Iterations(Box<ConjugateGradient>),
}

impl Default for Handover {
    fn default() -> Self {
        Self::new()
    }
}

impl Handover {
    /// An empty contact set, and no bound on memory before the path sets its own.
    #[must_use]
    pub fn new() -> Self {
        Self {
            stage: Stage::Factor(RecursiveCholesky::new()),
            budget: usize::MAX,
            order: Vec::new(),
            handed_over_at: None,
        }
    }

    /// Number of nodes in contact when the factor was given up, `None` while it is in use.
    #[must_use]
    pub fn handed_over_at(&self) -> Option<usize> {
        self.handed_over_at
    }

    fn updater(&self) -> &dyn LinearUpdater {
        match &self.stage {
            Stage::Factor(factor) => factor,
            Stage::Iterations(iterations) => &**iterations,
        }
    }

    fn updater_mut(&mut self) -> &mut dyn LinearUpdater {
        match &mut self.stage {
            Stage::Factor(factor) => factor,
            Stage::Iterations(iterations) => &mut **iterations,
        }
    }

    /// Whether a factor of the committed nodes leaves room for one more window.
    fn factor_fits(&self, factor: &RecursiveCholesky) -> bool {
        let needed = factor.bytes(self.order.len() + LEAST_WINDOW, LEAST_WINDOW);
        let window = 2 * size_of::<f64>() * LEAST_WINDOW * LEAST_WINDOW;
        needed.saturating_add(window) <= self.budget
    }

    /// Gives up a factor that leaves no room.
    fn hand_over(&mut self, system: &System) -> Result<(), Error> {
        let order = std::mem::take(&mut self.order);
        let mut solution = Solution::default();
        let none = Touched::default();
        self.updater_mut()
            .solve(system, &none, order.len(), &mut solution)?;
        log::info!(
            "{} nodes in contact: the factor would exceed {} bytes, conjugate gradients from here",
            order.len(),
            self.budget
        );
        self.handed_over_at = Some(order.len());
        // The factor goes before anything takes its place.
        self.stage = Stage::Iterations(Box::default());
        if let Stage::Iterations(iterations) = &mut self.stage {
            iterations.take_over(system, order, &solution)?;
        }
        Ok(())
    }
}

impl LinearUpdater for Handover {
    fn schur(&mut self, system: &System, nodes: &[usize], schur: &mut Schur) -> Result<(), Error> {
        self.updater_mut().schur(system, nodes, schur)
    }

    /// Gives up the factor if it leaves no room for another window.
    fn commit(&mut self, system: &System, touched: &Touched) -> Result<(), Error> {
        self.updater_mut().commit(system, touched)?;
        if let Stage::Factor(_) = self.stage {
            self.order.extend_from_slice(touched.nodes());
        }
        match &self.stage {
            Stage::Factor(factor) if !self.factor_fits(factor) => self.hand_over(system),
            _ => Ok(()),
        }
    }

    fn solve(
        &mut self,
        system: &System,
        touched: &Touched,
        count: usize,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        self.updater_mut().solve(system, touched, count, solution)
    }

    fn window_cost(&self) -> WindowCost {
        self.updater().window_cost()
    }

    fn is_exact(&self) -> bool {
        self.updater().is_exact()
    }

    fn bytes(&self, contact: usize, watched: usize) -> usize {
        let order = self.order.capacity() * size_of::<usize>();
        self.updater().bytes(contact, watched).saturating_add(order)
    }

    fn set_memory_budget(&mut self, bytes: usize) {
        self.budget = bytes;
        if let Stage::Factor(factor) = &self.stage
            && self.order.is_empty()
            && !self.factor_fits(factor)
        {
            self.handed_over_at = Some(0);
            self.stage = Stage::Iterations(Box::default());
        }
    }
}
