//! Holds an updater to what a path asks of it.

use super::{
    ConjugateGradient, Dense, Iterations, Left, LinearUpdater, Schur, Solution, WindowFactor,
    innermost,
};
use crate::contact::ContactSequence;
use crate::{Error, Problem, UpdaterError};

/// Nodes that are watched at a time, of which all but the last join.
const WATCHED: usize = 6;
/// Most nodes that are let into contact: a dense solution for each of them takes n³ operations.
const MOST: usize = 150;
/// Greatest difference from a dense solution, relative to the greatest value: influence matrices of so
/// few nodes lose some three digits.
const TOLERANCE: f64 = 1e-9;
/// How many times the tolerance of its gaps the pressures of a solution by iterations may be off, relatively.
const LOST: f64 = 1e3;

/// The result of [`check`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct UpdaterReport {
    /// Nodes that were in contact at the end.
    pub contact_nodes: usize,
    /// Greatest difference between a Schur complement and a dense one, relative to C(0, 0).
    pub schur_error: f64,
    /// Greatest difference between a solution and a dense one, relative to its greatest value.
    pub solution_error: f64,
    /// Whether the updater takes nodes back.
    pub truncates: bool,
    /// Whether the updater lets nodes in the middle of the contact go. Tried only if it takes nodes back.
    pub releases: bool,
    /// Whether it serves paths with a hardness. Tried only if it lets nodes go.
    pub yields: bool,
    /// Whether it answers with [`relief`](LinearUpdater::relief), which spares a solution for each event where nodes
    /// may leave.
    pub relieves: bool,
}

/// Goes through all verbs of an updater that has no node in contact yet, in the order in which a path
/// would call them, and compares every answer with [`Dense`]. The updater is of no further use.
///
/// The contact grows from nothing by nodes in the order of their initial gaps, with windows in which some
/// nodes are watched and do not join. Solutions are asked for on the contact as it grows, on its first half,
/// and on none of its nodes. See [`LinearUpdater`] for an example.
///
/// # Errors
///
/// Those of the updater; [`UpdaterError::UpdaterMismatch`](crate::UpdaterError::UpdaterMismatch) for an answer of the
/// wrong length; [`UpdaterError::UpdaterWrong`](crate::UpdaterError::UpdaterWrong) for one that differs from the dense
/// answer.
pub fn check(updater: &mut dyn LinearUpdater, problem: &Problem) -> Result<UpdaterReport, Error> {
    let mut nodes: Vec<usize> = (0..problem.grid().nodes()).collect();
    let gap = problem.initial_gap();
    nodes.sort_by(|&a, &b| gap[a].total_cmp(&gap[b]).then(a.cmp(&b)));
    nodes.truncate(MOST);
    let mut examiner = Examiner {
        updater,
        problem,
        contact: ContactSequence::new(problem.grid()),
        schur_error: 0.0,
        solution_error: 0.0,
        relieves: false,
    };
    examiner.solution(0)?;
    let mut left = &nodes[..];
    let mut repeated = None;
    while !left.is_empty() {
        // The node that was watched before and did not join comes first.
        let new = WATCHED.min(left.len());
        let watched: Vec<usize> = repeated.into_iter().chain(left[..new].to_vec()).collect();
        left = &left[new..];
        repeated = examiner.window(&watched)?;
        if !left.is_empty() {
            examiner.solution(examiner.contact.len())?;
        }
    }
    let contact_nodes = examiner.contact.len();
    for count in [0, contact_nodes / 2, contact_nodes] {
        examiner.solution(count)?;
    }
    let truncates = examiner.truncate(contact_nodes - contact_nodes / 3)?;
    let releases = truncates && examiner.release()?;
    let yields = releases && examiner.watch_both()?;
    Ok(UpdaterReport {
        contact_nodes,
        schur_error: examiner.schur_error,
        solution_error: examiner.solution_error,
        truncates,
        releases,
        yields,
        relieves: examiner.relieves,
    })
}

/// An updater under examination.
struct Examiner<'a> {
    updater: &'a mut dyn LinearUpdater,
    problem: &'a Problem,
    contact: ContactSequence,
    schur_error: f64,
    solution_error: f64,
    relieves: bool,
}

