//! How a loading path is set up.

use std::collections::VecDeque;
use std::fmt;
use std::sync::Arc;

use nalgebra::DMatrix;

use super::estimated::Estimated;
use super::exact::Exact;
use super::gap_field::GapField;
use super::history::History;
use super::limits::Limits;
use super::path::LoadingPath;
use super::phase::Phase;
use super::plastic::Plastic;
use super::releases::Releases;
use super::rule::ContactRule;
use super::run::{LoadingRun, LoadingTimings};
use super::scalars::PathScalars;
use super::single::Single;
use super::solver::LoadingSolver;
use crate::contact::{ContactSequence, ContactState, ContactTarget};
use crate::hardness::Limit;
use crate::memory::{self, Memory};
use crate::updater::{ConjugateGradient, Handover, LinearUpdater, WindowFactor};
use crate::{Boundary, ContactGrowth, Error, Grid, InfluenceKernel, Problem, Surface};

/// Sets up a [`LoadingSolver`]: the updater, the rule, the limits, the window, the memory budget.
#[derive(Debug, Clone)]
#[must_use = "a builder does nothing until it is built"]
pub struct LoadingBuilder<'a, U = Handover> {
    pub(super) settings: Settings<'a>,
    updater: U,
}

/// Everything but the updater.
#[derive(Clone)]
pub(super) struct Settings<'a> {
    surface: &'a dyn Surface,
    kernel: &'a dyn InfluenceKernel,
    rule: ContactRule,
    window_size: Option<usize>,
    max_nodes: Option<usize>,
    targets: Vec<ContactTarget>,
    memory_budget: Option<usize>,
    hand_over: Option<bool>,
    hardness: Limit<'a>,
}

impl fmt::Debug for Settings<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Settings")
            .field("grid", &self.kernel.grid())
            .field("rule", &self.rule)
            .field("window_size", &self.window_size)
            .field("max_nodes", &self.max_nodes)
            .field("targets", &self.targets)
            .field("memory_budget", &self.memory_budget)
            .field("hand_over", &self.hand_over)
            .field("has_hardness", &!matches!(self.hardness, Limit::None))
            .finish_non_exhaustive()
    }
}

impl LoadingSolver {
    /// The path of `surface` on the half-space of `kernel`, to full contact.
    ///
    /// # Errors
    ///
    /// As [`LoadingBuilder::build`].
    pub fn new(surface: &dyn Surface, kernel: &dyn InfluenceKernel) -> Result<Self, Error> {
        Self::builder(surface, kernel).build()
    }

    /// `Ok` if a path on a grid has room within a memory budget, by default that of
    /// [`LoadingBuilder::memory_budget`]: to be asked before a large surface is made. A path asks it too.
    ///
    /// # Errors
    ///
    /// [`Error::MemoryBudget`] if not even the grid fits.
    #[doc(hidden)]
    pub fn check_room(grid: &Grid, boundary: Boundary, budget: Option<usize>) -> Result<(), Error> {
        let budget = budget.unwrap_or_else(memory::default_budget);
        check_budget(LoadingRun::bytes_on(grid, boundary), budget)
    }

    /// The same for the whole path: `Ok` if it gets to full contact, by iterations where there is no room for a factor.
    ///
    /// # Errors
    ///
    /// [`Error::MemoryBudget`] if all nodes in contact do not fit.
    #[doc(hidden)]
    pub fn check_room_to_full_contact(
        grid: &Grid,
        boundary: Boundary,
        budget: Option<usize>,
    ) -> Result<(), Error> {
        let budget = budget.unwrap_or_else(memory::default_budget);
        let fixed = LoadingRun::bytes_on(grid, boundary);
        check_budget(fixed, budget)?;
        let bytes =
            |contact| fixed.saturating_add(ConjugateGradient::bytes_of(grid.nodes(), contact));
        // With the window of the last nodes.
        let needed = bytes(grid.nodes()).saturating_add(WindowFactor::bytes(8));
        if needed <= budget {
            return Ok(());
        }
        Err(Error::MemoryBudget {
            needed,
            budget,
            nodes_that_fit: budget.saturating_sub(bytes(0)) / (bytes(1) - bytes(0)).max(1),
        })
    }

    /// Sets up the path of `surface` on the half-space of `kernel`.
    pub fn builder<'a>(
        surface: &'a dyn Surface,
        kernel: &'a dyn InfluenceKernel,
    ) -> LoadingBuilder<'a> {
        LoadingBuilder::new(surface, kernel)
    }
}

