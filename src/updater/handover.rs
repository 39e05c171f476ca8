//! The default: a factor, which the path may give up for iterations.

use nalgebra::DMatrix;

use super::{Left, LinearUpdater, RecursiveCholesky, Schur, Solution, WindowFactor, forward_verbs};
use crate::contact::ContactSequence;
use crate::{Error, Problem};

/// The default: [`RecursiveCholesky`] until the rest of the path is cheaper with
/// [`ConjugateGradient`](super::ConjugateGradient), or its factor no longer fits the memory budget of the path, and
/// iterations from then on. No path ends for want of memory for n² numbers, unless the budget is less than iterations
/// take on the grid alone; and full contact on 512 × 512 nodes takes minutes.
///
/// An event costs some n² times 10 ps with a factor of n nodes, and without some 0.2 ms, 3.5 ns for each node of the
/// grid and 4 ns for each one in contact: both cost the same at some 5300 contact nodes on a grid of 128², 6800 on
/// 256², 10 800 on 512², and 19 900 on 1024². There the factor is given up if all that is left of the path, the first
/// solution without a factor included, takes four fifths of the time or less. A path that ends soon behind that number
/// of nodes keeps its factor: a tenth of 256² is exact to rounding. The end is the target; a load, an approach or a
/// mean gap is taken for about the number of nodes that load and stiffness of the present state give. These are
/// constants and not measurements, so that a path is the same on every run. The budget is that of
/// [`LoadingBuilder::memory_budget`](crate::loading::LoadingBuilder::memory_budget).
///
/// With a [hardness](crate::loading::LoadingBuilder::hardness) n counts elastic nodes only, which the factor holds: in
/// metals these are so few that it stays as a rule.
///
/// On periodic cells that are [too long](super::ConjugateGradient::MAX_ASPECT) for iterations the factor stays as long
/// as it fits the budget.
///
/// Events are the same before and after; before, states are exact to rounding, and after it as
/// [`loading`](crate::loading) says. A message of the level `info` goes to the crate `log`, and
/// [`LoadingPath::handed_over_at`](crate::LoadingPath::handed_over_at) says where it was. For a path exact to rounding
/// whatever it costs, take [`RecursiveCholesky`] itself.
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
/// assert!(path.handed_over_at().is_some());
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Default)]
pub struct Handover(RecursiveCholesky);

impl Handover {
    /// No node in contact.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    fn factor(&mut self) -> &mut RecursiveCholesky {
        &mut self.0
    }
}

impl LinearUpdater for Handover {
    forward_verbs!(factor);

    fn bytes(&self, contact: usize, watched: usize) -> usize {
        self.0.bytes(contact, watched)
    }
}
