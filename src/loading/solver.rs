//! The iterator over contact states.

use std::collections::VecDeque;
use std::iter::FusedIterator;
use std::time::Duration;

use super::fields::Fields;
use super::limits::{ContactRule, Limits};
use super::state::ContactState;
use super::stepwise::Stepwise;
use super::window::Window;
use crate::updater::{LinearUpdater, RecursiveCholesky, Solution, System, Touched};
use crate::{ContactGrowth, Error, Grid, InfluenceKernel, Surface};

/// The exact loading path of a rigid rough surface on an elastic half-space.
///
/// A fused iterator: it yields one [`ContactState`] for each node that touches (or leaves, with a
/// kernel that lets nodes leave), from first touch (approach 0, load 0) up to full contact or a
/// limit, and `None` for ever after that or after an error. Fields of the present state, that of the last item, are computed on demand.
///
/// ```
/// use asperity::surface::{Amplitude, SelfAffine};
/// use asperity::{Boussinesq, Grid, LoadingSolver};
///
/// # fn main() -> Result<(), asperity::Error> {
/// let grid = Grid::square(32, 1e-2)?;
/// let surface = SelfAffine::new(0.8, 2.5e-3, 1.25e-3, Amplitude::RmsHeight(50e-6), 7)?;
/// let mut path = LoadingSolver::builder(surface, Boussinesq::new(grid, 1.0)?)
///     .max_area_fraction(0.1)
///     .build()?;
/// while let Some(state) = path.next() {
///     let state = state?;
///     println!("{} nodes carry {} N", state.contact_nodes, state.load);
/// }
/// assert!(path.certificate()?.least_pressure > -1e-12);
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct LoadingSolver<S, K, U = RecursiveCholesky> {
    pub(super) surface: S,
    pub(super) kernel: K,
    pub(super) updater: U,
    pub(super) rule: ContactRule,
    pub(super) window_size: Option<usize>,
    pub(super) limits: Limits,
    pub(super) memory_budget: usize,
    pub(super) grid: Grid,
    pub(super) growth: ContactGrowth,
    /// The gauge of a periodic kernel over the cell area, zero of a free one: the approach in the
    /// gauge is that of the mean planes and this times the load.
    pub(super) gauge: f64,
    pub(super) system: System,
    pub(super) fields: Fields,
    pub(super) rms_height: f64,
    pub(super) greatest_gap: f64,
    pub(super) window: Window,
    pub(super) solution: Solution,
    /// For how many of the nodes in contact the solution is, if it is for any.
    pub(super) solved: Option<usize>,
    /// Nodes in contact, in the order in which they touched.
    pub(super) contact: Vec<usize>,
    pub(super) in_contact: Vec<bool>,
    /// How many of them the updater knows.
    pub(super) committed: usize,
    /// Scratch for the choice of the watched nodes: (key, node).
    pub(super) ranking: Vec<(f64, usize)>,
    pub(super) front: Front,
    pub(super) stepwise: Stepwise,
    /// States that are computed but not yielded yet.
    pub(super) ahead: VecDeque<ContactState>,
    /// What went wrong after them.
    pub(super) failure: Option<Error>,
    pub(super) state: Option<ContactState>,
    pub(super) timings: LoadingTimings,
    pub(super) finished: bool,
}

/// Where a path spent its time, beside its updater.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct LoadingTimings {
    /// Number of windows.
    pub windows: usize,
    /// Number of events that were computed and then taken back, because a state did not stand the
    /// check at the end of its window.
    pub taken_back: usize,
    /// Displacements of all nodes, at every refresh and every check of a window.
    pub convolution: Duration,
    /// Choice of the nodes to watch, once all displacements are known.
    pub choice: Duration,
    /// Events inside the windows.
    pub events: Duration,
}

/// The front of the path: where the last event left it. What the scalars of a state are made of,
/// kept up to date at every event.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Front {
    pub(super) approach: f64,
    pub(super) load: f64,
    pub(super) energy: f64,
    pub(super) mean_gap: f64,
    /// $e^T C_{II}^{-1} e$: stiffness per cell area.
    pub(super) unit_unit: f64,
    /// Mean of $r_2$: how fast the mean gap closes with the approach.
    pub(super) closing: f64,
}

impl<S: Surface, K: InfluenceKernel, U: LinearUpdater> LoadingSolver<S, K, U> {
    /// Solves for the first `count` nodes in contact, unless that is what was done last.
    pub(super) fn solve(&mut self, count: usize) -> Result<(), Error> {
        if self.solved == Some(count) {
            return Ok(());
        }
        self.solved = None;
        let pending = self.contact.len() - self.committed;
        let none = Touched::default();
        let touched = if pending > 0 {
            self.window.touched()
        } else {
            &none
        };
        self.updater
            .solve(&self.system, touched, count, &mut self.solution)?;
        for (quantity, values) in [("y1", &self.solution.y1), ("y2", &self.solution.y2)] {
            if values.len() != count {
                return Err(Error::UpdaterMismatch {
                    quantity,
                    expected: count,
                    found: values.len(),
                });
            }
        }
        self.solved = Some(count);
        Ok(())
    }

    /// Hands the nodes that touched over to the updater.
    pub(super) fn commit(&mut self) -> Result<(), Error> {
        let count = self.contact.len();
        if count > self.committed {
            self.updater.commit(&self.system, self.window.touched())?;
            self.committed = count;
            self.solved = None;
        }
        Ok(())
    }

    /// The next state, `None` at the end of the path.
    fn advance(&mut self) -> Result<Option<ContactState>, Error> {
        if self.ahead.is_empty() {
            if let Some(error) = self.failure.take() {
                return Err(error);
            }
            self.failure = self.produce()?;
        }
        let state = self.ahead.pop_front();
        self.state = state.or(self.state);
        Ok(state)
    }
}

impl<S: Surface, K: InfluenceKernel, U: LinearUpdater> Iterator for LoadingSolver<S, K, U> {
    type Item = Result<ContactState, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.finished {
            return None;
        }
        let item = self.advance().transpose();
        self.finished = !matches!(item, Some(Ok(_)));
        item
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        if self.is_stepwise() && !self.finished {
            // Nodes may leave and touch again.
            return (0, None);
        }
        let done = self.state.map_or(0, |state| state.contact_nodes);
        let most = self.limits.nodes.saturating_sub(done);
        // One more for an error.
        (0, Some(if self.finished { 0 } else { most + 1 }))
    }
}

impl<S: Surface, K: InfluenceKernel, U: LinearUpdater> FusedIterator for LoadingSolver<S, K, U> {}
