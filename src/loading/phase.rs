//! The solver of a path: an updater, and iterations in its place once these are cheaper.

use super::estimated::resumed::EstimatedEnd;
use super::event_cost::{Rest, greatest_factor};
use super::factor_log::FactorLog;
use super::gap_field;
use super::run::LoadingRun;
use super::tuning::{LEAST_CONTACT, LEAST_WINDOW};
use super::window::Window;
use crate::contact::ContactSequence;
use crate::updater::{
    ConjugateGradient, Handover, Iterations, Left, LinearUpdater, RecursiveCholesky, Solution,
    WindowFactor, innermost, join_all,
};
use crate::{Error, Problem};

/// The solver of a path.
#[derive(Debug)]
pub(super) enum Phase {
    /// An updater and how it grew so far; the path gives it up for iterations when its rest is cheaper with these, if
    /// `may_end`.
    Factor { updater: Box<dyn LinearUpdater>, log: FactorLog, may_end: bool },
    /// Iterations, whose Schur complements the path corrects.
    Iterations(Box<dyn Iterations>),
}

impl Phase {
    /// Begins with an updater that has no node in contact: with iterations where it is one of these. `hand_over` says
    /// whether it may end, if that is not for the updater to say.
    pub(super) fn new(updater: impl LinearUpdater, hand_over: Option<bool>) -> Self {
        let updater: Box<dyn LinearUpdater> = Box::new(updater);
        let own = innermost(&*updater);
        if let Some(iterations) = own.downcast_ref::<ConjugateGradient>() {
            return Self::Iterations(Box::new(iterations.afresh()));
        }
        let may_end = hand_over.unwrap_or_else(|| own.is::<Handover>());
        Self::Factor { updater, log: FactorLog::default(), may_end }
    }

    /// Gives up the factor if it does not serve any more on a path to `end` nodes in contact. Returns whether it has
    /// just done so.
    pub(super) fn hand_over(&mut self, run: &mut LoadingRun, end: usize) -> Result<bool, Error> {
        let (problem, contact) = (&run.problem, &run.contact);
        let count = contact.len();
        let Some(iterations) = self.successor(run, count, end) else {
            return Ok(false);
        };
        let mut solution = Solution::default();
        // At any approach: with the rate it is known at all others.
        let approach = 0.0;
        if let Self::Factor { updater, .. } = self
            && count > 0
        {
            gap_field::solve(problem, contact, updater.as_mut(), (count, approach), &mut solution)?;
            log::info!("{count} nodes in contact: without a factor from here");
        }
        // The factor goes before iterations fill its place: both at once may not fit.
        *self = Self::Iterations(iterations);
        if let Self::Iterations(iterations) = self
            && count > 0
        {
            iterations.take_over(problem, contact, approach, &solution)?;
        }
        // The gap field may hold a solution of the factor, if its last window was checked: iterations begin with their
        // own in any case.
        run.field.forget();
        Ok(true)
    }

    /// The iterations that take the place of a factor with `count` nodes, if it may end: where the rest of a path to
    /// `end` nodes in contact is cheaper with them and they are made for such cells, or where the factor leaves no room
    /// for one more window. Without room for iterations it stays as long as it can.
    fn successor(&self, run: &LoadingRun, count: usize, end: usize) -> Option<Box<dyn Iterations>> {
        let Self::Factor { updater, may_end: true, .. } = self else {
            return None;
        };
        let nodes = run.problem.grid().nodes();
        let iterations: Box<dyn Iterations> = Box::<ConjugateGradient>::default();
        let needed = updater.bytes(count + LEAST_WINDOW, LEAST_WINDOW);
        let needed = needed.saturating_add(WindowFactor::bytes(LEAST_WINDOW));
        let fits = run.memory.check(needed, count).is_ok();
        let is_cheaper = rest(run, count, end).is_cheaper_without();
        // Fewer nodes have no windows without a factor where contact need not grow.
        let has_windows = !run.may_leave() || count >= LEAST_CONTACT;
        let pays = is_cheaper && has_windows && iterations.check_cells(&run.problem).is_ok();
        if fits && !pays {
            return None;
        }
        let has_room = run.memory.check(iterations.bytes(nodes, count), count).is_ok();
        (has_room || count == 0).then_some(iterations)
    }

    /// The number of nodes in contact at which a window must end, so that the factor is given up there wherever windows
    /// begin: all nodes if it is kept on the way to `end` of them.
    pub(super) fn stop(&self, run: &LoadingRun, end: usize) -> usize {
        let nodes = run.problem.grid().nodes();
        let last = greatest_factor(nodes, end);
        let may_stop = matches!(self, Self::Factor { may_end: true, .. });
        if may_stop && last < end && run.contact.len() < last { last } else { nodes }
    }