impl<'a> LoadingBuilder<'a> {
    fn new(surface: &'a dyn Surface, kernel: &'a dyn InfluenceKernel) -> Self {
        let settings = Settings {
            surface,
            kernel,
            rule: ContactRule::default(),
            window_size: None,
            max_nodes: None,
            targets: Vec::new(),
            memory_budget: None,
            hand_over: None,
            hardness: Limit::None,
        };
        Self { settings, updater: Handover::new() }
    }
}

impl<'a, U: LinearUpdater> LoadingBuilder<'a, U> {
    /// Another updater, with no node in contact.
    pub fn updater<V: LinearUpdater>(self, updater: V) -> LoadingBuilder<'a, V> {
        LoadingBuilder { settings: self.settings, updater }
    }

    /// Whether the updater is given up for [`ConjugateGradient`] once that is cheaper for the rest of the path, or
    /// where the updater does not fit into the memory budget. By default [`Handover`] is, and no other updater.
    pub fn hand_over(mut self, may_end: bool) -> Self {
        self.settings.hand_over = Some(may_end);
        self
    }

    /// Which node touches next; exact by default.
    pub fn rule(mut self, rule: ContactRule) -> Self {
        self.settings.rule = rule;
        self
    }

    /// How many nodes to watch at a time. By default as many as make an event cheapest; states do not depend on it,
    /// except by rounding. With 1 every node costs one convolution and one row of the factor, as in the paper. Without
    /// a factor it is eight at least, to tell them apart.
    pub fn window_size(mut self, nodes: usize) -> Self {
        self.settings.window_size = Some(nodes);
        self
    }

    /// Ends the path at a target: at exactly this load, mean pressure, approach or mean gap, or with as many nodes in
    /// contact as fit into this fraction of the nominal area. Of several targets the first one reached
    /// counts. A target beyond full contact is not reached: the path ends there
    /// ([`LoadingEnd::FullContact`](super::LoadingEnd::FullContact)), and [`History::at`](super::History::at) reads
    /// what lies beyond.
    pub fn until(mut self, target: ContactTarget) -> Self {
        self.settings.targets.push(target);
        self
    }

    /// Ends the path at exactly this load \[N\].
    pub fn max_load(self, load: f64) -> Self {
        self.until(ContactTarget::Load(load))
    }

    /// Ends the path at exactly this load over the nominal area \[Pa\].
    pub fn max_mean_pressure(self, mean_pressure: f64) -> Self {
        self.until(ContactTarget::MeanPressure(mean_pressure))
    }

    /// Ends the path at exactly this approach \[m\].
    pub fn max_approach(self, approach: f64) -> Self {
        self.until(ContactTarget::Approach(approach))
    }

    /// Ends the path at exactly this mean gap \[m\].
    pub fn min_mean_gap(self, mean_gap: f64) -> Self {
        self.until(ContactTarget::MeanGap(mean_gap))
    }

    /// Ends the path before one more node would exceed this fraction (above 0, at most 1) of the nominal
    /// area; see [`Grid::nodes_in`](crate::Grid::nodes_in).
    pub fn max_area_fraction(self, fraction: f64) -> Self {
        self.until(ContactTarget::AreaFraction(fraction))
    }

    /// Ends the path before the first event that would bring more than this many nodes into contact; with a hardness
    /// also before a node yields once so many are.
    pub fn max_nodes(mut self, nodes: usize) -> Self {
        self.settings.max_nodes = Some(nodes);
        self
    }

    /// Limits the pressure to a hardness H \[Pa\]: elastic–perfectly plastic contact (Almqvist et al., Tribology
    /// International 40 (2007) 574). A node whose pressure rises to H *yields*, a state of its own
    /// ([`ContactEvent::Yield`]): from then on it carries H, stays in contact, and loses as much of its height as it
    /// would overlap. The path goes on behind full contact until all nodes have yielded, under the load H A, unless a
    /// limit ends it; no load limit may be as great as that. Infinity limits nothing.
    ///
    /// Contact must be known to grow ([`ContactGrowth`]). An updater needs [`watch_both`](LinearUpdater::watch_both),
    /// [`solve_for`](LinearUpdater::solve_for), [`release`](LinearUpdater::release) and
    /// [`truncate`](LinearUpdater::truncate) for it; iterations ([`ConjugateGradient`]) serve it as well, and take over
    /// from a factor as on elastic paths. The factor then holds elastic nodes only.
    ///
    /// [`ContactEvent::Yield`]: super::ContactEvent::Yield
    pub fn hardness(mut self, hardness: f64) -> Self {
        self.settings.hardness = Limit::Uniform(hardness);
        self
    }

    /// The same with a hardness for each node \[Pa\], nx × ny.
    pub fn hardness_map(mut self, hardness: &'a DMatrix<f64>) -> Self {
        self.settings.hardness = Limit::Map(hardness);
        self
    }

    /// Ends the path with an error before it holds more than this many bytes; every state up to there has
    /// then been yielded. By default three quarters of the memory that the process may use, where the system tells it
    /// (Linux), and without limit elsewhere. Close to the limit windows become smaller. What each thread takes for
    /// products of matrices, some 5 MB, comes on top of it.
    pub fn memory_budget(mut self, bytes: usize) -> Self {
        self.settings.memory_budget = Some(bytes);
        self
    }

    /// Samples the surface, tabulates the kernel, and prepares the path before its first state.
    ///
    /// # Errors
    ///
    /// Those of [`Problem::new`]; [`Error::NotPositive`] and [`Error::OutOfRange`] for limits that make no sense;
    /// [`SurfaceError::LessThanOneNode`](crate::SurfaceError::LessThanOneNode) for an area fraction without a node;
    /// [`Error::MemoryBudget`] if not even the grid fits. With a hardness [`Error::NotPositive`] and
    /// [`Error::GridMismatch`] for itself, [`Error::BeyondHardness`] for a load that it cannot bear, and
    /// [`KernelError::GrowthUnknown`](crate::KernelError::GrowthUnknown) for a kernel that does not promise that contact
    /// grows.
    pub fn build(self) -> Result<LoadingSolver<U>, Error> {
        let phase = Phase::new(self.updater, self.settings.hand_over);
        self.settings.build(phase).map(LoadingSolver::of)
    }

    /// The same path, to go on behind states that it yielded before, in another process perhaps: the next state
    /// is the one after the last event among them. A limit is no event.
    ///
    /// States [of a record](crate::record::LoadingRecord::history) know the end of their last window, where the path
    /// then goes on: see [`LoadingRecord::resume`](crate::record::LoadingRecord::resume).
    ///
    /// Otherwise nothing is searched for again: a factor is made of the nodes in contact in large blocks, n³/3 flops at
    /// the speed of a matrix product; without one a solution is all. The solution is compared with the last state,
    /// so that states of another surface or kernel are refused.
    ///
    /// # Errors
    ///
    /// Those of [`Self::build`]; [`Error::OutOfRange`] for a limit that the states have passed (for the state there see
    /// [`History::ending_at`]); [`Error::NotOnPath`] for states that are not those of this path, or not in the order of
    /// a path; [`Error::NodeOutOfGrid`], [`Error::AlreadyInContact`] and [`Error::NotInContact`] for nodes that are in
    /// no such order; [`Error::MemoryBudget`]; those of the updater.
    pub fn resume(self, history: &History) -> Result<LoadingSolver<U>, Error> {
        let mut solver = self.build()?;
        solver.go_on(history)?;
        Ok(solver)
    }
}

