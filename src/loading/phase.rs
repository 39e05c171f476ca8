//! What solves on the contact: an updater, until iterations are cheaper, and then these.

use super::gap_field;
use super::run::LoadingRun;
use super::tuning::{FACTOR, ITERATIONS, LEAST_WINDOW, WINDOW};
use super::window::Window;
use crate::contact::ContactSequence;
use crate::updater::{
    ConjugateGradient, Iterations, LinearUpdater, Method, RecursiveCholesky, Solution,
    WindowFactor, join_all,
};
use crate::{Error, Problem};

/// What solves on the contact of a path.
#[derive(Debug)]
pub(super) enum Phase<U> {
    /// An updater; the path gives it up for iterations when these are cheaper, if `may_end`.
    Factor { updater: U, may_end: bool },
    /// Iterations, whose Schur complements the path corrects.
    Iterations(Box<dyn Iterations>),
}

impl<U: LinearUpdater> Phase<U> {
    /// Begins with an updater that has no node in contact.
    pub(super) fn new(updater: U) -> Self {
        match updater.method() {
            Method::Factor => Self::Factor {
                updater,
                may_end: false,
            },
            Method::FactorWhileItPays => Self::Factor {
                updater,
                may_end: true,
            },
            Method::Iterations(iterations) => Self::Iterations(iterations),
        }
    }

    /// Gives up the factor if it does not serve any more. Returns whether it has just done so.
    pub(super) fn hand_over(&mut self, run: &mut LoadingRun) -> Result<bool, Error> {
        let (problem, contact) = (&run.problem, &run.contact);
        let count = contact.len();
        let Some(mut iterations) = self.successor(run, count) else {
            return Ok(false);
        };
        if let Self::Factor { updater, .. } = self
            && count > 0
        {
            // At any approach: with the rate it is known at all others.
            let (approach, mut solution) = (0.0, Solution::default());
            gap_field::solve(problem, contact, updater, (count, approach), &mut solution)?;
            log::info!("{count} nodes in contact: without a factor from here");
            iterations.take_over(problem, contact, approach, &solution)?;
        }
        *self = Self::Iterations(iterations);
        Ok(true)
    }

    /// The iterations that take the place of a factor with `count` nodes in contact, if that is one which may end: where they are
    /// cheaper and can do, or where it leaves no room for one more window. Without room for iterations it stays as long as it can.
    fn successor(&self, run: &LoadingRun, count: usize) -> Option<Box<dyn Iterations>> {
        let Self::Factor {
            updater,
            may_end: true,
        } = self
        else {
            return None;
        };
        let nodes = run.problem.grid().nodes();
        let iterations = Box::<ConjugateGradient>::default();
        let needed = updater.bytes(count + LEAST_WINDOW, LEAST_WINDOW);
        let needed = needed.saturating_add(WindowFactor::bytes(LEAST_WINDOW));
        let fits = run.memory.check(needed, count).is_ok();
        let pays = factor_seconds(count) <= iteration_seconds(nodes, count);
        if fits && (pays || iterations.check_cells(&run.problem).is_err()) {
            return None;
        }
        let has_room = run
            .memory
            .check(iterations.bytes(nodes, count), count)
            .is_ok();
        (has_room || count == 0).then_some(iterations as Box<dyn Iterations>)
    }

    /// Makes the gap field of a path that of its contact at an approach.
    pub(super) fn renew_field(&mut self, run: &mut LoadingRun, approach: f64) -> Result<(), Error> {
        match self {
            Self::Factor { updater, .. } => run.renew_field(updater, approach),
            Self::Iterations(_) if run.field.belongs_to(&run.contact, approach) => Ok(()),
            Self::Iterations(iterations) => {
                run.advance_field(&mut **iterations, approach, f64::INFINITY)
            }
        }
    }

    /// Lets a single node join, that touches at a time behind the present approach. With a factor `window` then says what it adds to
    /// the stiffness; iterations learn of it by their next solution.
    pub(super) fn admit(
        &mut self,
        run: &mut LoadingRun,
        window: &mut Window,
        (node, time): (usize, f64),
    ) -> Result<(), Error> {
        match self {
            Self::Factor { updater, .. } => {
                run.affordable(updater, 1)?;
                run.watch(updater, window, std::iter::once(node), f64::INFINITY)?;
                let touched = window.touch(0, time);
                touched.map_err(|bad| run.not_positive_definite(bad))?;
                run.join(updater, window)
            }
            Self::Iterations(_) => {
                self.check_room(run, run.contact.len() + 1)?;
                run.contact.push(node)
            }
        }
    }

