//! A factor as long as it pays, iterations after.

use super::{
    ConjugateGradient, LinearUpdater, RecursiveCholesky, Schur, Solution, SolveRequest, Touched,
    UpdaterProfile,
};
use crate::contact::ContactSequence;
use crate::{Error, Problem};

/// Watched nodes for which the factor must have room. With fewer, its solutions would be shared by
/// so few events that iterations are no slower.
const LEAST_WINDOW: usize = 64;

/// Seconds of an event with a factor of n nodes, per n²: a matrix product.
const FACTOR: f64 = 1.0e-11;
/// Seconds of an event by iterations, per node of the grid and per node in contact: convolutions, and what
/// goes with them on the contact.
const ITERATIONS: [f64; 2] = [4.0e-9, 6.0e-9];
/// The same for any grid: local solutions and events.
const WINDOW: f64 = 3.0e-4;

/// The default: [`RecursiveCholesky`] as long as its events are cheaper than those of [`ConjugateGradient`]
/// and its factor fits the memory budget of the path, and [`ConjugateGradient`] from then on. No path ends
/// for want of memory for n² numbers, unless the budget is less than iterations take on the grid alone; and full contact on 512 × 512
/// nodes takes minutes.
///
/// An event costs some n² times 10 ps with a factor of n nodes, and without some 0.3 ms, 4 ns for each node of
/// the grid and 6 ns for each one in contact: the factor is given up at some 6400 contact nodes on a grid of
/// 128², 7800 on 256², and 11 900 on 512². These are constants and not measurements, so that a path is the
/// same on every run. The budget is that of
/// [`LoadingBuilder::memory_budget`](crate::loading::LoadingBuilder::memory_budget).
///
/// On periodic cells that are [too long](ConjugateGradient::MAX_ASPECT) for iterations the factor stays as long as it fits the budget.
///
/// Events are the same on both sides of the seam; before it states are exact to rounding, behind it as
/// [`loading`](crate::loading) says. A message of the level `info` goes to the crate `log`, and
/// [`handed_over_at`](Self::handed_over_at) says where it was. For a path exact to rounding whatever it
/// costs, take [`RecursiveCholesky`] itself.
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

    /// Seconds that an event with so many nodes in contact takes on a grid of `nodes`, on a machine with
    /// two cores: for telling how long a path will take.
    #[must_use]
    pub fn event_cost(nodes: usize, contact: usize) -> f64 {
        Self::factor_cost(contact).min(Self::iteration_cost(nodes, contact))
    }

    /// Nodes in contact at which a factor costs as much as iterations on a grid of `nodes`: where it is given up if
    /// memory allows.
    #[must_use]
    pub fn last_factor(nodes: usize) -> usize {
        // Both costs grow with the contact, and that of a factor faster: one crossing.
        let dearer =
            |contact: &usize| Self::factor_cost(*contact) > Self::iteration_cost(nodes, *contact);
        let (mut low, mut high) = (0, nodes);
        while low < high {
            let middle = low.midpoint(high);
            if dearer(&middle) {
                high = middle;
            } else {
                low = middle + 1;
            }
        }
        low
    }

    fn factor_cost(contact: usize) -> f64 {
        FACTOR * (contact as f64).powi(2)
    }

    fn iteration_cost(nodes: usize, contact: usize) -> f64 {
        WINDOW + ITERATIONS[0] * nodes as f64 + ITERATIONS[1] * contact as f64
    }

    /// Whether a factor of `contact` nodes pays, or there is nothing else, and leaves room for one more window.
    fn factor_serves(&self, factor: &RecursiveCholesky, problem: &Problem, contact: usize) -> bool {
        let nodes = problem.grid().nodes();
        let pays = Self::factor_cost(contact) <= Self::iteration_cost(nodes, contact);
        self.factor_fits(factor, contact)
            && (pays || ConjugateGradient::check_cells(problem).is_err())
    }

    /// Whether a factor of `contact` nodes leaves room for one more window.
    fn factor_fits(&self, factor: &RecursiveCholesky, contact: usize) -> bool {
        let needed = factor.bytes(contact + LEAST_WINDOW, LEAST_WINDOW);
        needed.saturating_add(Touched::bytes(LEAST_WINDOW)) <= self.budget
    }

    /// Gives up the factor, with its last solution.
    fn hand_over(&mut self, problem: &Problem, contact: &ContactSequence) -> Result<(), Error> {
        let mut iterations = Box::<ConjugateGradient>::default();
        iterations.check_room(problem, self.budget, contact.len())?;
        let mut solution = Solution::default();
        // At any approach: with the rate it is known at all others.
        let request = SolveRequest::exact(contact.len(), 0.0);
        self.updater_mut()
            .solve(problem, contact, request, &mut solution)?;
        log::info!(
            "{} nodes in contact: without a factor from here",
            contact.len()
        );
        self.handed_over_at = Some(contact.len());
        // The factor goes before anything takes its place.
        self.stage = Stage::Iterations(Box::default());
        iterations.take_over(problem, contact, request.approach, &solution)?;
        self.stage = Stage::Iterations(iterations);
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

    /// Gives up the factor once it does not serve any more.
    fn join(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        touched: &Touched,
    ) -> Result<(), Error> {
        self.updater_mut().join(problem, contact, touched)?;
        let Stage::Factor(factor) = &self.stage else {
            return Ok(());
        };
        if self.factor_serves(factor, problem, contact.len()) {
            return Ok(());
        }
        match self.hand_over(problem, contact) {
            // There is room for the factor, and none for iterations: it grows up to where a window of one node does not fit.
            Err(Error::MemoryBudget { .. }) => Ok(()),
            done => done,
        }
    }

    fn solve(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        request: SolveRequest,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        self.updater_mut()
            .solve(problem, contact, request, solution)
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

    fn make_room(&mut self, problem: &Problem, bytes: usize) -> Result<(), Error> {
        self.budget = bytes;
        if let Stage::Factor(factor) = &self.stage
            && !self.factor_fits(factor, 0)
        {
            self.handed_over_at = Some(0);
            self.stage = Stage::Iterations(Box::default());
        }
        self.updater_mut().make_room(problem, bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Boussinesq, Grid, HeightMap, InfluenceKernel, Spectral};

    /// Flat, on 128 × 128 nodes.
    fn flat(kernel: &dyn InfluenceKernel) -> Result<Problem, Error> {
        let surface = HeightMap::new(nalgebra::DMatrix::zeros(128, 128))?;
        Problem::new(&surface, kernel)
    }

    /// 10 ps · n², and 0.3 ms, 4 ns a node and 6 ns a node in contact.
    #[test]
    fn costs_of_an_event() {
        for (nodes, contact, cost) in [
            (0, 1000, 1e-5),
            (1_000_000, 10_000, 1e-3),
            (10_000, 10_000, 3e-4 + 4e-5 + 6e-5),
            (1_000_000, 100_000, 3e-4 + 4e-3 + 6e-4),
        ] {
            let found = Handover::event_cost(nodes, contact);
            assert!(
                (found / cost - 1.0).abs() < 1e-14,
                "{nodes} {contact}: {found:e}"
            );
        }
    }

    /// The root of `10⁻¹¹ n² = 3·10⁻⁴ + 4·10⁻⁹ N + 6·10⁻⁹ n`, rounded up; all nodes if there is none among them.
    #[test]
    fn a_factor_is_given_up_where_costs_meet() {
        for nodes in [128 * 128, 256 * 256, 512 * 512] {
            let fixed = 3e-4 + 4e-9 * nodes as f64;
            let root = (6e-9 + (36e-18 + 4e-11 * fixed).sqrt()) / 2e-11;
            assert_eq!(Handover::last_factor(nodes), root.ceil() as usize);
        }
        assert_eq!([100, 1000].map(Handover::last_factor), [100, 1000]);
    }

    /// The factor and one more window: bytes of 64 nodes more in contact and 64 watched, and of their Schur complement and
    /// its factor, 1024 · 64.
    #[test]
    fn a_factor_fits_with_one_more_window() -> Result<(), Error> {
        let factor = RecursiveCholesky::new();
        let square = flat(&Boussinesq::new(Grid::square(128, 1.0)?, 1.0)?)?;
        let needed = factor.bytes(364, 64) + 1024 * 64;
        let mut handover = Handover::new();
        for (budget, fits) in [(needed, true), (needed - 1, false)] {
            handover.budget = budget;
            assert_eq!(handover.factor_fits(&factor, 300), fits);
            assert_eq!(handover.factor_serves(&factor, &square, 300), fits);
        }
        handover.budget = usize::MAX;
        assert_eq!(handover.bytes(300, 64), factor.bytes(300, 64));
        let last = Handover::last_factor(128 * 128);
        let serves = |problem: &Problem| {
            [last - 1, last].map(|contact| handover.factor_serves(&factor, problem, contact))
        };
        assert_eq!(serves(&square), [true, false]);
        // There is no other way on cells that iterations are not made for.
        let long = flat(&Spectral::new(Grid::new(128, 128, 1.0, 1e4)?, 1.0)?)?;
        assert_eq!(serves(&long), [true, true]);
        // Told of less than one window, it begins without a factor.
        let problem = crate::row::problem(&[0.0; 4])?;
        let first = factor.bytes(64, 64) + 1024 * 64;
        for (bytes, handed_over_at) in [(first, None), (first - 1, Some(0))] {
            let mut handover = Handover::new();
            handover.make_room(&problem, bytes)?;
            assert_eq!(handover.handed_over_at(), handed_over_at);
            assert_eq!(handover.profile().exact, handed_over_at.is_none());
        }
        Ok(())
    }
}
