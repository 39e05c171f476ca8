//! Many states, one after the other.

use std::iter::FusedIterator;

use super::continuation::Continuation;
use super::solution::FixedLoadSolution;
use super::solver::FixedLoadSolver;
use super::target::ContactTarget;
use crate::{Error, InfluenceKernel, Surface};

/// Contact at a sequence of loads or other targets: see [`FixedLoadSolver::sweep`].
///
/// A fused iterator: after an error it yields `None` for ever. Targets may come in any order and be
/// of any kind; the closer each is to the one before, the faster. Every state is as exact as if it
/// had been solved for alone.
///
/// ```
/// use asperity::surface::{Amplitude, SelfAffine};
/// use asperity::{Boussinesq, FixedLoadSolver, Grid};
///
/// # fn main() -> Result<(), asperity::Error> {
/// let grid = Grid::square(64, 1e-3)?;
/// let surface = SelfAffine::new(0.8, 5e-4, 8e-5, Amplitude::RmsHeight(1e-6), 7)?;
/// let mut solver = FixedLoadSolver::new(surface, Boussinesq::new(grid, 100e9)?)?;
/// for solution in solver.sweep([10.0, 20.0, 40.0]) {
///     let state = solution?.state;
///     println!("{} N: {} nodes, {} m", state.load, state.contact_nodes, state.mean_gap);
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct LoadSweep<'a, S, K, I> {
    solver: &'a mut FixedLoadSolver<S, K>,
    targets: I,
    continuation: Continuation,
    /// The solution that the solver holds.
    last: Option<FixedLoadSolution>,
    finished: bool,
}

impl<'a, S, K, I> LoadSweep<'a, S, K, I> {
    pub(super) fn new(solver: &'a mut FixedLoadSolver<S, K>, targets: I) -> Self {
        Self {
            solver,
            targets,
            continuation: Continuation::default(),
            last: None,
            finished: false,
        }
    }
}

impl<S, K, I> Iterator for LoadSweep<'_, S, K, I>
where
    S: Surface,
    K: InfluenceKernel,
    I: Iterator,
    I::Item: Into<ContactTarget>,
{
    type Item = Result<FixedLoadSolution, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.finished {
            return None;
        }
        let Some(target) = self.targets.next() else {
            self.finished = true;
            return None;
        };
        let (continuation, last) = (&mut self.continuation, self.last.as_ref());
        let solved = self.solver.next_target(continuation, target.into(), last);
        match &solved {
            Ok(solution) => self.last = Some(solution.clone()),
            Err(_) => self.finished = true,
        }
        Some(solved)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        if self.finished {
            return (0, Some(0));
        }
        (0, self.targets.size_hint().1)
    }
}

impl<S, K, I> FusedIterator for LoadSweep<'_, S, K, I>
where
    S: Surface,
    K: InfluenceKernel,
    I: Iterator,
    I::Item: Into<ContactTarget>,
{
}