    /// Makes the gap field of a path that of its contact at an approach.
    pub(super) fn renew_field(&mut self, run: &mut LoadingRun, approach: f64) -> Result<(), Error> {
        match self {
            Self::Factor { updater, .. } => run.renew_field(updater.as_mut(), approach),
            Self::Iterations(_) if run.field.belongs_to(&run.contact, approach) => Ok(()),
            Self::Iterations(iterations) => {
                run.advance_field(&mut **iterations, approach, f64::INFINITY)
            }
        }
    }

    /// Lets a single node join, that touches at a time behind the present approach: with a factor through a window of
    /// its own; iterations learn of it by their next solution.
    pub(super) fn admit(
        &mut self,
        run: &mut LoadingRun,
        window: &mut Window,
        (node, time): (usize, f64),
    ) -> Result<(), Error> {
        match self {
            Self::Factor { updater, log, .. } => {
                run.affordable(updater.as_ref(), 1)?;
                run.watch(updater.as_mut(), window, std::iter::once(node), f64::INFINITY)?;
                let touched = window.happen(0, time);
                touched.map_err(|bad| run.not_positive_definite(bad))?;
                run.join(updater.as_mut(), window)?;
                log.push(&[node], std::iter::once(0), 1);
                Ok(())
            }
            Self::Iterations(_) => {
                self.check_room(run, run.contact.len() + 1)?;
                run.contact.push(node)
            }
        }
    }

