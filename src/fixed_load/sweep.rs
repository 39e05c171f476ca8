//! Many loads, one after the other.

use std::iter::FusedIterator;

use super::continuation::Continuation;
use super::solution::FixedLoadSolution;
use super::solver::FixedLoadSolver;
use crate::{Error, InfluenceKernel, Surface};

/// Contact under a sequence of loads: see [`FixedLoadSolver::sweep`].
///
/// A fused iterator: after an error it yields `None` for ever. Loads may come in any order; the
/// closer each is to the one before, the faster.
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
    loads: I,
    continuation: Continuation,
    /// Whether the solver holds a solution of this sweep.
    warm: bool,
    finished: bool,
}

impl<'a, S, K, I> LoadSweep<'a, S, K, I> {
    pub(super) fn new(solver: &'a mut FixedLoadSolver<S, K>, loads: I) -> Self {
        Self {
            solver,
            loads,
            continuation: Continuation::default(),
            warm: false,
            finished: false,
        }
    }
}

impl<S: Surface, K: InfluenceKernel, I: Iterator<Item = f64>> Iterator for LoadSweep<'_, S, K, I> {
    type Item = Result<FixedLoadSolution, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.finished {
            return None;
        }
        let Some(load) = self.loads.next() else {
            self.finished = true;
            return None;
        };
        let warm = std::mem::replace(&mut self.warm, true);
        let solved = self.solver.next_load(&mut self.continuation, load, warm);
        self.finished = solved.is_err();
        Some(solved)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        if self.finished {
            return (0, Some(0));
        }
        (0, self.loads.size_hint().1)
    }
}

impl<S: Surface, K: InfluenceKernel, I: Iterator<Item = f64>> FusedIterator
    for LoadSweep<'_, S, K, I>
{
}