    /// Before the first node is in contact: tells the updater how many bytes are left for it, or checks that iterations have
    /// room.
    pub(super) fn make_room(&mut self, run: &LoadingRun) -> Result<(), Error> {
        match self {
            Self::Factor { updater, .. } => updater
                .make_room(&run.problem, run.memory.left())
                .map_err(|error| run.memory.in_all(error)),
            Self::Iterations(_) => self.check_room(run, 0),
        }
    }

    /// `Ok` if there is room for so many nodes in contact.
    pub(super) fn check_room(&self, run: &LoadingRun, contact: usize) -> Result<(), Error> {
        let grid = run.problem.grid();
        run.memory
            .check(self.bytes(grid.nodes(), contact, 0), run.contact.len())
    }

    /// Goes on without a node that was at `position` of the contact.
    pub(super) fn release(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        (node, position): (usize, usize),
    ) -> Result<(), Error> {
        match self {
            Self::Factor { updater, .. } => updater.release(problem, contact, node, position),
            Self::Iterations(iterations) => iterations.leave(problem, contact),
        }
    }

    /// Begins anew with a contact that is known. Returns whether the factor is given up at once.
    pub(super) fn restore(&mut self, run: &mut LoadingRun, order: &[usize]) -> Result<bool, Error> {
        run.contact = ContactSequence::new(run.problem.grid());
        let successor = self.successor(run, order.len());
        let hands_over = successor.is_some();
        if let Some(iterations) = successor {
            *self = Self::Iterations(iterations);
        }
        let restored = match self {
            Self::Factor { updater, .. } => join_all(
                updater,
                &run.problem,
                &mut run.contact,
                order,
                run.memory.left(),
            )
            .map_err(|error| run.memory.in_all(error)),
            Self::Iterations(_) => order.iter().try_for_each(|&node| run.contact.push(node)),
        };
        restored.map(|()| hands_over)
    }

    /// Solves on the contact after `step` events at an approach, and returns it. The path does not notice.
    pub(super) fn solve_at(
        &mut self,
        run: &LoadingRun,
        (step, approach): (usize, f64),
        solution: &mut Solution,
    ) -> Result<Vec<usize>, Error> {
        let (problem, contact) = (&run.problem, &run.contact);
        let nodes = run.releases.contact_at(contact.order(), step);
        let at = (nodes.len(), approach);
        if !run.releases.is_prefix(step) {
            // Nodes of that contact have left the updater since.
            let own = self.bytes(problem.grid().nodes(), contact.len(), 0);
            let rebuilt = RecursiveCholesky::bytes_of(nodes.len());
            run.memory
                .check(own.saturating_add(rebuilt), contact.len())?;
            let (mut updater, contact) = RecursiveCholesky::of(problem, &nodes)?;
            gap_field::solve(problem, &contact, &mut updater, at, solution)?;
            return Ok(nodes);
        }
        match self {
            Self::Factor { updater, .. } => {
                gap_field::solve(problem, contact, updater, at, solution)?;
            }
            Self::Iterations(iterations) => {
                iterations.solve_apart(problem, contact, at.0, approach, solution)?;
            }
        }
        Ok(nodes)
    }

    /// Greatest gap in contact that a solution leaves, relative to the approach: 0 with a factor, where it is rounding.
    pub(super) fn tolerance(&self) -> f64 {
        match self {
            Self::Factor { .. } => 0.0,
            Self::Iterations(iterations) => iterations.tolerance(),
        }
    }

    /// Bytes held when `contact` nodes of a grid of `nodes` are in contact and `watched` are watched.
    pub(super) fn bytes(&self, nodes: usize, contact: usize, watched: usize) -> usize {
        match self {
            Self::Factor { updater, .. } => updater.bytes(contact, watched),
            Self::Iterations(iterations) => iterations.bytes(nodes, contact),
        }
    }
}

/// Seconds that an event with so many nodes in contact takes on a grid of `nodes`, on a machine with
/// two cores: for telling how long a path will take.
#[doc(hidden)]
#[must_use]
pub fn event_seconds(nodes: usize, contact: usize) -> f64 {
    factor_seconds(contact).min(iteration_seconds(nodes, contact))
}

/// Nodes in contact at which a factor costs as much as iterations on a grid of `nodes`: where it is given up if
/// memory allows.
#[doc(hidden)]
#[must_use]
pub fn last_factor(nodes: usize) -> usize {
    // Both costs grow with the contact, and that of a factor faster: one crossing.
    let (mut low, mut high) = (0, nodes);
    while low < high {
        let middle = low.midpoint(high);
        if factor_seconds(middle) > iteration_seconds(nodes, middle) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    low
}

fn factor_seconds(contact: usize) -> f64 {
    FACTOR * (contact as f64).powi(2)
}

fn iteration_seconds(nodes: usize, contact: usize) -> f64 {
    WINDOW + ITERATIONS[0] * nodes as f64 + ITERATIONS[1] * contact as f64
}