    /// Before the first node is in contact: tells the updater how many bytes are left for it, or checks that iterations
    /// have room.
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
        run.memory.check(self.bytes(grid.nodes(), contact), run.contact.len())
    }

    /// Goes on without a node that left the contact.
    pub(super) fn release(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        left: Left,
    ) -> Result<(), Error> {
        // Iterations solve on the contact as it is then.
        if let Self::Factor { updater, log, .. } = self {
            updater.release(problem, contact, &[left])?;
            log.push_left(left.position);
        }
        Ok(())
    }

    /// Begins anew with a contact that is known. Returns whether the factor is given up at once.
    pub(super) fn restore(
        &mut self,
        run: &mut LoadingRun,
        order: &[usize],
        end: usize,
    ) -> Result<bool, Error> {
        run.contact = ContactSequence::new(run.problem.grid());
        let successor = self.successor(run, order.len(), end);
        let hands_over = successor.is_some();
        if let Some(iterations) = successor {
            *self = Self::Iterations(iterations);
        }
        let restored = match self {
            Self::Factor { updater, log, .. } => {
                *log = FactorLog::of_blocks(order);
                join_all(updater.as_mut(), &run.problem, &mut run.contact, order, run.memory.left())
                    .map_err(|error| run.memory.in_all(error))
            }
            Self::Iterations(_) => order.iter().try_for_each(|&node| run.contact.push(node)),
        };
        restored.map(|()| hands_over)
    }

    /// Makes a factor of a contact by the steps of a log. Returns whether it does: there must be one, and room for it.
    pub(super) fn restore_factor(
        &mut self,
        run: &LoadingRun,
        contact: &ContactSequence,
        known: &FactorLog,
    ) -> Result<bool, Error> {
        let Self::Factor { updater, log, .. } = self else {
            return Ok(false);
        };
        let left = run.memory.left();
        let fits = known.replay(updater.as_mut(), &run.problem, contact, left)?;
        if fits {
            log.clone_from(known);
        }
        Ok(fits)
    }

    /// Goes on with iterations where a window ended. Returns whether they are those of this path.
    pub(super) fn restore_iterations(
        &mut self,
        run: &LoadingRun,
        contact: &ContactSequence,
        end: &EstimatedEnd,
    ) -> Result<bool, Error> {
        let solved = end.contact(contact)?;
        let mut successor: Option<Box<dyn Iterations>> = None;
        let iterations = match self {
            Self::Factor { may_end: false, .. } => return Ok(false),
            Self::Factor { .. } => successor.insert(Box::<ConjugateGradient>::default()),
            Self::Iterations(iterations) => iterations,
        };
        let needed = iterations.bytes(run.problem.grid().nodes(), contact.len());
        if run.memory.check(needed, contact.len()).is_err()
            || !iterations.restore(&run.problem, &solved, &end.kept)?
        {
            return Ok(false);
        }
        if let Some(iterations) = successor {
            *self = Self::Iterations(iterations);
        }
        Ok(true)
    }

    /// Solves on the contact after `step` events at an approach, and returns it. The solution that the path goes on
    /// with is left as it is.
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
            let grid = problem.grid();
            let bytes = |contact| self.bytes(grid.nodes(), contact);
            let factor = RecursiveCholesky::bytes_of(nodes.len());
            // Where nothing yields, a factor of a small contact is less.
            let iterates = matches!(self, Self::Iterations(_))
                && (run.plastic.is_some() || bytes(nodes.len()) < factor);
            let beside = if iterates { bytes(nodes.len()) } else { factor };
            run.memory.check(bytes(contact.len()).saturating_add(beside), contact.len())?;
            let yielded: Vec<usize> = run.releases.yielded_at(step).collect();
            let beside =
                run.plastic.as_ref().map(|plastic| plastic.beside(&yielded)).transpose()?;
            let problem = beside.as_ref().map_or(problem, |(_, problem)| problem);
            if let (Self::Iterations(iterations), true) = (self, iterates) {
                let contact = ContactSequence::with_order(grid, nodes.iter().copied())?;
                iterations.solve_apart(problem, &contact, at.0, approach, solution)?;
                gap_field::check_solution(solution, at.0)?;
                return Ok(nodes);
            }
            let (mut updater, contact) = RecursiveCholesky::of(problem, &nodes)?;
            gap_field::solve(problem, &contact, &mut updater, at, solution)?;
            return Ok(nodes);
        }
        match self {
            Self::Factor { updater, .. } => {
                gap_field::solve(problem, contact, updater.as_mut(), at, solution)?;
            }
            Self::Iterations(iterations) => {
                iterations.solve_apart(problem, contact, at.0, approach, solution)?;
                gap_field::check_solution(solution, at.0)?;
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

    /// Bytes held between two windows when `contact` nodes of a grid of `nodes` are in contact.
    pub(super) fn bytes(&self, nodes: usize, contact: usize) -> usize {
        match self {
            Self::Factor { updater, .. } => updater.bytes(contact, 0),
            Self::Iterations(iterations) => iterations.bytes(nodes, contact),
        }
    }
}

/// What is left of a path with `count` nodes in its factor and `end` nodes in contact at the end.
fn rest(run: &LoadingRun, count: usize, end: usize) -> Rest {
    let nodes = run.problem.grid().nodes();
    let Some(plastic) = &run.plastic else {
        let rest = Rest::growing(nodes, count, end);
        if !run.may_leave() {
            return rest;
        }
        // As so far.
        let steps = run.releases.steps(count);
        return rest.with_releases(run.releases.count() as f64 / steps.max(1) as f64);
    };
    // Of the nodes that are to touch most yield as well; those that have not yet leave the factor as others come.
    let yielded = plastic.count();
    let (touches, yields) = (end.saturating_sub(count + yielded), end.saturating_sub(yielded));
    Rest::steady(nodes, count, touches + yields)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::loading::event_cost::last_factor;
    use crate::loading::test_chain::{self, Altered};
    use crate::loading::{LoadingSolver, LoadingState};
    use crate::memory::Memory;
    use crate::surface::{Amplitude, SelfAffine};
    use crate::updater::Handover;
    use crate::{Boussinesq, Grid, HeightMap, InfluenceKernel, Spectral};

    /// A path on a flat surface of 128 × 128 nodes, of which the updater may hold so many bytes.
    fn flat(kernel: &dyn InfluenceKernel, budget: usize) -> Result<LoadingRun, Error> {
        let surface = HeightMap::new(nalgebra::DMatrix::zeros(128, 128))?;
        let mut run = LoadingSolver::builder(&surface, kernel).build()?.into_path().run;
        run.memory = Memory { budget, fixed: 0 };
        Ok(run)
    }

    /// Bytes of a factor of so many nodes and one more window: of 64 nodes more in contact and 64 watched, and of their
    /// Schur complement and its factor, 1024 · 64.
    fn with_window(contact: usize) -> usize {
        RecursiveCholesky::new().bytes(contact + 64, 64) + 1024 * 64
    }

    #[test]
    fn a_factor_fits_with_one_more_window() -> Result<(), Error> {
        let phase = Phase::new(Handover::new(), None);
        // On the way to full contact.
        let successor = |run: &LoadingRun, count: usize| phase.successor(run, count, 128 * 128);
        let has_successor = |run: &LoadingRun, count: usize| successor(run, count).is_some();
        let square = Boussinesq::new(Grid::square(128, 1.0)?, 1.0)?;
        // There is no other way on cells that iterations are not made for, while it fits.
        let long = Spectral::new(Grid::new(128, 128, 1.0, 1e4)?, 1.0)?;
        for kernel in [&square as &dyn InfluenceKernel, &long] {
            for (less, is_given_up) in [(0, false), (1, true)] {
                let run = flat(kernel, with_window(2000) - less)?;
                assert_eq!(has_successor(&run, 2000), is_given_up);
            }
            // 480 bytes a node and 1000 a node in contact are more than that: nothing else has room, but before first
            // touch there is nothing to stay with.
            for count in [300, 0] {
                let run = flat(kernel, with_window(count) - 1)?;
                assert_eq!(has_successor(&run, count), count == 0);
            }
        }
        let last = last_factor(128 * 128);
        for (kernel, given_up) in
            [(&square as &dyn InfluenceKernel, [false, true]), (&long, [false; 2])]
        {
            let run = flat(kernel, usize::MAX)?;
            let found = [last - 1, last].map(|count| has_successor(&run, count));
            assert_eq!(found, given_up);
            // A factor that was asked for stays.
            let chosen = Phase::new(RecursiveCholesky::new(), None);
            assert!(chosen.successor(&run, last, 128 * 128).is_none());
        }
        Ok(())
    }

    /// Paths that end soon behind the place where events cost the same keep their factor, and have no window that ends
    /// there.
    #[test]
    fn a_factor_is_given_up_for_what_is_left() -> Result<(), Error> {
        let square = Boussinesq::new(Grid::square(128, 1.0)?, 1.0)?;
        let run = flat(&square, usize::MAX)?;
        let last = last_factor(128 * 128);
        let phase = Phase::new(Handover::new(), None);
        for (end, is_given_up) in [(last + 500, false), (2 * last, true)] {
            assert_eq!(phase.successor(&run, last, end).is_some(), is_given_up, "{end}");
            assert_eq!(phase.stop(&run, end), if is_given_up { last } else { 128 * 128 });
        }
        let chosen = Phase::new(RecursiveCholesky::new(), None);
        assert_eq!(chosen.stop(&run, 2 * last), 128 * 128);
        Ok(())
    }

    /// Two of six nodes are in contact, with a factor that fits.
    fn two_in_contact() -> Result<(LoadingRun, Phase), Error> {
        let mut run = test_chain::run(&[0.0, 9.0, 1.0, 9.0, 2.0, 9.0])?;
        let mut phase = Phase::new(Handover::new(), None);
        assert!(!phase.restore(&mut run, &[2, 0], 6)?);
        assert_eq!((run.contact.order(), phase.tolerance()), (&[2, 0][..], 0.0));
        Ok((run, phase))
    }

    /// Where one more window does not fit iterations go on from the solution of the factor, if there is room for them:
    /// here for six nodes and two in contact.
    #[test]
    fn a_factor_is_given_up_for_iterations() -> Result<(), Error> {
        let iterations = 6 * 480 + 2 * 1000;
        for (budget, is_given_up) in [
            (with_window(2), false),
            (with_window(2) - 1, true),
            (iterations, true),
            (iterations - 1, false),
        ] {
            let (mut run, mut phase) = two_in_contact()?;
            run.memory.budget = run.memory.fixed + budget;
            assert_eq!(phase.hand_over(&mut run, 6)?, is_given_up, "{budget}");
            assert_eq!(matches!(phase, Phase::Iterations(_)), is_given_up);
            assert_eq!(phase.tolerance(), if is_given_up { 1e-10 } else { 0.0 });
            // Once.
            assert!(!phase.hand_over(&mut run, 6)?);
            phase.renew_field(&mut run, 3.0)?;
            assert!(run.field.belongs_to(&run.contact, 3.0));
            let Solution { pressure, rate } = run.field.solution();
            let found = pressure.iter().chain(rate);
            for (found, expected) in found.zip([0.5, 0.75, 0.25, 0.25]) {
                assert!((found - expected).abs() < 1e-9, "{found} {expected}");
            }
        }
        Ok(())
    }

    /// A contact that is known begins with a factor that fits, and without one otherwise.
    #[test]
    fn contacts_are_restored() -> Result<(), Error> {
        let (mut run, _) = two_in_contact()?;
        for (budget, is_given_up) in [(with_window(2), false), (with_window(2) - 1, true)] {
            run.memory.budget = run.memory.fixed + budget;
            let mut phase = Phase::new(Handover::new(), None);
            assert_eq!(phase.restore(&mut run, &[0, 2], 6)?, is_given_up);
            assert_eq!(matches!(phase, Phase::Iterations(_)), is_given_up);
            assert_eq!(run.contact.order(), [0, 2]);
        }
        Ok(())
    }

    /// Before first touch there is nothing to solve, and iterations need room for the grid.
    #[test]
    fn without_room_for_a_window_there_is_no_factor() -> Result<(), Error> {
        for (budget, hands_over, has_room) in [
            (with_window(0), false, true),
            (with_window(0) - 1, true, true),
            (6 * 480, true, true),
            (6 * 480 - 1, true, false),
        ] {
            let mut run = test_chain::run(&[0.0; 6])?;
            run.memory.budget = run.memory.fixed + budget;
            let mut phase = Phase::new(Handover::new(), None);
            assert_eq!(phase.hand_over(&mut run, 6)?, hands_over, "{budget}");
            assert_eq!(phase.make_room(&run).is_ok(), has_room, "{budget}");
        }
        Ok(())
    }

    /// Errors speak of all bytes, those of the grid included.
    #[test]
    fn what_does_not_fit_is_told() -> Result<(), Error> {
        let mut run = test_chain::solved(&[0.0; 9], &[0, 1, 2], 1.0)?;
        let fixed = run.memory.fixed;
        let mut needing = Phase::new(Altered::needing(1000), None);
        let iterations = Phase::new(ConjugateGradient::new(), None);
        let bytes = 9 * 480 + 4 * 1000;
        for (budget, of_updater, of_iterations) in [
            (1000, true, false),
            (999, false, false),
            (bytes, true, true),
            (bytes - 1, true, false),
        ] {
            run.memory.budget = fixed + budget;
            let [found, other] = [needing.make_room(&run), iterations.check_room(&run, 4)];
            for (found, fits, needed, contact) in
                [(found, of_updater, 1000, 0), (other, of_iterations, bytes, 3)]
            {
                assert!(
                    match found {
                        Ok(()) => fits,
                        Err(Error::MemoryBudget { needed: found, budget: of, nodes_that_fit }) =>
                            !fits
                                && found == fixed + needed
                                && of == fixed + budget
                                && nodes_that_fit == contact,
                        Err(_) => false,
                    },
                    "{budget}"
                );
            }
        }
        Ok(())
    }

    /// Nodes that touch alone: with a factor they join it, and `1/4` is what the stiffness grows by; iterations find
    /// them in the contact.
    #[test]
    fn single_nodes_are_admitted() -> Result<(), Error> {
        let (mut run, mut factor) = two_in_contact()?;
        run.scalars.place_at(1.5);
        factor.renew_field(&mut run, 1.5)?;
        let mut window = Window::default();
        factor.admit(&mut run, &mut window, (4, 0.5))?;
        assert_eq!((run.contact.order(), window.nodes()), (&[2, 0, 4][..], &[4][..]));
        assert!((window.increments().next().map_or(0.0, |added| added[0]) - 0.25).abs() < 1e-15);
        let mut iterations = Phase::new(ConjugateGradient::new(), None);
        iterations.admit(&mut run, &mut window, (1, 0.5))?;
        assert_eq!(run.contact.order(), [2, 0, 4, 1]);
        run.memory.budget = run.memory.fixed + 6 * 480 + 5 * 1000 - 1;
        assert!(iterations.admit(&mut run, &mut window, (3, 0.5)).is_err());
        assert_eq!(run.contact.len(), 4);
        Ok(())
    }

    /// The states of a path with a factor and of one without are the same, to what the latter say of their approaches.
    #[test]
    fn both_phases_find_the_same_states() -> Result<(), Error> {
        let kernel = Boussinesq::new(Grid::new(14, 12, 1.0, 1.5)?, 1.0)?;
        let surface = SelfAffine::new(0.8, 8.0, 3.0, Amplitude::RmsHeight(0.1), 3)?;
        fn states(
            path: impl Iterator<Item = Result<LoadingState, Error>>,
        ) -> Result<Vec<LoadingState>, Error> {
            path.collect()
        }
        let builder = || LoadingSolver::builder(&surface, &kernel).window_size(12);
        let exact = states(builder().updater(RecursiveCholesky::new()).build()?)?;
        let found = states(builder().updater(ConjugateGradient::new()).build()?)?;
        assert_eq!((exact.len(), found.len()), (168, 168));
        for (found, exact) in found.iter().zip(&exact) {
            assert_eq!(found.node, exact.node);
            let error = (found.contact.approach - exact.contact.approach).abs();
            let allowed = found.approach_error + 1e-12 * exact.contact.approach;
            assert!(error <= allowed, "{error:e} of {allowed:e}: {found:?}");
        }
        Ok(())
    }
}