impl Examiner<'_> {
    /// Watches nodes, and lets all but the last join; returns that one.
    fn window(&mut self, watched: &[usize]) -> Result<Option<usize>, Error> {
        let (mut schur, mut expected) = (Schur::default(), Schur::default());
        let Self { updater, problem, contact, .. } = self;
        updater.watch(problem, contact, watched, &mut schur)?;
        Dense.watch(problem, contact, watched, &mut expected)?;
        UpdaterError::check_length("the Schur complement", schur.size(), watched.len())?;
        let tolerance = tolerance(*updater);
        let own = problem.table().self_influence();
        // The last ones first, as events need not come in the order of the window.
        let touching: Vec<usize> = watched.iter().rev().take(2).copied().collect();
        if let Some(relief) = updater.relief(problem, contact, &touching)? {
            let dense = Dense.relief(problem, contact, &touching)?.unwrap_or_default();
            UpdaterError::check_length("the relief", relief.len(), dense.len())?;
            for (found, expected) in relief.iter().zip(dense.iter()) {
                // Parts of a pressure.
                check_error("the relief", contact.len(), (found - expected).abs(), tolerance)?;
            }
            self.relieves = true;
        }
        for j in 0..watched.len() {
            for i in j..watched.len() {
                let error = (schur.matrix()[(i, j)] - expected.matrix()[(i, j)]).abs() / own;
                self.schur_error = self.schur_error.max(error);
                check_error("the Schur complement", contact.len(), error, tolerance)?;
            }
        }
        let sums = schur.row_sums().iter().zip(expected.row_sums());
        let scale = greatest(problem.row_sums());
        for (found, expected) in sums {
            let error = (found - expected).abs() / scale;
            check_error("the reduced row sums", contact.len(), error, tolerance)?;
        }
        // Not in the order in which they are watched.
        let joining = watched.len().saturating_sub(1).max(1);
        let positions: Vec<usize> = (0..joining).rev().collect();
        let touched = WindowFactor::of(expected, &positions)?;
        for &position in &positions {
            contact.push(watched[position])?;
        }
        updater.join(problem, contact, &touched)?;
        Ok(watched.get(joining).copied())
    }

    /// Solves on the first `count` nodes.
    fn solution(&mut self, count: usize) -> Result<(), Error> {
        let (mut found, mut expected) = (Solution::default(), Solution::default());
        let (problem, contact) = (self.problem, &self.contact);
        // All nodes so far would be under pressure.
        let approach = problem.greatest_gap();
        self.updater.solve(problem, contact, count, approach, &mut found)?;
        Dense.solve(problem, contact, count, approach, &mut expected)?;
        let tolerance = tolerance(self.updater);
        for (quantity, found, expected) in [
            ("pressures", &found.pressure, &expected.pressure),
            ("pressures per unit of approach", &found.rate, &expected.rate),
        ] {
            UpdaterError::check_length(quantity, found.len(), expected.len())?;
            let scale = greatest(expected);
            for (found, expected) in found.iter().zip(expected) {
                let error = (found - expected).abs() / scale;
                self.solution_error = self.solution_error.max(error);
                check_error(quantity, count, error, tolerance)?;
            }
        }
        Ok(())
    }

    /// Cuts the contact; false if the updater cannot follow.
    fn truncate(&mut self, count: usize) -> Result<bool, Error> {
        self.contact.truncate(count);
        match self.updater.truncate(self.problem, &self.contact) {
            Err(Error::Updater(UpdaterError::TruncateNotSupported { .. })) => Ok(false),
            done => done.and_then(|()| self.solution(count)).map(|()| true),
        }
    }

    /// Lets the node in the middle go, and the first and the last; false if the updater cannot follow.
    fn release(&mut self) -> Result<bool, Error> {
        let order = self.contact.order().to_vec();
        let mut positions = vec![0, order.len() / 2, order.len().saturating_sub(1)];
        positions.dedup();
        let left = positions.into_iter().filter_map(|position| {
            let node = *order.get(position)?;
            Some(Left { node, position })
        });
        let left: Vec<Left> = left.collect();
        for left in &left {
            self.contact.remove(left.node)?;
        }
        let (problem, contact) = (self.problem, &self.contact);
        match self.updater.release(problem, contact, &left) {
            Err(Error::Updater(UpdaterError::ReleaseNotSupported { .. })) => Ok(false),
            done => {
                let count = self.contact.len();
                done.and_then(|()| self.solution(count)).map(|()| true)
            }
        }
    }

    /// Watches nodes out of contact and in it, and solves for right-hand sides; false if the updater cannot.
    fn watch_both(&mut self) -> Result<bool, Error> {
        let Self { updater, problem, contact, .. } = self;
        let count = contact.len();
        let outside: Vec<usize> = (0..problem.grid().nodes())
            .filter(|&node| !contact.contains(node))
            .take(WATCHED)
            .collect();
        let inside: Vec<usize> = (0..count).step_by(5).take(WATCHED).collect();
        let (mut schur, mut expected) = (Schur::default(), Schur::default());
        match updater.watch_both(problem, contact, &outside, &inside, &mut schur) {
            Err(Error::Updater(UpdaterError::HardnessNotSupported)) => return Ok(false),
            done => done?,
        }
        Dense.watch_both(problem, contact, &outside, &inside, &mut expected)?;
        let size = outside.len() + inside.len();
        UpdaterError::check_length("the Schur complement", schur.size(), size)?;
        let own = problem.table().self_influence();
        let tolerance = tolerance(*updater);
        for j in 0..size {
            for i in j..size {
                // Pressures under overlaps are 1/C, gaps under pressures C, and the others have no unit.
                let inner = [i, j].iter().filter(|k| **k >= outside.len()).count();
                let scale = own.powi(1 - inner as i32);
                let error = (schur.matrix()[(i, j)] - expected.matrix()[(i, j)]).abs() / scale;
                check_error("the Schur complement of both kinds", count, error, tolerance)?;
            }
        }
        let mut found: Vec<[f64; 2]> = (0..count).map(|k| [own, own * (k % 3) as f64]).collect();
        let mut dense = found.clone();
        updater.solve_for(problem, contact, &mut found)?;
        Dense.solve_for(problem, contact, &mut dense)?;
        let scale = dense.iter().flatten().fold(f64::MIN_POSITIVE, |most, x| most.max(x.abs()));
        for (found, expected) in found.iter().flatten().zip(dense.iter().flatten()) {
            let error = (found - expected).abs() / scale;
            check_error("the solution for right-hand sides", count, error, tolerance)?;
        }
        Ok(true)
    }
}

