//! A path and its states, apart from the type of its updater.

use std::iter::FusedIterator;

use nalgebra::DMatrix;

use super::estimated::Estimated;
use super::exact::Exact;
use super::limits::{Limits, LoadingEnd};
use super::phase::Phase;
use super::rule::ContactRule;
use super::run::{LoadingRun, LoadingTimings};
use super::single::Single;
use super::state::LoadingState;
use crate::contact::ContactTarget;
use crate::kernel::Layering;
use crate::updater::LinearUpdater;
use crate::{Error, Grid, InfluenceKernel, Problem};

/// A loading path under way, whatever solves on its contact: what a [`LoadingSolver`](super::LoadingSolver) is but for
/// the type of its updater.
///
/// What reads fields of a path, or goes on with it, takes one of these; a [`LoadingSolver`](super::LoadingSolver) is
/// one where it is borrowed, and becomes one by [`into_path`](super::LoadingSolver::into_path).
#[derive(Debug)]
pub struct LoadingPath {
    pub(super) run: LoadingRun,
    /// The solver of the path.
    pub(super) phase: Phase,
    /// Events in windows with a factor, in windows without, and one at a time where nodes may leave.
    pub(super) exact: Exact,
    pub(super) estimated: Estimated,
    pub(super) single: Single,
    /// Elastic nodes in contact when the factor was given up.
    pub(super) handed_over_at: Option<usize>,
    /// The event behind which the path was made again from states alone: no window has begun there yet.
    pub(super) rebuilt_at: Option<usize>,
    pub(super) rule: ContactRule,
    pub(super) limits: Limits,
    /// The state yielded last.
    pub(super) state: Option<LoadingState>,
    /// The error that follows the states in the queue.
    pub(super) failure: Option<Error>,
    pub(super) end: Option<LoadingEnd>,
}

impl LoadingPath {
    /// Goes on to a target beyond a limit that ended the path, or would have: all limits set before are
    /// forgotten.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a target that is not beyond the present state, and those of the builder;
    /// [`Error::CannotContinue`] after an error.
    pub fn continue_to(&mut self, target: ContactTarget) -> Result<(), Error> {
        if let Some(LoadingEnd::Failed | LoadingEnd::Memory) = self.end {
            return Err(Error::CannotContinue { steps: self.state.map_or(0, |state| state.step) });
        }
        let mut limits = Limits::default();
        let problem = self.run.surface();
        limits.set(target, &problem.grid(), problem.mean_gap())?;
        if let Some(plastic) = &self.run.plastic {
            limits.check_hardness(plastic.hardness(), &problem.grid())?;
        }
        if let Some(state) = &self.state {
            limits.check_ahead(state, true)?;
        }
        self.limits = limits;
        self.end = None;
        Ok(())
    }

    /// The next state, `None` at the end of the path.
    fn advance(&mut self) -> Result<Option<LoadingState>, Error> {
        if self.run.queue.is_empty() {
            if let Some(error) = self.failure.take() {
                return Err(error);
            }
            // If a user-defined part panics here, this is where the path has ended.
            self.end = Some(LoadingEnd::Failed);
            let produced = self.produce();
            self.end = None;
            produced?;
        }
        let Some(next) = self.run.queue.front() else {
            let nodes = self.run.contact_nodes();
            let yielded = self.run.plastic.as_ref().map_or(0, |plastic| plastic.count());
            self.end = Some(if yielded == self.run.problem.grid().nodes() {
                LoadingEnd::FullyPlastic
            } else if nodes == self.run.problem.grid().nodes() && !self.run.may_yield() {
                if self.limits.ends_before_full_contact() {
                    log::warn!(
                        "full contact before the load, approach or mean gap at which the path was to end"
                    );
                }
                LoadingEnd::FullContact
            } else if let Some(end) = self.limits.enough(nodes) {
                end
            } else if let Some((end, at_limit)) =
                self.state.and_then(|last| self.limits.behind(last))
            {
                self.end = Some(end);
                self.state = at_limit.or(self.state);
                return Ok(at_limit);
            } else {
                LoadingEnd::NoMoreEvents
            });
            return Ok(None);
        };
        if let Some((end, at_limit)) = self.limits.between(self.state, next) {
            self.end = Some(end);
            self.state = at_limit.or(self.state);
            return Ok(at_limit);
        }
        self.state = self.run.queue.pop_front();
        Ok(self.state)
    }