impl<'a> Settings<'a> {
    /// The path before its first state.
    pub(super) fn build(self, mut phase: Phase) -> Result<LoadingPath, Error> {
        if self.window_size == Some(0) {
            return Err(Error::OutOfRange {
                quantity: "window size",
                value: 0.0,
                expected: "at least 1",
            });
        }
        let budget = self.memory_budget.unwrap_or_else(memory::default_budget);
        let (grid, boundary) = (self.kernel.grid(), self.kernel.boundary());
        let mut fixed_bytes = LoadingRun::bytes_on(&grid, boundary);
        check_budget(fixed_bytes, budget)?;
        let problem = match self.hardness {
            Limit::None => Problem::new(self.surface, self.kernel)?,
            _ => Problem::with_hardness(self.surface, self.kernel)?,
        };
        // A user-defined kernel may say something else when it is asked again.
        grid.check_shape(problem.grid().shape())?;
        let limits = self.limits(&problem)?;
        let growth = problem.growth();
        if growth == ContactGrowth::Unknown {
            fixed_bytes += LoadingRun::bytes_where_nodes_leave(&grid);
            check_budget(fixed_bytes, budget)?;
        }
        let (plastic, problem) = match self.hardness.resolve(&problem)? {
            Some(hardness) => {
                limits.check_hardness(&hardness, &grid)?;
                fixed_bytes += Plastic::bytes_on(&grid, boundary);
                check_budget(fixed_bytes, budget)?;
                let (plastic, elastic) = Plastic::new(hardness, problem);
                (Some(Arc::new(plastic)), elastic)
            }
            None => (None, problem),
        };
        let settles = self.rule == ContactRule::FirstContact;
        // Before first touch.
        let unloaded = ContactState::new(&grid, 0, 0.0, 0.0, f64::INFINITY);
        let last = (growth != ContactGrowth::Unknown).then_some(unloaded);
        let mut scalars = PathScalars::new(&problem);
        if plastic.is_some() {
            scalars = scalars.with_hardness();
        }
        let mut run = LoadingRun {
            contact: ContactSequence::new(problem.grid()),
            releases: Releases::default(),
            field: GapField::new(&problem),
            scalars,
            problem,
            plastic,
            queue: VecDeque::new(),
            memory: Memory { budget, fixed: fixed_bytes },
            last,
            inherited: 0.0,
            timings: LoadingTimings::default(),
        };
        let end = limits.expected_nodes(grid.nodes(), None);
        let window_size = self.window_size.map(|size| size.min(grid.nodes()));
        let handed_over_at = phase.hand_over(&mut run, end)?.then_some(0);
        phase.make_room(&run)?;
        Ok(LoadingPath {
            run,
            phase,
            exact: Exact::new(growth, window_size),
            estimated: Estimated::new(window_size, settles),
            single: Single::default(),
            handed_over_at,
            rebuilt_at: None,
            rule: self.rule,
            limits,
            state: None,
            failure: None,
            end: None,
        })
    }

