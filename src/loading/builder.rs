//! How a loading path is set up.

use std::collections::VecDeque;

use super::fields::Fields;
use super::limits::{ContactRule, Limits};
use super::solver::{Front, LoadingSolver, LoadingTimings};
use super::stepwise::Stepwise;
use super::window::Window;
use crate::convolution::Convolution;
use crate::initial_gap::InitialGap;
use crate::kernel::KernelTable;
use crate::updater::{LinearUpdater, RecursiveCholesky, Solution, System};
use crate::{Error, InfluenceKernel, Surface, memory};

/// Sets up a [`LoadingSolver`]: the updater, the rule, the limits, the window, the memory budget.
#[derive(Debug, Clone)]
#[must_use = "a builder does nothing until it is built"]
pub struct LoadingBuilder<S, K, U = RecursiveCholesky> {
    surface: S,
    kernel: K,
    updater: U,
    rule: ContactRule,
    window_size: Option<usize>,
    max_nodes: Option<usize>,
    max_load: Option<f64>,
    max_approach: Option<f64>,
    max_area_fraction: Option<f64>,
    memory_budget: Option<usize>,
}

impl<S: Surface, K: InfluenceKernel> LoadingSolver<S, K, RecursiveCholesky> {
    /// The path of `surface` on the half-space of `kernel`, to full contact.
    ///
    /// # Errors
    ///
    /// As [`LoadingBuilder::build`].
    pub fn new(surface: S, kernel: K) -> Result<Self, Error> {
        Self::builder(surface, kernel).build()
    }

    /// Sets up the path of `surface` on the half-space of `kernel`.
    pub fn builder(surface: S, kernel: K) -> LoadingBuilder<S, K> {
        LoadingBuilder {
            surface,
            kernel,
            updater: RecursiveCholesky::new(),
            rule: ContactRule::default(),
            window_size: None,
            max_nodes: None,
            max_load: None,
            max_approach: None,
            max_area_fraction: None,
            memory_budget: None,
        }
    }
}

impl<S: Surface, K: InfluenceKernel, U: LinearUpdater> LoadingBuilder<S, K, U> {
    /// Another updater, with an empty contact set.
    pub fn updater<V: LinearUpdater>(self, updater: V) -> LoadingBuilder<S, K, V> {
        LoadingBuilder {
            surface: self.surface,
            kernel: self.kernel,
            updater,
            rule: self.rule,
            window_size: self.window_size,
            max_nodes: self.max_nodes,
            max_load: self.max_load,
            max_approach: self.max_approach,
            max_area_fraction: self.max_area_fraction,
            memory_budget: self.memory_budget,
        }
    }

    /// Which node touches next; exact by default.
    pub fn rule(mut self, rule: ContactRule) -> Self {
        self.rule = rule;
        self
    }

    /// How many nodes to watch at a time. By default as many as make an event cheapest; the states
    /// do not depend on it but for rounding. With 1 the procedure is the paper's, literally: one
    /// convolution and one row of the factor for each node. A kernel of
    /// [`ContactGrowth::Unknown`](crate::ContactGrowth::Unknown) is always followed one event at a
    /// time.
    pub fn window_size(mut self, nodes: usize) -> Self {
        self.window_size = Some(nodes);
        self
    }

    /// Ends the path before the first event that would bring more than this many nodes into contact.
    pub fn max_nodes(mut self, nodes: usize) -> Self {
        self.max_nodes = Some(nodes);
        self
    }

    /// Ends the path before the first event beyond this load \[N\].
    pub fn max_load(mut self, load: f64) -> Self {
        self.max_load = Some(load);
        self
    }

    /// Ends the path before the first event beyond this approach \[m\].
    pub fn max_approach(mut self, approach: f64) -> Self {
        self.max_approach = Some(approach);
        self
    }

    /// Ends the path when one more node would exceed this fraction (0 to 1) of the nominal area.
    pub fn max_area_fraction(mut self, fraction: f64) -> Self {
        self.max_area_fraction = Some(fraction);
        self
    }

    /// Ends the path with an error before it holds more than this many bytes; every state up to
    /// there has then been yielded. By default what the system has free when the path is built, where
    /// it says so (Linux), and without limit elsewhere. Close to the limit windows become smaller.
    pub fn memory_budget(mut self, bytes: usize) -> Self {
        self.memory_budget = Some(bytes);
        self
    }

    /// Samples the surface, evaluates the kernel, and prepares the path before its first state.
    ///
    /// # Errors
    ///
    /// Those of the surface and of the kernel; [`Error::HeightNotFinite`];
    /// [`Error::GridMismatch`] if the surface returns heights of another grid;
    /// [`Error::NotPositive`] and [`Error::OutOfRange`] for limits that make no sense;
    /// [`Error::MemoryBudget`] if not even the grid fits.
    pub fn build(self) -> Result<LoadingSolver<S, K, U>, Error> {
        let grid = self.kernel.grid();
        let limits = self.limits()?;
        if self.window_size == Some(0) {
            return Err(Error::OutOfRange {
                quantity: "window size",
                value: 0.0,
                expected: "at least 1",
            });
        }

        let gap = InitialGap::of(&self.surface, &grid)?;
        let table = KernelTable::new(&self.kernel)?;
        let mut fields = Fields::new(Convolution::from_table(&table)?, grid.nodes());
        let row_sums = fields.displacement(&vec![1.0; grid.nodes()])?.to_vec();
        let growth = self.kernel.contact_growth();
        let gauge = table.gauge().unwrap_or_default() / grid.cell_area();
        let system = System::new(table, gap.values, row_sums)?;
        let budget = self
            .memory_budget
            .or_else(memory::available)
            .unwrap_or(usize::MAX);
        let mut path = LoadingSolver {
            contact: Vec::with_capacity(limits.nodes),
            in_contact: vec![false; grid.nodes()],
            committed: 0,
            ranking: Vec::with_capacity(grid.nodes()),
            window: Window::default(),
            solution: Solution::default(),
            solved: None,
            front: Front::default(),
            stepwise: Stepwise::default(),
            ahead: VecDeque::new(),
            failure: None,
            state: None,
            timings: LoadingTimings::default(),
            finished: false,
            surface: self.surface,
            kernel: self.kernel,
            updater: self.updater,
            rule: self.rule,
            window_size: self.window_size,
            limits,
            memory_budget: budget,
            grid,
            gauge,
            growth,
            system,
            fields,
            rms_height: gap.rms_height,
            greatest_gap: gap.greatest,
        };
        let needed = path.fixed_bytes();
        if needed > budget {
            return Err(Error::MemoryBudget {
                needed,
                budget,
                nodes_that_fit: 0,
            });
        }
        path.updater.set_memory_budget(budget - needed);
        Ok(path)
    }

    fn limits(&self) -> Result<Limits, Error> {
        let grid = self.kernel.grid();
        let mut limits = Limits::none(&grid);
        if let Some(nodes) = self.max_nodes {
            limits.nodes = limits.nodes.min(nodes);
        }
        if let Some(load) = self.max_load {
            limits.load = Error::require_positive("greatest load", load)?;
        }
        if let Some(approach) = self.max_approach {
            limits.approach = Error::require_positive("greatest approach", approach)?;
        }
        if let Some(fraction) = self.max_area_fraction {
            limits.area_fraction(&grid, fraction)?;
        }
        Ok(limits)
    }
}