    /// Computes at least one more state, unless the path is at its end.
    fn produce(&mut self) -> Result<(), Error> {
        let (run, phase) = (&mut self.run, &mut self.phase);
        let nodes = run.problem.grid().nodes();
        let most_nodes = self.limits.most_nodes().min(nodes);
        let limit = self.limits.most_nodes();
        let end = self.limits.expected_nodes(nodes, self.state.map(|state| state.contact));
        // With a hardness nodes yield behind full contact.
        let is_enough = match &run.plastic {
            Some(_) => run.contact_nodes() >= limit,
            None => run.contact.len() >= most_nodes,
        };
        if !is_enough && phase.hand_over(run, end)? {
            self.handed_over_at = Some(run.contact.len());
            self.exact.give_up();
        }
        let stop = phase.stop(run, end);
        let may_leave = run.may_leave();
        match phase {
            phase if may_leave => {
                let windows = (&mut self.exact, &mut self.estimated);
                self.single.produce(run, phase, windows, most_nodes)
            }
            _ if is_enough => Ok(()),
            Phase::Iterations(iterations) => self.estimated.produce(run, &mut **iterations),
            Phase::Factor { updater, log, .. } => {
                let most = if run.plastic.is_some() { limit } else { most_nodes.min(stop) };
                let failure = self.exact.produce(run, (updater.as_mut(), log), most)?;
                if !run.queue.is_empty() {
                    self.failure = failure;
                    return Ok(());
                }
                // Nothing came before it, and contact that only grows has events up to the last node.
                let stopped = || run.waiting().map(|_| self.exact.growth_stopped(run));
                failure.or_else(stopped).map_or(Ok(()), Err)
            }
        }
    }
}

impl Iterator for LoadingPath {
    type Item = Result<LoadingState, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.end.is_some() {
            return None;
        }
        let item = self.advance();
        if let Err(error) = &item {
            self.end = Some(match error {
                Error::MemoryBudget { .. } => LoadingEnd::Memory,
                _ => LoadingEnd::Failed,
            });
        }
        item.transpose()
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        if self.end.is_some() {
            return (0, Some(0));
        }
        if self.run.may_leave() {
            // Nodes may leave and touch again.
            return (0, None);
        }
        let end = self.limits.most_nodes().min(self.run.problem.grid().nodes());
        let done = self.state.map_or(0, |state| state.contact.contact_nodes);
        let mut most = end.saturating_sub(done);
        if self.run.plastic.is_some() {
            // Each node in contact may yield.
            let yielded = self.state.map_or(0, |state| state.contact.yielded_nodes());
            most += end.saturating_sub(yielded);
        }
        // One more for an error or a limit.
        (0, Some(most + 1))
    }
}

impl FusedIterator for LoadingPath {}

impl LoadingPath {
    /// The contact problem.
    #[must_use]
    pub fn problem(&self) -> &Problem {
        self.run.surface()
    }

    /// What the body of the problem is made of, for theories by which the states are read.
    #[must_use]
    pub fn layering(&self) -> Layering {
        let table = self.problem().table();
        table.origin().layering(table.boundary())
    }

    /// Where the path is to end, whichever comes first; a number of nodes is given as a fraction of the area.
    #[must_use]
    pub fn targets(&self) -> Vec<ContactTarget> {
        self.limits.targets(&self.grid())
    }

    /// Which node is taken to touch next.
    #[must_use]
    pub fn rule(&self) -> ContactRule {
        self.rule
    }

    /// The hardness of each node \[Pa\], if the path has [one](super::LoadingBuilder::hardness).
    #[must_use]
    pub fn hardness_map(&self) -> Option<DMatrix<f64>> {
        let (nx, ny) = self.grid().shape();
        let plastic = self.run.plastic.as_ref()?;
        Some(DMatrix::from_column_slice(nx, ny, plastic.hardness().values()))
    }

    /// The grid.
    #[must_use]
    pub fn grid(&self) -> Grid {
        self.run.problem.grid()
    }

    /// What solves on the contact; `None` where the path goes on, or has begun, without a factor.
    pub(super) fn linear_updater(&self) -> Option<&dyn LinearUpdater> {
        match &self.phase {
            Phase::Factor { updater, .. } => Some(&**updater),
            Phase::Iterations(_) => None,
        }
    }

    /// Number of elastic nodes in contact when the factor of [`Handover`](crate::updater::Handover) was given up,
    /// `None` while it is in use, or if a resumed path never had one.
    #[must_use]
    pub fn handed_over_at(&self) -> Option<usize> {
        self.handed_over_at
    }

    /// Where the time went so far, besides the updater.
    #[doc(hidden)]
    #[must_use]
    pub fn timings(&self) -> LoadingTimings {
        self.run.timings
    }

    /// Number of convolutions of iterations so far; `None` as long as there is a factor.
    #[doc(hidden)] // for the studies of this repository
    #[must_use]
    pub fn convolutions(&self) -> Option<usize> {
        match &self.phase {
            Phase::Factor { .. } => None,
            Phase::Iterations(iterations) => Some(iterations.convolutions()),
        }
    }

    /// Why the path has ended; `None` while there is more to come.
    #[must_use]
    pub fn end(&self) -> Option<LoadingEnd> {
        self.end
    }