/// Greatest errors of the answers of an updater.
fn tolerance(updater: &dyn LinearUpdater) -> f64 {
    match innermost(updater).downcast_ref::<ConjugateGradient>() {
        Some(iterations) => TOLERANCE.max(LOST * iterations.tolerance()),
        None => TOLERANCE,
    }
}

/// The greatest absolute value, 1 if there is none.
fn greatest(values: &[f64]) -> f64 {
    let greatest = values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    if greatest > 0.0 { greatest } else { 1.0 }
}

/// `Ok` if an error is within the tolerance, which NaN is not.
fn check_error(
    quantity: &'static str,
    contact_nodes: usize,
    error: f64,
    tolerance: f64,
) -> Result<(), Error> {
    if error <= tolerance {
        return Ok(());
    }
    Err(Error::Updater(UpdaterError::UpdaterWrong { quantity, contact_nodes, error, tolerance }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{Amplitude, SelfAffine};
    use crate::updater::test_altered::Altered;
    use crate::updater::{ConjugateGradient, Handover, RecursiveCholesky};
    use crate::{Boussinesq, Grid};

    fn problem() -> Result<Problem, Error> {
        let grid = Grid::new(16, 12, 1.0, 1.5)?;
        let surface = SelfAffine::new(0.8, 8.0, 3.0, Amplitude::RmsHeight(0.1), 3)?;
        Problem::new(&surface, &Boussinesq::new(grid, 1.0)?)
    }

    #[test]
    fn all_updaters_pass() -> Result<(), Error> {
        let problem = problem()?;
        let updaters: [(&str, Box<dyn LinearUpdater>); 4] = [
            ("dense", Box::new(Dense)),
            ("cholesky", Box::new(RecursiveCholesky::new())),
            ("iterations", Box::new(ConjugateGradient::new())),
            ("handover", Box::new(Handover::new())),
        ];
        for (name, mut updater) in updaters {
            let report = check(&mut updater, &problem)?;
            assert!(report.truncates && report.releases && report.yields, "{name}: {report:?}");
            assert!(report.contact_nodes > 100, "{name}: {report:?}");
        }
        Ok(())
    }

    /// What an updater is held to does not depend on the boxes around it.
    #[test]
    fn boxes_are_looked_into() -> Result<(), Error> {
        let coarse = ConjugateGradient::with_tolerance(1e-6)?;
        let mut boxed: Box<dyn LinearUpdater> =
            Box::new(Box::new(coarse) as Box<dyn LinearUpdater>);
        assert_eq!(tolerance(&boxed), LOST * 1e-6);
        check(&mut boxed, &problem()?)?;
        Ok(())
    }

    /// An updater that is right in all but one thing.
    struct Lying {
        inner: RecursiveCholesky,
        lie: &'static str,
    }

    impl Lying {
        /// An error on no nodes, if that is the lie.
        fn refuse(&self, lie: &str, nodes: usize) -> Result<(), Error> {
            if self.lie == lie && nodes == 0 {
                return Err(Error::FactorizationFailed { nodes });
            }
            Ok(())
        }
    }

    impl LinearUpdater for Lying {
        fn watch(
            &mut self,
            problem: &Problem,
            contact: &ContactSequence,
            nodes: &[usize],
            schur: &mut Schur,
        ) -> Result<(), Error> {
            self.refuse("watch", contact.len())?;
            self.inner.watch(problem, contact, nodes, schur)?;
            match self.lie {
                "matrix" => schur.matrix_mut()[(0, 0)] *= 1.0 + 1e-6,
                "matrix, a little" => schur.matrix_mut()[(0, 0)] *= 1.0 + 1e-10,
                "row sums" => schur.row_sums_mut()[0] *= 2.0,
                "size" => schur.resize(nodes.len() + 1)?,
                _ => {}
            }
            Ok(())
        }

        fn join(
            &mut self,
            problem: &Problem,
            contact: &ContactSequence,
            touched: &WindowFactor,
        ) -> Result<(), Error> {
            self.inner.join(problem, contact, touched)
        }

        fn solve(
            &mut self,
            problem: &Problem,
            contact: &ContactSequence,
            count: usize,
            approach: f64,
            solution: &mut Solution,
        ) -> Result<(), Error> {
            self.refuse("solve", count)?;
            self.refuse("part", count + usize::from(contact.is_empty()))?;
            self.inner.solve(problem, contact, count, approach, solution)?;
            match self.lie {
                "pressure" if count > 0 => solution.pressure[0] = f64::NAN,
                "pressure, a little" => {
                    solution.pressure.iter_mut().for_each(|p| *p *= 1.0 + 1e-10)
                }
                "rate" => solution.rate.reverse(),
                "rate, a little" => solution.rate.iter_mut().for_each(|y| *y *= 1.0 + 1e-10),
                "length" => solution.rate.clear(),
                _ => {}
            }
            Ok(())
        }
    }

    #[test]
    fn what_is_nothing_is_compared_with_1() {
        assert_eq!(
            [greatest(&[]), greatest(&[0.0, -0.0]), greatest(&[2.0, -3.0])],
            [1.0, 1.0, 3.0]
        );
    }

    /// One that takes the last nodes back, and no other.
    #[test]
    fn what_an_updater_cannot_do_is_told() -> Result<(), Error> {
        let report = check(&mut Altered::complements(|_| {}), &problem()?)?;
        assert!(report.truncates && !report.releases, "{report:?}");
        Ok(())
    }

    /// What is off by less than the tolerance is told: the first pivot without contact, which is C(0, 0), or all of a
    /// solution.
    #[test]
    fn errors_are_told() -> Result<(), Error> {
        let problem = problem()?;
        for (lie, expected) in [
            ("nothing", [0.0, 0.0]),
            ("matrix, a little", [1e-10, 0.0]),
            ("pressure, a little", [0.0, 1e-10]),
            ("rate, a little", [0.0, 1e-10]),
        ] {
            let report = check(&mut Lying { inner: RecursiveCholesky::new(), lie }, &problem)?;
            let found = [report.schur_error, report.solution_error];
            // Rounding, of which matrices of so few nodes make a thousand times as much.
            for (found, expected) in found.into_iter().zip(expected) {
                assert!((found - expected).abs() < 1e-12, "{lie}: {report:?}");
            }
        }
        Ok(())
    }

    #[test]
    fn lies_are_found() -> Result<(), Error> {
        let problem = problem()?;
        let checked = |lie| {
            let inner = RecursiveCholesky::new();
            check(&mut Lying { inner, lie }, &problem)
        };
        for lie in ["matrix", "row sums", "pressure", "rate"] {
            let found = checked(lie);
            assert!(
                matches!(found, Err(Error::Updater(UpdaterError::UpdaterWrong { .. }))),
                "{lie}: {found:?}"
            );
        }
        for lie in ["size", "length"] {
            let found = checked(lie);
            assert!(
                matches!(found, Err(Error::Updater(UpdaterError::UpdaterMismatch { .. }))),
                "{lie}: {found:?}"
            );
        }
        // Updaters that cannot do without a node: a path asks them on an empty contact, and on none of its nodes.
        for lie in ["watch", "solve", "part"] {
            let found = checked(lie);
            assert!(
                matches!(found, Err(Error::FactorizationFailed { nodes: 0 })),
                "{lie}: {found:?}"
            );
        }
        let honest = checked("nothing")?;
        assert!(!honest.truncates && !honest.releases);
        Ok(())
    }
}