    fn limits(&self, problem: &Problem) -> Result<Limits, Error> {
        let grid = problem.grid();
        let mut limits = Limits::default();
        for &target in &self.targets {
            limits.set(target, &grid, problem.mean_gap())?;
        }
        if let Some(nodes) = self.max_nodes {
            limits.set_nodes(nodes)?;
        }
        Ok(limits)
    }
}

/// `Ok` if the bytes that a path holds before its first node is in contact are within a budget.
fn check_budget(needed: usize, budget: usize) -> Result<(), Error> {
    if needed <= budget {
        return Ok(());
    }
    Err(Error::MemoryBudget { needed, budget, nodes_that_fit: 0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_chain;
    use crate::updater::{RecursiveCholesky, WindowFactor};

    /// What the grid leaves of a budget is the updater's: a factor needs room for one window.
    #[test]
    fn the_updater_has_what_the_grid_leaves() -> Result<(), Error> {
        let (surface, kernel) = (test_chain::surface(&[0.0; 9])?, test_chain::kernel(9)?);
        let fixed = LoadingRun::bytes_on(&test_chain::grid(9)?, Boundary::Free);
        let window = RecursiveCholesky::new().bytes(64, 64) + WindowFactor::bytes(64);
        for (budget, handed_over_at) in [(fixed + window, None), (fixed + window - 1, Some(0))] {
            let builder = LoadingSolver::builder(&surface, &kernel).memory_budget(budget);
            assert_eq!(builder.build()?.handed_over_at(), handed_over_at);
        }
        for (budget, has_room) in [(fixed, true), (fixed - 1, false)] {
            let found =
                LoadingSolver::check_room(&test_chain::grid(9)?, Boundary::Free, Some(budget));
            assert_eq!(found.is_ok(), has_room);
        }
        Ok(())
    }

    /// A mean pressure is a load: 3 Pa on nine cells of 2 m². The nearest limit of a kind counts.
    #[test]
    fn limits_of_a_path() -> Result<(), Error> {
        use ContactTarget::{Approach, Load};
        let (surface, kernel) = (test_chain::surface(&[0.0; 9])?, test_chain::kernel(9)?);
        let path = LoadingSolver::builder(&surface, &kernel)
            .max_load(9.0)
            .max_approach(2.0)
            .max_approach(1.0)
            .max_mean_pressure(0.25)
            .build()?;
        assert_eq!(path.targets(), [Load(4.5), Approach(1.0)]);
        let printed = format!("{:?}", LoadingSolver::builder(&surface, &kernel).max_load(9.0));
        assert!(printed.contains("targets: [Load(9.0)]"), "{printed}");
        for (window, is_one) in [(0, false), (1, true)] {
            let built = LoadingSolver::builder(&surface, &kernel).window_size(window).build();
            assert_eq!(built.is_ok(), is_one);
        }
        Ok(())
    }
}