    /// The present state: the last one yielded, `None` before the first.
    #[must_use]
    pub fn state(&self) -> Option<LoadingState> {
        self.state
    }

    /// The same, for a caller who has nothing to do without a state.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] before the first state.
    pub fn present(&self) -> Result<LoadingState, Error> {
        self.state.ok_or(Error::OutOfRange {
            quantity: "number of states yielded so far",
            value: 0.0,
            expected: "at least 1 for a present state",
        })
    }

    /// Number of states that are computed and not yielded yet: as long as there are any, the next one costs nothing.
    #[doc(hidden)] // for the package of Python in this repository
    #[must_use]
    pub fn waiting(&self) -> usize {
        self.run.queue.len()
    }

    /// Bytes held at present, with the nodes in contact of all states computed so far: those of a window are ahead of
    /// the present state.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let run = &self.run;
        let (nodes, contact) = (run.problem.grid().nodes(), run.contact.len());
        let own = self.phase.bytes(nodes, contact);
        run.memory.fixed.saturating_add(own)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::loading::LoadingSolver;
    use crate::test_chain;

    /// Two of four nodes are in contact at the approach 2, under 2 (1/2 + 1/4) N.
    fn path() -> Result<LoadingSolver, Error> {
        let (surface, kernel) =
            (test_chain::surface(&[0.0, 9.0, 1.0, 9.0])?, test_chain::kernel(4)?);
        let mut path = LoadingSolver::builder(&surface, &kernel).max_approach(2.0).build()?;
        assert_eq!(path.size_hint(), (0, Some(5)));
        assert_eq!((path.state(), path.end()), (None, None));
        let all = LoadingSolver::builder(&surface, &kernel).max_approach(2.0).build()?.run()?;
        assert_eq!(all.states().len(), 3);
        let none = path.present().err().map(|error| error.to_string());
        let told =
            "number of states yielded so far must be at least 1 for a present state, but is 0";
        assert_eq!(none.as_deref(), Some(told));
        path.by_ref().try_for_each(|state| state.map(drop))?;
        assert_eq!(Some(path.present()?), path.state());
        assert_eq!((path.size_hint(), path.end()), ((0, Some(0)), Some(LoadingEnd::Approach)));
        Ok(path)
    }

    #[test]
    fn paths_go_on_to_what_lies_beyond() -> Result<(), Error> {
        use ContactTarget::{Approach, AreaFraction, Load, MeanGap};
        let state = path()?.state();
        let mean_gap = state.map_or(0.0, |state| state.contact.mean_gap);
        assert!(
            state.is_some_and(
                |state| state.contact.contact_nodes == 2 && state.contact.approach == 2.0
            )
        );
        let load = state.map_or(0.0, |state| state.contact.load);
        for (target, is_beyond) in [
            (Load(load), false),
            (Load(1.25), false),
            (Load(1.75), true),
            (Approach(2.0), false),
            (Approach(1.5), false),
            (Approach(2.5), true),
            // Two of four nodes, one, and three.
            (AreaFraction(0.5), false),
            (AreaFraction(0.25), false),
            (AreaFraction(0.75), true),
            (MeanGap(mean_gap), false),
            (MeanGap(mean_gap + 0.25), false),
            (MeanGap(mean_gap - 0.25), true),
        ] {
            let mut path = path()?;
            let refused = path.continue_to(target).err();
            assert_eq!(refused.is_none(), is_beyond, "{target:?}");
            if is_beyond {
                assert_eq!((path.end(), path.targets()), (None, vec![target]));
                let most = if target == AreaFraction(0.75) { 1 } else { 2 };
                assert_eq!(path.size_hint(), (0, Some(most + 1)));
                assert!(path.next().is_some_and(|state| state.is_ok()));
            } else {
                assert!(matches!(refused, Some(Error::OutOfRange { .. })));
                assert_eq!(path.end(), Some(LoadingEnd::Approach));
            }
        }
        Ok(())
    }

    #[test]
    fn nothing_goes_on_after_an_error() -> Result<(), Error> {
        for end in [LoadingEnd::Failed, LoadingEnd::Memory] {
            let mut path = path()?;
            path.end = Some(end);
            let refused = path.continue_to(ContactTarget::Load(9.0));
            assert!(matches!(refused, Err(Error::CannotContinue { steps: 2 })));
        }
        Ok(())
    }

    /// Those of the grid, and those of a factor of four nodes: all events of the window have joined.
    #[test]
    fn bytes_are_those_of_grid_and_updater() -> Result<(), Error> {
        let path = path()?;
        let updater = path.updater().map_or(0, |updater| updater.bytes(4, 0));
        assert!(updater > 0);
        assert_eq!(path.bytes(), path.run.memory.fixed + updater);
        assert_eq!((path.grid(), path.rule()), (test_chain::grid(4)?, ContactRule::FirstContact));
        Ok(())
    }
}
