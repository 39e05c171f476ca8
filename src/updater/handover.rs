//! A factor as long as it fits, iterations after.

use super::{
    ConjugateGradient, LinearUpdater, RecursiveCholesky, Schur, Solution, SolveRequest, Touched,
    UpdaterProfile,
};
use crate::contact::ContactSequence;
use crate::{Error, Problem};

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
/// let mut path = LoadingSolver::builder(&Paraboloid::new(10.0)?, &kernel)
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
    handed_over_at: Option<usize>,
}

#[derive(Debug, Clone)]
enum Stage {
    Factor(Box<RecursiveCholesky>),
    Iterations(Box<ConjugateGradient>),
}

impl Default for Handover {
    fn default() -> Self {
        Self::new()
    }
}

impl Handover {
    /// No node in contact, and no bound on memory before the path sets its own.
    #[must_use]
    pub fn new() -> Self {
        Self {
            stage: Stage::Factor(Box::default()),
            budget: usize::MAX,
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
            Stage::Factor(factor) => &**factor,
            Stage::Iterations(iterations) => &**iterations,
        }
    }

    fn updater_mut(&mut self) -> &mut dyn LinearUpdater {
        match &mut self.stage {
            Stage::Factor(factor) => &mut **factor,
            Stage::Iterations(iterations) => &mut **iterations,
        }
    }

    /// Whether a factor of `contact` nodes leaves room for one more window.
    fn factor_fits(&self, factor: &RecursiveCholesky, contact: usize) -> bool {
        let needed = factor.bytes(contact + LEAST_WINDOW, LEAST_WINDOW);
        needed.saturating_add(Touched::bytes(LEAST_WINDOW)) <= self.budget
    }

    /// Gives up a factor that leaves no room, with its last solution.
    fn hand_over(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        approach: f64,
        solution: &Solution,
    ) -> Result<(), Error> {
        log::info!(
            "{} nodes in contact: the factor would exceed {} bytes, conjugate gradients from here",
            contact.len(),
            self.budget
        );
        self.handed_over_at = Some(contact.len());
        // The factor goes before anything takes its place.
        self.stage = Stage::Iterations(Box::default());
        if let Stage::Iterations(iterations) = &mut self.stage {
            iterations.take_over(problem, contact, approach, solution)?;
        }
        Ok(())
    }
}

impl LinearUpdater for Handover {
    fn watch(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        self.updater_mut().watch(problem, contact, nodes, schur)
    }

    fn join(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        touched: &Touched,
    ) -> Result<(), Error> {
        self.updater_mut().join(problem, contact, touched)
    }

    /// Gives up the factor if it leaves no room for another window.
    fn solve(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        request: SolveRequest,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        let updater = self.updater_mut();
        updater.solve(problem, contact, request, solution)?;
        match &self.stage {
            Stage::Factor(factor)
                if request.count == contact.len() && !self.factor_fits(factor, contact.len()) =>
            {
                self.hand_over(problem, contact, request.approach, solution)
            }
            _ => Ok(()),
        }
    }

    fn truncate(&mut self, problem: &Problem, contact: &ContactSequence) -> Result<(), Error> {
        self.updater_mut().truncate(problem, contact)
    }

    fn release(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        node: usize,
        position: usize,
    ) -> Result<(), Error> {
        self.updater_mut().release(problem, contact, node, position)
    }

    fn profile(&self) -> UpdaterProfile {
        self.updater().profile()
    }

    fn bytes(&self, contact: usize, watched: usize) -> usize {
        self.updater().bytes(contact, watched)
    }

    fn make_room(&mut self, bytes: usize) {
        self.budget = bytes;
        if let Stage::Factor(factor) = &self.stage
            && !self.factor_fits(factor, 0)
        {
            self.handed_over_at = Some(0);
            self.stage = Stage::Iterations(Box::default());
        }
    }
}
