//! Many states, one after the other.

use std::iter::FusedIterator;

use super::search::solve_target;
use super::solution::FixedLoadSolution;
use super::stepper::Stepper;
use crate::Error;
use crate::contact::ContactTarget;

/// Contact at a sequence of loads or other targets: see
/// [`FixedLoadSolver::sweep`](super::FixedLoadSolver::sweep).
///
/// A fused iterator: the first error is its last item. Targets may come in any order and be of any
/// kind; the closer each is to the one before, the faster. Every state is as exact as if it had been
/// solved for alone.
///
/// ```
/// use asperity::surface::{Amplitude, SelfAffine};
/// use asperity::{Boussinesq, ContactTarget, FixedLoadSolver, Grid};
///
/// # fn main() -> Result<(), asperity::Error> {
/// let grid = Grid::square(64, 1e-3)?;
/// let surface = SelfAffine::new(0.8, 5e-4, 8e-5, Amplitude::RmsHeight(1e-6), 7)?;
/// let half_space = Boussinesq::new(grid, 100e9)?;
/// let mut solver = FixedLoadSolver::new(&surface, &half_space)?;
/// for solution in solver.sweep([10.0, 20.0, 40.0].map(ContactTarget::Load)) {
///     let state = solution?.contact;
///     println!("{} N: {} nodes, {} m", state.load, state.contact_nodes, state.mean_gap);
/// }
/// # Ok(())
/// # }
/// ```
#[must_use = "nothing is solved before it is iterated over"]
#[derive(Debug)]
pub struct LoadSweep<'a, I> {
    stepper: Stepper<'a>,
    targets: I,
    finished: bool,
}

impl<'a, I> LoadSweep<'a, I> {
    pub(super) fn new(stepper: Stepper<'a>, targets: I) -> Self {
        Self { stepper, targets, finished: false }
    }
}

impl<I> Iterator for LoadSweep<'_, I>
where
    I: Iterator<Item = ContactTarget>,
{
    type Item = Result<FixedLoadSolution, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.finished {
            return None;
        }
        let target = self.targets.next();
        let solved = target.map(|target| solve_target(&mut self.stepper, target));
        self.finished = !matches!(solved, Some(Ok(_)));
        solved
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        if self.finished {
            return (0, Some(0));
        }
        (0, self.targets.size_hint().1)
    }
}

impl<I> FusedIterator for LoadSweep<'_, I> where I: Iterator<Item = ContactTarget> {}
